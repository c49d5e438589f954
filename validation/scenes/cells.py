"""Tables of cells: the texts of recorders and programs, whatever stands around their numbers.

Cells are separated by tabs, semicolons, commas or blanks, by those that make most numbers. A comma
inside a cell, where others separate or in quotes, is a decimal comma.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections.abc import Iterator, Sequence
from itertools import chain, islice, pairwise
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import ArrayLike

from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

_LINE = re.compile(r"[^\r\n]*\S[^\r\n]*")  # a line that is not blank
# Signs with several codes, and the sign of recorders for a value beyond their range
_SIGNS = {"μ": "µ", "−": "-", "∞": "inf"}
HEAD = 1000
"""Lines at the start of a text in which the separator and the first row of numbers are looked for.

As many bytes at the start of a file show whether the file is a text, without a zero byte.
"""

_MARKS = "\t;, "
_UNIT = r"[pnuµmckMG]?(?:m/s|[smNV])"  # units that are told without brackets
HEADER = re.compile(
    rf"^(.*?) ?(?:(?:[([] ?|\bin )([^][()\s]+) ?[])]?|(?<=\w)[ _/]({_UNIT}))?$"
)
"""Pattern of the name and the unit of a column: "Force (N)", "Force [N]", "Force in N"; "Force N",
"Force_N" and "Force/N" end in a usual unit."""

# Texts of recorders in place of a value beyond their range, and the numbers that SCPI has for it
# and for no number (SCPI-99, vol. 1, 7.2.1)
_BEYOND = re.compile(r"[-+]?o(l|vld?|ver(load|flow|range)?)", re.IGNORECASE)
_CLOCK = re.compile(r"(?:[-\d./]+[T ])?(\d\d):(\d\d):(\d\d\.?\d*)Z?")
"""Pattern of a time of day, also behind a date."""
_SCPI = {9.9e37: math.inf, -9.9e37: -math.inf, 9.91e37: math.nan}

# Chosen: a preamble with numbers is short beside its record.
_FEW = 0.1  # rows of numbers outside of the record, at most, over those of the record
# Least share of numbers in a row of a record: a date and a time may stand in front.
_LEAST = 1 / 3
_SETTINGS = 20  # lines in whose first columns recorders write settings


class Cells:
    """A text as a table of cells.

    Attributes
    ----------
    head : list of rows
        Cells of the lines above the numbers.
    entries : dict of str
        Cells of a line of numbers, by the numbers of the columns, from 1; without other cells.
    """

    def __init__(self, text: str) -> None:
        found = islice(_LINE.finditer(text), HEAD)
        lines = [line[0] for line in found]
        tables = {}
        shares = {}
        for mark in _MARKS:
            tables[mark] = [_split(line, mark) for line in lines]
            shares[mark] = [_share(row) for row in tables[mark]]

        def record(mark: str) -> tuple[int, int]:
            """Return start and end of the longest run of rows of numbers, with this separator."""
            return longest([share >= _LEAST for share in shares[mark]])

        def weight(mark: str) -> float:
            """Count the numbers of the record, each weighted by the share of numbers in its row.

            Without the weight a separator that also cuts texts into pieces would count as good.
            """
            start, end = record(mark)
            rows = zip(tables[mark], shares[mark], strict=True)
            record_rows = islice(rows, start, end)
            return sum(len(row) * share**2 for row, share in record_rows)

        self._mark = mark = max(_MARKS, key=weight)
        self._text = text
        rows = tables[mark]
        start, end = record(mark)
        typical: list[str] = []
        if end:
            # Which columns hold numbers is read from one row of the record, after the settings.
            place = min(start + _SETTINGS, end - 1)
            typical = rows[place]
        else:
            # Without any row of numbers all lines are the head.
            start = len(rows)
        self.head = rows[:start]
        self._texts = set()
        for line, row in zip(lines, self.head, strict=False):
            if any(row) and not _share(row):
                self._texts.add(line)
        self.entries = {}
        for number, cell in enumerate(typical, start=1):
            if not math.isnan(number_of(cell)):
                self.entries[number] = cell
        if mark == " ":
            # A header of several words, in a table of blanks: two blanks or more part the headers.
            for i, above in enumerate(lines[:start]):
                bare = above.strip("#% \t")
                tabs = re.sub(r"[ \t]{2,}", "\t", bare)
                headers = _split(tabs, "\t")
                if len(headers) == len(typical):
                    self.head[i] = headers

    @classmethod
    def read(cls, path: str | Path) -> Cells:
        """Read a file, or standard input ("-"): UTF-8, UTF-16 by its mark, or Latin-1."""
        content = files.content(Path(path))
        encoding = "utf-8-sig"
        if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            encoding = "utf-16"
        # Recorders may pad a text with zeros at its end. JSON is what `run` stores beside CSV.
        elif b"\0" in content[:HEAD] or content.startswith(b"{"):
            raise SceneError("it is no table: rows of text, CSV say, are wanted")
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            # Any bytes are Latin-1: the µ of an older recorder, say.
            text = content.decode("latin-1")
        # A translation would take as much memory again.
        for sign, plain in _SIGNS.items():
            text = text.replace(sign, plain)
        return cls(text)

    @property
    def headers(self) -> set[str]:
        """All cells above the numbers."""
        return {*chain(*self.head)}

    def above(self, number: int) -> list[str]:
        """Return the cells above a column, counted from 1."""
        return [row[number - 1] for row in self.head if 0 < number <= len(row)]

    def headed(self, header: str) -> list[int]:
        """Return the numbers of the columns of a header, or the numbers that are given instead.

        The lowest row with such a header counts. In a row, cells that are the header itself go
        before cells that are the header and a unit.
        """
        number = r"[1-9]\d{0,5}"
        if re.fullmatch(f"{number}(,{number})*", header):
            return [*map(int, header.split(","))]
        wanted = header.lower()
        for row in reversed(self.head):
            for form in (str.lower, name_of):
                cells = enumerate(map(form, row), start=1)
                numbers = [number for number, cell in cells if cell == wanted]
                if numbers:
                    return numbers
        return []

    def columns(
        self, numbers: Sequence[int], most: int | None = None
    ) -> dict[int, Array]:
        """Return columns, (lines,), by their rising numbers; NaN for a cell without a number.

        Blank lines are left out, and lines after the first ``most``.
        """
        table = np.empty((0, len(numbers)))
        if self.entries and numbers:
            # NumPy's reader parses a million rows in a second, Python's in six.
            table = np.loadtxt(
                # Each line has a cell of the last, and highest, number.
                islice(self._lines(numbers[-1]), most),
                delimiter=self._mark.strip(" ") or None,
                comments=None,
                converters=number_of,
                quotechar='"',
                usecols=[number - 1 for number in numbers],
                ndmin=2,
            )
        return dict(zip(numbers, table.T, strict=True))

    def _lines(self, count: int) -> Iterator[str]:
        """Yield the lines, with so many cells more that the reader finds all columns."""
        # The reader refuses a line that is too short.
        more = f"{self._mark}nan" * count
        for line in self._data():
            text = line[0]
            if '"' in text:
                # NumPy takes quotes right after a separator; a single one would join lines.
                text = text.replace(f'{self._mark} "', f'{self._mark}"')
                if text.count('"') % 2:
                    text = text.replace('"', "'")
            yield text + more

    def _data(self) -> Iterator[re.Match[str]]:
        """Yield the lines, without comments among the numbers and without repeated headers.

        A recorder may write its header again after each block.
        """
        seen = set()
        for place, line in enumerate(_LINE.finditer(self._text)):
            text = line[0]
            comment = text.startswith("#") and place >= len(self.head)
            if not comment and text not in seen:
                yield line
            if text in self._texts:
                seen.add(text)

    def rows(self, table: Array) -> tuple[int, int]:
        """Return start and end of the record in a table of columns: the rows without any NaN.

        There must be such a row. Raises `SceneError` for a gap or an infinite value in the record.
        """
        numbers = ~np.isnan(table)
        # A row of the record has a number in each wanted column.
        complete = np.all(numbers, axis=1)
        start, end = longest(complete)
        found = runs(complete)
        place = found.index((start, end))
        # A preamble or a footer may hold a few rows of numbers, if lines without any number part
        # them from the record. Any other run of rows beside the record is a part of it, beyond a
        # gap.
        many = complete.sum() > (1 + _FEW) * (end - start)
        first = max(place - 1, 0)
        for before, after in pairwise(found[first : place + 2]):
            _, gap = before
            if many or numbers[gap : after[0]].any():
                at, text = self._line(gap)
                raise SceneError(f"line {at} is a gap in the record: {shorten(text)}")
        infinite = np.isinf(table[start:end])
        beyond = np.flatnonzero(infinite.any(axis=1))
        if len(beyond):
            at, _ = self._line(start + beyond[0])
            raise SceneError(
                f"line {at} holds ∞, the signal is clipped: a larger range of the recorder is "
                "wanted"
            )
        return start, end

    def _line(self, row: int) -> tuple[int, str]:
        """Return the number, from 1, and the text of the line of a row of `columns`."""
        line = next(islice(self._data(), row, None))
        above = self._text[: line.start()].splitlines()
        return len(above) + 1, line[0]


def longest(flags: ArrayLike) -> tuple[int, int]:
    """Return start and end of the longest run of true flags, (0, 0) without any."""
    return max(runs(flags), key=lambda run: run[1] - run[0], default=(0, 0))


def runs(flags: ArrayLike) -> list[tuple[int, int]]:
    """Return starts and ends of the runs of true flags.

    >>> runs([False, True, True, False, True])
    [(1, 3), (4, 5)]
    """
    numbered, _ = scipy.ndimage.label(np.append(flags, False))  # at least one flag
    parts = scipy.ndimage.find_objects(numbered)
    return [(part.start, part.stop) for (part,) in parts]


def name_of(header: str) -> str:
    """Return a header without its unit, in the form in which headers are compared.

    >>> name_of("# Time [ms]"), name_of("bead 8 Dynamic force (N)")
    ('time', 'bead 8 force')
    """
    name = HEADER.sub(r"\1", header).lower()
    return name.replace("dynamic ", "").strip("#% ")


def number_of(cell: str) -> float:
    """Return the number in a cell, of a time of day its seconds; NaN for other text.

    >>> [number_of(cell) for cell in ("-1,5", "1.5D-3", "+ 4", "12:03", "1_0", "-OL")]
    [-1.5, 0.0015, 4.0, nan, nan, -inf]
    >>> number_of("2026-11-28T00:02:03.5Z")
    123.5
    """
    if "_" in cell:  # Python reads 1_0 as 10
        return math.nan
    plain = cell.replace(",", ".")
    try:
        value = float(plain)
        return _SCPI.get(value, value)
    except ValueError:
        # Fortran writes 1.5D-3, and some loggers write + 1.5.
        plain = plain.replace("D", "e").replace("+ ", "+").replace("- ", "-")
    if _BEYOND.fullmatch(plain):
        return -math.inf if plain.startswith("-") else math.inf
    clock = _CLOCK.fullmatch(plain)
    if clock:
        hours, minutes, seconds = map(float, clock.groups())
        return 3600 * hours + 60 * minutes + seconds
    try:
        return float(plain)
    except ValueError:
        return math.nan


def _split(line: str, mark: str) -> list[str]:
    """Return the cells of a line."""
    if mark == " ":
        # The blank between a header and its unit in brackets does not separate.
        mark = "\t"
        bare = line.strip("#% \t")
        line = re.sub(r"[ \t]+(?![([])", mark, bare)
    # Cells in quotes may hold separators.
    reader = csv.reader([line], delimiter=mark, skipinitialspace=True)
    cells = next(reader)
    return [" ".join(cell.split()) for cell in cells]


def _share(row: Sequence[str]) -> float:
    """Return the share of numbers among the cells of a row that are not blank, or 0."""
    filled = [*filter(None, row)]
    numbers = [cell for cell in filled if not math.isnan(number_of(cell))]
    return len(numbers) / max(len(filled), 1)
