"""Tables of the book's pages."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from validation.report.study import Report
from validation.report.table import Column, Table


def table(
    rows: Iterable[Iterable[Any]], *heads: str | tuple[str, str | Callable[[Any], str]]
) -> Report:
    """Rows under heads; a head may come with the format of its column."""
    pairs = [head if isinstance(head, tuple) else (head, "") for head in heads]
    # formatted here and not by the column, because a form may print None
    shown = []
    for row in rows:
        cells = {}
        for (name, form), cell in zip(pairs, row, strict=True):
            cells[name] = form(cell) if callable(form) else cell
        shown.append(cells)
    columns = [
        Column("", name, format="" if callable(form) else form) for name, form in pairs
    ]
    return Report("", (Table(columns, shown),))


def percent(digits: int = 1) -> Callable[[float | None], str]:
    """Return a format of a ratio less one, in percent; a dash stands for None."""
    return lambda value: "–" if value is None else f"{100 * value:+.{digits}f} %"
