"""From a cell to its theory: shares, mass ratios, decimals, progress, particles in any order."""

import pytest
import sympy as sp
from hypothesis import given, strategies as st

from lwa import Cell, Dimer, InputError, homogenize
from tests.commands import terminal


def test_cells_of_two_masses():
    m1, m2, omega = sp.symbols("m1 m2 omega", positive=True)
    assert Dimer("a", "b", N=3) == Cell(["a", "a", "a", "b"])
    assert Dimer(m1, m2, N=2).at(omega="w").masses[-1] == m1 * sp.Symbol(
        "w", positive=True
    )
    assert Dimer(m1, m2).at(m2=6, omega=3).masses == (2, 6)
    assert Dimer(1, omega).at(omega=3).masses == (1, 3)  # a symbol of the caller's


def test_the_closure_is_the_papers_where_the_paper_has_one():
    def chosen(*masses, **kind):
        closure = homogenize(Cell(masses), **kind).closure
        return closure.name, closure.field

    assert chosen("m") == chosen(1, 2) == chosen(1, 2, branch="optical")
    assert chosen(1, 2) == ("linear", "first")
    assert chosen(1, 2, 3) == chosen(1, 2, closure="full") == ("full", "center")
    theories = [homogenize(Cell(m), k="5/2") for m in ((1, 2, 3), (2, 3, 1), (3, 1, 2))]
    assert "closure='full', branch='acoustic', field='center'" in repr(theories[0])
    # one chain, whichever bead is called the first
    assert len({theory.pde.I for theory in theories}) == 1


def test_derivations_are_refused_by_an_estimate_of_their_terms():
    """Four masses: 420,000 terms at order 10, in half a gigabyte, and twice as many at 11."""
    cell = Cell(["a", "b", "c", "d"])
    assert homogenize(cell, 10).order == 10
    with pytest.raises(InputError, match="order is 11"):
        homogenize(cell, 11)


def test_high_orders_show_their_progress_on_a_terminal(capsys):
    def derived(order):
        return homogenize(Dimer(1, 2), order, k="3/2").pde.coefficients

    # One that says no size, as that of `docker exec`.
    with terminal(0, 0) as shown:
        assert derived(11)
        assert shown() == ""
        assert derived(12)
        assert "orders:" in shown()
    assert derived(12)
    assert capsys.readouterr().err == ""


values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


@given(st.lists(values, min_size=2, max_size=4), st.integers(1, 3))
def test_the_canonical_equation_is_the_same_from_every_particle(masses, n):
    """Particles named anew change the field that the wave equation is about, and no wave."""
    n %= len(masses)
    found, again = (
        homogenize(Cell(cell), 7, k="3/2", closure="full").pde.coefficients
        for cell in (masses, masses[n:] + masses[:n])
    )
    assert found.keys() == again.keys()
    assert all(dict(terms) == dict(again[n]) for n, terms in found.items())
