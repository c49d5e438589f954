"""Numbers that enter a scene become finite floats here, or are refused.

The counterpart of `lwa.exact` for the lattice: every fault is one line that names the value and
says what would be right.
"""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from lwa.exact import InputError, shorten

LEAST = sys.float_info.min
"""Of what is positive."""


class SceneError(InputError):
    """A scene, or a part of one, that cannot be meant: the message says what would be right."""


def real(value: Any, name: str) -> float:
    """Read one finite number; raises `SceneError` for anything else.

    >>> real("1.5", "duration")
    Traceback (most recent call last):
        ...
    validation.checked.SceneError: duration is '1.5': a number is wanted
    """
    if not isinstance(value, str | bytes | bool):
        try:
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            pass
        else:
            if math.isfinite(number):
                return number
            raise SceneError(f"{name} is {number}: a finite number is wanted")
    raise SceneError(f"{name} is {shorten(value)}: a number is wanted")


def positive(value: Any, name: str) -> float:
    """`real`, and refused unless it is positive and a float of all digits."""
    number = real(value, name)
    if not number > 0:
        raise SceneError(f"{name} is {number:g}: it must be positive")
    if number < LEAST:
        raise SceneError(f"{name} is {number}: floats below {LEAST:.1g} lose their digits")
    return number


def row(
    values: Sequence[Any], read: Callable[[Any, str], float], name: Callable[[int], str]
) -> Any:
    """Every value by a reader; ``name`` is what messages call number i of them, from 0.

    `real` and `positive` check a row of a million numbers at once.
    """
    if read in (real, positive) and set(map(type, values)) <= {int, float, np.float64}:
        try:
            numbers = np.array(values, float)
        except OverflowError:  # of an integer
            numbers = np.array([np.nan])
        if np.isfinite(numbers).all() and (read is real or np.all(numbers >= LEAST)):
            return numbers.tolist()
    return [read(value, name(i)) for i, value in enumerate(values)]


def integer(value: Any, name: str, least: int, most: int | None = None) -> int:
    """Read an integer from ``least`` to ``most``; raises `SceneError` for anything else."""
    wanted = f"an integer from {least} on" if most is None else f"one of {least} … {most}"
    try:
        number = operator.index(value)
    except TypeError:
        raise SceneError(f"{name} is {shorten(value)}: {wanted} is wanted") from None
    if isinstance(value, bool) or number < least or (most is not None and number > most):
        raise SceneError(f"{name} is {shorten(value)}: {wanted} is wanted")
    return number


def items(values: Any, name: str) -> tuple[Any, ...]:
    """The items of a sequence; raises `SceneError` for a text or a single value."""
    if isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        raise SceneError(f"{name} is {shorten(values)}: a sequence is wanted")
    return tuple(values)
