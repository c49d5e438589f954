"""A result as a picture, drawn by Matplotlib without a display.

Matplotlib is imported when a picture is drawn. A file appears only when it is complete.
"""

from __future__ import annotations

from functools import singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from validation.pulses.sensors import Recording, tracks
from validation.report.files import output_file, replacing
from validation.studies.limits import EQUAL, EXPONENTS, LAWS, LIGHT, Limits
from validation.studies.porter2008.experiment import Paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")


def plot_file(path: str) -> Path:
    """A path that a picture can be written to.

    Raises `lwa.InputError` for another suffix than `SUFFIXES` or a folder that does not exist.
    """
    return output_file("plot", path, SUFFIXES)


def save(result: Any, file: Path) -> None:
    """Draw a result into a file, which is replaced only by a complete picture."""
    with replacing(file) as new:
        figure(result).savefig(new, dpi=150)


@singledispatch
def figure(result: Any) -> Figure:
    """The picture of a result."""
    raise TypeError(f"nothing is known to draw of {type(result).__name__}")


@figure.register(Limits)
def _(result: Limits) -> Figure:
    """|error| against k - 1, with the leading powers that it must approach."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(10, 4.5), layout="constrained")
    epsilon = np.geomspace(float(EXPONENTS[-1] - 1) / 2, float(EXPONENTS[0] - 1), 2)
    for axes, omega in zip(picture.subplots(1, 2, sharey=True), (EQUAL, LIGHT), strict=True):
        for i, (quantity, law) in enumerate(LAWS.items()):
            rows = [
                row
                for row in result.rows
                if (row.quantity, row.omega) == (quantity, omega) and row.k is not None
            ]
            color = f"C{i}"
            axes.plot(epsilon, abs(float(law.coefficient)) * epsilon**law.order, color=color)
            axes.errorbar(
                [float(row.k - 1) for row in rows if row.k is not None],
                [abs(row.error) for row in rows],
                [row.lattice.relative_error for row in rows],
                fmt="osD^"[i],
                color=color,
                label=quantity,
            )
        axes.set(xscale="log", yscale="log", xlabel="k - 1", title=f"m2/m1 = {omega}")
        axes.set_xticks([float(k - 1) for k in EXPONENTS], [str(k - 1) for k in EXPONENTS])
        axes.set_xticks([], minor=True)
    picture.axes[0].set_ylabel("|theory/lattice - 1|")
    picture.axes[0].legend(title="lines: leading order in k - 1")
    return picture


@figure.register(Paper)
def _(result: Paper) -> Figure:
    """The forces at both sensors over time, the lattice's and the theory's."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(8, 4.5), layout="constrained")
    axes = picture.subplots()
    for i, record in enumerate(result.records):
        color, time = f"C{i}", 1e6 * record.time
        axes.plot(time, record.lattice, color=color, label=f"bead {record.bead}, lattice")
        axes.plot(time, record.theory, "--", color=color, label="theory, amplitude from F_m")
    axes.set(xlabel="time (µs)", ylabel="force, mean of the bead's contacts (N)")
    axes.legend(loc="upper center", ncols=2, bbox_to_anchor=(0.5, 1.17))
    return picture


@figure.register(Recording)
def _(result: Recording) -> Figure:
    """The dynamic force at every sensor over time."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(8, 4.5), layout="constrained")
    axes = picture.subplots()
    for track in tracks(result.run):
        axes.plot(track.time, track.force, label=f"{track.kind} {track.number}")
    axes.set(xlabel="time", ylabel="dynamic force")
    axes.legend()
    return picture
