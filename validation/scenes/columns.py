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
from functools import cached_property, partial
from itertools import cycle
from pathlib import Path
from typing import TypedDict, Unpack

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.base.files import reason
from lwa.base.words import similar
from validation.scenes.cells import Cells, longest
from validation.scenes.checks import SceneError
from validation.scenes.units import (
    BASES,
    found_unit,
    in_si,
    known,
    name_of,
    read_statement,
)

_NAME = re.compile(
    "time|displacement|speed|force_error|speed_error"
    r"|(?!contact.*velocity)(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(force|velocity)"
)
_NAMES = ("time", "bead 8 force", "bead 8 velocity", "contact 8 force", "speed")
_STEP = "1 us"  # an example: a usual step of recorders
_OF_STEP = "--step"  # key of the unit of the times that a step states


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
    column : int
        Number of the signal's column in its file, from 1.
    key, inverted : str
        Name or header under which the user states the signal's unit, and the statement that
        changes the signal's sign.
    """

    kind: str
    number: int | None
    quantity: str
    time: Array
    values: Array
    column: int
    key: str
    inverted: str


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
        """A statement of its unit that is valid."""
        if self.number is None:
            return _STEP
        if not self.unit:
            return self.base
        if in_si(self.unit, self.base) is None:
            return f"1 {self.base}/{self.unit}"
        return self.unit

    @property
    def fault(self) -> str:
        """Words on a unit that is missing or of another quantity."""
        base = self.base
        if self.number is None:
            return f"step is {shorten(self.stated)}: a time such as {_STEP} is wanted"
        if self.stated:
            return (
                f"unit of {self.name} is {shorten(self.stated)}: such as {base}, m{base}, "
                f"0.04 {base} or 12.5 {base}/V is wanted"
            )
        if not self.unit:
            return f"column {self.name} has no unit"
        return (
            f"column {self.name} has the unit {shorten(self.unit)}: a calibration such as "
            f"12.5 {base}/{self.unit} is wanted"
        )


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
    columns : list of Column
        The columns that have names, in their order.

    Raises
    ------
    SceneError
        In one line, for a file that cannot be read or has no such columns, and for statements on
        columns that the file does not have. It proposes statements that make the file readable.
    """

    def __init__(self, path: str | Path, **stated: Unpack[Stated]) -> None:
        self.path = "standard input" if str(path) == "-" else path
        try:
            self._cells = Cells.read(path)
        except (OSError, SceneError, csv.Error) as error:
            raise SceneError(f"{self.path}: {reason(error)}") from None
        self._step = stated.get("step") or ""
        self._units = {
            key: str(unit) for key, unit in (stated.get("units") or {}).items()
        }
        self._headers: dict[str, str] = {}  # or numbers of columns, by their names
        for given, header in (stated.get("columns") or {}).items():
            name = name_of(given)
            if not _NAME.fullmatch(name):
                near = similar(name, _NAMES) or ["force"]
                raise SceneError(
                    f"column is {shorten(given)}: such as {', '.join(_NAMES)} is wanted",
                    columns={**self._headers, near[0]: header},
                )
            # A step stands in place of a column.
            if name != "time" or not self._step:
                self._headers[name] = str(header)
        for name, header in self._headers.items():
            count = len(self._cells.headed(header))
            if count != 1:
                raise self._refusal(self._words(header, count), [name])
        self.columns = self._named(self._headers, self._step)
        for key in self._units:
            if not (self._has(name_of(key)) or self._cells.headed(key)):
                raise self._refusal(self._words(key, 0), [])

    def _named(self, headers: Mapping[str, str], step: str) -> list[Column]:
        """Return the columns that have names, by the user's headers and by their own."""
        names = {}
        for name, header in headers.items():
            numbers = self._cells.headed(header)
            if len(numbers) == 1:
                names[numbers[0]] = name
        columns = [Column("time", None, "", _OF_STEP, step)] if step else []
        taken = {*names.values(), *(column.name for column in columns)}
        for row in reversed(self._cells.head):  # the lowest header counts
            found = {}
            for number, cell in enumerate(row, start=1):
                name = name_of(cell)
                if _NAME.fullmatch(name) and name not in taken:
                    found[number] = name
            names = found | names
            taken |= {*found.values()}
        for number, name in sorted(names.items()):
            key = name
            for given in self._units:
                own = name_of(given)
                if own == name or (
                    own not in taken and number in self._cells.headed(given)
                ):
                    key = given
            unit = found_unit(self._cells.above(number))
            columns.append(Column(name, number, unit, key, self._units.get(key, "")))
        return columns

    def _has(self, name: str) -> int:
        """Return the number of columns of a name."""
        return sum(column.name == name for column in self.columns)

    def _words(self, header: str, count: int) -> str:
        """Return words on a header, or a name, that none or several columns have."""
        if count:
            return f"{count} columns are {shorten(header)}"
        near = similar(header, self._cells.headers)
        like = f", near: {', '.join(near)}" if near else ""
        return f"no column is {shorten(header)}{like}"

    def _refusal(
        self, words: str, missing: Sequence[str], step: str = ""
    ) -> SceneError:
        """Return an error that lists the columns and proposes statements.

        Parameters
        ----------
        words : str
            What is wrong.
        missing : sequence of str
            Names for which columns are to be proposed.
        step : str
            Time from sample to sample that is proposed in place of a column.
        """
        headers = {n: header for n, header in self._headers.items() if n not in missing}
        used = set()
        for column in self._named(headers, self._step):
            if column.name not in missing:
                used.add(column.number)
        free = [number for number in self._cells.entries if number not in used]
        if "time" in missing:
            for number in [number for number in free if self._rises(number)][:1]:
                free.remove(number)
                if not (step or self._counts(number)):
                    headers["time"] = str(number)
            if "time" not in headers:
                step = step or _STEP
        for name in missing:
            if name != "time" and free:
                base = BASES[name.split()[-1]]
                number = min(free, key=partial(self._fit, base=base))
                free.remove(number)
                headers[name] = str(number)
        columns = self._named(headers, step or self._step)
        units = {column.key: column.stated for column in columns if column.stated}
        for column in columns:
            if column.size is None and _has_units(columns):
                units[column.key] = column.proposed
        change: dict[str, object] = {}
        if headers or self._headers:
            change["columns"] = headers
        if step or self._step:
            # The unit of the times that a step states is its own.
            change["step"] = units.pop(_OF_STEP)
        if units or self._units:
            change["units"] = units
        listed = self._cells.listed
        return SceneError(f"{self.path}: {words}: found {listed}", **change)

    def _unit(self, number: int) -> str:
        """Return the unit that the file states for a column, "" for none."""
        return found_unit(self._cells.above(number))

    @cached_property
    def _steps(self) -> dict[int, Array]:
        """Differences from line to line, at the beginning, of the columns of numbers."""
        numbers = [*self._cells.entries]
        steps = {}
        table = self._read(self._cells.beginning(), numbers)
        for number, column in zip(numbers, table.T, strict=True):
            start, end = longest(np.isfinite(column))
            steps[number] = np.diff(column[start:end])
        return steps

    def _rises(self, number: int) -> bool:
        """Whether a column rises, as times do."""
        steps = self._steps[number]
        return len(steps) == 0 or steps.min() >= 0 < steps.max()

    def _counts(self, number: int) -> bool:
        """Whether a column without a unit of time counts its lines."""
        steps = self._steps[number]
        counts = len(steps) > 0 and bool(np.all(steps == 1))
        return counts and in_si(self._unit(number), "s") is None

    def _fit(self, number: int, base: str) -> int:
        """Rank of a column among those for a signal in a unit, the least for the best."""
        if in_si(self._unit(number), base) is not None:
            return 0
        # Numbers of lines, and constants, are no signals.
        return 1 if len(np.unique(self._steps[number])) > 1 else 2

    @property
    def names(self) -> list[str]:
        """Names of the columns, in their order."""
        return [column.name for column in self.columns]

    @property
    def si(self) -> bool:
        """Whether a unit is stated, by the file or by the user; values are in SI then."""
        return _has_units(self.columns)

    @property
    def notes(self) -> list[str]:
        """Lines on units that the user states otherwise than the file."""
        lines = []
        for column in self.columns:
            statement = read_statement(column.stated, column.base)
            unit = statement[1] if statement and column.stated else ""
            own = column.unit
            if unit and own and (known(unit) or unit) != (known(own) or own):
                lines.append(
                    f"{column.name}: {column.stated} is stated, the file says {own}."
                )
        return lines

    def rows(self, *names: str) -> Array:
        """Return the record of columns, (rows, columns), in SI if a unit is stated.

        Raises `SceneError`, in one line, for two columns of one name, for a gap in the record, for
        a value beyond the recorder's range, and for a unit of another quantity.
        """
        missing = [name for name in names if self.names.count(name) != 1]
        for name in missing[:1]:
            raise self._refusal(self._words(name, self.names.count(name)), missing)
        by_name = {column.name: column for column in self.columns}
        return self._record([by_name[name] for name in names])

    def records(
        self, of: str = "contact", wanted: Sequence[str] = ("force",)
    ) -> list[Record]:
        """Return the records of all sensors, those of beads first.

        One column "time" is that of all sensors; of several columns the first is that of the first
        sensor, and so on. The velocity of a bead whose force is there is left out.

        Parameters
        ----------
        of : {"contact", "bead"}
            Kind of the sensors whose names do not say it.
        wanted : sequence of str
            Names that are proposed for columns of a file without sensors.

        Raises
        ------
        SceneError
            As `rows` does, for columns of time that are not as many as the sensors, and for one of
            several sensors without a number.
        """
        times = []
        sensors = []
        for column in self.columns:
            force = column.name.replace("velocity", "force")
            if column.name == "time":
                times.append(column)
            elif column.name.endswith("force") or (
                column.name != force and force not in self.names
            ):
                sensors.append(column)
        missing = []
        if len(times) not in (1, len(sensors) or 1):
            missing.append("time")
        if not sensors:
            missing += wanted
        for name in missing[:1]:
            raise self._refusal(self._words(name, self.names.count(name)), missing)
        records = []
        for time, signal in zip(cycle(times), sensors, strict=False):
            records.append(self._signal(time, signal, of))
        if len(records) > 1 and None in [record.number for record in records]:
            headers = dict(self._headers)
            for number, column in enumerate(sensors, start=1):
                headers.pop(column.name, None)
                place, _, quantity = column.name.rpartition(" ")
                kind = place.rstrip(" 0123456789")
                headers[f"{kind} {number} {quantity}".strip()] = str(column.number)
            raise SceneError(
                f"{self.path}: each of several sensors needs its number",
                columns=headers,
            )
        return sorted(records, key=lambda record: record.kind)

    def _signal(self, time: Column, signal: Column, of: str) -> Record:
        """Return the record of a sensor from the columns of its time and signal."""
        sensor = _NAME.fullmatch(signal.name)
        assert sensor is not None
        assert signal.number is not None
        kind, number, quantity = sensor.groups()
        t, values = self._record([time, signal]).T
        if len(t) > 1 and np.diff(t).min() <= 0:
            step = f"{np.ptp(t) / (len(t) - 1):.6g}{' s' * self.si}"
            words = "time must increase, --step states it of evenly spaced samples"
            raise self._refusal(words, ["time"], step)
        given = signal.stated or signal.unit or "1"
        return Record(
            kind or ("bead" if quantity == "velocity" else of),
            int(number) if number else None,
            quantity,
            t,
            values,
            signal.number,
            signal.key,
            f"-{given}".removeprefix("--"),
        )

    def _record(self, columns: Sequence[Column]) -> Array:
        """Return columns, (rows, columns), in the rows where all of them are numbers."""
        in_file = {c.number: self._numbers[c.number] for c in columns if c.number}
        table = np.column_stack([*in_file.values()])
        names = " and ".join(column.name for column in columns)
        if np.isnan(table).any(axis=1).all():
            missing = []
            for column in columns:
                if column.number not in (None, *self._cells.entries):
                    missing.append(column.name)
            raise self._refusal(f"no row has numbers in {names}", missing)
        try:
            start, end = self._cells.rows(table)
        except SceneError as error:
            raise SceneError(f"{self.path}: {names}: {error}") from None
        record = np.empty((end - start, len(columns)))
        for place, column in enumerate(columns):
            size = column.size if self.si or column.stated else 1.0
            if size is None:
                raise self._refusal(column.fault, [])
            if column.number is None:
                # The times that a step states start with the record.
                record[:, place] = np.arange(end - start)
            else:
                record[:, place] = in_file[column.number][start:end]
            record[:, place] *= size
        return record

    @cached_property
    def _numbers(self) -> dict[int, Array]:
        """Columns of all lines by number, with NaN where a cell is no number."""
        found = [column.number for column in self.columns if column.number]
        table = self._read(self._cells, found)
        return dict(zip(found, table.T, strict=True))

    def _read(self, cells: Cells, numbers: Sequence[int]) -> Array:
        """Return columns of cells, (lines, columns), by their numbers."""
        try:
            return cells.numbers([number - 1 for number in numbers])
        except (ValueError, csv.Error) as error:
            raise SceneError(f"{self.path}: {shorten(str(error))}") from None


def _has_units(columns: Sequence[Column]) -> bool:
    """Whether a column has a unit; a number alone is a factor."""
    texts = [column.stated or column.unit for column in columns]
    return bool(re.search(r"[^-+.\deE ]", "".join(texts)))
