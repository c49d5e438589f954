"""Tables and findings as text in columns, and as HTML tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from textwrap import fill
from typing import Any

from validation.pulses.pulse import Measured
from validation.report.table import Column, Finding, Table

Lines = Sequence[Sequence[str]]


def aligned(lines: Lines) -> str:
    """Align columns of text: the first one left, the others right.

    >>> print(aligned((("bead", "force"), ("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    result = []
    for first, *others in lines:
        cells = [first.ljust(widths[0]), *map(str.rjust, others, widths[1:])]
        result.append("  ".join(cells).rstrip())
    return "\n".join(result)


def filled(text: str) -> str:
    """Wrap each line of a text to 100 columns."""
    return "\n".join(fill(line, 100, break_long_words=False) for line in text.splitlines())


def percent(share: float) -> str:
    """Format a fraction as a signed percentage.

    >>> percent(-0.0125)
    '-1.25 %'
    """
    return f"{100 * share:+.3g} %"


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


def blocks(table: Table) -> list[tuple[str, Lines]]:
    """Return the printed parts of a table: headings, and lines of cells below column labels.

    There is one part for each value of the column ``table.by``, by default a single part, and none
    without column labels.
    """
    shown = [(i, column) for i, column in enumerate(table.columns) if column.label]
    if not shown:
        return []
    header = [f"{c.label} ({c.unit})" if c.unit else c.label for _, c in shown]
    keys = [column.key for column in table.columns]
    parts: dict[str, list[Sequence[str]]] = {}
    for row in table.rows:
        group = str(row[keys.index(table.by)]) if table.by else ""
        parts.setdefault(group, [header]).append([cell(column, row[i]) for i, column in shown])
    return [(table.heads.get(group, group), lines) for group, lines in parts.items()]


def cell(column: Column, value: Any) -> str:
    """Format one cell; ``-`` for None, and a text in place of a number as it is."""
    if value is None:
        return "-"
    if isinstance(value, str) and column.error:
        return value
    if callable(column.format):
        return column.format(value)
    if isinstance(value, bool):
        return "ok" if value else "FAILS"
    if column.format:
        if isinstance(value, Measured):
            return f"{value.value:{column.format}} ± {value.error:.0e}"
        return format(value, column.format)
    return f"{value:.8g}" if isinstance(value, float) else str(value)


def text(table: Table) -> str:
    """Format a table as text; empty without column labels or rows."""
    parts = [f"{head}\n{aligned(lines)}".lstrip("\n") for head, lines in blocks(table)]
    return "\n".join(filter(None, (table.title, "\n\n".join(parts), table.note))) if parts else ""


def html(table: Table) -> str:
    """Format a table as HTML."""
    if not (parts := blocks(table)):
        return ""
    result = [_element("h4", table.title)]
    for head, (header, *lines) in parts:
        rows = ["".join(f"<td>{escape(part)}</td>" for part in line) for line in lines]
        result += [
            _element("p", head),
            "<table><thead><tr>",
            *(f"<th>{escape(part)}</th>" for part in header),
            "</tr></thead><tbody>",
            *(f"<tr>{row}</tr>" for row in rows),
            "</tbody></table>",
        ]
    return "".join((*result, _element("p", table.note)))


def _element(name: str, text: str) -> str:
    return f"<{name}>{escape(text)}</{name}>" if text else ""


def listed(findings: Iterable[Finding], failing: bool = False) -> str:
    """Return findings as a printed table (empty without any), with ``failing`` the failing ones."""
    lines = [("measured", "value", "expected", "")]
    for f in findings:
        if failing and f.ok:
            continue
        value = f"{f.value:.6g}" + ("" if f.error is None else f" ± {f.error:.0e}")
        expected = bounds(f.low, f.high)
        word = "FAILS" if not f.ok else "" if expected == "-" else "ok"
        lines.append((f.quantity, value, expected, word))
    return aligned(lines) if lines[1:] else ""
