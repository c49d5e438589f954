"""The hard cases as tables, as a document for JSON, and as a picture.

Importing this module teaches `validation.report.text` and `validation.report.figure` what `Hard`
is.
"""

from __future__ import annotations

import math
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import click

from validation.report.command import output, progress, show
from validation.report.figure import figure
from validation.report.result import Finding, Outcome, Panel, Statement
from validation.report.text import document, table, text
from validation.studies.hard.cases import CASES, Hard, hard

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Hard"]

_STYLES = ("o-", "s--", "^:", "D-.", "v-", "x--", "P:", "*-.")


@text.register(Hard)
def _(result: Hard) -> str:
    blocks = [block(name, outcome) for name, outcome in result.outcomes.items()]
    count = len(blocks)
    failed = sum(not outcome.ok for outcome in result.outcomes.values())
    cases = f"{count} case{'s' if count > 1 else ''}"
    blocks.append(f"{cases}: {f'{failed} fail' if failed else 'all hold'}")
    return "\n\n".join(blocks)


def block(name: str, outcome: Outcome) -> str:
    """One case: its question, its findings, what follows."""
    numbers = [f for f in outcome.findings if isinstance(f, Finding)]
    parts = [f"{name}\n{_filled(outcome.question)}"]
    parts += [
        _filled(f"{f.quantity}: {f.says}{'' if f.ok else '  FAILS'}")
        for f in outcome.findings
        if isinstance(f, Statement)
    ]
    if outcome.grid is not None:
        parts.append(table(outcome.grid.header, outcome.grid.rows))
        numbers = [f for f in numbers if not f.ok]
    if numbers:
        rows = [(f.quantity, _value(f), _bounds(f), _word(f)) for f in numbers]
        parts.append(table(("measured", "value", "expected", ""), rows))
    parts.append(_filled(_answer(outcome)))
    return "\n".join(parts)


def _answer(outcome: Outcome) -> str:
    failed = sum(not f.ok for f in outcome.findings)
    return (f"{failed} not as expected, which was: " if failed else "") + outcome.answer


def _filled(line: str) -> str:
    return fill(line, 100, break_long_words=False)


def _value(finding: Finding) -> str:
    value = f"{finding.value:.6g}"
    return value if finding.error is None else f"{value} ± {finding.error:.0e}"


def _bounds(finding: Finding) -> str:
    low, high = finding.low, finding.high
    if math.isinf(low) and math.isinf(high):
        return "-"
    if math.isinf(high):
        return f"≥ {low:g}"
    if math.isinf(low):
        return f"≤ {high:g}"
    if low == high:
        return f"{low:g}"
    return f"± {high:g}" if low == -high else f"{low:g} … {high:g}"


def _word(finding: Finding) -> str:
    if not finding.ok:
        return "FAILS"
    return "" if math.isinf(finding.low) and math.isinf(finding.high) else "ok"


@document.register(Hard)
def _(result: Hard) -> dict[str, Any]:
    """``ok`` and ``cases``, each with ``case`` (its name), ``question``, ``outcome``, ``ok``, its
    chief numbers by their keys (such as ``energy_drift_value``), ``findings``, ``statements`` and
    ``panel``.

    A finding has ``quantity``, ``measured_value``, ``error_value`` (null for what is exact or
    itself an error), ``least_value`` and ``most_value`` (null for no bound) and ``ok``; a statement
    ``quantity``, ``says`` and ``ok``; a panel the axes' labels ``x`` and ``y``, the logarithmic
    ones as ``scale`` and ``curves`` of ``label``, ``x_value`` and ``y_value``.
    """
    return {
        "ok": result.ok,
        "cases": [
            {
                "case": name,
                "question": outcome.question,
                "outcome": _answer(outcome),
                "ok": outcome.ok,
                **{
                    f"{f.key}_value": _finite(f.value)
                    for f in outcome.findings
                    if isinstance(f, Finding) and f.key
                },
                "findings": [
                    {
                        "quantity": f.quantity,
                        "measured_value": _finite(f.value),
                        "error_value": f.error,
                        "least_value": _finite(f.low),
                        "most_value": _finite(f.high),
                        "ok": f.ok,
                    }
                    for f in outcome.findings
                    if isinstance(f, Finding)
                ],
                "statements": [
                    {"quantity": f.quantity, "says": f.says, "ok": f.ok}
                    for f in outcome.findings
                    if isinstance(f, Statement)
                ],
                "panel": _panel(outcome.panel),
            }
            for name, outcome in result.outcomes.items()
        ],
    }


def _finite(number: float) -> float | None:
    """JSON has no infinities."""
    return number if math.isfinite(number) else None


def _panel(panel: Panel) -> dict[str, Any]:
    curves = [
        {"label": c.label, "x_value": c.x.tolist(), "y_value": c.y.tolist()} for c in panel.curves
    ]
    return {"x": panel.x, "y": panel.y, "scale": panel.scale, "curves": curves}


@figure.register(Hard)
def _(result: Hard) -> Figure:
    from matplotlib.figure import Figure

    count = len(result.outcomes)
    columns = min(count, 2)
    rows = math.ceil(count / columns)
    picture = Figure(figsize=(6 * columns, 3.8 * rows), layout="constrained")
    axes = picture.subplots(rows, columns, squeeze=False).ravel()
    for plot, (name, outcome) in zip(axes, result.outcomes.items(), strict=False):
        draw(plot, outcome.panel)
        plot.set_title(name)
    for empty in axes[count:]:
        empty.set_visible(False)
    return picture


def draw(plot: Axes, panel: Panel) -> None:
    """Draw a case's picture."""
    for i, curve in enumerate(panel.curves):
        style = _STYLES[i % len(_STYLES)]
        few = len(curve.x) <= 40  # marks would cover a line of many points
        marker, line = style[0] if few else "", style[1:] if curve.line else ""
        plot.plot(
            curve.x, curve.y, marker=marker, linestyle=line, color=f"C{i}", ms=4, label=curve.label
        )
    plot.set(xlabel=panel.x, ylabel=panel.y)
    if "x" in panel.scale:
        plot.set_xscale("log")
    if "y" in panel.scale:
        plot.set_yscale("log")
    plot.legend(fontsize="small")


@click.command("hard")
@click.option(
    "--case", "names", multiple=True, metavar="NAME",
    help=f"Only this case, may be given again: {', '.join(CASES)}.",
)  # fmt: skip
@output
def hard_command(names: tuple[str, ...], style: str, picture: Path | None) -> int:
    """Extreme k and ω, lost contacts, long runs, float64 against 50 digits: what holds there."""
    result: Hard = hard(names, progress)
    show(result, style, picture)
    return 0 if result.ok else 1
