"""The compiled engine: its order, chains of several tiles, and many scenes against single ones."""

from dataclasses import replace

import numpy as np
import pytest

from validation.lattice.kernel.arrays import TILE
from validation.lattice.simulate import simulate, simulate_many
from validation.scenes.chains import struck
from validation.scenes.forcing import Damping
from validation.scenes.scene import Scene

# Six beads under such weight that no contact opens: a smooth problem.
SMOOTH = {
    "masses": (1.0, 0.3, 2.0, 0.7, 1.1, 0.5), "stiffnesses": (1.0, 2.0, 0.5, 1.5, 3.0),
    "wall": 1.0, "gravity": 1.0, "displacements": (0.05, -0.05, 0.02),
    "velocities": (0.0, 0.1, -0.05), "duration": 8.0, "bead_sensors": range(6),
    "contact_sensors": range(6), "samples": 98,
}  # fmt: skip


@pytest.mark.parametrize(
    ("method", "damping", "order", "steps"),
    [
        ("RKN86", None, 8, (80, 64, 50)),
        ("RKN86", Damping("kuwabara_kono", 0.2), 8, (60, 45, 30)),
        ("symplectic", None, 4, (240, 160, 120)),
    ],
)
def test_the_order_on_a_smooth_problem(method, damping, order, steps):
    """The slopes of the error at the end; no tolerance shortens the steps of the pairs. The samples
    are values of an interpolant of order 7."""
    scene = Scene(**SMOOTH, k=3, damping=damping)
    exact = simulate(scene, method="DOP853", rtol=1e-13)
    assert exact.compression.min() > 0.1
    steps = 8.0 / np.array(steps)
    errors, between = [], []
    for h in steps:
        run = simulate(scene, method=method, step=h, rtol=1e-2)
        errors.append(np.abs(run.displacements - exact.displacements).max())
        between.append(np.abs(run.bead_velocity - exact.bead_velocity).max())
    assert errors[0] > 1e-12  # above rounding
    for found, least in ((errors, order - 0.4), (between, min(order, 7) - 1.2)):
        assert np.polyfit(np.log(steps), np.log(found), 1)[0] > least


@pytest.mark.parametrize(
    ("method", "damping"),
    [("RKN86", None), ("RKN86", Damping("contact", 0.1)), ("symplectic", None)],
)
def test_a_chain_of_several_tiles_moves_as_its_mirror_image(method, damping):
    """The tiles of the image end at other beads; 1e-6 is the error of both runs, not rounding."""
    start = np.random.default_rng(0).normal(size=2 * TILE + 90)
    scene = struck((1,), len(start), velocities=start, duration=3, damping=damping)
    run = simulate(scene, method=method)
    image = simulate(replace(scene, velocities=-start[::-1]), method=method)
    np.testing.assert_allclose(image.velocities, -run.velocities[::-1], atol=1e-6)


def test_many_scenes_run_as_single_ones_and_are_taken_lazily():
    scenes = [
        struck((1,), 40, duration=d, contact_sensors=(20,)) for d in range(10, 45)
    ]
    waiting = iter(scenes)
    runs = simulate_many(waiting, workers=2)
    first = next(runs)
    untaken = [*waiting]
    assert len(untaken) > 10
    done = [first, *runs]
    assert [run.scene for run in done] + untaken == scenes
    for run in done:
        alone = simulate(run.scene)
        np.testing.assert_array_equal(run.contact_force, alone.contact_force)
