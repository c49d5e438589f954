"""Measurements of pulses that are known in closed form, and of records that hold none."""

import math

import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from lwa import InputError
from validation.pulses.pulse import (
    FEWEST,
    ROUNDING,
    MeasureError,
    Piecewise,
    all_pulses,
    compared,
    first_pulse,
    measure,
    spline,
    tolerances,
)


def arch(t):
    """The theory's pulse for k = 3/2, cos^6."""
    return np.cos(np.clip(t, -np.pi / 2, np.pi / 2)) ** 6


def test_a_pulse_may_end_in_a_jump():
    """As the force of a damped contact that opens; rounding may move the jump off the grid."""
    for jump in np.random.default_rng(0).uniform(0.1, 0.2, 50):
        times = np.array([-1, -0.5, jump, 0.5, 1])
        signal = Piecewise(
            times, lambda t, end=jump: np.where(np.less(t, end), 1 - t * t, 0.0)
        )
        assert measure(signal).fall == pytest.approx(jump, rel=1e-12)


TIMES = np.linspace(-4, 14, 3601)


def humps(*places):
    """The signal of Gaussian humps of given heights and times."""
    f = [height * np.exp(-4 * (TIMES - at) ** 2) for height, at in places]
    return spline(TIMES, np.sum(f, axis=0))


@pytest.mark.parametrize(
    ("places", "low", "arrival", "count"),
    [
        (((0.4, 1), (1, 4), (1.5, 8)), 0.5, 4, 3),
        # Between these humps the signal stays above half of the first one: they are one pulse.
        (((0.6, 4), (1, 5.2)), 0.5, 5.2, 1),
        (((0.6, 4), (2, 8)), 0.25, 4, 2),
    ],
)
def test_the_first_pulse_is_not_a_later_and_higher_one(places, low, arrival, count):
    found = first_pulse(humps(*places), low, low)
    assert found.arrival == pytest.approx(arrival, abs=0.01)
    # A Gaussian falls to the same fraction of its peak.
    late = math.sqrt(-math.log(low) / 4)
    assert found.fall == pytest.approx(arrival + late, abs=0.01)
    assert len(all_pulses(humps(*places))) == count


@given(st.lists(st.tuples(st.floats(0.2, 1), st.floats(1, 9)), min_size=1, max_size=5))
@example([(1.0, 4.0), (0.9, 4.9)])
def test_all_pulses_of_a_record_backwards_are_the_same(places):
    """The force falls to half of its peak, or below the hump between two, on both sides."""
    signal = humps(*places)
    there = all_pulses(signal)
    back = all_pulses(Piecewise(-TIMES[::-1], lambda t: signal(-np.asarray(t))))[::-1]
    assert [p.peak for p in there] == pytest.approx([p.peak for p in back], rel=1e-6)
    for one, other in zip(there, back, strict=True):
        times = one.arrival, one.rise, one.fall
        mirrored = -other.arrival, -other.fall, -other.rise
        assert times == pytest.approx(mirrored, abs=1e-6)


T = np.linspace(-2, 2, 401)


@pytest.mark.parametrize(
    ("time", "signal", "message"),
    [
        (T[:200], arch(T[:200]), "the pulse is not wholly .*: it peaks at the end"),
        (T[180:], arch(T[180:]), "the pulse .*: its front does not pass 50%"),
        (T, 0 * T, "no pulse is in the record"),
        (T, T * np.nan, "time and signal must be finite"),
        (-T, arch(T), "time must increase"),
        (T[::40], arch(T[::40]), rf"\d samples lie above half .*: at least {FEWEST}"),
        (T, arch(T)[:-1], r".*: the shapes are \(401,\) and \(400,\)$"),
        (T, ["tea"] * 401, "time and signal must be equally long rows .*: .*'tea'"),
    ],
)
def test_records_without_a_whole_pulse(time, signal, message):
    with pytest.raises(MeasureError, match=f"^{message}") as caught:
        measure(time, signal)
    assert isinstance(caught.value, InputError)


@pytest.mark.parametrize(
    ("check", "error"),
    [(1, ROUNDING), (1 + 2**-40, 5 * 2**-40), (math.nan, math.nan)],
)
def test_a_small_difference_counts_five_times_and_none_is_unknown(check, error):
    """At least rounding; a number that the other run does not have has an unknown error."""
    found = compared(lambda value: {"x": value}, [1.0, check])["x"]
    assert found.error == pytest.approx(error, nan_ok=True)


def test_another_run_is_less_accurate_where_rounding_hides_it():
    assert tolerances(1e-13) == pytest.approx((1e-13, 1e-12))
    assert tolerances(1e-10, 1e-9) == pytest.approx((1e-10, 1e-9))


def test_a_record_beyond_the_floats_is_refused():
    with pytest.raises(MeasureError, match="for floats"):
        measure(1e300 * np.arange(9), np.arange(9) % 4)
