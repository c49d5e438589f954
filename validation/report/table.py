"""Tables of values as text, JSON and CSV, and findings: numbers held to bounds."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import numpy as np
import sympy as sp

WIDTH = 100
"""Characters of a printed line, at most."""

Lines = Sequence[Sequence[str]]
"""Lines of cells, the first of them the column labels."""


@dataclass(frozen=True)
class Column:
    """Column of a table.

    key : JSON name, with a dot for an entry of a mapping, as in "theory_value.speed"; empty for a
        column that is only printed.
    label, unit : printed above the column; without a label the column is not printed.
    format : format of printed cells, a format specification such as ".1e" or a function.
    error : True for cells that are `lwa.Estimate` (or None): in JSON two
        numbers, KEY_value and KEY_error_value.
    """

    key: str = ""
    label: str = ""
    unit: str = ""
    format: str | Callable[[Any], str] = ""
    error: bool = False

    def text(self, cell: Any) -> str:
        """Format one cell; ``-`` for None, NaN and ∞, as JSON has null."""
        if plain(cell) is None:
            return "-"
        if callable(self.format):
            return self.format(cell)
        if isinstance(cell, bool):
            return "ok" if cell else "FAILS"
        form = self.format or (".6g" if isinstance(cell, float) else "")
        return format(cell, form) if form else str(cell)

    def values(self, cell: Any) -> Iterator[tuple[str, Any]]:
        """Yield the JSON names and values of a cell.

        >>> from lwa import Estimate
        >>> dict(Column("speed.m1", error=True).values(Estimate(2.0, 0.25)))
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
    """Table of a report: rows of cells, one cell for each column.

    key : JSON name of the table; the first table with keys is the CSV of a report.
    title, note : printed above and below the table.
    by : key of a column by whose values the printed table is divided; its text heads each part.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    key: str = ""
    title: str = ""
    note: str = ""
    by: str = ""

    def records(self) -> list[dict[str, Any]]:
        """Return JSON names (with their dots) and values of each row, in the order of columns."""
        keyed = [(i, column) for i, column in enumerate(self.columns) if column.key]
        return [
            dict(pair for i, column in keyed for pair in column.values(row[i]))
            for row in self.rows
        ]

    def document(self) -> list[dict[str, Any]]:
        """The rows for JSON.

        >>> Table((Column("k"), Column("a_value.x"), Column("a_value.y")), ((2, 3, 4),)).document()
        [{'k': 2, 'a_value': {'x': 3, 'y': 4}}]
        """
        rows = []
        for record in self.records():
            row: dict[str, Any] = {}
            for name, value in record.items():
                *path, last = name.split(".")
                place = row
                for part in path:
                    place = place.setdefault(part, {})
                place[last] = value
            rows.append(row)
        return rows

    def csv(self) -> str:
        """The table as CSV: a header of keys and a line for each row, with empty cells for None.

        >>> print(Table((Column("k"), Column("c", error=True)), ((2, None),)).csv(), end="")
        k,c_value,c_error_value
        2,,
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(
            name for c in self.columns if c.key for name, _ in c.values(None)
        )
        for record in self.records():
            cells = record.values()
            writer.writerow(
                json.dumps(x) if isinstance(x, list | dict) else x for x in cells
            )
        return text.getvalue()

    def text(self) -> str:
        """The table as text, a part for each value of the column ``by``; empty without labels."""
        printed = [(i, column) for i, column in enumerate(self.columns) if column.label]
        header = [f"{c.label} ({c.unit})" if c.unit else c.label for _, c in printed]
        keys = [column.key for column in self.columns]
        parts: dict[str, list[Sequence[str]]] = {}
        for row in self.rows if printed else ():
            at = keys.index(self.by) if self.by else 0
            lines = parts.setdefault(
                self.columns[at].text(row[at]) if self.by else "", [header]
            )
            lines.append([column.text(row[i]) for i, column in printed])
        blocks = (
            f"{head}\n{aligned(lines)}".lstrip("\n") for head, lines in parts.items()
        )
        texts = wrap(self.title), "\n\n".join(blocks), wrap(self.note)
        return "\n".join(filter(None, texts)) if parts else ""


@dataclass(frozen=True)
class Finding:
    """A number and the bounds within which it is expected.

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


FINDING_COLUMNS = (
    *(Column("quantity", "measured"), Column("", "value"), Column("", "expected")),
    *map(Column, ("measured_value", "error_value", "least_value", "most_value")),
    Column("ok", "holds"),
)
"""Columns of findings: value and bounds as text, the numbers in JSON."""


def findings_table(findings: Iterable[Finding]) -> Table:
    """Table of findings."""
    rows = []
    for f in findings:
        value = f"{f.value:.6g}" + ("" if f.error is None else f" ± {f.error:.0e}")
        row = (
            f.quantity,
            value,
            bounds(f.low, f.high),
            f.value,
            f.error,
            f.low,
            f.high,
            f.ok,
        )
        rows.append(row)
    return Table(FINDING_COLUMNS, tuple(rows))


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


def aligned(lines: Lines, width: float = WIDTH) -> str:
    """Align columns of text: the first one left, the others right.

    Columns beyond the width of a line follow in a block of their own, after the first column.

    >>> print(aligned((("bead", "force"), ("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    blocks, used = [[0]], widths[0]
    for i, own in enumerate(widths[1:], start=1):
        if used + 2 + own > width and len(blocks[-1]) > 1:
            blocks.append([0])
            used = widths[0]
        blocks[-1].append(i)
        used += 2 + own
    texts = []
    for first, *others in blocks:
        cells = (
            (
                line[first].ljust(widths[first]),
                *(line[i].rjust(widths[i]) for i in others),
            )
            for line in lines
        )
        texts.append("\n".join("  ".join(row).rstrip() for row in cells))
    return "\n\n".join(texts)


def wrap(text: str) -> str:
    """Break the lines of a text that are longer than `WIDTH`."""
    return "\n".join(
        fill(line, WIDTH, break_long_words=False) for line in text.splitlines()
    )


def bounds(low: float, high: float) -> str:
    """Format an interval; infinite ends are left out.

    >>> bounds(-1.0, 1.0), bounds(2.0, 3.0), bounds(-math.inf, 3.0), bounds(-math.inf, math.inf)
    ('± 1', '2 … 3', '≤ 3', '-')
    """
    if low == high:
        return f"{low:g}"
    if low == -high:
        return f"± {high:g}" if math.isfinite(high) else "-"
    if math.isinf(high):
        return f"≥ {low:g}"
    return f"≤ {high:g}" if math.isinf(low) else f"{low:g} … {high:g}"


def percent(share: float) -> str:
    """Format a fraction as a signed percentage.

    >>> percent(-0.0125)
    '-1.25 %'
    """
    return f"{100 * share:+.3g} %"
