"""Chains driven by a piston, beside the plateau, the edges and the leading pulse of the theory."""

import numpy as np
import pytest

from book.studies.shock import shock
from lwa import Cell, Power
from lwa import shock as front
from validation import Drive, Scene, simulate


def test_plateau_speed_and_peak_of_three_laws():
    """Trains are so short at a jump of 3 that a tenth of the time of the next test is enough."""
    found = shock(jumps=(3,), duration=250)
    assert found.ok
    toda, hertz, square = found.document()["rows"]
    assert [row["law"] for row in (toda, hertz, square)] == ["Toda", "k = 3/2", "k = 2"]
    for row in (toda, hertz, square):
        assert abs(row["plateau_error_value"]) < 0.0025
        assert row["speed_error_value"] < 2e-4 * row["speed_value"]
    assert np.abs(list(toda["doubling_error_value"].values())).max() < 2e-4
    assert toda["dispersion_value"]["speed"] == pytest.approx(toda["doubling_value"]["speed"])
    assert np.abs(list(hertz["canonical_error_value"].values())).max() < 0.003
    assert -0.012 < hertz["dispersion_error_value"]["speed"] < -0.009  # El's edge is too slow
    assert square["dispersion_error_value"]["speed"] < -0.02


def test_a_wall_that_recedes_makes_the_fan():
    """c(p) = x/t between the edges c₋ and c₊; the lattice is about a site off at all times."""
    found = front(Cell([1], spacing=1), 1, 2, law=Power("3/2"))
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
