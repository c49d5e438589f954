"""The envelope's equation against closed forms, KdV and plane waves of chains."""

import numpy as np
import pytest
import scipy
import sympy as sp

from lwa import (
    Cell,
    Dimer,
    InputError,
    LoadedChain,
    Power,
    envelope,
    general,
)
from tests.identity import same

K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
m2 = sp.Symbol("m2", positive=True)
HERTZ = Power("3/2")


def test_a_law_without_an_expression_has_the_coefficients_of_its_force():
    """The light bead swings alone at the bottom of the optical band."""
    found = envelope(Dimer("m1", m2), law=general(), background=0)
    omega = sp.sqrt(2 * K2 / m2)
    assert same(found.nonlinearity, (3 * K2 * K4 - 4 * K3**2) / (K2 * m2**2 * omega))
    assert found.mode[0] == 0
    assert same(found.mode[1], 1 / sp.sqrt(m2))


def lattice_shift(masses, springs, kappa, phi, frequency, flow, A):
    """Frequency of the lattice's plane wave of projection A on the mode, less the linear one.

    Displacements of each bead at places θ = κn - ωt, by least squares; cells are longer by -flow,
    the mean compression of the envelope's mean flow.
    """
    n = 20  # the fifth harmonic is lost in rounding
    h = np.arange(n // 2 + 1)
    turn = np.exp(1j * kappa * h)

    def residual(v):
        u, omega = v[:-1].reshape(-1, n), v[-1]
        U = np.fft.rfft(u)
        after = np.fft.irfft(U[0] * turn) - flow
        delta = u - np.vstack([u[1:], after])
        force = sum(K[:, None] * delta ** (i + 1) for i, K in enumerate(springs))
        before = np.fft.irfft(np.fft.rfft(force[-1]) / turn)
        push = np.vstack([before, force[:-1]]) - force
        inertia = -(omega**2) * masses[:, None] * np.fft.irfft(h**2 * U)
        held = (masses * phi.conj() * U[:, 1]).sum() / n - A
        return np.concatenate(
            [(inertia - push).ravel(), [u.sum(), held.real, held.imag]]
        )

    theta = 2 * np.pi * np.arange(n) / n
    start = 2 * A * (phi[:, None] * np.exp(1j * theta)).real
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    found = scipy.optimize.least_squares(
        residual, [*start.ravel(), frequency], x_scale="jac", **tight
    )
    assert np.abs(found.fun).max() < 1e-13
    return found.x[-1] - frequency


@pytest.mark.parametrize("P", [1, 2, 3, 4])
def test_plane_waves_of_random_cells_on_the_lattice(P):
    """χ to four digits: the shift at two amplitudes, whose next order, in |A|⁴, is taken off."""
    rng = np.random.default_rng([P, 1])
    masses, A = rng.integers(4, 17, (2, P)) / 8
    kappa, branch = float(rng.uniform(0.5, 3)), int(rng.integers(P))
    found = envelope(
        Cell(masses, A, 1), k="5/2", background=1, wavenumber=kappa, branch=branch
    ).numeric()
    shares = np.array(found.static_compressions, float)
    springs = [A * scipy.special.binom(2.5, n) * shares ** (2.5 - n) for n in (1, 2, 3)]
    chi, omega = float(found.nonlinearity), float(found.frequency)
    phi, flow = np.array(found.mode, complex), float(sum(found.mean_strain))
    shifts = []
    for part in (2e-5, 5e-6):
        square = part * omega / abs(chi)
        shift = lattice_shift(
            masses, springs, kappa, phi, omega, flow * square, square**0.5
        )
        shifts.append(shift / square / chi)
    assert (4 * shifts[1] - shifts[0]) / 3 == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize(
    ("cell", "kappa"),
    [
        (Cell([2], [3], 1), sp.pi / 3),
        # Numbers far from 1, for what counts as close
        (Cell([3 * 10**6, 2 * 10**6], [10**6] * 2, spacing=1), sp.pi),
    ],
    ids=str,
)
def test_exact_numbers_are_those_of_floats(cell, kappa):
    chain = envelope(
        cell, k="3/2", background="1/2", wavenumber=kappa, branch=cell.size - 1
    )
    rows = []
    for found in (chain, chain.numeric()):
        row = [found.frequency, found.group_velocity, found.dispersion]
        row += [found.nonlinearity, *found.mean_strain, *found.squared_strains]
        rows.append([complex(value) for value in row])
    assert rows[0] == pytest.approx(rows[1], rel=1e-9, abs=1e-10)
    if kappa == sp.pi:
        assert not chain.nonlinearity.has(sp.Float)


def test_resonances_are_refused_by_name():
    """Sound is the one mode with c_g = c_0; second harmonics may be optical modes."""
    with pytest.raises(InputError, match="sound, c_g = c_0, has no envelope"):
        envelope(Dimer(1, 2), law=HERTZ, background=1, wavenumber=0, branch=0).kind  # noqa: B018 - to read it is refused
    long = envelope(Cell([1], spacing=1), law=HERTZ, background=1, wavenumber="1/1000")
    with pytest.raises(
        InputError, match="too close to that of sound, c_g = c_0, for floats"
    ):
        long.numeric().nonlinearity  # noqa: B018 - to read it is refused
    limit = -long.frequency / 4  # χ = -ω (k-1) (k - cos² κ/2) → -ω (k-1)²
    assert float(long.nonlinearity / limit) == pytest.approx(1, abs=1e-6)

    driven = envelope(Cell([1, 1], [1, 9], 1), law=Power(2), background=1, branch=0)
    with pytest.raises(InputError, match="the second harmonic is a mode too"):
        driven.nonlinearity  # noqa: B018 - to read it is refused


def test_a_harmonic_that_no_force_drives_is_left_out():
    """Masses 3 and 1 at κ = π: 4ω² = 8/3 is the optical mode, but both contacts push alike."""
    near = envelope(
        Cell(["m", 1], spacing=1), law=HERTZ, background=1, branch=0
    ).nonlinearity
    limit = sp.limit(near, sp.Symbol("m", positive=True), 3)
    found = envelope(Cell([3, 1], spacing=1), law=HERTZ, background=1, branch=0)
    assert found.nonlinearity == limit == -sp.Rational(1, 16)
    assert float(found.numeric().nonlinearity) == pytest.approx(-0.0625, rel=1e-12)


@pytest.mark.parametrize("P", [2, 3, 5])
def test_frequencies_and_their_derivatives_are_those_of_the_bands(P):
    """ω of `LoadedChain`, of κ per cell; c_g < c_0 and ω″ by its differences."""
    draw = np.random.default_rng(P)
    cell = Cell(*draw.integers(1, 10, (2, P)), spacing=1)
    kappa, h = 1.3, 1e-3
    branch = int(draw.integers(P))
    chain = LoadedChain(cell, HERTZ, 2)
    options = {"precompression": 2, "wavenumber": kappa, "branch": branch}
    ours = envelope(cell, law=HERTZ, **options).numeric()
    at = chain.bands.branches(np.array([kappa - h, kappa, kappa + h]) / P)[:, branch]
    assert float(ours.frequency) == pytest.approx(at[1], rel=1e-10)
    slope, bend = (at[2] - at[0]) / (2 * h), (at[2] - 2 * at[1] + at[0]) / h**2
    assert float(ours.group_velocity) == pytest.approx(slope, abs=1e-4)
    assert abs(slope) * P < chain.sound_speed  # in spacings per time
    assert float(ours.dispersion) == pytest.approx(bend, abs=1e-4)
