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

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Any

import numpy as np
import sympy as sp

from lwa import Cell, Dimer, canonical_wave, homogenize
from lwa.command.terminal import quantities
from lwa.spheres.hertz import Sphere
from validation.lattice.effort import RunProgress, silent
from validation.lattice.run import Run
from validation.lattice.simulate import twice
from validation.pulses.pulse import Measured, MeasureError, Pulse, compared, highest_pulse, speed
from validation.pulses.sensors import tracks
from validation.report.command import number, option, study
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.report.text import percent
from validation.scenes.chains import chain_scene
from validation.scenes.checks import SceneError, integer, items, real
from validation.scenes.materials import DIAMETER, PTFE_BEAD, STEEL_BEAD, contact_stiffness
from validation.scenes.scene import Scene
from validation.waves.theory import Compacton

HERTZ = sp.Rational(3, 2)
BEADS, SENSORS, VELOCITY = 38, (15, 34), 1.37
"""Of the chain, the striker included; with a sensor, counted from 1; of the striker, in m/s."""
GRAVITY = 9.81  # in m/s²
TOLERANCES = (1e-9, 1e-7)  # of the run that counts, and of the one that gives its errors
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

_COLUMNS = (
    Column("quantity", "quantity"), Column("unit", "unit"),
    Column("lattice", "lattice", error=True),
    *(column for source in SOURCES for column in (
        Column(f"theory_value.{source}", f"by {source}", format=".5g"),
        Column(f"error_value.{source}"), Column("", "error"))),
)  # fmt: skip
_NOTE = """\
The force of a bead is the mean of its two contacts'; what names no bead is the mean over both
sensor beads (odd ones are steel, even ones PTFE) or over their four contacts. The theory's
amplitude is set by F_m, by the speed, or by all of the striker's momentum; error: theory/lattice
- 1. ±: the error of the integration."""


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

    @property
    def cells(self) -> tuple[Any, ...]:
        """Of a table: by source the theory's number and its error, for programs and for people."""
        by_source = (
            (self.theory[source], self.error(source),
             "set" if quantity == self.quantity else percent(self.error(source)))
            for source, quantity in SOURCES.items()
        )  # fmt: skip
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

    def report(self) -> Report:
        """``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``: ``quantity``,
        ``unit``, ``lattice_value``, ``lattice_error_value``, and by what sets the theory's
        amplitude (``F_m``, ``speed``, ``striker``) ``theory_value`` {…} and ``error_value`` {…};
        in the picture the forces at both sensors over time."""
        gravity = f"gravity {self.gravity:g} m/s²" if self.gravity else "no gravity"
        return Report(
            f"{self.beads} beads, steel (the striker, {self.velocity:g} m/s) and PTFE in turn, "
            f"steel wall, {gravity}; sensors in beads {self.sensors[0]} and {self.sensors[1]}",
            (Table(_COLUMNS, tuple(row.cells for row in self.rows), "rows"),),
            panels=(Panel("time (µs)", "force, mean of the bead's contacts (N)", self.records),),
            notes=(_NOTE,),
            data={"velocity_value": self.velocity, "beads": self.beads, "sensors": self.sensors,
                  "gravity_value": self.gravity},
        )  # fmt: skip


@dataclass(frozen=True)
class Train:
    """A run's dynamic pulses by the numbers of beads or contacts, from before the wall's answer."""

    pulses: Mapping[int, Pulse]

    @classmethod
    def of(cls, run: Run, kind: str = "bead") -> Train:
        """At the sensors of that kind, "bead" or "contact", but the wall's; raises `MeasureError`
        where a pulse is not whole."""
        end = float(run.time[np.argmax(run.contact_force[-1])])
        pulses = {}
        for track in tracks(run)[:-1]:  # the last one is the wall's
            if track.kind == kind:
                try:
                    pulses[track.number] = highest_pulse(track.force, end)
                except MeasureError as error:
                    place = f"{kind} {track.number}, before the wave reaches the wall"
                    raise MeasureError(f"{place}: {error}") from None
        return cls(pulses)

    def only(self, wanted: Callable[[int], bool]) -> Train:
        """At the wanted numbers."""
        return Train({number: pulse for number, pulse in self.pulses.items() if wanted(number)})

    @property
    def speed(self) -> float:
        """From the first bead to the last, in m/s."""
        first, last = min(self.pulses), max(self.pulses)
        return speed(self.pulses[first], self.pulses[last], (last - first) * DIAMETER)

    @property
    def peak(self) -> float:
        """The mean, in N."""
        return float(np.mean([pulse.peak for pulse in self.pulses.values()]))

    @property
    def fwhm(self) -> float:
        """The mean, in s."""
        return float(np.mean([pulse.fwhm for pulse in self.pulses.values()]))


def chain_cell(N: int = 1, ptfe: Sphere = PTFE_BEAD) -> Cell:
    """N steel beads and one of PTFE, in SI units."""
    row = [STEEL_BEAD] * N + [ptfe, STEEL_BEAD]
    stiffnesses = [contact_stiffness(*pair) for pair in pairwise(row)]
    return Dimer(STEEL_BEAD.mass, ptfe.mass, N, stiffnesses=stiffnesses, spacing=DIAMETER)


def recorded_chain(
    sensors: Sequence[int], velocity: float = VELOCITY, N: int = 1, ptfe: Sphere = PTFE_BEAD,
    beads: int = BEADS,
) -> Scene:  # fmt: skip
    """The N:1 chain, struck, for as long as the pulse takes to its wall."""
    wave = canonical_wave(chain_cell(N, ptfe), HERTZ)
    pulse = Compacton.of_momentum(wave, float(STEEL_BEAD.mass) * velocity)
    duration = 1.6 * beads * DIAMETER / pulse.speed
    return chain_scene(velocity, beads, sensors, 0.0, duration, N, ptfe)


def chain_runs(sensors: Sequence[int], **options: Any) -> tuple[Run, Run]:
    """`recorded_chain`: the run that counts, and one that gives its errors."""
    return twice(recorded_chain(sensors, **options), *TOLERANCES)


@study(
    option("--velocity", callback=number, default=str(VELOCITY), says="Of the striker, in m/s."),
    option("--beads", default=BEADS, says="In the chain, the striker included."),
    option("--sensors", callback=quantities, default="15,34",
           says="The two beads that are compared, counted from the striker, 1."),
    option("--gravity", flag_value=GRAVITY, default=0.0, type=float, show_default=False,
           says="Let the chain stand upright, under its own weight."),
)  # fmt: skip
def paper(
    velocity: float = VELOCITY, beads: int = BEADS, sensors: tuple[int, int] = SENSORS,
    gravity: float = 0.0, run_progress: RunProgress = silent,
) -> Paper:  # fmt: skip
    """The steel:PTFE chain of the paper: speed, peak force and FWHM.

    Gravity is in m/s², towards the wall. Raises `SceneError` for values that cannot be meant,
    `MeasureError` where the pulse is not whole at a sensor before the wall throws it back.
    """
    if not 1e-6 <= real(velocity, "velocity") <= 1000:
        raise SceneError(f"velocity is {velocity:g} m/s: one from 1e-6 to 1000 is wanted")
    beads = integer(beads, "beads", 8, 2000)
    pair = tuple(integer(bead, "sensor", 2, beads - 1) for bead in items(sensors, "sensors"))
    if len(pair) != 2 or not pair[0] < pair[1]:
        wanted = "two beads are wanted, the one nearer to the striker first"
        raise SceneError(f"sensors are {', '.join(map(str, pair))}: {wanted}")
    wave = homogenize(chain_cell(), k=HERTZ).pde.traveling_wave()
    striker = Compacton.of_momentum(wave, float(STEEL_BEAD.mass) * velocity)
    # Ample: the pulse that had all the momentum would need two thirds of this to the wall.
    duration = 1.5 * beads * DIAMETER / striker.speed
    scene = chain_scene(velocity, beads, pair, gravity, duration)
    run, check = twice(scene, 1e-10, 1e-7, progress=run_progress)
    numbers = compared(_numbers, run, check)
    waves = {
        "F_m": Compacton.of_bead_force(wave, numbers["peak bead force F_m"].value),
        "speed": Compacton.of_speed(wave, numbers["speed V_s"].value),
        "striker": striker,
    }
    rows = tuple(
        Comparison(name.format(first=pair[0], second=pair[1]), unit, numbers[name],
                   {source: theory(wave) for source, wave in waves.items()})
        for name, (unit, theory) in QUANTITIES.items()
    )  # fmt: skip
    return Paper(velocity, beads, pair, gravity, rows, tuple(_records(run, waves["F_m"])))


def _numbers(run: Run) -> dict[str, float]:
    """The lattice's `QUANTITIES`."""
    beads, contacts = Train.of(run), Train.of(run, "contact")
    first, second = beads.pulses.values()
    sites = beads.speed / DIAMETER
    return {
        "speed V_s": beads.speed,
        "peak bead force F_{first}": first.peak,
        "peak bead force F_{second}": second.peak,
        "peak bead force F_m": beads.peak,
        "peak contact force": contacts.peak,
        "FWHM of F_{first}": first.fwhm * sites,
        "FWHM of F_{second}": second.fwhm * sites,
        "FWHM of bead force": beads.fwhm * sites,
        "FWHM of bead force in time": 1e6 * beads.fwhm,
        "FWHM of contact force": contacts.fwhm * sites,
        "FWHM of contact force in time": 1e6 * contacts.fwhm,
    }


def _records(run: Run, theory: Compacton) -> Iterator[Curve]:
    """Dynamic forces over time, the theory's with its peak where the lattice's is."""
    pulses = Train.of(run).pulses.items()
    for i, ((bead, pulse), force) in enumerate(zip(pulses, run.bead_force, strict=True)):
        line = theory.bead_force(theory.speed * (run.time - pulse.arrival))
        name = "" if i else "theory, amplitude from F_m"
        yield Curve(f"bead {bead}, lattice", 1e6 * run.time, force - force[0], f"C{i}-")
        yield Curve(name, 1e6 * run.time, line, f"C{i}--")
