"""Chains driven by a piston; their shocks are held against `book/shocks.md` beside its numbers."""

import numpy as np
import pytest

from lwa import Cell, Power, shock
from validation import Drive, Scene, simulate


def test_a_wall_that_recedes_makes_the_fan():
    """c(p) = x/t between the edges c₋ and c₊; the lattice is about a site off at all times."""
    found = shock(Cell([1], spacing=1), 1, 2, law=Power("3/2"))
    errors = []
    for end in (200, 400):
        n = 2 * end
        fan = [round(share * end) for share in np.linspace(1.29, 1.41, 5)]
        scene = Scene(
            masses=(1.0,) * n, stiffnesses=(1.0,) * (n - 1), wall=1.0, law=Power("3/2"),
            precompression=2**1.5, drive=Drive(velocity=float(found.plateau)), duration=end,
            contact_sensors=(5, *fan), samples=11,
        )  # fmt: skip
        plateau, *strains = simulate(scene, rtol=1e-7).compression[:, -1]
        assert plateau == pytest.approx(1, rel=1e-3)
        theory = (((np.array(fan) + 0.5) / end) ** 2 / 1.5) ** 2  # c² = F'(p) = 3/2 √p
        assert 1.1 < theory[0] < theory[-1] < 1.95
        errors.append(np.abs(strains / theory - 1).max())
    assert errors[0] < 0.02
    assert errors[1] < 0.6 * errors[0]
