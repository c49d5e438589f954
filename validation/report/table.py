"""What a result is told in: tables of values, and findings that hold or do not."""

from __future__ import annotations

import csv as comma
import io
import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import sympy as sp

from validation.pulses.pulse import Measured


@dataclass(frozen=True)
class Column:
    """One quantity.

    key : its JSON name; of what stands in a mapping with a dot, as in "theory_value.speed". None
        for people only.
    label : what people read above it, with the unit; none for programs only.
    format : of a cell: a format specification such as ".1e", or a function.
    error : whether cells are `validation.pulses.pulse.Measured`, or None: programs read two
        numbers, KEY_value and KEY_error_value.
    """

    key: str = ""
    label: str = ""
    unit: str = ""
    format: str | Callable[[Any], str] = ""
    error: bool = False

    def values(self, cell: Any) -> Iterator[tuple[str, Any]]:
        """Names and plain values for programs.

        >>> dict(Column("speed.m1", error=True).values(Measured(2.0, 1.75)))
        {'speed_value.m1': 2.0, 'speed_error_value.m1': 0.25}
        """
        if not self.error:
            yield self.key, plain(cell)
            return
        name, dot, rest = self.key.partition(".")
        for ending, part in (("value", "value"), ("error_value", "error")):
            yield f"{name}_{ending}{dot}{rest}", plain(getattr(cell, part, None))


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of cells, one for each column.

    key : its name in a document, where it has one; the first table of a report is its CSV.
    by : key of a column: for people the table falls into one for each of its values, with what
        ``heads`` says of the value above it.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    key: str = ""
    title: str = ""
    note: str = ""
    by: str = ""
    heads: Mapping[str, str] = field(default_factory=dict)

    def records(self) -> list[dict[str, Any]]:
        """Each row's names and plain values, in the columns' order, names with their dots."""
        keyed = [(i, column) for i, column in enumerate(self.columns) if column.key]
        return [
            dict(pair for i, column in keyed for pair in column.values(row[i])) for row in self.rows
        ]

    def document(self) -> list[dict[str, Any]]:
        """The rows for JSON.

        >>> Table((Column("k"), Column("a_value.x"), Column("a_value.y")), ((2, 3, 4),)).document()
        [{'k': 2, 'a_value': {'x': 3, 'y': 4}}]
        """
        return [_nested(record) for record in self.records()]

    def csv(self) -> str:
        """A header of keys, and a line for each row; empty where there is no value.

        >>> print(Table((Column("k"), Column("c", error=True)), ((2, None),)).csv(), end="")
        k,c_value,c_error_value
        2,,
        """
        text = io.StringIO()
        names = [name for c in self.columns if c.key for name, _ in c.values(None)]
        writer = comma.DictWriter(text, names, lineterminator="\n")
        writer.writeheader()
        for record in self.records():
            writer.writerow(
                {
                    name: json.dumps(value) if isinstance(value, list | dict) else value
                    for name, value in record.items()
                }
            )
        return text.getvalue()


def plain(value: Any) -> Any:
    """A value as JSON holds it: exact numbers as texts that SymPy reads, None for no number."""
    if isinstance(value, sp.Basic):
        return str(value)
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    return value


def _nested(record: Mapping[str, Any]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for name, value in record.items():
        *path, last = name.split(".")
        place = result
        for part in path:
            place = place.setdefault(part, {})
        place[last] = value
    return result


@dataclass(frozen=True)
class Finding:
    """One measured number.

    low, high : what it must lie between, its error included; a number without either is only told.
    error : of the value; None where the number is itself an error, or exact.
    key : by which a program finds it in the document; none for the many of a loop.

    >>> Finding("order", 2.4, 2.0, 3.0, error=0.1).ok
    True
    >>> Finding("order", 2.4, 2.0, 2.45, error=0.1).ok
    False
    """

    quantity: str
    value: float
    low: float = -math.inf
    high: float = math.inf
    error: float | None = None
    key: str = ""

    @classmethod
    def of(
        cls, quantity: str, measured: Measured, low: float, high: float, key: str = ""
    ) -> Finding:
        """A number that was measured twice."""
        return cls(quantity, measured.value, low, high, measured.error, key)

    @property
    def ok(self) -> bool:
        """Whether it lies where it must; a NaN never does."""
        error = self.error or 0.0
        return bool(self.low <= self.value - error and self.value + error <= self.high)

    def document(self) -> dict[str, Any]:
        """For JSON; null is the error of what is exact or itself an error, and no bound."""
        found = {
            "quantity": self.quantity,
            "measured_value": self.value,
            "error_value": self.error,
            "least_value": self.low,
            "most_value": self.high,
            "ok": self.ok,
        }
        return {name: plain(part) for name, part in found.items()}


@dataclass(frozen=True)
class Statement:
    """What holds or does not, such as that something is refused, in the words of the refusal."""

    quantity: str
    says: str
    ok: bool
