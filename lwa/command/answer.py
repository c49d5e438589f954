"""The answer of a command: rows, lines of text and further answers, as text, JSON and LaTeX."""

from __future__ import annotations

import json
import re
import shutil
import sys
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from lwa.base import latex
from lwa.base.exact import InputError
from lwa.base.frozen import Shown
from lwa.command.rows import UNITLESS, Row, Scale

WIDTH = 100
"""Columns of text at most, and in a file or a pipe; a narrower terminal has its own."""

# Breaks of a line: spaces, and within a longer word after an operator but **
_BREAK = re.compile(r"(\s+|(?<=[^*/][*/])(?![*/\s]))")

Values = dict[str, Any]


@dataclass(frozen=True)
class Answer:
    """The result of a command, or a part of one.

    Parameters
    ----------
    head : mapping
        JSON of the chain and the settings; expressions become strings when they are printed.
    rows : sequence of Row, str or Answer
        Results, lines of text, and parts, in the order of the text.
    scale : Scale
        Units of the numbers.
    shown : sequence of Shown or str
        Results, or equations in LaTeX, that stand in LaTeX before those of the rows.
    errors : str
        Meaning of ±, printed below rows with an error.
    notes : sequence of str
        Sentences on the validity of the numbers.
    key : str
        Name in JSON, of a part.
    """

    head: Mapping[str, Any]
    rows: Sequence[Row | str | Answer]
    scale: Scale = UNITLESS
    shown: Sequence[Shown | str] = ()
    errors: str = ""
    notes: Sequence[str] = ()
    key: str = ""

    def print(self, style: str) -> None:
        """Print the answer as "text", "json" or "latex"."""
        if style == "json":
            click.echo(json.dumps(self.json(), indent=2, default=str))
        elif style == "latex":
            click.echo(self.latex())
        else:
            click.echo(self.text())

    def _values(self) -> Iterator[Row]:
        """The rows that are values."""
        for row in self.rows:
            if isinstance(row, Row):
                yield row

    def json(self) -> Values:
        """The object that ``--format json`` prints.

        Names ending in ``_value`` are floats, in the unit of length where the spacing is a symbol,
        at V_s = 1 and B = 1, or -1 where B < 0. Symbols, complex numbers and numbers beyond a
        double have none. The notes include the reasons of missing values.
        """
        result = dict(self.head)
        units: Values = {}
        faults = []
        for row in self._values():
            if not row.key:
                continue
            if row.unit:
                _put(units, row.key, "", row.unit)
            if isinstance(row.value, InputError):
                faults.append(str(row.value))
            for ending, value in row.entries(self.scale).items():
                _put(result, row.key, ending, value)
        if self.scale.si:
            result["units"] = units
        for part in self.rows:
            if isinstance(part, Answer):
                result[part.key] = part.json()
        notes = list(dict.fromkeys((*self.notes, *faults)))
        return result | {"notes": notes} if notes else result

    def text(self) -> str:
        """The lines that ``--format text`` prints."""
        lines = []
        for line in self._lines():
            lines += _wrapped(line, text_width())
        return "\n".join(lines)

    def _lines(self) -> Iterator[str]:
        for row in self.rows:
            if isinstance(row, Answer):
                yield from row._lines()
            elif isinstance(row, str):
                yield from row.split("\n")
            elif row.label:
                yield f"  {row.text(self.scale)}"
        if self.errors and any(row.error > 0 for row in self._values()):
            yield f"±: {self.errors}"
        for note in self.notes:
            yield ""
            yield f"Note: {note}"

    def latex(self) -> str:
        """The display that ``--format latex`` prints, units and notes as comments behind it."""
        lines = [latex.align(list(self._equations()))]
        if self.scale.si:
            lines.append("% numbers are in SI: m, s, kg, N, rad")
        lines += [f"% {note}" for note in self.notes]
        return "\n".join(lines)

    def _equations(self) -> Iterator[str]:
        for result in self.shown:
            yield from [result] if isinstance(result, str) else result.latex_rows()
        for row in self.rows:
            if isinstance(row, Answer):
                yield from row._equations()
            elif isinstance(row, Row) and row.latex():
                yield row.latex()


def _put(result: Values, key: str, ending: str, value: Any) -> None:
    """Set the value of a key, whose part behind a dot is the name in a mapping."""
    group, dot, entry = key.partition(".")
    if dot:
        result.setdefault(group + ending, {})[entry] = value
    else:
        result[group + ending] = value


def text_width() -> int:
    """Columns of the terminal, `WIDTH` at most; `WIDTH` in a file or a pipe."""
    if not sys.stdout.isatty():
        return WIDTH
    return min(shutil.get_terminal_size().columns, WIDTH)


def _wrapped(line: str, width: int) -> list[str]:
    """Break a line of text; further lines are indented by eight columns more."""
    indent = line[: len(line) - len(line.lstrip())]
    wrapper = textwrap.TextWrapper(width, "", f"{indent}        ")
    wrapper.wordsep_re = _BREAK
    return wrapper.wrap(line) or [""]
