"""The envelope's equation against closed forms, KdV and plane waves of chains."""

from types import SimpleNamespace

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
k, m1, m2, q, p0 = sp.symbols("k m1 m2 q p0", positive=True)
HERTZ = Power("3/2")


def test_the_optical_band_of_a_dimer_begins_with_the_light_bead():
    found = envelope(Dimer(m1, m2), law=general(), background=0)
    omega = sp.sqrt(2 * K2 / m2)
    assert same(found.frequency, omega)
    assert found.group_velocity == 0
    assert same(found.dispersion, K2 / (2 * omega * (m1 - m2)))
    assert same(found.nonlinearity, (3 * K2 * K4 - 4 * K3**2) / (K2 * m2**2 * omega))
    assert found.mode[0] == 0
    assert same(found.mode[1], 1 / sp.sqrt(m2))


def lattice_shift(springs, kappa, frequency, phi, flow, A, harmonics=5):
    """Frequency of the lattice's plane wave of projection A on the mode, less the linear one.

    Newton's method for complex Fourier coefficients of each bead in θ = κn - ωt; cells are longer
    by -flow, the mean compression of the envelope's mean flow.
    """
    P, n = len(springs.masses), 4 * harmonics
    h, theta = np.arange(1, harmonics + 1), 2 * np.pi * np.arange(n) / n
    waves = np.exp(1j * np.outer(h, theta))
    steps = np.exp(1j * kappa * h)

    def residual(v):
        mean, parts, omega = v[:P], v[P:-1].reshape(2, P, harmonics), v[-1]
        U = parts[0] + 1j * parts[1]
        u = 2 * (U @ waves).real + mean[:, None]
        after = 2 * ((U[:1] * steps) @ waves).real + mean[0] - flow
        delta = u - np.vstack([u[1:], after])
        K = [c[:, None] for c in (springs.K2, springs.K3, springs.K4)]
        force = sum(c * delta ** (i + 1) for i, c in enumerate(K))
        force = np.fft.rfft(force, axis=1)[:, : harmonics + 1] / n
        before = np.vstack([force[-1:] * np.append(1, 1 / steps), force[:-1]])
        push = before - force
        rest = -(omega**2) * springs.masses[:, None] * U * h**2 - push[:, 1:]
        held = (springs.masses * phi.conj() * U[:, 0]).sum() - A
        loose = [push[:-1, 0].real, [mean.sum(), held.real, held.imag]]
        return np.concatenate([*loose, rest.real.ravel(), rest.imag.ravel()])

    start = np.zeros((P, harmonics), complex)
    start[:, 0] = A * phi
    v = np.concatenate(
        [np.zeros(P), start.real.ravel(), start.imag.ravel(), [frequency]]
    )
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    found = scipy.optimize.least_squares(residual, v, x_scale="jac", **tight)
    assert np.abs(found.fun).max() < 1e-13
    return found.x[-1] - frequency


@pytest.mark.parametrize("P", [1, 2, 3, 4])
def test_plane_waves_of_random_cells_on_the_lattice(P):
    """χ to four digits: the shift at two amplitudes, whose next order, in |A|⁴, is taken off."""
    rng = np.random.default_rng([P, 1])
    masses, stiffnesses = (
        [sp.Rational(int(n), 8) for n in rng.integers(4, 17, P)] for _ in range(2)
    )
    kappa, branch = float(rng.uniform(0.5, 3)), int(rng.integers(P))
    found = envelope(
        Cell(masses, stiffnesses, 1),
        law=Power("5/2"),
        background=1,
        wavenumber=kappa,
        branch=branch,
    ).numeric()
    shares = np.array(found.static_compressions, float)
    A = np.array(stiffnesses, float)
    springs = SimpleNamespace(
        masses=np.array(masses, float),
        K2=2.5 * A * shares**1.5,
        K3=2.5 * 1.5 / 2 * A * shares**0.5,
        K4=2.5 * 1.5 * 0.5 / 6 * A * shares**-0.5,
    )
    chi, omega = float(found.nonlinearity), float(found.frequency)
    phi, flow = np.array(found.mode, complex), float(sum(found.mean_strain))
    shifts = []
    for part in (2e-5, 5e-6):
        square = part * omega / abs(chi)
        shift = lattice_shift(springs, kappa, omega, phi, flow * square, square**0.5)
        shifts.append(shift / square / chi)
    assert (4 * shifts[1] - shifts[0]) / 3 == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize(
    ("cell", "kappa"),
    [
        (Cell([2], [3], 1), sp.pi / 3),
        (Cell([3, 2], spacing=1), sp.pi),
    ],
    ids=str,
)
def test_exact_numbers_are_those_of_floats(cell, kappa):
    chain = envelope(
        cell, law=HERTZ, background="1/2", wavenumber=kappa, branch=cell.size - 1
    )
    floats = chain.numeric()
    for name in ("frequency", "group_velocity", "dispersion", "nonlinearity"):
        ours, theirs = (complex(getattr(e, name)) for e in (chain, floats))
        assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-12)
    for name in ("mean_strain", "strains"):
        pairs = zip(getattr(chain, name), getattr(floats, name), strict=True)
        assert all(
            complex(a) == pytest.approx(complex(b), rel=1e-9, abs=1e-10)
            for a, b in pairs
        )
    if kappa == sp.pi:
        assert not chain.nonlinearity.has(sp.Float)


def test_resonances_are_refused_by_name():
    """Sound is the one mode with c_g = c_0; second harmonics may be optical modes."""
    with pytest.raises(InputError, match="sound, c_g = c_0, has no envelope"):
        envelope(Dimer(1, 2), law=HERTZ, background=1, wavenumber=0, branch=0).kind  # noqa: B018
    long = envelope(Cell([1], spacing=1), law=HERTZ, background=1, wavenumber="1/1000")
    with pytest.raises(
        InputError, match="too close to that of sound, c_g = c_0, for floats"
    ):
        long.numeric().nonlinearity  # noqa: B018
    limit = -long.frequency / 4  # χ = -ω (k-1) (k - cos² κ/2) → -ω (k-1)²
    assert float(long.nonlinearity / limit) == pytest.approx(1, abs=1e-6)

    def square(kappa, sign):
        """ω² of masses 1 and 1/2, over K2."""
        return 3 + sign * np.sqrt(9 - 8 * np.sin(kappa / 2) ** 2)

    place = scipy.optimize.brentq(
        lambda q: 4 * square(q, -1) - square(2 * q, 1), 0.1, 3, xtol=1e-15
    )
    options = {"background": 1, "wavenumber": place, "branch": 0}
    ringing = envelope(Dimer(1, "1/2", spacing=1), law=HERTZ, **options)
    with pytest.raises(InputError, match="the second harmonic is a mode too"):
        ringing.numeric().nonlinearity  # noqa: B018
    driven = envelope(Cell([1, 1], [1, 9], 1), law=Power(2), background=1, branch=0)
    with pytest.raises(InputError, match="the second harmonic is a mode too"):
        driven.nonlinearity  # noqa: B018


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
    masses, stiffnesses = draw.integers(1, 10, (2, P))
    cell, kappa, branch, h = (
        Cell(masses, stiffnesses, 1),
        1.3,
        int(draw.integers(P)),
        1e-3,
    )
    chain = LoadedChain(cell, HERTZ, 2)
    options = {"precompression": 2, "wavenumber": kappa, "branch": branch}
    ours = envelope(cell, law=HERTZ, **options).numeric()
    at = chain.bands.branches(np.array([kappa - h, kappa, kappa + h]) / P)[:, branch]
    assert float(ours.frequency) == pytest.approx(at[1], rel=1e-10)
    slope, bend = (at[2] - at[0]) / (2 * h), (at[2] - 2 * at[1] + at[0]) / h**2
    assert float(ours.group_velocity) == pytest.approx(slope, abs=1e-4)
    assert abs(slope) * P < chain.sound_speed  # in spacings per time
    assert float(ours.dispersion) == pytest.approx(bend, abs=1e-4)
