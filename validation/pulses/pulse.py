"""What is read off the record of a pulse: arrival, peak, width, impulse, and the speed of two.

A record is a signal sampled in time, dense enough that a cubic spline through it (SciPy) is the
signal: the peak is a root of the spline's derivative, a flank a root of spline - peak/2, the
impulse the spline's integral.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from lwa.exact import InputError

Source = TypeVar("Source")

FEWEST = 8
"""Samples above half the peak, below which a record is too coarse to be measured."""


_FORGOTTEN = 64
"""Samples beyond the flanks that a spline is put through: of each, it keeps 0.27 a sample on."""


class MeasureError(InputError):
    """A record that does not hold what is to be measured; the message says what is missing."""


@dataclass(frozen=True)
class Pulse:
    """A pulse in a record; times in the record's unit, ``peak`` in that of the signal.

    arrival : time of the peak.
    peak : the signal there.
    rise, fall : times at which the signal passes half its peak, before and behind it.
    """

    arrival: float
    peak: float
    rise: float
    fall: float

    @cached_property
    def fwhm(self) -> float:
        """Full width at half maximum, a time."""
        return self.fall - self.rise


@dataclass(frozen=True)
class Measured:
    """A number, and the same number measured less well; their difference is its error.

    >>> Measured(1.4119284, 1.4119277)
    1.4119284 ± 7e-07
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
        decimals = max(0, -math.floor(math.log10(self.error)))
        size = abs(self.value)
        if size > self.error and not 1e-12 < size < 1e16:
            digits = math.floor(math.log10(size)) - math.floor(math.log10(self.error))
            return f"{self.value:.{digits}e} ± {self.error:.0e}"
        return f"{self.value:.{min(decimals, 12)}f} ± {self.error:.0e}"

    __repr__ = __str__


def derived(function: Callable[..., float], *numbers: Measured) -> Measured:
    """A function of measured numbers, with the error that theirs make in it.

    >>> derived(lambda a, b: a * b, Measured(2.0, 2.1), Measured(3.0, 3.0))
    6.0 ± 3e-01
    """
    return Measured(function(*(n.value for n in numbers)), function(*(n.check for n in numbers)))


def compared(
    numbers: Callable[[Source], Mapping[str, float]], fine: Source, coarse: Source
) -> dict[str, Measured]:
    """Numbers read off two runs, of which the less accurate one gives the errors.

    >>> compared(lambda x: {"x": x, "2x": 2 * x}, 1.5, 1.25)
    {'x': 1.5 ± 2e-01, '2x': 3.0 ± 5e-01}
    """
    less = numbers(coarse)
    return {name: Measured(value, less[name]) for name, value in numbers(fine).items()}


def measure(time: ArrayLike, signal: ArrayLike) -> Pulse:
    """Measure the highest pulse of a record.

    Parameters
    ----------
    time, signal : (S,), the times increasing.

    Raises `MeasureError` when the pulse is not wholly in the record (its peak or a flank lies
    outside), when there is none, or when fewer than `FEWEST` samples lie above half its peak.

    >>> t = np.linspace(-1, 1, 201)
    >>> pulse = measure(t, np.cos(np.pi * t / 2) ** 2)
    >>> round(pulse.peak, 6), round(pulse.fwhm, 6)
    (1.0, 1.0)
    """
    t, f = _record(time, signal)
    top = int(np.argmax(f))
    if not f[top] > 0:
        raise MeasureError("no pulse is in the record: its signal is nowhere positive")
    if top in (0, len(f) - 1):
        raise MeasureError(
            f"the pulse is not wholly in the record: it peaks at the {'last' if top else 'first'} "
            "sample"
        )
    low = f <= f[top] / 2
    start = top - int(np.argmax(low[top::-1])) if low[:top].any() else 0
    stop = top + int(np.argmax(low[top:])) if low[top:].any() else len(f)
    start, stop = max(0, start - _FORGOTTEN), stop + _FORGOTTEN
    t, f, top = t[start:stop], f[start:stop], top - start
    # Powers of two, which cost no digit: slopes of a spline may overflow where its values do not.
    pace, height = (2.0 ** (math.frexp(x)[1] - 1) for x in (t[-1] - t[0], f[top]))
    t, f = t / pace, f / height
    spline = scipy.interpolate.CubicSpline(t, f, extrapolate=False)
    # The peak may lie on either side of the highest sample.
    crest = scipy.interpolate.PPoly(
        spline.c[:, top - 1 : top + 1], spline.x[top - 1 : top + 2], extrapolate=False
    )
    candidates = np.append(crest.derivative().roots(), t[top])
    arrival = candidates[np.argmax(spline(candidates))]
    peak = spline(arrival)
    passes = spline.solve(peak / 2)
    before, behind = passes[passes < arrival], passes[passes > arrival]
    for side, found in (("front", before), ("back", behind)):
        if not len(found):
            raise MeasureError(
                f"the pulse is not wholly in the record: its {side} does not pass half its peak"
            )
    rise, fall = before[-1], behind[0]
    inside = np.count_nonzero((t > rise) & (t < fall))
    if inside < FEWEST:
        raise MeasureError(
            f"{inside} samples lie above half the pulse's peak: at least {FEWEST} are wanted"
        )
    arrival, rise, fall = (float(x * pace) for x in (arrival, rise, fall))
    return Pulse(arrival=arrival, peak=float(peak * height), rise=rise, fall=fall)


def impulse(time: ArrayLike, signal: ArrayLike, start: float, end: float) -> float:
    """∫ signal dt from start to end, in the record's units.

    Raises `MeasureError` when start … end is not wholly in the record.

    >>> round(impulse([0, 1, 2, 3], [0, 1, 4, 9], 0, 3), 12)
    9.0
    """
    t, f = _record(time, signal)
    if not t[0] <= start < end <= t[-1]:
        raise MeasureError(
            f"{start:g} … {end:g} is not within the record, {t[0]:g} … {t[-1]:g}, in this order"
        )
    return float(scipy.interpolate.CubicSpline(t, f).integrate(start, end))


def speed(first: Pulse, second: Pulse, distance: float) -> float:
    """Distance over the time from the first pulse's arrival to the second's.

    Raises `MeasureError` unless the second arrives later.
    """
    if not second.arrival > first.arrival:
        raise MeasureError(
            f"the pulse arrives at {first.arrival:g} and then at {second.arrival:g}: a speed "
            "needs a later second arrival"
        )
    found = float(distance) / (second.arrival - first.arrival)
    if not math.isfinite(found):
        raise MeasureError(f"the speed comes out as {found}: choose other units")
    return found


def _record(time: ArrayLike, signal: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    t, f = np.asarray(time, float), np.asarray(signal, float)
    if t.ndim != 1 or t.shape != f.shape or len(t) < 4:
        raise MeasureError(
            f"time and signal have the shapes {t.shape} and {f.shape}: two equally long rows of at "
            "least 4 samples are wanted"
        )
    if not (np.all(np.isfinite(t)) and np.all(np.isfinite(f)) and np.all(np.diff(t) > 0)):
        raise MeasureError("time and signal must be finite, and time must increase")
    return t, f
