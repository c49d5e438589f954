"""Graded chains beside the lattice, and interfaces beyond the range of their rule."""

import numpy as np
import pytest

from lwa import Cell, InputError, graded_force, transmitted_force
from tests.passage import peaks


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
