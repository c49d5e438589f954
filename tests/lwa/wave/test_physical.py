"""The wave of a peak contact force: forces, scalings, limits; tests/validation has the lattice."""

import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, canonical_wave, homogenize
from lwa.base.frozen import QUANTITIES


def rationals(low, high):
    return st.fractions(low, high, max_denominator=100).map(sp.Rational)


reals = rationals("1/100", 1000)
cells = st.integers(1, 3).flatmap(
    lambda P: st.tuples(*(st.lists(reals, min_size=P, max_size=P) for _ in range(2)))
)


def close(found, wanted):
    return abs(sp.N(found, 40) / sp.N(wanted, 40) - 1) < 1e-34


@given(cells, reals, rationals("21/20", 4), reals)
def test_compression_speed_and_times_are_those_of_the_force(cell, D, k, F):
    """The strain is the mean of the contacts under F; widths in time are lengths over the speed."""
    masses, stiffnesses = cell
    wave = canonical_wave(Cell(masses, stiffnesses, D), k)
    found = wave.at_force(F)
    assert close(sum((F / A) ** (1 / k) for A in stiffnesses), len(masses) * D * found.strain)
    assert close(found.compression, D * found.strain)
    assert close(found.speed, wave.speed(found.strain) * wave.time_scale)
    assert close(found.bead_velocity, found.speed * wave.profile(0, found.strain))
    for quantity in QUANTITIES:
        assert found.fwhm(quantity) == wave.fwhm(quantity)
        assert close(found.fwhm(quantity, "time") * found.speed, found.fwhm(quantity))


def test_equal_spheres_by_hand():
    """The theory's c² = (2/(k+1)) A^{1/k} F^{(k-1)/k} D²/m, 4/5 of it at k = 3/2."""
    m, A, D, F = sp.symbols("m A D F", positive=True)
    answer = homogenize(Cell([m], [A], D), k="3/2").pde.traveling_wave().at_force()
    assert answer.force == F
    assert answer.speed**2 == sp.Rational(4, 5) * A ** sp.Rational(2, 3) * sp.cbrt(F) * D**2 / m
