"""Checked input of scenes: numbers and sequences; messages name the faulty value."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from lwa.base import files
from lwa.base.exact import InputError, shorten
from lwa.base.files import Reader

SceneError = InputError
"""Invalid input of a scene, under the name that `validation` exports."""

finite, integer, items, positive = (
    files.finite,
    files.integer,
    files.items,
    files.positive,
)


class Failure(RuntimeError):
    """A computation with valid input that could not go on; the message says where and why."""


def one_of(value: Any, choices: Collection[str], name: str) -> str:
    """Return a text if it is one of the choices, else raise `SceneError`."""
    if not isinstance(value, str) or value not in choices:
        raise SceneError(
            f"{name} is {shorten(value)}: one of {', '.join(choices)} is wanted"
        )
    return value


def between(value: Any, name: str, low: float, high: float, wanted: str = "") -> float:
    """Return a finite number between two limits; ``wanted`` ends the message of a `SceneError`."""
    number = finite(value, name)
    if not low <= number <= high:
        wanted = wanted or f"it lies between {low:g} and {high:g}"
        digits = repr(number).removesuffix(".0")  # all of them: 1.0000001 is not 1
        raise SceneError(f"{name} is {digits}: {wanted}")
    return number


def each(reader: Reader) -> Reader:
    """Return a reader of sequences that reads every item by ``reader``, as ``name[0]`` …"""
    return lambda values, name: tuple(
        reader(value, f"{name}[{i}]") for i, value in enumerate(items(values, name))
    )
