"""Columns of measured files, each with its unit.

A file is text in UTF-8 or Latin-1, as oscilloscopes write it. The header is the first line that
names the wanted columns, and the lines before the header are skipped. A header with a tab is
separated by tabs, another one with a semicolon by semicolons, any other by commas; with tabs or
semicolons numbers may have decimal commas. Blank entries end a column.

Units are stated, never guessed: in the header, as in "Force (mN)" or "force [mN]"; in a row without
numbers under the header; or by the user, who may also give a calibration per unit of the file, as
in "12.5 N/V". Values are returned in SI. A file in which no unit is stated at all is
in the scene's own numbers; if one unit is stated, every column that is used needs one.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

_TIME = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
    **{"ms": 1e-3, "µs": 1e-6, "us": 1e-6, "ns": 1e-9},
}
_LENGTH = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "um": 1e-6}
_FORCE = {"N": 1.0, "mN": 1e-3, "kN": 1e3, "Newton": 1.0}
_SPEED = {"m/s": 1.0, "km/s": 1e3, "mm/s": 1e-3}
_UNITS: Mapping[str, Mapping[str, float]] = {
    **{"time": _TIME, "displacement": _LENGTH, "force": _FORCE, "force_error": _FORCE},
    **{"speed": _SPEED, "speed_error": _SPEED},
}  # by the last word of a column's name
LONGEST = 100  # times the simulated time that a record may last
_NAME = re.compile(r"(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(?:dynamic )?(\w+)")  # of a column
_HEADER = re.compile(r"(.*?) ?(?:[([] ?([^][()]*?) ?[])])?")  # name, (unit) or [unit]
_CALIBRATION = re.compile(r"([-+.\deE]+)\s*(\S+)/(\w+)")  # number, unit, unit of the file


@dataclass(frozen=True, eq=False)
class MeasuredFile:
    """Names, units and entries of the columns of a file; `read` makes one.

    names : of the columns, in the order of the file; names in lower case. units : of each column,
    by the file and by the user, who may give a calibration; "" for none.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[tuple[str, str], ...]
    lines: tuple[tuple[int, list[str]], ...]  # number of the line in the file, and its entries
    decimal: str  # the decimal separator

    @classmethod
    def read(
        cls,
        path: str | Path,
        *wanted: str,
        renamed: Mapping[str, str] | None = None,
        units: Mapping[str, str] | None = None,
    ) -> MeasuredFile:
        """Read a file. Its header is the first line with columns of the wanted quantities (the last
        words of their names) and with all that are renamed.

        renamed : headers as they stand in the file, with or without their unit, by the new names;
        upper and lower case of other names are alike. units : by names, new or old, units
        of columns without one, or calibrations, such as "12.5 N/V".

        Raises `SceneError`, in one line, for a file that cannot be read or has no such header, for
        an unknown new name, and for a unit of a column that the file does not have.
        """
        for name in renamed or {}:
            if not (match := _NAME.fullmatch(name.lower())) or match[3] not in _UNITS:
                known = "time, bead 8 force, contact 8 force, speed, displacement"
                raise SceneError(f"column is {shorten(name)}: a name such as {known} is wanted")
        renamed = {name.lower(): header for name, header in (renamed or {}).items()}
        new = {header: name for name, header in renamed.items()}
        given = {
            name.lower(): unit.replace("μ", "µ").strip() for name, unit in (units or {}).items()
        }
        try:
            content = files.content(Path(path))
            try:
                text = content.decode("utf-8-sig")
            except UnicodeDecodeError:
                text = content.decode("latin-1")
            lines = text.replace("μ", "µ").split("\n")
            for start, line in enumerate(lines, start=1):  # noqa: B007
                mark = next((mark for mark in "\t;" if mark in line), ",")
                cells = next(csv.reader([line], delimiter=mark))
                header = [" ".join(cell.split()) for cell in cells]
                parts = [_HEADER.fullmatch(cell).groups("") for cell in header]  # type: ignore[union-attr]
                names = []
                for cell, (name, _) in zip(header, parts, strict=True):
                    other = "" if name.lower() in renamed else name.lower()
                    names.append(new.get(cell, new.get(name, other)))
                if {*wanted} <= {name.split(" ")[-1] for name in names} and {*renamed} <= {*names}:
                    break
            else:
                columns = ", ".join((*wanted, *renamed.values()))
                raise SceneError(f"no line names {columns}: --column NAME=HEADER names a column")
            reader = csv.reader(lines[start:], delimiter=mark)
            rows = [(start + reader.line_num, row) for row in reader if any(map(str.strip, row))]
        except (OSError, csv.Error, SceneError) as error:
            raise SceneError(f"{path}: {files.reason(error)}") from None
        decimal = "." if mark == "," else ","
        stated = [unit for _, unit in parts]
        if rows and np.isnan([_number(cell, decimal) for cell in rows[0][1]]).all():
            below = [cell.strip(" ()[]") for cell in rows.pop(0)[1]] + [""] * len(names)
            stated = [unit or under for unit, under in zip(stated, below, strict=False)]
        old = [name.lower() for name, _ in parts]
        if unknown := [name for name in units or {} if name.lower() not in (*names, *old)]:
            wrong = f"unit is of {shorten(unknown[0])}: the header has {shorten(header)}"
            raise SceneError(f"{path}: {wrong}")
        added = [given.get(name) or given.get(o, "") for name, o in zip(names, old, strict=True)]
        both = zip(stated, added, strict=True)
        return cls(Path(path), tuple(names), tuple(both), tuple(rows), decimal)

    @property
    def has_units(self) -> bool:
        """Whether a unit is stated, by the file or by the user; values are in SI then."""
        return any(map(any, self.units))

    def column(self, name: str) -> Array:
        """Return the values of a column, (N,), in SI if the file has units.

        Raises `SceneError`, in one line, unless there is one such column, its unit is one of this
        quantity's, and its entries are finite numbers.
        """
        if self.names.count(name) != 1:
            found = shorten(list(self.names))
            raise SceneError(
                f"{self.path}: one column {name} is wanted (see --column), the header has {found}"
            )
        return self._values(self.names.index(name))

    def record(self, sensor: SensorColumn) -> tuple[Array, Array]:
        """Return the times and the forces of a sensor, each (N,), as `column` does.

        The times of "bead 8 force" are those of the column "bead 8 time"; else those of the nearest
        column "time" on the left, or of the only one.
        """
        own = sensor.name.replace("dynamic ", "").replace("force", "time")
        times = [i for i, name in enumerate(self.names) if name == "time"]
        places = [i for i, name in enumerate(self.names) if name == own != "time"]
        places = places or [i for i in times if i < sensor.place or len(times) == 1]
        if not places:
            raise SceneError(f"{self.path}: {sensor.name} has no column {own} or time on its left")
        time, force = self._values(places[-1]), self._values(sensor.place)
        if len(time) < len(force):
            raise SceneError(f"{self.path}: {sensor.name} has more samples than times")
        return time[: len(force)], force

    def _values(self, at: int) -> Array:
        """Return the values of the column at a place of the header."""
        cells = [(line, row[at].strip() if at < len(row) else "") for line, row in self.lines]
        while cells and not cells[-1][1]:
            del cells[-1]
        values = self._size(at) * np.array([_number(cell, self.decimal) for _, cell in cells])
        for (line, cell), value in zip(cells, values, strict=True):
            if not np.isfinite(value):
                fault = f"column {self.names[at]}, line {line}: {shorten(cell)} is no finite number"
                raise SceneError(f"{self.path}: {fault}")
        return values

    def _size(self, at: int) -> float:
        """Return the number in SI of one unit of a column, 1 in a file without units."""
        if not self.has_units:
            return 1.0
        name, (unit, given) = self.names[at], self.units[at]
        known, match = _UNITS[name.split()[-1]], _CALIBRATION.fullmatch(given)
        number, to, of = match.groups() if match else ("1", *2 * (given or unit,))
        if unit in ("", of):
            with suppress(KeyError, ValueError):
                return float(number) * known[to]
        says = f"the unit {shorten(unit)}" if unit else "no unit"
        says += f" and is given {shorten(given)}" if given else ""
        raise SceneError(
            f"{self.path}: column {name} has {says}: one of {', '.join(known)} is wanted, or a "
            f"calibration such as --unit 'CH1=12.5 N/{unit or 'V'}'"
        )


def _number(cell: str, decimal: str) -> float:
    """Return the number in a cell, NaN if it holds none."""
    try:
        return float(cell.replace(decimal, "."))
    except ValueError:
        return np.nan


@dataclass(frozen=True)
class SensorColumn:
    """A column with the force of a sensor, such as "bead 15 force"."""

    name: str
    place: int  # in the header
    kind: str  # "bead" or "contact"
    number: int | None  # counted from 1; None for the only sensor of a file


def sensor_columns(file: MeasuredFile, of: str = "contact") -> list[SensorColumn]:
    """Return the columns of sensors, beads first.

    of : kind of the sensors whose names do not say it.

    Raises `SceneError` for two columns of one sensor, and for several of which one has no number.
    """
    sensors = [
        SensorColumn(name, place, m[1] or of, int(m[2]) if m[2] else None)
        for place, name in enumerate(file.names)
        if (m := _NAME.fullmatch(name)) and m[3] == "force"
    ]
    if len(sensors) > 1 and (without := [s.name for s in sensors if s.number is None]):
        raise SceneError(f"{file.path}: {shorten(without[0])} has no number: several are there")
    if len({(sensor.kind, sensor.number) for sensor in sensors}) < len(sensors):
        names = shorten([sensor.name for sensor in sensors])
        raise SceneError(f"{file.path}: two columns of {names} are of one sensor")
    return sorted(sensors, key=lambda sensor: sensor.kind)


def check_span(path: str | Path, time: Array, duration: float) -> None:
    """Refuse a record that lies outside of the simulated time or lasts `LONGEST` times as long."""
    first, last = (float(time.min()), float(time.max())) if len(time) else (0.0, 0.0)
    if last < 0 or first > duration or last - first >= LONGEST * duration:
        raise SceneError(
            f"{path}: the record lasts from {first:g} to {last:g}, the simulation from 0 to "
            f"{duration:g}: are the units of time alike?"
        )
