"""Momentum, energy and the potential of the wave equation, against calculus on explicit fields."""

import pytest
import sympy as sp
from sympy.calculus.euler import euler_equations

from lwa import Cell, D, Dimer, homogenize
from lwa.equation.terms import Jet
from tests.lwa.fields import energy_density, right_side

x = sp.Symbol("x")
m1, m2 = sp.symbols("m1 m2", positive=True)


def at_a_point(expression, u):
    """The expression for a polynomial u with all jets alive, at x = 1/3."""
    field = 2 * x + sum(x**n / sp.prime(n) for n in range(2, 11))
    return sp.nsimplify(expression.subs(u, field).doit().subs(x, sp.Rational(1, 3)))


def variational(pde):
    """Whether u_ττ = R is -δV/δu: R is homogeneous of degree k in u, so V is -∫ u R/(k+1) dx."""
    u = sp.Function("u")(x)
    R = right_side(pde, u, x)
    (slope,) = euler_equations(u * R / (pde.k + 1), u, x)
    return at_a_point(slope.lhs - R, u) == 0


@pytest.mark.parametrize("k", [2, 3])
def test_the_canonical_field_has_an_energy_at_third_order(k):
    pde = homogenize(Dimer(3, 1, spacing=1), 4, k=k, closure="full", field="center").pde
    assert variational(pde)
    u = sp.Function("u")(x)
    p = u.diff(x)
    density = p ** (k + 1) / (k * (k + 1)) - pde.I / 2 * p ** (k - 1) * p.diff(x) ** 2
    assert sp.simplify(energy_density(pde, u, x) - density) == 0
    (slope,) = euler_equations(density, u, x)
    assert at_a_point(slope.lhs + right_side(pde, u, x), u) == 0
    ((jet, coefficient),) = pde.energy[2].items()
    assert (jet, coefficient) == (Jet(((2, 2),)), -pde.I / 2)


@pytest.mark.parametrize(
    ("cell", "order", "kind", "conservative"),
    [
        (Dimer("m1", "m2"), 8, {"closure": "full", "field": "center"}, True),
        (Cell(["m1", "m1", "m2"]), 8, {"closure": "full", "field": "center"}, True),
        # three different masses have no mirror symmetry and even orders from D^{k+4} on
        (Cell([1, 2, 3]), 8, {"closure": "full", "field": "center"}, True),
        (Dimer("m1", "m2"), 4, {"closure": "full"}, True),
        (Dimer("m1", "m2"), 6, {"closure": "full"}, False),
        (Dimer("m1", "m2"), 3, {}, False),  # asked of D^{k+3} at least
        (Dimer("m1", "m2"), 4, {"branch": "optical"}, False),
    ],
)
def test_which_equations_conserve_momentum(cell, order, kind, conservative):
    """The canonical field's at every order, the first field's up to the third order only."""
    pde = homogenize(cell, order, **kind).pde
    assert pde.conservative == conservative
    if cell == Cell([1, 2, 3]):
        assert pde.vanishing == (2,)


@pytest.mark.parametrize(("masses", "conservative"), [((1, 1), True), ((3, 1), False)])
def test_conservation_form_agrees_with_the_euler_operator(masses, conservative):
    pde = homogenize(Dimer(*masses), order=4, k=3).pde
    u = sp.Function("u")(x)
    # at a polynomial with all jets alive: an expression that vanishes does so for any field
    (slope,) = euler_equations(right_side(pde, u, x), u, x)
    value = at_a_point(slope.lhs.subs(D, 1), u)
    assert (value == 0) == conservative == pde.conservative
