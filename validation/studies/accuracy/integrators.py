"""Speed against error: what an integrator costs, and how far the pulse is off, on fixed tasks.

Methods are SciPy's steppers and the compiled ones, on the whole chain and on a window that moves
with the pulse, and integrators of other packages on the whole chain, each at several tolerances.
The error is the largest relative one of arrival time, peak force and FWHM. The cost is CPU time
without compilation, the median of a few runs where they are short.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import scipy

from lwa.base.arrays import Array
from lwa.base.progress import Progress
from validation.lattice.simulate import COMPILED, simulate
from validation.pulses.pulse import MeasureError, Pulse
from validation.report.command import option, study
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import one_of
from validation.studies.accuracy.costs import WANTED, Row, cost, goals, methods, timed
from validation.studies.accuracy.many import Many, many, together
from validation.studies.accuracy.peers import missing, prepared
from validation.studies.accuracy.reference import FINEST, integrate, reference
from validation.studies.accuracy.tasks import NUMBERS, TASKS, Task, errors, settings
from validation.studies.accuracy.theories import CASES, Ladder, place

_SCIPY: Mapping[tuple[str, bool], Sequence[float]] = {
    ("DOP853", False): (1e-6, 1e-8, 1e-9, 1e-10),
    ("RK45", False): (1e-7, 1e-8, 1e-9),
    ("LSODA", False): (1e-6, 1e-7),
    ("DOP853", True): (1e-6, 1e-7, 1e-8, 1e-9, 1e-10),
    ("RK45", True): (1e-7, 1e-8, 1e-9),
    ("LSODA", True): (1e-6, 1e-7),
}
"""(method, window) → tolerances."""

_COMPILED: Mapping[str, Sequence[float]] = {name: settings(1e-3, FINEST) for name in COMPILED}
"""Method → the error of the peak force that it aims at, on the window and the whole chain."""

MANY, THEORY = "many", "theory"
NAMES = (*TASKS, MANY, THEORY)
"""Of all tasks."""


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.3g}"


_RUNS = tuple(map(Column, ("task", "family", "method", "setting", "error",
                           *(f"{name}_error" for name in NUMBERS),
                           "seconds", "step", "ns_per_bead_evaluation")))  # fmt: skip
_COSTS = (
    Column("task"),
    Column("method", "CPU time (ms) for the peak force to"),
    *(Column(f"seconds_{wanted:.0e}", f"{wanted:.0e}", format=_ms) for wanted in WANTED),
)
_NOTE = "CPU time without compilation, on this machine; - where no run attains it from there on."
_REFERENCES = (Column("task"), *map(Column, NUMBERS), Column("agreement"))
_GOALS = tuple(map(Column, ("key", "goal", "measured_value", "error_value", "least_value",
                            "most_value", "ok")))  # fmt: skip
_MANY = (
    Column("method", "Many chains"),
    Column("setting", "setting", format=".0e"),
    Column("error", "error", format=".0e"),
    Column("seconds", "a chain", "ms", _ms),
    Column("share_value", "share of the ideal gain", format=".2f"),
)
_MANY_NOTE = (
    "100 of the paper's chains with random masses, over a thread a core; error: the median one of\n"
    "the peak force. Wall time."
)
_COLOURS = {"SciPy": "C0", "compiled": "C1", "peer": "C2"}
_MARKS = "osD^v<>PX*"


@study(
    option("--task", "names", multiple=True, metavar="NAME",
           says=f"Only this task, may be given again: {', '.join(NAMES)}."),
)  # fmt: skip
def accuracy(names: Collection[str] = (), progress: Progress[str] = iter) -> Report:
    """Speed against error: integrators on fixed tasks, and theories against true waves. Six
    minutes; of one task alone up to three.

    ``rows``, as of `Row`, with the largest ``error``; ``costs`` by method; ``references`` and their
    ``agreement`` with another route; ``many``, as of `Many`; ``goals``, which people read as
    findings; ``absent``, the peers that are missing; ``theories``, as of `Ladder`. In the picture
    CPU time over the error, solid with a window.

    Raises `validation.scenes.checks.SceneError` for a name that is not one of `NAMES`, and
    `validation.studies.accuracy.peers.PeerError` for a peer that is missing where CI is set.
    """
    wanted = {one_of(name, NAMES, "task") for name in names} or set(NAMES)
    rows: dict[str, list[Row]] = {}
    references: list[tuple[Any, ...]] = []
    chains: list[Many] = []
    theories: list[Report] = []
    absent: tuple[str, ...] = ()
    for name in progress([name for name in NAMES if name in wanted]):
        if name == THEORY:
            theories = [Ladder(tuple(place(*case) for case in CASES)).report()]
            continue
        absent = missing()  # within the progress: to load the peers takes seconds
        if name == MANY:
            chains = many()
            continue
        task = TASKS[name]()
        truth, agreement = reference(task)
        references.append((name, *(getattr(truth, number) for number in NUMBERS), agreement))
        rows[name] = list(_compared(name, task, truth))
    return _report(rows, references, chains, theories, absent)


def _compared(name: str, task: Task, truth: Pulse) -> Iterator[Row]:
    """All methods at one task."""

    def row(
        family: str, method: str, window: bool, setting: float, force: Array, *spent: float
    ) -> Row:
        try:
            off = errors(task.read(force), truth)
        except MeasureError:  # at this setting no pulse comes through
            off = dict.fromkeys(NUMBERS, math.inf)
        return Row(name, family, method, window, setting, off, *spent)

    for (method, window), tolerances in _SCIPY.items():
        stepper = getattr(scipy.integrate, method)
        for rtol in tolerances if task.windowed or not window else ():
            force, seconds = timed(partial(integrate, task, stepper, rtol, window=window))
            yield row("SciPy", f"SciPy {method}", window, rtol, force, seconds)
    for method, aims in _COMPILED.items():
        for window in sorted({task.windowed, False}, reverse=True):
            simulated = partial(simulate, task.scene, method=method, window=window)
            simulated(rtol=1e-3)  # compiles
            for rtol in aims:
                run, seconds = timed(partial(simulated, rtol=rtol))
                spent = seconds, run.step, 1e9 * seconds / run.bead_evaluations
                yield row("compiled", method, window, rtol, task.force(run), *spent)
    for peer, solve in prepared(task):
        for setting in peer.tolerances:
            displacements, seconds = timed(partial(solve, setting, task))
            yield row("peer", peer.name, False, setting, task.force_at(displacements), seconds)


def _report(
    rows: Mapping[str, Sequence[Row]],
    references: Sequence[tuple[Any, ...]],
    chains: Sequence[Many],
    theories: Sequence[Report],
    absent: Sequence[str],
) -> Report:
    """Of rows and references by task."""
    runs = tuple((r.task, r.family, r.name, r.setting, r.error,
                  *(r.errors[name] for name in NUMBERS), r.seconds, r.step, r.ns)
                 for its in rows.values() for r in its)  # fmt: skip
    spent = tuple((task, *line) for task, its in rows.items() for line in _costs(its))
    heads = {task: f"{task}: arrival {arrival:.12g}, peak {peak:.12g}, FWHM {fwhm:.12g};\n"
                   f"another route differs by {agreement:.0e} at most"
             for task, arrival, peak, fwhm, agreement in references}  # fmt: skip
    many = tuple((m.method, m.setting, m.error, m.seconds, m.share) for m in chains)
    aims = (*(goal for its in rows.values() for goal in goals(its)), *together(chains))
    parts = [Report("goals", findings=aims), *theories] if aims else theories
    left = ", ".join(absent)
    left = f"Left out, as not installed: {left} (pip install 'lwa[peers]' brings them)."
    return Report(
        "Speed against error",
        (
            Table(_RUNS, runs, "rows"),
            Table(_COSTS, spent, "costs", note=_NOTE, by="task", heads=heads),
            Table(_REFERENCES, tuple(references), "references"),
            Table(_MANY, many, "many", note=_MANY_NOTE),
            Table(_GOALS, tuple((aim.key, *aim.document().values()) for aim in aims), "goals"),
        ),
        panels=tuple(_panel(task, its) for task, its in rows.items()),
        notes=(left,) if absent else (),
        data={"absent": absent, **{name: x for part in theories for name, x in part.data.items()}},
        parts=tuple(parts),
    )


def _costs(rows: Sequence[Row]) -> list[tuple[Any, ...]]:
    """Of each method its name and `cost` at `WANTED`, None where not attained; the best first."""
    found: list[tuple[Any, ...]] = [(name, *(cost(its, wanted) for wanted in WANTED))
             for (_, name), its in methods(rows).items()]  # fmt: skip
    found.sort(key=lambda line: line[:0:-1])  # by the finest, where attained
    return [tuple(None if part == math.inf else part for part in line) for line in found]


def _panel(task: str, rows: Sequence[Row]) -> Panel:
    """A mark for each method of a family, shared by its window and its whole chain."""
    marks: dict[str, dict[str, str]] = {}
    curves = []
    for (family, name), its in methods(rows).items():
        known, method = marks.setdefault(family, {}), its[0].method
        mark = known.setdefault(method, _MARKS[len(known) % len(_MARKS)])
        style = _COLOURS[family] + mark + ("-" if its[0].window else ":")
        seen = [row for row in its if math.isfinite(row.error)]
        points = ([row.error for row in seen], [row.seconds for row in seen])
        curves.append(Curve.of(name, *points, style=style))
    label = "largest relative error of arrival, peak, FWHM"
    return Panel(label, "CPU time (s)", tuple(curves), "xy", task)
