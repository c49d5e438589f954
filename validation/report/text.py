"""Tables and findings as text in columns, and as the tables of a web page."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from textwrap import fill
from typing import Any

from validation.pulses.pulse import Measured
from validation.report.table import Column, Finding, Statement, Table

Lines = Sequence[Sequence[str]]


def aligned(lines: Lines) -> str:
    """Columns of text, the first aligned left, the others right.

    >>> print(aligned((("bead", "force"), ("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if i else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


def filled(text: str) -> str:
    """Each line of a text within 100 columns."""
    return "\n".join(fill(line, 100, break_long_words=False) for line in text.splitlines())


def percent(share: float) -> str:
    """A share with its sign.

    >>> percent(-0.0125)
    '-1.25 %'
    """
    return f"{100 * share:+.3g} %"


def bounds(low: float, high: float) -> str:
    """What a number must lie between.

    >>> bounds(-1.0, 1.0), bounds(2.0, 3.0), bounds(-math.inf, 3.0), bounds(-math.inf, math.inf)
    ('± 1', '2 … 3', '≤ 3', '-')
    """
    if math.isinf(low) and math.isinf(high):
        return "-"
    if math.isinf(high):
        return f"≥ {low:g}"
    if math.isinf(low):
        return f"≤ {high:g}"
    if low == high:
        return f"{low:g}"
    return f"± {high:g}" if low == -high else f"{low:g} … {high:g}"


def blocks(table: Table) -> list[tuple[str, Lines, str]]:
    """What stands above, the lines with their header, and what stands below, of each part that
    people read: one, or one for each value of the column that the table is divided ``by``."""
    shown = [(i, column) for i, column in enumerate(table.columns) if column.label]
    if not shown or not table.rows:
        return []
    header = [f"{c.label} ({c.unit})" if c.unit else c.label for _, c in shown]
    parts: dict[str, list[Sequence[str]]] = {}
    place = next((i for i, c in enumerate(table.columns) if c.key == table.by), None)
    for row in table.rows:
        group = "" if not table.by or place is None else str(row[place])
        parts.setdefault(group, [header]).append([cell(column, row[i]) for i, column in shown])
    return [(table.heads.get(group, group), lines, table.feet.get(group, ""))
            for group, lines in parts.items()]  # fmt: skip


def cell(column: Column, value: Any) -> str:
    """One value as text; ``-`` where there is none."""
    if value is None:
        return "-"
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
    """The table for people; nothing where no column has a label, or no row is there."""
    parts = ["\n".join(filter(None, (head, aligned(lines), foot)))
             for head, lines, foot in blocks(table)]  # fmt: skip
    if not parts:
        return ""
    return "\n".join(filter(None, (table.title, "\n\n".join(parts), table.note)))


def html(table: Table) -> str:
    """The same for a web page."""
    result = [f"<h4>{escape(table.title)}</h4>"] if table.title and blocks(table) else []
    for head, (header, *lines), foot in blocks(table):
        rows = ["".join(f"<td>{escape(part)}</td>" for part in line) for line in lines]
        result += [
            f"<p>{escape(head)}</p>" if head else "",
            "<table><thead><tr>", *(f"<th>{escape(part)}</th>" for part in header),
            "</tr></thead><tbody>", *(f"<tr>{row}</tr>" for row in rows), "</tbody></table>",
            f"<p>{escape(foot)}</p>" if foot else "",
        ]  # fmt: skip
    return "".join(result) + (f"<p>{escape(table.note)}</p>" if table.note and result else "")


def listed(findings: Iterable[Finding | Statement], all_of_them: bool = True) -> list[str]:
    """Findings line by line: statements, then a table of the numbers, of those that fail alone
    where ``all_of_them`` is False."""
    told = [f for f in findings if all_of_them or isinstance(f, Statement) or not f.ok]
    parts = [
        filled(f"{f.quantity}: {f.says}{'' if f.ok else '  FAILS'}")
        for f in told
        if isinstance(f, Statement)
    ]
    lines = [
        (f.quantity, _value(f), bounds(f.low, f.high), _word(f))
        for f in told
        if isinstance(f, Finding)
    ]
    return [*parts, aligned([("measured", "value", "expected", ""), *lines])] if lines else parts


def _value(finding: Finding) -> str:
    value = f"{finding.value:.6g}"
    return value if finding.error is None else f"{value} ± {finding.error:.0e}"


def _word(finding: Finding) -> str:
    if not finding.ok:
        return "FAILS"
    return "" if math.isinf(finding.low) and math.isinf(finding.high) else "ok"
