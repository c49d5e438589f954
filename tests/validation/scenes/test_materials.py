"""The paper's beads, and chains of them in floats: the exact numbers of `lwa.spheres`."""

import math

import pytest

from lwa.spheres.hertz import stiffness
from validation.scenes.chains import DIAMETER, PTFE, PTFE_BEAD, STEEL, STEEL_BEAD

ROUNDING = 1e-15  # half an ulp of the stiffness, and what the formula's own floats lose


def test_the_formula_as_the_paper_writes_it():
    E1, n1, E2, n2, R = 193e9, 0.3, 1.46e9, 0.46, DIAMETER / 4
    A = 4 * E1 * E2 * math.sqrt(R) / (3 * (E2 * (1 - n1**2) + E1 * (1 - n2**2)))
    assert float(stiffness(STEEL_BEAD, PTFE_BEAD)) == pytest.approx(A, rel=ROUNDING)


def test_a_wall_is_stiffer_than_an_equal_bead():
    wall, bead = stiffness(STEEL_BEAD, STEEL), stiffness(STEEL_BEAD, STEEL_BEAD)
    assert float(wall / bead) == pytest.approx(math.sqrt(2), rel=ROUNDING)


def test_the_beads_of_the_experiment():
    """Masses and diameter must agree with handbook densities, 8000 and 2180 kg/m³, to 1 %."""
    volume = math.pi * DIAMETER**3 / 6
    assert float(STEEL_BEAD.mass) / volume == pytest.approx(8000, rel=0.01)
    assert float(PTFE_BEAD.mass) / volume == pytest.approx(2180, rel=0.01)
    found = [float(x) for x in (STEEL.E, STEEL.nu, PTFE.E, PTFE.nu)]
    assert found == [193e9, 0.3, 1.46e9, 0.46]
    assert float(STEEL_BEAD.radius) == float(PTFE_BEAD.radius) == DIAMETER / 2
