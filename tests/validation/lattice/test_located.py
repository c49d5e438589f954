"""The engine at its finest against a reference that shares the scene's numbers alone."""

from functools import partial

import numpy as np
import pytest

from book.studies.accuracy import FINEST, TASKS, struck_chain
from tests.validation.lattice.forced import follow
from validation.lattice.equations import Motion
from validation.lattice.simulate import simulate


def difference(task):
    """Greatest difference to the reference in the force of the pulse, in units of its peak."""
    scene, motion, run = task.scene, Motion(task.scene), simulate(task.scene, rtol=FINEST)
    pulse, (contact,) = task.read(run), scene.contact_sensors
    times = pulse.arrival + pulse.fwhm * np.linspace(-2, 2, 20)
    times = times[times < scene.duration]
    size = motion.scales.displacement, motion.scales.velocity, motion.scales.energy
    found = follow(scene, times, 2.5e-14, size)  # about the least tolerance that SciPy takes
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
