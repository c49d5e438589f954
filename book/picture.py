"""The README's picture: the paper's beads, the pulse that runs down them, the theory on top.

A chain of steel and PTFE beads is struck at 1.37 m/s, as in Porter et al. 2008. The picture shows
the beads, their displacements enlarged, and the force in each contact. The line is the theory's
wave. Its peak is the mean peak force of the beads. It starts at the place of the lattice's pulse at
the first moment, and runs at its own speed.

    python book/picture.py

draws `chain.png`, which the README shows; the numbers of the picture stand in the file as text.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from lwa import Cell, Material, PhysicalWave, Sphere, homogenize
from lwa.base.arrays import Array
from validation import Scene, measure, simulate

HERE = Path(__file__).parent
STEEL = Sphere("0.45e-3", "2.38e-3", Material(E="193e9", nu="0.3"))
PTFE = Sphere("0.123e-3", "2.38e-3", Material(E="1.46e9", nu="0.46"))
PAIRS, FIRST, LAST, FRAMES = 20, 11, 31, 21
"""Cells; first and last bead of the pulse's way, both of PTFE; number of moments on the way."""

LARGER = 60
"""Factor by which the picture enlarges displacements."""


@dataclass(frozen=True, eq=False)
class Passage:
    """Motion of the lattice and place of the theory's wave at a few moments.

    times : the moments; between two of them the pulse advances by a site.
    force, displacement : forces of contacts and displacements of beads then, in N and in D.
    places : places of the theory's wave then, in D, the first bead at 0.
    """

    times: Array
    force: Array
    displacement: Array
    places: Array
    theory: PhysicalWave
    lattice_speed: float

    @property
    def numbers(self) -> dict[str, list[float] | float]:
        """Numbers of the picture, to five digits."""
        values = {"time": self.times, "force": self.force, "place": self.places}
        rounded = {
            name: [float(f"{x:.5g}") for x in v.ravel()] for name, v in values.items()
        }
        return rounded | {"speed": float(f"{float(self.theory.speed):.5g}")}


def passage() -> Passage:
    """Integrate the chain and evaluate the theory at equally spaced moments."""
    cell = Cell.of_spheres([STEEL, PTFE])
    beads, D = range(2 * PAIRS), 2 * 2.38e-3
    scene = Scene.of_cell(
        cell, PAIRS, "3/2", velocities=(1.37,), duration=1.4e-3, samples=7001,
        contact_sensors=beads[:-1], bead_sensors=beads,
    )  # fmt: skip
    run = simulate(scene)
    arrivals = [  # at a bead: in the mean of its two contacts
        np.mean(
            [measure(run.time, run.contact_force[i]).arrival for i in (bead - 1, bead)]
        )
        for bead in (FIRST, LAST)
    ]
    times = np.linspace(*arrivals, FRAMES)
    heights = run.bead_force[FIRST:LAST].max(axis=1)
    wave = homogenize(cell, k="3/2").pde.traveling_wave()
    theory = wave.at_force(float(heights.mean()), of="bead")
    speed = (LAST - FIRST) * D / (arrivals[1] - arrivals[0])
    return Passage(
        times,
        _at(times, run.time, run.contact_force),
        _at(times, run.time, run.bead_displacement) / D,
        FIRST + float(theory.speed) * (times - times[0]) / D,
        theory,
        speed,
    )


def _at(times: Array, time: Array, records: Array) -> Array:
    return np.array([np.interp(times, time, record) for record in records]).T


def draw(axes: Axes, seen: Passage, moment: int) -> None:
    """The chain, its forces and the theory's wave at one moment."""
    force, moved = seen.force[moment], LARGER * seen.displacement[moment]
    axes.clear()
    top = 1.15 * seen.force.max()
    axes.bar(np.arange(len(force)) + 0.5, force, width=0.55, color="#56B4E9")
    x = np.linspace(-1, len(force) + 1, 1201)
    D = float(seen.theory.wave.D)
    line = seen.theory.along(D * (x - seen.places[moment]), of="contact")
    axes.plot(
        x, np.where(line > 1e-3 * top, line, np.nan), color="#D55E00", ls="-", lw=1.6
    )
    beads = [Circle((i + x, 0), 0.5) for i, x in enumerate(moved)]
    row = axes.inset_axes((0, 0, 1, 0.29))
    row.add_collection(
        PatchCollection(beads, fc=["#44546A", "#F2E6C9"] * PAIRS, ec="k", lw=0.5)
    )
    row.set(xlim=(-2, len(moved)), ylim=(-0.6, 0.6), aspect="equal")
    row.axis("off")
    axes.set(xlim=(-2, len(moved)), ylim=(-0.42 * top, top))
    axes.axis("off")


def still(seen: Passage) -> Figure:
    """Three moments, one below the other."""
    figure, rows = plt.subplots(3, 1, figsize=(9, 4.2), layout="constrained")
    for axes, moment in zip(rows, (0, len(seen.times) // 2, -1), strict=True):
        draw(axes, seen, moment)
        axes.text(
            -1.5, 0.6 * seen.force.max(), f"{1e6 * seen.times[moment]:.0f} µs", size=11
        )
    return figure


def main() -> None:
    """Draw the README's picture."""
    seen = passage()
    still(seen).savefig(
        HERE / "chain.png", dpi=100, metadata={"Comment": json.dumps(seen.numbers)}
    )
    print(
        f"lattice {seen.lattice_speed:.2f} m/s, theory {float(seen.theory.speed):.2f} m/s"
    )


if __name__ == "__main__":
    main()
