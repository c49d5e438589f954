"""The same chain described from another particle, or backwards.

Naming the particles of a cell anew changes which field the wave equation is about. What a wave does
cannot depend on it: β, the speed and I must stay, and with the full closure's canonical field the
whole equation does. The paper's linear closure keeps I only.
"""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, homogenize

values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


def rotated(cell, n):
    masses, stiffnesses = cell.masses, cell.stiffnesses
    return Cell(masses[n:] + masses[:n], stiffnesses=stiffnesses[n:] + stiffnesses[:n])


def reflected(cell):
    # contact i joins particles i and i+1; backwards, the last contact of the cell comes last again
    inner, last = cell.stiffnesses[:-1], cell.stiffnesses[-1]
    return Cell(cell.masses[::-1], stiffnesses=(*inner[::-1], last))


def canonical(cell, order=4):
    return homogenize(cell, order, k="3/2", closure="full", field="center").pde


@given(st.lists(st.tuples(values, values), min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=4)
def test_beta_speed_and_I_do_not_depend_on_the_labels(pairs, n):
    masses, stiffnesses = zip(*pairs, strict=True)
    cell = Cell(masses, stiffnesses=stiffnesses)
    wave = canonical(cell).traveling_wave()
    for other in (rotated(cell, n % cell.size), reflected(cell)):
        again = canonical(other).traveling_wave()
        for name in ("I", "beta", "speed_factor", "time_scale"):
            difference = sp.N(getattr(wave, name) - getattr(again, name), 30).subs(cell.spacing, 1)
            assert abs(sp.N(difference, 30)) < 1e-25  # shares are irrational: 30 digits less some


@given(st.lists(values, min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=10)
def test_the_canonical_equation_is_the_same_from_every_particle(masses, n):
    cell = Cell(masses)
    pde, again = canonical(cell, 7), canonical(rotated(cell, n % cell.size), 7)
    assert {n: dict(found) for n, found in pde.coefficients.items()} == {
        n: dict(found) for n, found in again.coefficients.items()
    }


def test_the_linear_closure_depends_on_the_labels():
    """β D → √10/10 for m2 → 0, but √6/4 for m1 → 0, which is the same chain (k = 3/2)."""
    wave = homogenize(Dimer("m1", "m2"), k="3/2").pde.traveling_wave()
    w = sp.Symbol("w", positive=True)
    heavy_first = sp.limit(wave.at(m1=1, m2=w, D=1).beta, w, 0)
    light_first = sp.limit(wave.at(m1=w, m2=1, D=1).beta, w, 0)
    assert heavy_first == sp.sqrt(10) / 10
    assert light_first == sp.sqrt(6) / 4
    full = homogenize(Dimer("m1", "m2"), k="3/2", closure="full", field="center").pde
    beta = full.traveling_wave().at(D=1).beta
    m1, m2 = full.cell.masses
    assert sp.limit(beta.subs({m1: 1, m2: w}), w, 0) == sp.sqrt(10) / 10
    assert sp.limit(beta.subs({m1: w, m2: 1}), w, 0) == sp.sqrt(10) / 10
