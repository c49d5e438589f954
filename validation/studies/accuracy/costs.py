"""What an accuracy costs, and the goals that are set for it.

A method's cost of an accuracy is that of its cheapest run from which on every costlier one attains
it as well: where kinks of [δ]_+^k meet a step by chance, single runs are better than they should.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from statistics import median
from typing import TypeVar

import numpy as np

from validation.report.table import Finding

WANTED = (1e-4, 1e-6, 1e-8, 1e-10)
"""Relative errors of the peak force at which costs are compared."""

_ENOUGH, _REPEATS = 0.15, 7  # seconds and times, beyond which a run is not repeated


@dataclass(frozen=True)
class Row:
    """One run of one method, of the family "SciPy", "compiled" or "peer".

    setting : tolerance.
    errors : relative, by `validation.studies.accuracy.tasks.NUMBERS`; infinite where no pulse came.
    seconds : of CPU time, without compilation.
    step, ns : of compiled runs the mean step, and the time per bead and evaluation of its force.
    """

    task: str
    family: str
    method: str
    window: bool
    setting: float
    errors: Mapping[str, float]
    seconds: float
    step: float | None = None
    ns: float | None = None

    @property
    def name(self) -> str:
        """The integrator, and where it ran."""
        return self.method + (", window" if self.window else "")

    @property
    def error(self) -> float:
        """The largest of the errors."""
        return max(self.errors.values())


_Found = TypeVar("_Found")


def timed(
    run: Callable[[], _Found], least: int = 1, clock: Callable[[], float] = time.process_time
) -> tuple[_Found, float]:
    """The result and its time by a clock, the median of a few where they are short."""
    taken: list[float] = []
    while True:
        start = clock()
        found = run()
        taken.append(clock() - start)
        if len(taken) == _REPEATS or (len(taken) >= least and sum(taken) > _ENOUGH):
            return found, median(taken)


def methods(rows: Iterable[Row]) -> dict[tuple[str, str], list[Row]]:
    """Rows by family and name."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        found.setdefault((row.family, row.name), []).append(row)
    return found


def cost(rows: Iterable[Row], wanted: float) -> float:
    """CPU time of one method's cheapest run from which on the peak force is good to ``wanted``;
    infinite where its costliest run is not."""
    costly = sorted(rows, key=lambda row: -row.seconds)
    good = takewhile(lambda row: row.errors["peak"] <= wanted, costly)
    return min((row.seconds for row in good), default=math.inf)


def cheapest(rows: Iterable[Row], family: str, wanted: float) -> tuple[str, float]:
    """The method of a family that costs least, and what; "none" and infinity where none attains
    what is wanted."""
    found = {name: cost(its, wanted) for (of, name), its in methods(rows).items() if of == family}
    best = min(found, key=found.__getitem__, default="none")
    return best, found.get(best, math.inf)


# By task and accuracy: how many times as long as the engine the best peer takes at least, where
# that is more than once; and the engine's own CPU time at most, in ms.
_AHEAD = {("experiment", 1e-6): 2.0, ("experiment", 1e-8): 2.0, ("dimer", 1e-6): 40.0,
          ("precompressed", 1e-8): 2.5}  # fmt: skip
_TIMES = {("dimer", 1e-6): 2.0, ("dimer", 1e-10): 12.0}


def goals(rows: Sequence[Row]) -> Iterator[Finding]:
    """What the engine is meant to attain on a task: beside the peers, on the dimer at all."""
    task = rows[0].task
    for wanted in WANTED:
        what, place = f"{task}, peak force to {wanted:.0e}", (task, wanted)
        ours, least = cheapest(rows, "compiled", wanted)
        peer, theirs = cheapest(rows, "peer", wanted)
        if place in _TIMES:
            yield Finding(f"{what}: CPU time of {ours} (ms)", 1e3 * least, high=_TIMES[place],
                          key=f"{task}_ms_{wanted:.0e}")  # fmt: skip
        if math.isfinite(theirs):
            yield Finding(f"{what}: the best peer, {peer}, over {ours}", theirs / least,
                          _AHEAD.get(place, 1.0), key=f"{task}_peer_{wanted:.0e}")  # fmt: skip
    if task == "dimer":
        whole = cost(methods(rows)["SciPy", "SciPy DOP853"], 1e-6)
        share = whole / cheapest(rows, "compiled", 1e-6)[1]
        each = min(row.ns for row in rows if row.ns is not None)
        name = "dimer, peak force to 1e-06: SciPy's DOP853 on the whole chain over the engine"
        yield Finding(name, share, low=500.0, key="scipy_ratio")
        name = "CPU time per bead and evaluation of its force, at best (ns)"
        yield Finding(name, each, key="evaluation_ns")
        name = "that over the time of a square root"
        yield Finding(name, each / square_root(), key="evaluation_over_root")


def square_root() -> float:
    """Nanoseconds that one takes here, in the cache: a force of Hertz's costs one at least."""
    values = np.linspace(1.0, 2.0, 4096)
    out = np.empty_like(values)
    _, seconds = timed(lambda: [np.sqrt(values, out=out) for _ in range(500)])
    return 1e9 * seconds / (500 * len(values))
