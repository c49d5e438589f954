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
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypedDict

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.base.files import reason
from validation.scenes.cells import Cells, longest, runs
from validation.scenes.checks import SceneError
from validation.scenes.units import BASES, in_si, read_statement, same

# Name and unit: "Force (N)", "Force [N]", "Force in N"
_HEADER = re.compile(r"^(.*?) ?(?:[([] ?([^][()\s]*) ?[])]|\bin (\S+))?$")
_SENSOR = re.compile(
    r"(?!contact.*velocity)(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(force|velocity)"
)
_OTHERS = ("time", "displacement", "speed", "force_error", "speed_error")
_FEW = 0.1  # rows of numbers in a preamble, at most, over the rows of the record


class Stated(TypedDict, total=False):
    """Statements of the user about measured files, as keywords.

    columns : headers, with or without their units, or numbers of columns, by the names "time",
        "bead 8 force", "bead 8 velocity", "contact 8 force", "force", "speed", ….
    units : statements (`validation.scenes.units`) by name, header or number of a column.
    step : time from each sample to the next, as a statement, in place of a column.
    """

    columns: Mapping[str, str]
    units: Mapping[str, str]
    step: str | None


@dataclass(frozen=True, eq=False)
class Record:
    """Samples of a signal at a sensor.

    kind : "bead" or "contact". number : of the bead or contact, from 1; None if the file has no
    other sensor and does not say it. quantity : "force" or "velocity". time, values : (S,).
    inverted : option of the command line that changes the signal's sign.
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
    *wanted : str
        Names of columns that must be there; "force" stands for the signal of any sensor.
    columns, units, step
        Statements of the user, see `Stated`.

    Raises
    ------
    SceneError
        In one line, for a file that cannot be read or has no such columns, and for statements on
        columns that the file does not have.
    """

    def __init__(
        self,
        path: str | Path,
        *wanted: str,
        columns: Mapping[str, str] | None = None,
        units: Mapping[str, str] | None = None,
        step: str | None = None,
    ) -> None:
        self.path = "standard input" if str(path) == "-" else path
        self._step = step
        try:
            self._cells = Cells.read(path)
        except (OSError, SceneError, csv.Error) as error:
            raise SceneError(f"{self.path}: {reason(error)}") from None
        self.names: dict[int, str] = {}
        self._name_columns(columns or {})
        kinds = {name.split()[-1] for name in self.names.values()}
        kinds |= {"time"} if self._step else kinds & {"velocity"} and {"force"}
        for name in wanted:
            if name not in kinds:
                raise self._fault(f"no column {name}", *wanted)
        self._given: dict[int, str] = {}
        for key, statement in (units or {}).items():
            places = [i for i, name in self.names.items() if name == _name(key)]
            places = places or self._places(key)
            if not places:
                raise self._fault(f"unit is of {shorten(key)}, which is no column", key)
            self._given |= dict.fromkeys(places, str(statement))

    def _name_columns(self, stated: Mapping[str, str]) -> None:
        """Name the columns that the user states, and those whose headers are such names."""
        for name, column in stated.items():
            if not _is_name(_name(name)):
                known = "time, bead 8 force, bead 8 velocity, contact 8 force, speed"
                raise SceneError(
                    f"column is {shorten(name)}: such as {known} is wanted"
                )
            places = self._places(str(column))
            if len(places) != 1:
                raise self._fault(f"{len(places)} columns are {shorten(column)}", name)
            self.names[places[0]] = _name(name)
        for row in reversed(self._cells.head):  # the lowest header counts
            taken = {*self.names.values()}
            for place, cell in enumerate(row):
                if _is_name(_name(cell)) and _name(cell) not in taken:
                    self.names.setdefault(place, _name(cell))
        self.names = dict(sorted(self.names.items()))

    def _places(self, column: str) -> list[int]:
        """Return the places of the columns of a number or a header, that of the lowest line."""
        if re.fullmatch(r"[1-9]\d{0,5}", column):
            return [int(column) - 1]
        for row in reversed(self._cells.head):
            headers = [(_name(cell), cell.lower()) for cell in row]
            places = [i for i, own in enumerate(headers) if column.lower() in own]
            if places:
                return places
        return []

    def _fault(self, words: str, *names: str) -> SceneError:
        """Return an error that lists the columns, and ends in options that name some of them."""
        paste = " ".join(f"--column '{name}={i}'" for i, name in enumerate(names, 1))
        found = []
        for place, entry in enumerate(self._cells.first):
            above = [row[place] for row in self._cells.head[-2:] if place < len(row)]
            found.append(f"{place + 1} {' '.join(above)[:20]!r} {entry[:12]}")
        listed = ", ".join(found) or "no numbers"
        return SceneError(f"{self.path}: {words}: found {listed}: {paste}")

    @cached_property
    def si(self) -> bool:
        """Whether a unit is stated, by the file or by the user; values are in SI then."""
        stated = " ".join((*self._given.values(), self._step or ""))
        # A number alone is a factor.
        return bool(re.search(r"[^-+.\deE ]", stated)) or any(
            map(self._unit, self.names)
        )

    @property
    def notes(self) -> list[str]:
        """Lines on units that the user states otherwise than the file."""
        lines = []
        for place, statement in self._given.items():
            _, unit = read_statement(statement, self.names[place].split()[-1])
            own = self._unit(place)
            if unit and own and not same(unit, own):
                name = self.names[place]
                lines.append(f"{name}: {statement} is stated, the file says {own}.")
        return lines

    def rows(self, *names: str) -> Array:
        """Return the record of columns, (rows, columns), in SI if a unit is stated.

        Raises `SceneError`, in one line, for two columns of one name, for a gap in the record, for
        a value beyond the recorder's range, and for a unit of another quantity.
        """
        places = []
        for name in names:
            own = [place for place, known in self.names.items() if known == name]
            if name == "time" and self._step:
                continue
            if len(own) != 1:
                raise self._fault(f"{len(own)} columns are {name}", name)
            places += own
        record = self._record(places)
        return self._timed(record) if "time" in names else record

    def records(self, of: str = "contact") -> list[Record]:
        """Return the records of all sensors, those of beads first.

        One column "time" is that of all sensors; of several columns the first is that of the first
        sensor, and so on. The velocity of a bead whose force is there is left out.

        of : kind of the sensors whose names do not say it.

        Raises `SceneError` as `rows` does, for two columns of one sensor, for several sensors of
        which one has no number, and for columns of time that are not as many as the sensors.
        """
        times: list[list[int]] = [[]] if self._step else []
        signals: list[tuple[int, re.Match[str]]] = []
        for place, name in self.names.items():
            sensor = _SENSOR.fullmatch(name)
            if sensor:
                signals.append((place, sensor))
            elif name == "time" and not self._step:
                times.append([place])
        if len(times) not in (1, len(signals)):
            wanted = f"{len(times)} columns time and {len(signals)} of sensors"
            raise self._fault(f"{wanted}: one for all, or one for each, is wanted")
        found: dict[tuple[str, int | None], tuple[str, list[int]]] = {}
        for i, (place, sensor) in enumerate(signals):
            kind, number, quantity = sensor.groups()
            usual = "bead" if quantity == "velocity" else of
            key = (kind or usual, int(number) if number else None)
            other, _ = found.get(key, ("", []))
            if other == quantity:
                raise SceneError(f"{self.path}: two columns are {self.names[place]}")
            if other != "force":
                found[key] = (quantity, [*times[i % len(times)], place])
        if len(found) > 1 and None in [number for _, number in found]:
            raise SceneError(f"{self.path}: each of several sensors needs its number")
        ordered = sorted(found.items(), key=lambda sensor: sensor[0][0])
        return [self._signal(*sensor, *columns) for sensor, columns in ordered]

    def _signal(
        self, kind: str, number: int | None, quantity: str, places: list[int]
    ) -> Record:
        """Return the record of a sensor from the places of its time, if any, and signal."""
        t, values = self._timed(self._record(places)).T
        if np.any(np.diff(t) == 0):
            step = np.ptp(t) / (len(t) - 1)
            raise SceneError(
                f"{self.path}: times repeat, as rounded ones do: --step '{step:.6g} s' states them"
            )
        place = places[-1]
        given = self._given.get(place) or self._unit(place)
        turned = given[1:] if given.startswith("-") else f"-{given}"
        if not re.match(r"-?[\d.]", turned):
            turned = f"-1 {given}"
        option = f"--unit '{self.names[place]}={turned.strip()}'"
        return Record(kind, number, quantity, t, values, option)

    def _timed(self, record: Array) -> Array:
        """Return a record with the times by the user's step, if there is one, in front."""
        if not self._step:
            return record
        step, _ = read_statement(self._step, "time")
        return np.column_stack((step * np.arange(len(record)), record))

    def _record(self, places: list[int]) -> Array:
        """Return columns, (rows, columns), in the rows where all of them are numbers."""
        kept = list(self.names)
        table = self._table[:, [kept.index(place) for place in places]]
        numbers = ~np.isnan(table)
        complete = np.all(numbers, axis=1)
        start, end = longest(complete)
        if not end:
            named = " and ".join(self.names[place] for place in places)
            raise self._fault(f"no row has numbers in {named}", *self.names.values())
        for first, last in runs(complete):
            # A preamble may hold rows of numbers, few, with lines without any behind them.
            gap = slice(last, start) if last <= start else slice(end, first)
            large = last - first > _FEW * (end - start)
            if first != start and (large or numbers[gap].any()):
                line = self._cells.line_number(gap.start)
                raise SceneError(f"{self.path}: line {line} is a gap in the record")
        record = table[start:end]
        beyond = np.flatnonzero(np.isinf(record).any(axis=1))
        if len(beyond):
            line = self._cells.line_number(start + int(beyond[0]))
            raise SceneError(
                f"{self.path}: line {line} holds ∞, the signal is clipped: a larger range of the "
                "recorder is wanted"
            )
        record *= [self._size(place) for place in places]
        return record

    @cached_property
    def _table(self) -> Array:
        """Columns of all lines, with NaN where a cell is no number."""
        try:
            return self._cells.numbers(list(self.names))
        except (ValueError, csv.Error) as error:
            raise SceneError(f"{self.path}: {shorten(str(error))}") from None

    def _unit(self, place: int) -> str:
        """Return the unit that the file states for a column, "" for none."""
        cells = [row[place] for row in reversed(self._cells.head) if place < len(row)]
        for cell in cells:
            header = _HEADER.fullmatch(cell)
            if header and (header[2] or header[3]):
                return str(header[2] or header[3])
        return next(filter(same, cells), "")

    def _size(self, place: int) -> float:
        """Return the value in SI of an entry 1 of a column, 1 in a file without units."""
        name = self.names[place]
        quantity = name.split()[-1]
        if place in self._given:
            return read_statement(self._given[place], quantity)[0]
        unit = self._unit(place)
        size = in_si(unit, BASES[quantity]) if self.si else 1.0
        if size is None:
            says = f"has the unit {shorten(unit)}" if unit else "has no unit"
            base = BASES[quantity]
            raise SceneError(
                f"{self.path}: column {name} {says}: --unit '{name}={base}', or as a calibration "
                f"--unit '{name}=12.5 {base}/{unit or 'V'}'"
            )
        return size


def _name(header: str) -> str:
    """Return a header without its unit as it is compared."""
    return _HEADER.sub(r"\1", header).lower().replace("dynamic ", "").strip("#% ")


def _is_name(name: str) -> bool:
    """Whether a header is the name of a quantity that can be read."""
    return name in _OTHERS or _SENSOR.fullmatch(name) is not None
