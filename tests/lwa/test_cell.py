"""The periodic cell: shares, effective stiffness, refusals."""

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Dimer, InputError

positive_fractions = st.fractions(min_value="1/100", max_value=100, max_denominator=100)


@given(st.lists(positive_fractions, min_size=1, max_size=5))
def test_fractions_sum_to_one(masses):
    cell = Cell(masses)
    assert sum(cell.fractions) == 1
    assert cell.mass == sum(sp.Rational(m.numerator, m.denominator) for m in masses)


def test_shares_make_all_contact_forces_equal():
    A1, A2, A3, k = sp.symbols("A1 A2 A3 k", positive=True)
    cell = Cell([1, 1, 1], stiffnesses=[A1, A2, A3])
    shares = cell.shares(k)
    assert sp.simplify(sum(shares) - 3) == 0
    for A, c in zip(cell.stiffnesses, shares, strict=True):
        # A_i c_i^k = A_eff, at numbers: sympy does not merge the powers of a sum
        numbers = {A1: 2, A2: 3, A3: 5, k: sp.Rational(3, 2)}
        assert abs(sp.N((A * c**k / cell.stiffness(k) - 1).subs(numbers), 40)) < 1e-35


def test_equal_contacts_have_shares_one():
    A = sp.Symbol("A", positive=True)
    cell = Cell([1, 2], stiffnesses=[A, A])
    assert cell.shares() == (1, 1)
    assert cell.stiffness() == A


def test_a_cell_is_a_value():
    assert Dimer(1, 2) == Cell((1, 2))
    assert hash(Dimer(1, 2)) == hash(Cell([1, 2]))
    with pytest.raises(AttributeError):
        Dimer(1, 2).masses = (1, 1)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (dict(masses=[]), "at least one mass"),
        (dict(masses=[1, 0]), "mass 2 is 0"),
        (dict(masses=[1, float("nan")]), "mass 2 is nan"),
        (dict(masses=[1, 2], stiffnesses=[1]), "1 stiffnesses for 2 masses"),
        (dict(masses=[1, 2], stiffnesses=[1, -3]), "stiffness 2 is -3"),
        (dict(masses=[1, 2], spacing=0), "spacing is 0"),
        (dict(masses=["k", 1]), "'k': the name means the exponent"),
        (dict(masses="m1,m2"), "a sequence"),
        (dict(masses=3), "a sequence"),
    ],
)
def test_impossible_cells_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        Cell(**arguments)


def test_the_N_to_one_dimer():
    assert Dimer("a", "b", N=3) == Cell(["a", "a", "a", "b"])
    for N in (0, -1, 1.5, True):
        with pytest.raises(InputError, match="N is"):
            Dimer(1, 2, N=N)
