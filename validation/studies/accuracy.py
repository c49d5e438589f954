"""Speed against error: CPU time and error of integrators on fixed tasks.

A task is a pulse that is measured at one contact far away. The engine's methods run on the whole
chain and, where no wave comes back, on a window that moves with the pulse; SciPy's methods run on
the whole chain, each at several tolerances. The error is the largest relative one of arrival time,
peak force and FWHM, against the exact wave or the engine at its finest tolerance. The cost is CPU
time without compilation. `tests/benchmarks` measures other packages and checks the references by an
integrator of its own.

Tasks:

uniform, dimer: a chain of 560 beads, m1 = A = D = 1 and k = 3/2, whose first is struck to velocity
    1; measured 480 contacts further. The dimer's ω = 0.2733 is that of steel and PTFE.
exact: the uniform chain's solitary wave (`validation.waves.solver`), put on the lattice and
    measured 100 sites further, where arrival, peak and width are known from the wave itself.
experiment: the 2:1 chain of Porter et al. (2008), figure 2(d): 38 beads of steel and PTFE up to a
    steel wall. In units of the striker's mass and velocity and the first contact's stiffness.
precompressed: 200 equal beads under a static force of 1, measured 150 sites further.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from statistics import median
from typing import Any, TypeVar

import click
import numpy as np

from lwa.base.progress import Progress
from validation.lattice.run import IntegrationError, Run
from validation.lattice.simulate import COMPILED, simulate
from validation.pictures.panel import Curve, Panel
from validation.pulses.pulse import MeasureError, Pulse, highest_pulse
from validation.pulses.signals import Mapped
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.scenes import chains
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene
from validation.studies.theories import CASES, ladder, place
from validation.waves.solver import exact_wave

NUMBERS = ("arrival", "peak", "fwhm")
"""Attributes of a `Pulse` that are compared."""

WANTED = (1e-4, 1e-6, 1e-8, 1e-10)
"""Relative errors of the peak force at which costs are compared."""

FINEST = 1e-13
"""The smallest tolerance that `validation.simulate` takes."""

METHODS: Mapping[str, Sequence[float]] = {
    COMPILED[0]: tuple(10.0 ** -np.arange(3, 12.5, 0.5)),
    COMPILED[1]: tuple(10.0 ** -np.arange(3, 10.5, 0.5)),
    "SciPy DOP853": (1e-6, 1e-8, 1e-9, 1e-10),
    "SciPy RK45": (1e-6, 1e-7, 1e-8),
    "SciPy LSODA": (1e-6, 1e-7),
}
"""Tolerances of each method."""

_ENOUGH, _REPEATS = 0.15, 7  # seconds and times after which a run is not repeated
_AHEAD = 5.0  # least ratio of SciPy's cost to the engine's; 30 to 300 were measured


@dataclass(frozen=True)
class Task:
    """A scene whose highest pulse at one contact sensor is measured; its ``truth`` where known."""

    scene: Scene
    truth: Pulse | None = None

    @property
    def contact(self) -> int:
        """The sensor."""
        return self.scene.contact_sensors[0]

    def read(self, run: Run) -> Pulse:
        """The pulse of the dynamic force.

        Raises `validation.pulses.pulse.MeasureError` when the pulse is not wholly in the record.
        """
        load = self.scene.load[self.contact]
        return highest_pulse(Mapped(run.signal("contact", self.contact), lambda f: f - load))

    def errors(self, run: Run, truth: Pulse) -> dict[str, float]:
        """Relative errors by `NUMBERS`; ∞ without a pulse."""
        try:
            return relative_errors(self.read(run), truth)
        except MeasureError:
            return dict.fromkeys(NUMBERS, math.inf)


def relative_errors(pulse: Pulse, truth: Pulse) -> dict[str, float]:
    """Relative differences of two pulses, by `NUMBERS`."""
    return {name: abs(getattr(pulse, name) / getattr(truth, name) - 1) for name in NUMBERS}


def struck(omega: float, beads: int, contact: int, duration: float) -> Task:
    """A dimer chain, m1 = A = 1 and k = 3/2, whose first bead has velocity 1."""
    sensors: dict[str, Any] = {"contact_sensors": (contact,), "samples": 2}
    return Task(chains.struck((1.0, omega), beads, duration=duration, **sensors))


def exact(sites: int = 100) -> Task:
    """The solitary wave of equal beads, from bead 16 to the contact ``sites`` further."""
    start, wave = 16, exact_wave([1], 1.5)
    arrival, width = (sites + 0.5) / wave.c, wave.fwhm("force") / wave.c
    recorded = {"contact_sensors": (start + sites,), "duration": arrival + 10, "samples": 2}
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    return Task(wave.launched(start, sites, **recorded), truth)


def experiment() -> Task:
    """The 2:1 chain, struck at 1.37 m/s; contact of beads 33 and 34, before the wall answers."""
    si = chains.chain_scene(1.37, 38, (16, 34), 0.0, 1e-3, N=2)
    m, A = si.masses[0], si.stiffnesses[0]
    scene = Scene(
        masses=tuple(mass / m for mass in si.masses),
        stiffnesses=tuple(stiffness / A for stiffness in si.stiffnesses),
        wall=(si.wall or 0.0) / A,
        k=si.k,
        velocities=(1.0,),
        contact_sensors=(32,),
        duration=172.0,
        samples=2,
    )
    return Task(scene)


def precompressed(beads: int = 200, sites: int = 150) -> Task:
    """Equal beads under a static force of 1; from the first to the contact ``sites`` further."""
    scene = Scene(
        masses=(1.0,) * beads,
        stiffnesses=(1.0,) * (beads - 1),
        wall=1.0,
        precompression=1.0,
        k=1.5,
        velocities=(1.0,),
        contact_sensors=(sites,),
        duration=0.814 * sites + 10,  # the pulse takes 0.814 units of time a site
        samples=2,
    )
    return Task(scene)


TASKS: Mapping[str, Callable[[], Task]] = {
    "uniform": partial(struck, 1.0, 560, 480, 582.0),
    "dimer": partial(struck, 0.2733, 560, 480, 510.0),
    "exact": exact,
    "experiment": experiment,
    "precompressed": precompressed,
}
THEORY = "theory"
NAMES = (*TASKS, THEORY)
"""Names of all tasks, the ladder of theories among them."""


@dataclass(frozen=True)
class Row:
    """One run of a method: relative errors by `NUMBERS`, infinite without a pulse; CPU seconds."""

    task: str
    method: str
    window: bool
    setting: float
    errors: Mapping[str, float]
    seconds: float

    @property
    def name(self) -> str:
        """Method, and "window" where the run had one."""
        return self.method + (", window" if self.window else "")

    @property
    def error(self) -> float:
        """The largest of the errors."""
        return max(self.errors.values())


_Found = TypeVar("_Found")


def timed(
    run: Callable[[], _Found], clock: Callable[[], float] = time.process_time
) -> tuple[_Found, float]:
    """Result of a run, and the median of its times, repeated where they are short."""
    taken: list[float] = []
    while True:
        start = clock()
        found = run()
        taken.append(clock() - start)
        if len(taken) == _REPEATS or sum(taken) > _ENOUGH:
            return found, median(taken)


def cost(rows: Iterable[Row], wanted: float) -> float:
    """CPU time of a method's cheapest run from which on the peak force is good to ``wanted``.

    Single runs may be good by chance, where steps meet openings of contacts: every costlier run
    must be as good. Infinite where the costliest is not.
    """
    costly = sorted(rows, key=lambda row: -row.seconds)
    good = takewhile(lambda row: row.errors["peak"] <= wanted, costly)
    return min((row.seconds for row in good), default=math.inf)


def runs(name: str, task: Task, truth: Pulse) -> Iterator[Row]:
    """Rows of a task, for each method and tolerance."""
    for method, tolerances in METHODS.items():
        for window in (False, True) if method in COMPILED and task.scene.wall is None else (False,):
            options: dict[str, Any] = {"method": method.split()[-1], "window": window}
            if method in COMPILED:
                simulate(task.scene, rtol=1e-3, **options)  # compiles
            for rtol in tolerances:
                run_once = partial(simulate, task.scene, rtol=rtol, atol=rtol, **options)
                with suppress(IntegrationError):  # two windows differ
                    run, seconds = timed(run_once)
                    errors = task.errors(run, truth)
                    yield Row(name, method, window, rtol, errors, seconds)


def by_name(rows: Iterable[Row]) -> dict[str, list[Row]]:
    """Rows by method and window."""
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(row.name, []).append(row)
    return found


def goals(rows: Sequence[Row]) -> Iterator[Finding]:
    """Ratios within one run: the best of SciPy's costs over the engine's, on the whole chain."""
    task = rows[0].task
    for wanted in WANTED:
        costs = {name: cost(its, wanted) for name, its in by_name(rows).items()}
        ours = min(costs[name] for name in COMPILED if name in costs)
        best = min((n for n in METHODS if n not in COMPILED and n in costs), key=costs.__getitem__)
        if math.isfinite(costs[best]):
            name = f"{task}, peak force to {wanted:.0e}: {best} over the engine"
            yield Finding(name, costs[best] / ours, _AHEAD, key=f"{task}_scipy_{wanted:.0e}")


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.3g}"


_RUNS = ("task", "method", "setting", "error", *(f"{name}_error" for name in NUMBERS), "seconds")
_COSTS = (
    Column("task"),
    Column("method", "CPU time (ms) for the peak force to"),
    *(Column(f"seconds_{wanted:.0e}", f"{wanted:.0e}", format=_ms) for wanted in WANTED),
)
_NOTE = "CPU time without compilation, on this machine; - where no run attains it from there on."


def _costs(rows: Sequence[Row]) -> list[tuple[Any, ...]]:
    """Name and costs at `WANTED` of each method, None where not attained; the best first."""
    found: list[tuple[Any, ...]] = [
        (name, *(cost(its, wanted) for wanted in WANTED)) for name, its in by_name(rows).items()
    ]
    found.sort(key=lambda line: line[:0:-1])  # by the finest, where attained
    return [tuple(None if part == math.inf else part for part in line) for line in found]


def _panel(task: str, rows: Sequence[Row]) -> Panel:
    """CPU time over error: a colour for each method, other marks and solid lines with a window."""
    curves = []
    for name, its in by_name(rows).items():
        place = list(METHODS).index(its[0].method)
        style = f"C{place}" + ("x+*12"[place] + "-" if its[0].window else "os^v<"[place] + ":")
        seen = [row for row in its if math.isfinite(row.error)]
        points = [row.error for row in seen], [row.seconds for row in seen]
        curves.append(Curve.of(name, *points, style=style))
    label = "largest relative error of arrival, peak, FWHM"
    return Panel(label, "CPU time (s)", tuple(curves), "xy", task)


@study(option("--task", "names", multiple=True, type=click.Choice(NAMES), says="Only this task."))
def accuracy(names: Collection[str] = (), progress: Progress[str] = iter) -> Report:
    """Speed against error: integrators on fixed tasks, theories against true waves. Three minutes.

    names: tasks to run, by default all; raises `lwa.InputError` for a name beside `NAMES`. JSON:
    ``rows``, ``costs`` by method, ``references``, ``theories``, and the goals as ``findings``.
    """
    wanted = {one_of(name, NAMES, "task") for name in names} or set(NAMES)
    rows: dict[str, list[Row]] = {}
    references: list[tuple[Any, ...]] = []
    theories: tuple[Report, ...] = ()
    for name in progress([name for name in NAMES if name in wanted]):
        if name == THEORY:
            theories = (ladder([place(*case) for case in CASES]),)
            continue
        task = TASKS[name]()
        truth = task.truth or task.read(simulate(task.scene, rtol=FINEST))
        rows[name] = list(runs(name, task, truth))
        references.append((name, *(getattr(truth, number) for number in NUMBERS)))
    heads = {
        task: f"{task}: arrival {arrival:.12g}, peak {peak:.12g}, FWHM {fwhm:.12g}"
        for task, arrival, peak, fwhm in references
    }
    cells = tuple(
        (r.task, r.name, r.setting, r.error, *r.errors.values(), r.seconds)
        for its in rows.values()
        for r in its
    )
    spent = tuple((task, *line) for task, its in rows.items() for line in _costs(its))
    return Report(
        "Speed against error",
        (
            Table(tuple(map(Column, _RUNS)), cells, "rows"),
            Table(_COSTS, spent, "costs", note=_NOTE, by="task", heads=heads),
            Table(tuple(map(Column, ("task", *NUMBERS))), tuple(references), "references"),
        ),
        tuple(goal for its in rows.values() for goal in goals(its)),
        tuple(_panel(task, its) for task, its in rows.items()),
        data={name: x for part in theories for name, x in part.data.items()},
        parts=theories,
    )
