"""Tables of values as text, JSON and CSV, and findings: numbers held to bounds."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import numpy as np
import sympy as sp

from lwa.base.frozen import TABLE_DIGITS, Estimate
from lwa.spheres.units import Unit, labelled

WIDTH = 100
"""Characters of a printed line, at most, where the terminal's width is not known."""

Row = Mapping[str, Any]
"""Cells of a table by the keys of its columns, or by the label of a column that has no key."""


@dataclass(frozen=True)
class Column:
    """Column of a table.

    Parameters
    ----------
    key : str
        JSON name, with a dot for an entry of a mapping, as in "theory_value.speed"; empty for a
        column that is only printed.
    label : str
        Text above the printed column; empty for a column that is not printed. A label that ends in
        an SI unit, as in "arrival (s)", is printed with the prefix that suits the largest cell.
    format : str or callable
        Format of printed cells: a format specification such as ".1e", or a function of the cell; of
        cells that are estimates the number of digits, at most.
    """

    key: str = ""
    label: str = ""
    format: str | Callable[[Any], str] = ""

    @property
    def name(self) -> str:
        """Key of its cells in a row."""
        return self.key or self.label

    def text(self, cell: Any, size: float = 1.0) -> str:
        """Format one cell, in a unit of a size; ``-`` for None, NaN and ∞, as JSON has null."""
        if plain(without_error(cell)) is None:
            return "-"
        if callable(self.format):
            return self.format(cell)
        # A failure is loud: it is looked for among many rows.
        if isinstance(cell, bool):
            return "ok" if cell else "FAILS"
        if size != 1:
            cell = cell * (1 / size)
        if isinstance(cell, Estimate):
            return cell.text(int(self.format or TABLE_DIGITS))
        # Six digits are more than any other number of a report has; JSON has all of them.
        digits = ".6g" if isinstance(cell, float) else ""
        return format(cell, self.format or digits)

    def values(self, name: str, cell: Any) -> dict[str, Any]:
        """Return the JSON names and values of a cell."""
        return {name: plain(cell)}


class Estimates(Column):
    """Column of cells that are `lwa.Estimate` (or None): KEY_value and KEY_error_value in JSON."""

    def values(self, name: str, cell: Any) -> dict[str, Any]:
        """Return the JSON names and values of a cell.

        >>> Estimates().values("speed.m1", Estimate(2.0, 0.25))
        {'speed_value.m1': 2.0, 'speed_error_value.m1': 0.25}
        """
        # The endings belong to the name of the mapping, not to its entries.
        head, dot, entry = name.partition(".")
        return {
            # A cell of None has neither number, and both are null.
            f"{head}_value{dot}{entry}": plain(getattr(cell, "value", None)),
            f"{head}_error_value{dot}{entry}": plain(getattr(cell, "error", None)),
        }


@dataclass(frozen=True, eq=False)
class Table:
    """Table of a report.

    Parameters
    ----------
    columns : sequence of Column
        Columns. If no column has a key, the labels are the names in JSON and CSV.
    rows : sequence of mappings
        Cells by the column's key, or by its label if it has no key. A cell that is missing, where
        the number does not exist, is None.
    key : str
        JSON name of the table.
    note : str
        Text below the printed table.
    errors : str
        Meaning of ±, printed below the table.
    by : str
        Key of a column by whose values the printed table is divided; its text heads each part.

    Examples
    --------
    >>> cubes = Table((Column("n", "n"), Column("", "n³")), [{"n": 2, "n³": 8}])
    >>> print(cubes.text())
    n  n³
    2   8
    """

    columns: Sequence[Column]
    rows: Sequence[Row]
    key: str = ""
    note: str = ""
    errors: str = ""
    by: str = ""

    def _record(self, row: Row) -> dict[str, Any]:
        """The JSON names (with their dots) and values of a row, in the order of columns.

        A column's JSON name is its key, or its label where no column of the table has a key.
        """
        keyed = any(column.key for column in self.columns)
        record: dict[str, Any] = {}
        for column in self.columns:
            # A column without a key, beside others with one, is only printed. A column of estimates
            # has two values, the number and its error (`Column.values`).
            if column.key or not keyed:
                record |= column.values(column.name, row.get(column.name))
        return record

    def document(self) -> list[dict[str, Any]]:
        """The rows for JSON.

        >>> Table((Column("k"), Column("a_value.x")), [{"k": 2, "a_value.x": 3}]).document()
        [{'k': 2, 'a_value': {'x': 3}}]
        """
        documents = []
        for row in self.rows:
            document: dict[str, Any] = {}
            for name, value in self._record(row).items():
                *path, last = name.split(".")
                place = document  # the mapping that holds the value
                for part in path:
                    place = place.setdefault(part, {})
                place[last] = value
            documents.append(document)
        return documents

    def csv(self) -> str:
        """The table as CSV: a header of names and a line for each row, with empty cells for None.

        >>> print(Table((Column("k"), Estimates("c")), [{"k": 2}]).csv(), end="")
        k,c_value,c_error_value
        2,,
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        # Names do not depend on the cells: an empty row gives the header.
        writer.writerow(self._record({}))
        for row in self.rows:
            cells = []
            for value in self._record(row).values():
                # A spreadsheet's cell holds no list: its JSON stands there.
                is_nested = isinstance(value, list | dict)
                cells.append(json.dumps(value) if is_nested else value)
            writer.writerow(cells)
        return text.getvalue()

    def text(self, width: int = WIDTH) -> str:
        """The table as text, a part for each value of the column ``by``; empty without labels.

        Parameters
        ----------
        width : int
            Characters of a line, at most; columns beyond it follow in a block of their own.
        """
        if not (self.rows and any(column.label for column in self.columns)):
            return ""
        blocks = [
            f"{heading}\n{aligned(lines, width)}".strip("\n")
            for heading, lines in self._parts().items()
        ]
        text = "\n\n".join(blocks)
        if self.note:
            # A note is one paragraph, however its lines are broken in the source.
            note = " ".join(self.note.split())
            text += f"\n{wrap(note, width)}"
        if self.errors:
            meaning = f"±: {self.errors}; at least one in the last digit shown."
            text += f"\n{wrap(meaning, width)}"
        return text

    def _parts(self) -> dict[str, list[list[str]]]:
        """The printed lines of each part, labels first, by heading; "" heads an undivided table."""
        # One prefix for all parts of a column, so that its numbers can be compared.
        units = [self._unit(column) for column in self.columns]
        labels = [unit.name for unit in units if unit.name]
        parts: dict[str, list[list[str]]] = {}
        for row in self.rows:
            heading = ""
            cells = []
            for column, unit in zip(self.columns, units, strict=True):
                cell = row.get(column.name)
                if self.by and column.key == self.by:
                    heading = column.text(cell)
                if column.label:
                    cells.append(column.text(cell, unit.size))
            # The labels stand above each part.
            parts.setdefault(heading, [labels]).append(cells)
        return parts

    def _unit(self, column: Column) -> Unit:
        """The label of a column in text, with its unit fitted to the largest cell."""
        largest = 0.0
        for row in self.rows:
            number = without_error(row.get(column.name))
            # Counts and exact numbers have no unit that a prefix would suit.
            if isinstance(number, float) and math.isfinite(number):
                largest = max(largest, abs(number))
        return labelled(column.label, largest)


@dataclass(frozen=True)
class Finding:
    """A number and the bounds within which it is expected.

    Parameters
    ----------
    quantity : str
        Name of the number.
    value : float
        The number.
    low, high : float
        Bounds of the value, its error included; by default every number holds.
    error : float, optional
        Error of the value; None if the value is exact, or itself an error.
    key : str
        JSON name, KEY_value; by default the finding stands in the list of findings alone.

    Examples
    --------
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
        # The whole interval of the error lies between the bounds; comparisons with NaN fail.
        error = self.error or 0.0
        return bool(self.low <= self.value - error and self.value + error <= self.high)


FINDING_COLUMNS = (
    Column("quantity", "measured"),
    Column("", "value"),
    Column("", "expected"),
    Column("measured_value"),
    Column("error_value"),
    Column("least_value"),
    Column("most_value"),
    Column("ok", "holds"),
)
"""Columns of findings: value with error and bounds in text, the numbers in JSON."""


def findings_table(findings: Iterable[Finding]) -> Table:
    """Return the table of findings."""
    records = []
    for finding in findings:
        value: Any = finding.value
        if finding.error is not None:
            value = Estimate(finding.value, finding.error)
        records.append(
            {
                "quantity": finding.quantity,
                "value": value,
                "expected": bounds(finding.low, finding.high),
                "measured_value": finding.value,
                "error_value": finding.error,
                "least_value": finding.low,
                "most_value": finding.high,
                "ok": finding.ok,
            }
        )
    return Table(FINDING_COLUMNS, records)


def without_error(cell: Any) -> Any:
    """Return the value of an estimate, and any other cell as it is."""
    return cell.value if isinstance(cell, Estimate) else cell


def plain(value: Any) -> Any:
    """Convert a value for JSON: exact numbers to texts that SymPy reads, NaN and ∞ to None."""
    if isinstance(value, sp.Basic):
        return str(value)
    # NumPy's numbers of one entry too: its bool_ is no bool for JSON.
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    return value


def aligned(lines: Sequence[Sequence[str]], width: int = WIDTH) -> str:
    """Align columns of text: the first one left, the others right.

    Columns beyond the width of a line follow in a block of their own, after the first column.

    >>> print(aligned((("bead", "force"), ("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    blocks: list[list[int]] = []
    used = width
    for place in range(1, len(widths)):
        # Two spaces before each column.
        if not blocks or used + 2 + widths[place] > width:
            blocks.append([])
            used = widths[0]
        blocks[-1].append(place)
        used += 2 + widths[place]
    texts = []
    for block in blocks or [[]]:  # a single column has no other one
        for line in lines:
            cells = [line[0].ljust(widths[0])]
            cells += [line[place].rjust(widths[place]) for place in block]
            texts.append("  ".join(cells).rstrip())
        texts.append("")  # a line between blocks, and one too many at the end
    return "\n".join(texts[:-1])


def wrap(text: str, width: int) -> str:
    """Break the lines of a text that are longer than a width."""
    lines = (fill(line, width, break_long_words=False) for line in text.splitlines())
    return "\n".join(lines)


def bounds(low: float, high: float) -> str:
    """Format an interval; infinite ends are left out.

    >>> bounds(-1.0, 1.0), bounds(2.0, 3.0), bounds(-math.inf, 3.0), bounds(-math.inf, math.inf)
    ('± 1', '2 … 3', '≤ 3', '-')
    """
    if math.isinf(low):
        return "-" if math.isinf(high) else f"≤ {high:g}"
    if math.isinf(high):
        return f"≥ {low:g}"
    return f"± {high:g}" if low == -high else f"{low:g} … {high:g}"


def percent(share: float) -> str:
    """Format a fraction as a signed percentage.

    >>> percent(-0.0125)
    '-1.25 %'
    """
    return f"{100 * share:+.3g} %"
