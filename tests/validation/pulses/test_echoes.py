"""Pulses that a wall sends back: delay and height, and errors that cover."""

import math
import operator
from dataclasses import replace

import numpy as np
import pytest

from lwa import Estimate
from validation import simulate
from validation.pulses.noisy import noisy_pulses
from validation.pulses.readings import Reading, echoes
from validation.pulses.sensors import record
from validation.scenes.chains import struck

SCENE = struck((1,), 24, wall=0.3, contact_sensors=(8, 14), duration=55.0, samples=1101)


@pytest.fixture(scope="module")
def true():
    """Echo at contact 9 of an accurate run, as (delay, ratio)."""
    found = echoes(
        record(replace(SCENE, samples=2), rtol=1e-12, every=True).sensors, operator.add
    )
    (echo,) = [
        r.numbers for r, back in found if back and r.places == (9,) and r.pulse == 2
    ]
    return echo


def test_the_wall_reflects_and_the_two_sensors_tell(true):
    """From contact 15 to the wall and back is a shorter way: the delay there is less."""
    found = echoes(record(SCENE, every=True).sensors, operator.add)
    seconds = {r.places: (r.numbers, back) for r, back in found if r.pulse == 2}
    assert all(back for _, back in seconds.values())
    (near, _), (far, _) = seconds[15,], seconds[9,]
    speed = 6 / (far["delay"].value - near["delay"].value) * 2  # both ways, 12 sites
    assert 0.6 < speed < 1.2
    assert far["delay"].value == pytest.approx(true["delay"].value, rel=1e-8)


def test_errors_are_those_of_both_pulses():
    """Errors of 3 and 4, of times and in percent of the peaks."""
    pulses = [
        {"arrival": Estimate(t, e), "peak": Estimate(F, F * e / 100)}
        for t, F, e in ((100.0, 2.0, 3.0), (300.0, 1.0, 4.0))
    ]
    found = [Reading("contact", (9,), p, 0.0, pulse=i) for i, p in enumerate(pulses, 1)]
    ((echo, _),) = echoes(found, math.hypot)
    errors = echo.numbers["delay"].error, 100 * echo.numbers["ratio"].relative_error
    assert errors == pytest.approx((5, 5))


@pytest.mark.parametrize("rtol", [1e-7, 1e-9])
def test_the_errors_cover_an_accurate_run(true, rtol):
    found = echoes(record(SCENE, rtol=rtol, every=True).sensors, operator.add)
    (echo,) = [r.numbers for r, _ in found if r.places == (9,) and r.pulse == 2]
    for name, number in echo.items():
        assert (
            abs(number.value - true[name].value)
            <= number.error
            < 100 * rtol * number.value
        )


def test_errors_of_a_noisy_record_are_one_standard_deviation(true):
    """Of 40 copies with white noise of half a percent; the shares have a spread of 7 %."""
    run, rng, within = simulate(SCENE), np.random.default_rng(3), []
    force = run.contact_force[0]
    for _ in range(40):
        noisy = force + 0.005 * force.max() * rng.normal(size=force.shape)
        pulses = noisy_pulses(run.time, noisy)
        readings = [
            Reading("contact", (9,), p.numbers, p.base, pulse=i)
            for i, p in enumerate(pulses, 1)
        ]
        echo = max(
            (r.numbers for r, _ in echoes(readings, math.hypot)),
            key=lambda n: n["ratio"].value,
        )
        within.append(
            [abs(echo[n].value - true[n].value) < echo[n].error for n in true]
        )
    share = np.mean(within, axis=0)
    assert np.all((share > 0.5) & (share < 0.92)), share
