"""Tables of values, and findings: numbers held to bounds."""

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


@dataclass(frozen=True)
class Column:
    """Column of a table.

    key : JSON name, with a dot for an entry of a mapping, as in "theory_value.speed"; empty for a
        column that is only printed.
    label, unit : printed above the column; without a label the column is not printed.
    format : format of printed cells, a format specification such as ".1e" or a function.
    error : True for cells that are `validation.pulses.pulse.Measured` (or None): in JSON two
        numbers, KEY_value and KEY_error_value.
    """

    key: str = ""
    label: str = ""
    unit: str = ""
    format: str | Callable[[Any], str] = ""
    error: bool = False

    def values(self, cell: Any) -> Iterator[tuple[str, Any]]:
        """Yield the JSON names and values of a cell.

        >>> from validation.pulses.pulse import Measured
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
    """Rows of cells, one cell for each column.

    key : JSON name of the table; the first table with keys is the CSV of a report.
    title, note : printed above and below the table.
    by : key of a column by whose values the printed table is divided.
    heads : printed heading of each part, by the value; by default the value itself.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    key: str = ""
    title: str = ""
    note: str = ""
    by: str = ""
    heads: Mapping[str, str] = field(default_factory=dict)

    def records(self) -> list[dict[str, Any]]:
        """Return JSON names (with their dots) and values of each row, in the order of columns."""
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
        """The table as CSV: a header of keys and a line for each row, with empty cells for None.

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
    """Convert a value for JSON: exact numbers to texts that SymPy reads, NaN and ∞ to None."""
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
    """A number with bounds, within which it is expected.

    low, high : bounds of the value, its error included; by default every number holds.
    error : error of the value; None if the value is exact, or itself an error.
    key : JSON name, KEY_value; by default none.

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

    @property
    def ok(self) -> bool:
        """True if the value lies within its bounds; False for NaN."""
        error = self.error or 0.0
        return bool(self.low <= self.value - error and self.value + error <= self.high)

    def document(self) -> dict[str, Any]:
        """The finding for JSON, with null for a missing error or bound."""
        found = {
            "quantity": self.quantity,
            "measured_value": self.value,
            "error_value": self.error,
            "least_value": self.low,
            "most_value": self.high,
            "ok": self.ok,
        }
        return {name: plain(part) for name, part in found.items()}
