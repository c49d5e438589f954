"""What `simulate` and `record` refuse: one line that begins with the name of the value."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lwa.law import Law, named
from tests.validation.lattice.scenes import chain
from validation.lattice import cost
from validation.lattice.simulate import simulate, simulate_many
from validation.pulses.sensors import record
from validation.scenes.chains import struck
from validation.scenes.forcing import Damping, Drive
from validation.scenes.scene import SceneError

CHAIN = struck((1,), 20, duration=25)
DAMPED = replace(CHAIN, damping=Damping("contact", 1))
X = sp.Symbol("x", positive=True)


def pressed(law):
    return chain(1, wall=1, law=law, precompression=2, duration=1)


REFUSED = [
    ("x", {}, "scene is 'x'"),
    (DAMPED, {"method": "symplectic"}, "method is symplectic"),
    (CHAIN, {"method": "DOP853", "step": 0}, "step is 0"),
    (CHAIN, {"rtol": 0}, "rtol is 0: it lies between 1e-13"),
    # values beyond floats
    (replace(CHAIN, velocities=(1e200,)), {}, "the scene's energy comes out as inf"),
    (replace(CHAIN, velocities=(1e-200,)), {}, "the scene's energy comes out as 0"),
    # laws that have no number in floats, or none at the load
    (pressed(named("polynomial", 0, -1)), {}, "force is 2.0"),
    (pressed(Law(sp.besseli(1, X), X)), {}, r"law is 'besseli\(1, x\)'"),
    # more steps or memory than a run may take
    (struck((1, 1e-300), 20, duration=25), {}, "duration is 25"),
    (replace(CHAIN, duration=1e300), {"method": "DOP853"}, r"duration is 1e\+300"),
    (CHAIN, {"method": "symplectic", "step": 1e-12}, "duration is 25: .* 2e.13 steps"),
    # a drive that presses its contact into a pole of the law
    (
        chain(
            1, wall=1, law=named("magnetic", 4, 2), drive=Drive(velocity=1), duration=5
        ),
        {},
        "duration is 5",
    ),
    (replace(CHAIN, bead_sensors=range(20), samples=3 * 10**6), {}, "samples is"),
    (struck((1,), 20_000, duration=25), {"method": "LSODA"}, "samples is .* 13 GB"),
    # SciPy's dense output is the motion of all beads at each sample
    (replace(CHAIN, samples=5 * 10**6), {"method": "RK45"}, "samples is .* GB"),
]


@pytest.mark.parametrize(("scene", "options", "named"), REFUSED)
def test_a_scene_or_an_option_is_refused_by_name(scene, options, named):
    with pytest.raises(SceneError, match=f"^{named}") as caught:
        simulate(scene, **options)
    assert "\n" not in str(caught.value)


def test_rounding_that_hides_the_motion_ends_a_run():
    """The steps would shrink to a millionth; `record` sees it, and loose tolerances, before."""
    heavy = replace(CHAIN, wall=1.0, gravity=1e12, duration=0.05)
    with pytest.raises(cost.IntegrationError, match=r"^\d+ steps of RKN86"):
        simulate(heavy, rtol=1e-12)
    for scene, rtol in ((heavy, 1e-10), (CHAIN, 1.0000001e-5)):
        with pytest.raises(SceneError, match=f"^rtol is {rtol!r}"):
            record(scene, rtol=rtol)


def test_the_error_of_a_scene_among_many_is_raised_in_its_place():
    runs = simulate_many([CHAIN, replace(CHAIN, velocities=(1e200,)), CHAIN], workers=2)
    assert np.array_equal(next(runs).velocities, simulate(CHAIN).velocities)
    with pytest.raises(SceneError, match="energy"):
        next(runs)
    with pytest.raises(SceneError, match=r"^scenes is Scene"):
        next(simulate_many(CHAIN))
