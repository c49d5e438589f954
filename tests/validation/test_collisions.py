"""Closed forms and rules of collisions beside the lattice: strikes, graded chains, interfaces."""

import numpy as np
import pytest

from lwa import Cell, graded_force, pulse_of_strike, transmitted_force
from validation import Scene, simulate


def peaks(masses, stiffnesses, k, sensors, duration):
    scene = Scene(
        masses=tuple(masses), stiffnesses=tuple(stiffnesses), k=k, duration=duration,
        velocities=(1,), contact_sensors=sensors, samples=20001,
    )  # fmt: skip
    return [force.max() for force in simulate(scene).contact_force]


@pytest.mark.parametrize("k", ["5/4", "3/2", "5/2"])
@pytest.mark.parametrize("mass", [0.5, 1.75, 8])
def test_the_force_of_a_strike_is_right_within_its_error(k, mass):
    found = pulse_of_strike(Cell([1], spacing=1), mass, 1, k=k)
    number = float(found.chain.k)
    (peak,) = peaks([mass] + 60 * [1], 60 * [1], number, (40,), 80)
    assert abs(found.force.value - peak) < found.force.error
    if found.chain.effective_mass.at().value <= mass <= 2:
        assert found.force.error < 0.013 * peak
    assert found.train == (mass > 2)


@pytest.mark.parametrize("what", ["stiffness", "mass", "radius"])
def test_force_in_a_graded_chain(what):
    """Stiffness ×4, mass ×4 or radius ÷2 over 500 beads: within 0.5 % halfway."""
    share = np.clip((np.arange(600) - 50) / 500, 0, 1)
    equal = np.ones(600)
    stiffness, masses = {
        "stiffness": (4.0**share, equal),
        "mass": (equal, 4.0**share),
        "radius": (2 ** (-share / 2), 8.0**-share),  # A ~ √R and m ~ R³
    }[what]
    first, half = peaks(masses, stiffness[:-1], 1.5, (40, 300), 500)
    assert half == pytest.approx(float(graded_force(first, 1, stiffness[300], "3/2")), rel=0.005)


@pytest.mark.parametrize(("ratio", "most"), [(0.25, 0.075), (0.5, 0.025), (2, 0.025), (8, 0.1)])
def test_force_behind_an_interface(ratio, most):
    """The rule is a little too small, and the better the more alike the beads are."""
    before, behind = peaks(60 * [1] + 50 * [ratio], 109 * [1], 1.5, (40, 90), 260)
    rule = float(transmitted_force(before, Cell([1]), Cell([ratio]), "3/2"))
    assert -most < rule / behind - 1 < 0
