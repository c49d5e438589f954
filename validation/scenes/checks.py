"""Checked input of scenes: numbers and sequences; messages name the faulty value."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from lwa.base import files
from lwa.base.exact import InputError
from lwa.base.exact import one_of as one_of
from lwa.base.files import Reader

SceneError = InputError
"""Invalid input of a scene, under the name that `validation` exports."""

finite = files.finite
integer = files.integer
items = files.items
positive = files.positive


class Failure(RuntimeError):
    """A computation with valid input that could not go on; the message says where and why."""


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


def one_or_each(reader: Reader) -> Reader:
    """Return a reader of one value for all contacts, or of a sequence with one for each contact.

    A sequence of equal values is read as one value: contacts that are alike are the same chain
    however they were written.
    """

    def read(value: Any, name: str) -> Any:
        if isinstance(value, str) or not isinstance(value, Iterable):
            return reader(value, name)
        return alike(each(reader)(value, name))

    return read


def alike(values: tuple[Any, ...]) -> Any:
    """Return the value of a tuple of equal values, any other tuple as it is."""
    return values[0] if len(set(values)) == 1 else values


def check_count(value: Any, name: str, contacts: int) -> None:
    """Raise `SceneError` for a tuple, as `one_or_each` returns it, of another length."""
    if isinstance(value, tuple) and len(value) != contacts:
        raise SceneError(
            f"{name} has {len(value)} entries: one for all contacts is wanted, or one for each "
            f"of the {contacts} (the wall's is the last)"
        )
