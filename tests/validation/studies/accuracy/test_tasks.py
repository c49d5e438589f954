"""What a tolerance of the engine means, on every task."""

import numpy as np
import pytest

from validation.lattice.simulate import simulate
from validation.studies.accuracy.tasks import TASKS, errors


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.slow
def test_rtol_is_the_error_of_the_peak_force(name):
    """At most one and a half times, in the median a fiftieth at least where contacts open: errors
    vary tenfold from one tolerance to the next, as steps meet the kinks elsewhere. On closed
    contacts the higher order is better than the lower one's estimate."""
    task = TASKS[name]()

    def pulse(rtol):
        return task.read(task.force(simulate(task.scene, rtol=rtol)))

    exact, tolerances = pulse(1e-13), 10.0 ** np.arange(-11, -3, 0.4)
    shares = [abs(errors(pulse(rtol), exact)["peak"]) / rtol for rtol in tolerances]
    assert max(shares) < 1.5
    assert (0 if name == "precompressed" else 1 / 50) < np.median(shares) < 1
