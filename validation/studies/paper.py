"""The experiment of Porter et al. (2008) on the lattice, beside the theory.

A steel bead strikes a chain in which PTFE and steel beads alternate. The chain has 38 beads,
numbered from 1 (the striker), and ends in a steel wall. As in the paper, sensors sit in beads 15
and 34, the peak force is F_m = (F_15 + F_34)/2, the speed V_s is the distance of the two beads over
the time between their peaks, and forces are dynamic: static forces of gravity are subtracted. The
force of a bead is the mean of its two contacts' forces.

Bead 15 is steel and bead 34 PTFE: the shapes of their pulses differ, so that V_s is not the speed
of the pulse. The speed between beads of one kind stands beside it.

The amplitude of the theory's wave is set in turn by F_m, by V_s, and by the striker's momentum, as
if the pulse took all of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np
import sympy as sp

from lwa import Cell, PhysicalWave, Sphere, canonical_wave, homogenize
from lwa.command.options import quantities
from validation.lattice.run import Run, RunProgress, silent
from validation.lattice.simulate import twice
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, Pulse, compared
from validation.pulses.train import Train
from validation.report.command import number, option, study
from validation.report.result import Report
from validation.report.table import Column, Table, percent
from validation.scenes.chains import chain_scene
from validation.scenes.checks import SceneError, integer, items, real
from validation.scenes.materials import DIAMETER, PTFE_BEAD, STEEL_BEAD
from validation.scenes.scene import Scene
from validation.waves.theory import bead_fwhm, of_momentum, of_speed

HERTZ = sp.Rational(3, 2)
BEADS, SENSORS = 38, (15, 34)  # numbered from the striker, 1
VELOCITY, GRAVITY = 1.37, 9.81  # of the striker in m/s; in m/s²
TOLERANCES = (1e-10, 1e-7)  # rtol of the run that counts and of the run that gives its errors
SOURCES = {"F_m": "peak bead force F_m", "speed": "speed V_s", "striker": None}
"""Quantity that sets the theory's amplitude → the quantity that then agrees by construction."""

UNITS = {"speed": "m/s", "peak": "N", "FWHM": "sites"}  # by the first word; µs "in time"

_COLUMNS = (
    Column("quantity", "quantity"),
    Column("unit", "unit"),
    Column("lattice", "lattice", error=True),
    *(
        column
        for source in SOURCES
        for column in (
            Column(f"theory_value.{source}", f"by {source}", format=".5g"),
            Column(f"error_value.{source}"),
            Column("", "error"),
        )
    ),
)
_NOTE = """\
The force of a bead is the mean of its two contacts'; numbers that name no bead are means over both
sensor beads (odd ones are steel, even ones PTFE) or over their four contacts. The theory's
amplitude is set by F_m, by V_s, or by all of the striker's momentum; error: theory/lattice - 1.
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
) -> Scene:
    """Return the struck N:1 chain without gravity, until the pulse has run to the wall and back."""
    pulse = of_momentum(canonical_wave(chain_cell(N, ptfe), HERTZ), _momentum(velocity))
    duration = 1.6 * beads * DIAMETER / float(pulse.speed)
    return chain_scene(velocity, beads, sensors, 0.0, duration, N, ptfe)


def chain_runs(sensors: Sequence[int], **options: Any) -> tuple[Run, Run]:
    """Simulate a `recorded_chain` at both of `TOLERANCES`; return the finer run first."""
    return twice(recorded_chain(sensors, **options), *TOLERANCES)


def _momentum(velocity: float) -> float:
    return float(STEEL_BEAD.mass) * velocity


@study(
    option("--velocity", callback=number, default=str(VELOCITY), says="Of the striker, in m/s."),
    option("--beads", default=BEADS, says="Number of beads, the striker included."),
    option("--sensors", callback=quantities, default="15,34", says="Two beads; the striker is 1."),
    option(
        "--gravity",
        flag_value=GRAVITY,
        default=0.0,
        type=float,
        show_default=False,
        says="Let the chain stand upright, under its own weight.",
    ),
)
def paper(
    velocity: float = VELOCITY,
    beads: int = BEADS,
    sensors: tuple[int, int] = SENSORS,
    gravity: float = 0.0,
    run_progress: RunProgress = silent,
) -> Report:
    """The steel:PTFE chain of the paper: speed, peak force and FWHM.

    Gravity is in m/s², towards the wall. Raises `SceneError` for values out of range, and
    `MeasureError` if the pulse is not whole at a sensor before the wall throws it back.

    ``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``: ``quantity``, ``unit``,
    ``lattice_value``, ``lattice_error_value``, and by what sets the theory's amplitude (``F_m``,
    ``speed``, ``striker``) ``theory_value`` {…} and ``error_value`` {…}, theory over lattice - 1.
    """
    if not 1e-6 <= real(velocity, "velocity") <= 1000:
        raise SceneError(f"velocity is {velocity:g} m/s: one from 1e-6 to 1000 is wanted")
    beads = integer(beads, "beads", 8, 2000)
    pair = tuple(integer(bead, "sensor", 2, beads - 1) for bead in items(sensors, "sensors"))
    if len(pair) != 2 or not pair[0] < pair[1]:
        wanted = "two beads are wanted, the one nearer to the striker first"
        raise SceneError(f"sensors are {', '.join(map(str, pair))}: {wanted}")
    wave = homogenize(chain_cell(), k=HERTZ).pde.traveling_wave()
    striker = of_momentum(wave, _momentum(velocity))
    # Ample: a pulse with all of the momentum needs two thirds of this to the wall.
    duration = 1.5 * beads * DIAMETER / float(striker.speed)
    heard = sorted({*pair, *chain.from_iterable(like_pairs(pair))})
    scene = chain_scene(velocity, beads, heard, gravity, duration)
    run, check = twice(scene, *TOLERANCES, progress=run_progress)
    lattice = compared(
        lambda run: numbers(Train.of(run), Train.of(run, "contact"), pair), run, check
    )
    by_force = PhysicalWave(wave, lattice["peak bead force F_m"].value, "bead")
    by_speed = of_speed(wave, lattice["speed V_s"].value)
    waves = dict(zip(SOURCES, (by_force, by_speed, striker), strict=True))
    theory = {source: theory_numbers(found, pair) for source, found in waves.items()}
    rows = tuple(
        _row(name, value, {source: theory[source][name] for source in SOURCES})
        for name, value in lattice.items()
    )
    under = f"gravity {gravity:g} m/s²" if gravity else "no gravity"
    curves = tuple(_records(run, pair, by_force))
    return Report(
        f"{beads} beads, steel (the striker, {velocity:g} m/s) and PTFE in turn, steel wall, "
        f"{under}; sensors in beads {pair[0]} and {pair[1]}",
        (Table(_COLUMNS, rows, "rows"),),
        panels=(Panel("time (µs)", "dynamic force, mean of the bead's contacts (N)", curves),),
        notes=(_NOTE, *_speeds(lattice, theory["F_m"])),
        data={
            "velocity_value": velocity,
            "beads": beads,
            "sensors": pair,
            "gravity_value": gravity,
        },
    )


def _row(quantity: str, lattice: Measured, theory: Mapping[str, float]) -> tuple[Any, ...]:
    """Return cells of the table: the lattice's number, the theory's and its error by `SOURCES`."""
    unit = "µs" if quantity.endswith("in time") else UNITS[quantity.split()[0]]
    cells: list[Any] = []
    for source, value in theory.items():
        error = value / lattice.value - 1
        cells += [value, error, "set" if SOURCES[source] == quantity else percent(error)]
    return quantity, unit, lattice, *cells


def theory_numbers(wave: PhysicalWave, pair: tuple[int, ...] = SENSORS) -> dict[str, float]:
    """Return the `numbers` of the theory's wave; pair : the two sensor beads."""
    V, sensors = float(wave.speed), range(pair[0] - 1, pair[1] + 1)

    def train(peak: Any, fwhm: float) -> Train:
        half, times = fwhm / V / 2, {i: i * DIAMETER / V for i in sensors}
        pulses = {i: Pulse(t, float(peak), t - half, t + half) for i, t in times.items()}
        return Train(pulses, DIAMETER)

    beads = train(wave.bead_force, bead_fwhm(wave.wave))
    return numbers(beads, train(wave.contact_force, float(wave.fwhm("force"))), pair)


def numbers(beads: Train, contacts: Train, pair: tuple[int, ...]) -> dict[str, float]:
    """Return speeds, peak forces and FWHM at the two sensor beads ``pair``, in `UNITS`.

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
    """Return pairs of beads of one kind next to two sensor beads of different kinds.

    >>> like_pairs((15, 34)), like_pairs((15, 33))
    ([(15, 33), (16, 34)], [])
    """
    first, second = pair
    unlike = (second - first) % 2 and second - first > 1
    return [(first, second - 1), (first + 1, second)] if unlike else []


def _speeds(lattice: Mapping[str, Measured], theory: Mapping[str, float]) -> Iterator[str]:
    """Yield a sentence on V_s between unlike beads and the speeds between beads of one kind."""
    like = [number.value for name, number in lattice.items() if name.startswith("speed from")]
    if like:
        V, F = lattice["speed V_s"].value, lattice["peak bead force F_m"].value
        canonical = PhysicalWave(canonical_wave(chain_cell(), HERTZ), F, "bead")
        speeds = theory["speed V_s"], float(canonical.speed)
        off = [percent(float(c / np.mean(like) - 1)) for c in speeds]
        yield (
            f"V_s, {V:.2f} m/s, compares peaks of different shape, in steel and in PTFE. Between "
            f"beads of one kind the pulse has {like[0]:.2f} and {like[1]:.2f} m/s; off their mean "
            f"are, at F_m, the theory by {off[0]} and the canonical wave by {off[1]}."
        )


def _records(run: Run, pair: tuple[int, ...], theory: PhysicalWave) -> Iterator[Curve]:
    """Yield curves of dynamic force against time, and the theory's shifted to the same peak."""
    pulses = Train.of(run).pulses
    forces = dict(zip(run.scene.bead_sensors, run.bead_force, strict=True))
    for i, bead in enumerate(pair):
        line = theory.curve(run.time - pulses[bead].arrival)
        force = forces[bead - 1]
        yield Curve(f"bead {bead}, lattice", 1e6 * run.time, force - force[0], f"C{i}-")
        yield Curve(f"bead {bead}, theory by F_m", 1e6 * run.time, line, f"C{i}--")
