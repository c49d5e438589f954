"""Closed forms and rules of collisions beside the lattice: strikes, graded chains, interfaces."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, InputError, graded_force, pulse_of_strike, transmitted_force
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


@pytest.mark.parametrize(
    ("k", "mass", "stiffness", "between"),
    [
        ("3/2", 1 / 8, 1 / 3, 1 / 3),
        ("3/2", 1 / 4, 1, 1),
        ("3/2", 8, 1, 1),
        ("3/2", 1, 3, 1),
        ("3/2", 1, 3, 3),
        ("5/4", 1 / 8, 1 / 3, 1 / 3),
        ("5/4", 1 / 2, 3, 3),
        ("5/4", 8, 3, 1),
        ("5/2", 4, 3, 3),
        ("5/2", 1 / 4, 1, 1),
    ],
)
def test_force_behind_an_interface_is_right_within_its_error(k, mass, stiffness, between):
    """On both ends of the range, and with a contact between the chains like those of either."""
    masses, contacts = 60 * [1] + 50 * [mass], 59 * [1] + [between] + 49 * [stiffness]
    duration = 80 + 75 * (mass / stiffness) ** 0.5
    before, behind = peaks(masses, contacts, float(sp.Rational(k)), (40, 90), duration)
    cells = Cell([1]), Cell([Fraction(mass)], [Fraction(stiffness).limit_denominator(9)])
    found = transmitted_force(before, *cells, k)
    assert abs(found.value - behind) < found.error < 30 * abs(found.value - behind)


@pytest.mark.parametrize(
    ("cell", "k", "message"),
    [
        (Cell([1], [114]), "3/2", "ratio of stiffnesses is 114"),
        (Cell([9]), "3/2", "ratio of masses is 9"),
        (Cell([1]), 3, "k is 3"),
        (Cell(["m"]), "3/2", "'m' has no value"),
        (Cell([1, 2]), "3/2", "other is Cell"),
    ],
)
def test_interfaces_beyond_the_measured_range_are_refused(cell, k, message):
    with pytest.raises(InputError, match=message):
        transmitted_force(1, Cell([1]), cell, k)
