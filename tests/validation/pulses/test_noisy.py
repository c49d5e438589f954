"""Pulses of noisy records: bias and coverage by draws, against the same pulse without noise."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from validation import simulate
from validation.pulses.noisy import noisy_pulse, noisy_pulses
from validation.pulses.pulse import MeasureError, first_pulse
from validation.studies.paper import recorded_chain

NUMBERS = ("arrival", "peak", "fwhm")
STATIC = 1.5


@pytest.fixture(scope="module")
def signals():
    """Dynamic forces of beads of the paper's 1:1 and 2:1 columns, by column and bead."""
    found = {}
    for N in (1, 2):
        run = simulate(replace(recorded_chain((8, 16, 24), N=N), duration=1.2e-3))
        found |= {(N, i + 1): run.signal("bead", i) for i in run.scene.bead_sensors}
    return found


def record(signal, samples=None, widths=5):
    """Sample times, so many a width or at 1 MHz, and the pulse itself."""
    pulse = first_pulse(signal)
    start, end = pulse.arrival - widths * pulse.fwhm, pulse.arrival + 3 * pulse.fwhm
    return np.arange(start, end, pulse.fwhm / samples if samples else 1e-6), pulse


def white(share):
    return lambda t, f, P, rng: f + share * P * rng.normal(size=len(t))


def slow(count, rng):
    """Butterworth's second order at 50 kHz, of samples at 1 MHz, with variance 1."""
    poles = scipy.signal.butter(2, 0.1)
    response = scipy.signal.lfilter(*poles, np.eye(1, 500)[0])
    noise = scipy.signal.lfilter(*poles, rng.normal(size=count + 500))[500:]
    return noise / np.linalg.norm(response)


def drift_and_hum(t, f, P, rng):
    """With white noise of half a percent; each is 2 % of the peak."""
    drift, hum = (t - t[0]) / np.ptp(t), np.sin(2 * np.pi * (50 * t + rng.random()))
    return f + P * (0.02 * (drift + hum) + 0.005 * rng.normal(size=len(t)))


KINDS = {  # of a record, by times, forces, peak and generator
    "white, 0.2 %": white(0.002),
    "white, 2 %": white(0.02),
    "low-passed at 50 kHz": lambda t, f, P, rng: f + 0.005 * P * slow(len(t), rng),
    "drift and hum": drift_and_hum,
    "8 bits": lambda t, f, P, rng: (
        P / 200 * np.round(200 * f / P + 0.5 * rng.normal(size=len(t)))
    ),
    "8 bits, little noise": lambda t, f, P, rng: (
        P / 200 * np.round(200 * f / P + 0.05 * rng.normal(size=len(t)))
    ),
}


def quality(signal, kind, copies, samples=None):
    """Biases and errors over the scatter, and shares of the errors that cover, each (3,)."""
    t, pulse = record(signal, samples, 12)
    rng, step, rows = np.random.default_rng(3), t[1] - t[0], []
    for _ in range(copies):
        at = t + rng.random() * step
        clean = (
            STATIC
            + rng.random()
            + np.where(at > 0, signal(np.clip(at, 0, 1.2e-3)), 0.0)
        )
        noisy = noisy_pulse(at, KINDS[kind](at, clean, pulse.peak, rng)).numbers
        rows.append([(noisy[name].value, noisy[name].error) for name in NUMBERS])
    values, errors = np.moveaxis(np.array(rows), 2, 0)
    off, scatter = (
        values - [getattr(pulse, name) for name in NUMBERS],
        values.std(axis=0),
    )
    within = np.mean(np.abs(off) < errors, axis=0)
    return (
        np.abs(off.mean(axis=0)) / scatter,
        np.median(errors, axis=0) / scatter,
        within,
    )


FEW = [((1, 16), kind, 50) for kind in ("low-passed at 50 kHz", "8 bits, little noise")]
MANY = [
    *(((1, 24), kind, 200) for kind in KINDS),
    *(((2, 16), kind, 200) for kind in [*KINDS][:2]),
]
FEW += [pytest.param(*case, marks=pytest.mark.slow) for case in MANY]


@pytest.mark.parametrize(("place", "kind", "copies"), FEW)
def test_errors_are_one_standard_deviation(signals, place, kind, copies):
    """Bias: a third of the scatter; share: 60 … 80 %, one spread of 200 copies more, two of 50."""
    bias, _, within = quality(signals[place], kind, copies)
    more, least, most = {50: (2 / np.sqrt(50), 0.47, 0.93), 200: (0, 0.57, 0.83)}[
        copies
    ]
    assert np.all(bias < 1 / 3 + more), bias
    assert np.all((within > least) & (within < most)), within


def test_too_few_samples_make_errors_larger(signals):
    """17 samples a width of a pulse with ripples: errors cover, 30 times too large at most."""
    bias, error, within = quality(signals[2, 8], "white, 0.2 %", 25, 17)
    assert np.all(bias < np.maximum(error, 1) / 3)
    assert np.all(within > 0.6)
    assert np.all(error < 30)


def test_the_arrival_of_two_equal_humps_is_uncertain_by_their_distance():
    t, rng, covered = np.arange(-20, 10, 0.03), np.random.default_rng(5), 0
    f = np.exp(-((t - 0.9) ** 2)) + np.exp(-((t + 0.9) ** 2))
    later = abs(t[np.argmax(f)])
    for _ in range(20):
        noisy = noisy_pulse(t, f + 0.02 * rng.normal(size=len(t))).numbers["arrival"]
        covered += abs(noisy.value - later) < noisy.error
    assert (
        covered > 0.45 * 20
    )  # half of the copies have the other hump as the higher one


@pytest.mark.parametrize(("lead", "louder"), [(3.5, 1), (12, 10)])
def test_a_short_lead_and_noise_of_the_pulse_itself_are_in_the_error(lead, louder):
    """A line through a width and a half of samples errs more at the pulse than the fit does."""
    rng, t = np.random.default_rng(8), np.arange(-lead - 0.5, 2.5, 0.03)
    clean, within = 0.7 + np.exp(-4 * np.log(2) * t**2), 0
    for _ in range(30):
        noise = 0.01 * np.where(t > -1.5, 1, 1 / louder) * rng.normal(size=len(t))
        peak = noisy_pulse(t, clean + noise).numbers["peak"]
        within += abs(peak.value - 1) < peak.error
    assert 0.5 <= within / 30 <= 0.9


def test_rounding_without_noise_is_in_the_error_of_the_peak():
    """Forces in steps of 1/200 of the peak; without the error of the base a half is covered."""
    rng, t, within = np.random.default_rng(4), np.arange(-4.5, 2.5, 0.02), 0
    for _ in range(30):
        f = np.round(200 * np.exp(-4 * np.log(2) * t**2) + rng.random()) / 200
        peak = noisy_pulse(t, f).numbers["peak"]
        within += abs(peak.value - 1) < peak.error
    assert 0.7 <= within / 30 <= 0.95


@pytest.mark.parametrize(("samples", "bound"), [(17, 1e-3), (70, 1e-6)])
def test_a_record_without_noise_gives_the_pulse_of_the_signal(signals, samples, bound):
    """The error covers what the spline does not resolve."""
    t, pulse = record(signals[1, 24], samples)
    found = noisy_pulse(
        t, STATIC + np.where(t > 0, signals[1, 24](np.maximum(t, 0)), 0)
    )
    assert found.base == pytest.approx(STATIC, rel=1e-12)
    for name, size in zip(NUMBERS, (pulse.fwhm, pulse.peak, pulse.fwhm), strict=True):
        number = found.numbers[name]
        assert abs(number.value - getattr(pulse, name)) < min(
            number.error, bound * size
        )
        assert number.error < 300 * bound * size


def test_pulses_come_one_after_the_other():
    t = np.arange(0, 25, 0.01)
    f = (
        np.exp(-((t - 8) ** 2))
        + 0.5 * np.exp(-((t - 14) ** 2))
        + np.exp(-((t - 20) ** 2))
    )
    noise = 0.005 * np.random.default_rng(0).normal(size=len(t))
    found = [pulse.numbers for pulse in noisy_pulses(t, f + noise + 0.7 - 0.01 * t)]
    assert len(found) == 3
    width = 2 * np.sqrt(np.log(2))
    for numbers, at, peak in zip(found, (8, 14, 20), (1, 0.5, 1), strict=True):
        for name, value in (("arrival", at), ("peak", peak), ("fwhm", width)):
            assert abs(numbers[name].value - value) < 4 * numbers[name].error < 0.1


N = np.arange(400.0)
PULSE = np.exp(-(((N - 300) / 20) ** 2))
NOISE = np.random.default_rng(2).normal(size=400)


@pytest.mark.parametrize(
    ("f", "named"),
    [
        (np.exp(-(((N - 300) / 8.0) ** 2)), "1[0-5] samples"),
        (
            np.exp(-(((N - 30) / 12.0) ** 2)),
            "no part of the record is before the pulse: 0",
        ),
        (np.exp(-(((N - 399) / 12.0) ** 2)), "back"),
        (0 * N, "no pulse"),
        (np.nan * N, "must be finite"),
        (PULSE + 0.07 * NOISE, "the noise is "),
        (39.1 * np.minimum(PULSE, 0.97) / 0.97, r"saturates at 39.1 from 297 to 303"),
        (np.minimum(PULSE + 0.003 * NOISE, 0.9), "saturates at 0.9 from 29"),
        (
            np.round(120 * np.minimum(PULSE + 0.003 * NOISE, 0.9)) / 120,
            "saturates at 0.9 from 29",
        ),
        (2 - PULSE + 0.01 * NOISE, "inverted"),
        (
            PULSE + np.exp(-(((N - 345) / 20) ** 2)),
            "pulses overlap: peaks at 30[01] and 34[45]",
        ),
        (0.6 * PULSE + np.exp(-(((N - 345) / 20) ** 2)), "pulses overlap"),
    ],
)
def test_records_without_a_measurable_pulse_are_refused(f, named):
    with pytest.raises(MeasureError, match=named):
        noisy_pulse(N, f)


def test_many_samples_are_averaged():
    """Thirty thousand samples a width: the errors are those of the samples themselves."""
    t = np.linspace(-6, 3, 270_001)
    f = np.exp(-((2 * t) ** 2 * np.log(2))) + 0.02 * np.random.default_rng(3).normal(
        size=len(t)
    )
    numbers = noisy_pulse(t, f).numbers
    for name, value in (("arrival", 0), ("peak", 1), ("fwhm", 1)):
        assert abs(numbers[name].value - value) < 3 * numbers[name].error < 6e-3
