"""Signals: functions of time that are smooth on each interval between given times.

The dense output of a run (`validation.lattice.result.Run.signal`) is a signal, and so is the cubic
spline through samples.
"""

from __future__ import annotations

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
    """A function of time, called with times of any shape."""

    @property
    def times(self) -> Array:
        """Increasing times; the signal is smooth between neighbouring times."""
        ...

    def __call__(self, time: ArrayLike, /) -> Array: ...


def checked(time: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    """Return sample times and values as arrays (S,), at least four; `MeasureError` for others."""
    try:
        t, f = np.asarray(time, float), np.asarray(values, float)
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
