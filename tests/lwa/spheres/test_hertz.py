"""Hertz's A and the cells of spheres: the paper's formula and its limits."""

import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Material, Sphere
from lwa.spheres.hertz import stiffness
from tests.identity import same

E1, E2, R1, R2, m1, m2 = sp.symbols("E1 E2 R1 R2 m1 m2", positive=True)
n1, n2 = sp.symbols("n1 n2", real=True)
FIRST, SECOND = Sphere(m1, R1, Material(E1, n1)), Sphere(m2, R2, Material(E2, n2))

sizes = st.fractions(min_value="1/1000", max_value=1000, max_denominator=1000)
ratios = st.fractions(min_value="-99/100", max_value="1/2", max_denominator=100)
spheres = st.builds(Sphere, sizes, sizes, st.builds(Material, sizes, ratios))


def test_the_formula_as_the_paper_writes_it():
    A = 4 * E1 * E2 * sp.sqrt(R1 * R2 / (R1 + R2)) / (3 * (E2 * (1 - n1**2) + E1 * (1 - n2**2)))
    assert same(stiffness(FIRST, SECOND), A)
    assert stiffness(FIRST, SECOND) == stiffness(SECOND, FIRST)


def test_a_wall_is_a_sphere_of_infinite_radius():
    limit = sp.limit(stiffness(FIRST, SECOND), R2, sp.oo)
    assert same(limit, stiffness(FIRST, SECOND.material))


@given(st.lists(spheres, min_size=1, max_size=4))
def test_a_cell_is_as_long_as_its_spheres(row):
    cell = Cell.of_spheres(row)
    assert cell.masses == tuple(sphere.mass for sphere in row)
    assert cell.size * cell.spacing == sum(2 * sphere.radius for sphere in row)
    for i, A in enumerate(cell.stiffnesses):  # the last one joins the cell to the next
        assert stiffness(row[i], row[(i + 1) % len(row)]) == A
