"""The paper's beads: masses, diameter and materials."""

import math

import pytest

from validation.scenes.chains import DIAMETER, PTFE, PTFE_BEAD, STEEL, STEEL_BEAD


def test_the_beads_of_the_experiment():
    """Masses and diameter must agree with handbook densities, 8000 and 2180 kg/m³, to 1 %."""
    volume = math.pi * DIAMETER**3 / 6
    assert float(STEEL_BEAD.mass) / volume == pytest.approx(8000, rel=0.01)
    assert float(PTFE_BEAD.mass) / volume == pytest.approx(2180, rel=0.01)
    found = [float(x) for x in (STEEL.E, STEEL.nu, PTFE.E, PTFE.nu)]
    assert found == [193e9, 0.3, 1.46e9, 0.46]
    assert float(STEEL_BEAD.radius) == float(PTFE_BEAD.radius) == DIAMETER / 2
