"""The first pulse of a measured record.

A pulse is located in a moving mean. The record before the first pulse gives the base and the noise
(`validation.pulses.base`); arrival, peak and FWHM are those of a spline fitted to the samples
(`validation.pulses.fitted`), with one standard deviation as errors. Samples on one level of the
recorder err alike if their noise is below half the distance of the levels: drawn records are then
rounded to the levels. A record whose noise is below `_EXACT` of the peak is that of a program: its
pulses are those of the cubic spline through all samples, and the errors the differences to the
spline through every other sample.

Behind a piezoelectric sensor and its amplifier, which lose their charge, a force f gives a signal v
with ``v' = f' - v/T``, T the time constant. So ``f = v + ∫ v dt/T``, and v swings below its base
behind a pulse.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import cumulative_trapezoid
from scipy.signal import find_peaks

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from lwa.spheres.units import fitting
from validation.pulses.base import FEWEST_FOR_BASE, Base
from validation.pulses.fitted import fitted
from validation.pulses.pulse import (
    READINGS,
    MeasureError,
    checked,
    first_pulse,
    readings,
    spline,
)
from validation.scenes.cells import longest

_EARLY = 5  # samples at the start of the record that locate its base
_FEWEST = 16  # samples above half the peak; with 12 the errors are too small
_FEWEST_EXACT = 6  # samples above half the peak in a record without noise
_MOST = 400  # samples above half the peak; of more, neighbours are averaged
_SMOOTH = 0.01  # noise of the moving mean over the peak
# Share of the peak below which a pulse has fallen. It is less than a half: with a half, noise on
# the front, where the signal has just passed half its peak, would count as the end of the pulse.
_LOW = 0.45
# Share of the record's range: samples that differ by less, as by the rounding of printed numbers,
# are equal.
_EQUAL = 1e-6
_CONSTANT = 1e-8  # range of a signal without pulses, over its size
# Logarithm of the growth in a width from which on a force begins suddenly: that of a Gaussian two
# widths before its top.
_SUDDEN = 11.0
_GRID = 400  # intervals in which the maxima of a pulse are looked for
_SAME = 0.01  # distance, over the width, of two readings of one maximum
_EXACT = 1e-4  # noise over the peak of a record without noise
_UPRIGHT = 0.1  # least rise of a record over its fall; with less the record is inverted
# Widths behind the arrival: ends of two stretches that are searched for an undershoot
_BEHIND = (1.5, 2.5, 3.5)
# Least depth of an undershoot, the mean of a stretch, in errors of the peak, which hold that of the
# base. Of 540 records without an undershoot none has the line of `suggested`; with the noise in
# place of this error 29 had it.
_SURE = 2.0
_SHALLOWEST = 0.002  # least depth over the peak
_ALIKE = 1.5  # largest ratio of the time constants by the two stretches


class InvertedError(MeasureError):
    """A record that falls where pulses rise: its sign may be the wrong one."""


@dataclass(frozen=True)
class NoisyPulse:
    """A pulse of a record.

    Parameters
    ----------
    numbers : mapping of Estimate
        Arrival, peak above the base and fwhm, by these names; without the peak if the record begins
        too late for a base.
    base : float
        Value below the pulse, at the time ``rise``.
    missing : str, optional
        Words on the number that is missing.
    rise : float
        Time at which the pulse rises through half of its peak.
    slope : float
        Growth of the base in time.
    noise : float
        Standard deviation, times ``√n``, of the mean noise of n samples; 0 in a record without
        noise.
    """

    numbers: Mapping[str, Estimate]
    base: float
    missing: str | None = None
    rise: float = 0.0
    slope: float = 0.0
    noise: float = 0.0


def noisy_pulse(time: ArrayLike, values: ArrayLike, unit: str = "") -> NoisyPulse:
    """Measure the first pulse of a record.

    Parameters
    ----------
    time, values : array_like
        Times and values of the samples, (S,).
    unit : str
        Unit of the times, for messages.

    Returns
    -------
    NoisyPulse
        Errors are one standard deviation.

    Raises
    ------
    MeasureError
        For a record without a whole pulse, for a pulse that is clipped, inverted, or has fewer
        than 16 samples above half of its peak (6 in a record without noise), and for noise above
        5 % of the peak.

    Examples
    --------
    >>> t = np.linspace(-4, 3, 701)
    >>> noise = 0.01 * np.random.default_rng(0).normal(size=701)
    >>> print(noisy_pulse(t, np.exp(-9 * t**2) + noise).numbers["fwhm"])  # √(4 ln 2)/3
    0.557 ± 0.003
    """
    t, f = checked(time, values)
    size = float(np.abs(f).max()) or 1.0  # so that squares neither over- nor underflow
    f = f / size
    swing = np.ptp(f)
    if swing < _CONSTANT:
        raise MeasureError("no pulse is in the record: its signal is constant")
    step = _step(f)
    if _is_exact(f) and step < _EXACT * swing:
        pulse = _exact(t, f)
    else:
        pulse = _noisy(t, f, step, unit)
    # Times are known to the last digit of a float: 2e-7 s if they count from 1970.
    farthest = np.abs(t).max()
    resolution = np.spacing(farthest)
    numbers = {}
    for name, number in pulse.numbers.items():
        if name == "peak":
            numbers[name] = number * size
        else:
            error = max(number.error, resolution)
            numbers[name] = Estimate(number.value, error)
    return replace(
        pulse,
        numbers=numbers,
        base=pulse.base * size,
        slope=pulse.slope * size,
        noise=pulse.noise * size,
    )


def _noisy(t: Array, f: Array, step: float, unit: str) -> NoisyPulse:
    """Measure the first pulse of a record with noise.

    Samples are rounded to levels at the distance ``step``; times have the ``unit``.
    """
    start = f[:_EARLY].mean()
    rise, fall = _place(t, f - start)
    width = fall - rise
    in_pulse = (t > rise) & (t < fall)
    inside = int(np.count_nonzero(in_pulse))
    # Means of blocks of neighbours stand for the samples of a record with many.
    block = max(1, inside // _MOST)
    whole = len(t) // block * block
    samples = np.array((t, f))[:, :whole]
    blocks = samples.reshape(2, -1, block)
    at, means = blocks.mean(axis=2)
    base = Base.before(at, means, rise, width)
    missing = None
    if base is None:
        base = Base.guessed(means, _noise_by_neighbours(means))
        spacing = np.median(np.diff(t))
        # About as much as `Base.before` needs: the shortest base, and a width up to the rise.
        wanted = max(2 * width, FEWEST_FOR_BASE * spacing)
        missing = (
            f"no peak: the record starts {in_unit(rise - t[0], unit)} before the pulse, and "
            f"{in_unit(wanted, unit)} are wanted for its base"
        )
    # Noise of half a level or more spreads the samples over the levels and tells their rounding.
    rounding = 0.0
    if base.best.variance < (step / 2) ** 2:
        rounding = step
    _check_top(t, f, (rise, fall), _FEWEST, step)
    above = means - base.at(at)
    numbers = fitted(at, above, base, (rise, fall), rounding)
    if missing:
        del numbers["peak"]
    ends = np.array([rise, fall])
    level, later = base.at(ends).tolist()
    slope = (later - level) / width
    # The mean noise of n samples, n/block of the means, has the variance σ² · correlation time over
    # their number, σ² being that of a mean: times n it no longer depends on n (`NoisyPulse.noise`).
    correlated = base.best.variance * base.best.correlation_time
    noise = math.sqrt(correlated * block)
    return NoisyPulse(numbers, level, missing, rise, slope, noise)


def _is_exact(f: Array) -> bool:
    """True for a record without noise before it first exceeds half of its maximum.

    Such a record is, within `_EXACT` of its range, constant at its start, or rises without a fall
    and with at most one change of the sign of its curvature.
    """
    swing = f - f[0]
    if swing.max() < _UPRIGHT * -swing.min():
        return False  # the moving mean tells that it is inverted
    least = _EXACT * np.ptp(f)
    rise = np.argmax(swing > swing.max() / 2)
    before = f[:rise]
    early = before[: len(before) // 4]
    if len(early) >= _EARLY and np.ptp(early) < least:
        return True
    # The signal may rise smoothly from the start: noise falls as well, and bends to and fro.
    falls = np.minimum(np.diff(before), 0.0)
    bends = np.diff(before, 2)
    clear = bends[np.abs(bends) > least]
    signs = np.sign(clear)
    turns = np.count_nonzero(np.diff(signs))
    return bool(len(before) and -falls.sum() < least and turns < 2)


def _exact(t: Array, f: Array) -> NoisyPulse:
    """Measure the first pulse of a record without noise, whose base is its first sample."""
    level = float(f[0])
    above = f - level
    # Counted from the start, times far from zero, as seconds since 1970, keep their digits.
    start = float(t[0])
    x = t - start
    signal = spline(x, above)
    pulse = first_pulse(signal)
    sides = (start + pulse.rise, start + pulse.fall)
    _check_top(t, f, sides, _FEWEST_EXACT)
    numbers = readings(pulse)
    errors = dict.fromkeys(numbers, 0.0)
    for first in (0, 1):
        coarse = spline(x[first::2], above[first::2])
        rough = readings(first_pulse(coarse))
        for name, value in numbers.items():
            difference = abs(value - rough[name])
            errors[name] = max(errors[name], difference)
    # Which of two humps is the higher is unsure within the error of the peak.
    times = np.linspace(pulse.rise, pulse.fall, _GRID + 1)
    least = pulse.peak - errors["peak"]
    tops, _ = find_peaks(signal(times), height=least)
    distances = np.abs(times[tops] - pulse.arrival)
    apart = distances.max(initial=0.0)
    if apart > _SAME * pulse.fwhm:
        errors["arrival"] = max(errors["arrival"], apart + _SAME * pulse.fwhm)
    # A base that is off by this much moves the peak as much, and both flanks at its half. As x
    # begins with 0, x[1] is the time from sample to sample.
    doubt = _front(f, pulse.fwhm / x[1]) / pulse.peak
    for name in ("peak", "fwhm"):
        errors[name] += doubt * numbers[name]
    numbers["arrival"] += start
    estimates = map(Estimate, numbers.values(), errors.values())
    return NoisyPulse(dict(zip(READINGS, estimates, strict=True)), level)


def _front(f: Array, width: float) -> float:
    """Return the error of the first sample as the base of a record that begins in a front.

    The pulse has the ``width`` in samples. A record that begins with 0 may be that of a force which
    begins suddenly; the base of another one lies from 0 to its first sample.
    """
    first, second = map(float, np.diff(f[:3]))
    # Without any knowledge of the foot: the base lies from 0 to the first sample, or a step below.
    unknown = max(abs(float(f[0])), first)
    if 0 < first < second:
        # Differences of a + b e^{n g}, n the number of a sample, grow by the factor e^g.
        factor = second / first
        if f[0] == 0 and math.log(factor) * width > _SUDDEN:
            return 0.0
        # b e^{n g} at the first sample: how far the exponential has risen above its base a
        risen = first / (factor - 1)
        return risen if f[0] == 0 else min(risen, unknown)
    # A front past its steepest place tells nothing of its foot.
    return unknown if first > _EXACT * np.ptp(f) else abs(first)


def in_unit(time: float, unit: str) -> str:
    """Return a time as text, with a prefix of its unit that suits its size."""
    suited = fitting(unit, time)
    return f"{time / suited.size:.3g} {suited.name}".strip()


def _noise_by_neighbours(f: Array) -> float:
    """Return the standard deviation of the noise, by the differences of neighbouring samples."""
    # Fourth differences of a smooth pulse are small; those of white noise have the variance 70 σ².
    # A quarter of them lies below 0.3186 of their standard deviation, where the record is calm.
    if len(f) < 5:
        return 0.0
    differences = np.abs(np.diff(f, 4))
    calm = float(np.quantile(differences, 0.25))
    return calm / (0.3186 * math.sqrt(70))


def _step(f: Array) -> float:
    """Return the distance of the levels to which a recorder rounds; 0 if there are none."""
    gaps = np.diff(np.unique(f))
    swing = np.ptp(f)
    # More than a million different values may leave no gap above `_EQUAL`: that record has no
    # levels, and as one gap, the range, it is found below to have none.
    least = min(gaps[gaps > _EQUAL * swing], default=swing)
    # Printed levels are rounded, too: the range, of many levels, gives their distance best.
    step = swing / round(swing / least)
    levels = (f - f.min()) / step
    off = np.abs(levels - levels.round())
    # Values that have nothing to do with the levels are up to half a step off, rounded levels
    # far less: a quarter tells them apart.
    if off.max() > 0.25:
        return 0.0
    return float(step)


def _place(t: Array, f: Array) -> tuple[float, float]:
    """Return rough times at which the first pulse rises and falls through half of its peak.

    They are the last time before, and the first time behind, the top at which a moving mean is
    below `_LOW` of the top.
    """
    # The moving mean. The mean of n samples of noise σ has the noise σ/√n, which is _SMOOTH times
    # the peak for n = (σ/(_SMOOTH peak))².
    highest = max(f.max(), np.finfo(float).tiny)
    noise = _noise_by_neighbours(f) / (_SMOOTH * highest)
    count = math.ceil(min(max(1.0, noise**2), len(f)))
    weights = np.full(count, 1 / count)
    g = np.convolve(f, weights, "same")
    if -g.min() > max(g.max(), 0):
        raise InvertedError(
            "the signal falls farther below its start than it rises: it begins in a pulse, or is "
            "inverted"
        )
    # The first pulse: from where the mean first exceeds half of its maximum to where it next falls
    # below _LOW of the maximum.
    peak = g.max()
    start = np.argmax(g > peak / 2)
    fallen = np.append(g[start:] < _LOW * peak, True)
    end = start + np.argmax(fallen)
    top = start + np.argmax(g[start:end])
    # The sides of the pulse, now by its own top: another pulse may be higher.
    below = np.flatnonzero(g < _LOW * g[top])
    after = np.searchsorted(below, top)
    if after in (0, len(below)):
        side = "back" if after else "front"
        raise MeasureError(
            f"the pulse is not wholly in the record: its {side} does not pass half its peak"
        )
    rise, fall = t[below[after - 1 : after + 1]]
    return float(rise), float(fall)


def _check_top(
    t: Array, f: Array, sides: tuple[float, float], fewest: int, step: float = 0.0
) -> None:
    """Refuse a pulse between two times that has few samples or that is clipped.

    sides : times at which the pulse rises and falls through half of its peak. step : distance of
    the levels to which samples are rounded.
    """
    rise, fall = sides
    inside = np.flatnonzero((t > rise) & (t < fall))
    width = len(inside)  # FWHM in samples
    if width < fewest:
        raise MeasureError(
            f"{width} samples lie above half the pulse's peak: at least {fewest} are wanted"
        )
    samples = f[inside]
    top = samples.max()
    peak = 2 * (top - samples.min())  # as all these samples lie above its half
    # The longest run of samples at the top, equal but for `_EQUAL` of the record's range.
    start, end = longest(samples >= top - _EQUAL * np.ptp(f))
    # A smooth pulse about its top is peak (1 - 4 ln 2 (t/width)²), as a Gaussian is; 4 ln 2 ≈ 2.7.
    # It stays within a step of its top for the time 2 width √(step/(2.7 peak)); a run of twice as
    # many samples, and three, is no top. If all are equal, as in a square pulse, nothing is known
    # of the top.
    run = end - start
    if run == width or run > 3 + 4 * width * math.sqrt(step / (2.7 * peak)):
        first, *_, last = t[inside[start:end]]
        raise MeasureError(
            f"the record is clipped from {first:.6g} to {last:.6g}: a larger range of the "
            "recorder is wanted"
        )


def corrected(t: Array, signal: Array, constant: float) -> Array:
    """Return the force behind the signal of a sensor with a time constant.

    An error of the base makes a slope, which the base of a pulse takes out.
    """
    swing = signal - signal[:_EARLY].mean()
    charge = cumulative_trapezoid(swing, t, initial=0)
    return np.asarray(signal + charge / constant)


def suggested(t: Array, signal: Array, pulse: NoisyPulse, unit: str) -> str:
    """Return a line on an undershoot behind a pulse, with the time constant; "" without any.

    Waves behind a pulse rarely swing alike in both stretches. Times have the ``unit``.
    """
    arrival = pulse.numbers["arrival"].value
    width = pulse.numbers["fwhm"].value
    # A base that falls is no undershoot.
    fall = min(pulse.slope, 0.0)
    base = pulse.base + fall * (t - pulse.rise)
    swing = signal - base
    charge = cumulative_trapezoid(swing, t, initial=0)
    constants = []
    for start, end in pairwise(_BEHIND):
        behind = (t - arrival) / width
        inside = (behind > start) & (behind < end)
        below = -swing[inside]
        if len(below) < _EARLY:
            return ""
        error = pulse.numbers["peak"].error
        if not 0 < _SURE * error < below.mean() > _SHALLOWEST * swing.max():
            return ""
        # Behind the pulse the force f = v + charge/T is 0: T = charge/(-v).
        constant = charge[inside].mean() / below.mean()
        constants.append(constant)
    near, far = constants
    if not 1 / _ALIKE < near / far < _ALIKE:
        return ""
    return (
        "the signal falls below its base behind the pulse, as that of a sensor that loses its "
        f"charge: --time-constant '{in_unit(near, unit)}' corrects it"
    )
