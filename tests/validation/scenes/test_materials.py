"""Hertz contacts: the paper's formula, its limits and symmetries, and what is refused."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lwa import InputError
from validation.scenes.materials import (
    DIAMETER,
    PTFE,
    PTFE_BEAD,
    STEEL,
    STEEL_BEAD,
    Bead,
    Material,
    contact_stiffness,
)
from validation.scenes.scene import SceneError

materials = st.builds(Material, E=st.floats(1e6, 1e12), nu=st.floats(-0.9, 0.5))
beads = st.builds(Bead, mass=st.floats(1e-6, 1), radius=st.floats(1e-4, 1e-1), material=materials)

ROUNDING = 1e-13  # a dozen operations, each to half an ulp


@given(beads, beads)
def test_the_formula_as_the_paper_writes_it(a, b):
    E1, E2, n1, n2 = a.material.E, b.material.E, a.material.nu, b.material.nu
    numerator = 4 * E1 * E2 * (a.radius * b.radius / (a.radius + b.radius)) ** 0.5
    A = numerator / (3 * (E2 * (1 - n1**2) + E1 * (1 - n2**2)))
    assert contact_stiffness(a, b) == pytest.approx(A, rel=ROUNDING)
    assert contact_stiffness(b, a) == pytest.approx(A, rel=ROUNDING)


@given(beads)
def test_equal_spheres(bead):
    E, nu, R = bead.material.E, bead.material.nu, bead.radius
    A = E * math.sqrt(2 * R) / (3 * (1 - nu**2))
    assert contact_stiffness(bead, bead) == pytest.approx(A, rel=ROUNDING)


@given(beads, materials)
def test_a_wall_is_a_sphere_of_infinite_radius(bead, wall):
    sphere = Bead(1.0, 1e10 * bead.radius, wall)
    # √(1 + R1/R2) - 1 = 5e-11
    assert contact_stiffness(bead, wall) == pytest.approx(
        contact_stiffness(bead, sphere), rel=1e-10
    )


@given(beads)
def test_against_a_rigid_wall_only_the_bead_yields(bead):
    rigid = Material(E=1e30, nu=0.0)
    A = 4 * bead.material.E * math.sqrt(bead.radius) / (3 * (1 - bead.material.nu**2))
    assert contact_stiffness(bead, rigid) == pytest.approx(A, rel=ROUNDING)


def test_a_wall_is_stiffer_than_an_equal_bead():
    wall, bead = contact_stiffness(STEEL_BEAD, STEEL), contact_stiffness(STEEL_BEAD, STEEL_BEAD)
    assert wall / bead == pytest.approx(math.sqrt(2), rel=ROUNDING)


def test_the_beads_of_the_experiment():
    """Masses and diameter must agree with handbook densities, 8000 and 2180 kg/m³, to 1 %."""
    volume = math.pi * DIAMETER**3 / 6
    assert STEEL_BEAD.mass / volume == pytest.approx(8000, rel=0.01)
    assert PTFE_BEAD.mass / volume == pytest.approx(2180, rel=0.01)
    assert (STEEL.E, STEEL.nu, PTFE.E, PTFE.nu) == (193e9, 0.3, 1.46e9, 0.46)
    assert STEEL_BEAD.radius == PTFE_BEAD.radius == DIAMETER / 2


NOT_NUMBERS = [None, "1", "x", True, float("nan"), float("inf"), 1j, [1.0], 10**400]


@pytest.mark.parametrize("bad", [*NOT_NUMBERS, 0, -1.0])
@pytest.mark.parametrize("field", ["E", "mass", "radius"])
def test_quantities_must_be_positive_numbers(field, bad):
    good = dict(E=1.0, nu=0.3) if field == "E" else dict(mass=1.0, radius=1.0, material=STEEL)
    make = Material if field == "E" else Bead
    with pytest.raises(SceneError, match=rf"^{field} is .*(number is wanted|must be positive)$"):
        make(**{**good, field: bad})


@pytest.mark.parametrize("bad", [*NOT_NUMBERS, -1, 0.51, 2])
def test_poissons_ratio(bad):
    with pytest.raises(InputError, match=r"^nu is "):
        Material(E=1.0, nu=bad)


def test_a_bead_needs_a_material():
    with pytest.raises(SceneError, match=r"^material is 'steel': a Material is wanted$"):
        Bead(1.0, 1.0, "steel")
