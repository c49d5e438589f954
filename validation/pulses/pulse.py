"""Pulses of a signal: arrival, peak and width.

A signal is a function of time that is smooth on each interval between given times: the dense output
of a run (`validation.lattice.result.Run.signal`), or the cubic spline through samples. A pulse of a
signal is found on a grid of `_POINTS` points in each smooth interval. Between grid points the
signal is interpolated at Chebyshev points: the arrival is the maximum of the interpolant around the
highest grid point, and the flanks are where interpolants pass half of the peak. So a pulse is as
accurate as the signal.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol, TypeVar, cast

import numpy as np
import scipy
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.frozen import Estimate

Source = TypeVar("Source")

FEWEST = 8  # samples above half the peak; a record with fewer is too coarse
_POINTS = 4  # grid points in each smooth interval
# Degree of an interpolant, over half an interval at most: error about 1e-16.
_DEGREE = 10
_AT_AN_END = 1e-6  # part of an interval beyond its ends in which a zero is the signal's
# Part of the largest |signal| that may be rounding, or a spline's overshoot.
_NOISE = 1e-6
# Chosen: what is lower counts as a ripple.
_LEAST = 0.01  # smallest prominence of a pulse over the highest peak
# A second run, at FINER times the tolerance, gives the errors: SHARE times the differences of both
# runs' numbers. The error of a step is nearly random: the difference to a less accurate run may be
# large or vanish by chance, the one to a far more accurate run is the error. Counted over 27,030
# numbers of struck, damped, driven, loaded and colliding scenes at rtol 1e-8 and 1e-10, 0.1 % of
# the errors are too small (colliding beads 0.2 %) and 0.8 % more than thirty times too large; at a
# tenth of the tolerance, for a fifth less time, 2 and 1 %.
FINER = 0.01
SHARE = 2.0
_FINEST = 1e-13  # smallest tolerance: rounding hides a smaller one
# The time of a broad crest is known to some 1e-12, as rounding of the slope moves it: both runs may
# then err alike, and a smaller difference is small by chance. So the error is at least the smaller
# of _BY_CHANCE differences and _NOISY of the number. At rtol 1e-10 this leaves 15 of 2,208 errors
# too small, SHARE alone 45.
_NOISY = 5e-12
_BY_CHANCE = 5.0
ROUNDING = 1e-13  # relative error of a number, at least
_PARTLY = "the pulse is not wholly in the record:"


class MeasureError(InputError):
    """A record without the wanted pulse; the message says what is missing."""


class Signal(Protocol):
    """A function of time, called with times of any shape."""

    @property
    def times(self) -> Array:
        """Increasing times; the signal is smooth between neighbouring times."""
        ...

    def __call__(self, time: ArrayLike, /) -> Array: ...


def checked(time: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    """Return sample times and values as arrays (S,), at least four; `MeasureError` for others."""
    try:
        t = np.asarray(time, float)
        f = np.asarray(values, float)
        if f.size < 4 or not f.shape == t.shape == (f.size,):
            raise ValueError(f"the shapes are {t.shape} and {f.shape}")
    except (TypeError, ValueError, OverflowError) as reason:
        wanted = "time and signal must be equally long rows of at least 4 numbers"
        raise MeasureError(f"{wanted}: {reason}") from None
    if not np.isfinite((t, f)).all():
        raise MeasureError("time and signal must be finite")
    if np.any(np.diff(t) <= 0):
        raise MeasureError("time must increase")
    return t, f


@dataclass(frozen=True)
class Piecewise:
    """A function that is smooth between increasing ``times``, as a `Signal`."""

    times: Array
    function: Callable[[ArrayLike], Array]

    def __call__(self, time: ArrayLike, /) -> Array:
        """Return the function's values."""
        return self.function(time)


def spline(time: ArrayLike, values: ArrayLike) -> Piecewise:
    """Return the cubic spline through samples; `MeasureError` for others than `checked` takes."""
    t, f = checked(time, values)
    try:
        with np.errstate(all="ignore"):
            return Piecewise(t, scipy.interpolate.CubicSpline(t, f))
    except ValueError:  # the slopes, value over time, are beyond the floats
        raise MeasureError("the signal is too steep, or too long, for floats") from None


READINGS = ("arrival", "peak", "fwhm")
"""Names of the numbers of a pulse."""


@dataclass(frozen=True)
class Pulse:
    """A pulse in the units of its record."""

    arrival: float  # time of the peak
    peak: float  # value of the signal at the peak
    rise: float  # time before the arrival at which the signal passes half its peak
    fall: float  # time after the arrival at which the signal passes half its peak

    @property
    def fwhm(self) -> float:
        """Full width at half maximum, a time."""
        return self.fall - self.rise


def readings(pulse: Pulse) -> dict[str, float]:
    """Return the numbers of a pulse by the names `READINGS`."""
    return {name: getattr(pulse, name) for name in READINGS}


def measure(time: ArrayLike | Signal, values: ArrayLike | None = None) -> Pulse:
    """Measure the highest pulse of a signal, or of samples.

    Parameters
    ----------
    time : Signal or array_like
        A signal such as `Run.signal(...)`, or increasing sample times (S,).
    values : array_like, optional
        Sample values (S,), of which the cubic spline through them is measured.

    Returns
    -------
    Pulse

    Raises
    ------
    MeasureError
        For a record without a pulse, for a pulse that is not wholly in the record, and for fewer
        than `FEWEST` samples above half its peak.

    Examples
    --------
    >>> t = np.linspace(-1, 1, 201)
    >>> pulse = measure(t, np.cos(np.pi * t / 2) ** 2)
    >>> round(pulse.peak, 6), round(pulse.fwhm, 6)
    (1.0, 1.0)
    """
    if values is not None:
        signal: Signal = spline(cast(ArrayLike, time), values)
    elif callable(time):
        signal = time
    else:
        raise MeasureError(
            "values are missing: they are wanted beside the sample times"
        )
    pulse = highest_pulse(signal)
    t = signal.times
    in_pulse = (t > pulse.rise) & (t < pulse.fall)
    inside = np.count_nonzero(in_pulse)
    if values is not None and inside < FEWEST:
        few = f"{inside} samples lie above half the pulse's peak"
        raise MeasureError(f"{few}: at least {FEWEST} are wanted")
    return pulse


def all_pulses(signal: Signal) -> list[Pulse]:
    """Measure all pulses of a signal, in the order of their arrivals.

    A pulse has a prominence (height above its surroundings) of `_LEAST` of the highest peak. If one
    of its flanks does not fall to half its peak, as when two overlap, it is left out.
    Raises `MeasureError` for a record without any pulse.
    """
    grid = _Grid(signal)
    least = _LEAST * grid.f.max()
    _, sides = scipy.signal.find_peaks(grid.f, height=0.0, prominence=least)
    whole: list[Pulse] = []
    # From the lowest point before a top to the lowest one behind, up to higher neighbours
    for start, end in zip(sides["left_bases"], sides["right_bases"], strict=True):
        with suppress(MeasureError):
            whole.append(grid.highest(start, end + 1))
    if not whole:
        raise MeasureError("no pulse is in the record")
    return whole


def highest_pulse(signal: Signal) -> Pulse:
    """Measure the highest pulse of a signal."""
    return _Grid(signal).highest()


def first_pulse(signal: Signal, low: float = 0.5, share: float = 0.5) -> Pulse:
    """Measure the first pulse that exceeds a fraction of a signal's maximum.

    Parameters
    ----------
    signal : Signal
        The signal.
    low : float
        This fraction. The pulse ends where the signal first falls below the same fraction of its
        highest value in the pulse. A contact's force ``A δ^k`` with ``0.25**k`` has the leading
        pulse of a chain, up to where the compression δ falls to a quarter.
    share : float
        Fraction of the peak, ``low`` at least, at which the pulse rises and falls.
    """
    grid = _Grid(signal)
    exceeds = grid.f > low * grid.f.max()
    start = int(np.argmax(exceeds))
    f = grid.f[start:]
    highest = np.maximum.accumulate(f)
    fallen = np.append(f < low * highest, True)
    stop = start + int(np.argmax(fallen))
    return grid.highest(stop=stop + 1, share=share)


class _Grid:
    """Values of a signal at `_POINTS` points in each smooth interval."""

    def __init__(self, signal: Signal) -> None:
        times = signal.times
        parts = np.arange(_POINTS) / _POINTS
        starts = times[:-1, np.newaxis]
        steps = np.diff(times)[:, np.newaxis]
        between = starts + steps * parts
        self.signal = signal
        self.t = np.append(between.ravel(), times[-1])
        self.f = signal(self.t)
        largest = np.abs(self.f).max()
        if not self.f.max() > _NOISE * largest:
            raise MeasureError(
                "no pulse is in the record: its signal is nowhere positive"
            )

    def highest(
        self, start: int = 0, stop: int | None = None, share: float = 0.5
    ) -> Pulse:
        """Measure the highest pulse between two grid points, at a fraction of its peak."""
        part = self.f[start:stop]
        # A point is named by its number in the whole grid, not in the part.
        # The highest point; at an end of the record the signal may go on to rise.
        top = start + np.argmax(part)
        if top in (0, len(self.f) - 1):
            end = "end" if top else "start"
            raise MeasureError(f"{_PARTLY} it peaks at the {end} of the record")
        arrival, peak = self._crest(self.t[top - 1], self.t[top + 1])
        level = share * peak
        # The last point before the top, and the first one behind, at which the signal is below the
        # level: between each of them and its neighbour the signal passes the level.
        below = start + np.flatnonzero(part <= level)
        place = np.searchsorted(below, top)
        if place in (0, len(below)):
            side = "back" if place else "front"
            raise MeasureError(f"{_PARTLY} its {side} does not pass half its peak")
        rise = self._crossing(below[place - 1], level)
        fall = self._crossing(below[place] - 1, level)
        return Pulse(arrival, peak, rise, fall)

    def _crossing(self, i: int, level: float) -> float:
        """Return the time between grid points i and i+1 at which the signal passes a level."""
        low, high = self.t[i : i + 2]
        series = self._interpolant(low, high)
        passed = _zeros(series - level)
        # Without a zero the signal jumps at the later point: a damped contact opens.
        return float(min(passed, default=high))

    def _crest(self, low: float, high: float) -> tuple[float, float]:
        """Return the time and value of the signal's maximum between two times.

        The maximum of each smooth part is at an end or at a zero of its interpolant's derivative.
        """
        # The signal is smooth between its times alone, and only there a polynomial follows it.
        times = self.signal.times
        inside = times[(times > low) & (times < high)]
        tops = []
        for a, b in pairwise((low, *inside, high)):
            series = self._interpolant(a, b)
            flat = _zeros(series.deriv())
            times = np.append(flat, (a, b))
            values = series(times)
            best = np.argmax(values)
            tops.append((float(values[best]), float(times[best])))
        peak, arrival = max(tops)
        return arrival, peak

    def _interpolant(self, low: float, high: float) -> chebyshev.Chebyshev:
        """Interpolate the signal between two times by a polynomial."""
        return chebyshev.Chebyshev.interpolate(self.signal, _DEGREE, (low, high))


def _zeros(series: chebyshev.Chebyshev) -> Array:
    """Return the zeros of a polynomial in its domain, to which rounding may not move them."""
    low, high = series.domain
    zeros = series.roots()
    inside = zeros.real.clip(low, high)
    moved = np.abs(zeros - inside)
    near = moved < _AT_AN_END * (high - low)
    return np.asarray(inside[near])


def derived(function: Callable[..., float], *numbers: Estimate) -> Estimate:
    """Return a function of numbers; its error is the sum of its changes as each number errs."""
    values = [number.value for number in numbers]
    found = function(*values)
    error = 0.0
    for i, number in enumerate(numbers):
        moved = [*values]
        moved[i] += number.error
        error += abs(function(*moved) - found)
    return Estimate(found, error)


def exponent(x: Sequence[Estimate], y: Sequence[Estimate]) -> Estimate:
    """Return the exponent p of ``y ~ x^p``, from a least-squares fit of the logarithms."""

    def slope(*values: float) -> float:
        log_x, log_y = np.split(np.log(values), 2)
        return float(np.polyfit(log_x, log_y, 1)[0])

    # Errors of similar runs have a common sign and might cancel: their absolute values are added.
    return derived(slope, *x, *y)


def tolerances(rtol: float, rounding: float = 0.0) -> tuple[float, float]:
    """Return the tolerance of a run, and that of the run whose differences give its errors.

    Parameters
    ----------
    rtol : float
        Tolerance of the run.
    rounding : float
        Rounding of the scene's motion (`validation.lattice.equations.Scales`). Where it leaves no
        room for a run ten times as accurate, the second run is ten times less accurate.
    """
    check = max(FINER * rtol, _FINEST, rounding)
    if check > rtol / 10:
        check = 10 * rtol
    return rtol, check


def compared(
    numbers: Callable[[Source], Mapping[str, float]], runs: Sequence[Source]
) -> dict[str, Estimate]:
    """Return numbers of a run, with errors by their differences to another run.

    Parameters
    ----------
    numbers : callable
        Function of a run that returns its numbers by name.
    runs : sequence
        The run, and the other one, at the `tolerances` of the run.

    Returns
    -------
    dict of Estimate
        Numbers by name.
    """
    found, checks = map(numbers, runs)
    measured = {}
    for name, value in found.items():
        difference = abs(value - checks[name])
        rounding = min(_BY_CHANCE * difference, _NOISY * abs(value))
        least = max(rounding, ROUNDING * abs(value))
        # A number that the other run lacks is NaN there and has the error NaN: `min` and `max` of
        # Python keep a NaN that is their first argument.
        measured[name] = Estimate(value, max(SHARE * difference, least))
    return measured
