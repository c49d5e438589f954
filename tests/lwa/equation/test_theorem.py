"""One number I for every cell: the minimum of the elastic energy S(e), by an independent route.

Proof in the book's chapter "One number": with w_i = φ + D² e_i φ_xx + …, Σ μ_i e_i = 0, the elastic
energy at D² is k A φ_x^{k-1} φ_xx² S(e), and I/D² = -(2/P) min S.
"""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dispersion, general, homogenize

weights = st.integers(1, 30)


@st.composite
def cells(draw):
    """Cells of 1 to 5 beads whose shares are rational at k = 3/2."""
    size = draw(st.integers(1, 5))
    masses, roots = (draw(st.lists(weights, min_size=size, max_size=size)) for _ in "mA")
    return Cell(masses, stiffnesses=[root**3 for root in roots])


def least(cell, k):
    """-(2/P) min S(e) on Σ μ_i e_i = 0, by a Lagrange multiplier."""
    P = cell.size
    roots = [A ** (-1 / k) for A in cell.stiffnesses]
    c = [P * root / sum(roots) for root in roots]
    e, multiplier = sp.symbols(f"e:{P}"), sp.Symbol("multiplier")
    after = [*e[1:], e[0]]
    S = sum(
        -(share**3) / 24 - share * (here + there) / 2 + (there - here) ** 2 / (2 * share)
        for share, here, there in zip(c, e, after, strict=True)
    )
    mean = sum(m * e_i for m, e_i in zip(cell.masses, e, strict=True))
    equations = [sp.diff(S + multiplier * mean, e_i) for e_i in e] + [mean]
    (found,) = sp.solve(equations, [*e, multiplier], dict=True)
    return -2 * S.subs(found) / P


@given(cells())
@settings(max_examples=12, deadline=None)
def test_the_minimum_is_that_of_the_full_closure_and_of_blochs_branch(cell):
    k = sp.Rational(3, 2)
    pde = homogenize(cell, k=k, closure="full", field="center").pde
    I = pde.I / pde.cell.spacing**2
    assert sp.simplify(I - least(cell, k)) == 0
    assert sp.simplify(I - Dispersion(cell, k).I) == 0
    assert (pde.G - pde.I * (k - 1) * (k - 2) / 2).equals(0)
    assert (pde.H - 2 * pde.I * (k - 1)).equals(0)


@given(st.lists(weights, min_size=1, max_size=4))
@settings(max_examples=6, deadline=None)
def test_any_law_has_the_same_number_in_equal_contacts(masses):
    cell = Cell(masses)
    pde = homogenize(cell, law=general(), closure="full", field="center").pde
    phi2, phi3 = sp.symbols("phi2 phi3", real=True)
    assert sp.simplify(pde.I / pde.cell.spacing**2 - least(cell, sp.S.One)) == 0
    assert sp.simplify(pde.H - 2 * phi2 * pde.I) == 0
    assert sp.simplify(pde.G - phi3 * pde.I / 2) == 0
