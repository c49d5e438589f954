"""The wave of a peak contact force: forces, scalings, limits; tests/validation has the lattice."""

from functools import cache

import mpmath
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, canonical_wave, homogenize
from lwa.base.frozen import QUANTITIES

k = sp.Symbol("k", positive=True)


def symbols(letter, P):
    return sp.symbols(f"{letter}1:{P + 1}", positive=True)


@cache
def functions(P):
    """Names and mpmath functions of all results of the wave in a cell of P symbols."""
    wave = canonical_wave(Cell(symbols("m", P), symbols("A", P)), k)
    answer = wave.at_force()
    expressions = {
        "B": answer.strain,
        "delta": answer.compression,
        "c": answer.speed,
        "v": answer.bead_velocity,
        "scaled": wave.speed(answer.strain) * wave.time_scale,
        "peak": wave.profile(0, answer.strain),
        **{f"{q} of the wave": wave.fwhm(q) for q in QUANTITIES},
        **{f"{q} length": answer.fwhm(q) for q in QUANTITIES},
        **{f"{q} time": answer.fwhm(q, "time") for q in QUANTITIES},
    }
    arguments = (*wave.cell.masses, *wave.cell.stiffnesses, wave.D, k, answer.force)
    return list(expressions), sp.lambdify(arguments, list(expressions.values()), "mpmath", cse=True)


def values(masses, stiffnesses, D, k, F):
    names, compiled = functions(len(masses))
    return dict(zip(names, compiled(*masses, *stiffnesses, D, k, F), strict=True))


def close(found, wanted):
    return abs(found / wanted - 1) < mpmath.mpf(10) ** -34  # of 40 digits


reals = st.floats(1e-3, 1e3).map(mpmath.mpf)
exponents = st.floats(1.05, 4).map(mpmath.mpf)
cells = st.integers(1, 3).flatmap(
    lambda P: st.tuples(
        st.lists(reals, min_size=P, max_size=P), st.lists(reals, min_size=P, max_size=P)
    )
)


@given(cells, reals, exponents, reals)
def test_the_strain_is_the_mean_of_the_contacts_under_the_force(cell, D, k, F):
    with mpmath.workdps(40):
        masses, stiffnesses = cell
        found = values(masses, stiffnesses, D, k, F)
        assert close(sum((F / A) ** (1 / k) for A in stiffnesses), len(masses) * D * found["B"])
        assert close(found["delta"], D * found["B"])


@given(cells, reals, exponents, reals)
def test_widths_in_time_are_widths_in_space_over_the_speed(cell, D, k, F):
    with mpmath.workdps(40):
        found = values(*cell, D, k, F)
        assert close(found["c"], found["scaled"])
        assert close(found["v"], found["c"] * found["peak"])
        for quantity in QUANTITIES:
            assert found[f"{quantity} length"] == found[f"{quantity} of the wave"]
            assert close(found[f"{quantity} time"] * found["c"], found[f"{quantity} length"])


def test_equal_spheres_by_hand():
    """The theory's c² = (2/(k+1)) A^{1/k} F^{(k-1)/k} D²/m, 4/5 of it at k = 3/2."""
    m, A, D, F = sp.symbols("m A D F", positive=True)
    answer = homogenize(Cell([m], [A], D), k="3/2").pde.traveling_wave().at_force()
    assert answer.force == F
    assert answer.speed**2 == sp.Rational(4, 5) * A ** sp.Rational(2, 3) * sp.cbrt(F) * D**2 / m
