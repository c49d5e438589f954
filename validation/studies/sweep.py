"""Width, speed and decay of a dimer chain's steady pulse over k and ω, beside the theory.

Each point of the grid is one struck chain (`validation.pulses.steady`) and enters the sweep's file
as soon as the point is finished. An interrupted sweep continues from its file, and a larger sweep
with the same file computes only its new points. The theory's numbers belong to the compact wave
with contact force 1 at its peak, in the paper's closure and for the full closure's canonical field.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    as_completed,
)
from contextlib import AbstractContextManager
from itertools import product
from pathlib import Path
from typing import Any

import click
import numpy as np
import sympy as sp
from sympy import Rational

from lwa import Dimer, Estimate, canonical_wave, homogenize
from lwa.base.arrays import Array
from lwa.base.exact import InputError, read_exact, shorten
from lwa.base.progress import Progress
from lwa.command.options import count
from validation.lattice.threads import cluster, threads
from validation.pictures import Curve, Panel
from validation.pulses.steady import LABELS, Key, Point, point, stored
from validation.report.study import Report, option, output_file, study
from validation.report.table import Column, Estimates, Table, percent
from validation.scenes.checks import Failure, SceneError, items

RANGES = {
    "k": (Rational(21, 20), Rational(6)),
    "omega": (Rational(1, 100), Rational(100)),
}
"""Exponents and mass ratios at which a run of some seconds is enough."""

CLOSURES = {"linear": "paper's closure", "canonical": "full closure, canonical field"}
"""Theories beside the lattice, with their labels."""

_MOST = 1000  # values of an axis; a grid of 10⁶ points takes days, and waits in 2 GB
MEMORY = Path(":memory:")
"""SQLite's name of a database that is not kept, of a sweep without a file."""

Axis = Sequence[Rational]

_LABELS = {"k": "k", "omega": "ω = m2/m1"}
_COLUMNS = (
    # Heads a part of the table.
    Column("k", format="k = {}".format),
    Column("omega", _LABELS["omega"]),
    Estimates("width", "width"),
    Column("error.linear.width_value", "linear", format=percent),
    Column("error.canonical.width_value", "canonical", format=percent),
    Estimates("speed", "speed"),
    Column("error.linear.speed_value", "linear", format=percent),
    Column("error.canonical.speed_value", "canonical", format=percent),
    Estimates("decay", "decay per site"),
    Column("sites", "sites", format="{0[0]} … {0[1]}".format),
    # The columns from here on are for JSON and CSV alone: a terminal has no room.
    Estimates("strain_width"),
    Column("missing"),
    *(
        Column(f"theory.{closure}.{quantity}_value")
        for closure in CLOSURES
        for quantity in ("width", "strain_width", "speed")
    ),
)
_NOTE = """\
Width: FWHM of a contact's force, in sites. Speed: sites over time at contact force 1, with A = D =
m1 = 1. Decay: of the logarithm of the peak force. Sites: places of the measurement, from the struck
bead. linear, canonical: theory/lattice - 1 for the paper's closure and for the full closure's
canonical field. From m2/m1 = 0.2 to 0.7 a contact's force may have several humps, that of the
theory has one: the width, of the highest hump, is no measure of the theory's error."""
_ERRORS = (
    "the largest change over a stretch, from a less accurate run, or twice that to 40 "
    "stretches"
)


Row = Mapping[str, Any]
"""Cells of a point by the keys of columns."""


def report(points: Sequence[Point]) -> Report:
    """Return the report of points, in rising order of k, then of ω, beside the theories.

    Table ``points`` has the missing values' reasons.
    """
    rows = _rows(points)
    # Reasons stand below the table: a cell has no room for a sentence.
    missing = []
    for found in points:
        if found.missing is not None:
            missing.append(f"k = {found.k}, ω = {found.omega}: {found.missing}")
    return Report(
        "The steady pulse of a struck dimer chain",
        (Table(_COLUMNS, rows, "points", by="k", note=_NOTE, errors=_ERRORS),),
        panels=[*_panels(rows)],
        notes=("\n".join(missing),),
        data={"missing": len(missing)},
    )


def _rows(points: Sequence[Point]) -> list[Row]:
    """Return the row of each point: its numbers, the theory's, and the theory's errors.

    The keys are those of `_COLUMNS`: ``sites`` are both ends of the measured stretch, ``missing``
    is the reason why a point has no numbers, "linear" and "canonical" name the `CLOSURES`, and an
    error is theory/lattice - 1.
    """
    waves = theory(points)
    rows: list[Row] = []
    for i, found in enumerate(points):
        row: dict[str, Any] = {
            "k": found.k,
            "omega": found.omega,
            "sites": found.sites,
            "missing": found.missing,
        }
        row |= found.numbers
        for (closure, quantity), values in waves.items():
            row[f"theory.{closure}.{quantity}_value"] = values[i]
            # Some points have no steady pulse, or one whose width is not measured.
            if quantity in found.numbers:
                error = values[i] / found.numbers[quantity].value - 1
                row[f"error.{closure}.{quantity}_value"] = error
        rows.append(row)
    return rows


def _panels(rows: Sequence[Row]) -> Iterator[Panel]:
    """Yield curves of each quantity over ω, one for each k; of a single ω, over k.

    A single curve has the theories beside it.
    """
    x, of_curve = "omega", "k"
    if len({row["omega"] for row in rows}) == 1:
        x, of_curve = of_curve, x  # exchanged
    groups: dict[str, list[Row]] = {}
    for row in rows:
        name = f"{_LABELS[of_curve]} = {row[of_curve]}"
        groups.setdefault(name, []).append(row)
    for quantity, label in LABELS.items():
        curves = []
        for name, group in groups.items():
            axis = [row[x] for row in group]
            numbers = [row.get(quantity, _NONE) for row in group]
            values = np.array([number.value for number in numbers])
            errors = np.array([number.error for number in numbers])
            # On a logarithmic axis a decay below its error, or below 0, is drawn as its error.
            if quantity == "decay":
                values = np.fmax(values, errors)
            curves.append(Curve(name, axis, values, error=errors))
        # Beside several curves the theories' would hide them; theories have no decay.
        if len(groups) == 1 and quantity != "decay":
            for closure, name in CLOSURES.items():
                line = [row[f"theory.{closure}.{quantity}_value"] for row in rows]
                curves.append(Curve(name, axis, line))
        scale = "y" if quantity == "decay" else ""
        yield Panel(_LABELS[x], label, curves, scale)


_NONE = Estimate(math.nan, math.nan)


def theory(points: Sequence[Point]) -> dict[tuple[str, str], Array]:
    """Return widths and speed of the compact waves at contact force 1, (points,).

    The keys are pairs of a closure, of `CLOSURES`, and a quantity: "width" or "strain_width", the
    FWHM of force or strain in sites, or "speed", sites over time. NaN where a closure has no wave.
    """
    k = np.array([point.k for point in points], float)
    omega = np.array([point.omega for point in points], float)
    # The theory's speed is dx/dτ in the scaled time τ = t √(2k A D^{k+1}/(m1 + m2)). Here
    # A = D = m1 = 1 and m2 = ω: the factor is τ/t.
    scale = np.sqrt(2 * k / (1 + omega))
    # One derivation in symbols serves all points.
    cell = Dimer("m1", "m2", spacing=1)
    waves = {
        "linear": homogenize(cell).pde.traveling_wave(),
        # A width that does not depend on which bead is called the first.
        "canonical": canonical_wave(cell),
    }
    found = {}
    for closure, exact in waves.items():
        # The paper's closure has no wave at some k and ω: nothing is drawn there.
        wave = exact.numeric(missing="nan")
        found[closure, "width"] = wave.fwhm(k, omega, "force")
        found[closure, "strain_width"] = wave.fwhm(k, omega, "strain")
        # The peak strain is 1 by default: with A = D = 1 that is a compression and a force of 1.
        found[closure, "speed"] = wave.speed(k, omega) * scale
    return found


def _read(part: Any, name: str) -> list[sp.Expr]:
    """Read a number, or the numbers of a range start:stop:count, both ends included, exactly."""
    texts = str(part).split(":")
    numbers = [read_exact(text, name) for text in texts]
    if len(numbers) == 1:
        return numbers
    if len(numbers) != 3:
        raise SceneError(f"{name} is {shorten(part)}: a range is start:stop:count")
    start, stop, count = numbers
    if not (count.is_Integer and 2 <= count <= _MOST):
        wanted = f"the count of a range is an integer from 2 to {_MOST}"
        raise SceneError(f"{name} is {shorten(part)}: {wanted}")
    # Exact steps: 1/10 is a value of 1/20:1:20, and a file finds the point again.
    length = stop - start
    return [start + length * i / (count - 1) for i in range(count)]


def _values(given: str | Iterable[Any], name: str) -> tuple[Rational, ...]:
    """Read the exact values of an axis, in rising order."""
    least, most = RANGES[name]
    values = set()  # a value in two overlapping ranges is one
    parts = given.split(",") if isinstance(given, str) else items(given, name)
    for part in parts:
        for value in _read(part, name):
            if not (value.is_Rational and least <= value <= most):
                wanted = f"a number from {least} to {most} is wanted"
                raise SceneError(f"{name} is {shorten(value)}: {wanted}")
            values.add(value)
    if not 0 < len(values) <= _MOST:
        fault = f"it has {len(values)} values, and 1 to {_MOST} are wanted"
        raise SceneError(f"{name} is {shorten(given)}: {fault}")
    return tuple(sorted(values))


def measured(
    ks: Axis,
    omegas: Axis,
    path: Path,
    workers: AbstractContextManager[Executor],
    progress: Progress[Key],
) -> list[Point]:
    """Measure the points of a grid that are not yet in the file, by the executor of ``workers``."""
    with workers as executor, stored(path) as (points, keep):
        # Points of an earlier sweep with this file are not computed again.
        missing = [key for key in product(ks, omegas) if key not in points]
        try:
            waiting = [executor.submit(point, *key) for key in missing]
            # The first that is done, whatever its place in the grid.
            finished = as_completed(waiting)
            for _, future in zip(progress(missing), finished, strict=True):
                new = future.result()
                points[new.k, new.omega] = new
                keep(new)
        except (BrokenExecutor, CancelledError) as error:
            gone = "the workers are gone before the sweep is done: killed, or out of memory?"
            raise Failure(gone) from error
        except KeyboardInterrupt:
            kept = f"the same line goes on from {path}"
            if path == MEMORY:
                kept = "--file points.sqlite keeps finished points for the same line"
            raise KeyboardInterrupt(kept) from None
    return [points[key] for key in product(ks, omegas)]


_RANGES = "values and ranges start:stop:count, separated by commas."


@study(
    option("--k", f"Exponents of F = δ^k: {_RANGES}", to="ks", default="5/4:3:8"),
    option(
        "--omega", f"Mass ratios m2/m1: {_RANGES}", to="omegas", default="1/20:1:20"
    ),
    option(
        "--file",
        "File of finished points (.sqlite), to be continued.",
        metavar="FILE",
        type=click.Path(),
    ),
    option("--jobs", "Number of threads; by default one a processor.", read=count),
    option(
        "--cluster",
        "Dask scheduler, in place of threads.",
        to="address",
        metavar="ADDRESS",
    ),
    page="recipes",
    examples=(
        "lwa-validate sweep --k 3/2,2 --omega 1/4:1:4 --file p.sqlite",
        "lwa-validate sweep --k 3/2,2 --omega 1/4:1:4 --file p.sqlite --plot p.svg",
    ),
)
def sweep(
    ks: str | Iterable[Any],
    omegas: str | Iterable[Any],
    file: str | Path | None = None,
    jobs: int | None = None,
    address: str | None = None,
    progress: Progress[Key] = iter,
) -> Report:
    """Width, speed and decay of a struck chain's pulse over k and m2/m1. The 160 points of the
    default grid take half a minute.

    Parameters
    ----------
    ks, omegas : str or iterable of numbers
        Texts such as "5/4:3:8, 4", or exact numbers; floats count as their decimals.
    file : path, optional
        File of finished points (.sqlite), which are not computed again.
    jobs : int, optional
        Number of threads; by default one a core.
    address : str, optional
        Scheduler of a Dask cluster, in place of threads.
    progress : Progress
        Display of the number of points that are done.

    Raises
    ------
    InputError
        For numbers outside `RANGES`, and for an unfit file.
    Failure
        When a worker fails; the file keeps finished points.

    Examples
    --------
    >>> round(sweep(["3/2"], [1]).document()["points"][0]["width_value"], 4)
    1.4119
    """
    grid = _values(ks, "k"), _values(omegas, "omega")
    # Checked before the file is made: a refusal leaves no file behind.
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has its own workers", jobs=None)
    path = MEMORY
    if file is not None:
        path = output_file("file", str(file), (".sqlite",))
    workers = threads(jobs, "jobs") if address is None else cluster(address)
    return report(measured(*grid, path, workers, progress))
