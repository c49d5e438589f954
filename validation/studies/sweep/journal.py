"""A sweep's file: one line of JSON a point, there for good as soon as the point is finished.

The first line names the format and the settings, each other one is a
`validation.pulses.steady.Point`:

    {"format": "lwa sweep", "version": 2, "settings": {"stretch": 4}}
    {"k": "3/2", "omega": "1", "sites": [56, 64], "numbers": {"width": [1.41192837, 1.4119284], …}}
    {"k": "3/2", "omega": "1/9", "missing": "the pulse has not passed 80 sites by t = 1e+05"}

A number is followed by the one that its error comes from. A last line without its end, which a
power cut or a full disk leaves, is dropped and its point computed anew; other damage is refused.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from io import FileIO
from pathlib import Path
from typing import Any

import sympy as sp

from lwa.base.exact import InputError, exact, shorten
from lwa.base.files import content, reason
from lwa.base.tables import Reader, Table, array, integer, real, table
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point
from validation.report.files import output_file

SUFFIX = ".jsonl"
FORMAT = {"format": "lwa sweep", "version": 2}  # also of the definitions of what is measured
MOST_BYTES = 10**9  # of the file: twice a million points
Key = tuple[sp.Rational, sp.Rational]  # k and ω


class Journal:
    """The finished points of a sweep, and the file that keeps them, if there is one.

    The file is begun, or freed of its torn end, with the first point that is added.

    Raises `lwa.InputError` for a file that cannot be one, is another sweep's, or is damaged.
    """

    def __init__(self, path: str | Path | None, settings: Mapping[str, int]) -> None:
        self.points: dict[Key, Point] = {}
        self.file = None if path is None else output_file("file", str(path), (SUFFIX,))
        self._header = json.dumps(FORMAT | {"settings": dict(settings)}).encode() + b"\n"
        self._torn: int | None = None
        if self.file is None or not self.file.exists():
            return
        if not os.access(self.file, os.W_OK):
            raise InputError(f"file is {self.file}: one that can be written is wanted")
        try:
            found = content(self.file, MOST_BYTES)
        except (OSError, InputError) as error:
            raise InputError(f"{self.file} is not read: {reason(error)}") from None
        if end := found.rfind(b"\n") + 1:
            self.points = _read(self.file, found[:end], settings)
        elif not self._header.startswith(found):
            raise InputError(f"{self.file} is not a sweep's file: choose another name")
        self._torn = end

    def add(self, point: Point) -> None:
        """Keep a finished point. Raises `lwa.InputError` when the file cannot take it."""
        key = point.k, point.omega
        self.points[key] = point  # first, as a Ctrl-C is heard when the line is on the disk
        if self.file is None:
            return
        try:
            with self.file.open("ab", buffering=0) as stream:
                self._append(stream, _line(point))
        except OSError as error:
            del self.points[key]
            raise InputError(f"{self.file} is not written: {reason(error)}") from None

    def _append(self, stream: FileIO, line: bytes) -> None:
        """The whole line, on the disk, or nothing of it."""
        end = stream.truncate(stream.seek(0, os.SEEK_END) if self._torn is None else self._torn)
        self._torn = None
        line = line if end else self._header + line
        try:
            if stream.write(line) < len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(stream.fileno())
        except OSError:
            stream.truncate(end)
            raise


def _line(point: Point) -> bytes:
    found: dict[str, Any] = {"missing": point.missing}
    if point.missing is None:
        numbers = {name: [n.value, n.check] for name, n in point.numbers.items()}
        found = {"sites": point.sites, "numbers": numbers}
    entry = {"k": str(point.k), "omega": str(point.omega)} | found
    return json.dumps(entry, ensure_ascii=False, allow_nan=False).encode() + b"\n"


def _read(file: Path, content: bytes, settings: Mapping[str, int]) -> dict[Key, Point]:
    first, *lines = content.splitlines()
    _check_header(file, first, settings)
    points: dict[Key, Point] = {}
    for number, line in enumerate(lines, start=2):
        try:
            point = _point(_json(line))
            if points.setdefault((point.k, point.omega), point) != point:
                its = f"k = {point.k}, ω = {point.omega}"
                raise ValueError(f"it holds {its} again, with other numbers")
        except ValueError as error:
            raise InputError(f"{file} is damaged in line {number}: {error}") from None
    return points


def _check_header(file: Path, line: bytes, settings: Mapping[str, int]) -> None:
    header = None
    with suppress(ValueError):
        header = _json(line)
    if not isinstance(header, dict) or header.get("format") != FORMAT["format"]:
        raise InputError(f"{file} is not a sweep's file: choose another name")
    if (version := header.get("version")) != FORMAT["version"]:
        its = f"{file} has version {shorten(version)} of its format"
        raise InputError(f"{its}: {FORMAT['version']} is wanted")
    if (theirs := header.get("settings")) != settings:
        ours = ", ".join(f"{name} = {value}" for name, value in settings.items())
        its = f"{file} is another sweep's, with settings {shorten(theirs)}"
        raise InputError(f"{its}: choose another name for {ours}")


def _json(line: bytes) -> Any:
    try:
        return json.loads(line.decode())
    except (ValueError, RecursionError):  # also of an encoding
        raise ValueError("it is not JSON") from None


def _point(entry: Any) -> Point:
    found = Table(entry, "", ("k", "omega", "sites", "numbers", "missing"))
    k, omega = (found.read(name, rational) for name in ("k", "omega"))
    if "missing" in found:
        return Point(k, omega, None, {}, found.read("missing", _text))
    given = found.read("numbers", table(tuple(QUANTITIES)))
    numbers = {name: Measured(*given.read(name, _two(real))) for name in QUANTITIES}
    return Point(k, omega, found.read("sites", _two(partial(integer, least=0))), numbers)


def rational(value: Any, name: str) -> sp.Rational:
    """Read a rational number; raises `lwa.InputError` for anything else."""
    if not (number := exact(value, name)).is_Rational:
        wanted = "an integer, a decimal or a fraction is wanted"
        raise InputError(f"{name} is {shorten(value)}: {wanted}")
    return number


def _text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name} is {shorten(value)}: a text is wanted")
    return value


def _two(reader: Reader) -> Reader:
    """Reader of a list of two."""

    def read(value: Any, name: str) -> tuple[Any, ...]:
        if len(array(value, name)) != 2:
            raise InputError(f"{name} is {shorten(value)}: two numbers are wanted")
        return tuple(reader(item, name) for item in value)

    return read
