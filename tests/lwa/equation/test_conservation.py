"""Momentum, energy and the potential of the wave equation, against calculus on explicit fields."""

import pytest
import sympy as sp
from sympy.calculus.euler import euler_equations

from lwa import Cell, D, Dimer, InputError, homogenize
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


def test_the_canonical_field_is_in_conservation_form_at_every_order():
    for cell in (Dimer("m1", "m2"), Cell(["m1", "m1", "m2"])):
        assert homogenize(cell, 8, closure="full", field="center").pde.conservative
    # three different masses have no mirror symmetry and even orders from D^{k+4} on
    chiral = homogenize(Cell([1, 2, 3]), 8, closure="full", field="center").pde
    assert chiral.conservative
    assert chiral.vanishing == (2,)


def test_the_first_field_of_the_full_closure_conserves_momentum_up_to_third_order_only():
    assert homogenize(Dimer("m1", "m2"), 4, closure="full").pde.conservative
    assert not homogenize(Dimer("m1", "m2"), 6, closure="full").pde.conservative


def test_the_optical_branch_does_not_conserve_momentum():
    pde = homogenize(Dimer("m1", "m2"), branch="optical").pde
    assert not pde.conservative
    with pytest.raises(InputError, match="acoustic"):
        pde.traveling_wave()


@pytest.mark.parametrize(("masses", "conservative"), [((1, 1), True), ((3, 1), False)])
def test_conservation_form_agrees_with_the_euler_operator(masses, conservative):
    pde = homogenize(Dimer(*masses), order=4, k=3).pde
    u = sp.Function("u")(x)
    # at a polynomial with all jets alive: an expression that vanishes does so for any field
    (slope,) = euler_equations(right_side(pde, u, x), u, x)
    value = at_a_point(slope.lhs.subs(D, 1), u)
    assert (value == 0) == conservative == pde.conservative
