"""The README's picture: the paper's beads, the pulse that runs down them, the theory on top.

A chain of steel and PTFE beads is struck at 1.37 m/s, as in Porter et al. 2008. The picture shows
the beads at the last moment, their displacements enlarged, and the force in each contact at three
moments. The line is the theory's wave. Its peak is the mean peak force of the beads. It starts at
the place of the lattice's pulse at the first moment, and runs at its own speed.

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
from validation import Pulse, Scene, measure, simulate

HERE = Path(__file__).parent
STEEL = Sphere("0.45e-3", "2.38e-3", Material(E="193e9", nu="0.3"))
PTFE = Sphere("0.123e-3", "2.38e-3", Material(E="1.46e9", nu="0.46"))
PAIRS = 20  # cells
FIRST, LAST = 11, 31  # beads at which the pulse's way begins and ends, both of PTFE
FRAMES = 21  # moments on the way

LARGER = 60
"""Factor by which the picture enlarges displacements."""

LATTICE, THEORY = "#2C7FB8", "#D55E00"


@dataclass(frozen=True, eq=False)
class Passage:
    """Motion of the lattice and place of the theory's wave at a few moments.

    Parameters
    ----------
    times : ndarray
        The moments; between two of them the pulse advances by a site.
    force, displacement : ndarray
        Forces of contacts and displacements of beads then, in N and in D.
    places : ndarray
        Places of the theory's wave then, in D, the first bead at 0.
    theory : PhysicalWave
        The theory's wave.
    lattice_speed : float
        Speed of the lattice's pulse in m/s.
    peak, duration : float
        Peak force of a contact in the middle of the way, and its full width at half maximum, in N
        and s: means over two neighbours.
    """

    times: Array
    force: Array
    displacement: Array
    places: Array
    theory: PhysicalWave
    lattice_speed: float
    peak: float
    duration: float

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
    beads = range(2 * PAIRS)
    D = 2 * 2.38e-3
    scene = Scene.of_cell(
        cell, PAIRS, "3/2", velocities=(1.37,), duration=1.4e-3, samples=7001,
        contact_sensors=beads[:-1], bead_sensors=beads,
    )  # fmt: skip
    run = simulate(scene)

    def pulse(contact: int) -> Pulse:
        return measure(run.time, run.contact_force[contact])

    # at a bead: in the mean of its two contacts
    first = (pulse(FIRST - 1).arrival + pulse(FIRST).arrival) / 2
    last = (pulse(LAST - 1).arrival + pulse(LAST).arrival) / 2
    times = np.linspace(first, last, FRAMES)
    heights = run.bead_force[FIRST:LAST].max(axis=1)
    wave = homogenize(cell, k="3/2").pde.traveling_wave()
    theory = wave.at_force(float(heights.mean()), of="bead")
    middle = (FIRST + LAST) // 2
    pair = pulse(middle), pulse(middle + 1)
    return Passage(
        times,
        _at(times, run.time, run.contact_force),
        _at(times, run.time, run.bead_displacement) / D,
        FIRST + float(theory.speed) * (times - times[0]) / D,
        theory,
        (LAST - FIRST) * D / (last - first),
        (pair[0].peak + pair[1].peak) / 2,
        (pair[0].fwhm + pair[1].fwhm) / 2,
    )


def _at(times: Array, time: Array, records: Array) -> Array:
    return np.array([np.interp(times, time, record) for record in records]).T


def draw(axes: Axes, seen: Passage, moment: int, shade: float) -> None:
    """Bars of the forces at a moment, and the theory's wave."""
    force = seen.force[moment]
    contacts = np.arange(len(force)) + 0.5
    axes.bar(contacts, force, width=0.6, color=LATTICE, alpha=shade, lw=0)
    places = seen.places[moment] + np.linspace(-4, 4, 401)
    D = float(seen.theory.wave.D)
    line = seen.theory.along(D * (places - seen.places[moment]), of="contact")
    axes.plot(places, line, color=THEORY, ls="-", lw=2, alpha=0.4 + 0.6 * shade)
    time = 1e6 * (seen.times[moment] - seen.times[0])
    top = 1.02 * max(float(force.max()), float(line.max()))
    axes.text(seen.places[moment], top, f"{time:.0f} µs", ha="center", size=11)


def still(seen: Passage) -> Figure:
    """Three moments of the pulse above one row of beads, its curves labelled."""
    figure, axes = plt.subplots(figsize=(9, 4.2), layout="constrained")
    last = len(seen.times) - 1
    for moment, shade in ((0, 0.4), (last // 2, 0.6), (last, 1.0)):
        draw(axes, seen, moment, shade)
    top = float(seen.force.max())
    beads = len(seen.displacement[last])
    moved = LARGER * seen.displacement[last]
    circles = [Circle((i + x, 0), 0.5) for i, x in enumerate(moved)]
    row = axes.inset_axes((0, 0, 1, 0.12))
    colors = ["#44546A", "#F2E6C9"] * PAIRS
    row.add_collection(PatchCollection(circles, fc=colors, ec="k", lw=0.5))
    row.set(xlim=(-1.5, beads + 0.5), ylim=(-0.6, 0.6), aspect="equal")
    row.axis("off")
    axes.set(xlim=(-1.5, beads + 0.5), ylim=(-0.2 * top, 1.3 * top))
    axes.axis("off")
    peak = f"{seen.peak:.1f} N for {1e6 * seen.duration:.0f} µs"
    axes.text(0.0, 1.2 * top, peak, size=17, weight="bold")
    axes.text(
        0.0, 1.11 * top, "force in each contact, by Newton's equations", color=LATTICE
    )
    axes.text(0.0, 1.04 * top, "long-wave theory", color=THEORY)
    return figure


def main() -> None:
    """Draw the README's picture."""
    seen = passage()
    text = json.dumps(seen.numbers)
    still(seen).savefig(HERE / "chain.png", dpi=100, metadata={"Comment": text})
    theory = float(seen.theory.speed)
    print(f"lattice {seen.lattice_speed:.2f} m/s, theory {theory:.2f} m/s")


if __name__ == "__main__":
    main()
