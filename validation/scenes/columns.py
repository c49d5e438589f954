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
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

_SECOND = dict.fromkeys(("s", "sec", "second", "seconds"), 1.0)
_UNITS = {
    "time": _SECOND | {"ms": 1e-3, "µs": 1e-6, "us": 1e-6, "ns": 1e-9},
    "displacement": {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "um": 1e-6},
    "force": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "Newton": 1.0},
    "speed": {"m/s": 1.0, "km/s": 1e3, "mm/s": 1e-3},
}  # by the last word of a column's name
_UNITS |= {f"{name}_error": _UNITS[name] for name in ("force", "speed")}
_SENSOR = re.compile(r"(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(?:dynamic )?force")
_HEADER = re.compile(r"^(.*?) ?(?:[([] ?([^][()]*?) ?[])])?$")  # name, (unit) or [unit]
_CALIBRATION = re.compile(
    r"([-+.\deE]+)\s*(\S+)/(\w+)"
)  # number, unit, unit of the file


@dataclass(frozen=True, eq=False)
class MeasuredFile:
    """Names, units and entries of the columns of a file; `read` makes one.

    names : of the columns, in the order of the file; names in lower case. units : of each column,
    by the file and by the user, who may give a calibration; "" for none.
    """

    path: Path
    names: Sequence[str]
    units: Sequence[tuple[str, str]]
    lines: Sequence[
        tuple[int, list[str]]
    ]  # number of the line in the file, and its entries
    decimal: str  # the decimal separator

    @classmethod
    def read(
        cls,
        path: str | Path,
        *wanted: str,
        renamed: Mapping[str, str] | None = None,
        units: Mapping[str, str] | None = None,
    ) -> MeasuredFile:
        """Read a file. Its header is the first line with all wanted columns (the force of any
        sensor is "force") and with all that are renamed.

        renamed : headers as they stand in the file, with or without their unit, by the new names;
        upper and lower case of other names are alike. units : by names, new or old, units
        of columns without one, or calibrations, such as "12.5 N/V".

        Raises `SceneError`, in one line, for a file that cannot be read or has no such header, for
        an unknown new name, and for a unit of a column that the file does not have.
        """
        for name in renamed or {}:
            if name.lower() not in _UNITS and not _SENSOR.fullmatch(name.lower()):
                known = "time, bead 8 force, contact 8 force, speed, displacement"
                raise SceneError(
                    f"column is {shorten(name)}: a name such as {known} is wanted"
                )
        renamed = {name.lower(): header for name, header in (renamed or {}).items()}
        given = {
            name.lower(): unit.replace("μ", "µ") for name, unit in (units or {}).items()
        }
        new = {header: name for name, header in renamed.items()}
        try:
            lines = _text(Path(path)).split("\n")
            for start, line in enumerate(lines, start=1):  # noqa: B007
                mark = next((mark for mark in "\t;" if mark in line), ",")
                header = [
                    " ".join(x.split())
                    for x in next(csv.reader([line], delimiter=mark))
                ]
                old = [_HEADER.sub(r"\1", cell) for cell in header]
                names = []
                for cell, name in zip(header, old, strict=True):
                    other = "" if name.lower() in renamed else name.lower()
                    names.append(new.get(cell, new.get(name, other)))
                if {*wanted} <= {_SENSOR.sub("force", n) for n in names} and {
                    *renamed
                } <= {*names}:
                    break
            else:
                columns = ", ".join((*wanted, *renamed.values()))
                raise SceneError(
                    f"no line names {columns}: --column NAME=HEADER names a column"
                )
            reader = csv.reader(lines[start:], delimiter=mark)
            rows = [
                (start + reader.line_num, row)
                for row in reader
                if any(map(str.strip, row))
            ]
        except (OSError, TypeError, ValueError, csv.Error) as error:
            raise SceneError(f"{path}: {files.reason(error)}") from None
        decimal = "." if mark == "," else ","
        stated = [_HEADER.sub(r"\2", cell) for cell in header]
        if rows and np.isnan([_number(cell, decimal) for cell in rows[0][1]]).all():
            below = [cell.strip(" ()[]") for cell in rows.pop(0)[1]] + [""] * len(names)
            stated = [unit or under for unit, under in zip(stated, below, strict=False)]
        low = [name.lower() for name in old]
        if unknown := [
            name for name in units or {} if name.lower() not in (*names, *low)
        ]:
            wrong = (
                f"unit is of {shorten(unknown[0])}: the header has {shorten(header)}"
            )
            raise SceneError(f"{path}: {wrong}")
        added = [
            given.get(name) or given.get(n, "")
            for name, n in zip(names, low, strict=True)
        ]
        return cls(Path(path), names, [*zip(stated, added, strict=True)], rows, decimal)

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
            wanted = f"one column {name} is wanted (see --column)"
            raise SceneError(
                f"{self.path}: {wanted}, the header has {shorten([*self.names])}"
            )
        return self._values(self.names.index(name))

    def sensors(
        self, of: str = "contact"
    ) -> dict[tuple[str, int | None], tuple[int, int]]:
        """Return the places of time and force in the header, by kind and number of the sensor.

        The kind is "bead" (these come first) or "contact". Numbers count from 1; the only sensor of
        a file may have none. One column "time" is that of all sensors; of several columns the first
        is that of the first force, and so on.

        of : kind of the sensors whose names do not say it.

        Raises `SceneError` for two columns of one sensor, for several sensors of which one has no
        number, and for several columns of time that are not as many as the forces.
        """
        times = [i for i, name in enumerate(self.names) if name == "time"]
        forces = {
            i: m for i, name in enumerate(self.names) if (m := _SENSOR.fullmatch(name))
        }
        if len(times) not in (1, len(forces)):
            found = f"{len(times)} columns time and {len(forces)} of forces"
            raise SceneError(
                f"{self.path}: {found}: one time for all or one for each is wanted"
            )
        sensors = {
            (m[1] or of, int(m[2]) if m[2] else None): (time, force)
            for time, (force, m) in zip(
                times * len(forces), forces.items(), strict=False
            )
        }
        if len(sensors) < len(forces) or (
            len(sensors) > 1 and None in [n for _, n in sensors]
        ):
            names = shorten([self.names[force] for force in forces])
            raise SceneError(
                f"{self.path}: {names}: each sensor is wanted once, with its number"
            )
        return dict(sorted(sensors.items(), key=lambda sensor: sensor[0][0]))

    def record(self, time: int, force: int) -> tuple[Array, Array]:
        """Return times and forces, each (N,), from their places in the header, as `column` does."""
        t, f = self._values(time), self._values(force)
        if len(t) < len(f):
            raise SceneError(
                f"{self.path}: {self.names[force]} has more samples than times"
            )
        return t[: len(f)], f

    def _values(self, at: int) -> Array:
        """Return the values of the column at a place of the header."""
        cells = [
            (line, row[at].strip() if at < len(row) else "") for line, row in self.lines
        ]
        while cells and not cells[-1][1]:
            del cells[-1]
        values = self._size(at) * np.array(
            [_number(cell, self.decimal) for _, cell in cells]
        )
        for i in np.flatnonzero(~np.isfinite(values))[:1]:
            line, cell = cells[i]
            fault = f"column {self.names[at]}, line {line}: {shorten(cell)} is no finite number"
            raise SceneError(f"{self.path}: {fault}")
        return values

    def _size(self, at: int) -> float:
        """Return the number in SI of one unit of a column, 1 in a file without units."""
        if not self.has_units:
            return 1.0
        name, (unit, given) = self.names[at], self.units[at]
        known, match = _UNITS[name.split()[-1]], _CALIBRATION.fullmatch(given)
        number, to, of = (
            match.groups() if match else ("1", given or unit, given or unit)
        )
        size = _number(number, ".") * known.get(to, np.nan)
        if unit not in ("", of) or not np.isfinite(size):
            says = f"the unit {shorten(unit)}" if unit else "no unit"
            says += f" and is given {shorten(given)}" if given else ""
            wanted = f"--unit states one of {', '.join(known)}, or such as 12.5 N/{unit or 'V'}"
            raise SceneError(f"{self.path}: column {name} has {says}: {wanted}")
        return size


def _text(path: Path) -> str:
    """Return the text of a file in UTF-8 or Latin-1, with one of Unicode's two signs for micro."""
    content = files.content(path)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    return text.replace("μ", "µ")


def _number(cell: str, decimal: str) -> float:
    """Return the number in a cell, NaN if it holds none."""
    try:
        return float(cell.replace(decimal, "."))
    except ValueError:
        return np.nan
