"""The paper's figures as tables, as a document for JSON, and as a picture.

Importing this module teaches `validation.report.text` and `validation.report.figure` what `Figures`
is.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from validation.report.command import output, progress, show
from validation.report.figure import figure
from validation.report.text import document, table, text
from validation.studies.porter2008.figures import (
    FIRST_BEAD,
    HEIGHTS,
    STATED,
    Definition,
    Figures,
    Scaling,
    Widths,
    figures,
)

__all__ = ["Figures"]

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@text.register(Figures)
def _(result: Figures) -> str:
    speeds = table(
        ("chain", "V_s lattice (m/s)", "peak force (N)", "V_s theory (m/s)", "error"),
        [
            (
                f"{row.N}:1",
                str(row.speed),
                str(row.force),
                f"{row.theory:.2f}",
                f"{100 * (row.theory / row.speed.value - 1):+.1f} %",
            )
            for row in result.speeds
        ],
    )
    scaling = table(
        ("E of PTFE", "exponent of V_s in F_m", "less 1/6", "V_s (m/s)", "F_m (N)"),
        [
            (
                f"{row.E / 1e9:g} GPa",
                str(row.exponent),
                f"{row.exponent.value - 1 / 6:+.0e}",
                f"{row.speeds[0].value:.1f} … {row.speeds[-1].value:.1f}",
                f"{row.forces[0].value:.2f} … {row.forces[-1].value:.2f}",
            )
            for row in result.scaling
        ],
    )
    header = ["FWHM of", "average"]
    for closure in ("linear", "canonical"):
        header += [f"{line}, {closure}" for line in STATED]
    widths = table(
        [*header, "stated errors met"], [_width_row(d) for d in result.widths.definitions]
    )
    stated = ", ".join(f"{100 * e:.1f} % ({line})" for line, e in STATED.items())
    return "\n\n".join(
        (
            "N:1 chains; the theory is that of the canonical field at the lattice's peak force; "
            f"±: by how\nmuch a less accurate run differs\n{speeds}",
            f"drop heights {HEIGHTS[0]:g} … {HEIGHTS[-1]:g} m; the paper fits 0.1666\n{scaling}",
            f"theory over the average from bead {FIRST_BEAD} on, less 1, for equal contacts and "
            f"equal force;\nthe paper states {stated}\n{widths}",
            _verdict(result.widths),
        )
    )


def _width_row(definition: Definition) -> list[str]:
    average = definition.average.value
    unit = f"{1e6 * average:.2f} µs" if definition.time else f"{average:.3f} D"
    row = [f"{definition.quantity}, in {'time' if definition.time else 'sites'}", unit]
    for errors in definition.errors.values():
        row += [f"{100 * errors[line]:+.1f} %" for line in STATED]
    return [*row, ", ".join(definition.reproduced) or "none"]


def _verdict(widths: Widths) -> str:
    best = max(widths.definitions, key=lambda d: len(d.reproduced))
    if len(best.reproduced) == len(STATED):
        return f"The stated errors are those of: {best.quantity}."
    return (
        "No definition meets all three stated errors within half a percent; nearest: "
        f"{best.quantity}, in {'time' if best.time else 'sites'}."
    )


@document.register(Figures)
def _(result: Figures) -> dict[str, Any]:
    """``scaling`` is the paper's chain, with its dynamic modulus; ``scalings`` has both."""
    scalings = [_scaling(row) for row in result.scaling]
    return {
        "scaling": scalings[0],
        "scalings": scalings,
        "speeds": [
            {
                "N": row.N,
                "speed_value": row.speed.value,
                "speed_error_value": row.speed.error,
                "force_value": row.force.value,
                "force_error_value": row.force.error,
                "theory_value": row.theory,
            }
            for row in result.speeds
        ],
        "forces": [
            {"N": f.N, "beads": list(f.beads), "time_value": f.time.tolist(),
             "force_value": f.force.tolist()}
            for f in result.forces
        ],
        "widths": {
            "beads": list(result.widths.beads),
            "fwhm_value": [width.value for width in result.widths.times],
            "fwhm_error_value": [width.error for width in result.widths.times],
            "lines_value": {closure: dict(lines) for closure, lines in result.widths.lines.items()},
            "definitions": [
                {
                    "quantity": d.quantity,
                    "unit": "s" if d.time else "sites",
                    "average_value": d.average.value,
                    "average_error_value": d.average.error,
                    "error_value": {closure: dict(errors) for closure, errors in d.errors.items()},
                    "reproduced": list(d.reproduced),
                }
                for d in result.widths.definitions
            ],
            "stated_error_value": STATED,
        },
    }  # fmt: skip


def _scaling(row: Scaling) -> dict[str, Any]:
    return {
        "modulus_value": row.E,
        "exponent_value": row.exponent.value,
        "exponent_error_value": row.exponent.error,
        "speed_value": [V.value for V in row.speeds],
        "speed_error_value": [V.error for V in row.speeds],
        "force_value": [F.value for F in row.forces],
        "force_error_value": [F.error for F in row.forces],
    }


@figure.register(Figures)
def _(result: Figures) -> Figure:
    from matplotlib.figure import Figure

    picture = Figure(figsize=(11, 8), layout="constrained")
    axes = picture.subplots(2, 2)
    for plot, record in zip(axes[0], result.forces, strict=True):
        for bead, force in zip(record.beads, record.force, strict=True):
            plot.plot(1e6 * record.time, force, label=f"bead {bead}")
        plot.set(title=f"{record.N}:1", xlabel="time (µs)", ylabel="force of the bead (N)")
        plot.legend()
    _draw_scaling(axes[1][0], result)
    _draw_widths(axes[1][1], result.widths)
    return picture


def _draw_scaling(axes: Axes, result: Figures) -> None:
    for i, row in enumerate(result.scaling):
        label = f"E = {row.E / 1e9:g} GPa: exponent {row.exponent.value:.4f}"
        forces, speeds = ([m.value for m in found] for found in (row.forces, row.speeds))
        axes.loglog(forces, speeds, "os"[i] + "-", label=label)
    axes.set(xlabel="peak force $F_m$ (N)", ylabel="speed $V_s$ (m/s)")
    axes.legend()


def _draw_widths(axes: Axes, widths: Widths) -> None:
    times = [1e6 * width.value for width in widths.times]
    axes.plot(widths.beads, times, "ko-", ms=3, label="lattice, force of the bead")
    for style, (closure, lines) in zip(("-", "--"), widths.lines.items(), strict=True):
        for i, (line, width) in enumerate(lines.items()):
            axes.axhline(1e6 * width, ls=style, color=f"C{i}", label=f"{line}, {closure}")
    axes.set(xlabel="bead", ylabel="FWHM (µs)")
    axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3)


@click.command("figures")
@output
def figures_command(style: str, picture: Path | None) -> None:
    """The paper's figures: force records, N:1 chains, force against speed, and the FWHM."""
    result: Figures = figures(progress)
    show(result, style, picture)
