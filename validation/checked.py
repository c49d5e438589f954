"""Numbers that enter a scene become finite floats here, or are refused.

The counterpart of `lwa.exact` for the lattice: every fault is one line that names the value and
says what would be right.
"""

from __future__ import annotations

import math
import operator
from typing import Any

from lwa.exact import InputError, shorten


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
    """`real`, and refused unless it is positive."""
    number = real(value, name)
    if not number > 0:
        raise SceneError(f"{name} is {number:g}: it must be positive")
    return number


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
