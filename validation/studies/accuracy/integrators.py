"""Speed against error: what an integrator costs, and how far the pulse is off, on fixed tasks.

Tasks: `validation.studies.accuracy.tasks`. Methods: SciPy's steppers and the compiled splittings,
on the whole chain and on a window that moves with the pulse, and general integrators of other
packages on the whole chain (`validation.studies.accuracy.peers`), each at several tolerances or
steps. The error is the largest relative one of arrival time, peak force and FWHM, against
`validation.studies.accuracy.reference`. The cost is CPU time without compilation, the median of a
few runs where they are short.

A method's cost of an accuracy is that of its cheapest run from which on every costlier one attains
it as well: where kinks of [δ]_+^k meet a step by chance, single runs are better than they should.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from statistics import median
from typing import TypeVar

import numpy as np
from scipy import integrate as scipy

from validation.lattice.equations import Array, Motion
from validation.lattice.simulate import COMPILED, simulate
from validation.report.result import Finding
from validation.studies.accuracy.peers import missing, packages, prepared
from validation.studies.accuracy.reference import Reference, integrate, reference
from validation.studies.accuracy.tasks import TASKS, Task, errors, known, struck
from validation.studies.accuracy.theories import Ladder, ladder

BEST = COMPILED[0]
"""The compiled scheme that is looked at most closely."""

_SCIPY: Mapping[tuple[str, bool], Sequence[float]] = {
    ("DOP853", False): (1e-6, 1e-7, 1e-8, 3e-9, 1e-9),
    ("RK45", False): (1e-7, 1e-8, 1e-9),
    ("LSODA", False): (1e-6, 1e-7),
    ("DOP853", True): (1e-6, 1e-7, 1e-8, 1e-9),
    ("RK45", True): (1e-7, 1e-8, 1e-9),
    ("LSODA", True): (1e-6, 1e-7),
}
"""(method, window) → tolerances."""

_SPLITTINGS: Mapping[tuple[str, bool], Sequence[float]] = {
    (BEST, True): (1e-5, 3e-6, 2e-6, 1e-6, 1e-7, 1e-8, 1e-10),
    (BEST, False): (1e-6, 1e-8, 1e-10),
    **{(name, True): (1e-5, 1e-6, 1e-8) for name in COMPILED if name not in (BEST, "Verlet")},
    ("Verlet", True): (1e-5, 1e-6),
    ("Verlet", False): (1e-5,),
}
"""(scheme, window) → the error that the step aims at."""

_PEERS = {
    "CyRK": (3e-7, 2e-7, 1e-7, 3e-8, 1e-8, 1e-9),
    "diffrax": (1e-7, 1e-8, 1e-9),
    "heyoka": (0.03, 0.01),
}
"""Tolerances; heyoka's largest steps."""

THEORY = "theory"
NAMES = (*TASKS, THEORY)
"""Of all tasks."""

_ENOUGH = 0.15
"""Seconds, beyond which a run is not repeated."""
_REPEATS = 7

WANTED = 1e-6
"""Relative error of the peak force at which costs are compared."""
_GOAL_TASK = "dimer"
_SITES = (100, 1000, 10_000, 100_000)
_PACE = 1.2
"""Time per site, a little more than the pulse of equal beads takes."""


@dataclass(frozen=True)
class Row:
    """One run of one method.

    family : "SciPy", "compiled" or "peer".
    setting : tolerance; of heyoka its largest step.
    errors : relative, by `validation.studies.accuracy.tasks.NUMBERS`.
    seconds : of CPU time, without compilation.
    step : mean step, and ns: seconds per bead and evaluation of its force, of compiled runs.
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


@dataclass(frozen=True)
class Accuracy:
    """Rows and references of the tasks that were run, the goals, peers that are missing, and the
    ladder of theories."""

    rows: tuple[Row, ...]
    references: tuple[Reference, ...]
    goals: tuple[Finding, ...]
    absent: tuple[str, ...]
    theories: Ladder | None = None


def accuracy(
    names: Collection[str] = (),
    progress: Callable[[list[str]], Iterable[str]] = iter,
    *,
    peers: bool = True,
) -> Accuracy:
    """Run the tasks of these names, all by default; ``progress`` shows how far (as `tqdm.tqdm`).

    Goals are set for the dimer, and there are none without it. The task "theory" is
    `validation.studies.accuracy.theories`. ``peers`` False leaves the other packages' integrators
    out.

    Raises `validation.scenes.checks.SceneError` for a name that is not one of `NAMES`, and
    `validation.studies.accuracy.peers.PeerError` for a peer that is missing where CI is set.
    """
    wanted = {known(name, NAMES) for name in names} or set(NAMES)
    rows: list[Row] = []
    references: list[Reference] = []
    theories: Ladder | None = None
    absent = missing() if peers and wanted != {THEORY} else ()
    for name in progress([name for name in NAMES if name in wanted]):
        if name == THEORY:
            theories = ladder()
            continue
        task = TASKS[name]()
        references.append(reference(name, task))
        rows += _compared(name, task, references[-1], absent if peers else packages())
    goals = tuple(_goals(rows)) if _GOAL_TASK in wanted else ()
    return Accuracy(tuple(rows), tuple(references), goals, absent, theories)


def _compared(name: str, task: Task, truth: Reference, absent: Collection[str]) -> Iterator[Row]:
    """All methods at one task."""

    def row(
        family: str, method: str, window: bool, setting: float, force: Array, seconds: float
    ) -> Row:
        off = errors(task.read(force), truth.pulse)
        return Row(name, family, method, window, setting, off, seconds)

    for (method, window), tolerances in _SCIPY.items():
        stepper = getattr(scipy, method)
        for rtol in tolerances if task.windowed or not window else ():
            force, seconds = _timed(partial(integrate, task, stepper, rtol, window=window))
            yield row("SciPy", f"SciPy {method}", window, rtol, force, seconds)
    for (method, window), aims in _splittings(task).items():
        simulated = partial(simulate, task.scene, method=method, window=window)
        simulated(rtol=1e-3)  # compiles
        for rtol in aims:
            run, seconds = _timed(partial(simulated, rtol=rtol))
            force = run.contact_force[0][-len(task.times) :]
            found = row("compiled", method, window, rtol, force, seconds)
            yield replace(found, step=run.step, ns=1e9 * seconds / run.bead_evaluations)
    motion = Motion(task.scene)
    for peer, solve in prepared(task, absent):
        for setting in _PEERS[peer.package]:
            y, seconds = _timed(partial(solve, setting))
            force = motion.force(motion.compression(y))[task.contact]
            yield row("peer", peer.name, False, setting, force, seconds)


def _splittings(task: Task) -> dict[tuple[str, bool], Sequence[float]]:
    """`_SPLITTINGS`, on the whole chain where a window is not allowed."""
    if task.windowed:
        return dict(_SPLITTINGS)
    whole: dict[tuple[str, bool], Sequence[float]] = {}
    for (method, _), aims in _SPLITTINGS.items():
        whole.setdefault((method, False), aims)
    return whole


_Found = TypeVar("_Found")


def _timed(run: Callable[[], _Found]) -> tuple[_Found, float]:
    """The result and its CPU time, the median of a few where they are short."""
    taken: list[float] = []
    while True:
        start = time.process_time()
        found = run()
        taken.append(time.process_time() - start)
        if len(taken) == _REPEATS or sum(taken) > _ENOUGH:
            return found, median(taken)


def cost(rows: Iterable[Row], wanted: float = WANTED) -> float:
    """CPU time of one method's cheapest run from which on the peak force is good to ``wanted``.

    Infinite where its costliest run is not.
    """
    seconds = float("inf")
    for row in sorted(rows, key=lambda row: -row.seconds):
        if row.errors["peak"] > wanted:
            break
        seconds = row.seconds
    return seconds


def costs(rows: Iterable[Row], wanted: float = WANTED) -> dict[tuple[str, str], float]:
    """`cost` by family and name."""
    methods: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        methods.setdefault((row.family, row.name), []).append(row)
    return {method: cost(its, wanted) for method, its in methods.items()}


def _goals(rows: Iterable[Row]) -> Iterator[Finding]:
    """What the compiled window is meant to attain, at the dimer and over the chain's length."""
    found = [row for row in rows if row.task == _GOAL_TASK]
    seconds = costs(found)
    ours = seconds["compiled", f"{BEST}, window"]
    yield Finding(
        f"{BEST}, window: CPU time for the peak force to {WANTED:g} (ms)", 1e3 * ours,
        high=5.0, key="window_ms",
    )  # fmt: skip
    yield Finding(
        "SciPy's DOP853 on the whole chain takes so many times as long",
        seconds["SciPy", "SciPy DOP853"] / ours, low=500.0, key="scipy_ratio",
    )  # fmt: skip
    peers = {name: taken for (family, name), taken in seconds.items() if family == "peer"}
    if peers:
        best = min(peers, key=lambda name: peers[name])
        yield Finding(
            f"the best peer, {best}, takes so many times as long", peers[best] / ours,
            low=25.0, key="peer_ratio",
        )  # fmt: skip
    spent = [row for row in found if row.name == f"{BEST}, window" and row.setting == 1e-8]
    yield Finding(
        f"{BEST}, window: CPU time per bead and evaluation of its force (ns)",
        min(row.ns or 0.0 for row in spent), high=1.5, key="evaluation_ns",
    )  # fmt: skip
    slope, error = scaling(_SITES)
    yield Finding(
        f"its cost per site ~ sites^p, equal beads, {_SITES[0]} to {_SITES[-1]} sites: p", slope,
        high=0.1, error=error, key="site_exponent",
    )  # fmt: skip


def scaling(sites: Sequence[int]) -> tuple[float, float]:
    """p of the windowed cost per site ~ sites^p, by least squares, and its standard error.

    At least three chains; what a run costs at its start makes p negative on short ones.
    """
    each = []
    for n in sites:
        scene = replace(struck(1.0, n, 0, 0.0, _PACE * n).scene, contact_sensors=(), samples=2)
        _, seconds = _timed(partial(simulate, scene, method=BEST, rtol=1e-6, window=True))
        each.append(seconds / n)
    (slope, _), covariance = np.polyfit(np.log(sites), np.log(each), 1, cov=True)
    return float(slope), float(np.sqrt(covariance[0, 0]))
