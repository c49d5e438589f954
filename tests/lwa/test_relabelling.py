"""The same chain described from another particle.

Naming the particles of a cell anew changes which field the wave equation is about; a wave cannot
depend on it. The canonical field's equation stays, and with it β and the speed; the paper's linear
closure keeps I only.
"""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, homogenize

values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


@given(st.lists(values, min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=10)
def test_the_canonical_equation_is_the_same_from_every_particle(masses, n):
    n %= len(masses)
    found, again = (
        homogenize(Cell(cell), 7, k="3/2", closure="full", field="center").pde.coefficients
        for cell in (masses, masses[n:] + masses[:n])
    )
    assert {n: dict(terms) for n, terms in found.items()} == {
        n: dict(terms) for n, terms in again.items()
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
