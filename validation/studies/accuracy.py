"""Speed against error: CPU time and error of integrators on fixed tasks.

A task is a pulse that is measured at one contact far away. The engine's methods and SciPy's run at
several tolerances each. The error is the largest relative one of arrival time, peak force and FWHM,
against the exact wave or the engine at its finest tolerance. The cost is CPU time without
compilation. `tests/benchmarks` measures another package.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import takewhile
from statistics import median
from typing import Any, TypeVar

import click
import numpy as np
import sympy as sp

from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import COMPILED, simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import MeasureError, Pulse, highest_pulse
from validation.pulses.sensors import READINGS, readings, tracks
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes import chains
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene
from validation.studies.theories import SOLITARY, STRUCK_CHAIN, ladder, place
from validation.waves.solver import exact_wave

WANTED = (1e-4, 1e-6, 1e-8, 1e-10)
"""Relative errors of the peak force at which costs are compared."""

FINEST = 1e-13
"""The smallest tolerance that `validation.simulate` takes."""

METHODS: Mapping[str, Sequence[float]] = {
    # down to rounding; SciPy's methods at few tolerances, as their runs are long
    COMPILED[0]: tuple(10.0 ** -np.arange(3, 12.5, 0.5)),
    COMPILED[1]: tuple(10.0 ** -np.arange(3, 10.5, 0.5)),
    "SciPy DOP853": (1e-6, 1e-8, 1e-9, 1e-10),
    "SciPy RK45": (1e-6, 1e-7, 1e-8),
    "SciPy LSODA": (1e-6, 1e-7),
}
"""Tolerances of each method."""

_ENOUGH, _REPEATS = 0.15, 7  # seconds and times after which a run is not repeated


@dataclass(frozen=True)
class Task:
    """A scene with one contact sensor, at which the highest pulse is measured.

    truth : the exact pulse, if it is known without a simulation.
    """

    scene: Scene
    truth: Pulse | None = None

    def read(self, run: Run) -> Pulse:
        """Return the highest pulse of the dynamic force at the sensor.

        Raises `validation.pulses.pulse.MeasureError` when the pulse is not wholly in the record.
        """
        (track,) = tracks(run)
        return highest_pulse(track.force)


def relative_errors(pulse: Pulse, truth: Pulse) -> dict[str, float]:
    """Return relative errors |pulse/truth - 1| of arrival, peak force and FWHM (`READINGS`)."""
    return {name: abs(getattr(pulse, name) / getattr(truth, name) - 1) for name in READINGS}


def struck_chain(omega: float, beads: int, contact: int, duration: float) -> Task:
    """A dimer chain, m1 = A = 1 and k = 3/2, whose first bead has velocity 1.

    omega : m2/m1. contact : index of the contact that is measured.
    """
    sensors: dict[str, Any] = {"contact_sensors": (contact,), "samples": 2}
    return Task(chains.struck((1.0, omega), beads, duration=duration, **sensors))


def solitary_wave(sites: int = 100) -> Task:
    """The solitary wave of equal beads, measured ``sites`` beyond its initial place, bead 16.

    The true arrival, peak and width follow from the exact wave.
    """
    start, wave = 16, exact_wave([1], 1.5)
    # a contact lies half a site behind its bead
    arrival, width = (sites + 0.5) / wave.c, wave.fwhm("force") / wave.c
    recorded = {"contact_sensors": (start + sites,), "duration": arrival + 10, "samples": 2}
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    return Task(wave.launched(start, sites, **recorded), truth)


def experiment() -> Task:
    """The 2:1 chain of Porter et al. (2008), figure 2(d): steel and PTFE up to a steel wall.

    Units are the striker's mass and velocity and the first contact's stiffness. The contact of
    beads 33 and 34 is measured, before the wall reflects the pulse.
    """
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


def precompressed() -> Task:
    """200 equal beads under a static force of 1 against a wall, measured at contact 150."""
    loose = struck_chain(1.0, 200, 150, 132.1).scene  # the pulse takes 0.814 units of time a site
    return Task(replace(loose, wall=1.0, precompression=1.0))


TASKS: Mapping[str, Callable[[], Task]] = {
    "uniform": partial(struck_chain, 1.0, 560, 480, 582.0),
    "dimer": partial(struck_chain, 0.2733, 560, 480, 510.0),  # ω of steel and PTFE
    "exact": solitary_wave,
    "experiment": experiment,
    "precompressed": precompressed,
}
THEORY = "theory"
NAMES = (*TASKS, THEORY)
"""Names of all tasks, the ladder of theories among them."""

# Mass ratios of the Hertz dimer's solitary waves are from `validation.waves.resonances`.
CASES = tuple(
    (sp.Rational(k), sp.Rational(omega), kind)
    for exponents, ratios, kind in (
        (("1.1", "5/4", "3/2", "2", "3"), ("1",), SOLITARY),
        (("3/2",), ("0.3428457811", "0.1547515139", "0.0901277691"), SOLITARY),
        (("3/2",), ("0.01", "0.05", "0.2", "0.8", "0.9"), STRUCK_CHAIN),
        (("5/4", "2"), ("0.05", "0.2", "0.8"), STRUCK_CHAIN),
    )
    for k in exponents
    for omega in ratios
)
"""k, ω and the kind of truth of each place of the ladder of theories."""


T = TypeVar("T")


def timed(run: Callable[[], T]) -> tuple[T, float]:
    """Call ``run``; return the result and the CPU time in seconds, for short runs a median."""
    taken: list[float] = []
    while True:
        start = time.process_time()
        result = run()
        taken.append(time.process_time() - start)
        if len(taken) == _REPEATS or sum(taken) > _ENOUGH:
            return result, median(taken)


def cost(runs: Iterable[tuple[float, float]], wanted: float) -> float:
    """Return the least CPU time at which a method's peak force errs by ``wanted`` at most; else ∞.

    runs : relative error of the peak force and CPU time of each run of one method. All costlier
    runs must be as accurate: a single run may be accurate by chance, when its steps happen to end
    where contacts open.
    """
    costly = sorted(runs, key=lambda run: -run[1])
    good = takewhile(lambda run: run[0] <= wanted, costly)
    return min((seconds for _, seconds in good), default=math.inf)


def timings(
    task: Task, truth: Pulse, method: str, tolerances: Iterable[float]
) -> Iterator[tuple[float, dict[str, float], float]]:
    """Run a task by one method; yield each tolerance with the run's errors and CPU time in seconds.

    The errors are relative, by the names `READINGS`; ∞ if the run shows no pulse.
    """
    integrator = method.split()[-1]
    if method in COMPILED:
        simulate(task.scene, rtol=1e-3, method=integrator)  # compiles
    for rtol in tolerances:
        once = partial(simulate, task.scene, rtol=rtol, atol=rtol, method=integrator)
        run, seconds = timed(once)
        errors = dict.fromkeys(READINGS, math.inf)
        with suppress(MeasureError):
            errors = relative_errors(task.read(run), truth)
        yield rtol, errors, seconds


_RUNS = ("task", "method", "setting", "error", *(f"{name}_error" for name in READINGS), "seconds")
_COSTS = (
    Column("task"),
    Column("method", "CPU time (ms) for the peak force to"),
    *(
        Column(f"seconds_{error:.0e}", f"{error:.0e}", format=lambda s: f"{1e3 * s:.3g}")
        for error in WANTED
    ),
)
_NOTE = "CPU time without compilation, on this machine; - where no run attains it from there on."
_AXES = "largest relative error of arrival, peak, FWHM", "CPU time (s)"


_TASKS = click.Choice(NAMES)


@study(option("--task", "names", multiple=True, type=_TASKS, says="Only this task; repeatable."))
def accuracy(
    names: Collection[str] = (),
    methods: Mapping[str, Sequence[float]] = METHODS,
    progress: Progress[str] = iter,
) -> Report:
    """Speed against error: integrators on fixed tasks, theories against true waves (three minutes).

    names: tasks to run, by default all; raises `lwa.InputError` for a name beside `NAMES`.
    methods: tolerances of each integrator. JSON: ``rows``, a run each, ``costs`` by method,
    ``references``, the true arrival, peak and fwhm, and ``theories``.
    """
    wanted = {one_of(name, NAMES, "task") for name in names} or set(NAMES)
    theories = Report("")
    rows: list[tuple[Any, ...]] = []
    costs: list[tuple[Any, ...]] = []
    references: list[tuple[Any, ...]] = []
    panels: list[Panel] = []
    for name in progress([name for name in NAMES if name in wanted]):
        if name == THEORY:
            theories = ladder([place(*case) for case in CASES])
            continue
        curves, spent = [], []
        task = TASKS[name]()
        truth = task.truth or task.read(simulate(task.scene, rtol=FINEST))
        references.append((name, *readings(truth).values()))
        for method, tolerances in methods.items():
            found = [*timings(task, truth, method, tolerances)]
            rows += [(name, method, r, max(e.values()), *e.values(), s) for r, e, s in found]
            peaks = [(errors["peak"], seconds) for _, errors, seconds in found]
            spent.append((name, method, *(cost(peaks, error) for error in WANTED)))
            largest = [max(errors.values()) for _, errors, _ in found]
            curves.append(Curve(method, largest, [seconds for *_, seconds in found]))
        # the cheapest at the smallest error first; methods that do not attain it last
        costs += sorted(spent, key=lambda line: line[:1:-1])
        panels.append(Panel(*_AXES, tuple(curves), "xy", name))
    return Report(
        "Speed against error",
        (
            Table(tuple(map(Column, _RUNS)), tuple(rows), "rows"),
            Table(_COSTS, tuple(costs), "costs", note=_NOTE, by="task"),
            *theories.tables,
            Table(tuple(map(Column, ("task", *READINGS))), tuple(references), "references"),
        ),
        panels=(*panels, *theories.panels),
        data=theories.data,
    )
