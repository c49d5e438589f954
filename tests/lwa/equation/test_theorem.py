"""The canonical equation of every cell: G = I(k-1)(k-2)/2, H = 2I(k-1), I the linear chain's.

Write the field of particle i, which sits at x_i = c_0 + … + c_{i-1}, as
w_i = e^{x_i D∂} (φ + D² e_i φ_xx + …) with Σ μ_i e_i = 0, which defines φ. The kinetic energy of a
cell is φ_t²/2 to D², and of the elastic energy at D² one monomial is left,
k A φ_x^{k-1} φ_xx² S(e). So the equation is that of one density for every cell, and e minimises a
form that does not know k.
"""

import pytest
import sympy as sp

from lwa import Cell, Dispersion, homogenize
from tests.identity import same


def least(masses, shares):
    """The minimum of S(e) under Σ μ_i e_i = 0, exactly: stationary with a multiplier."""
    P = len(shares)
    e = sp.symbols(f"e0:{P}")
    S = 0
    for i, c in enumerate(shares):
        here, there = e[i], e[(i + 1) % P]
        S += (there - here) ** 2 / (2 * c) - c * (here + there) / 2 - c**3 / 24
    multiplier = sp.Symbol("multiplier")
    mean = sum(m * e_i for m, e_i in zip(masses, e, strict=True)) / sum(masses)
    equations = [mean]
    for e_i in e:
        equations.append(sp.diff(S + multiplier * mean, e_i))
    (found,) = sp.linsolve(equations, [*e, multiplier])
    return S.subs(dict(zip(e, found[:P], strict=True)))


@pytest.mark.parametrize("k", [2, "k"])
@pytest.mark.parametrize("P", [1, 2, 3, 4, 5, 6])
def test_the_closure_comes_to_the_equation_of_one_density(k, P):
    """The recursion on P fields uses no energy. Contacts are unlike at k = 2, else equal."""
    masses, shares = [], []
    for i in range(P):
        masses.append(sp.Rational(3 * i * i + 2, i + 4))
        shares.append(sp.Rational(i + 1, 2 + i % 3) if k == 2 else sp.S.One)
    shares = [P * c / sum(shares) for c in shares]
    chain = Cell(masses, [1 / c**2 for c in shares], 1)
    pde = homogenize(chain, 4, k=k, closure="full").pde
    I = -sp.Rational(2, P) * least(masses, shares)
    assert pde.I == Dispersion(chain, k).I == I
    assert same(pde.G, I * (pde.k - 1) * (pde.k - 2) / 2)
    assert same(pde.H, 2 * I * (pde.k - 1))
