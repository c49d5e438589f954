"""The compiled engine against references, and many scenes against single ones."""

from functools import partial

import numpy as np
import pytest

from book.studies.accuracy import FINEST, TASKS, struck_chain
from tests.validation.lattice.reference import follow
from validation.lattice.equations import Motion
from validation.lattice.kernel.arrays import TILE
from validation.lattice.signal import RECORDS
from validation.lattice.simulate import COMPILED, simulate, simulate_many
from validation.scenes.chains import struck
from validation.scenes.forcing import Damping
from validation.scenes.scene import Scene


def loaded(k, duration=8.0, **rest):
    """Six beads under such weight that no contact opens: a smooth problem."""
    masses, n = (1.0, 0.3, 2.0, 0.7, 1.1, 0.5), 6
    scene = dict(
        masses=masses, stiffnesses=(1.0, 2.0, 0.5, 1.5, 3.0), wall=1.0, gravity=1.0, k=k,
        displacements=(0.05, -0.05, 0.02), velocities=(0.0, 0.1, -0.05),
        contact_sensors=range(n), bead_sensors=range(n), duration=duration,
    )  # fmt: skip
    return Scene(**{**scene, **rest})


@pytest.mark.parametrize(
    ("method", "order", "steps"),
    [("RKN86", 8, (80, 64, 50)), ("symplectic", 4, (240, 160, 120))],
)
def test_the_order_on_a_smooth_problem(method, order, steps):
    """Slopes 8 and 4 of the error at the end; no tolerance shortens the steps of the pair."""
    scene = loaded(3.0)
    reference = simulate(scene, method="DOP853", rtol=1e-13)
    exact = reference.displacements
    assert reference.compression.min() > 0.1
    steps = 8.0 / np.array(steps)
    errors = [
        np.abs(
            simulate(scene, method=method, step=h, rtol=1e-2).displacements - exact
        ).max()
        for h in steps
    ]
    assert errors[0] > 1e-12  # above rounding
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(order, abs=0.4)


@pytest.mark.parametrize("k", [1.0, 1.1, 1.25, 2.0, 2.5, 3.0])
def test_every_law_and_every_sensor_agree_with_dop853(k):
    """Smooth, so that the step's error is far below 1e-6; the samples' quintic as well."""
    scene = loaded(k, samples=301)
    reference = simulate(scene, method="DOP853", rtol=1e-12)
    for method in COMPILED:
        run = simulate(scene, method=method, step=0.02)
        for name in (*RECORDS.values(), "velocities"):
            np.testing.assert_allclose(
                getattr(run, name), getattr(reference, name), atol=1e-6
            )
        np.testing.assert_allclose(run.bead_velocity[:, -1], run.velocities, atol=1e-14)
        np.testing.assert_allclose(
            run.bead_displacement[:, -1], run.displacements, atol=1e-14
        )


@pytest.mark.parametrize(
    ("method", "damping"),
    [("RKN86", None), ("RKN86", Damping("contact", 0.1)), ("symplectic", None)],
)
def test_a_chain_of_several_tiles_moves_as_its_mirror_image(method, damping):
    """The tiles of the image end at other beads; 1e-6 is the error of both runs, not rounding."""
    n, start = 2 * TILE + 90, np.random.default_rng(0).normal(size=2 * TILE + 90)
    gas = dict(
        masses=(1,) * n, stiffnesses=(1,) * (n - 1), k=1.5, duration=3, damping=damping
    )
    options = dict(method=method, rtol=1e-9)
    run, image = (
        simulate(Scene(velocities=v, **gas), **options) for v in (start, -start[::-1])
    )
    np.testing.assert_allclose(image.velocities, -run.velocities[::-1], atol=1e-6)


def difference(task):
    """Greatest difference to the reference in the force of the pulse, in units of its peak."""
    scene, motion, run = (
        task.scene,
        Motion(task.scene),
        simulate(task.scene, rtol=FINEST),
    )
    pulse, (contact,) = task.read(run), scene.contact_sensors
    times = pulse.arrival + pulse.fwhm * np.linspace(-2, 2, 20)
    times = times[times < scene.duration]
    size = motion.scales.displacement, motion.scales.velocity, motion.scales.energy
    found = follow(
        scene, times, 2.5e-14, size
    )  # about the least tolerance that SciPy takes
    expected = motion.force(motion.compression(found.y.T))[contact]
    return np.abs(run.signal("contact", contact)(times) - expected).max() / pulse.peak


@pytest.mark.parametrize(
    "task",
    [
        partial(struck_chain, 0.2733, 16, 10, 17.0),
        pytest.param(TASKS["experiment"], marks=pytest.mark.slow),
    ],
)
def test_forces_agree_with_located_kinks(task):
    """The rounding of some thousand steps: a few 1e-13."""
    assert difference(task()) < 5e-12


def test_many_scenes_run_as_single_ones_and_are_taken_lazily():
    scenes = [
        struck((1,), 40, duration=d, contact_sensors=(20,))
        for d in np.linspace(10, 40, 30)
    ]
    taken = []
    runs = simulate_many(
        (taken.append(scene) or scene for scene in scenes), rtol=1e-7, workers=2
    )
    first = next(runs)
    assert len(taken) < 20
    for scene, run in zip(scenes, (first, *runs), strict=True):
        alone = simulate(scene, rtol=1e-7)
        assert run.scene is scene
        assert np.array_equal(run.contact_force, alone.contact_force)
