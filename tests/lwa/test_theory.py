"""One call from a cell to its theory: decimals, progress, particles in any order."""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, homogenize
from tests.commands import terminal


def test_floats_enter_as_their_decimals():
    assert (
        homogenize(Dimer(0.45, 0.123), k=1.5).pde.I
        == homogenize(Dimer("9/20", "123/1000"), k="3/2").pde.I
    )
    assert not homogenize(Dimer(0.1, 0.7), k=1.1).pde.G.has(sp.Float)


def test_high_orders_show_their_progress_on_a_terminal(capsys):
    with terminal() as shown:
        homogenize(Dimer(1, 2), 11, k="3/2")
        assert shown() == ""
        homogenize(Dimer(1, 2), 12, k="3/2")
        assert "orders:" in shown()
    homogenize(Dimer(1, 2), 12, k="3/2")
    assert capsys.readouterr().err == ""


values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


@given(st.lists(values, min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=10)
def test_the_canonical_equation_is_the_same_from_every_particle(masses, n):
    """Particles named anew change the field that the wave equation is about, and no wave."""
    n %= len(masses)
    found, again = (
        homogenize(Cell(cell), 7, k="3/2", closure="full", field="center").pde.coefficients
        for cell in (masses, masses[n:] + masses[:n])
    )
    assert {n: dict(terms) for n, terms in found.items()} == {
        n: dict(terms) for n, terms in again.items()
    }
