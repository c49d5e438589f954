"""What an accuracy costs, and the goals that are set for it.

A method's cost of an accuracy is that of its cheapest run from which on every costlier one attains
it as well: where kinks of [δ]_+^k meet a step by chance, single runs are better than they should.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from statistics import median
from typing import TypeVar

import numpy as np

from validation.lattice.simulate import COMPILED, simulate
from validation.report.table import Finding
from validation.scenes.chains import struck

BEST = COMPILED[0]  # the compiled scheme that is looked at most closely
OURS = f"{BEST}, window"

WANTED = 1e-6
"""Relative error of the peak force at which costs are compared."""

_ENOUGH, _REPEATS = 0.15, 7  # seconds and times, beyond which a run is not repeated
_SITES = (100, 1000, 10_000, 100_000)
_PACE = 1.2  # time per site, a little more than the pulse of equal beads takes


@dataclass(frozen=True)
class Row:
    """One run of one method, of the family "SciPy", "compiled" or "peer".

    setting : tolerance; of heyoka its largest step.
    errors : relative, by `validation.studies.accuracy.tasks.NUMBERS`.
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


def timed(run: Callable[[], _Found]) -> tuple[_Found, float]:
    """The result and its CPU time, the median of a few where they are short."""
    taken: list[float] = []
    while True:
        start = time.process_time()
        found = run()
        taken.append(time.process_time() - start)
        if len(taken) == _REPEATS or sum(taken) > _ENOUGH:
            return found, median(taken)


def methods(rows: Iterable[Row]) -> dict[tuple[str, str], list[Row]]:
    """Rows by family and name."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        found.setdefault((row.family, row.name), []).append(row)
    return found


def cost(rows: Iterable[Row], wanted: float = WANTED) -> float:
    """CPU time of one method's cheapest run from which on the peak force is good to ``wanted``;
    infinite where its costliest run is not."""
    costly = sorted(rows, key=lambda row: -row.seconds)
    good = takewhile(lambda row: row.errors["peak"] <= wanted, costly)
    return min((row.seconds for row in good), default=math.inf)


def costs(rows: Iterable[Row], wanted: float = WANTED) -> dict[tuple[str, str], float]:
    """`cost` by family and name."""
    return {method: cost(its, wanted) for method, its in methods(rows).items()}


def goals(rows: Iterable[Row]) -> Iterator[Finding]:
    """What the compiled window is meant to attain, where the dimer was run."""
    if not (dimer := [row for row in rows if row.task == "dimer"]):
        return
    seconds = costs(dimer)
    ours, theirs = seconds["compiled", OURS], seconds["SciPy", "SciPy DOP853"]
    peers = {name: taken for (family, name), taken in seconds.items() if family == "peer"}
    fine = (row for row in methods(dimer)["compiled", OURS] if row.setting == 1e-8)
    p, error = scaling(_SITES)
    yield from (
        Finding(f"{OURS}: CPU time for the peak force to {WANTED:g} (ms)", 1e3 * ours, high=5.0,
                key="window_ms"),
        Finding("SciPy's DOP853 on the whole chain takes so many times as long", theirs / ours,
                low=500.0, key="scipy_ratio"),
        *(Finding(f"the best peer, {best}, takes so many times as long", peers[best] / ours,
                  low=25.0, key="peer_ratio") for best in sorted(peers, key=peers.__getitem__)[:1]),
        Finding(f"{OURS}: CPU time per bead and evaluation of its force (ns)",
                min(row.ns or 0.0 for row in fine), high=1.5, key="evaluation_ns"),
        Finding(f"its cost per site ~ sites^p, equal beads, {_SITES[0]} to {_SITES[-1]} sites: p",
                p, high=0.1, error=error, key="site_exponent"),
    )  # fmt: skip


def scaling(sites: Sequence[int]) -> tuple[float, float]:
    """p of the windowed cost per site ~ sites^p, by least squares, and its standard error; what a
    run costs at its start makes p negative on short chains."""
    each = []
    for n in sites:
        scene = struck((1.0,), n, duration=_PACE * n, samples=2)
        _, seconds = timed(partial(simulate, scene, method=BEST, rtol=1e-6, window=True))
        each.append(seconds / n)
    (slope, _), covariance = np.polyfit(np.log(sites), np.log(each), 1, cov=True)
    return float(slope), float(np.sqrt(covariance[0, 0]))
