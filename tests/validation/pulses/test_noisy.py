"""Pulses of noisy records: bias and coverage by draws, against the same pulse without noise."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy

from validation import simulate
from validation.pulses.base import Base
from validation.pulses.noisy import corrected, noisy_pulse, suggested
from validation.pulses.pulse import MeasureError, first_pulse, spline
from validation.studies.paper import recorded_chain

NUMBERS = ("arrival", "peak", "fwhm")
STATIC = 1.5
WIDTH = 47.0  # samples, of the paper's pulses at 1 MHz


@pytest.fixture(scope="module")
def signals():
    """Forces of beads of the paper's 1:1 and 2:1 columns, by column and bead."""
    found = {}
    for N in (1, 2):
        run = simulate(replace(recorded_chain((8, 16, 24), N=N), duration=1.2e-3))
        for i in run.scene.bead_sensors:
            found[N, i + 1] = run.signal("bead", i)
    return found


def at_widths(signal):
    """The signal as a function of widths from its arrival, of peak 1; 0 outside of the run."""
    pulse = first_pulse(signal)

    def pulse_at(x):
        t = pulse.arrival + pulse.fwhm * x
        inside = (t > 0) & (t < signal.times[-1])
        return np.where(inside, signal(np.where(inside, t, 0.0)), 0.0) / pulse.peak

    return pulse_at


def numbers_of(function):
    """Arrival, peak and FWHM of a function of time in widths."""
    x = np.linspace(-12, 3, 15_001)
    pulse = first_pulse(spline(x, function(x)))
    return np.array([getattr(pulse, name) for name in NUMBERS])


def slow(x, rng):
    """Noise behind Butterworth's second order at a tenth of the highest frequency."""
    poles = scipy.signal.butter(2, 0.1)
    response = scipy.signal.lfilter(*poles, np.eye(1, 500)[0])
    noise = scipy.signal.lfilter(*poles, rng.normal(size=len(x) + 500))[500:]
    return noise / np.linalg.norm(response)


def hum(x, rng):
    """A hum of 50 Hz, of 2 % of the peak, and white noise."""
    phase = 50 * 47e-6 * x + rng.random()
    return 0.02 * np.sin(2 * np.pi * phase) + 0.005 * rng.normal(size=len(x))


NOISE = {  # of a record, by times in widths and generator
    "white, 0.2 %": lambda x, rng: 0.002 * rng.normal(size=len(x)),
    "white, 2 %": lambda x, rng: 0.02 * rng.normal(size=len(x)),
    "low-passed": lambda x, rng: 0.005 * slow(x, rng),
    "drifting": lambda x, rng: 0.002 * x + 0.005 * rng.normal(size=len(x)),
    "humming": hum,
}
SHAPES = ("forerunning", "discharging")  # of white noise of 0.2 %
LEVELS = {
    "8 bits": 0.5,
    "8 bits, little noise": 0.05,
}  # noise over the levels' distance
KINDS = (*NOISE, *SHAPES, *LEVELS)


def forerunner(x):
    """A tail of 5 % that grows within a width and a half, and ends in the pulse."""
    return 0.05 * np.exp(x / 1.5) / (1 + np.exp((x - 0.8) / 0.15))


def discharged(x, f, constant):
    """The signal of a sensor with a time constant, by the midpoint rule."""
    kept = math.exp(-(x[1] - x[0]) / constant)
    return scipy.signal.lfilter(math.sqrt(kept) * np.array([1, -1]), [1, -kept], f)


def coverage(pulses, kind, copies, samples=WIDTH):
    """Biases and errors over the scatter, and shares of the errors that cover, each (3,)."""
    cleans = pulses
    if kind == "forerunning":
        cleans = [lambda x, pulse=pulse: pulse(x) + forerunner(x) for pulse in pulses]
    true = [numbers_of(clean) for clean in cleans]
    # Kinds of their own seeds: the same noise in all of them would err alike.
    rng = np.random.default_rng([*kind.encode()])
    rows = []
    for copy in range(copies):
        place = copy % len(pulses)
        x = np.arange(-12, 3, 1 / samples) + rng.random() / samples
        f = cleans[place](x)
        if kind == "discharging":
            f = discharged(x, f, 21.0)
        if kind in LEVELS:
            # At a peak of a whole number of levels, base and top would be rounded alike.
            levels = rng.uniform(190, 210)
            noise = LEVELS[kind] * rng.normal(size=len(x))
            f = np.round(levels * f + rng.random() + noise) / levels
        else:
            f = f + NOISE.get(kind, NOISE["white, 0.2 %"])(x, rng)
        if kind == "discharging":
            f = corrected(x, f, 21.0)
        numbers = noisy_pulse(x, STATIC + f).numbers
        pairs = [(numbers[name].value, numbers[name].error) for name in NUMBERS]
        rows.append(np.subtract(np.transpose(pairs), (true[place], np.zeros(3))))
    off, errors = np.moveaxis(np.array(rows), 1, 0)
    scatter = off.std(axis=0)
    within = np.mean(np.abs(off) < errors, axis=0)
    return (
        np.abs(off.mean(axis=0)) / scatter,
        np.median(errors, axis=0) / scatter,
        within,
    )


SOME = ("low-passed", "8 bits, little noise")
EVERY = [pytest.param(kind, 200, marks=pytest.mark.slow) for kind in KINDS]


@pytest.mark.parametrize(("kind", "copies"), [*((kind, 50) for kind in SOME), *EVERY])
def test_errors_are_one_standard_deviation(signals, kind, copies):
    """60 … 80 % of 200 copies of two pulses lie within their errors; bias: half the scatter.

    Two spreads more of 50 copies.
    """
    pulses = [at_widths(signals[1, 24]), at_widths(signals[2, 8])]
    bias, _, within = coverage(pulses, kind, copies)
    spread = 0.0 if copies == 200 else 0.13
    assert np.all(bias < 1 / 2 + spread), bias
    assert np.all((within >= 0.6 - spread) & (within <= 0.8 + spread)), within


def test_too_few_samples_make_errors_larger(signals):
    """17 samples a width of a pulse with ripples: errors cover, 30 times too large at most."""
    bias, error, within = coverage([at_widths(signals[2, 8])], "white, 0.2 %", 25, 17)
    assert np.all(bias < np.maximum(error, 1) / 3)
    assert np.all(within > 0.6)
    assert np.all(error < 30)


def test_the_arrival_of_two_equal_humps_is_uncertain_by_their_distance():
    """Half of the copies have the other hump as the higher one."""
    t = np.arange(-20, 10, 0.03)
    rng = np.random.default_rng(5)
    f = np.exp(-((t - 0.9) ** 2)) + np.exp(-((t + 0.9) ** 2))
    later = abs(t[np.argmax(f)])
    covered = 0
    for _ in range(20):
        noisy = noisy_pulse(t, f + 0.02 * rng.normal(size=len(t))).numbers["arrival"]
        covered += abs(noisy.value - later) < noisy.error
    assert covered > 0.45 * 20


@pytest.mark.parametrize(("lead", "louder"), [(3.5, 1), (12, 10)])
def test_a_short_lead_and_noise_of_the_pulse_itself_are_in_the_error(lead, louder):
    """A line through a width and a half of samples errs more at the pulse than the fit does."""
    rng = np.random.default_rng(8)
    t = np.arange(-lead - 0.5, 2.5, 0.03)
    clean = 0.7 + np.exp(-4 * np.log(2) * t**2)
    within = 0
    for _ in range(30):
        noise = 0.01 * np.where(t > -1.5, 1, 1 / louder) * rng.normal(size=len(t))
        peak = noisy_pulse(t, clean + noise).numbers["peak"]
        within += abs(peak.value - 1) < peak.error
    assert 0.5 <= within / 30 <= 0.9


@pytest.mark.parametrize(("samples", "bound"), [(7, 0.1), (17, 1e-3), (70, 2e-6)])
def test_a_record_without_noise_gives_the_pulse_of_the_signal(signals, samples, bound):
    """The error covers what the samples do not resolve; the base is the first sample."""
    pulse_at = at_widths(signals[1, 24])
    x = np.arange(-5, 3, 1 / samples)
    found = noisy_pulse(x, STATIC + pulse_at(x))
    assert found.base == pytest.approx(STATIC, rel=1e-12)
    for name, true in zip(NUMBERS, numbers_of(pulse_at), strict=True):
        number = found.numbers[name]
        assert abs(number.value - true) < number.error + 1e-9, name
        assert number.error < bound, name


@pytest.mark.parametrize("at", [40, 60, 80, 100])
def test_a_record_may_begin_in_the_front_of_its_pulse(at):
    """A Gaussian of width 30: what it has risen to by its first sample is in the errors."""
    t = np.arange(400.0)
    found = noisy_pulse(t, np.exp(-(((t - at) / 30) ** 2))).numbers
    for name, true in (("peak", 1), ("fwhm", 60 * math.sqrt(math.log(2)))):
        number = found[name]
        assert abs(number.value - true) < number.error < 30 * abs(number.value - true)


def test_many_samples_are_averaged():
    """Thirty thousand samples a width: the errors are those of the samples themselves."""
    t = np.linspace(-6, 3, 270_001)
    noise = 0.02 * np.random.default_rng(3).normal(size=len(t))
    numbers = noisy_pulse(t, np.exp(-4 * np.log(2) * t**2) + noise).numbers
    for name, value in (("arrival", 0), ("peak", 1), ("fwhm", 1)):
        assert abs(numbers[name].value - value) < 3 * numbers[name].error < 6e-3


@pytest.mark.parametrize("noise", [0, 0.001])
def test_times_that_count_from_1970_err_by_the_last_digit_of_a_float(noise):
    """Samples each microsecond, at times that are known to 2e-7 s."""
    off = []
    for arrival in np.linspace(270, 271, 20):
        f = np.exp(-(((N - arrival) / 30) ** 2)) + noise * WHITE
        found = noisy_pulse(1.7e9 + 1e-6 * N, f).numbers["arrival"]
        off.append((found.value - 1.7e9 - 1e-6 * arrival) / found.error)
    assert 1 / 30 < np.abs(off).max() < 1


def test_a_record_that_begins_too_late_has_an_arrival_and_a_width(signals):
    pulse_at = at_widths(signals[1, 24])
    x = np.arange(-2, 3, 1 / WIDTH)
    noise = 0.002 * np.random.default_rng(1).normal(size=len(x))
    found = noisy_pulse(x, pulse_at(x) + noise, "s")
    assert found.missing.startswith(
        "no peak: the record starts 1.45 s before the pulse"
    )
    arrival, _, width = numbers_of(pulse_at)
    assert list(found.numbers) == ["arrival", "fwhm"]
    assert abs(found.numbers["arrival"].value - arrival) < 0.02
    assert abs(found.numbers["fwhm"].value - width) < 0.05


@pytest.mark.parametrize("constant", [21.0, 5.0])
def test_a_sensor_that_loses_its_charge_is_told_by_its_undershoot(constant):
    x = np.arange(-12, 8, 1 / WIDTH)
    pulse = np.exp(-4 * np.log(2) * x**2)
    noise = 0.001 * np.random.default_rng(1).normal(size=len(x))
    f = discharged(x, pulse, constant) + noise
    hint = suggested(x, f, noisy_pulse(x, f), "")
    told = float(hint.split("--time-constant '")[1].split("'")[0])
    assert told == pytest.approx(constant, rel=0.1)
    for slope in (0.0, -0.02):
        f = pulse + noise + slope * x
        assert suggested(x, f, noisy_pulse(x, f), "") == "", slope


N = np.arange(400.0)
PULSE = np.exp(-(((N - 300) / 20) ** 2))
WHITE = np.random.default_rng(2).normal(size=400)


@pytest.mark.parametrize(
    ("f", "named"),
    [
        (np.exp(-(((N - 300) / 8) ** 2)) + 0.001 * WHITE, "1[0-5] samples"),
        (np.exp(-(((N - 300) / 2) ** 2)), "[35] samples"),
        (np.exp(-(((N - 399) / 12) ** 2)), "it peaks at the end"),
        (0 * N, "constant"),
        (np.nan * N, "must be finite"),
        (PULSE + 0.07 * WHITE, "the noise is "),
        (39.1 * np.minimum(PULSE, 0.97) / 0.97, "clipped from 297 to 303"),
        (np.minimum(PULSE + 0.003 * WHITE, 0.9), "clipped from 29"),
        (np.round(120 * np.minimum(PULSE + 0.003 * WHITE, 0.9)), "clipped from 29"),
        # square: all samples inside are equal
        (np.where(abs(N - 300) < 20, 1, 0.003 * WHITE), "clipped from 281 to 319"),
        (2 - PULSE + 0.01 * WHITE, "is inverted"),
        (2 - PULSE, "is inverted"),
        # the second sample is the highest
        (np.where(N == 1, 0.05, 0.01 * WHITE) - PULSE, "is inverted"),
    ],
)
def test_records_without_a_measurable_pulse_are_refused(f, named):
    with pytest.raises(MeasureError, match=named):
        noisy_pulse(N, f)


def two_humps(t):
    """A pulse whose second hump is higher by 3e-5, as that of a bead between two contacts."""
    return np.exp(-((t - 0.4) ** 2) / 0.2) + 0.99997 * np.exp(-((t + 0.4) ** 2) / 0.2)


@pytest.mark.parametrize("samples", [6.5, 9.0, 12.0])
def test_the_arrival_of_two_humps_is_unsure_by_their_distance(samples):
    """Without noise, too: coarse samples do not tell which of two humps is the higher."""
    dense = np.linspace(-5, 5, 20_001)
    true = first_pulse(spline(dense, two_humps(dense)))
    missed = 0
    for start in np.linspace(0, 1, 9):
        t = np.arange(-5, 5, true.fwhm / samples) + start * true.fwhm / samples
        numbers = noisy_pulse(t, two_humps(t)).numbers
        for name in NUMBERS:
            off = numbers[name].value - getattr(true, name)
            assert abs(off) < numbers[name].error < 0.6 * true.fwhm, name
        missed += numbers["arrival"].value < 0
    assert missed > 0


def test_the_doubt_between_two_bases_is_in_the_drawn_errors():
    """Without any noise, the draws lie where each of two equally likely bases would put a pulse."""
    base = Base.guessed(np.repeat([1.0, 0.0], [5, 95]), 0.0)
    t = np.linspace(0, 1, 5)
    drawn = base.drawn(t, np.zeros(5), 0.0, 0.0)
    assert set(drawn.ravel().round(12)) == {-0.5, 0.5}
    assert abs(drawn.mean()) < 0.1
