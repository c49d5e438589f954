"""Columns of measured files: CSV with a header that names each column and its unit.

The header is the first line that is neither empty nor begins with #. "Force (mN)" or "force [mN]"
names the column "force" and its unit: values are returned in SI. Values of a column without a unit
are returned as they are. A header with a semicolon is separated by semicolons, and numbers below it
may have decimal commas; any other header is separated by commas.
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

TIME: Mapping[str, float] = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "us": 1e-6, "ns": 1e-9}
_FORCE = {"N": 1.0, "mN": 1e-3, "kN": 1e3}
LENGTH: Mapping[str, float] = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "um": 1e-6}
_SPEED = {"m/s": 1.0, "km/s": 1e3, "mm/s": 1e-3}
_UNITS: Mapping[str, Mapping[str, float]] = {
    "time": TIME,
    **dict.fromkeys(("force", "force_error", "force_value"), _FORCE),
    **dict.fromkeys(("displacement", "compression", "compression_value"), LENGTH),
    **dict.fromkeys(("speed", "speed_error", "velocity"), _SPEED),
}  # by the last word of a column's name
LONGEST = 100  # times the simulated time that a record may last
_SENSOR = re.compile(r"(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(dynamic )?force")
_HEADER = re.compile(r"\s*(.*?)\s*(?:\(([^()]*)\)|\[([^][]*)\])?\s*")  # name, (unit) or [unit]


@dataclass(frozen=True, eq=False)
class MeasuredFile:
    """Names, units and texts of the columns of a file; `read` makes one, `column` reads numbers.

    names, units : of the columns, in the order of the file; names in lower case, "" for a column
    without a unit.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    lines: tuple[tuple[int, list[str]], ...]  # number of the line in the file, and its entries
    decimal: str  # the decimal separator

    @classmethod
    def read(cls, path: str | Path, renamed: Mapping[str, str] | None = None) -> MeasuredFile:
        """Read a file. ``renamed``: headers, with or without their unit, by the new names.

        Upper and lower case are alike, but for headers that differ in nothing else.

        Raises `SceneError`, in one line, for a file that cannot be read, and for a header in
        ``renamed`` that the file does not have once.
        """
        try:
            text = files.content(Path(path)).decode("utf-8-sig")
            numbered = list(enumerate(text.splitlines(), start=1))
            while numbered and (not (line := numbered[0][1].strip()) or line.startswith("#")):
                del numbered[0]
            mark = ";" if numbered and ";" in numbered[0][1] else ","
            entries = csv.reader((line for _, line in numbered), delimiter=mark)
            rows = [(n, row) for (n, _), row in zip(numbered, entries, strict=False) if row]
        except UnicodeDecodeError:
            raise SceneError(f"{path}: not a text in UTF-8") from None
        except (OSError, csv.Error, SceneError) as error:
            raise SceneError(f"{path}: {files.reason(error)}") from None
        header = rows[0][1] if rows else []
        names, units = [], []
        for entry in header:
            name, *brackets = _HEADER.fullmatch(" ".join(entry.split())).groups()  # type: ignore[union-attr]
            names.append(name)
            units.append((brackets[0] or brackets[1] or "").strip().replace("μ", "µ"))
        for name, old in (renamed or {}).items():
            known = list(zip(map(str.strip, header), names, strict=True))
            places = [i for i, both in enumerate(known) if old in both]
            # A header in another case will do, unless "t" and "T" are both there.
            alike = [i for i, both in enumerate(known) if old.lower() in map(str.lower, both)]
            places = places or alike
            if len(places) != 1:
                found = shorten(header)
                raise SceneError(f"{path}: one column {old} is wanted, the header has {found}")
            names = ["" if other.lower() == name.lower() else other for other in names]
            names[places[0]] = name
        return cls(
            Path(path),
            tuple(name.lower() for name in names),
            tuple(units),
            tuple(rows[1:]),
            ",."[mark == ","],
        )

    def column(self, name: str) -> Array:
        """Return the values of a column, (N,), in SI if the header names a unit.

        Raises `SceneError`, in one line, unless there is one such column, its unit is one of this
        quantity's, and its entries are finite numbers.
        """
        if self.names.count(name) != 1:
            found = shorten(list(self.names))
            raise SceneError(f"{self.path}: one column {name} is wanted, the header has {found}")
        at = self.names.index(name)
        unit, known = self.units[at], _UNITS.get(name.split()[-1], {"": 1.0})
        if unit and unit not in known:
            wanted = f"one of {', '.join(known)} is wanted"
            raise SceneError(f"{self.path}: column {name} is in {shorten(unit)}: {wanted}")
        values, size = np.empty(len(self.lines)), known.get(unit, 1.0)
        for i, (line, row) in enumerate(self.lines):
            entry = row[at].strip() if at < len(row) else ""
            try:
                values[i] = float(entry.replace(self.decimal, ".")) * size
            except ValueError:
                values[i] = np.nan
            if not np.isfinite(values[i]):
                fault = f"column {name}, line {line}: {shorten(entry)} is no finite number"
                raise SceneError(f"{self.path}: {fault}")
        return values


def columns(
    path: str | Path,
    *wanted: str,
    optional: Sequence[str] = (),
    renamed: Mapping[str, str] | None = None,
) -> dict[str, Array]:
    """Return the wanted columns of a measured file and those optional ones that it has, by name.

    Raises `SceneError` as `MeasuredFile` does, and for new names that none of the columns has.
    """
    refuse_unknown(renamed, (*wanted, *optional))
    file = MeasuredFile.read(path, renamed)
    present = (name for name in optional if name in file.names)
    return {name: file.column(name) for name in (*wanted, *present)}


def refuse_unknown(renamed: Mapping[str, str] | None, known: Sequence[str]) -> None:
    """Refuse a new name of a column that is not among the known ones."""
    for name in renamed or {}:
        if name.lower() not in known:
            raise SceneError(f"column is {shorten(name)}: one of {', '.join(known)} is wanted")


@dataclass(frozen=True)
class SensorColumn:
    """A column with the force of a sensor, such as "bead 15 force"."""

    name: str
    kind: str  # "bead" or "contact"
    number: int | None  # counted from 1; None for the only sensor of a file
    dynamic: bool  # True without the static force


def sensor_columns(file: MeasuredFile, of: str = "contact") -> list[SensorColumn]:
    """Return the columns of sensors, beads first.

    of : kind of the sensors whose names do not say it.

    Raises `SceneError` for two columns of one sensor, and for several of which one has no number.
    """
    named = [(name, match) for name in file.names if (match := _SENSOR.fullmatch(name))]
    sensors = [
        SensorColumn(n, m[1] or of, int(m[2]) if m[2] else None, bool(m[3])) for n, m in named
    ]
    if len(sensors) > 1 and (without := [s.name for s in sensors if s.number is None]):
        raise SceneError(f"{file.path}: {shorten(without[0])} has no number: several are there")
    if len({(sensor.kind, sensor.number) for sensor in sensors}) < len(sensors):
        names = shorten([sensor.name for sensor in sensors])
        raise SceneError(f"{file.path}: two columns of {names} are of one sensor")
    return sorted(sensors, key=lambda sensor: sensor.kind)


def amount(text: str, name: str, units: Mapping[str, float]) -> float:
    """Read a positive number that a unit may follow, such as "4.76 mm", as a number in SI."""
    number, unit = re.fullmatch(r"(.*?)\s*([^\W\d]*)", text.strip()).groups()  # type: ignore[union-attr]
    try:
        value = float(number) * ({"": 1.0} | dict(units))[unit.replace("μ", "µ")]
    except (ValueError, KeyError):
        value = np.nan
    if not 0 < value < np.inf:
        wanted = f"a positive number is wanted, perhaps with one of the units {', '.join(units)}"
        raise SceneError(f"{name} is {shorten(text)}: {wanted}")
    return value


def check_span(path: str | Path, time: Array, duration: float) -> None:
    """Refuse a record that lies outside of the simulated time or lasts `LONGEST` times as long."""
    first, last = (float(time.min()), float(time.max())) if len(time) else (0.0, 0.0)
    if last < 0 or first > duration or last - first >= LONGEST * duration:
        raise SceneError(
            f"{path}: the record lasts from {first:g} to {last:g}, the simulation from 0 to "
            f"{duration:g}: are the units of time alike?"
        )
