"""CyRK, the peer of the benchmarks, integrates the same motion."""

import numpy as np
import pytest
from scipy import integrate as scipy

from tests.benchmarks import cyrk
from tests.benchmarks.located import integrate
from validation.scenes.scene import Scene
from validation.studies.accuracy import Task, struck_chain


def loaded():
    """A light chain under weight and a wall, to see that rest, load and wall are passed on."""
    scene = Scene(
        masses=(1.0, 0.3, 2.0, 0.7),
        stiffnesses=(1.0, 2.0, 0.5),
        wall=1.5,
        gravity=0.1,
        k=1.5,
        velocities=(0.3,),
        duration=8.0,
        samples=2,
        contact_sensors=(2,),
    )
    return Task(scene)


@pytest.mark.slow  # CyRK compiles its integrators
@pytest.mark.optional("CyRK")
@pytest.mark.parametrize("method", cyrk.METHODS)
@pytest.mark.filterwarnings("default::DeprecationWarning")
def test_a_peer_agrees_with_scipy(method):
    """Kinks leave an error of 1e-6 at tolerances of 1e-10."""
    for task in (struck_chain(0.2733, 16, 10, 17.0), loaded()):
        times = np.linspace(1.0, task.scene.duration, 141)
        found = cyrk.prepared(task, method)(1e-10, task, times)
        expected = integrate(task, times, scipy.DOP853, 1e-11)
        np.testing.assert_allclose(found, expected, atol=3e-6 * expected.max())
