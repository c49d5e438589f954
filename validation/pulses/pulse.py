"""What is read off the record of a pulse: arrival, peak, width, and the speed of two.

A record is a signal sampled in time, dense enough that a cubic spline through it (SciPy) is the
signal: the peak is a root of the spline's derivative, a flank a root of spline - peak/2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from lwa.base.exact import InputError

Source = TypeVar("Source")

FEWEST = 8  # samples above half the peak, below which a record is too coarse to be measured
FORGOTTEN = 32  # samples beyond the flanks that a spline goes through: it keeps 0.27 of each a step


class MeasureError(InputError):
    """A record that does not hold what is to be measured; the message says what is missing."""


@dataclass(frozen=True)
class Pulse:
    """A pulse in a record, in the record's units: when it peaks, the signal there, and when the
    signal passes half of it, before (rise) and behind (fall)."""

    arrival: float
    peak: float
    rise: float
    fall: float

    @property
    def fwhm(self) -> float:
        """Full width at half maximum, a time."""
        return self.fall - self.rise


@dataclass(frozen=True)
class Measured:
    """A number, and the same number measured less well; their difference is its error.

    >>> Measured(2.5e300, 2.50003e300)
    2.50000e+300 ± 3e+295
    """

    value: float
    check: float

    @property
    def error(self) -> float:
        """|value - check|."""
        return abs(self.value - self.check)

    @property
    def relative_error(self) -> float:
        """|1 - check/value|."""
        return abs(1 - self.check / self.value)

    def __str__(self) -> str:
        if not self.error:
            return f"{self.value!r} ± 0"
        size, last = abs(self.value), math.floor(math.log10(self.error))
        if size > self.error and not 1e-12 < size < 1e16:
            return f"{self.value:.{math.floor(math.log10(size)) - last}e} ± {self.error:.0e}"
        return f"{self.value:.{min(max(0, -last), 12)}f} ± {self.error:.0e}"

    __repr__ = __str__


def derived(function: Callable[..., float], *numbers: Measured) -> Measured:
    """A function of measured numbers, with the error that theirs make in it."""
    return Measured(function(*(n.value for n in numbers)), function(*(n.check for n in numbers)))


def exponent(x: Sequence[Measured], y: Sequence[Measured]) -> Measured:
    """p of y ~ x^p, by least squares of their logarithms."""

    def fitted(*numbers: float) -> float:
        one, other = np.split(np.log(numbers), 2)
        return float(np.polyfit(one, other, 1)[0])

    return derived(fitted, *x, *y)


def compared(
    numbers: Callable[[Source], Mapping[str, float]], fine: Source, coarse: Source
) -> dict[str, Measured]:
    """Numbers read off two runs, of which the less accurate one gives the errors."""
    less = numbers(coarse)
    return {name: Measured(value, less[name]) for name, value in numbers(fine).items()}


def measure(time: ArrayLike, signal: ArrayLike) -> Pulse:
    """Measure the highest pulse of a record, of shapes (S,) and with increasing times.

    Raises `MeasureError` when the pulse is not wholly in the record (its peak or a flank lies
    outside), when there is none, or when fewer than `FEWEST` samples lie above half its peak.

    >>> t = np.linspace(-1, 1, 201)
    >>> pulse = measure(t, np.cos(np.pi * t / 2) ** 2)
    >>> round(pulse.peak, 6), round(pulse.fwhm, 6)
    (1.0, 1.0)
    """
    t, f = _record(time, signal)
    top = int(np.argmax(f))
    partly = "the pulse is not wholly in the record:"
    if not f[top] > 0:
        raise MeasureError("no pulse is in the record: its signal is nowhere positive")
    if top in (0, len(f) - 1):
        raise MeasureError(f"{partly} it peaks at the {'last' if top else 'first'} sample")
    low = f <= f[top] / 2
    start = top - int(np.argmax(low[top::-1])) if low[:top].any() else 0
    stop = top + int(np.argmax(low[top:])) if low[top:].any() else len(f)
    start, stop = max(0, start - FORGOTTEN), stop + FORGOTTEN
    t, f, top = t[start:stop], f[start:stop], top - start
    # Powers of two, which cost no digit: slopes of a spline may overflow where its values do not.
    pace, height = (2.0 ** (math.frexp(x)[1] - 1) for x in (t[-1] - t[0], f[top]))
    t, f = t / pace, f / height
    arrival, peak, rise, fall = (float(x[0]) for x in read(t, f[None], np.array([top])))
    for side, found in (("front", rise), ("back", fall)):
        if math.isnan(found):
            raise MeasureError(f"{partly} its {side} does not pass half its peak")
    if (inside := np.count_nonzero((t > rise) & (t < fall))) < FEWEST:
        few = f"{inside} samples lie above half the pulse's peak"
        raise MeasureError(f"{few}: at least {FEWEST} are wanted")
    return Pulse(arrival * pace, peak * height, rise * pace, fall * pace)


def read(time: Array, rows: Array, top: NDArray[np.intp]) -> tuple[Array, Array, Array, Array]:
    """Arrival, peak, rise and fall of the pulse in each row, whose highest sample is at ``top``.

    All rows, of shape (R, S), are at the same times, ``top`` at neither end; NaN where a flank is
    not in the record.
    """
    spline = scipy.interpolate.CubicSpline(time, rows, axis=1)
    row, steps = np.arange(len(rows)), np.diff(time)

    def piece(i: NDArray[np.intp]) -> Array:
        """One for each row: coefficients of a cubic in 0 … 1."""
        powers = np.arange(3, -1, -1).reshape(4, *(1,) * i.ndim)
        return np.asarray(spline.c[:, i, row] * steps[i] ** powers)

    def at(cubic: Array, x: Array) -> Array:
        return np.asarray(((cubic[0] * x + cubic[1]) * x + cubic[2]) * x + cubic[3])

    # The peak may lie on either side of the highest sample.
    crest = top - (spline.c[2, top, row] <= 0)
    a, b, c, _ = cubic = piece(crest)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.nan_to_num(c / (np.sqrt(np.maximum(b * b - 3 * a * c, 0)) - b)).clip(0, 1)
    peak = np.maximum(at(cubic, x), rows[row, top])
    arrival = time[crest] + x * steps[crest]
    below, place = rows <= peak[:, None] / 2, np.arange(len(time))
    before = np.where(below & (place < top[:, None]), place, -1).max(axis=1)
    behind = np.where(below & (place > top[:, None]), place, len(time)).min(axis=1)

    def flanks(i: NDArray[np.intp]) -> Array:
        """Where it passes half of the peak, rising in i[0] and falling in i[1]."""
        cubic, low, high = piece(i), np.zeros(i.shape), np.ones(i.shape)
        rising = np.array([[True], [False]])
        for _ in range(53):  # by bisection: the spline passes half of the peak once
            x = (low + high) / 2
            under = (at(cubic, x) < peak / 2) == rising
            low, high = np.where(under, x, low), np.where(under, high, x)
        return np.asarray(time[i] + high * steps[i])

    rise, fall = flanks(np.stack((np.maximum(before, 0), np.minimum(behind, len(time) - 1) - 1)))
    rise[before < 0] = fall[behind == len(time)] = np.nan
    return arrival, peak, rise, fall


def speed(first: Pulse, second: Pulse, distance: float) -> float:
    """Distance over the time from the first pulse's arrival to the second's.

    Raises `MeasureError` unless the second arrives later.
    """
    if not second.arrival > first.arrival:
        arrivals = f"the pulse arrives at {first.arrival:g} and then at {second.arrival:g}"
        raise MeasureError(f"{arrivals}: a speed needs a later second arrival")
    if not math.isfinite(found := float(distance) / (second.arrival - first.arrival)):
        raise MeasureError(f"the speed comes out as {found}: choose other units")
    return found


def _record(time: ArrayLike, signal: ArrayLike) -> tuple[Array, Array]:
    try:
        t, f = np.asarray(time, float), np.asarray(signal, float)
    except (TypeError, ValueError) as reason:
        raise MeasureError(f"time and signal must be rows of numbers: {reason}") from None
    if t.ndim != 1 or t.shape != f.shape or len(t) < 4:
        shapes = f"time and signal have the shapes {t.shape} and {f.shape}"
        raise MeasureError(f"{shapes}: two equally long rows of at least 4 samples are wanted")
    if not (np.all(np.isfinite(t)) and np.all(np.isfinite(f)) and np.all(np.diff(t) > 0)):
        raise MeasureError("time and signal must be finite, and time must increase")
    return t, f
