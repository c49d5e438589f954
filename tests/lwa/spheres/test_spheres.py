"""Hertz's A, cells of spheres, materials by name, and the masses of beads from densities."""

import math

import pytest
import sympy as sp
from hypothesis import given, strategies as st

from lwa import Cell, Material, Sphere
from lwa.spheres import beads
from lwa.spheres.hertz import MATERIALS, stiffness
from tests.identity import same

E1, E2, R1, R2, m1, m2 = sp.symbols("E1 E2 R1 R2 m1 m2", positive=True)
n1, n2 = sp.symbols("n1 n2", real=True)
FIRST, SECOND = Sphere(m1, R1, Material(E1, n1)), Sphere(m2, R2, Material(E2, n2))

sizes = st.fractions(min_value="1/1000", max_value=1000, max_denominator=1000)
ratios = st.fractions(min_value="-99/100", max_value="1/2", max_denominator=100)
spheres = st.builds(Sphere, sizes, sizes, st.builds(Material, sizes, ratios))


def test_the_formula_as_the_paper_writes_it():
    A = (
        4
        * E1
        * E2
        * sp.sqrt(R1 * R2 / (R1 + R2))
        / (3 * (E2 * (1 - n1**2) + E1 * (1 - n2**2)))
    )
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


RANGES = {  # E in GPa and density in Mg/m³ of Gere & Goodno, Mechanics of Materials, appendix
    "steel 316": (190, 210, 7.7, 8.1),
    "steel 440C": (190, 210, 7.6, 7.9),
    "aluminium": (68, 79, 2.6, 2.8),
    "brass": (96, 110, 8.4, 8.6),
    "glass": (48, 83, 2.4, 2.8),
    "PTFE": (0.4, 1.8, 2.1, 2.3),
    "delrin": (2.8, 3.4, 1.40, 1.43),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_a_material_is_one_of_its_kind(name):
    low, high, light, heavy = RANGES[name]
    material = Material.named(name)
    assert low <= material.E / 10**9 <= high
    assert light <= material.density / 1000 <= heavy
    assert sp.Rational(1, 5) < material.nu < sp.S.Half


@pytest.mark.parametrize(("name", "mass"), [("steel", 0.45e-3), ("PTFE", 0.123e-3)])
def test_the_papers_beads_have_the_papers_masses(name, mass):
    """4.76 mm in diameter; the masses are given to 0.01 g and 0.001 g."""
    sphere = Sphere.solid("2.38e-3", Material.named(name))
    assert float(sphere.mass) == pytest.approx(mass, rel=0.012)


def read(**tables):
    """The bead of a file's tables."""
    (sphere,) = beads.spheres({"chain": {"cell": ["ball"]}} | tables)
    return sphere


def ball(**more):
    return {"ball": {"radius": 0.01, "material": "steel 316"} | more}


def test_a_bead_takes_a_mass_a_density_or_that_of_its_material():
    volume = 4 * math.pi / 3 * 1e-6
    for bead, mass in (
        (ball(), 8000 * volume),
        (ball(density=7970.0), 7970 * volume),
        (ball(mass=0.03), 0.03),
    ):
        sphere = read(beads=bead)
        assert float(sphere.mass) == pytest.approx(mass, rel=1e-14)
        assert sphere.material == Material.named("steel 316")


def test_a_file_may_change_a_material_or_have_its_own_of_the_same_name():
    own = {"steel 316": {"E": 200e9, "nu": 0.29, "density": 7900.0}}
    sphere = read(beads=ball(), materials=own)
    assert sphere.material == Material("200e9", "0.29", 7900)
    like = {"soft": {"like": "PTFE", "E": 0.6e9}}
    sphere = read(beads=ball(material="soft"), materials=like)
    assert sphere.material == Material.named("PTFE", E="0.6e9")
