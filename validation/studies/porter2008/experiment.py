"""The experiment of Porter et al. (2008) as a run of the lattice, beside the theory.

A steel bead strikes a chain in which PTFE and steel beads alternate; with it there are 38, numbered
from 1 (the striker), and a steel wall ends the chain. As in the paper, the sensors sit in beads 15
and 34, the peak force is F_m = (F_15 + F_34) / 2, the speed is the time of flight between them,
and forces are dynamic: what gravity holds there at rest is subtracted. The force of a bead is the
mean of its two contacts' forces; a contact's is named as such.

The theory's wave has one free number, its amplitude, which is taken in turn from F_m, from the
speed, and from the striker's momentum, as if the pulse took all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa import Cell, Dimer, TravelingWave, homogenize
from lwa.command.terminal import quantities, quantity
from validation.lattice.effort import Progress, silent
from validation.lattice.run import Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import Measured, MeasureError, Pulse, measure, speed
from validation.report.command import number, output, run_progress, show
from validation.report.figure import figure
from validation.report.text import document, percent, table, text
from validation.scenes.checks import SceneError, integer, items, real
from validation.scenes.materials import (
    DIAMETER,
    PTFE_BEAD,
    STEEL,
    STEEL_BEAD,
    Bead,
    contact_stiffness,
)
from validation.scenes.scene import Scene
from validation.waves.theory import Compacton

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

GRAVITY = 9.81
"""In m/s²."""

SOURCES = {"F_m": "peak bead force F_m", "speed": "speed V_s", "striker": None}
"""What sets the theory's amplitude, and the quantity that then agrees by construction."""

QUANTITIES: dict[str, tuple[str, Callable[[Compacton], float]]] = {
    "speed V_s": ("m/s", lambda c: c.speed),
    "peak bead force F_{first}": ("N", lambda c: float(c.bead_force(0.0))),
    "peak bead force F_{second}": ("N", lambda c: float(c.bead_force(0.0))),
    "peak bead force F_m": ("N", lambda c: float(c.bead_force(0.0))),
    "peak contact force": ("N", lambda c: float(c.contact_force(0.0))),
    "FWHM of F_{first}": ("sites", lambda c: c.fwhm("bead force") / c.spacing),
    "FWHM of F_{second}": ("sites", lambda c: c.fwhm("bead force") / c.spacing),
    "FWHM of bead force": ("sites", lambda c: c.fwhm("bead force") / c.spacing),
    "FWHM of bead force in time": ("µs", lambda c: 1e6 * c.fwhm("bead force") / c.speed),
    "FWHM of contact force": ("sites", lambda c: c.fwhm("force") / c.spacing),
    "FWHM of contact force in time": ("µs", lambda c: 1e6 * c.fwhm("force") / c.speed),
}
"""Unit and theory of what is compared, the sensor beads' numbers left open. What names no bead is
the mean over both, or over their four contacts."""


@dataclass(frozen=True)
class Comparison:
    """One number of the lattice and what the theory says of it, for each of `SOURCES`."""

    quantity: str
    unit: str
    lattice: Measured
    theory: Mapping[str, float]

    def error(self, source: str) -> float:
        """Theory over lattice, less 1."""
        return self.theory[source] / self.lattice.value - 1


@dataclass(frozen=True, eq=False)
class Record:
    """The dynamic force of one bead, in N, over time, in s: the lattice's and the theory's.

    The theory's is that of amplitude F_m, with its peak where the lattice's is.
    """

    bead: int
    time: Array
    lattice: Array
    theory: Array


@dataclass(frozen=True, eq=False)
class Paper:
    """The chain, its numbers beside the theory's, and the force records at the sensors."""

    velocity: float
    beads: int
    sensors: tuple[int, int]
    gravity: float
    rows: tuple[Comparison, ...]
    records: tuple[Record, ...]


def chain_cell(N: int = 1, ptfe: Bead = PTFE_BEAD) -> Cell:
    """N steel beads and one of PTFE, in SI units."""
    row = [STEEL_BEAD] * N + [ptfe, STEEL_BEAD]
    stiffnesses = [contact_stiffness(*pair) for pair in pairwise(row)]
    return Dimer(STEEL_BEAD.mass, ptfe.mass, N, stiffnesses=stiffnesses, spacing=DIAMETER)


def chain_wave() -> TravelingWave:
    """The paper's theory of the steel:PTFE chain, in SI units."""
    return homogenize(chain_cell(), k=sp.Rational(3, 2)).pde.traveling_wave()


def chain_scene(
    velocity: float,
    beads: int,
    sensors: Sequence[int],
    gravity: float,
    duration: float,
    N: int = 1,
    ptfe: Bead = PTFE_BEAD,
) -> Scene:
    """The N:1 chain; it records the sensor beads, their two contacts each, and the wall's."""
    row = [STEEL_BEAD if number % (N + 1) else ptfe for number in range(1, beads + 1)]
    around = sorted({bead - 1 + side for bead in sensors for side in (-1, 0)})
    return Scene.of_beads(
        row,
        wall=STEEL,
        velocities=(velocity,),
        gravity=gravity,
        bead_sensors=[bead - 1 for bead in sensors],
        contact_sensors=[*around, beads - 1],
        duration=duration,
        samples=60 * beads,
    )


def paper(
    velocity: float = 1.37,
    beads: int = 38,
    sensors: tuple[int, int] = (15, 34),
    gravity: float = 0.0,
    progress: Progress = silent,
) -> Paper:
    """Simulate the chain and compare it with the theory.

    Parameters
    ----------
    velocity : of the striker, in m/s, from 1e-6 to 1000.
    beads : in the chain, the striker included, from 8 to 2000.
    sensors : numbers of two beads, counted from 1, that the pulse passes in this order.
    gravity : in m/s², towards the wall.
    progress : of the two runs, as for `validation.simulate`.

    Raises `SceneError` for values that cannot be meant, `MeasureError` where the pulse is not
    whole at a sensor before the wall throws it back.
    """
    if not 1e-6 <= real(velocity, "velocity") <= 1000:
        raise SceneError(f"velocity is {velocity:g} m/s: one from 1e-6 to 1000 is wanted")
    beads = integer(beads, "beads", 8, 2000)
    pair = _pair(sensors, beads)
    wave = chain_wave()
    momentum = STEEL_BEAD.mass * velocity
    # Ample: the pulse that had all the momentum would need two thirds of this to the wall.
    duration = 1.5 * beads * DIAMETER / Compacton.of_momentum(wave, momentum).speed
    scene = chain_scene(velocity, beads, pair, gravity, duration)
    run, check = (simulate(scene, rtol=t, atol=t, progress=progress) for t in (1e-10, 1e-7))
    numbers = {
        name: Measured(value, less)
        for (name, value), less in zip(
            _numbers(run, pair).items(), _numbers(check, pair).values(), strict=True
        )
    }
    waves = {
        "F_m": Compacton.of_bead_force(wave, numbers["peak bead force F_m"].value),
        "speed": Compacton.of_speed(wave, numbers["speed V_s"].value),
        "striker": Compacton.of_momentum(wave, momentum),
    }
    rows = tuple(
        Comparison(
            name.format(first=pair[0], second=pair[1]),
            unit,
            numbers[name],
            {s: theory(c) for s, c in waves.items()},
        )
        for name, (unit, theory) in QUANTITIES.items()
    )
    records = tuple(_record(run, i, waves["F_m"]) for i in (0, 1))
    return Paper(velocity, beads, pair, gravity, rows, records)


def _pair(sensors: object, beads: int) -> tuple[int, int]:
    given = items(sensors, "sensors")
    pair = tuple(integer(bead, "sensor", 2, beads - 1) for bead in given)
    if len(pair) != 2 or not pair[0] < pair[1]:
        raise SceneError(
            f"sensors are {', '.join(map(str, pair))}: two beads are wanted, the one nearer to "
            "the striker first"
        )
    return pair[0], pair[1]


def _numbers(run: Run, sensors: tuple[int, int]) -> dict[str, float]:
    """The lattice's `QUANTITIES`."""
    beads = [
        pulse_before_wall(run, run.bead_force[i], f"bead {bead}") for i, bead in enumerate(sensors)
    ]
    contacts = [
        pulse_before_wall(run, force, f"contact {i + 1}")
        for i, force in zip(run.scene.contact_sensors[:-1], run.contact_force[:-1], strict=True)
    ]
    V = speed(beads[0], beads[1], (sensors[1] - sensors[0]) * DIAMETER)
    peaks = [pulse.peak for pulse in beads]
    sites = V / DIAMETER
    values = [V, *peaks, float(np.mean(peaks)), float(np.mean([p.peak for p in contacts]))]
    values += [pulse.fwhm * sites for pulse in beads]
    for pulses in (beads, contacts):
        width = float(np.mean([pulse.fwhm for pulse in pulses]))
        values += [width * sites, 1e6 * width]
    return dict(zip(QUANTITIES, values, strict=True))


def pulse_before_wall(run: Run, force: Array, name: str) -> Pulse:
    """The dynamic pulse of a record, before the wall's answer can be in it."""
    wall = run.contact_force[-1]
    end = int(np.argmax(wall)) + 1
    try:
        return measure(run.time[:end], force[:end] - force[0])
    except MeasureError as error:
        raise MeasureError(f"{name}, before the wave reaches the wall: {error}") from None


def _record(run: Run, sensor: int, compacton: Compacton) -> Record:
    force = run.bead_force[sensor]
    bead = run.scene.bead_sensors[sensor] + 1
    arrival = pulse_before_wall(run, force, f"bead {bead}").arrival
    theory = compacton.bead_force(compacton.speed * (run.time - arrival))
    return Record(bead, run.time, force - force[0], theory)


# --- as text, document and picture ------------------------------------------------------------


@text.register
def _(result: Paper) -> str:
    header = ["quantity", "unit", "lattice"]
    for source in SOURCES:
        header += [f"by {source}", "error"]
    lines = []
    for row in result.rows:
        line = [row.quantity, row.unit, str(row.lattice)]
        for source, fixed in SOURCES.items():
            by_construction = fixed == row.quantity
            line += [f"{row.theory[source]:.5g}"]
            line += ["set" if by_construction else percent(row.error(source))]
        lines.append(line)
    first, second = result.sensors
    gravity = f"gravity {result.gravity:g} m/s²" if result.gravity else "no gravity"
    return "\n\n".join(
        (
            f"{result.beads} beads, steel (the striker, {result.velocity:g} m/s) and PTFE in turn, "
            f"steel wall, {gravity}; sensors in beads {first} and {second}",
            table(header, lines),
            "The force of a bead is the mean of its two contacts'; what names no bead is the mean "
            "over both sensor\nbeads (odd ones are steel, even ones PTFE) or over their four "
            "contacts. The theory's amplitude is set by\nF_m, by the speed, or by all of the "
            "striker's momentum; error: theory/lattice - 1. ±: the error of the\nintegration.",
        )
    )


@document.register
def _(result: Paper) -> dict[str, Any]:
    """``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``: ``quantity``,
    ``unit``, ``lattice_value``, ``lattice_error_value``, and by what sets the theory's amplitude
    (``F_m``, ``speed``, ``striker``) ``theory_value`` {…} and ``error_value`` {…}.
    """
    return {
        "velocity_value": result.velocity,
        "beads": result.beads,
        "sensors": list(result.sensors),
        "gravity_value": result.gravity,
        "rows": [
            {
                "quantity": row.quantity,
                "unit": row.unit,
                "lattice_value": row.lattice.value,
                "lattice_error_value": row.lattice.error,
                "theory_value": dict(row.theory),
                "error_value": {source: row.error(source) for source in SOURCES},
            }
            for row in result.rows
        ],
    }


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


@click.command("paper")
@click.option(
    "--velocity",
    callback=quantity,
    default="1.37",
    show_default=True,
    help="Of the striker, in m/s.",
)
@click.option(
    "--beads", type=int, default=38, show_default=True, help="In the chain, the striker included."
)
@click.option(
    "--sensors",
    callback=quantities,
    default="15,34",
    show_default=True,
    help="The two beads that are compared, counted from the striker, 1.",
)
@click.option("--gravity", is_flag=True, help="Let the chain stand upright, under its own weight.")
@output
def paper_command(
    velocity: sp.Expr,
    beads: int,
    sensors: tuple[sp.Expr, ...],
    gravity: bool,
    style: str,
    picture: Path | None,
) -> None:
    """The steel:PTFE chain of the paper: speed, peak force and FWHM."""  # fmt: skip
    g = GRAVITY if gravity else 0.0
    result = paper(number(velocity, "velocity"), beads, sensors, g, run_progress)
    show(result, style, picture)
