"""Width, speed and decay of a dimer chain's steady pulse over k and ω, beside the theory.

Each point of the grid is one struck chain (`validation.pulses.steady`) and enters the sweep's file
as soon as the point is finished. An interrupted sweep continues from its file, and a larger sweep
with the same file computes only its new points. The theory's numbers belong to the compact wave
with contact force 1 at its peak, in the paper's closure and for the full closure's canonical field.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import AbstractContextManager
from itertools import islice, product
from pathlib import Path
from queue import SimpleQueue
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
from validation.pulses.steady import LABELS, STRETCH, Key, Point, PointFile, point
from validation.report.study import Report, option, output_file, study
from validation.report.table import Column, Table, percent
from validation.scenes.checks import Failure, SceneError, integer, items

RANGES = {
    "k": (Rational(21, 20), Rational(6)),
    "omega": (Rational(1, 100), Rational(100)),
}
"""Exponents and mass ratios at which a run of some seconds is enough."""

CLOSURES = {"linear": "paper's closure", "canonical": "full closure, canonical field"}
"""Theories beside the lattice, with their labels."""

_MOST = 1000  # values of an axis; a grid of 10⁶ points takes days
MEMORY = Path(":memory:")
"""SQLite's name of a database that is not kept, of a sweep without a file."""

AHEAD = 1000  # points that wait for a worker, whatever the size of the grid
Axis = Sequence[Rational]
Grids = Mapping[str, Array]  # quantity → (len(ks), len(omegas)); NaN where missing

_OMEGA = "ω = m2/m1"
_COLUMNS = (
    # Heads a part of the table.
    Column("k", format="k = {}".format),
    Column("omega", _OMEGA),
    Column("width", "width", error=True),
    Column("error.linear.width_value", "linear", format=percent),
    Column("error.canonical.width_value", "canonical", format=percent),
    Column("speed", "speed", error=True),
    Column("error.linear.speed_value", "linear", format=percent),
    Column("error.canonical.speed_value", "canonical", format=percent),
    Column("decay", "decay per site", error=True),
    Column("sites", "sites", format="{0[0]} … {0[1]}".format),
    # From here on for JSON and CSV alone, as a terminal has no room.
    Column("strain_width", error=True),
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


def report(
    ks: Axis, omegas: Axis, points: Sequence[Point], stretch: int = STRETCH
) -> Report:
    """Return the report of points, in rising order of k, then of ω, beside the theories.

    Table ``points`` has the missing values' reasons.
    """
    waves = theory(ks, omegas)
    rows = []
    # Reasons stand below the table: a cell has no room for a sentence.
    missing = []
    grid = np.ndindex(len(ks), len(omegas))
    for place, found in zip(grid, points, strict=True):
        rows.append(_row(found, waves, place))
        if found.missing is not None:
            missing.append(f"k = {found.k}, ω = {found.omega}: {found.missing}")
    return Report(
        "The steady pulse of a struck dimer chain",
        (Table.of(_COLUMNS, rows, "points", by="k", note=_NOTE, errors=_ERRORS),),
        panels=tuple(_panels(omegas, points, waves)),
        notes=("\n".join(missing),),
        data={"stretch": stretch, "missing": len(missing)},
    )


def _row(
    found: Point, waves: Mapping[str, Grids], place: tuple[int, ...]
) -> dict[str, Any]:
    """Return the cells of a point by the keys of columns; ``place`` is that in the grids."""
    row: dict[str, Any] = {
        "k": found.k,
        "omega": found.omega,
        "sites": found.sites,
        "missing": found.missing,
    }
    row |= found.numbers
    for closure, grids in waves.items():
        for quantity, grid in grids.items():
            value = grid[place]
            row[f"theory.{closure}.{quantity}_value"] = value
            # Some points have no steady pulse, or one whose width is not measured.
            if quantity in found.numbers:
                error = value / found.numbers[quantity].value - 1
                row[f"error.{closure}.{quantity}_value"] = error
    return row


def _panels(
    omegas: Axis, points: Sequence[Point], waves: Mapping[str, Grids]
) -> Iterator[Panel]:
    """Yield curves of each quantity over ω, one for each k; of a single ω, over k.

    A single curve has the theories beside it.
    """
    over_k = len(omegas) == 1
    x = "k" if over_k else _OMEGA
    groups: dict[str, list[Point]] = {}
    # A curve for each k; where there is one ω, a single one over k.
    for found in points:
        name = f"{_OMEGA} = {found.omega}" if over_k else f"k = {found.k}"
        groups.setdefault(name, []).append(found)
    for quantity, label in LABELS.items():
        curves = []
        for name, group in groups.items():
            numbers = [found.numbers.get(quantity, _NONE) for found in group]
            values = np.array([number.value for number in numbers])
            errors = np.array([number.error for number in numbers])
            # On a logarithmic axis a decay below its error, or below 0, is drawn as its error.
            if quantity == "decay":
                values = np.fmax(values, errors)
            axis = [found.k if over_k else found.omega for found in group]
            curves.append(Curve(name, axis, values, error=errors))
        # Beside several curves the theories' would hide them; theories have no decay.
        if len(groups) == 1 and quantity != "decay":
            for closure, wave in waves.items():
                line = wave[quantity].ravel()
                curves.append(Curve(CLOSURES[closure], axis, line))
        yield Panel(x, label, tuple(curves), "y" if quantity == "decay" else "")


_NONE = Estimate(math.nan, math.nan)


def theory(ks: Axis, omegas: Axis) -> dict[str, Grids]:
    """Return widths and speed of the compact waves at contact force 1, by closure and quantity."""
    k, omega = np.meshgrid(np.array(ks, float), np.array(omegas, float), indexing="ij")
    scale = np.sqrt(2 * k / (1 + omega))  # τ/t, for A = D = m1 = 1
    # One derivation in symbols serves all points.
    cell = Dimer("m1", "m2", spacing=1)
    waves = {
        "linear": homogenize(cell).pde.traveling_wave(),
        # A width that does not depend on which bead is called the first.
        "canonical": canonical_wave(cell),
    }
    grids: dict[str, Grids] = {}
    for closure, exact in waves.items():
        # The paper's closure has no wave at some k and ω: nothing is drawn there.
        wave = exact.numeric(missing="nan")
        grids[closure] = {
            "width": wave.fwhm(k, omega, "force"),
            "strain_width": wave.fwhm(k, omega, "strain"),
            "speed": wave.speed(k, omega) * scale,
        }
    return grids


def _axis(text: str, name: str) -> Iterator[sp.Expr]:
    """Yield the exact values of a text with numbers and ranges start:stop:count."""
    for part in text.split(","):
        numbers = [read_exact(number, name) for number in part.split(":")]
        if len(numbers) == 1:
            yield numbers[0]
        elif len(numbers) == 3:
            start, stop, given = numbers
            if not (given.is_Integer and 2 <= given <= _MOST):
                wanted = f"the count of a range is an integer from 2 to {_MOST}"
                raise SceneError(f"{name} is {shorten(part)}: {wanted}")
            # Exact steps: 1/10 is a value of 1/20:1:20, and a file finds the point again.
            for i in range(given):
                yield start + (stop - start) * i / (given - 1)
        else:
            raise SceneError(f"{name} is {shorten(part)}: a range is start:stop:count")


def _values(given: str | Iterable[Any], name: str) -> tuple[Rational, ...]:
    """Read the exact values of an axis, in rising order."""
    least, most = RANGES[name]
    values = set()  # a value in two overlapping ranges is one
    for part in _axis(given, name) if isinstance(given, str) else items(given, name):
        value = read_exact(part, name)
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
    file: PointFile,
    workers: AbstractContextManager[Executor],
    progress: Progress[Key],
) -> list[Point]:
    """Measure the points of a grid that are not yet in the file, by the executor of ``workers``."""
    with workers as executor, file.opened() as (points, keep):
        # Points of an earlier sweep with this file are not computed again.
        missing = [key for key in product(ks, omegas) if key not in points]
        waiting = iter(missing)
        ahead: set[Future[Point]] = set()
        done = SimpleQueue[Future[Point]]()
        try:
            for _ in progress(missing):
                # As many new points as are done: an executor keeps all that it is given.
                for key in islice(waiting, AHEAD - len(ahead)):
                    future = executor.submit(point, *key, file.stretch)
                    ahead.add(future)
                    future.add_done_callback(done.put)
                # The first that is done, whatever its place in the grid.
                future = done.get()
                ahead.remove(future)
                new = future.result()
                points[new.k, new.omega] = new
                keep(new)
        except (BrokenExecutor, CancelledError) as error:
            gone = "the workers are gone before the sweep is done: killed, or out of memory?"
            raise Failure(gone) from error
        except KeyboardInterrupt:
            kept = f"the same line goes on from {file.path}"
            if file.path == MEMORY:
                kept = "--file points.sqlite keeps finished points for the same line"
            raise KeyboardInterrupt(kept) from None
        finally:
            # After a failure the points that no worker has begun would still be computed.
            for future in ahead:
                future.cancel()
    return [points[key] for key in product(ks, omegas)]


_RANGES = "values and ranges start:stop:count, separated by commas."


@study(
    option("--k", "ks", default="5/4:3:8", says=f"Exponents of F = δ^k: {_RANGES}"),
    option(
        "--omega", "omegas", default="1/20:1:20", says=f"Mass ratios m2/m1: {_RANGES}"
    ),
    option(
        "--stretch",
        default=STRETCH,
        says="Cells between two measurements; more at k < 3/2.",
    ),
    option(
        "--file",
        metavar="FILE",
        type=click.Path(),
        says="File of finished points (.sqlite), to be continued.",
    ),
    option(
        "--jobs",
        read=count,
        says="Number of threads; by default one a processor.",
    ),
    option(
        "--cluster",
        "address",
        metavar="ADDRESS",
        says="Dask scheduler, in place of threads.",
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
    stretch: int = STRETCH,
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
    stretch : int
        Cells between places of measurement; more below k of 3/2, see `validation.pulses.steady`.
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
    # A stretch of one cell is shorter than the pulse.
    stretch = integer(stretch, "stretch", 2, 100)
    # Before the file: a refusal leaves none behind.
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has its own workers", jobs=None)
    path = MEMORY
    if file is not None:
        path = output_file("file", str(file), (".sqlite",))
    workers = threads(jobs, "jobs") if address is None else cluster(address)
    points = measured(*grid, PointFile(path, stretch), workers, progress)
    return report(*grid, points, stretch)
