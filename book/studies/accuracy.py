"""Speed against error: integrators on fixed tasks.

A task is a pulse that is measured at one contact far away. The engine's methods and SciPy's run at
several tolerances each. The error is the largest relative one of arrival time, peak force and FWHM,
against the exact wave or the engine at its finest tolerance. The cost is CPU time without
compilation. `tests/benchmarks` measures another package.

    python book/studies/accuracy.py --task uniform
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

from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import COMPILED, simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import (
    READINGS,
    MeasureError,
    Pulse,
    highest_pulse,
    readings,
)
from validation.pulses.sensors import tracks
from validation.report.study import Report, option, study
from validation.report.table import Column, Table
from validation.scenes import chains
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene
from validation.studies.paper import recorded_chain
from validation.waves.profile import ExactWave
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

_ENOUGH = 0.15  # seconds of runs after which a run is not repeated
_REPEATS = 7  # runs of which the median counts, at most


@dataclass(frozen=True)
class Task:
    """A scene with one contact sensor, at which the highest pulse is measured.

    Parameters
    ----------
    scene : Scene
        The scene.
    truth : Pulse, optional
        The exact pulse, if it is known without a simulation.
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
    return {
        name: abs(getattr(pulse, name) / getattr(truth, name) - 1) for name in READINGS
    }


def struck_chain(omega: float, beads: int, contact: int, duration: float) -> Task:
    """A dimer chain of spheres, m1 = A = 1, whose first bead has velocity 1, seen at a contact."""
    masses = 1.0, omega
    scene = chains.struck(
        masses, beads, duration=duration, contact_sensors=(contact,), samples=2
    )
    return Task(scene)


def solitary_wave(sites: int = 100) -> Task:
    """The solitary wave of equal beads, measured ``sites`` beyond its initial place, bead 16.

    The true arrival, peak and width follow from the exact wave.
    """
    wave = exact_wave([1], 1.5)
    start = 16
    arrival = (sites + 0.5) / wave.c  # a contact lies half a site behind its bead
    width = wave.fwhm("force") / wave.c
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    scene = launched(
        wave,
        start,
        sites,
        contact_sensors=(start + sites,),
        duration=arrival + 10,
        samples=2,
    )
    return Task(scene, truth)


def launched(wave: ExactWave, start: int, sites: int, **rest: Any) -> Scene:
    """Return a scene of a chain that carries a wave, centered at bead ``start`` at time 0.

    Parameters
    ----------
    wave : ExactWave
        The wave.
    start, sites : int
        Sites before the wave's center, and the distance that the wave is to run.
    **rest
        Further fields of the scene.
    """
    bead = np.arange(2 * start + sites) - start
    contact = bead[:-1] + 0.5
    is_first = bead % 2 == 0
    ahead_of_first, ahead_of_second = (wave.strain(contact, kind) for kind in (0, 1))
    strain = np.where(is_first[:-1], ahead_of_first, ahead_of_second)
    return Scene(
        masses=np.where(is_first, *wave.masses),
        stiffnesses=(1.0,) * len(contact),
        # Beads behind a contact have moved by the compressions of all contacts ahead.
        displacements=np.append(np.cumsum(strain[::-1])[::-1], 0.0),
        velocities=np.where(is_first, wave.velocity(bead, 0), wave.velocity(bead, 1)),
        k=wave.k,
        **rest,
    )


def experiment() -> Task:
    """The 2:1 chain of Porter et al. (2008), figure 2(d): steel and PTFE up to a steel wall.

    Units are the striker's mass and velocity and the first contact's stiffness. The contact of
    beads 33 and 34 is measured, before the wall reflects the pulse.
    """
    si = recorded_chain((16, 34), N=2)
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
    # the pulse takes 0.814 units of time a site
    loose = struck_chain(1.0, 200, 150, 132.1).scene
    return Task(replace(loose, wall=1.0, precompression=1.0))


# Durations: until the pulse has passed the sensor.
TASKS: Mapping[str, Callable[[], Task]] = {
    "uniform": partial(struck_chain, 1.0, 560, 480, 582.0),
    "dimer": partial(struck_chain, 0.2733, 560, 480, 510.0),  # ω of steel and PTFE
    "exact": solitary_wave,
    "experiment": experiment,
    "precompressed": precompressed,
}
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

    All costlier runs must be as accurate: a single run may be accurate by chance, when its steps
    happen to end where contacts open.

    Parameters
    ----------
    runs : iterable of (float, float)
        Relative error of the peak force and CPU time of each run of one method.
    wanted : float
        Relative error.
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
        once = partial(simulate, task.scene, rtol=rtol, method=integrator)
        run, seconds = timed(once)
        errors = dict.fromkeys(READINGS, math.inf)
        with suppress(MeasureError):
            errors = relative_errors(task.read(run), truth)
        yield rtol, errors, seconds


_RUNS = (
    Column("task"),
    Column("method"),
    Column("setting"),
    Column("error"),
    *(Column(f"{name}_error") for name in READINGS),
    Column("seconds"),
)
_COSTS = (
    Column("task"),
    Column("method", "CPU time (ms) for the peak force to"),
    *(Column(f"seconds_{error:.0e}", f"{error:.0e}", ".3g") for error in WANTED),
)
_NOTE = "CPU time without compilation, on this machine; - where no run attains it from there on."
_AXES = "largest relative error of arrival, peak, FWHM", "CPU time (s)"


@study(
    option(
        "--task",
        "Only this task; repeatable.",
        to="names",
        multiple=True,
        type=click.Choice([*TASKS]),
    )
)
def accuracy(
    names: Collection[str] = (),
    methods: Mapping[str, Sequence[float]] = METHODS,
    progress: Progress[str] = iter,
) -> Report:
    """Speed against error: integrators on fixed tasks (two minutes).

    Parameters
    ----------
    names : collection of str
        Tasks to run, by default all.
    methods : mapping
        Tolerances of each integrator.

    Notes
    -----
    JSON: ``rows``, a run each, ``costs`` by method, and ``references``, the true arrival, peak and
    fwhm.
    """
    wanted = [one_of(name, TASKS, "task") for name in names] or [*TASKS]
    rows, costs, references, panels = [], [], [], []
    for name in progress(wanted):
        task = TASKS[name]()
        truth = task.truth or task.read(simulate(task.scene, rtol=FINEST))
        references.append({"task": name, **readings(truth)})
        spent, curves = [], []
        for method, tolerances in methods.items():
            peaks, largest, times = [], [], []
            for rtol, errors, seconds in timings(task, truth, method, tolerances):
                row = {"task": name, "method": method, "setting": rtol}
                row |= {f"{reading}_error": error for reading, error in errors.items()}
                rows.append(row | {"error": max(errors.values()), "seconds": seconds})
                peaks.append((errors["peak"], seconds))
                largest.append(max(errors.values()))
                times.append(seconds)
            # in milliseconds
            line: dict[str, Any] = {"task": name, "method": method}
            for error in WANTED:
                line[f"seconds_{error:.0e}"] = 1e3 * cost(peaks, error)
            spent.append(line)
            curves.append(Curve(method, largest, times))
        # the cheapest at the smallest error first; methods that do not attain it last
        costs += sorted(spent, key=lambda line: [*line.values()][:1:-1])
        panels.append(Panel(*_AXES, tuple(curves), "xy", name))
    tables = (
        Table(_RUNS, rows, "rows"),
        Table(_COSTS, costs, "costs", note=_NOTE, by="task"),
        Table(tuple(map(Column, ("task", *READINGS))), references, "references"),
    )
    return Report("Speed against error", tables, panels=tuple(panels))


if __name__ == "__main__":
    accuracy.main()
