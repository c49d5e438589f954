"""What a result is told in: tables of values, and findings that hold or do not.

A table is one thing for people, programs and spreadsheets: `document` makes the rows of a JSON
document of it, `csv` a header of keys and a line for each row, `validation.report.text` columns of
text.
"""

from __future__ import annotations

import csv as comma
import io
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
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
        yield f"{name}_value{dot}{rest}", None if cell is None else plain(cell.value)
        yield f"{name}_error_value{dot}{rest}", None if cell is None else plain(cell.error)


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of cells, one for each column.

    key : its name in a document, where it has one; the first table of a report is its CSV.
    by : key of a column: for people the table falls into one for each of its values, with what
        ``heads`` and ``feet`` say of the value above and below.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    key: str = ""
    title: str = ""
    note: str = ""
    by: str = ""
    heads: Mapping[str, str] = field(default_factory=dict)
    feet: Mapping[str, str] = field(default_factory=dict)

    def records(self) -> list[dict[str, Any]]:
        """Each row's names and plain values, in the columns' order, names with their dots."""
        keyed = [(i, column) for i, column in enumerate(self.columns) if column.key]
        return [dict(pair for i, column in keyed for pair in column.values(row[i])) for row in
                self.rows]  # fmt: skip

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
        keyed = [column for column in self.columns if column.key]
        writer = comma.writer(text, lineterminator="\n")
        writer.writerow([name for column in keyed for name, _ in column.values(None)])
        for record in self.records():
            writer.writerow([json.dumps(value) if isinstance(value, list | dict) else value
                             for value in record.values()])  # fmt: skip
        return text.getvalue()


def plain(value: Any) -> Any:
    """A value as JSON holds it: exact numbers as texts that SymPy reads, None for no number."""
    if isinstance(value, sp.Basic):
        return str(value)
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, np.ndarray | np.integer):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    return value


def _nested(record: Mapping[str, Any]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for name, value in record.items():
        name, dot, rest = name.partition(".")
        if dot:
            result.setdefault(name, {})[rest] = value
        else:
            result[name] = value
    return {
        name: _nested(value) if isinstance(value, dict) and any("." in n for n in value) else value
        for name, value in result.items()
    }


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


@dataclass(frozen=True)
class Statement:
    """What holds or does not, such as that something is refused, in the words of the refusal."""

    quantity: str
    says: str
    ok: bool


def document(findings: Iterable[Finding | Statement]) -> dict[str, Any]:
    """Findings for JSON: the value of each that has a key, as KEY_value, ``findings`` with
    ``quantity``, ``measured_value``, ``error_value`` (null for what is exact or itself an error),
    ``least_value`` and ``most_value`` (null for no bound) and ``ok``, and ``statements`` with
    ``quantity``, ``says`` and ``ok``."""
    numbers = [f for f in findings if isinstance(f, Finding)]
    statements = [f for f in findings if isinstance(f, Statement)]
    return {f"{f.key}_value": plain(f.value) for f in numbers if f.key} | {
        "findings": [
            {
                "quantity": f.quantity,
                "measured_value": plain(f.value),
                "error_value": f.error,
                "least_value": plain(f.low),
                "most_value": plain(f.high),
                "ok": f.ok,
            }
            for f in numbers
        ],
        "statements": [{"quantity": s.quantity, "says": s.says, "ok": s.ok} for s in statements],
    }
