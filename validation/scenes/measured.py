"""Measured files: records of named columns, in the rows where all of them are numbers.

Preambles, rows of units, footers and blank ends are not data; a gap inside a record is refused.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import cycle
from pathlib import Path
from typing import Unpack

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.base.files import reason
from lwa.base.words import similar
from validation.scenes.cells import Cells, name_of
from validation.scenes.checks import SceneError
from validation.scenes.columns import (
    NAME,
    NAMES,
    STEP,
    Column,
    Columns,
    Stated,
    read_time,
)


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
    key : str
        Name or header under which the user states the signal's unit.
    turned : mapping of str
        The user's statements of units, but with the opposite sign in that of ``key``: they turn an
        inverted signal upright.
    """

    kind: str
    number: int | None
    quantity: str
    time: Array
    values: Array
    column: int
    key: str
    turned: Mapping[str, str]


class MeasuredFile(Columns):
    """The named columns of a file."""

    @classmethod
    def read(cls, path: str | Path, **stated: Unpack[Stated]) -> MeasuredFile:
        """Read a file by the statements of the user.

        Parameters
        ----------
        path : str or Path
            Name of the file; "-" is standard input.
        **stated
            Statements of the user, see `validation.scenes.columns.Stated`.

        Raises
        ------
        SceneError
            In one line, for a file that cannot be read or has no such columns, and for statements
            on columns that the file does not have. It proposes statements that make the file
            readable.
        """
        source = str(path)
        # A message names what the user sees.
        if source == "-":
            source = "standard input"
        try:
            cells = Cells.read(path)
        except (OSError, SceneError, csv.Error) as error:
            raise SceneError(f"{source}: {reason(error)}") from None
        step = stated.get("step") or ""
        if step:
            read_time(step, "step", STEP)
        headers: dict[str, str] = {}
        columns = stated.get("columns") or {}
        for given, header in columns.items():
            name = name_of(given)
            if not NAME.fullmatch(name):
                near = similar(name, NAMES) or ["force"]
                raise SceneError(
                    f"column is {shorten(given)}: such as {', '.join(NAMES)} is wanted",
                    columns={**headers, near[0]: header},
                )
            # A step stands in place of a column.
            if name != "time" or not step:
                headers[name] = str(header)
        given_units = stated.get("units") or {}
        units = {key: str(unit) for key, unit in given_units.items()}
        file = cls(source, cells, headers, units, step)
        for name, header in headers.items():
            count = len(cells.headed(header))
            # Each sensor may have a time of its own.
            if count == 0 or name != "time":
                file._demand(header, count, [name])
        # A unit may be stated by a name, or by a header of the file.
        for key in units:
            if name_of(key) not in file.names and not cells.headed(key):
                file._demand(key, 0, [])
        return file

    def _demand(self, header: str, count: int, missing: Sequence[str]) -> None:
        """Refuse a header, or a name, unless one column has it.

        Parameters
        ----------
        header : str
            The header.
        count : int
            Number of columns that have it.
        missing : sequence of str
            Names for which columns are proposed.
        """
        if count == 1:
            return
        words = f"{count} columns are {shorten(header)}"
        if count == 0:
            words = f"no column is {shorten(header)}"
            near = similar(header, self.cells.headers)
            if near:
                words += f", near: {', '.join(near)}"
        raise self.refusal(words, missing)

    @property
    def notes(self) -> list[str]:
        """Lines on units that the user states otherwise than the file."""
        return [column.note for column in self.named if column.note]

    def rows(self, *names: str) -> Array:
        """Return the record of columns, (rows, columns), in SI if a unit is stated.

        Raises `SceneError`, in one line, for two columns of one name, for a gap in the record, for
        a value beyond the recorder's range, and for a unit of another quantity.
        """
        there = self.names
        missing = [name for name in names if there.count(name) != 1]
        for name in missing:
            self._demand(name, there.count(name), missing)
        by_name = {column.name: column for column in self.named}
        columns = [by_name[name] for name in names]
        return self._record(columns)

    def records(
        self, of: str = "contact", wanted: Sequence[str] = ("force",)
    ) -> list[Record]:
        """Return the records of all sensors, those of beads first.

        One column "time" is that of all sensors; of several columns the first is that of the first
        sensor, and so on. A bead with both a force and a velocity has one record, that of its
        force, as both show the same pulses.

        Parameters
        ----------
        of : {"contact", "bead"}
            Kind of the sensors whose names do not say it.
        wanted : sequence of str
            Names that are proposed for columns of a file without sensors.

        Raises
        ------
        SceneError
            For a record that `rows` refuses, and for fewer or more columns of time than sensors.
        """
        names = self.names
        times = []
        sensors = []
        for column in self.named:
            place, _, quantity = column.name.rpartition(" ")
            force = f"{place} force".strip()
            if column.name == "time":
                times.append(column)
            elif quantity == "force" or (quantity == "velocity" and force not in names):
                sensors.append(column)
        # One column of times serves all sensors, or each sensor has a column of its own.
        missing = []
        one_each = len(sensors) or 1
        if len(times) not in (1, one_each):
            missing.append("time")
        if not sensors:
            missing += wanted
        for name in missing:
            self._demand(name, names.count(name), missing)
        records = []
        for time, signal in zip(cycle(times), sensors, strict=False):
            found = self._signal(time, signal, of)
            records.append(found)
        # "bead" before "contact": the order in which `run` writes its sensors.
        return sorted(records, key=lambda record: record.kind)

    def _signal(self, time: Column, signal: Column, of: str) -> Record:
        """Return the record of a sensor from the columns of its time and signal.

        of : the sensor's kind, "bead" or "contact", where the column's name does not say it.
        """
        sensor = NAME.fullmatch(signal.name)
        assert sensor is not None
        assert signal.number is not None
        kind, number, quantity = sensor.groups()
        if quantity == "velocity":
            kind = "bead"  # contacts have none
        t, values = self._record([time, signal]).T
        steps = np.diff(t)
        if np.any(steps <= 0):
            step = ""
            # Times of few digits repeat; those of a second part of the file begin anew.
            if steps.max() > 0:
                step = f"{steps[steps >= 0].mean():.6g}{' s' * self.si}"
            words = "time must increase, --step states it of evenly spaced samples"
            raise self.refusal(words, ["time"], step)
        # The last entry, `Record.turned`: the user's calibration of this signal, "2 N/V" say, with
        # the other sign, "-2 N/V"; without one the file's unit, or the number 1.
        given = signal.stated or signal.unit or "1"
        return Record(
            kind or of,
            int(number) if number else None,
            quantity,
            t,
            values,
            signal.number,
            signal.key,
            {**self.units, signal.key: f"-{given}".removeprefix("--")},
        )

    def _record(self, columns: Sequence[Column]) -> Array:
        """Return columns, (rows, columns), in the rows where all of them are numbers.

        Values are in SI if a unit is stated. A column without a number is the times that a step
        states, ``size`` apart.
        """
        entries = [self._numbers[c.number] for c in columns if c.number is not None]
        # A record needs numbers in all wanted columns; other columns may have gaps.
        table = np.column_stack(entries)
        names = " and ".join(column.name for column in columns)
        gaps = np.isnan(table).any(axis=1)
        if gaps.all():
            known = (None, *self.cells.entries)
            missing = [column.name for column in columns if column.number not in known]
            raise self.refusal(f"no row has numbers in {names}", missing)
        try:
            start, end = self.cells.rows(table)
        except SceneError as error:
            raise SceneError(f"{self.path}: {names}: {error}") from None
        record = []
        for column in columns:
            size: float | None = 1.0
            if self.si or column.stated:
                size = column.size
            if size is None:
                raise self.refusal(column.fault)
            if column.number is None:
                # The times that a step states start with the record.
                values = np.arange(end - start, dtype=float)
            else:
                values = self._numbers[column.number][start:end]
            record.append(size * values)
        return np.column_stack(record)

    @cached_property
    def _numbers(self) -> dict[int, Array]:
        """Named columns by number, an entry for each line, NaN where a cell is no number."""
        numbers = [c.number for c in self.named if c.number is not None]
        return self.cells.columns(numbers)
