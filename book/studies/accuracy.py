"""Speed against error: integrators on fixed tasks, theories against true waves.

A task is a pulse that is measured at one contact far away. The engine's methods and SciPy's run at
several tolerances each. The error is the largest relative one of arrival time, peak force and FWHM,
against the exact wave or the engine at its finest tolerance. The cost is CPU time without
compilation. `tests/benchmarks` measures another package.

The ladder of theories compares the linear, full and canonical closures and the sums of the series
in k - 1 with the true wave, in the widths of force and strain at a contact and the speed, at peak
contact force 1, m1 = A = D = 1. The true wave (the truth) is `validation.waves.solver.exact_wave`
at mass ratios with a solitary wave, and elsewhere the steady pulse of a struck chain
(`validation.pulses.steady`), with an error. The cost is that of deriving and evaluating the theory.

    python book/studies/accuracy.py --task uniform
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, product, takewhile
from statistics import median
from typing import Any, TypeVar

import click
import numpy as np
import sympy as sp

from lwa import Cell, InputError, NoSolitaryWave, expand
from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import COMPILED, simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import MeasureError, Pulse, highest_pulse
from validation.pulses.sensors import READINGS, readings, tracks
from validation.pulses.steady import STRETCH, point
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes import chains
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene
from validation.studies.limits import theory_at
from validation.studies.paper import recorded_chain
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

_ENOUGH, _REPEATS = 0.15, 7  # seconds, and times, after which a run is not repeated


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
    return {
        name: abs(getattr(pulse, name) / getattr(truth, name) - 1) for name in READINGS
    }


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
    recorded = {
        "contact_sensors": (start + sites,),
        "duration": arrival + 10,
        "samples": 2,
    }
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    return Task(wave.launched(start, sites, **recorded), truth)


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
    loose = struck_chain(
        1.0, 200, 150, 132.1
    ).scene  # the pulse takes 0.814 units of time a site
    return Task(replace(loose, wall=1.0, precompression=1.0))


# Durations: until the pulse has passed the sensor.
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

_HEADS = {
    "force": "FWHM of a contact's force: theory over truth - 1",
    "strain": "FWHM of a contact's strain: theory over truth - 1",
    "speed": "speed at peak contact force 1: theory over truth - 1",
}
COMPARED = tuple(_HEADS)

Prediction = tuple[Sequence[float], Sequence[float] | None]
"""Values of `COMPARED`, and the theory's own estimates of their relative errors."""


def _closed(closure: str, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return `COMPARED` by the closed form of a closure."""
    wave = theory_at(k, omega, closure).at_force(1)
    return [
        float(x) for x in (wave.fwhm("force"), wave.fwhm("strain"), wave.speed)
    ], None


def _summed(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return the sums of the series in ε to order n, and their estimated errors."""
    expansion = expand(Cell((1,) if omega == 1 else (1, omega)), n, k=k)
    sums = [
        row.at()
        for row in (expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c)
    ]
    return [x.value for x in sums], [abs(x.error / x.value) for x in sums]


THEORIES: Mapping[str, Callable[[sp.Rational, sp.Rational], Prediction]] = {
    **{
        f"{closure} closure": partial(_closed, closure)
        for closure in ("linear", "full")
    },
    "canonical field": partial(_closed, "canonical"),
    **{f"ε^{n}": partial(_summed, n) for n in (6, 8, 12)},
}
"""Closures, and sums of the series in ε = k - 1."""

SOLITARY, STRUCK_CHAIN = "solitary wave", "struck chain"
HERTZ = sp.Rational(3, 2)

Place = Mapping[str, Any]
"""Predictions of all theories at one k and ω, beside the lattice's values, as in JSON.

``k``, ``omega``; ``truth``, `SOLITARY` or `STRUCK_CHAIN`, the origin of the lattice's `COMPARED`,
``truth_value`` and ``truth_error_value``; ``rows``, for each theory ``theory``, its name;
``error_value``, theory/truth - 1 by `COMPARED`, or None and the reason ``missing``;
``estimate_value`` of |error| by the theory itself, where it has one; ``seconds``, CPU time of
derivation and evaluation.
"""

_LADDER = (
    Column("quantity", format=_HEADS.__getitem__),
    Column("k", "k"),
    Column("omega", "m2/m1", format=lambda omega: f"{float(omega):.4g}"),
    Column("truth_value", "truth", format=".6g"),
    Column("truth_error_value", "±", format=".0e"),
    Column("truth", "by", format=lambda kind: kind.split()[0]),
    *(Column(f"error_value.{theory}", theory, format="+.1e") for theory in THEORIES),
)
_LADDER_NOTE = """\
ε^n: the series in k - 1 summed from n orders.
Truth: the solitary wave or, where there is none, the pulse of a struck chain."""


def ladder(places: Sequence[Place]) -> Report:
    """Return the table of the theories' errors, and a picture of |error| of the force's width.

    JSON: ``theories``, the places.
    """
    seconds: dict[str, list[float]] = {}
    for row in chain.from_iterable(place["rows"] for place in places):
        if row["error_value"]:
            seconds.setdefault(row["theory"], []).append(row["seconds"])
    costs = ", ".join(f"{name} {1e3 * median(s):.3g}" for name, s in seconds.items())
    rows = []
    for name, p in product(COMPARED, places):
        truth = p["truth_value"][name], p["truth_error_value"][name], p["truth"]
        off = [row["error_value"] and row["error_value"][name] for row in p["rows"]]
        rows.append((name, p["k"], p["omega"], *truth, *off))
    note = f"{_LADDER_NOTE}\nMedian cost of derivation and evaluation (ms of CPU): {costs}."
    title = "Theories against true waves"
    equal = [(p["k"] - 1, p) for p in places if p["omega"] == 1]
    dimers = [(p["omega"], p) for p in places if p["omega"] != 1 and p["k"] == HERTZ]
    return Report(
        "",
        (Table(_LADDER, tuple(rows), "", title, note, by="quantity"),),
        panels=(
            _panel("k - 1", "theories, equal beads", equal),
            _panel("m2/m1", "theories, dimers, k = 3/2", dimers),
        ),
        data={"theories": places},
    )


def _panel(axis: str, title: str, places: Sequence[tuple[sp.Rational, Place]]) -> Panel:
    """Return the panel of |error| of the force's width, as a function of k - 1 or ω."""
    curves = []
    for i, (theory, mark) in enumerate(zip(THEORIES, "osDPdv", strict=True)):
        errors = ((x, p["rows"][i]["error_value"]) for x, p in places)
        if points := sorted((x, abs(error["force"])) for x, error in errors if error):
            x, y = zip(*points, strict=True)
            curves.append(Curve(theory, x, y, f"C{i}{mark}-"))
    return Panel(axis, "|error| of the FWHM of the force", tuple(curves), "xy", title)


def place(k: sp.Rational, omega: sp.Rational, kind: str = SOLITARY) -> Place:
    """Compare all theories with the lattice's solitary wave or struck pulse at one k and ω.

    Raises `MeasureError` where the struck chain's pulse is not steady.
    """
    if kind == SOLITARY:
        wave = exact_wave((1.0,) if omega == 1 else (1.0, float(omega)), float(k))
        widths = [wave.estimate("fwhm", name) for name in ("force", "strain")]
        truth = [*widths, wave.estimate("c")]
    else:
        pulse = point(k, omega, STRETCH)
        if pulse.missing:
            raise MeasureError(pulse.missing)
        truth = [pulse.numbers[name] for name in ("width", "strain_width", "speed")]
    rows = []
    for theory, predict in THEORIES.items():
        row = dict.fromkeys(("error_value", "estimate_value", "missing"))
        start = time.process_time()
        try:
            numbers, shares = predict(k, omega)
            off = (x / true.value - 1 for x, true in zip(numbers, truth, strict=True))
            row["error_value"] = dict(zip(COMPARED, off, strict=True))
            row["estimate_value"] = shares and dict(zip(COMPARED, shares, strict=True))
        except (InputError, NoSolitaryWave) as reason:
            row["missing"] = str(reason)
        rows.append({"theory": theory, **row, "seconds": time.process_time() - start})
    return {
        "k": k,
        "omega": omega,
        "truth": kind,
        "truth_value": {q: x.value for q, x in zip(COMPARED, truth, strict=True)},
        "truth_error_value": {q: x.error for q, x in zip(COMPARED, truth, strict=True)},
        "rows": rows,
    }


# Mass ratios of the Hertz dimer's solitary waves are from `validation.waves.solver`.
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
        once = partial(simulate, task.scene, rtol=rtol, method=integrator)
        run, seconds = timed(once)
        errors = dict.fromkeys(READINGS, math.inf)
        with suppress(MeasureError):
            errors = relative_errors(task.read(run), truth)
        yield rtol, errors, seconds


_RUNS = (
    "task",
    "method",
    "setting",
    "error",
    *(f"{name}_error" for name in READINGS),
    "seconds",
)
_COSTS = (
    Column("task"),
    Column("method", "CPU time (ms) for the peak force to"),
    *(
        Column(
            f"seconds_{error:.0e}", f"{error:.0e}", format=lambda s: f"{1e3 * s:.3g}"
        )
        for error in WANTED
    ),
)
_NOTE = "CPU time without compilation, on this machine; - where no run attains it from there on."
_AXES = "largest relative error of arrival, peak, FWHM", "CPU time (s)"


_TASKS = click.Choice(NAMES)


@study(
    option(
        "--task",
        "names",
        multiple=True,
        type=_TASKS,
        says="Only this task; repeatable.",
    )
)
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
            rows += [
                (name, method, r, max(e.values()), *e.values(), s) for r, e, s in found
            ]
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
            Table(
                tuple(map(Column, ("task", *READINGS))), tuple(references), "references"
            ),
        ),
        panels=(*panels, *theories.panels),
        data=theories.data,
    )


if __name__ == "__main__":
    accuracy.main()
