"""Splines fitted to noisy pulses, and the errors of arrival, peak and width.

A spline of degree 5 is fitted to the samples about a pulse by least squares. The number of its
coefficients is the best by Schwarz's criterion (Ann. Statist. 6, 461, 1978), for as many samples as
are independent, times `_FINER`: where the criterion stops, a bias is as large as the scatter.

Errors are one standard deviation: records of noise are drawn, base and spline are fitted to each,
and `_WITHIN` of the numbers lie within the error. So an arrival is uncertain by the distance of two
humps if the noise hides which of them is the higher. If the record has too few samples for the
wanted coefficients, the error also holds the difference to a coarser spline.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.interpolate import BSpline, make_lsq_spline
from scipy.signal import peak_widths

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from validation.pulses.base import Base
from validation.pulses.pulse import READINGS, MeasureError

_BESIDE = 0.3  # widths before the rise and after the fall that the fit takes in
_READ = 0.1  # widths before and after in which the spline is read: its ends follow the noise
_DEGREE = 5  # degree of the spline
_LOWEST = 8  # fewest coefficients of the spline
_HIGHEST = 120  # most coefficients
_RATIO = 1.2  # number of coefficients that is tried over the one before
# Coefficients in the end over the best number. With 1.5 the arrivals of records of 8 bits with
# little noise are off by their scatter; with 2 only 59 % of those of loud records lie within their
# errors.
_FINER = 1.7
_DENSEST = 0.8  # most coefficients over samples
_COARSER = 1.3  # ratio of the coefficients to those of a coarser spline, which shows what is missed
_WITHIN = 0.7  # 0.68 and a little: the number of coefficients depends on the noise
_GRID = 400  # intervals on which splines are read
# Mean squared residual over the variance of the noise before the pulse, from which on the residuals
# count as the noise.
_MISFIT = 2.0
_LOUDEST = 0.05  # greatest noise over the peak, for which the pulse is located


def fitted(
    t: Array, f: Array, base: Base, sides: tuple[float, float], step: float
) -> dict[str, Estimate]:
    """Measure arrival, peak and fwhm of a pulse on a spline that is fitted to its samples.

    Parameters
    ----------
    t, f : array
        Times and samples over their base, (N,).
    base : Base
        Base and noise before the pulse.
    sides : tuple of float
        Times at which the pulse rises and falls through half of its peak.
    step : float
        Distance of the levels to which samples are rounded, 0 if their noise hides it.

    Returns
    -------
    dict of Estimate
        Numbers by their names, with one standard deviation.

    Raises
    ------
    MeasureError
        If the noise is too large.
    """
    rise, fall = sides
    beside = _BESIDE * (fall - rise)
    near = (t >= rise - beside) & (t <= fall + beside)
    margin = _READ * (fall - rise)
    # Counted from the rise, times that are far from zero, as seconds since 1970, keep their digits.
    ends = (-margin, fall - rise + margin)
    x = t[near] - rise
    f = f[near]
    rounding = np.finfo(float).eps * np.abs(f).max()
    variance = base.best.variance + rounding**2
    most = min(_HIGHEST, int(_DENSEST * len(x)))
    smoothed = partial(_smoothed, x, f, base.best.correlation_time, most)
    # `wanted` coefficients would be best, the spline has at most `most`; `left` is the variance of
    # the samples about it.
    wanted, spline, left = smoothed(variance)
    if left > _MISFIT * variance:
        # The noise during the pulse is larger than before.
        wanted, spline, variance = smoothed(left)
        variance = max(variance, left)
    pulse = spline(x)
    peak = pulse.max()
    share = math.sqrt(variance) / peak
    if share > _LOUDEST:
        raise MeasureError(
            f"the noise is {share:.1%} of the peak: at most {_LOUDEST:.0%} is read"
        )
    noise = base.drawn(rise + x, pulse, variance, step)
    # A fit is linear: a record with drawn noise has the best fit's coefficients and the noise's.
    drawn = _fit(x, noise, len(spline.c))
    best = spline.c[:, np.newaxis]
    coefficients = np.hstack((best, best + drawn.c))
    splines = BSpline(spline.t, coefficients, _DEGREE)
    # Arrival, peak and FWHM, in a row for each spline: the best fit's first, then the draws'.
    found = _read(splines, ends)
    numbers = found[0]
    errors = np.quantile(np.abs(found[1:] - numbers), _WITHIN, axis=0)
    if wanted > most:
        count = max(_LOWEST, round(most / _COARSER))
        rough = _fit(x, f[:, np.newaxis], count)
        (coarse,) = _read(rough, ends)
        errors = np.hypot(errors, numbers - coarse)
    numbers[0] += rise  # the arrival
    estimates = map(Estimate, numbers.tolist(), errors.tolist())
    return dict(zip(READINGS, estimates, strict=True))


def _smoothed(
    t: Array, f: Array, correlation_time: float, most: int, variance: float
) -> tuple[int, BSpline, float]:
    """Return the wanted number of coefficients, the spline with at most ``most`` of them, and the
    variance of its residuals.

    The noise has the ``variance`` and the ``correlation_time``, in samples.
    """
    ratios = math.log(most / _LOWEST) / math.log(_RATIO)
    tries = math.ceil(ratios) + 1
    counts = np.geomspace(_LOWEST, most, tries)
    counts = counts.round().astype(int)
    # Schwarz's criterion, Σ residual²/σ² + count · ln N, for the independent among the samples.
    independent = len(t) / correlation_time
    penalty = math.log(max(independent, 2))
    criteria = []
    for count in counts:
        residuals = _fit(t, f, count)(t) - f
        squares = np.sum(residuals**2)
        misfit = squares / (variance * correlation_time)
        criteria.append(misfit + count * penalty)
    best = counts[np.argmin(criteria)]
    wanted = math.ceil(_FINER * best)
    spline = _fit(t, f, min(wanted, most))
    residuals = spline(t) - f
    squares = np.sum(residuals**2)
    freedom = len(t) - len(spline.c)
    return wanted, spline, float(squares) / freedom


def _fit(t: Array, f: Array, count: int) -> BSpline:
    """Fit a spline of so many coefficients to samples."""
    # Equally many samples lie between neighbouring knots, so that gaps in a record do no harm.
    numbers = np.arange(len(t))
    places = np.linspace(0, len(t) - 1, count - _DEGREE + 1)
    inside = np.interp(places, numbers, t)
    knots = np.pad(inside, _DEGREE, mode="edge")
    return make_lsq_spline(t, f, knots, _DEGREE)


def _read(splines: BSpline, ends: tuple[float, float]) -> Array:
    """Return arrival, peak and FWHM of each of several splines between two times, (splines, 3)."""
    grid = np.linspace(*ends, _GRID + 1)
    numbers = []
    for f in splines(grid).T:
        # The vertex of the parabola through the highest value and its neighbours: it lies at
        # top - slope/bend, at most one interval away, and there f = f[top] - slope²/(2 bend).
        top = np.argmax(f[1:-1]) + 1
        before, highest, after = f[top - 1 : top + 2]
        slope = (after - before) / 2
        bend = before - 2 * highest + after
        shift = 0.0
        # At an end of the grid, or where values are equal, there is no vertex.
        if bend < 0:
            shift = min(max(-slope / bend, -1.0), 1.0)
        peak = highest + slope * shift / 2
        # SciPy measures the width at the height f[top] - prominence/2. The prominence
        # 2 f[top] - peak makes this peak/2, half of the vertex above the base, which is 0. Both
        # flanks are looked for on the whole grid.
        prominence = np.array([2 * highest - peak])
        start = np.array([0])
        end = np.array([_GRID])
        (width,), *_ = peak_widths(f, [top], 0.5, (prominence, start, end))
        numbers.append((top + shift, peak, width))
    step = grid[1] - grid[0]
    tops, peaks, widths = np.transpose(numbers)
    arrivals = ends[0] + step * tops
    return np.column_stack((arrivals, peaks, step * widths))
