"""Sums and profiles of the expansion beside the lattice's own waves, up to k = 20.

Equal beads have c² r = Λ * r^k for the strain r, Λ the triangle on [-1, 1] (English & Pego 2005).
Iterated with the peak held at 1 and solved by Fourier it is the wave, independently of the
expansion and of `validation`, with whose waves it is compared where these reach.
"""

from contextlib import suppress
from functools import cache

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, InputError, expand

POINTS = 4096
WIDTHS = ("strain", "force", "velocity")
NAMES = ("c2", "c", "momentum", "kinetic", "energy", "effective_mass")
EXPONENTS = ("1.1", "3/2", "4", "8", "9.5", "20")


@cache
def lattice(k):
    """Values by name of the wave of equal beads whose force peaks at 1; ξ and its forces.

    The velocity is the force's mean over one site, over c: c² s' = F(ξ - ½) - F(ξ + ½).
    """
    half = max(4.0, 8 / np.sqrt(k - 1))
    xi = np.linspace(-half, half, POINTS, endpoint=False)
    q = np.pi * np.fft.fftfreq(POINTS, 1 / POINTS) / half
    mean = np.sinc(q / 2 / np.pi)
    strain = np.exp(-3 * (k - 1) / k * np.fft.ifftshift(xi) ** 2)
    for _ in range(1000):
        new = np.fft.ifft(mean**2 * np.fft.fft(np.maximum(strain, 0) ** k)).real
        c2 = new.max()
        new, old = new / c2, strain
        strain = new
        if np.abs(new - old).max() < 1e-15:
            break
    force = np.fft.fft(np.maximum(strain, 0) ** k)

    def width(spectrum):
        below, above = 0.0, half / 2
        height = spectrum.real.sum() / 2
        for _ in range(60):
            middle = (below + above) / 2
            inside = (spectrum * np.exp(1j * q * middle)).real.sum() > height
            below, above = (middle, above) if inside else (below, middle)
        return 2 * below

    spectra, step, c = (
        (np.fft.fft(strain), force, mean * force),
        xi[1] - xi[0],
        np.sqrt(c2),
    )
    velocity, push = np.fft.ifft(mean * force).real / c, np.maximum(strain, 0) ** k
    kinetic, elastic = (
        step * (velocity @ velocity) / 2,
        step * (strain @ push) / (k + 1),
    )
    momentum, energy = step * velocity.sum(), kinetic + elastic
    rest = momentum, kinetic, energy, momentum**2 / (2 * energy)
    values = dict(zip(NAMES, (c2, c, *rest), strict=True))
    values |= dict(zip(WIDTHS, map(width, spectra), strict=True))
    assert kinetic / elastic == pytest.approx((k + 1) / 2)  # the virial theorem
    return values, xi, np.fft.fftshift(push)


def series(expansion):
    """Series of all quantities of `lattice`, by the same names."""
    found = {name: getattr(expansion, name) for name in NAMES}
    return found | {name: expansion.fwhm(name) for name in WIDTHS}


@pytest.mark.slow
@pytest.mark.parametrize("k", [1.1, 1.5, 3.0, 8.0])
def test_these_are_the_waves_of_newtons_method(k):
    from validation.waves.solver import exact_wave

    values, _, _ = lattice(k)
    wave = exact_wave([1], k)
    found = {"c2": wave.c2, "c": wave.c}
    found |= {name: wave.fwhm(name) for name in WIDTHS}
    for name, value in found.items():
        assert value == pytest.approx(values[name], abs=1e-10)


@pytest.mark.parametrize("order", [6, 10])
@pytest.mark.parametrize("k", EXPONENTS)
def test_a_sum_is_right_within_its_error_or_refused(k, order):
    """At order 10 none is refused up to k = 9.5; c² is from k = 12 on."""
    values, _, _ = lattice(float(sp.Rational(k)))
    rows = series(expand(Cell([1]), order, k=k))
    for name, row in list(rows.items()):
        with suppress(InputError):
            found = row.at()
            assert 0 < found.error < found.value
            assert abs(found.value - values[name]) < found.error
            del rows[name]
    assert not rows or order < 10 or sp.Rational(k) > 9.5
    assert "c2" in rows or sp.Rational(k) < 12


@pytest.mark.parametrize("order", [1, 3])
@pytest.mark.parametrize(("k", "bound"), [("1.1", 3e-4), ("3/2", 6e-3), ("2", 0.03)])
def test_a_profile_is_the_lattices(k, bound, order):
    """exp Σ ε^n φ_n(√ε ξ) is near the lattice's force down to half of its peak."""
    _, xi, force = lattice(float(sp.Rational(k)))
    root = sp.sqrt(sp.Rational(k) - 1)
    place = sp.Symbol("xi", real=True)
    log = sum(
        root ** (2 * n) * phi
        for n, phi in expand(Cell([1]), order, k=k).log_force(X=root * place).items()
    )
    near = force > 0.5
    ours = np.exp([float(log.subs(place, x)) for x in xi[near][::16]])
    assert np.abs(ours - force[near][::16]).max() < bound
