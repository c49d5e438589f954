"""Columns of a table of cells: their names and units, of the file and of the user.

A column is named by its header, in whatever line the header stands, or by its number, from 1.

Units are stated, never guessed: by the user (`validation.scenes.units`), whose word stands above
the file's, in brackets behind a header, as in "Force (mN)", or in a row of units. Values are in SI.
A file whose named columns have no unit at all is in the scene's own numbers; if one has a unit,
each that is used needs one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypedDict

from lwa.base.exact import shorten
from validation.scenes.cells import Cells
from validation.scenes.units import (
    BASES,
    found_unit,
    in_si,
    known,
    name_of,
    read_statement,
)

NAME = re.compile(
    "time|displacement|speed|force_error|speed_error"
    r"|(?!contact.*velocity)(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(force|velocity)"
)
"""Pattern of the names of columns."""

NAMES = ("time", "bead 8 force", "bead 8 velocity", "contact 8 force", "speed")
"""Examples of names."""


class Stated(TypedDict, total=False):
    """Statements of the user about measured files, as keywords.

    Attributes
    ----------
    columns : mapping of str
        Headers, with or without their units, or numbers of columns, by the names "time",
        "bead 8 force", "bead 8 velocity", "contact 8 force", "force", "speed", ….
    units : mapping of str
        Statements (`validation.scenes.units`) by name, header or number of a column.
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
        Its name, such as "time" or "bead 8 force".
    number : int or None
        Its number in the file, from 1; None for the times that a step states.
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
        """Unit of its quantity in SI."""
        return BASES[self.name.split()[-1]]

    @property
    def size(self) -> float | None:
        """Value in SI of an entry 1; None without a unit of its quantity."""
        if not self.stated:
            return in_si(self.unit, self.base)
        statement = read_statement(self.stated, self.base)
        return statement and statement[0]

    @property
    def proposed(self) -> str:
        """A statement that is valid, in place of a unit that is missing or of another quantity."""
        # Behind the slash stands the file's own name of its unit.
        return f"1 {self.base}/{self.unit}" if self.unit else self.base

    @property
    def fault(self) -> str:
        """Words on a unit that is missing or of another quantity."""
        unit = self.stated or self.unit
        found = shorten(unit) if unit else "missing"
        base = self.base
        return (
            f"unit of {self.name} is {found}: such as {base}, m{base}, 0.04 {base} or 12.5 "
            f"{base}/{self.unit or 'V'} is wanted"
        )

    @property
    def note(self) -> str:
        """A line on a unit that the user states otherwise than the file; "" for none."""
        statement = read_statement(self.stated, self.base)
        if not (self.stated and self.unit and statement and statement[1]):
            return ""
        # Spellings of one unit are alike: us, µs, usec.
        theirs, own = (known(unit) or unit for unit in (statement[1], self.unit))
        if theirs == own:
            return ""
        return f"{self.name}: {self.stated} is stated, the file says {self.unit}."


@dataclass(frozen=True, eq=False)
class Columns:
    """The columns of a table that have names, by the user's statements and by their headers.

    Parameters
    ----------
    cells : Cells
        The table.
    headers : mapping of str
        The user's headers, or numbers of columns, by the names of the columns.
    units : mapping of str
        The user's statements of units by name, header or number of a column.
    step : str
        The user's statement of the time from sample to sample, "" for none.
    """

    cells: Cells
    headers: Mapping[str, str]
    units: Mapping[str, str]
    step: str = ""

    @cached_property
    def named(self) -> list[Column]:
        """The columns in their order, behind the times that a step states."""
        names: dict[int, str] = {}
        for name, header in self.headers.items():
            names |= dict.fromkeys(self.cells.headed(header)[:1], name)
        columns = []
        if self.step:
            columns.append(Column("time", None, "", "", self.step))
        taken = {*names.values(), *(column.name for column in columns)}
        for row in reversed(self.cells.head):  # the lowest header counts
            found = {}
            for number, cell in enumerate(row, start=1):
                name = name_of(cell)
                if NAME.fullmatch(name) and name not in taken:
                    found[number] = name
            names = found | names
            taken |= {*found.values()}
        keys: dict[int, str] = {}
        for given in self.units:
            own = [number for number, name in names.items() if name == name_of(given)]
            keys |= dict.fromkeys(own or self.cells.headed(given), given)
        for number, name in sorted(names.items()):
            key = keys.get(number, name)
            unit = found_unit(self.cells.above(number))
            columns.append(Column(name, number, unit, key, self.units.get(key, "")))
        return columns

    @property
    def names(self) -> list[str]:
        """Names of the columns, in their order."""
        return [column.name for column in self.named]

    @property
    def si(self) -> bool:
        """Whether a unit is stated, by the file or by the user; values are in SI then."""
        texts = [column.stated or column.unit for column in self.named]
        # A number alone is a factor.
        return bool(re.search(r"[^-+.\deE ]", "".join(texts)))
