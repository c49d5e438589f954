"""Speed against error as tables, as a document for JSON, and as a work–precision diagram.

Importing this module teaches `validation.report.text` and `validation.report.figure` what
`Accuracy` is.
"""

from __future__ import annotations

import math
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from validation.lattice.run import IntegrationError
from validation.report.command import output, progress, show
from validation.report.figure import figure
from validation.report.result import Finding
from validation.report.text import document, table, text
from validation.studies.accuracy.integrators import NAMES, WANTED, Accuracy, Row, accuracy, costs
from validation.studies.accuracy.peers import PeerError
from validation.studies.accuracy.rungs import draw
from validation.studies.accuracy.tasks import NUMBERS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Accuracy"]

_READING = (
    "Errors are relative. Setting: the tolerance; of compiled splittings the error that their "
    "step aims at,\nof heyoka the largest step. CPU time without compilation, on this machine."
)

_COLORS = {"SciPy": "C0", "compiled": "C1", "peer": "C2"}
_MARKERS = "osD^v<>PX*"


@text.register(Accuracy)
def _(result: Accuracy) -> str:
    blocks = []
    truths = {reference.task: reference for reference in result.references}
    for name, group in groupby(result.rows, lambda row: row.task):
        rows, truth = list(group), truths[name]
        pulse = truth.pulse
        head = (
            f"{name}: arrival {pulse.arrival:.12g}, peak {pulse.peak:.12g}, FWHM "
            f"{pulse.fwhm:.12g};\nanother route differs by {truth.agreement:.0e} at most"
        )
        header = ("method", "setting", "arrival", "peak", "FWHM", "CPU (ms)")
        lines = [
            (
                row.name,
                f"{row.setting:.0e}",
                *(f"{row.errors[number]:.1e}" for number in NUMBERS),
                f"{1e3 * row.seconds:.3g}",
            )
            for row in rows
        ]
        blocks.append(f"{head}\n{table(header, lines)}")
        cheapest = sorted(costs(rows).items(), key=lambda item: item[1])
        attained = [f"{m} {1e3 * s:.3g}" for (_, m), s in cheapest if math.isfinite(s)]
        failing = [m for (_, m), s in cheapest if math.isinf(s)]
        line = f"Peak force to {WANTED:g} from here on (ms): {'; '.join(attained) or 'none'}."
        blocks[-1] += f"\n{line}" + (f" Not: {', '.join(failing)}." if failing else "")
    if result.rows:
        blocks.append(_READING)
    if result.goals:
        blocks.append("\n".join(["goals on the dimer", *map(_goal, result.goals)]))
    if result.theories is not None:
        blocks.append(text(result.theories))
    if result.absent:
        blocks.append(
            f"Left out, as not installed: {', '.join(result.absent)} "
            "(pip install 'lwa[peers]' brings them)."
        )
    return "\n\n".join(blocks)


def _goal(goal: Finding) -> str:
    error = "" if goal.error is None else f" ± {goal.error:.0e}"
    bounds = [f"≥ {goal.low:g}"] * math.isfinite(goal.low)
    bounds += [f"≤ {goal.high:g}"] * math.isfinite(goal.high)
    verdict = "met" if goal.ok else "NOT met"
    return f"  {goal.quantity}: {goal.value:.3g}{error} ({' and '.join(bounds)}: {verdict})"


@document.register(Accuracy)
def _(result: Accuracy) -> dict[str, Any]:
    return {
        "rows": [_row(row) for row in result.rows],
        "references": [
            {"task": r.task}
            | {name: getattr(r.pulse, name) for name in NUMBERS}
            | {"agreement": r.agreement}
            for r in result.references
        ],
        "goals": [
            {
                "goal": goal.quantity,
                "key": goal.key,
                "measured_value": goal.value if math.isfinite(goal.value) else None,
                "error_value": goal.error,
                "least_value": goal.low if math.isfinite(goal.low) else None,
                "most_value": goal.high if math.isfinite(goal.high) else None,
                "ok": goal.ok,
            }
            for goal in result.goals
        ],
        "absent": list(result.absent),
        **({} if result.theories is None else document(result.theories)),
    }


def _row(row: Row) -> dict[str, Any]:
    return {
        "task": row.task,
        "method": row.name,
        "error": row.error,
        "seconds": row.seconds,
        "family": row.family,
        "setting": row.setting,
        **{f"{name}_error": row.errors[name] for name in NUMBERS},
        "step": row.step,
        "ns_per_bead_evaluation": row.ns,
    }


@figure.register(Accuracy)
def _(result: Accuracy) -> Figure:
    """Error against CPU time, one panel for each task; windowed methods are drawn solid. The ladder
    of theories has two panels of its own."""
    from matplotlib.figure import Figure

    tasks = {name: list(rows) for name, rows in groupby(result.rows, lambda row: row.task)}
    if not tasks:
        return figure(result.theories)
    count = len(tasks) + 2 * (result.theories is not None)
    columns = min(2, count)
    lines = math.ceil(count / columns)
    picture = Figure(figsize=(6 * columns, 5 * lines + 1), layout="constrained")
    names = list(dict.fromkeys((row.family, row.name) for row in result.rows))
    # A marker for each method of a family, shared by its window and its whole chain.
    methods = list(dict.fromkeys((row.family, row.method) for row in result.rows))
    place = {method: [m for m in methods if m[0] == method[0]].index(method) for method in methods}
    panels = picture.subplots(lines, columns, squeeze=False).ravel()
    for axes, (task, rows) in zip(panels, tasks.items(), strict=False):
        for family, name in names:
            its = [row for row in rows if (row.family, row.name) == (family, name)]
            if its:
                first = its[0]
                axes.loglog(
                    [row.error for row in its],
                    [row.seconds for row in its],
                    color=_COLORS[family],
                    marker=_MARKERS[place[family, first.method] % len(_MARKERS)],
                    linestyle="-" if first.window else ":",
                    markerfacecolor=_COLORS[family] if first.window else "none",
                    markersize=5,
                    linewidth=1,
                    label=name,
                )
        axes.set(
            title=task,
            xlabel="largest relative error of arrival, peak, FWHM",
            ylabel="CPU time (s)",
        )
        axes.grid(alpha=0.3)
    for axes in panels[count:]:
        axes.set_visible(False)
    if result.theories is not None:
        left, right = panels[len(tasks) : count]
        draw(left, right, result.theories)
    handles = {
        label: handle
        for axes in panels[: len(tasks)]
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    picture.legend(
        handles.values(), handles.keys(), loc="outside lower center", ncols=2 * columns + 1,
        fontsize="small",
    )  # fmt: skip
    return picture


@click.command("accuracy")
@click.option(
    "--task", "names", multiple=True, metavar="NAME",
    help=f"Only this task, may be given again: {', '.join(NAMES)}.",
)  # fmt: skip
@output
def accuracy_command(names: tuple[str, ...], style: str, picture: Path | None) -> None:
    """Speed against error: integrators on fixed tasks, and theories against true waves."""
    try:
        result: Accuracy = accuracy(names, progress)
    except (PeerError, IntegrationError) as error:
        raise click.ClickException(str(error)) from None
    show(result, style, picture)
