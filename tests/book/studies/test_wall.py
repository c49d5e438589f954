"""The pulse that a wall sends back: scaling, a mirror, and the modulus from the delay."""

import numpy as np
import pytest

from book.studies.wall import BEAD, SOFTEST, STIFFEST, echo, modulus, wall
from lwa import Estimate, Material
from validation import Scene, simulate
from validation.pulses.pulse import all_pulses
from validation.pulses.sensors import tracks
from validation.scenes.checks import SceneError


def test_softer_walls_answer_later():
    rows = wall().document()["rows"]
    delays = [row["delay_value"] for row in rows]
    assert np.all(np.diff(delays) < 0)
    assert all(row["delay_error_value"] < 1e-8 for row in rows)


def test_times_scale_with_the_blow_and_the_ratio_does_not_change():
    slow, fast = (echo(SOFTEST, velocity=v) for v in (1e-6, 5))
    assert slow[0].value / fast[0].value == pytest.approx(5e6**0.2, rel=1e-9)
    assert slow[1].value == pytest.approx(fast[1].value, rel=1e-9)


@pytest.mark.parametrize(
    ("E", "beads", "wall", "velocities"),
    [
        (1e18, 40, None, (0.5, *[0.0] * 38, -0.5)),
        (3e9, 20, Material(3e9, 0.3), (0.5,)),
    ],
)
def test_a_rigid_wall_is_a_mirror_and_a_soft_one_a_contact(E, beads, wall, velocities):
    """By Hertz's formulas a sphere presses it as it presses its own image; and a soft wall."""
    settings = {"contact_sensors": (9,), "duration": 1.5e-3, "velocities": velocities}
    (track,) = tracks(simulate(Scene.of_beads([BEAD] * beads, wall=wall, **settings)))
    first, second = all_pulses(track.force)[:2]
    delay, ratio = echo(E)
    assert second.arrival - first.arrival == pytest.approx(delay.value, rel=1e-7)
    assert second.peak / first.peak == pytest.approx(ratio.value, rel=1e-6)


def test_the_modulus_is_read_from_the_delay_with_its_error():
    """The ± is the larger change of the modulus at both ends of the delay's error."""
    delay, _ = echo(70e9)
    read = modulus(Estimate(delay.value, 1e-6))
    assert read.value == pytest.approx(70e9, rel=1e-7)
    ends = [echo(read.value + side * read.error)[0].value for side in (1, -1)]
    assert delay.value - ends[0] == pytest.approx(
        1e-6, rel=1e-3
    )  # the stiffer wall errs more
    assert 1e-6 < ends[1] - delay.value < 1.1e-6
    assert 1e-2 < read.relative_error < 5e-2


@pytest.mark.parametrize("E", [SOFTEST / 2, 2 * STIFFEST])
def test_delays_of_no_wall_are_refused(E):
    delay, _ = echo(E)
    with pytest.raises(SceneError, match="delay is"):
        modulus(delay)
