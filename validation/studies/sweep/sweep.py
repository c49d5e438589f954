"""Sweeps: the steady pulse of a dimer chain over k and ω, beside the theory's.

Every point is one chain of `validation.pulses.steady`. The points are computed by any executor of
`concurrent.futures`, a bounded number at a time, and go into the sweep's file one by one as they
are finished (`validation.studies.sweep.journal`): a sweep that is interrupted goes on from there,
and one with more k and ω computes only what is new. A point that cannot be measured says why.

The theory's numbers are those of the wave of `lwa` with contact force 1 at its peak: the paper's
closure, and the canonical field of the full closure.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass
from functools import cache
from itertools import islice, product
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa import Dimer, canonical_wave, homogenize
from lwa.exact import shorten
from lwa.numeric import NumericWave
from validation.pulses.steady import STRETCH, Point, point
from validation.scenes.checks import SceneError, integer, items
from validation.studies.sweep.executors import processes
from validation.studies.sweep.journal import Journal, Key, rational

Array = NDArray[np.float64]

RANGES = {
    "k": (sp.Rational(21, 20), sp.Integer(6)),
    "omega": (sp.Rational(1, 100), sp.Integer(100)),
}
"""Where a run of some seconds is enough."""

MOST = 1000
"""Values on each axis."""

CLOSURES = {
    "linear": "paper's closure",
    "canonical": "full closure, canonical field",
}
"""The theories beside the lattice, and what they are called."""

_UNDERWAY = 256
"""Points that the executor is given at a time."""


class SweepError(RuntimeError):
    """The executor gave up; what was finished is kept. The message says where it stood."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """A point for each k (outer) and ω (inner), both in rising order, beside the theories.

    stretch : cells from place to place, see `validation.pulses.steady`.
    theory : closure → `QUANTITIES` but for the decay → (len(ks), len(omegas)); NaN where the
        theory has no wave.
    """

    ks: tuple[sp.Rational, ...]
    omegas: tuple[sp.Rational, ...]
    stretch: int
    points: tuple[Point, ...]
    theory: Mapping[str, Mapping[str, Array]]

    def map(self, quantity: str, part: str = "value") -> Array:
        """One of `QUANTITIES`, or its ``part`` "error": (len(ks), len(omegas)).

        NaN at the points that are ``missing``.
        """
        values = (
            getattr(p.numbers[quantity], part) if p.missing is None else np.nan for p in self.points
        )
        return np.fromiter(values, float).reshape(len(self.ks), len(self.omegas))


def axis(text: str, name: str) -> tuple[sp.Rational, ...]:
    """The values in a text: numbers and ranges start:stop:count, separated by commas, exact.

    >>> axis("1.2, 3/2:2:3", "k")
    (6/5, 3/2, 7/4, 2)
    """
    values: list[sp.Rational] = []
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
    progress: Callable[[Collection[Key]], Iterable[Key]] = iter,
) -> Sweep:
    """Strike a chain for each k and ω.

    Parameters
    ----------
    ks, omegas : exact numbers, texts, or floats (read as the decimals they print as); the order
        and repetitions do not matter.
    stretch : cells from place to place, see `validation.pulses.steady`; at k ≥ 3/2, and more below.
    executor : which computes the points, and is left running; or a context that gives one, such
        as `validation.studies.sweep.executors.cluster`, entered when there is something to compute.
        By default `validation.studies.sweep.executors.processes`.
    file : where finished points are kept, ending in .jsonl; those it holds are not computed again.
    progress : is shown the points to be computed (such as `tqdm.tqdm`).

    Raises `lwa.InputError` for numbers outside `RANGES` or a file that cannot serve, and
    `SweepError` when the executor fails.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor() as threads:
    ...     found = sweep(["3/2"], [1], executor=threads)
    >>> found.points[0].numbers["width"].value.__round__(4)
    1.4119
    """
    grid = _values(ks, "k"), _values(omegas, "omega")
    stretch = integer(stretch, "stretch", 2, 100)
    with closing(Journal(file, {"stretch": stretch})) as journal:
        todo = [key for key in product(*grid) if key not in journal.points]
        if todo:
            with _entered(executor) as workers:
                _compute(workers, todo, stretch, journal, progress)
        points = tuple(journal.points[key] for key in product(*grid))
    return Sweep(*grid, stretch, points, theory(*grid))


def theory(
    ks: Collection[sp.Rational], omegas: Collection[sp.Rational]
) -> dict[str, dict[str, Array]]:
    """The theories' numbers, as in `Sweep`."""
    k, omega = np.meshgrid([float(k) for k in ks], [float(w) for w in omegas], indexing="ij")
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


def _values(given: Iterable[Any], name: str) -> tuple[sp.Rational, ...]:
    values = {rational(value, name) for value in items(given, name)}
    least, most = RANGES[name]
    for value in values:
        if not least <= value <= most:
            raise SceneError(f"{name} is {shorten(value)}: one from {least} to {most} is wanted")
    if not 0 < len(values) <= MOST:
        raise SceneError(f"{name} has {len(values)} values: 1 … {MOST} are wanted")
    return tuple(sorted(values))


def _entered(
    executor: Executor | AbstractContextManager[Executor] | None,
) -> AbstractContextManager[Executor]:
    if executor is None:
        return processes()
    if isinstance(executor, Executor):
        return nullcontext(executor)
    if isinstance(executor, AbstractContextManager):
        return executor
    raise SceneError(f"executor is {shorten(executor)}: a concurrent.futures.Executor is wanted")


def _compute(
    executor: Executor,
    todo: list[Key],
    stretch: int,
    journal: Journal,
    progress: Callable[[Collection[Key]], Iterable[Key]],
) -> None:
    """Each point into the journal as soon as it is finished, whatever happens to the others."""
    waiting = iter(todo)
    underway: dict[Future[Point], Key] = {}
    with closing(key for key in progress(todo)) as ticks:
        next(ticks)
        try:
            while True:
                for key in islice(waiting, _UNDERWAY - len(underway)):
                    underway[executor.submit(point, *key, stretch)] = key
                if not underway:
                    return
                done = wait(underway, return_when=FIRST_COMPLETED).done
                for future in [future for future in underway if future in done]:
                    journal.add(_result(future, underway[future]))
                    del underway[future]
                    next(ticks, None)
        except BaseException as error:
            for future, key in underway.items():
                if key in journal.points:  # it was being kept when Ctrl-C came
                    continue
                if not future.cancel() and future.done() and future.exception() is None:
                    journal.add(future.result())
            if isinstance(error, BrokenExecutor | CancelledError):
                reason = "killed, or out of memory?"
                raise SweepError(
                    f"the workers are gone before the sweep is done: {reason}"
                ) from error
            raise


def _result(future: Future[Point], key: Key) -> Point:
    try:
        return future.result()
    except (BrokenExecutor, CancelledError):
        raise
    except Exception as error:  # beyond what a point can say of itself
        reason = f"{type(error).__name__}: {error}"
        raise SweepError(f"k = {key[0]}, omega = {key[1]} is not computed: {reason}") from error
