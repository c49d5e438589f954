"""Signals: functions of time that are smooth on each interval between given times.

The dense output of a run (`validation.lattice.run.Run.signal`) is a signal, and so is the cubic
spline through samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from lwa.base.exact import InputError


class MeasureError(InputError):
    """A record without the wanted pulse; the message says what is missing."""


class Signal(Protocol):
    """A function of time, called with times of any shape; NaN where it is not known."""

    @property
    def times(self) -> Array:
        """Increasing times; the signal is smooth between neighbouring times."""
        ...

    def __call__(self, time: ArrayLike, /) -> Array: ...


class Sampled:
    """The cubic spline through samples, as a `Signal`.

    Raises `MeasureError` unless time and values are finite, at least four, and time increases.
    """

    def __init__(self, time: ArrayLike, values: ArrayLike) -> None:
        self.times, f = _record(time, values)
        # Scaled by powers of two, which cost no digit: slopes may overflow where values do not.
        scales = (self.times[-1] - self.times[0], np.abs(f).max())
        self._pace, self._height = (2.0 ** (math.frexp(x)[1] - 1) for x in scales)
        self._spline = scipy.interpolate.CubicSpline(self.times / self._pace, f / self._height)

    def __call__(self, time: ArrayLike, /) -> Array:
        """Return the spline's values at any times within the record."""
        scaled = np.asarray(time, float) / self._pace
        return np.asarray(self._spline(scaled) * self._height)


@dataclass(frozen=True)
class Mapped:
    """A signal whose values are a ``function`` of another signal's values."""

    signal: Signal
    function: Callable[[Array], Array]

    @property
    def times(self) -> Array:
        """Times of the underlying signal."""
        return self.signal.times

    def __call__(self, time: ArrayLike, /) -> Array:
        """Return ``function`` of the signal's values at these times."""
        return self.function(self.signal(time))


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
