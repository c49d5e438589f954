"""Many chains at once: the paper's 38 beads with masses of their own each, over threads.

Every chain is the task "experiment" with masses that vary at random. The engine runs them by
`validation.simulate_many`, a peer over as many threads, each at the coarsest setting at which the
median chain's peak force is good to `ERROR`, against the engine at its finest. Times are wall times
a chain, medians of a few.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from time import perf_counter

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.simulate import COMPILED, simulate_many
from validation.lattice.threads import cores, threads
from validation.report.table import Finding
from validation.studies.accuracy.costs import timed
from validation.studies.accuracy.peers import Solve, prepared
from validation.studies.accuracy.reference import FINEST
from validation.studies.accuracy.tasks import TASKS, Task, settings

ERROR = 1e-6
"""Of the peak force, in the median."""

_CHAINS, _SPREAD = 100, 0.1  # and the standard deviation of a mass, relative
_REPEATS = 3  # at least


@dataclass(frozen=True)
class Many:
    """What a method takes.

    error : median one of the peak force.
    seconds : a chain, over all cores; alone : over one thread.
    """

    method: str
    setting: float
    error: float
    seconds: float
    alone: float

    @property
    def share(self) -> float:
        """Of the ideal gain by threads."""
        return self.alone / self.seconds / cores()


def chains(count: int = _CHAINS, seed: int = 38) -> list[Task]:
    """The tasks."""
    task, random = TASKS["experiment"](), np.random.default_rng(seed)
    for_each = random.lognormal(0.0, _SPREAD, (count, task.scene.size)) * task.scene.masses
    return [replace(task, scene=replace(task.scene, masses=tuple(row))) for row in for_each]


Run = Callable[[float, int], list[Array]]
"""From a setting and the number of threads to the force of each chain's contact."""


def many() -> list[Many]:
    """The engine, and the peers that are there."""
    tasks = chains()
    runs = {COMPILED[0]: _engine(tasks)}
    for peer, solve in prepared(tasks[0]):
        runs[peer.name] = _threaded(solve, tasks)
    truths = _peaks(tasks, runs[COMPILED[0]](FINEST, cores()))
    return [_cheapest(name, run, tasks, truths) for name, run in runs.items()]


def together(found: Sequence[Many]) -> Iterator[Finding]:
    """What the engine is meant to attain with many chains."""
    if not found:
        return
    engine, *others = found
    yield Finding(f"many chains: gain of {engine.method} by threads over the ideal one",
                  engine.share, low=0.9, key="many_share")  # fmt: skip
    if good := [m for m in others if m.error <= ERROR]:
        best = min(good, key=lambda m: m.seconds)
        yield Finding(f"many chains: the best peer, {best.method}, over {engine.method}",
                      best.seconds / engine.seconds, low=1.0, key="many_peer")  # fmt: skip


def _engine(tasks: Sequence[Task]) -> Run:
    def run(setting: float, workers: int) -> list[Array]:
        runs = simulate_many((t.scene for t in tasks), workers=workers, rtol=setting)
        return [task.force(run) for task, run in zip(tasks, runs, strict=True)]

    return run


def _threaded(solve: Solve, tasks: Sequence[Task]) -> Run:
    def run(setting: float, workers: int) -> list[Array]:
        with threads(workers) as pool:
            return list(pool.map(lambda task: task.force_at(solve(setting, task)), tasks))

    return run


def _peaks(tasks: Sequence[Task], forces: Sequence[Array]) -> Array:
    return np.array([t.read(force).peak for t, force in zip(tasks, forces, strict=True)])


def _cheapest(method: str, run: Run, tasks: Sequence[Task], truths: Array) -> Many:
    """At the coarsest setting that is good enough, or at the finest."""
    for setting in settings(1e-5, 1e-9):
        error = float(np.median(np.abs(_peaks(tasks, run(setting, 1)) / truths - 1)))
        if error <= ERROR:
            break
    together, alone = (timed(partial(run, setting, n), _REPEATS, perf_counter)[1] / len(tasks)
                       for n in (cores(), 1))  # fmt: skip
    return Many(method, setting, error, together, alone)
