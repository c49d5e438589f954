"""The energy of any order: conserved at the rate of its closure, in every field.

What is checked shares nothing with the derivation: for explicit periodic fields the energy of a
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

x, s, D = sp.symbols("x s D")
FIELD = x + sp.sin(x) / 5 + sp.cos(2 * x) / 17
VELOCITY = sp.cos(x) / 3 + sp.sin(2 * x) / 4


def order_of_the_drift(pde):
    """n of d/dτ ∫ e dx ∝ D^n, from two small D; infinite where the energy is constant."""
    spacing = pde.cell.spacing
    force = right_side(pde, FIELD, x, VELOCITY)
    density = energy_density(pde, FIELD + s * VELOCITY, x, VELOCITY + s * force)
    change = sp.lambdify((x, spacing), density.diff(s).subs(s, 0), "mpmath", cse=True)
    with mpmath.workdps(60):
        points = [2 * mpmath.pi * i / 96 for i in range(96)]
        left = [
            abs(mpmath.fsum(change(point, mpmath.mpf(10) ** -d) for point in points))
            for d in (3, 4)
        ]
        if max(left) < mpmath.mpf(10) ** -50:  # 60 digits, less the trapezia's error
            return math.inf
        return float(mpmath.log10(left[0] / left[1]))


TODA = named("exponential", 1 / lwa.D)  # the compression D u_x of a contact is of order 1 in 1/a
CASES = [
    (Cell([1]), 6, "3/2", {}),
    (Dimer(3, 1), 4, "3/2", {"closure": "full"}),
    (Dimer(3, 1), 6, 2, {"closure": "full", "field": "center"}),
    (Cell([1, 2, 3], [1, 2, 3]), 5, 1, {"closure": "full"}),
    (Dimer(3, 1), 5, TODA, {"closure": "full"}),
    (Cell([1, 2, 3]), 4, TODA, {"closure": "full", "field": "center"}),
]


@pytest.mark.parametrize(("cell", "order", "law", "kind"), CASES)
def test_the_energy_is_conserved_to_the_order_of_its_closure(cell, order, law, kind):
    pde = homogenize(cell, order, law=law if law is TODA else Power(law), **kind).pde
    assert set(pde.energy) == set(range(order - 1))
    # at least: the next order may vanish
    assert order_of_the_drift(pde) > order - 1 - 1e-2  # of the slope between two D


def test_the_energy_of_the_linear_closure_without_a_defect():
    """Below D^{k+3} it is that of the full closure."""
    linear, full = (homogenize(Dimer(3, 1), 3, closure=name).pde for name in ("linear", "full"))
    assert linear.energy == full.energy
