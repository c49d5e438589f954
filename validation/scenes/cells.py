"""Tables of cells: the texts of recorders and programs, whatever stands around their numbers.

Cells are separated by tabs, semicolons, commas or blanks, by those that make most numbers. A comma
inside a cell, where others separate or in quotes, is a decimal comma. Where cells such as 0,5 tell
the decimal sign of a file, 1.234 is a number with its thousands marked.

A table that lies, with a signal in each row, is set upright; rows may stand in brackets, as lists.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import chain, islice, zip_longest
from pathlib import Path
from statistics import median

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

_FOLDED = re.compile(r'"(?<![^;,\t\n]")[^"\n]*(?:\n[^"\n]*){1,3}"(?=[;,\t\r\n])')
"""Pattern of a cell of several lines, such as a header above its unit."""
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
    r"^(.*?) ?(?:(?:[([] ?|\bin |(?<= )/ )((?:\S*\d )?[^][()\s]+) ?[])]?"
    rf"|(?<=\w)(?:,? |[_/])({_UNIT}))?$"
)
"""Pattern of the name and the unit of a column: "Force (N)", "Force [10 N]", "Force in N",
"Force / N"; "Force N", "Force, N", "Force_N" and "Force/N" end in a usual unit."""

# Texts of recorders in place of a value beyond their range, and the numbers that SCPI has for it
# and for no number (SCPI-99, vol. 1, 7.2.1)
_BEYOND = re.compile(r"[-+]?o(l|vld?|ver(load|flow|range)?)", re.IGNORECASE)
_CLOCK = re.compile(
    r"(?:[-\d./]+[T ])?(?:(\d\d?):)?(\d\d?):(\d\d[.,]\d*|(?<=:\d\d:)\d\d)"
    r"(?:Z|[-+]\d\d:\d\d| ?([AP])M)?"
)
"""Pattern of a time of day, also behind a date; without hours the seconds have a fraction."""
_THOUSANDS = re.compile(r" *[-+]?[1-9]\d{0,2}([.,]\d{3})+(?!\d)")
_DECIMAL = re.compile(
    r"(?![-+]?[1-9]\d{0,2}(?:[.,]\d{3})+$)"
    r"[-+]?(?:\d*|\d{1,3}(?:[.,]\d{3})+)([.,])\d+(?:[eE][-+]?\d+)?"
)
"""Pattern of a number whose last sign is a decimal one: that of 1.234 may mark thousands."""
_MARKED = re.compile(
    r"(?<=\d)(?:['’\xa0\u202f](?=\d{3}(?!\d))|([.,])(?=(?:\d{3}\1)*\d{3}(?!\1)[.,]))"
)
"""Pattern of a sign that only marks thousands: a hard blank, an apostrophe, the first of two."""
_SCPI = {9.9e37: math.inf, -9.9e37: -math.inf, 9.91e37: math.nan}

# Chosen: a preamble with numbers is short beside its record.
_FEW = 0.1  # rows of numbers outside of the record, at most, over those of the record
# Least share of numbers in a row of a record: a date and a time may stand in front.
_LEAST = 1 / 3
_SETTINGS = 20  # lines in whose first columns recorders write settings
# Chosen: a pulse of 16 samples above its half keeps its shape without two of them.
_LOST = 3.5  # least time from row to row that is a gap, over the usual one
_WIDE = 3  # least length of the rows of a table that lies, over their number


class Cells:
    """A text as a table of cells.

    Attributes
    ----------
    head : list of rows
        Cells of the lines above the numbers.
    top : list of rows
        The head, and the first line of numbers, which may hold settings.
    turned : str
        The text of the table upright if it lies, else "".
    entries : dict of str
        Cells of a line of numbers, by the numbers of the columns, from 1; without other cells.
    """

    def __init__(self, text: str) -> None:
        lines = [line[0] for line in islice(_LINE.finditer(text), HEAD)]
        tables = {}
        weights = {}
        for mark in _MARKS:
            tables[mark] = [_split(line, mark) for line in lines]
            weights[mark] = [*map(_weight, tables[mark])]

        def record(mark: str) -> tuple[int, int]:
            """Return start and end of the longest run of rows of numbers, with this separator."""
            return longest(np.array(weights[mark]) > 0)

        def total(mark: str) -> float:
            """Sum the weights of the record's usual rows.

            A line of the head that one separator cuts into numbers does not decide.
            """
            start, end = record(mark)
            own = weights[mark][start:end]
            usual = median(own or [0])
            return usual * sum(weight >= usual for weight in own)

        self._mark = mark = max(_MARKS, key=total)
        self._text = text
        rows = tables[mark]
        start, end = record(mark)
        found = map(_DECIMAL.fullmatch, chain(*rows[start:end]))
        decimal = {number[1] for number in found if number}
        self._thousands = {",": ".", ".": ","}.get("".join(decimal), "")
        typical = []
        if end:
            # Which columns hold numbers is read from one row of the record, after the settings.
            typical = rows[min(start + _SETTINGS, end - 1)]
        else:
            # Without any row of numbers all lines are the head.
            start = len(rows)
        self.head = rows[:start]
        self.top = rows[: start + 1]
        self.entries = {}
        for number, cell in enumerate(typical, start=1):
            if not math.isnan(self._reader(cell)(cell)):
                self.entries[number] = cell
        self.turned = ""
        # In a table that lies all rows begin alike, with a name or with a number.
        begins = {math.isnan(number_of(row[0])) for row in rows}
        if len(typical) > _WIDE * end == _WIDE * len(rows) and len(begins) == 1:
            self.turned = "\n".join(map("\t".join, zip_longest(*rows, fillvalue="")))
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
        elif not content[1:HEAD:2].strip(b"\0"):
            encoding = "utf-16-le"
        # Recorders may pad a text with zeros at its end.
        elif b"\0" in content[:HEAD]:
            raise SceneError("it is no table: rows of text, CSV say, are wanted")
        if re.match(rb'\{\s*"', content):
            raise SceneError(
                "it is no table but JSON; try: lwa-validate run scene.toml --out FILE.csv"
            )
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            # Any bytes are Latin-1: the µ of an older recorder, say.
            text = content.decode("latin-1")
        # A translation would take as much memory again.
        for sign, plain in _SIGNS.items():
            text = text.replace(sign, plain)
        text = _FOLDED.sub(lambda cell: " ".join(cell[0].split()), text)
        if text.startswith(("{{", "[[")):  # rows in brackets; Mathematica's 2.*^-6
            text = "".join(text.replace("*^", "e").split())
            text = re.sub(r"[]}],[{[]", "\n", text).strip("[]{}")
        cells = cls(text)
        return cls(cells.turned) if cells.turned else cells

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
                converters={
                    n - 1: self._reader(self.entries.get(n, "")) for n in numbers
                },
                quotechar='"',
                usecols=[number - 1 for number in numbers],
                ndmin=2,
            )
        return dict(zip(numbers, table.T, strict=True))

    def _reader(self, entry: str) -> Callable[[str], float]:
        """Return the reader of a column with this entry.

        Times of day may stand above signals, too: they are no numbers there.
        """
        if _CLOCK.fullmatch(entry):
            return seconds_of
        return partial(number_of, thousands=self._thousands)

    def _lines(self, count: int) -> Iterator[str]:
        """Yield the lines, each with ``count`` cells "nan" more.

        NumPy's reader refuses a line with fewer cells than the columns that are read: with the
        number of the last column as ``count`` no line has too few.
        """
        more = f"{self._mark}nan" * count
        for line in self._data():
            text = line[0]  # the whole line, of the match
            if '"' in text:
                # NumPy takes quotes right after a separator; a single one would join lines.
                text = text.replace(f'{self._mark} "', f'{self._mark}"')
                if text.count('"') % 2:
                    text = text.replace('"', "'")
            yield text + more

    def _data(self) -> Iterator[re.Match[str]]:
        """Yield the lines, without comments among the numbers."""
        for place, line in enumerate(_LINE.finditer(self._text)):
            if place < len(self.head) or not line[0].startswith("#"):
                yield line

    def rows(self, table: Array, timed: bool) -> NDArray[np.intp]:
        """Return the places of the rows of the record in a table of columns: those without any NaN.

        There must be such a row. Raises `SceneError` for a gap or an infinite value in the record.

        Parameters
        ----------
        table : array
            Columns, (lines, columns).
        timed : bool
            Whether the first column is the time: rows between two whose times are near, as where
            single samples are lost or channels take turns, are then no gap.
        """
        numbers = ~np.isnan(table)
        # A row of the record has a number in each wanted column.
        complete = np.all(numbers, axis=1)
        joined = complete
        kept = np.flatnonzero(complete)
        if timed and len(kept) > 1:
            with np.errstate(invalid="ignore"):  # ∞ - ∞
                steps = np.diff(table[kept, 0])
                near = (steps > 0) & (steps < _LOST * np.median(steps))
            # The sum is the number of whole rows so far, behind which a row is bridged.
            bridged = np.pad(near, 1)
            joined = complete | bridged[np.cumsum(complete)]
        start, end = longest(joined)
        found = runs(joined)
        place = found.index((start, end))
        # A preamble may hold a few rows of numbers, if lines without any number part them from the
        # record, and a footer a few. Any other run of rows beside the record is a part of it,
        # beyond a gap.
        many = joined.sum() > (1 + _FEW) * (end - start)
        gap = end if many else None
        if place:
            _, above = found[place - 1]
            if many or numbers[above:start].any():
                gap = above
        if gap is not None:
            at, text = self._line(gap)
            raise SceneError(
                f"line {at} is a gap in the record: {shorten(text)}; head -n {at - 1} "
                "keeps the part above"
            )
        infinite = np.isinf(table[start:end])
        beyond = np.flatnonzero(infinite.any(axis=1))
        if len(beyond):
            at, _ = self._line(start + beyond[0])
            raise SceneError(
                f"line {at} holds ∞, the signal is clipped: a larger range of the recorder is "
                "wanted"
            )
        return start + np.flatnonzero(complete[start:end])

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


def number_of(cell: str, thousands: str = "") -> float:
    """Return the number in a cell, NaN for other text.

    The sign ``thousands`` marks thousands where three digits follow it.


    >>> [number_of(cell) for cell in ("-1,5", "1.5D-3", "+ 4", "1'234,5", "1_0", "-OL")]
    [-1.5, 0.0015, 4.0, 1234.5, nan, -inf]
    >>> number_of("1.234"), number_of("1.234", thousands="."), number_of("1,234,567.5")
    (1.234, 1234.0, 1234567.5)
    """
    if "_" in cell:  # Python reads 1_0 as 10
        return math.nan
    if thousands and thousands in cell and _THOUSANDS.match(cell):
        cell = cell.replace(thousands, "")
    try:
        value = float(cell.replace(",", "."))
        return _SCPI.get(value, value)
    except ValueError:
        # Fortran writes 1.5D-3, and some loggers write + 1.5.
        plain = _MARKED.sub("", cell).replace(",", ".").replace("D", "e")
        plain = plain.replace("+ ", "+").replace("- ", "-")
    if _BEYOND.fullmatch(plain):
        return -math.inf if plain.startswith("-") else math.inf
    try:
        return float(plain)
    except ValueError:
        return math.nan


def seconds_of(stamp: str) -> float:
    """Return the seconds of a time of day, NaN for other text.

    >>> seconds_of("2026-11-28T00:02:03.5Z"), seconds_of("02:03,5"), seconds_of("12:03")
    (123.5, 123.5, nan)
    >>> seconds_of("28.11.2026 12:00:01 AM"), seconds_of("12:00:01 pm")
    (1.0, nan)
    """
    found = _CLOCK.fullmatch(stamp.strip())
    if not found:
        return math.nan
    hours, minutes, seconds, half = found.groups("0")
    hour = float(hours)
    if half != "0":
        hour = hour % 12 + 12 * (half == "P")
    return 3600 * hour + 60 * float(minutes) + number_of(seconds)


def _split(line: str, mark: str) -> list[str]:
    """Return the cells of a line."""
    if mark == " ":
        # The blank between a header and its unit in brackets does not separate.
        mark = "\t"
        bare = line.strip("#% \t")
        line = re.sub(r"[ \t]+(?![([])", mark, bare)
    # Cells in quotes may hold separators.
    cells = next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    return [re.sub(" +", " ", cell.strip()) for cell in cells]


def _weight(row: Sequence[str]) -> float:
    """Count the numbers of a row, weighted by their share; 0 if the share is below `_LEAST`.

    Without the weight a separator that also cuts texts into pieces would count as good.
    """
    filled = [*filter(None, row)]
    numbers = [cell for cell in filled if not math.isnan(number_of(cell))]
    share = len(numbers) / max(len(filled), 1)
    return len(row) * share**2 * (share >= _LEAST)
