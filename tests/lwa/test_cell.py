"""The periodic cell: equal forces, N:1 dimers, ratios of masses."""

import sympy as sp

from lwa import Cell, Dimer
from tests.identity import same


def test_shares_make_all_contact_forces_equal():
    A1, A2, A3, k = sp.symbols("A1 A2 A3 k", positive=True)
    cell = Cell([1, 1, 1], stiffnesses=[A1, A2, A3])
    shares = cell.shares(k)
    assert same(sum(shares), 3)
    for A, c in zip(cell.stiffnesses, shares, strict=True):
        # A_i c_i^k = A_eff, at numbers: sympy does not merge the powers of a sum
        numbers = {A1: 2, A2: 3, A3: 5, k: sp.Rational(3, 2)}
        assert abs(sp.N((A * c**k / cell.stiffness(k) - 1).subs(numbers), 40)) < 1e-35


def test_the_N_to_one_dimer():
    assert Dimer("a", "b", N=3) == Cell(["a", "a", "a", "b"])


def test_omega_replaces_a_mass():
    m1, m2, omega = sp.symbols("m1 m2 omega", positive=True)
    assert Dimer(m1, m2, N=2).at(omega="w").masses[-1] == m1 * sp.Symbol("w", positive=True)
    assert Dimer(m1, m2).at(m2=6, omega=3).masses == (2, 6)
    assert Dimer(1, omega).at(omega=3).masses == (1, 3)  # a symbol of the caller's
