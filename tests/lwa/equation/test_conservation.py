"""Momentum and energy of the wave equation, against calculus on explicit fields.

What is checked shares nothing with the derivation. For explicit periodic fields the energy of a
period is differentiated along the wave equation by SymPy's calculus and integrated by trapezia,
which are exact to the digits carried here. What an energy to D^{order-2} leaves is D^{order-1}.
"""

import math

import mpmath
import pytest
import sympy as sp
from sympy.calculus.euler import euler_equations

import lwa
from lwa import Cell, Dimer, Power, homogenize
from lwa.law import named
from tests.lwa.fields import energy_density, right_side

x, s = sp.symbols("x s")
FULL = {"closure": "full", "field": "first"}
CANONICAL = FULL | {"field": "center"}


@pytest.mark.parametrize(
    ("cell", "order", "kind", "conservative"),
    [
        (Dimer("m1", "m2"), 8, CANONICAL, True),
        (Cell(["m1", "m1", "m2"]), 8, CANONICAL, True),
        # three different masses have no mirror symmetry and even orders from D^{k+4} on
        (Cell([1, 2, 3]), 8, CANONICAL, True),
        (Dimer("m1", "m2"), 4, FULL, True),
        (Dimer("m1", "m2"), 6, FULL, False),
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
def test_momentum_is_conserved_where_the_euler_operator_vanishes(masses, conservative):
    pde = homogenize(Dimer(*masses), order=4, k=3).pde
    u = sp.Function("u")(x)
    (slope,) = euler_equations(right_side(pde, u, x), u, x)
    # at a polynomial with all jets alive: an expression that vanishes does so for any field
    field = 2 * x + sum(x**n / sp.prime(n) for n in range(2, 11))
    value = sp.nsimplify(
        slope.lhs.subs(lwa.D, 1).subs(u, field).doit().subs(x, sp.Rational(1, 3))
    )
    assert (value == 0) == conservative == pde.conservative


FIELD = x + sp.sin(x) / 5 + sp.cos(2 * x) / 17
VELOCITY = sp.cos(x) / 3 + sp.sin(2 * x) / 4


def order_of_the_drift(pde):
    """n of d/dτ ∫ e dx ∝ D^n, from two small D; infinite where the energy is constant."""
    force = right_side(pde, FIELD, x, VELOCITY)
    density = energy_density(pde, FIELD + s * VELOCITY, x, VELOCITY + s * force)
    change = sp.lambdify(
        (x, pde.cell.spacing), density.diff(s).subs(s, 0), "mpmath", cse=True
    )
    with mpmath.workdps(60):
        points = [2 * mpmath.pi * i / 96 for i in range(96)]
        left = [
            abs(mpmath.fsum(change(point, mpmath.mpf(10) ** -d) for point in points))
            for d in (3, 4)
        ]
        if max(left) < mpmath.mpf(10) ** -50:  # 60 digits, less the trapezia's error
            return math.inf
        return float(mpmath.log10(left[0] / left[1]))


TODA = named(
    "exponential", 1 / lwa.D
)  # the compression D u_x of a contact is of order 1 in 1/a


@pytest.mark.parametrize(
    ("cell", "order", "law", "kind"),
    [
        (Cell([1]), 4, Power("3/2"), {}),
        (Dimer(3, 1), 4, Power("3/2"), FULL),
        (Dimer(3, 1), 6, Power(2), CANONICAL),
        (Cell([1, 2, 3], [1, 2, 3]), 5, Power(1), FULL),
        (Dimer(3, 1), 5, TODA, FULL),
        (Cell([1, 2, 3]), 4, TODA, CANONICAL),
    ],
)
def test_the_energy_is_conserved_to_the_order_of_its_closure(cell, order, law, kind):
    pde = homogenize(cell, order, law=law, **kind).pde
    assert set(pde.energy) == set(range(order - 1))
    # at least: the next order may vanish
    assert order_of_the_drift(pde) > order - 1 - 1e-2  # of the slope between two D


def test_the_energy_of_the_linear_closure_without_a_defect():
    """Below D^{k+3} it is that of the full closure."""
    linear, full = (
        homogenize(Dimer(3, 1), 3, closure=name).pde for name in ("linear", "full")
    )
    assert linear.energy == full.energy
