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

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
import sympy as sp

from lwa import Cell, PhysicalWave, Sphere, canonical_wave, homogenize
from lwa.command.reading import quantities
from validation.lattice.cost import RunProgress, silent
from validation.lattice.run import Run
from validation.lattice.simulate import twice
from validation.pictures.panel import Curve, Panel
from validation.pulses.pulse import Measured, MeasureError, Pulse, compared, highest_pulse, speed
from validation.pulses.sensors import tracks
from validation.report.command import number, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.report.text import percent
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


@dataclass(frozen=True)
class Comparison:
    """A number of the lattice and the theory's, for each of `SOURCES`."""

    quantity: str
    lattice: Measured
    theory: Mapping[str, float]

    @property
    def unit(self) -> str:
        """The unit of the quantity."""
        return "µs" if self.quantity.endswith("in time") else UNITS[self.quantity.split()[0]]

    def error(self, source: str) -> float:
        """Theory over lattice, less 1."""
        return self.theory[source] / self.lattice.value - 1

    @property
    def cells(self) -> tuple[Any, ...]:
        """Cells of the table."""
        by_source = (
            (
                self.theory[source],
                self.error(source),
                "set" if quantity == self.quantity else percent(self.error(source)),
            )
            for source, quantity in SOURCES.items()
        )
        return self.quantity, self.unit, self.lattice, *chain.from_iterable(by_source)


@dataclass(frozen=True, eq=False)
class Paper:
    """The chain, its numbers beside the theory's, and the force records at the sensors."""

    velocity: float
    beads: int
    sensors: tuple[int, int]
    gravity: float
    rows: tuple[Comparison, ...]
    records: tuple[Curve, ...]
    notes: tuple[str, ...]

    def report(self) -> Report:
        """``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``: ``quantity``,
        ``unit``, ``lattice_value``, ``lattice_error_value``, and by what sets the theory's
        amplitude (``F_m``, ``speed``, ``striker``) ``theory_value`` {…} and ``error_value`` {…}.
        """
        gravity = f"gravity {self.gravity:g} m/s²" if self.gravity else "no gravity"
        return Report(
            f"{self.beads} beads, steel (the striker, {self.velocity:g} m/s) and PTFE in turn, "
            f"steel wall, {gravity}; sensors in beads {self.sensors[0]} and {self.sensors[1]}",
            (Table(_COLUMNS, tuple(row.cells for row in self.rows), "rows"),),
            panels=(
                Panel("time (µs)", "dynamic force, mean of the bead's contacts (N)", self.records),
            ),
            notes=self.notes,
            data={
                "velocity_value": self.velocity,
                "beads": self.beads,
                "sensors": self.sensors,
                "gravity_value": self.gravity,
            },
        )


@dataclass(frozen=True)
class Train:
    """Pulses by bead or contact number, in s and N."""

    pulses: Mapping[int, Pulse]

    @classmethod
    def of(cls, run: Run, kind: str = "bead") -> Train:
        """Dynamic pulses at the "bead" or "contact" sensors of a run, before the wall's answer.

        The last contact sensor is the wall's. Raises `MeasureError` if a pulse is not whole.
        """
        end = float(run.time[np.argmax(run.contact_force[-1])])
        pulses = {}
        for track in tracks(run)[:-1]:
            if track.kind == kind:
                try:
                    pulses[track.number] = highest_pulse(track.force, end)
                except MeasureError as error:
                    place = f"{kind} {track.number}, before the wave reaches the wall"
                    raise MeasureError(f"{place}: {error}") from None
        return cls(pulses)

    @classmethod
    def expected(cls, wave: PhysicalWave, sensors: Iterable[int], kind: str = "bead") -> Train:
        """The theory's pulses at these sensors."""
        V, peak = float(wave.speed), wave.bead_force if kind == "bead" else wave.contact_force
        half = (bead_fwhm(wave.wave) if kind == "bead" else float(wave.fwhm("force"))) / V / 2
        times = {number: number * DIAMETER / V for number in sensors}
        return cls({i: Pulse(t, float(peak), t - half, t + half) for i, t in times.items()})

    def only(self, wanted: Container[int]) -> Train:
        """The pulses at the wanted numbers."""
        return Train({number: pulse for number, pulse in self.pulses.items() if number in wanted})

    @property
    def speed(self) -> float:
        """Speed from the first number to the last, in m/s."""
        first, last = min(self.pulses), max(self.pulses)
        return speed(self.pulses[first], self.pulses[last], (last - first) * DIAMETER)

    @property
    def peak(self) -> float:
        """Mean peak, in N."""
        return float(np.mean([pulse.peak for pulse in self.pulses.values()]))

    @property
    def fwhm(self) -> float:
        """Mean FWHM, in s."""
        return float(np.mean([pulse.fwhm for pulse in self.pulses.values()]))


def chain_cell(N: int = 1, ptfe: Sphere = PTFE_BEAD) -> Cell:
    """N steel beads and one of PTFE, in SI units."""
    return Cell.of_spheres([STEEL_BEAD] * N + [ptfe])


def recorded_chain(
    sensors: Sequence[int],
    velocity: float = VELOCITY,
    N: int = 1,
    ptfe: Sphere = PTFE_BEAD,
    beads: int = BEADS,
) -> Scene:
    """The struck N:1 chain without gravity, for the flight of the pulse to the wall and back."""
    pulse = of_momentum(canonical_wave(chain_cell(N, ptfe), HERTZ), _momentum(velocity))
    duration = 1.6 * beads * DIAMETER / float(pulse.speed)
    return chain_scene(velocity, beads, sensors, 0.0, duration, N, ptfe)


def chain_runs(sensors: Sequence[int], **options: Any) -> tuple[Run, Run]:
    """`recorded_chain`: the run that counts and the run that gives its errors."""
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
) -> Paper:
    """The steel:PTFE chain of the paper: speed, peak force and FWHM.

    Gravity is in m/s², towards the wall. Raises `SceneError` for values out of range, and
    `MeasureError` if the pulse is not whole at a sensor before the wall throws it back.
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
    found = compared(lambda run: numbers(Train.of(run), Train.of(run, "contact"), pair), run, check)
    waves = {
        "F_m": PhysicalWave(wave, found["peak bead force F_m"].value, "bead"),
        "speed": of_speed(wave, found["speed V_s"].value),
        "striker": striker,
    }
    theory = {source: theory_numbers(wave, pair) for source, wave in waves.items()}
    rows = tuple(
        Comparison(name, value, {source: theory[source][name] for source in SOURCES})
        for name, value in found.items()
    )
    records = tuple(_records(run, pair, waves["F_m"]))
    return Paper(velocity, beads, pair, gravity, rows, records, (_NOTE, *_speeds(rows)))


def theory_numbers(wave: PhysicalWave, pair: tuple[int, ...] = SENSORS) -> dict[str, float]:
    """`numbers` of the theory's wave."""
    heard = range(pair[0] - 1, pair[1] + 1)
    return numbers(Train.expected(wave, heard), Train.expected(wave, heard, "contact"), pair)


def numbers(beads: Train, contacts: Train, pair: tuple[int, ...]) -> dict[str, float]:
    """Speeds, peak forces and FWHM at two sensor beads, in `UNITS`.

    Numbers that name no bead are means over both beads or over their four contacts.
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
    """Pairs of beads of one kind next to two beads of different kinds.

    >>> like_pairs((15, 34)), like_pairs((15, 33))
    ([(15, 33), (16, 34)], [])
    """
    first, second = pair
    unlike = (second - first) % 2 and second - first > 1
    return [(first, second - 1), (first + 1, second)] if unlike else []


def _speeds(rows: Sequence[Comparison]) -> Iterator[str]:
    """The speed V_s between unlike beads beside the speeds between beads of one kind."""
    found = {row.quantity: row for row in rows}
    like = [row.lattice.value for name, row in found.items() if name.startswith("speed from")]
    if like:
        V, F, mean = found["speed V_s"], found["peak bead force F_m"].lattice.value, np.mean(like)
        canonical = PhysicalWave(canonical_wave(chain_cell(), HERTZ), F, "bead")
        off = (percent(float(c / mean - 1)) for c in (V.theory["F_m"], float(canonical.speed)))
        yield (
            f"V_s, {V.lattice.value:.2f} m/s, compares peaks of different shape, in steel and in "
            f"PTFE. Between beads of one kind the pulse has {like[0]:.2f} and {like[1]:.2f} m/s; "
            "off their mean are, at F_m, the theory by {} and the canonical wave by {}.".format(
                *off
            )
        )


def _records(run: Run, pair: tuple[int, ...], theory: PhysicalWave) -> Iterator[Curve]:
    """Dynamic forces over time; the theory's peak stands at the lattice's."""
    pulses = Train.of(run).pulses
    forces = dict(zip(run.scene.bead_sensors, run.bead_force, strict=True))
    for i, bead in enumerate(pair):
        line = theory.curve(run.time - pulses[bead].arrival)
        force = forces[bead - 1]
        yield Curve(f"bead {bead}, lattice", 1e6 * run.time, force - force[0], f"C{i}-")
        yield Curve(f"bead {bead}, theory by F_m", 1e6 * run.time, line, f"C{i}--")
