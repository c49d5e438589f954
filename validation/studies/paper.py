"""The experiment of Porter et al. (2008) on the lattice, beside the theory.

A steel bead strikes a chain in which PTFE and steel beads alternate. The chain has 38 beads,
numbered from 1 (the striker), and ends in a steel wall. As in the paper, sensors sit in beads 15
and 34, the peak force is F_m = (F_15 + F_34)/2, and the speed V_s is the distance of the two beads
over the time between their peaks. The force of a bead is the mean of its two contacts' forces; the
static forces of gravity are subtracted.

Bead 15 is steel and bead 34 PTFE: the shapes of their pulses differ, so that V_s is not the speed
of the pulse. The speed between beads of one kind stands beside it.

The amplitude of the theory's wave is set in turn by F_m, by V_s, and by the striker's momentum, as
if the pulse took all of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import sympy as sp

from lwa import Cell, PhysicalWave, Sphere, canonical_wave, homogenize
from lwa.command.options import quantities
from validation.lattice.cost import RunProgress, silent
from validation.lattice.result import Run
from validation.lattice.simulate import twice
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Pulse, compared
from validation.pulses.sensors import Train
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Table, percent
from validation.scenes.chains import DIAMETER, GRAVITY, PTFE_BEAD, STEEL_BEAD, chain_scene
from validation.scenes.checks import SceneError, between, integer, items
from validation.scenes.scene import Scene
from validation.waves.theory import bead_fwhm, of_momentum, of_speed

HERTZ = sp.Rational(3, 2)
BEADS, SENSORS, VELOCITY = 38, (15, 34), 1.37  # sensors are numbered from the striker, 1; in m/s
TOLERANCES = (1e-10, 1e-9)  # rtol of the run that counts and of the run that gives its errors
SOURCES = ("F_m", "speed", "striker")
"""Names of the quantities that set the theory's amplitude."""

_UNITS = {"speed": "m/s", "peak": "N", "FWHM": "sites"}  # by the first word; µs "in time"


def _error(error: float) -> str:
    """Format an error in per cent; "set" for the theory's input, exact within rounding."""
    return percent(error) if abs(error) > 1e-12 else "set"


_COLUMNS = (
    *(Column("quantity", "quantity"), Column("unit", "unit")),
    Column("lattice", "lattice", error=True),
    *chain.from_iterable(
        (
            Column(f"theory_value.{source}", f"by {source}", format=".5g"),
            Column(f"error_value.{source}", "error", format=_error),
        )
        for source in SOURCES
    ),
)
_NOTE = """\
The force of a bead is the mean of its two contacts'; numbers that name no bead
are means over both sensor beads (odd ones are steel, even ones PTFE) or over
their four contacts. The theory's amplitude is set by F_m, by V_s, or by all of
the striker's momentum; error: theory/lattice - 1. Between steel and PTFE, V_s
compares peaks of different shape, and is not the pulse's speed.
±: error of the integration."""


def chain_cell(N: int = 1, ptfe: Sphere = PTFE_BEAD) -> Cell:
    """Unit cell of N steel beads and one of PTFE, in SI units."""
    return Cell.of_spheres([STEEL_BEAD] * N + [ptfe])


def recorded_chain(
    sensors: Sequence[int],
    velocity: float = VELOCITY,
    N: int = 1,
    ptfe: Sphere = PTFE_BEAD,
    beads: int = BEADS,
    gravity: float = 0.0,
) -> Scene:
    """Return the struck N:1 chain, until the pulse has run to the wall and back."""
    momentum = float(STEEL_BEAD.mass) * velocity
    pulse = of_momentum(canonical_wave(chain_cell(N, ptfe), HERTZ), momentum)
    # A pulse with all of the striker's momentum needs two thirds of this time to the wall.
    duration = 1.6 * beads * DIAMETER / float(pulse.speed)
    return chain_scene(velocity, beads, sensors, gravity, duration, N, ptfe)


@study(
    option("--velocity", default=VELOCITY, says="Velocity of the striker in m/s."),
    option("--beads", default=BEADS, says="Number of beads, the striker included."),
    option("--sensors", callback=quantities, default="15,34", says="Two beads; 1 is the striker."),
    option(
        "--gravity",
        flag_value=str(GRAVITY),
        default=0.0,
        show_default=False,
        says="Let the chain stand upright, under its own weight.",
    ),
)
def paper(
    velocity: float = VELOCITY,
    beads: int = BEADS,
    sensors: tuple[int, int] = SENSORS,
    gravity: float = 0.0,
    tolerances: tuple[float, float] = TOLERANCES,
    run_progress: RunProgress = silent,
) -> Report:
    """The experiment of Porter et al. (2008): a chain of steel and PTFE beads in turn is struck at
    one end. Speed, peak force and FWHM on the lattice, and by the theory.

    gravity: in m/s², towards the wall. tolerances: of the run and of the less accurate run that
    gives its errors. Raises `SceneError` for values out of range, and `MeasureError` if the pulse
    is not whole at a sensor before the wall reflects it.

    ``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``: ``quantity``, ``unit``,
    ``lattice_value``, ``lattice_error_value``, and by the quantity that sets the theory's amplitude
    (``F_m``, ``speed``, ``striker``) ``theory_value`` {…} and ``error_value`` {…}, theory over
    lattice - 1.
    """
    velocity = between(velocity, "velocity", 1e-6, 1000)
    beads = integer(beads, "beads", 8, 2000)
    pair = tuple(integer(bead, "sensor", 2, beads - 1) for bead in items(sensors, "sensors"))
    if len(pair) != 2 or not pair[0] < pair[1]:
        wanted = "two beads are wanted, the one nearer to the striker first"
        raise SceneError(f"sensors are {', '.join(map(str, pair))}: {wanted}")
    recorded = sorted({*pair, *chain.from_iterable(like_pairs(pair))})
    scene = recorded_chain(recorded, velocity, beads=beads, gravity=gravity)
    run, check = twice(scene, *tolerances, progress=run_progress)

    def measured(run: Run) -> dict[str, float]:
        return numbers(Train.of(run), Train.of(run, "contact"), pair)

    lattice = compared(measured, run, check, rtol=tolerances[0])
    wave = homogenize(chain_cell(), k=HERTZ).pde.traveling_wave()
    waves = (
        PhysicalWave(wave, lattice["peak bead force F_m"].value, "bead"),
        of_speed(wave, lattice["speed V_s"].value),
        of_momentum(wave, float(STEEL_BEAD.mass) * velocity),
    )
    theories = [theory_numbers(wave, pair) for wave in waves]
    rows = []
    for name, value in lattice.items():
        unit = "µs" if name.endswith("in time") else _UNITS[name.split()[0]]
        pairs = [(theory[name], theory[name] / value.value - 1) for theory in theories]
        rows.append((name, unit, value, *chain.from_iterable(pairs)))
    return Report(
        f"{beads} beads, steel (the striker, {velocity:g} m/s) and PTFE in turn, steel wall, "
        f"{f'gravity {gravity:g} m/s²' if gravity else 'no gravity'}; "
        f"sensors in beads {pair[0]} and {pair[1]}",
        (Table(_COLUMNS, tuple(rows), "rows", note=_NOTE),),
        panels=(_panel(run, pair, waves[0]),),
        data={
            "velocity_value": velocity,
            "beads": beads,
            "sensors": pair,
            "gravity_value": gravity,
        },
        width=80,
    )


def theory_numbers(wave: PhysicalWave, pair: tuple[int, ...] = SENSORS) -> dict[str, float]:
    """Return the `numbers` of the theory's wave; pair : the two sensor beads."""
    V, sensors = float(wave.speed), range(pair[0] - 1, pair[1] + 1)

    def train(peak: float, fwhm: float) -> Train:
        half, times = fwhm / V / 2, {i: i * DIAMETER / V for i in sensors}
        return Train({i: Pulse(t, peak, t - half, t + half) for i, t in times.items()}, DIAMETER)

    beads = train(float(wave.bead_force), bead_fwhm(wave.wave))
    contacts = train(float(wave.contact_force), float(wave.fwhm("force")))
    return numbers(beads, contacts, pair)


def numbers(beads: Train, contacts: Train, pair: tuple[int, ...]) -> dict[str, float]:
    """Return speeds, peak forces and FWHM at the two sensor beads ``pair``, in `_UNITS`.

    Numbers whose names hold no bead are means over both beads or over their four contacts.
    """
    first, second = (beads.only([bead]) for bead in pair)
    both, around = beads.only(pair), contacts.only([b + side for b in pair for side in (-1, 0)])
    sites = both.speed / DIAMETER
    return {
        "speed V_s": both.speed,
        f"peak bead force F_{pair[0]}": first.peak,
        f"peak bead force F_{pair[1]}": second.peak,
        "peak bead force F_m": both.peak,
        "peak contact force": around.peak,
        f"FWHM of F_{pair[0]}": first.fwhm * sites,
        f"FWHM of F_{pair[1]}": second.fwhm * sites,
        "FWHM of bead force": both.fwhm * sites,
        "FWHM of bead force in time": 1e6 * both.fwhm,
        "FWHM of contact force": around.fwhm * sites,
        "FWHM of contact force in time": 1e6 * around.fwhm,
        **{f"speed from bead {a} to {b}": beads.only((a, b)).speed for a, b in like_pairs(pair)},
    }


def like_pairs(pair: tuple[int, ...]) -> list[tuple[int, int]]:
    """Return pairs of like beads (both steel, both PTFE), each next to one of two sensor beads.

    >>> like_pairs((15, 34)), like_pairs((15, 33))
    ([(15, 33), (16, 34)], [])
    """
    first, second = pair
    unlike = (second - first) % 2 and second - first > 1
    return [(first, second - 1), (first + 1, second)] if unlike else []


def _panel(run: Run, pair: tuple[int, ...], theory: PhysicalWave) -> Panel:
    """Return a panel of dynamic forces at two beads, and the theory's wave with each peak."""
    curves = []
    for i, (bead, pulse) in enumerate(Train.of(run).only(pair).pulses.items()):
        (force,) = run.bead_force[[j == bead - 1 for j in run.scene.bead_sensors]]
        wave = theory.curve(run.time - pulse.arrival)
        curves.append(Curve(f"bead {bead}, lattice", 1e6 * run.time, force - force[0], f"C{i}-"))
        curves.append(Curve(f"bead {bead}, theory by F_m", 1e6 * run.time, wave, f"C{i}--"))
    return Panel("time (µs)", "dynamic force, mean of the bead's contacts (N)", tuple(curves))
