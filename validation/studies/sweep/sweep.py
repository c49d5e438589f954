"""Sweeps: the steady pulse of a dimer chain over k and ω, beside the theory's.

Every point is one chain of `validation.pulses.steady`, and goes into the sweep's file as soon as it
is finished: a sweep that is interrupted goes on from there, and one with more k and ω computes only
what is new. A point that cannot be measured says why. The theory's numbers are those of its wave
with contact force 1 at its peak: the paper's closure, and the canonical field of the full closure.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import click
import numpy as np
from sympy import Rational

from lwa import Dimer, canonical_wave, homogenize
from lwa.base.arrays import Array
from lwa.base.exact import InputError, shorten
from lwa.base.progress import Progress
from lwa.wave.numeric import NumericWave
from validation.lattice.threads import threads
from validation.pulses.steady import QUANTITIES, STRETCH, Point
from validation.report.command import option, study, whole
from validation.report.panel import Curve, Map, Panel
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.report.text import percent
from validation.scenes.checks import SceneError, integer, items
from validation.studies.sweep.executors import cluster, compute, entered
from validation.studies.sweep.journal import Journal, Key, rational

RANGES = {"k": (Rational(21, 20), Rational(6)), "omega": (Rational(1, 100), Rational(100))}
"""Where a run of some seconds is enough."""

MOST = 1000
"""Values on each axis."""

CLOSURES = {"linear": "paper's closure", "canonical": "full closure, canonical field"}
"""The theories beside the lattice, and what they are called."""

_OMEGA = "ω = m2/m1"
_UNSURE = 0.01  # relative error of the width from which on a map marks a point
_NO_DECAY = 1e-7  # per site: what a map shows as no decay
_MOST_ERROR = 50.0  # of the theory, in percent: where the colours of its map end
_WIDE = 50  # the largest over the least ω from which on a map's axis is logarithmic

_NOTE = (
    "Width: FWHM of a contact's force, in sites. Speed: sites over time at contact force 1, with "
    "A = D = m1 = 1.\nDecay: of the logarithm of the peak force. ±: the largest change over two "
    "stretches, or of a less accurate run.\nSites: from the struck bead, where it was measured. "
    "Theory/lattice - 1 of the wave of\n"
    f"{'; '.join(f'{closure}: the {name}' for closure, name in CLOSURES.items())}."
)


@dataclass(frozen=True, eq=False)
class Sweep:
    """A point for each k (outer) and ω (inner), both in rising order, beside the theories.

    stretch : cells from place to place, see `validation.pulses.steady`.
    theory : closure → `QUANTITIES` but for the decay → (len(ks), len(omegas)); NaN where the
        theory has no wave.
    """

    ks: tuple[Rational, ...]
    omegas: tuple[Rational, ...]
    stretch: int
    points: tuple[Point, ...]
    theory: Mapping[str, Mapping[str, Array]]

    def map(self, quantity: str, part: str = "value") -> Array:
        """One of `QUANTITIES`, or its ``part`` "error": (len(ks), len(omegas)), NaN where it is
        missing."""
        values = [getattr(p.numbers.get(quantity), part, np.nan) for p in self.points]
        return np.array(values).reshape(len(self.ks), len(self.omegas))

    def error(self, closure: str, quantity: str) -> Array:
        """That of a theory, over the lattice, less 1: (len(ks), len(omegas)), NaN without one."""
        return np.asarray(self.theory[closure][quantity] / self.map(quantity) - 1)

    def report(self) -> Report:
        """``stretch``, ``missing`` (how many), and ``points``: ``k``, ``omega`` (exact), ``sites``,
        ``width_value``, ``strain_width_value``, ``speed_value``, ``decay_value`` and their errors
        (``width_error_value``, …), null where ``missing`` says why; ``theory`` by closure:
        ``width_value``, ``strain_width_value``, ``speed_value``, null where there is no wave. The
        picture: maps over ω and k, or curves where one of the two has a single value.
        """
        without = [point for point in self.points if point.missing is not None]
        missing = "\n".join(f"k = {p.k}, ω = {p.omega}: {p.missing}" for p in without)
        panels = self._maps if min(len(self.ks), len(self.omegas)) > 1 else self._curves
        data = {"stretch": self.stretch, "missing": len(without)}
        return Report("The steady pulse of a struck dimer chain", (self._table(),),
                      panels=panels(), notes=(missing, _NOTE), data=data)  # fmt: skip

    def _table(self) -> Table:
        points = self.points
        numbers = {name: [p.numbers.get(name) for p in points] for name in QUANTITIES}
        cells: list[tuple[Column, Iterable[Any]]] = [
            (Column("k"), [p.k for p in points]),
            (Column("omega", _OMEGA), [p.omega for p in points]),
        ]
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
            for name, found in wave.items():
                cells.append((Column(f"theory.{closure}.{name}_value"), found.ravel()))
        columns, values = zip(*cells, strict=True)
        rows = tuple(zip(*values, strict=True))
        return Table(columns, rows, "points", by="k", heads={str(k): f"k = {k}" for k in self.ks})

    def _maps(self) -> tuple[Panel, ...]:
        width, decay = self.map("width"), self.map("decay")
        theory = 100 * self.error("linear", "width")
        largest = min(np.max(np.abs(theory), initial=1e-3, where=np.isfinite(theory)), _MOST_ERROR)
        most = np.max(decay, initial=10 * _NO_DECAY, where=np.isfinite(decay))
        decay = np.maximum(decay, _NO_DECAY / 2)  # a logarithm wants what is positive
        x, y = (np.array(axis, float) for axis in (self.omegas, self.ks))
        of_theory = f"FWHM of force: {CLOSURES['linear']}/lattice - 1 (%)"
        maps = (
            Map(QUANTITIES["width"], x, y, width),
            Map(QUANTITIES["speed"], x, y, self.map("speed")),
            Map(QUANTITIES["decay"], x, y, decay, _NO_DECAY, most, "log", "cividis"),
            Map(of_theory, x, y, theory, -largest, largest, colours="PuOr"),
        )
        i, j = np.nonzero(self.map("width", "error") > _UNSURE * width)
        marks = (Curve("", x[j], y[i], "rx"),)
        red = f"red ×: width known to less than {_UNSURE:.0%}" if len(i) else ""
        scale = "x" if x[-1] > _WIDE * x[0] else ""

        def title(found: Map) -> str:
            hatched = "hatched: no value" if np.isnan(found.values).any() else ""
            return "; ".join(filter(None, (hatched, red)))

        return tuple(Panel(_OMEGA, "k", marks, scale, title(found), found) for found in maps)

    def _curves(self) -> tuple[Panel, ...]:
        along_k = self.ks, "k", f"ω = {self.omegas[0]}"
        axis, x, title = along_k if len(self.ks) > 1 else (self.omegas, _OMEGA, f"k = {self.ks[0]}")
        places = np.array(axis, float)
        panels = []
        for name, label in QUANTITIES.items():
            value, error = (self.map(name, part).ravel() for part in ("value", "error"))
            if log := name == "decay":  # what is less than its error is shown as that
                value = np.fmax(value, error)
            curves = [Curve("lattice", places, value, "ko", error)]
            for style, (closure, wave) in zip(("C0-", "C1--"), self.theory.items(), strict=True):
                if name in wave:
                    curves.append(Curve(CLOSURES[closure], places, wave[name].ravel(), style))
            panels.append(Panel(x, label, tuple(curves), "y" * log, title))
        return tuple(panels)


def axis(text: str, name: str) -> tuple[Rational, ...]:
    """The values in a text: numbers and ranges start:stop:count, separated by commas, exact.

    >>> axis("1.2, 3/2:2:3", "k")
    (6/5, 3/2, 7/4, 2)
    """
    values: list[Rational] = []
    for part in text.split(","):
        start, *rest = part.split(":")
        if not rest:
            values.append(rational(start, name))
            continue
        if len(rest) != 2 or not rest[1].strip().isdecimal() or len(rest[1]) > 9:
            raise SceneError(f"{name} is {shorten(part)}: a range is start:stop:count")
        count = integer(int(rest[1]), f"the count of {name}", 2, MOST)
        first, last = rational(start, name), rational(rest[0], name)
        values += [first + (last - first) * i / (count - 1) for i in range(count)]
    return tuple(values)


def sweep(
    ks: Iterable[Any],
    omegas: Iterable[Any],
    *,
    stretch: int = STRETCH,
    executor: Executor | AbstractContextManager[Executor] | None = None,
    file: str | Path | None = None,
    progress: Progress[Key] = iter,
) -> Sweep:
    """Strike a chain for each k and ω.

    ks, omegas : exact numbers, texts, or floats (read as the decimals they print as), in any order.
    stretch : cells from place to place, see `validation.pulses.steady`; at k ≥ 3/2, and more below.
    executor : which computes the points, and is left running; or a context that gives one, such
        as `validation.studies.sweep.executors.cluster`, entered when there is something to compute.
        By default a thread for each core.
    file : where finished points are kept, ending in .jsonl; those it holds are not computed again.
    progress : is shown the points to be computed (such as `tqdm.tqdm`).

    Raises `lwa.InputError` for numbers outside `RANGES` or a file that cannot serve, and
    `validation.studies.sweep.executors.SweepError` when the executor fails.

    >>> found = sweep(["3/2"], [1])
    >>> found.points[0].numbers["width"].value.__round__(4)
    1.4119
    """
    grid = _values(ks, "k"), _values(omegas, "omega")
    stretch = integer(stretch, "stretch", 2, 100)
    journal = Journal(file, {"stretch": stretch})
    if todo := [key for key in product(*grid) if key not in journal.points]:
        with entered(executor) as workers:
            compute(workers, todo, stretch, journal, progress)
    points = tuple(journal.points[key] for key in product(*grid))
    return Sweep(*grid, stretch, points, theory(*grid))


def theory(ks: Sequence[Rational], omegas: Sequence[Rational]) -> dict[str, dict[str, Array]]:
    """The theories' numbers, as in `Sweep`."""
    k, omega = np.meshgrid(np.array(ks, float), np.array(omegas, float), indexing="ij")
    scale = np.sqrt(2 * k / (1 + omega))  # τ/t, for A = D = m1 = 1
    return {
        closure: {
            "width": wave.fwhm(k, omega, "force"),
            "strain_width": wave.fwhm(k, omega, "strain"),
            "speed": wave.speed(k, omega) * scale,
        }
        for closure, wave in _waves().items()
    }


@cache
def _waves() -> dict[str, NumericWave]:
    cell = Dimer("m1", "m2", spacing=1)
    waves = {"linear": homogenize(cell).pde.traveling_wave(), "canonical": canonical_wave(cell)}
    return {closure: wave.numeric(missing="nan") for closure, wave in waves.items()}


def _values(given: Iterable[Any], name: str) -> tuple[Rational, ...]:
    values = {rational(value, name) for value in items(given, name)}
    least, most = RANGES[name]
    for value in values:
        if not least <= value <= most:
            raise SceneError(f"{name} is {shorten(value)}: one from {least} to {most} is wanted")
    if not 0 < len(values) <= MOST:
        raise SceneError(f"{name} has {len(values)} values: 1 … {MOST} are wanted")
    return tuple(sorted(values))


@study(
    option("--k", "ks", default="5/4:3:8", says="Exponents of F = δ^k: values and "
           "ranges start:stop:count, separated by commas."),
    option("--omega", "omegas", default="1/20:1:20",
           says="Mass ratios m2/m1, likewise."),
    option("--stretch", default=STRETCH, says="Cells from one place at which the pulse is measured "
           "to the next; more below k = 3/2."),
    option("--file", metavar="FILE", says="Keep finished points (.jsonl); with the same file a "
           "sweep goes on where it was left."),
    option("--jobs", callback=whole, says="Threads; by default one for each processor."),
    option("--cluster", "address", metavar="ADDRESS", says="Compute on a Dask cluster instead, "
           "whose scheduler is there, such as tcp://host:8786."),
    name="sweep",
)  # fmt: skip
def sweep_command(
    ks: str, omegas: str, stretch: int, file: str | None, jobs: int | None, address: str | None,
    progress: Progress[Key],
) -> Sweep:  # fmt: skip
    """Maps over k and m2/m1: width, speed and decay of a struck chain's pulse."""
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has workers of its own")
    executor = threads(jobs, "jobs") if address is None else cluster(address)
    try:
        return sweep(axis(ks, "k"), axis(omegas, "omega"), stretch=stretch, executor=executor,
                     file=file, progress=progress)  # fmt: skip
    except KeyboardInterrupt:
        if file is not None and Path(file).exists():
            click.echo(f"finished points are in {file}: the same command goes on", err=True)
        raise
