"""Columns of a table of cells: their names and units, of the file and of the user, and refusals.

A column is named by its header, in whatever line the header stands, or by its number, from 1.

Units are stated, never guessed, in the spellings of recorders and with any SI prefix: by the file,
in brackets after a header, as in "Force (mN)", or in a row of units; or by the user, whose word
stands above the file's. A statement of the user such as "12.5 N/V" holds a number, a unit, and
after the first slash the file's own name of its unit. All but one of the parts may be left out:
"us", "0.04 us", "N/V"; a number alone, "4e-8", is the value in SI of an entry 1. Where both name a
unit of one other quantity, V and mV, the prefixes count.

Values are in SI. A file whose named columns have no unit at all is in the scene's own numbers; if
one has a unit, each that is used needs one.

A refusal lists the columns and proposes statements that read the file. For a name without a column
it is the column that has a unit of the quantity; else one that behaves like it: times rise, but do
not count their lines, signals vary. Where no column may be the time, a step is proposed, as the
head tells it. A "?" stands for a number that the user alone knows, of a calibration, say.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import zip_longest
from typing import TypedDict

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.cells import (
    HEAD,
    HEADER,
    Cells,
    longest,
    name_of,
    number_of,
)
from validation.scenes.checks import SceneError

BASES = {
    "time": "s",
    "arrival": "s",
    "FWHM": "s",
    "displacement": "m",
    "compression": "m",
    "force": "N",
    "velocity": "m/s",
    "speed": "m/s",
    "force_error": "N",
    "speed_error": "m/s",
}
"""SI units of the quantities that are read and written."""

# Other spellings; upper and lower case are alike.
_SPELLINGS = {
    "s": "s|se[ck](onde?s?|s|unden?)?",
    "m": "m|met(er|re)s?",
    "N": "N|newtons?",
    "m/s": "m/s|m/sec",
    "V": "V|volts?",
    "C": "C|coulombs?",
    "Hz": "Hz|hertz",
}
# Names of prefixes by their powers of ten
_PREFIXES = {
    -15: "f femto",
    -12: "p pico",
    -9: "n nano",
    -6: "u µ micro",
    -3: "m milli",
    -2: "c centi",
    -1: "d deci",
    0: "",
    1: "da deca",
    2: "h hecto",
    3: "k kilo",
    6: "M mega",
    9: "G giga",
    12: "T tera",
}
_POWERS = {
    name: power for power, names in _PREFIXES.items() for name in names.split(" ")
}

NAME = re.compile(
    "time|displacement|speed|force_error|speed_error"
    r"|(?!contact.*velocity)(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(force|velocity)"
)
"""Pattern of the names of columns."""

NAMES = ("time", "bead 8 force", "bead 8 velocity", "contact 8 force", "speed")
"""Examples of names."""

STEP = "? us"
"""A time that the user alone knows; what stands for a number that is not known is refused."""

# A number without a sign
_UNSIGNED = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_TOLD = re.compile(
    r"(?:interval|increment|[xt]_?inc|delta_?x|hresolution|sampl\w* ?period"
    rf"|(sampl\w*[ _]?(?:rate|frequency)))\W*({_UNSIGNED}) ?([kMGmnuµ]?(?:s|Hz)\b)?",
    re.IGNORECASE,
)
"""Pattern of the time from sample to sample, or of the rate, in a head."""
# Columns in a message, which is to have 300 characters at most: of a column its number, up to 20
# characters of its header and up to 12 of an entry
_LISTED = 4
_UNLIKE = 2  # least rank of a column that does not behave like a quantity


class Stated(TypedDict, total=False):
    """Statements of the user about measured files, as keywords.

    Attributes
    ----------
    columns : mapping of str
        Headers, with or without their units, or numbers of columns, by the names "time",
        "bead 8 force", "bead 8 velocity", "contact 8 force", "force", "speed", …; numbers of
        several times, one for each sensor, have commas.
    units : mapping of str
        Statements by name, header or number of a column.
    step : str
        Time from each sample to the next, as a statement, in place of a column.
    """

    columns: Mapping[str, str]
    units: Mapping[str, str]
    step: str | None


@dataclass(frozen=True)
class Column:
    """A column of a file that has a name.

    Parameters
    ----------
    name : str
        Name of the column, such as "time" or "bead 8 force".
    number : int or None
        Number of the column in the file, from 1; None for times that a step states.
    unit : str
        Unit that the file states, "" for none.
    key, stated : str
        Name or header under which the user states a unit, and the statement, "" for none.
    """

    name: str
    number: int | None
    unit: str
    key: str
    stated: str

    @property
    def base(self) -> str:
        """SI unit of the column's quantity."""
        # The quantity is the last word of a name such as "bead 8 force".
        return BASES[self.name.split()[-1]]

    @property
    def size(self) -> float | None:
        """Value in SI of an entry 1; None if the column has no unit of its quantity."""
        if not self.stated:
            return in_si(self.unit, self.base)
        statement = read_statement(self.stated, self.base)
        if statement is None:
            return None
        size, named = statement
        # The unit of a sensitivity, mV in 80 mV/N, may have another prefix than the file's, V.
        theirs = known(named)
        own = known(self.unit)
        if theirs and own and theirs[0] == own[0] != self.base:
            size *= own[1] / theirs[1]
        return size

    @property
    def proposed(self) -> str:
        """A statement that is valid, in place of a unit that is missing or of another quantity."""
        # A scale in the header, as of "force (10 N)", may be meant as a range: the user says it.
        if read_statement(self.unit, self.base):
            return self.unit
        # After the slash stands the file's own name of its unit.
        unit = f"{self.base}/{self.unit}" if self.unit else self.base
        return unit if unit == "s" else f"? {unit}"

    @property
    def fault(self) -> str:
        """Words on a unit that is missing or of another quantity."""
        base = self.base
        found = "missing"
        if self.stated or self.unit:
            found = shorten(self.stated or self.unit)
        return (
            f"unit of {self.name} is {found}: such as {base}, m{base}, 0.04 {base} or 12.5 "
            f"{base}/V is wanted"
        )


@dataclass(frozen=True, eq=False)
class Columns:
    """The columns of a table that have names, by the user's statements and by their headers.

    Parameters
    ----------
    path : str
        Name of the file.
    cells : Cells
        The table.
    headers : mapping of str
        The user's headers, or numbers of columns, by the names of the columns.
    units : mapping of str
        The user's statements of units by name, header or number of a column.
    step : str
        The user's statement of the time from sample to sample, "" for none.
    """

    path: str
    cells: Cells
    headers: Mapping[str, str]
    units: Mapping[str, str]
    step: str = ""

    @cached_property
    def named(self) -> list[Column]:
        """The columns in their order, behind the times that a step states."""
        # Names by the numbers of their columns. Of columns with one header the first is taken here;
        # `validation.scenes.measured` refuses a header that is not unique.
        names: dict[int, str] = {}
        for name, header in self.headers.items():
            names |= dict.fromkeys(self.cells.headed(header), name)
        columns = []
        if self.step:
            columns.append(Column("time", None, "", "", self.step))
        # The user's word stands above the file's headers.
        taken = {*names.values(), *(column.name for column in columns)}
        for row in reversed(self.cells.head):  # the lowest header counts
            found = {}
            for number, cell in enumerate(row, start=1):
                name = name_of(cell)
                if NAME.fullmatch(name) and name not in taken:
                    found[number] = name
            names = found | names
            taken |= {*found.values()}
        # A unit is that of the column of this name, else of all columns with this header.
        keys: dict[int, str] = {}
        for given in self.units:
            wanted = name_of(given)
            own = [number for number, name in names.items() if name == wanted]
            keys |= dict.fromkeys(own or self.cells.headed(given), given)
        for number, name in sorted(names.items()):
            key = keys.get(number, name)
            unit = found_unit(self.cells.above(number))
            stated = self.units.get(key, "")
            columns.append(Column(name, number, unit, key, stated))
        return columns

    @property
    def names(self) -> list[str]:
        """Names of the columns, in their order."""
        return [column.name for column in self.named]

    @property
    def si(self) -> bool:
        """True if a unit is stated, by the file or by the user: values are in SI then."""
        texts = [column.stated or column.unit for column in self.named]
        # A number alone, with the E of its power, is a factor and states no unit.
        return bool(re.search(r"[^-+.\deE ]", "".join(texts)))

    def refusal(
        self, words: str, missing: Sequence[str] = (), step: str = ""
    ) -> SceneError:
        """Return an error that names the file, lists its columns and proposes statements.

        Parameters
        ----------
        words : str
            Description of the fault.
        missing : sequence of str
            Names for which columns are proposed, the time first.
        step : str
            Time from sample to sample that is proposed in place of a column.
        """
        cells = self.cells
        headers = {n: header for n, header in self.headers.items() if n not in missing}
        # Columns that are named already are not proposed for another name.
        used = {column.number for column in self.named if column.name not in missing}
        free = [number for number in cells.entries if number not in used]
        steps = _steps(cells)
        if not cells.entries:
            missing = ()  # no step helps a file without numbers
        for name in missing:
            rank = partial(_rank, cells, steps, name)
            best = min(free, key=rank, default=None)
            if name == "time" and (step or best is None or rank(best) >= _UNLIKE):
                step = step or _told_step(cells)
            elif best is not None:
                # Each sensor may have a time of its own.
                alike = [number for number in free if rank(number) == rank(best)]
                taken = [best]
                if name == "time" and len(alike) == len(used):
                    taken = alike
                free = [number for number in free if number not in taken]
                headers[name] = ",".join(map(str, taken))
        proposed = replace(self, headers=headers, step=step or self.step)
        units = {}
        for column in proposed.named:
            # Times that a step states, which have no number of a column, bring their own unit. Of a
            # column without a unit of its quantity one is proposed; others keep the user's word.
            if column.number is not None:
                if column.size is None and proposed.si:
                    units[column.key] = column.proposed
                elif column.stated:
                    units[column.key] = column.stated
        # The options that the error proposes, by their names on the command line
        change = {}
        for option, given, wanted in (
            ("columns", self.headers, headers),
            ("step", self.step, proposed.step),
            ("units", self.units, units),
        ):
            if given or wanted:  # an empty proposal takes the user's own statement away
                change[option] = wanted
        return SceneError(f"{self.path}: {words}: found {_listed(cells)}", **change)


def _rank(cells: Cells, steps: dict[int, Array], name: str, number: int) -> int:
    """Return the rank of a column among those for a name, 0 for the best.

    A column that does not behave like the quantity ranks behind all that do; among equals one with
    a unit of the quantity is the better.
    """
    base = BASES[name.split()[-1]]
    unknown = in_si(found_unit(cells.above(number)), base) is None
    own = steps[number]
    if name == "time":
        # A column without a unit that rises by 1 counts the lines; times in a unit may do so.
        lines = unknown and np.all(own == 1)
        rises = own.min(initial=0) >= 0 < own.max(initial=0)
        suits = rises and not lines
    else:
        # Counts of lines, and constants, are no signals: all their steps are equal.
        suits = len(np.unique(own)) > 1
    return unknown + _UNLIKE * (not suits)


def _steps(cells: Cells) -> dict[int, Array]:
    """Return the differences from line to line, at the beginning, of the columns of numbers."""
    steps = {}
    columns = cells.columns([*cells.entries], HEAD)
    for number, column in columns.items():
        start, end = longest(np.isfinite(column))
        steps[number] = np.diff(column[start:end])
    return steps


def _told_step(cells: Cells) -> str:
    """Return the time from sample to sample, or the rate, that the head tells; else `STEP`."""
    # The number stands beside its name, or below it.
    for row in (*cells.top, *zip_longest(*cells.top, fillvalue="")):
        found = _TOLD.search(" ".join(row))
        if found:
            rate, number, unit = found.groups()
            return f"{number} {unit or (rate and 'Hz') or 's'}"
    return STEP


def _listed(cells: Cells) -> str:
    """Return words on the first columns of numbers: number, header and an entry."""
    found = []
    for number, entry in cells.entries.items():
        above = cells.above(number)[-2:]
        header = " ".join(above)[-20:].strip()
        found.append(f"{number} {header!r} {entry[:12]}")
    return ", ".join(found[:_LISTED]) or "no numbers"


def in_si(unit: str, base: str) -> float | None:
    """Return a unit as a multiple of a base unit, or None for a unit of another quantity.

    >>> [in_si(unit, "s") for unit in ("ms", "uS", "USEC", "Microseconds", "N")]
    [0.001, 1e-06, 1e-06, 1e-06, None]
    """
    found = known(unit)
    return found[1] if found and found[0] == base else None


def known(unit: str) -> tuple[str, float] | None:
    """Return the base unit of a unit, and the unit's size in it; None for an unknown unit.

    For "ms" they are "s" and 0.001.
    """
    for base, spellings in _SPELLINGS.items():
        text = unit
        # Recorders that write in capitals mean ms by MS; MN may well be a meganewton.
        if unit.isupper() and base != "N":
            text = unit.lower()
        parts = re.fullmatch(rf"([a-zA-Zµ]*?)(?i:{spellings})", text)
        if parts:
            # M is mega and m milli, but Micro is micro.
            prefix = parts[1]
            power = _POWERS.get(prefix, _POWERS.get(prefix.lower()))
            if power is not None:
                return base, 10.0**power
    return None


def found_unit(cells: Sequence[str]) -> str:
    """Return the unit that the cells above a column state, "" for none; the lowest one counts."""
    for cell in reversed(cells):
        header = HEADER.fullmatch(cell)
        if header:
            name, *units = header.groups("")
            # "0.5 ms", and "rate = 0.5 ms", are settings.
            if any(units) and math.isnan(number_of(name.rpartition("=")[2])):
                return "".join(units)
    # A row of units stands below names: the V of a single header is a speed, say.
    below = [*filter(None, cells)][1:]
    return next(filter(known, reversed(below)), "")


def read_statement(text: str, base: str) -> tuple[float, str] | None:
    """Return the value in SI of an entry 1, and the name of the file's unit ("" if none is named).

    Parameters
    ----------
    text : str
        A statement of the user.
    base : str
        Unit in SI of the quantity, one of `BASES`.

    Returns
    -------
    tuple or None
        None for a text that is no statement of this quantity.

    Examples
    --------
    >>> read_statement("12.5 mN/V", "N"), read_statement("us", "s"), read_statement("us", "N")
    ((0.0125, 'V'), (1e-06, 'us'), None)
    >>> read_statement("10 mV/N", "N"), read_statement("x10^-6 s", "s")
    ((0.1, 'mV'), (1e-06, ''))
    >>> read_statement("2 MHz", "s")
    (5e-07, '')
    """
    plain = text.replace("μ", "µ").replace("10^", "1e").strip()
    plain = re.sub(r"^[x×*] ?(?=\d)", "", plain)
    parts = re.fullmatch(rf"(-?)({_UNSIGNED})? *(.*)", plain)
    assert parts is not None  # all may be empty
    # A sign alone turns an inverted signal: -N/V.
    sign, number, unit = parts.groups()
    size = float(f"{sign}{number or 1}")
    if number and not unit:
        return size, ""
    # Behind the unit stands whatever the file calls its own, m/s^2 say.
    words = unit.split("/")
    for count in (1, 2):  # the unit of a velocity has a slash of its own
        own = "/".join(words[:count])
        multiple = in_si(own.strip(), base)
        if multiple is not None:
            named = "/".join(words[count:])
            # A unit alone is the file's, too.
            return size * multiple, named or ("" if number else unit)
    rate = in_si(unit, "Hz")
    if base == "s" and rate and size:
        return 1 / (size * rate), ""
    # A sensitivity, as of a data sheet, is the other way around: 10 mV/N.
    *theirs, ours = unit.split("/")
    multiple = in_si(ours.strip(), base)
    if theirs and multiple and size:
        return multiple / size, "/".join(theirs)
    return None


def read_time(text: str, name: str) -> float:
    """Return a time above 0 in SI, as a statement of the user; `SceneError` for another text.

    Parameters
    ----------
    text : str
        The statement.
    name : str
        Name of its option in Python.
    """
    statement = read_statement(text, "s")
    if statement is None or not statement[0] > 0:
        option = name.replace("_", "-")
        raise SceneError(
            f"{option} is {shorten(text)}: a time above 0 is wanted", **{name: STEP}
        )
    return statement[0]
