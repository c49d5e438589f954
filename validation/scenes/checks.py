"""Checked input of scenes: numbers, sequences and CSV columns; messages name the faulty value."""

from __future__ import annotations

import csv
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lwa.base import files, tables
from lwa.base.arrays import Array
from lwa.base.exact import InputError, shorten
from lwa.base.tables import Reader

SceneError = InputError
"""Invalid input of a scene, under the name that `validation` exports."""

finite, integer, positive = tables.finite, tables.integer, tables.positive


class Failure(RuntimeError):
    """A computation with valid input that could not go on; the message says where and why."""


def one_of(value: Any, choices: Collection[str], name: str) -> str:
    """Return a text if it is one of the choices, else raise `SceneError`."""
    if not isinstance(value, str) or value not in choices:
        raise SceneError(f"{name} is {shorten(value)}: one of {', '.join(choices)} is wanted")
    return value


def between(value: Any, name: str, low: float, high: float, wanted: str = "") -> float:
    """Return a finite number between two limits; ``wanted`` ends the message of a `SceneError`."""
    number = finite(value, name)
    if not low <= number <= high:
        wanted = wanted or f"it lies between {low:g} and {high:g}"
        digits = repr(number).removesuffix(".0")  # all of them: 1.0000001 is not 1
        raise SceneError(f"{name} is {digits}: {wanted}")
    return number


def items(values: Any, name: str) -> tuple[Any, ...]:
    """Return the items of a sequence as a tuple; `SceneError` for a text or a single value."""
    if isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        raise SceneError(f"{name} is {shorten(values)}: a sequence is wanted")
    return tuple(values)


def each(reader: Reader) -> Reader:
    """Return a reader of sequences that reads every item by ``reader``, as ``name[0]`` …"""
    return lambda values, name: tuple(
        reader(value, f"{name}[{i}]") for i, value in enumerate(items(values, name))
    )


def columns(path: str | Path, *wanted: str, optional: Sequence[str] = ()) -> dict[str, Array]:
    """Read columns of a CSV file with a header; return each, (N,), by its name without unit.

    A header such as "force (N)" names the column "force". Raises `SceneError`, in one line, for a
    file without a wanted column, and for entries that are no finite numbers.
    """
    try:
        text = files.content(Path(path)).decode("utf-8-sig")
        header, *rows = [row for row in csv.reader(text.splitlines()) if row] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error, SceneError) as error:
        raise SceneError(f"{path}: {files.reason(error)}") from None
    names = [name.partition("(")[0].strip() for name in header]
    values: dict[str, Array] = {}
    for name in (*wanted, *(name for name in optional if name in names)):
        if names.count(name) != 1:
            header_text = shorten(names)
            raise SceneError(f"{path}: one column {name} is wanted, the header has {header_text}")
        try:
            values[name] = np.array([row[names.index(name)] for row in rows], float)
        except (ValueError, IndexError):
            values[name] = np.array([np.nan])
        if not np.isfinite(values[name]).all():
            raise SceneError(f"{path}: column {name}: finite numbers are wanted")
    return values
