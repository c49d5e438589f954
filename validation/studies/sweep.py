"""Width, speed and decay of a dimer chain's steady pulse over k and ω, beside the theory.

Each point of the grid is one struck chain (`validation.pulses.steady`) and enters the sweep's file
as soon as the point is finished. An interrupted sweep continues from its file, and a larger sweep
with the same file computes only its new points. The theory's numbers belong to the compact wave
with contact force 1 at its peak, in the paper's closure and for the full closure's canonical field.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, as_completed
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from filelock import FileLock, Timeout
from sympy import Rational

from lwa import Dimer, canonical_wave, homogenize
from lwa.base.arrays import Array
from lwa.base.exact import InputError, exact, shorten
from lwa.base.files import content
from lwa.base.progress import Progress
from validation.lattice.threads import cluster, threads
from validation.pictures.panel import Curve, Map, Panel
from validation.pulses.pulse import Measured
from validation.pulses.steady import HUMPS, QUANTITIES, STRETCH, Point, point
from validation.report.command import option, study, whole
from validation.report.files import output_file
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.report.text import percent
from validation.scenes.checks import Failure, SceneError, integer, items

RANGES = {"k": (Rational(21, 20), Rational(6)), "omega": (Rational(1, 100), Rational(100))}
"""Exponents and mass ratios at which a run of some seconds is enough."""

CLOSURES = {"linear": "paper's closure", "canonical": "full closure, canonical field"}
"""Theories beside the lattice, with their labels."""

Key = tuple[Rational, Rational]  # k and ω of a point

_MOST, _MOST_BYTES = 300, 10**9  # values of an axis; of the file
_FORMAT = {"format": "lwa sweep", "version": 3}  # changes with the definition of a quantity
_OMEGA = "ω = m2/m1"
_NOTE = """\
Width: FWHM of a contact's force, in sites. Speed: sites over time at contact force 1, with A = D =
m1 = 1. Decay: of the logarithm of the peak force. Sites: places of the measurement, from the struck
bead. ±: the largest change over a stretch, from a less accurate run, or twice that to 40 stretches.
Not steady: by then a higher pulse has overtaken or follows. linear, canonical: theory/lattice - 1
for the paper's closure and for the full closure's canonical field."""
_HUMPED = Rational(1, 5), Rational(7, 10)  # m2/m1 between which the force has several humps
_BEYOND = f"""\
{HUMPS}
(at k = 3/2 it is 2.42 sites at m2/m1 = 0.45, and 1.43 at 0.75). The theory has one hump: from
m2/m1 = {float(_HUMPED[0])} to {float(_HUMPED[1])} a width is no measure of its error."""


class SweepError(Failure):
    """A worker failed, or is gone. Finished points are kept."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """Points for each k (outer) and ω (inner), both in rising order, beside the theories.

    theory: closure → width, strain_width and speed, each (len(ks), len(omegas)); NaN where the
        theory has no wave.
    """

    ks: tuple[Rational, ...]
    omegas: tuple[Rational, ...]
    stretch: int
    points: tuple[Point, ...]
    theory: Mapping[str, Mapping[str, Array]]

    def map(self, quantity: str, part: str = "value") -> Array:
        """A quantity, or its ``part`` "error": (len(ks), len(omegas)), NaN where missing."""
        values = [getattr(p.numbers.get(quantity), part, np.nan) for p in self.points]
        return np.array(values).reshape(len(self.ks), len(self.omegas))

    def error(self, closure: str, quantity: str) -> Array:
        """Theory over lattice, less 1: (len(ks), len(omegas)), NaN where either is missing."""
        return np.asarray(self.theory[closure][quantity] / self.map(quantity) - 1)

    def report(self) -> Report:
        """Table ``points`` (missing values with their reason), and maps over ω and k, or curves."""
        points = self.points
        told = [f"k = {p.k}, ω = {p.omega}: {p.missing}" for p in points if p.missing is not None]
        cells: list[tuple[Column, Iterable[Any]]] = [
            (Column("k"), [p.k for p in points]),
            (Column("omega", _OMEGA), [p.omega for p in points]),
        ]
        numbers = {name: [p.numbers.get(name) for p in points] for name in QUANTITIES}
        for name in ("width", "speed"):
            cells.append((Column(name, name, format=str, error=True), numbers[name]))
            for closure in CLOSURES:
                errors = [None if np.isnan(x) else x for x in self.error(closure, name).flat]
                cells.append((Column("", closure, format=percent), errors))
        cells += [
            (Column("decay", "decay per site", format=".2e", error=True), numbers["decay"]),
            (Column("sites", "sites", format="{0[0]} … {0[1]}".format), [p.sites for p in points]),
            (Column("strain_width", error=True), numbers["strain_width"]),
            (Column("missing"), [p.missing for p in points]),
        ]
        for closure, wave in self.theory.items():
            cells += [(Column(f"theory.{closure}.{n}_value"), x.ravel()) for n, x in wave.items()]
        columns, values = zip(*cells, strict=True)
        heads = {str(k): f"k = {k}" for k in self.ks}
        table = Table(columns, tuple(zip(*values, strict=True)), "points", by="k", heads=heads)
        panels = self._maps() if min(len(self.ks), len(self.omegas)) > 1 else self._curves()
        data = {"stretch": self.stretch, "missing": len(told)}
        title = "The steady pulse of a struck dimer chain"
        low, high = _HUMPED
        beyond = _BEYOND if any(low < omega < high for omega in self.omegas) else ""
        notes = ("\n".join(told), _NOTE, beyond)
        return Report(title, (table,), panels=panels, notes=notes, data=data)

    def _maps(self) -> tuple[Panel, ...]:
        x, y = (np.array(axis, float) for axis in (self.omegas, self.ks))
        decay, theory = self.map("decay"), 100 * self.error("linear", "width")
        # Where colours end.
        least, largest = 1e-7, min(np.nanmax([*np.abs(theory).flat, 1e-3]), 50.0)
        decay = np.maximum(decay, least / 2)  # positive, for the logarithm
        percents = f"FWHM of force: {CLOSURES['linear']}/lattice - 1 (%)"
        i, j = np.nonzero(self.map("width", "error") > 0.01 * self.map("width"))
        unsure = (Curve("", x[j], y[i], "rx"),)
        title = "hatched: no value; red ×: width known to less than 1 %"
        scale = "x" if x[-1] > 50 * x[0] else ""
        return tuple(
            Panel(_OMEGA, "k", unsure, scale, title, found)
            for found in (
                Map(QUANTITIES["width"], x, y, self.map("width")),
                Map(QUANTITIES["speed"], x, y, self.map("speed")),
                Map(QUANTITIES["decay"], x, y, decay, least, scale="log", colours="cividis"),
                Map(percents, x, y, theory, -largest, largest, colours="PuOr"),
            )
        )

    def _curves(self) -> tuple[Panel, ...]:
        along_k = self.ks, "k", f"ω = {self.omegas[0]}"
        axis, x, title = along_k if len(self.ks) > 1 else (self.omegas, _OMEGA, f"k = {self.ks[0]}")
        panels = []
        for name, label in QUANTITIES.items():
            value, error = (self.map(name, part).ravel() for part in ("value", "error"))
            if log := name == "decay":  # a decay below its error is drawn as its error
                value = np.fmax(value, error)
            curves = [Curve.of("lattice", axis, value, "ko", error)]
            for style, (closure, wave) in zip(("C0-", "C1--"), self.theory.items(), strict=True):
                if name in wave:
                    curves.append(Curve.of(CLOSURES[closure], axis, wave[name].ravel(), style))
            panels.append(Panel(x, label, tuple(curves), "y" * log, title))
        return tuple(panels)


def _finished(file: Path, header: bytes) -> dict[Key, Point]:
    """Points of a sweep's file. A torn last line is dropped.

    The first line holds the format and the settings, every other line a point:

        {"k": "3/2", "omega": "1", "sites": [56, 64], "numbers": {"width": [1.41192837, 1.4119], …}}
        {"k": "3/2", "omega": "1/9", "missing": "not steady: the pulse has not passed 320 sites"}

    A number is followed by the less accurate one that gives its error.
    """

    def read(
        k: str, omega: str, sites: Any = None, numbers: Any = (), missing: Any = None
    ) -> Point:
        pairs = {name: Measured(*map(float, numbers[name])) for name in QUANTITIES if numbers}
        return Point(exact(k, "k"), exact(omega, "omega"), sites and (*sites,), pairs, missing)

    found = content(file, _MOST_BYTES) if file.exists() else b""
    if not header.startswith(found) and not found.startswith(header):
        wanted = header.decode().strip()
        raise InputError(f"{file} does not begin with {wanted}: choose another name")
    end, points = found.rfind(b"\n") + 1, dict[Key, Point]()
    for number, line in enumerate(found[:end].splitlines()[1:], start=2):
        try:
            point = read(**json.loads(line))
        except (ValueError, TypeError, KeyError, RecursionError):
            raise InputError(f"{file} is damaged in line {number}") from None
        points[point.k, point.omega] = point
    if end < len(found):
        os.truncate(file, end)
    return points


def _keep(file: Path, header: bytes, point: Point) -> None:
    """Append a point to a sweep's file; the point is on the disk when this returns."""
    numbers = {name: [n.value, n.check] for name, n in point.numbers.items()}
    entry = {"k": str(point.k), "omega": str(point.omega)} | (
        {"missing": point.missing} if point.missing else {"sites": point.sites, "numbers": numbers}
    )
    line = json.dumps(entry, ensure_ascii=False, allow_nan=False).encode() + b"\n"
    with file.open("ab") as stream:
        stream.write(line if stream.tell() else header + line)
        stream.flush()
        os.fsync(stream.fileno())


@contextmanager
def _locked(file: Path) -> Iterator[None]:
    """Keep other processes away from a sweep's file."""
    lock = FileLock(f"{file}.lock", blocking=False)
    try:
        with lock:
            try:
                yield
            finally:
                Path(lock.lock_file).unlink()
    except Timeout:
        raise InputError(f"file is {file}: another sweep writes it") from None


def theory(ks: Sequence[Rational], omegas: Sequence[Rational]) -> dict[str, dict[str, Array]]:
    """Widths and speed of the compact waves with contact force 1, as in `Sweep`."""
    k, omega = np.meshgrid(np.array(ks, float), np.array(omegas, float), indexing="ij")
    scale = np.sqrt(2 * k / (1 + omega))  # τ/t, for A = D = m1 = 1
    cell = Dimer("m1", "m2", spacing=1)
    found = {"linear": homogenize(cell).pde.traveling_wave(), "canonical": canonical_wave(cell)}
    waves = {closure: wave.numeric(missing="nan") for closure, wave in found.items()}
    return {
        closure: {
            "width": wave.fwhm(k, omega, "force"),
            "strain_width": wave.fwhm(k, omega, "strain"),
            "speed": wave.speed(k, omega) * scale,
        }
        for closure, wave in waves.items()
    }


def _axis(text: str, name: str) -> Iterator[Rational]:
    """Values and ranges start:stop:count of a text, exactly."""
    for part in text.split(","):
        start, *rest = part.split(":")
        if not rest:
            yield exact(start, name)
            continue
        if len(rest) != 2 or not rest[1].strip().isdecimal() or len(rest[1]) > 9:
            raise SceneError(f"{name} is {shorten(part)}: a range is start:stop:count")
        count = integer(int(rest[1]), f"the count of {name}", 2, _MOST)
        first, last = exact(start, name), exact(rest[0], name)
        yield from (first + (last - first) * i / (count - 1) for i in range(count))


def _values(given: str | Iterable[Any], name: str) -> tuple[Rational, ...]:
    listed = _axis(given, name) if isinstance(given, str) else items(given, name)
    values = {exact(value, name) for value in listed}
    least, most = RANGES[name]
    for value in values:
        if not (value.is_Rational and least <= value <= most):
            raise SceneError(f"{name} is {shorten(value)}: one from {least} to {most} is wanted")
    if not 0 < len(values) <= _MOST:
        raise SceneError(f"{name} has {len(values)} values: 1 … {_MOST} are wanted")
    return tuple(sorted(values))


_RANGES = "values and ranges start:stop:count, separated by commas."


@study(
    option("--k", "ks", default="5/4:3:8", says=f"Exponents of F = δ^k: {_RANGES}"),
    option("--omega", "omegas", default="1/20:1:20", says=f"Mass ratios m2/m1: {_RANGES}"),
    option("--stretch", default=STRETCH, says="Cells from place to place; more at k < 3/2."),
    option("--file", metavar="FILE", says="Keep finished points (.jsonl), and continue from them."),
    option("--jobs", callback=whole, says="Threads; by default one for each processor."),
    option("--cluster", "address", metavar="ADDRESS", says="Dask scheduler to compute on."),
)
def sweep(
    ks: str | Iterable[Any],
    omegas: str | Iterable[Any],
    stretch: int = STRETCH,
    file: str | Path | None = None,
    jobs: int | None = None,
    address: str | None = None,
    progress: Progress[Key] = iter,
) -> Sweep:
    """Maps over k and m2/m1: width, speed and decay of a struck chain's pulse. The 160 points of
    the default grid take half a minute.

    ks, omegas: texts such as "5/4:3:8, 4", or exact numbers; floats count as their decimals.
    stretch: cells between places of measurement at k ≥ 3/2, see `validation.pulses.steady`.
    file: keeps finished points, ends in .jsonl; points in the file are not computed again.
    jobs, address: number of threads, by default one a core; scheduler of a Dask cluster instead.
    progress: shows the points to be computed, such as `tqdm.tqdm`.

    Raises `lwa.InputError` for numbers outside `RANGES` or an unfit file, `SweepError` when a
    worker fails; finished points are kept.

    >>> round(sweep(["3/2"], [1]).points[0].numbers["width"].value, 4)
    1.4119
    """
    grid = _values(ks, "k"), _values(omegas, "omega")
    stretch = integer(stretch, "stretch", 2, 100)
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has workers of its own")
    path = None if file is None else output_file("file", str(file), (".jsonl",))
    header = json.dumps(_FORMAT | {"settings": {"stretch": stretch}}).encode() + b"\n"
    with _locked(path) if path else nullcontext():
        points = _finished(path, header) if path else {}
        todo = [key for key in product(*grid) if key not in points]
        with threads(jobs, "jobs") if address is None else cluster(address) as workers:
            underway = [workers.submit(point, *key, stretch) for key in todo]
            try:
                for _, future in zip(progress(todo), as_completed(underway), strict=True):
                    found = future.result()
                    points[found.k, found.omega] = found
                    if path:
                        _keep(path, header, found)
            except (BrokenExecutor, CancelledError) as error:
                gone = "the workers are gone before the sweep is done: killed, or out of memory?"
                raise SweepError(gone) from error
            finally:
                for future in underway:
                    future.cancel()
    return Sweep(*grid, stretch, tuple(points[key] for key in product(*grid)), theory(*grid))
