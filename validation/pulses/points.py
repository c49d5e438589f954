"""A file of measured points (k, ω) of a sweep; each finished point appends a line.

The first line holds the format and the settings, every other line a point:

    {"k": "3/2", "omega": "1", "sites": [56, 64], "numbers": {"width": [1.41192837, 1.4119], …}}
    {"k": "3/2", "omega": "1/9", "missing": "not steady: the pulse has not passed 320 sites …"}

A number is followed by the less accurate number that gives its error.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout
from sympy import Rational

from lwa.base.exact import InputError, exact
from lwa.base.files import content
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point

Key = tuple[Rational, Rational]  # k and ω of a point

_MOST_BYTES = 10**9
_FORMAT = {"format": "lwa sweep", "version": 3}  # changes with the definition of a quantity


@dataclass(frozen=True)
class PointFile:
    """A file of points measured with the same ``stretch`` (`validation.pulses.steady.point`)."""

    path: Path
    stretch: int

    @property
    def header(self) -> bytes:
        """The file's first line, with the format and the settings."""
        return _line(_FORMAT | {"settings": {"stretch": self.stretch}})

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other processes away from the file; raises `lwa.InputError` if one has it."""
        lock = FileLock(f"{self.path}.lock", blocking=False)
        try:
            lock.acquire()
        except Timeout:
            raise InputError(f"file is {self.path}: another sweep writes it") from None
        with lock:
            try:
                yield
            finally:
                Path(lock.lock_file).unlink()

    def read(self) -> dict[Key, Point]:
        """Read all points. A torn last line is dropped.

        Raises `lwa.InputError` for another sweep's file, or one that is damaged.
        """
        text = content(self.path, _MOST_BYTES) if self.path.exists() else b""
        if not self.header.startswith(text) and not text.startswith(self.header):
            wanted = self.header.decode().strip()
            raise InputError(f"{self.path} does not begin with {wanted}: choose another name")
        end, points = text.rfind(b"\n") + 1, dict[Key, Point]()
        for number, line in enumerate(text[:end].splitlines()[1:], start=2):
            try:
                point = _point(**json.loads(line))
            except (ValueError, TypeError, KeyError, RecursionError):
                raise InputError(f"{self.path} is damaged in line {number}") from None
            points[point.k, point.omega] = point
        if end < len(text):
            os.truncate(self.path, end)
        return points

    def append(self, point: Point) -> None:
        """Append a point, and return when the point is on the disk."""
        numbers = {name: [n.value, n.check] for name, n in point.numbers.items()}
        measured = {"sites": point.sites, "numbers": numbers}
        rest = {"missing": point.missing} if point.missing else measured
        line = _line({"k": str(point.k), "omega": str(point.omega)} | rest)
        with self.path.open("ab") as stream:
            stream.write(line if stream.tell() else self.header + line)
            stream.flush()
            os.fsync(stream.fileno())


def _line(entry: dict[str, Any]) -> bytes:
    return json.dumps(entry, ensure_ascii=False, allow_nan=False).encode() + b"\n"


def _point(k: str, omega: str, sites: Any = None, numbers: Any = (), missing: Any = None) -> Point:
    pairs = {name: Measured(*map(float, numbers[name])) for name in QUANTITIES if numbers}
    return Point(exact(k, "k"), exact(omega, "omega"), sites and (*sites,), pairs, missing)
