"""The engine at its finest against DOP853 with located kinks, which shares only the equations."""

import math

import numpy as np
import pytest
from scipy import integrate as scipy

from tests.benchmarks.located import Located, around, integrate, located, read
from validation.lattice.equations import Motion
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene
from validation.studies.accuracy import FINEST, TASKS, relative_errors, solitary_wave, struck_chain


def compiled(task):
    return task.read(simulate(task.scene, rtol=FINEST))


def off(task):
    """The largest relative difference of the two routes."""
    truth = compiled(task)
    return max(relative_errors(located(task, truth), truth).values())


def short(omega):
    return struck_chain(omega, 30, 20, {1.0: 34.0, 0.2733: 30.0}[omega])


def test_both_routes_agree():
    """Each route has an error of a few 1e-13, the rounding of some thousand steps."""
    assert off(short(0.2733)) < 2e-12


@pytest.mark.slow
def test_located_kinks_make_the_error_follow_the_tolerance():
    """Errors are proportional to the tolerance; plain DOP853 steps over the kinks and errs more."""
    task = short(0.2733)
    truth = compiled(task)

    def error(method, rtol):
        found = read(task, around(task, truth), integrate(task, around(task, truth), method, rtol))
        return relative_errors(found, truth)["peak"]

    tolerances = np.array([1e-9, 1e-11, 1e-13])
    found = [error(Located, rtol) for rtol in tolerances]
    assert np.polyfit(np.log(tolerances), np.log(found), 1)[0] == pytest.approx(1, abs=0.2)
    assert error(scipy.DOP853, 1e-13) > 10 * found[-1]


def test_the_end_of_a_collision_is_located():
    """Two beads are in contact for (2 δ/v) √π Γ(1+s)/Γ(1/2+s), s = 1/(k+1), δ the deepest."""
    k, reduced = 1.5, 1 / (1 + 1 / 0.3)
    scene = Scene(masses=(1, 0.3), stiffnesses=(1,), k=k, velocities=(1,), duration=9)
    s = 1 / (k + 1)
    deepest = (reduced / (2 * s)) ** s
    duration = 2 * deepest * math.sqrt(math.pi) * math.gamma(1 + s) / math.gamma(0.5 + s)
    motion = Motion(scene)
    stepper = Located(motion, 0.0, motion.start, 9.0, rtol=2.5e-14, atol=1e-15)
    while not stepper.events:
        assert stepper.step() is None
    assert stepper.t == pytest.approx(duration, rel=1e-12)
    while stepper.status == "running":
        assert stepper.step() is None
    assert stepper.events == 1
    assert stepper.y[3] - stepper.y[2] == pytest.approx(1.0, rel=1e-12)  # elastic


def test_the_exact_wave_arrives_on_time():
    """Within the residual of the wave itself, which is 1e-12 of its speed at most."""
    task = solitary_wave(20)
    for pulse in (located(task, task.truth), compiled(task)):
        assert max(relative_errors(pulse, task.truth).values()) < 5e-12


@pytest.mark.slow
@pytest.mark.parametrize("name", ["experiment"])
def test_the_references_agree(name):
    """Rounding over many steps is what is left."""
    assert off(TASKS[name]()) < 5e-12


def test_a_pulse_is_read_to_twelve_digits():
    """cos^8 between its zeros, as narrow and as densely sampled as the tasks' pulses."""
    task, times = struck_chain(1.0, 30, 20, 20.0), np.linspace(10, 20, 201)
    width, centre, half = 1.6, 15.013, math.acos(0.5 ** (1 / 8))
    phase = (times - centre) * 2 * half / width
    force = 0.7 * np.where(np.abs(phase) < np.pi / 2, np.cos(phase), 0.0) ** 8
    pulse = read(task, times, force)
    # The peak's time is where a slope vanishes, and less certain than the slope.
    assert pulse.arrival == pytest.approx(centre, rel=3e-12)
    assert pulse.peak == pytest.approx(0.7, rel=1e-12)
    assert pulse.fwhm == pytest.approx(width, rel=1e-12)
