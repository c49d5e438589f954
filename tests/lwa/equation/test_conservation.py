"""Momentum and energy of the wave equation, against calculus on explicit fields.

What is checked shares nothing with the derivation. For explicit periodic fields the energy of a
period is differentiated along the wave equation by SymPy's calculus and integrated by trapezia,
which are exact to the digits carried here. What an energy to D^{order-2} leaves is D^{order-1}.
"""

import math

import mpmath
import pytest
import sympy as sp

import lwa
from lwa import Cell, Dimer, Power, homogenize
from lwa.law import named
from tests.lwa.fields import energy_density, right_side

x, s = sp.symbols("x s")
FIRST = {"closure": "full", "field": "first"}
GENERAL = FIRST | {"law": lwa.general()}
CANONICAL = {"closure": "full"}
DIMER, TRIMER = Dimer("m1", "m2"), Cell([1, 2, 3])


@pytest.mark.parametrize(
    ("cell", "order", "kind", "conservative"),
    [
        (DIMER, 8, CANONICAL, True),
        (Cell(["m1", "m1", "m2", "m2"]), 6, CANONICAL, True),
        # three different masses have no mirror symmetry and even orders from D^{k+4} on
        (TRIMER, 8, CANONICAL, True),
        (DIMER, 4, FIRST, True),
        (DIMER, 6, FIRST, False),
        (DIMER, 6, GENERAL, False),
        (TRIMER, 5, GENERAL, False),
        (DIMER, 3, {}, False),  # asked of D^{k+3} at least
        (DIMER, 4, {"branch": "optical"}, False),
    ],
)
def test_which_equations_conserve_momentum(cell, order, kind, conservative):
    """The canonical field's at every order, the first field's up to the third order only."""
    pde = homogenize(cell, order, **kind).pde
    assert pde.conservative == conservative
    if cell == TRIMER:
        assert pde.vanishing == (2,)


FIELD = x + sp.sin(x) / 5 + sp.cos(2 * x) / 17
VELOCITY = sp.cos(x) / 3 + sp.sin(2 * x) / 4


def order_of_the_drift(pde):
    """n of d/dτ ∫ e dx ∝ D^n, from two small D; infinite where the energy is constant."""
    force = right_side(pde, FIELD, x, VELOCITY)
    density = energy_density(pde, FIELD + s * VELOCITY, x, VELOCITY + s * force)
    rate = density.diff(s).subs(s, 0)
    change = sp.lambdify((x, pde.cell.spacing), rate, "mpmath", cse=True)
    left = []
    with mpmath.workdps(60):
        for D in (mpmath.mpf("1e-3"), mpmath.mpf("1e-4")):
            total = sum(change(2 * mpmath.pi * i / 96, D) for i in range(96))
            left.append(abs(total))
        if max(left) < mpmath.mpf(10) ** -50:  # 60 digits, less the trapezia's error
            return math.inf
        return float(mpmath.log10(left[0] / left[1]))


# the compression D u_x of a contact is of order 1 in 1/a
TODA = named("exponential", 1 / lwa.D)


@pytest.mark.parametrize(
    ("cell", "order", "law", "kind"),
    [
        (Cell([1]), 4, Power("3/2"), {}),
        (Dimer(3, 1), 4, Power("3/2"), FIRST),
        (Dimer(3, 1), 6, Power(2), CANONICAL),
        (Cell([1, 2, 3], [1, 2, 3]), 5, Power(1), FIRST),
        (Dimer(3, 1), 5, TODA, FIRST),
        (TRIMER, 4, TODA, CANONICAL),
    ],
)
def test_the_energy_is_conserved_to_the_order_of_its_closure(cell, order, law, kind):
    pde = homogenize(cell, order, law=law, **kind).pde
    assert set(pde.energy) == set(range(order - 1))
    for jet in set().union(*pde.energy.values()):
        (*_, (_, power)) = jet.t or jet.x
        assert power > 1  # of the highest derivative: no term is less by parts
    # at least: the next order may vanish
    assert order_of_the_drift(pde) > order - 1 - 1e-2  # of the slope between two D
