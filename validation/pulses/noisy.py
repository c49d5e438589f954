"""Pulses of measured records: a spline fitted to noisy samples, and errors from the noise.

The record before the pulse gives the base and its slope, by a straight line, and the noise: its
standard deviation and its correlations, from the residuals of the line. The first pulse is located
in a moving mean, and a spline of degree 5 is fitted to the samples about it by least squares:
arrival, peak and FWHM are those of the spline. The number of its coefficients is the best by
Schwarz's criterion (Ann. Statist. 6, 461, 1978), for as many samples as are independent, times
`_FINER`, and at least `_MORE` more: where the criterion stops a bias is as large as the scatter.

Errors are one standard deviation: `_DRAWS` records of noise with the spectrum of the noise before
the pulse are added, base and spline are fitted to each, and `_WITHIN` of the numbers lie within the
error. So an arrival is uncertain by the distance of two humps if the noise hides which of them is
the higher. Samples on one level of the recorder err alike if their noise is below half the distance
of the levels: the drawn records are then rounded to the levels, with base and pulse at random
between two of them. If the record has too few samples for the wanted coefficients, the error also
holds the difference to a coarser spline.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline, make_lsq_spline
from scipy.signal import find_peaks

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from validation.pulses.pulse import MeasureError, highest_pulse
from validation.pulses.signals import Piecewise, checked

_BESIDE = 0.3  # widths in front of the rise and behind the fall that the fit takes in
_READ = 0.1  # widths likewise in which the spline is read: its ends follow the noise
_BEFORE = 2.0  # widths between the samples of the base and the rise
_LEAD = 10.0  # widths of the base: a straight line errs by the square of its length
_CALM = 16  # fewest samples of the base, over a width at least
_FEWEST = 16  # samples above half the peak; with 12 the errors no longer cover
_MOST = 400  # samples above half the peak; of more, neighbours are averaged
_DEGREE = 5  # of the spline
_LOWEST, _HIGHEST, _STEP = (
    8,
    120,
    1.2,
)  # numbers of coefficients that are tried, and their ratio
_FINER, _MORE = 1.5, 8  # coefficients in the end: a multiple, and at least so many more
_DENSEST = 0.8  # coefficients over samples, at most
_COARSER = 1.3  # coefficients over those of the spline that shows what is not resolved
_DRAWS, _WITHIN = (
    200,
    0.7,
)  # 0.68 and a little: the number of coefficients depends on the noise
_GRID = 400  # intervals on which drawn splines are read
_MISFIT = 2.0  # residuals over σ², from which on they are the noise
_SMOOTH = 0.01  # noise of the moving mean over the peak
_LOW = 0.45  # share of the peak below which a pulse has fallen, so that noise at half is no end
_APART = 0.2  # share of the peak to which the signal falls between pulses that do not overlap
_HUMP = (
    0.25  # depth, over the peak, of the dip between two pulses; less lies in a pulse
)
_LATER = 0.1  # smallest peak of a later pulse over the first
_LOUDEST = 0.05  # greatest noise over the peak, for which the pulse is located
_EQUAL = 1e-6  # of the record's range: samples that differ less are equal


@dataclass(frozen=True)
class NoisyPulse:
    """A pulse of a record, each number with one standard deviation as its error.

    numbers : arrival, peak above the base, fwhm, by these names.
    base : mean of the samples before the first pulse.
    """

    numbers: Mapping[str, Estimate]
    base: float


def noisy_pulse(time: ArrayLike, values: ArrayLike) -> NoisyPulse:
    """Measure the first pulse of a record with noise, sample times and values (S,).

    Raises `MeasureError` for a record without a whole pulse or without a part before the pulse, for
    a pulse that is clipped, inverted, overlaps another one, or has fewer than 16 samples above half
    of its peak, and for noise above 5 % of the peak.

    >>> t = np.linspace(-4, 3, 701)
    >>> noise = 0.01 * np.random.default_rng(0).normal(size=701)
    >>> print(noisy_pulse(t, np.exp(-9 * t**2) + noise).numbers["fwhm"])  # √(4 ln 2)/3
    0.557 ± 0.004
    """
    return next(noisy_pulses(time, values))


def noisy_pulses(time: ArrayLike, values: ArrayLike) -> Iterator[NoisyPulse]:
    """Measure the pulses of a record one after the other, as `noisy_pulse` does the first.

    All have the base and the noise of the record before the first pulse. Raises `MeasureError`
    where the next pulse, of a tenth of the first one's peak or more, cannot be measured.
    """
    t, f = checked(time, values)
    size = float(np.abs(f).max()) or 1.0  # so that squares neither over- nor underflow
    f = f / size
    levels = np.unique(f)
    gaps = np.diff(levels)
    least = _EQUAL * (levels[-1] - levels[0])
    resolution = float(min(gaps[gaps > least], default=0.0))
    rise, fall = _place(t, f - f[:_CALM].mean())
    width = fall - rise
    lead = (t < rise - _BEFORE * width) & (t > rise - (_BEFORE + _LEAD) * width)
    if np.count_nonzero(lead) < _CALM or np.ptp(t[lead]) < 0.9 * width:
        raise MeasureError(
            f"no part of the record is before the pulse: {np.count_nonzero(lead)} samples lie "
            f"{_BEFORE:g} widths before it, {_CALM} over a width are wanted for base and noise"
        )
    line = np.polynomial.Polynomial.fit(t[lead], f[lead], 1)
    base, first = float(f[lead].mean()), 0.0
    # Noise of half a level or more spreads the samples over the levels and tells their rounding.
    quiet = np.std(f[lead] - line(t[lead])) < resolution / 2
    step = resolution if quiet else 0.0
    block = max(1, int(np.count_nonzero((t > rise) & (t < fall))) // _MOST)
    while True:
        _check_top(t, f, (rise, fall), resolution, size)
        whole = len(t) // block * block
        rows = np.array((t, f, lead), float)[:, :whole]
        at, values, calm = rows.reshape(3, -1, block).mean(axis=2)
        numbers = _measured(at, values - line(at), calm == 1, (rise, fall), step)
        first = first or numbers["peak"].value
        numbers["peak"] = numbers["peak"] * size
        yield NoisyPulse(numbers, base * size)
        behind = t > 2 * fall - rise
        later = f[behind] - line(t[behind])
        if not later.max(initial=0.0) > _LATER * first:
            return
        rise, fall = _place(t[behind], later)


def _place(t: Array, f: Array) -> tuple[float, float]:
    """Return about the times at which the first pulse rises and falls through half of its peak."""
    # Fourth differences of a smooth pulse are small; those of white noise have the variance 70 σ².
    noise = (
        np.median(np.abs(np.diff(f, 4))) / (0.6745 * math.sqrt(70))
        if len(f) > 4
        else 0.0
    )
    highest = max(f.max(), np.finfo(float).tiny)
    count = math.ceil(min(max(1.0, (noise / (_SMOOTH * highest)) ** 2), len(f)))
    g = np.convolve(f, np.full(count, 1 / count), "same")
    if -g.min() > max(g.max(), 0):
        raise MeasureError(
            "the signal falls farther below its start than it rises: it is inverted "
            "(--unit 'CH1=-1 N/N' turns it), or begins in a pulse"
        )
    if not g.max() > 0:
        raise MeasureError("no pulse is in the record: its signal is nowhere positive")
    start = int(np.argmax(g > g.max() / 2))
    end = start + int(np.argmax(np.append(g[start:] < _LOW * g.max(), True)))
    top = start + int(np.argmax(g[start:end]))
    below = np.flatnonzero(g < _LOW * g[top])
    after = int(np.searchsorted(below, top))
    if after in (0, len(below)):
        side = "back" if after else "front"
        raise MeasureError(
            f"the pulse is not wholly in the record: its {side} does not pass half its peak"
        )
    foot = np.flatnonzero(g < _APART * g[top])
    sides = np.split(foot, [np.searchsorted(foot, top)])
    low, high = max(sides[0], default=-1) + 1, min(sides[1], default=len(g))
    tilted = g[low:high] + np.linspace(
        0, _EQUAL * g[top], high - low
    )  # no two peaks are equal
    humps, _ = find_peaks(np.pad(tilted, 1), prominence=_HUMP * g[top])
    if len(humps) > 1:
        times = " and ".join(f"{t[low + hump - 1]:.4g}" for hump in humps[:2])
        raise MeasureError(
            f"pulses overlap: peaks at {times} without a fall to {_APART:.0%}"
        )
    return float(t[below[after - 1]]), float(t[below[after]])


def _fitted(t: Array, f: Array, count: int) -> BSpline:
    """Fit a spline of so many coefficients to samples."""
    # Equally many samples lie between neighbouring knots, so that gaps in a record do no harm.
    inner = np.interp(
        np.linspace(0, len(t) - 1, count - _DEGREE + 1), np.arange(len(t)), t
    )
    knots = np.pad(inner, _DEGREE, mode="edge")
    return make_lsq_spline(t, f, knots, _DEGREE)


def _check_top(
    t: Array, f: Array, sides: tuple[float, float], resolution: float, size: float
) -> None:
    """Refuse a pulse between two times that has few samples or that is clipped.

    resolution : distance of neighbouring values. size : unit of the values.
    """
    inside = np.flatnonzero((t > sides[0]) & (t < sides[1]))
    if (few := len(inside)) < _FEWEST:
        raise MeasureError(
            f"{few} samples lie above half the pulse's peak: at least {_FEWEST} are wanted"
        )
    top, low = f[inside].max(), f[inside].min()
    below = np.append(np.flatnonzero(f[inside] < top - _EQUAL * np.ptp(f)), few)
    runs = np.diff(below, prepend=-1) - 1
    # A smooth pulse 1 - e (t/width)², e ≈ 2.7, stays within a resolution of its top as long as
    # 2 width √(resolution/(e peak)); twice as long, and three samples, are no top.
    longest = 3 + 4 * few * math.sqrt(resolution / (2.7 * 2 * (top - low)))
    if runs.max() > longest:
        end = inside[below[np.argmax(runs)] - 1]
        start = end - runs.max() + 1
        raise MeasureError(
            f"the record saturates at {top * size:.4g} from {t[start]:.6g} to {t[end]:.6g}: "
            "a larger range of the recorder is wanted"
        )


def _measured(
    t: Array, f: Array, lead: Array, sides: tuple[float, float], step: float
) -> dict[str, Estimate]:
    """Return arrival, peak and FWHM of a pulse between two times, with their errors.

    t, f : samples over their base. lead : which of them are before the first pulse. step : distance
    of the levels to which the samples are rounded, if it is more than their noise, else 0.
    """
    width = sides[1] - sides[0]
    near = (t >= sides[0] - _BESIDE * width) & (t <= sides[1] + _BESIDE * width)
    ends = sides[0] - _READ * width, sides[1] + _READ * width
    before, t, f, calm = t[lead], t[near], f[near], f[lead]
    # Correlations of the noise, up to the first lag without.
    both = np.fft.irfft(np.abs(np.fft.rfft(calm, 2 * len(calm))) ** 2)[
        : len(calm)
    ] / len(calm)
    both = both[: max(1, int(np.argmax(np.append(both, 0.0) <= 0)))]
    length = float(1 + 2 * np.sum(both[1:] / both[0])) if both[0] else 1.0
    n, rounding = len(t), (np.finfo(float).eps * np.abs(f).max()) ** 2
    highest = min(_HIGHEST, int(_DENSEST * n))
    tries = math.ceil(math.log(highest / _LOWEST) / math.log(_STEP))
    counts = np.geomspace(_LOWEST, highest, tries + 1).round().astype(int)
    squares = np.array([np.sum((_fitted(t, f, count)(t) - f) ** 2) for count in counts])
    variance = rounding + float(np.var(calm, ddof=2))
    for _ in range(
        2
    ):  # once more with the noise of the residuals, where that is the larger one
        criterion = squares / (variance * length) + counts * math.log(
            max(n / length, 2)
        )
        best = int(counts[np.argmin(criterion)])
        wanted = max(math.ceil(_FINER * best), best + _MORE)
        spline = _fitted(t, f, min(wanted, highest))
        left = float(np.sum((spline(t) - f) ** 2)) / (n - len(spline.c))
        if left <= _MISFIT * variance:
            break
        variance = left
    scale = calm.std(), math.sqrt(max(0.0, variance - step**2 / 12))
    draws = (
        _noise(both, len(calm) + n) * np.repeat(scale, (len(calm), n))[:, np.newaxis]
    )
    if step:
        phases = step * np.random.default_rng(1).uniform(-0.5, 0.5, (2, _DRAWS))
        true = np.append(0 * calm, spline(t))[:, np.newaxis] + np.repeat(
            phases, (len(calm), n), 0
        )
        draws = step * np.round((true + draws) / step) - true
    errors = _spread(spline, t, before, draws, ends)
    numbers = _read(spline, ends)
    if numbers[1] and (share := math.sqrt(variance) / numbers[1]) > _LOUDEST:
        raise MeasureError(
            f"the noise is {share:.1%} of the peak: at most {_LOUDEST:.0%} is read"
        )
    if wanted > highest:
        coarse = _read(_fitted(t, f, max(_LOWEST, round(highest / _COARSER))), ends)
        errors = np.hypot(errors, np.subtract(numbers, coarse))
    names = ("arrival", "peak", "fwhm")
    found = zip(names, numbers, errors.tolist(), strict=True)
    return {name: Estimate(value, error) for name, value, error in found}


def _noise(both: Array, count: int) -> Array:
    """Draw records of noise of variance 1, (count, `_DRAWS`), with given correlations by lag."""
    size = count + len(both)
    spectrum = np.maximum(np.fft.rfft(both, size).real - both[0] / 2, 0)
    white = np.random.default_rng(0).normal(size=(size, _DRAWS))
    if not spectrum.any():
        return white[:count]
    shaped = (
        np.fft.rfft(white, axis=0) * np.sqrt(spectrum / spectrum.mean())[:, np.newaxis]
    )
    return np.asarray(np.fft.irfft(shaped, size, axis=0)[:count])


def _read(spline: BSpline, ends: tuple[float, float]) -> tuple[float, float, float]:
    """Return arrival, peak and FWHM of a spline between two times."""
    inside = (spline.t > ends[0]) & (spline.t < ends[1])
    times = np.array((ends[0], *spline.t[inside], ends[1]))
    pulse = highest_pulse(Piecewise(times, spline))
    return pulse.arrival, pulse.peak, pulse.fwhm


def _spread(
    spline: BSpline,
    t: Array,
    before: Array,
    noise: Array,
    ends: tuple[float, float],
) -> Array:
    """Return the errors of arrival, peak and FWHM of a spline through samples at times t.

    before : times of the samples that give the base. noise : (len(before) + len(t), `_DRAWS`), at
    both.
    """
    calm, near = noise[: len(before)], noise[len(before) :]
    x, ahead = before - before.mean(), t - before.mean()
    near = (
        near - calm.mean(axis=0) - np.outer(ahead, x @ calm / (x @ x))
    )  # the base is a line
    off = _fitted(t, near, len(spline.c)).c
    grid, draw = np.linspace(*ends, _GRID + 1), np.arange(_DRAWS + 1)
    f = BSpline(
        spline.t, np.column_stack((spline.c, spline.c[:, np.newaxis] + off)), _DEGREE
    )(grid)
    # The vertex of the parabola through the highest value and its neighbours, in grid steps.
    top = np.clip(np.argmax(f, axis=0), 1, _GRID - 1)
    before, highest, after = (f[top + side, draw] for side in (-1, 0, 1))
    bend = before - 2 * highest + after
    shift = np.clip((before - after) / np.where(bend < 0, 2 * bend, -np.inf), -1, 1)
    peak = highest - (before - after) * shift / 4
    # The last place before the top below half the peak, and the first one behind.
    below, place = f <= peak / 2, np.arange(_GRID + 1)[:, np.newaxis]
    rise = np.max(np.where(below & (place < top), place, 0), axis=0)
    fall = np.min(np.where(below & (place > top), place, _GRID), axis=0)
    width = fall - rise
    for at, side in ((rise, 1), (fall, -1)):
        step = f[at + side, draw] - f[at, draw]
        width = width - (peak / 2 - f[at, draw]) / np.where(step == 0, np.inf, step)
    numbers = np.array((top + shift, peak, width))
    errors = np.quantile(np.abs(numbers[:, 1:] - numbers[:, :1]), _WITHIN, axis=1)
    step = (ends[1] - ends[0]) / _GRID
    return np.asarray(errors * (step, 1.0, step))
