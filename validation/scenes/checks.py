"""Checked input of scenes: finite floats, or one line that names the value and the remedy."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np

from lwa.base import tables
from lwa.base.exact import InputError, shorten
from lwa.base.tables import LEAST, Reader, array

SceneError = InputError
"""Invalid input of a scene, under the name that `validation` exports."""

integer, positive, real = tables.integer, tables.positive, tables.real


class Failure(RuntimeError):
    """A computation with valid input that could not go on; the message says where and why."""


def one_of(value: Any, choices: Collection[str], name: str) -> str:
    """Return a text if it is one of the choices, else raise `SceneError`."""
    if not isinstance(value, str) or value not in choices:
        raise SceneError(f"{name} is {shorten(value)}: one of {', '.join(choices)} is wanted")
    return value


def between(value: Any, name: str, low: float, high: float, wanted: str = "") -> float:
    """Return a finite number between two limits; ``wanted`` ends the message of a `SceneError`."""
    number = real(value, name)
    if not low <= number <= high:
        wanted = wanted or f"it lies between {low:g} and {high:g}"
        digits = repr(number).removesuffix(".0")  # all of them: 1.0000001 is not 1
        raise SceneError(f"{name} is {digits}: {wanted}")
    return number


def row(
    values: Sequence[Any], read: Callable[[Any, str], float], name: Callable[[int], str]
) -> Any:
    """Return the values as ``read`` returns each; ``name(i)`` is the name of value i in messages.

    `real` and `positive` check a row of numbers at once, as a chain may have a million beads.
    """
    if read in (real, positive) and set(map(type, values)) <= {int, float, np.float64}:
        try:
            numbers = np.array(values, float)
        except OverflowError:  # of an integer
            numbers = np.array([np.nan])
        if np.isfinite(numbers).all() and (read is real or np.all(numbers >= LEAST)):
            return numbers.tolist()
    return [read(value, name(i)) for i, value in enumerate(values)]


def each(reader: Reader) -> Reader:
    """Return a reader of lists that reads every item by ``reader``."""
    return lambda value, name: row(array(value, name), reader, lambda i: f"{name} number {i + 1}")


def items(values: Any, name: str) -> tuple[Any, ...]:
    """Return the items of a sequence as a tuple; `SceneError` for a text or a single value."""
    if isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        raise SceneError(f"{name} is {shorten(values)}: a sequence is wanted")
    return tuple(values)
