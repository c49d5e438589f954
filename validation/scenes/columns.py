"""Columns of measured files: names and units, of the file and of the user.

A column is named by its header, in whatever line the header stands, or by its number, from 1. A
record is the wanted columns in the rows where all of them are numbers; preambles, rows of units,
footers and blank ends are not.

Units are stated, never guessed: by the user (`validation.scenes.units`), whose word stands above
the file's, in brackets behind a header, as in "Force (mN)", or in a row of units. Values are in SI.
A file whose named columns have no unit at all is in the scene's own numbers; if one has a unit,
each that is used needs one.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import cycle
from pathlib import Path
from typing import TypedDict, Unpack

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.base.files import reason
from lwa.base.words import similar
from validation.scenes.cells import Cells
from validation.scenes.checks import SceneError
from validation.scenes.units import (
    found_unit,
    known,
    name_of,
    read_statement,
    size_of,
)

_NAME = re.compile(
    "time|displacement|speed|force_error|speed_error"
    r"|(?!contact.*velocity)(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(force|velocity)"
)


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


@dataclass(frozen=True, eq=False)
class Record:
    """Samples of a signal at a sensor.

    Parameters
    ----------
    kind : {"bead", "contact"}
        Kind of the sensor.
    number : int or None
        Number of the bead or contact, from 1; None if the file does not say it.
    quantity : {"force", "velocity"}
        The signal.
    time, values : array
        Times and values of the samples, (S,).
    inverted : str
        Option of the command line that changes the signal's sign.
    """

    kind: str
    number: int | None
    quantity: str
    time: Array
    values: Array
    inverted: str


class MeasuredFile:
    """The named columns of a file.

    Parameters
    ----------
    path : str or Path
        Name of the file; "-" is standard input.
    columns, units, step
        Statements of the user, see `Stated`.

    Attributes
    ----------
    names : dict of str
        Names by the numbers of the columns; number 0 is the time that a step states.

    Raises
    ------
    SceneError
        In one line, for a file that cannot be read or has no such columns, and for statements on
        columns that the file does not have.
    """

    def __init__(self, path: str | Path, **stated: Unpack[Stated]) -> None:
        self.path = "standard input" if str(path) == "-" else path
        try:
            self._cells = Cells.read(path)
        except (OSError, SceneError, csv.Error) as error:
            raise SceneError(f"{self.path}: {reason(error)}") from None
        step = stated.get("step")
        self.names = {0: "time"} if step else {}
        self._stated = {0: step} if step else {}
        self._keys: dict[int, str] = {}  # names or headers by which units are stated
        self._name_columns(stated.get("columns") or {})
        for key, statement in (stated.get("units") or {}).items():
            numbers = self._named(name_of(key)) or self._cells.headed(key)
            if not numbers:
                raise self._fault(key, numbers)
            self._stated |= dict.fromkeys(numbers, str(statement))
            self._keys |= dict.fromkeys(numbers, key)

    def _name_columns(self, stated: Mapping[str, str]) -> None:
        """Name the columns that the user states, and those whose headers are such names."""
        for given, column in stated.items():
            name = name_of(given)
            if not _NAME.fullmatch(name):
                known = "time, bead 8 force, bead 8 velocity, contact 8 force, speed"
                raise SceneError(
                    f"column is {shorten(given)}: such as {known} is wanted"
                )
            numbers = self._cells.headed(str(column))
            if len(numbers) != 1:
                raise self._fault(str(column), numbers, [name])
            self.names[numbers[0]] = name
        for row in reversed(self._cells.head):  # the lowest header counts
            taken = {*self.names.values()}
            for number, cell in enumerate(row, start=1):
                name = name_of(cell)
                if _NAME.fullmatch(name) and name not in taken:
                    self.names.setdefault(number, name)
        self.names = dict(sorted(self.names.items()))

    def _named(self, name: str) -> list[int]:
        """Return the numbers of the columns of a name."""
        return [number for number, known in self.names.items() if known == name]

    def _fault(
        self, column: str, numbers: Sequence[int], names: Sequence[str] = ()
    ) -> SceneError:
        """Return an error that lists the columns, and ends in options to paste.

        Parameters
        ----------
        column : str
            Header or name of which there should be one column.
        numbers : sequence of int
            Columns that have it.
        names : sequence of str
            Names that the options give to columns.
        """
        if numbers:
            words = f"{len(numbers)} columns are {shorten(column)}"
        else:
            near = similar(column, self._cells.headers)
            like = f", near: {', '.join(near)}" if near else ""
            words = f"no column is {shorten(column)}{like}"
        return SceneError(f"{self.path}: {words}: {self._cells.hint(names)}")

    @cached_property
    def si(self) -> bool:
        """Whether a unit is stated, by the file or by the user; values are in SI then."""
        found = map(self._unit, self.names)
        # A number alone is a factor.
        return bool(
            re.search(r"[^-+.\deE ]", "".join((*self._stated.values(), *found)))
        )

    @property
    def notes(self) -> list[str]:
        """Lines on units that the user states otherwise than the file."""
        lines = []
        for number, statement in self._stated.items():
            name = self.names[number]
            _, unit = read_statement(statement, name)
            own = self._unit(number)
            if unit and own and (known(unit) or unit) != (known(own) or own):
                lines.append(f"{name}: {statement} is stated, the file says {own}.")
        return lines

    def rows(self, *names: str) -> Array:
        """Return the record of columns, (rows, columns), in SI if a unit is stated.

        Raises `SceneError`, in one line, for two columns of one name, for a gap in the record, for
        a value beyond the recorder's range, and for a unit of another quantity.
        """
        numbers = [self._named(name) for name in names]
        for name, own in zip(names, numbers, strict=True):
            if len(own) != 1:
                raise self._fault(name, own, names)
        return self._record([number for (number,) in numbers])

    def records(self, of: str = "contact") -> list[Record]:
        """Return the records of all sensors, those of beads first.

        One column "time" is that of all sensors; of several columns the first is that of the first
        sensor, and so on. The velocity of a bead whose force is there is left out.

        Parameters
        ----------
        of : {"contact", "bead"}
            Kind of the sensors whose names do not say it.

        Raises
        ------
        SceneError
            As `rows` does, and for columns of time that are not as many as the sensors.
        """
        times = self._named("time")
        sensors = []
        for number, name in self.names.items():
            force = name.replace("velocity", "force")
            if name.endswith("force") or (name != force and not self._named(force)):
                sensors.append(number)
        if not sensors or len(times) not in (1, len(sensors)):
            missing = ["time"] * (len(times) != 1) + ["force"] * (not sensors)
            raise self._fault(missing[0], self._named(missing[0]), missing)
        pairs = zip(cycle(times), sensors, strict=False)
        records = [self._signal(time, signal, of) for time, signal in pairs]
        return sorted(records, key=lambda record: record.kind)

    def _signal(self, time: int, signal: int, of: str) -> Record:
        """Return the record of a sensor from the columns of its time and signal."""
        name = self.names[signal]
        sensor = _NAME.fullmatch(name)
        assert sensor is not None
        kind, number, quantity = sensor.groups()
        t, values = self._record([time, signal]).T
        given = self._stated.get(signal) or self._unit(signal) or "1"
        turned = f"-{given}".removeprefix("--")
        return Record(
            kind or ("bead" if quantity == "velocity" else of),
            int(number) if number else None,
            quantity,
            t,
            values,
            f"--unit '{self._keys.get(signal, name)}={turned}'",
        )

    def _record(self, numbers: list[int]) -> Array:
        """Return columns, (rows, columns), in the rows where all of them are numbers."""
        columns = self._columns
        names = " and ".join(self.names[number] for number in numbers)
        try:
            start, end = self._cells.rows(
                np.column_stack([columns[number] for number in numbers if number])
            )
        except SceneError as error:
            raise SceneError(f"{self.path}: {names}: {error}") from None
        # The time that a step states starts with the record.
        columns = columns | {0: np.arange(-start, end - start, dtype=float)}
        table = np.column_stack([columns[number][start:end] for number in numbers])
        # In place: long records are large.
        table *= [self._size(number) for number in numbers]
        return table

    @cached_property
    def _columns(self) -> dict[int, Array]:
        """Columns of all lines by number, with NaN where a cell is no number."""
        found = [number for number in self.names if number]
        try:
            table = self._cells.numbers([number - 1 for number in found])
        except (ValueError, csv.Error) as error:
            raise SceneError(f"{self.path}: {shorten(str(error))}") from None
        return dict(zip(found, table.T, strict=True))

    def _unit(self, number: int) -> str:
        """Return the unit that the file states for a column, "" for none."""
        return found_unit(self._cells.above(number))

    def _size(self, number: int) -> float:
        """Return the value in SI of an entry 1 of a column, 1 in a file without units."""
        name = self.names[number]
        if number in self._stated:
            return read_statement(self._stated[number], name)[0]
        return size_of(self._unit(number), name) if self.si else 1.0
