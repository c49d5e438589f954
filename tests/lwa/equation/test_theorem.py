"""The canonical equation of every cell: G = I(k-1)(k-2)/2, H = 2I(k-1), I the linear chain's.

Write the field of particle i, which sits at x_i = c_0 + … + c_{i-1}, as
w_i = e^{x_i D∂} (φ + D² e_i φ_xx + …) with Σ μ_i e_i = 0, which defines φ. The kinetic energy of a
cell is φ_t²/2 to D², and of the elastic energy at D² one monomial is left,
k A φ_x^{k-1} φ_xx² S(e). So the equation is that of one density for every cell, and e minimises a
form that does not know k.
"""

from itertools import pairwise

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dispersion, homogenize

K = 2
"""The exponent of the closures below: A_i = c_i^{-2} is rational where the share c_i is."""

fractions = st.fractions("1/9", 9, max_denominator=9).map(sp.Rational)
beads = st.lists(st.tuples(fractions, fractions), min_size=1, max_size=6)


def least(masses, shares):
    """The minimum of S(e) under Σ μ_i e_i = 0, exactly: stationary with a multiplier."""
    P, total = len(shares), sum(masses)
    e = sp.symbols(f"e0:{P}")
    around = [*e, e[0]]
    S = sum(
        -(c**3) / 24 - c * (a + b) / 2 + (b - a) ** 2 / (2 * c)
        for c, (a, b) in zip(shares, pairwise(around), strict=True)
    )
    held, multiplier = (
        sum(m / total * a for m, a in zip(masses, e, strict=True)),
        sp.Symbol("l"),
    )
    equations = [sp.diff(S + multiplier * held, a) for a in e] + [held]
    (found,) = sp.linsolve(equations, [*e, multiplier])
    return S.subs(dict(zip(e, found, strict=False)))


@settings(max_examples=4)
@given(beads)
def test_the_coefficient_is_the_minimum_and_the_linear_chains(beads):
    """I/D² = -(2/P) min S, and that of the acoustic branch Ω² = κ² (1 - Iκ² + …)."""
    masses, shares = zip(*beads, strict=True)
    P, total = len(shares), sum(shares)
    shares = [P * c / total for c in shares]
    chain = Cell(masses, [c**-K for c in shares], 1)
    I = -sp.Rational(2, P) * least(masses, shares)
    assert Dispersion(chain, K).I == I
    assert (
        Dispersion(Cell(masses, [1 / c for c in shares], 1)).I == I
    )  # springs of these shares


@pytest.mark.parametrize("k", [K, "k"])
@pytest.mark.parametrize("P", [1, 2, 3, 4, 5, 6])
def test_the_closure_comes_to_the_same_equation(k, P):
    """The recursion on P fields, which uses no energy, for equal and for unlike contacts."""
    masses = [sp.Rational(3 * i * i + 2, i + 4) for i in range(P)]
    shares = [sp.Rational(i + 1, 2 + i % 3) for i in range(P)] if k == K else [1] * P
    shares = [P * sp.sympify(c) / sum(shares) for c in shares]
    chain = Cell(masses, [c**-K for c in shares], 1)
    pde = homogenize(chain, 4, k=k, closure="full", field="center").pde
    I = -sp.Rational(2, P) * least(masses, shares)
    k = pde.k
    assert pde.I == I
    assert sp.expand(pde.G - I * (k - 1) * (k - 2) / 2) == 0
    assert sp.expand(pde.H - 2 * I * (k - 1)) == 0
