"""The same chain described from another particle.

Naming the particles of a cell anew changes which field the wave equation is about; a wave cannot
depend on it. The canonical field's equation stays, and with it β and the speed; the paper's linear
closure keeps I only.
"""

from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, homogenize

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
