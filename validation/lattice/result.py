"""The result of an integration: records of the sensors and the final state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.cost import IntegrationError
from validation.lattice.equations import Motion
from validation.lattice.signal import (
    RECORDS,
    Path,
    SensorSignal,
    beads_at,
    contact_changes,
    quantities,
    sample_times,
    sensed_beads,
)
from validation.pictures import Curve, Map, Panel, Pictured
from validation.scenes.checks import SceneError, one_of
from validation.scenes.columns import BASES
from validation.scenes.scene import Scene

# Sensors of one kind that are drawn as curves, in ten colours; more make a map.
_MOST = 10
_FINEST = 1000  # places, and times, of a map: a picture has some thousand pixels a side


@dataclass(frozen=True, eq=False, repr=False)
class Run(Pictured):
    """Records of the sensors in a simulation, its final state, and the drift of its energy.

    Forces are total: the static force of gravity and precompression is included. S is the number of
    samples; all arrays are read-only.

    Parameters
    ----------
    motion : Motion
        The equations of motion.
    end : array
        Final state, in the order of `Motion.start`.
    steps : int
        Number of steps.
    path : Path, optional
        Motion of the beads near sensors throughout the run; None if it takes too much memory, or
        without sensors.
    samples : array, shape (2, beads, S), optional
        Displacements and velocities of `validation.lattice.signal.sensed_beads` at the sample
        times; None if ``path`` is known.

    Raises
    ------
    IntegrationError
        If the square of a number of the final state is not finite.
    """

    motion: Motion
    end: Array
    steps: int
    path: Path | None = None
    samples: Array | None = None

    def __post_init__(self) -> None:
        # A sum is finite only if all its terms are; squares, as energies overflow, too.
        if not math.isfinite(self.end @ self.end):
            raise IntegrationError(
                "the motion overflows: choose other units, or a step of "
                f"{self.step:g} is too long"
            )
        self.end.setflags(write=False)

    @cached_property
    def time(self) -> Array:
        """Sample times, shape (S,)."""
        time = sample_times(self.scene)
        time.setflags(write=False)
        return time

    @cached_property
    def _records(self) -> dict[str, Array]:
        """All records, by their names in `RECORDS`.

        The quantities are computed for all beads near sensors, from the path or the stored samples,
        and the rows of the sensors are picked out.
        """
        beads = sensed_beads(self.motion)
        samples: Any = self.samples
        if self.path is not None:
            samples = self.path(beads, self.time)
        elif samples is None:
            # Without sensors there is no motion to sample: y and v of no beads.
            samples = np.zeros((2, 0, len(self.time)))
        found = quantities(self.motion, beads, *samples)
        sensors = self.scene.sensors
        records = {}
        for (kind, _), name in RECORDS.items():
            rows = beads.searchsorted(sensors[kind])
            records[name] = found[name][rows]
            records[name].setflags(write=False)
        return records

    @property
    def contact_force(self) -> Array:
        """Forces at the scene's contact sensors, shape (contacts, S)."""
        return self._records["contact_force"]

    @property
    def compression(self) -> Array:
        """Compressions at the contact sensors, shape (contacts, S); negative for a gap."""
        return self._records["compression"]

    @property
    def bead_force(self) -> Array:
        """Means of the forces of the two contacts of the sensors' beads, shape (beads, S)."""
        return self._records["bead_force"]

    @property
    def bead_displacement(self) -> Array:
        """Displacements of the sensors' beads from the equilibrium, shape (beads, S)."""
        return self._records["bead_displacement"]

    @property
    def bead_velocity(self) -> Array:
        """Velocities of the sensors' beads, shape (beads, S)."""
        return self._records["bead_velocity"]

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.motion.scene

    @property
    def displacements(self) -> Array:
        """Displacements of all beads at the end, shape (n,)."""
        return self.end[: self.motion.size]

    @property
    def velocities(self) -> Array:
        """Velocities of all beads at the end, shape (n,)."""
        # A state ends with two energies, the heat and the work of the drive.
        return self.end[self.motion.size : -2]

    @property
    def dissipated(self) -> float:
        """Energy that damped contacts have turned into heat."""
        # A state ends with the heat and the work of the drive.
        return float(self.end[-2])

    @cached_property
    def _gained(self) -> Array:
        """Energies above equilibrium that each bead, then each contact, gained in the run."""
        # One by one: the differences of small energies keep their digits.
        after = self.motion.energies(self.end)
        return np.concatenate(after) - np.concatenate(self.motion.initial_energies)

    @property
    def work(self) -> float:
        """Work of the drive, on the chain and on the driven bead itself; 0 without a drive."""
        driven = self.scene.drive is not None
        # The last number of the final state is the work against the force of the driven bead's
        # contact. The energies begin with the kinetic ones of the beads: ``[:driven]`` takes that
        # of the driven bead, which is the first, and none without a drive.
        return float(self.end[-1] + self._gained[:driven].sum())

    @property
    def step(self) -> float:
        """Mean step."""
        return self.scene.duration / self.steps

    @cached_property
    def energy_drift(self) -> float:
        """Error of the energy at the end.

        The change of the energy above equilibrium, plus the heat, less the work, in units of the
        initial energy, or of the energy of the response to a drive; 0 without energy.
        """
        # The energy of a driven bead, and its rounding, may be far greater than the response.
        # So its energy, entry 0, is left out, and the work, end[-1], is that on the other beads.
        driven = self.scene.drive is not None
        change = self.dissipated - self.end[-1] + self._gained[driven:].sum()
        return float(change) / (self.motion.scales.energy or math.inf)

    def __repr__(self) -> str:
        sensors = len(self.scene.bead_sensors) + len(self.scene.contact_sensors)
        recorded = f"{sensors} sensor{'s' * (sensors != 1)}, {len(self.time)} samples"
        made = f"{self.steps} steps, energy drift {self.energy_drift:.1g}"
        return f"{type(self).__name__}({self.scene}; {made}; {recorded})"

    def label(self, quantity: str) -> str:
        """Return the name of a quantity, such as "bead 1 velocity", with its unit in a SI scene."""
        if not self.scene.units:
            return quantity
        # The last word, such as "force", is the key of the unit.
        return f"{quantity} ({BASES[quantity.split()[-1]]})"

    def columns(self) -> dict[str, Array]:
        """Return time and all records, each (S,), by names such as "bead 15 force (N)"."""
        columns = {self.label("time"): self.time}
        for kind, sensors in self.scene.sensors.items():
            for row, i in enumerate(sensors):
                for (own, quantity), name in RECORDS.items():
                    if own == kind:
                        label = self.label(f"{kind} {i + 1} {quantity}")
                        columns[label] = getattr(self, name)[row]
        return columns

    def pictured(self) -> list[Panel]:
        """Panels of force against time at all sensors; an x–t map for more than ten of a kind."""
        time = self.label("time")
        force = self.label("force")
        curves = []
        maps = []
        for kind, sensors in self.scene.sensors.items():
            forces = getattr(self, RECORDS[kind, "force"])
            if len(sensors) <= _MOST:
                for i, row in zip(sensors, forces, strict=True):
                    curves.append(Curve(f"{kind} {i + 1}", self.time, row))
                continue
            # Rows in the order of the chain; of too many rows, or times, every second, third, …
            rows = np.argsort(sensors)[:: math.ceil(len(sensors) / _FINEST)]
            each = math.ceil(len(self.time) / _FINEST)
            places = np.array(sensors, float)[rows] + 1
            drawn = Map(force, places, self.time[::each], forces[rows, ::each].T)
            maps.append(Panel(kind, time, map=drawn))
        if not curves:
            return maps
        return [Panel(time, force, curves, legend_above=True), *maps]

    def signal(self, kind: str, number: int, quantity: str = "force") -> SensorSignal:
        """Return a quantity at a sensor as a function of time; the records are its samples.

        Parameters
        ----------
        kind : {"contact", "bead"}
            Kind of the sensor.
        number : int
            Number of the contact or bead, from 0, as in the scene's sensors.
        quantity : {"force", "compression", "displacement", "velocity"}
            Compression of a contact; displacement or velocity of a bead; force of either.

        Returns
        -------
        SensorSignal

        Raises
        ------
        SceneError
            Without such a sensor, and if the motion takes too much memory to store.
        """
        if self.path is None:
            raise SceneError(
                "the run has too many steps to keep the motion: read its samples"
            )
        sensors = self.scene.sensors
        one_of(kind, tuple(sensors), "kind")
        one_of(quantity, tuple(q for own, q in RECORDS if own == kind), "quantity")
        if number not in sensors[kind]:
            raise SceneError(
                f"number is {number!r}: the scene has no sensor at this {kind}"
            )
        beads = beads_at(self.motion, {kind: [number]})
        # Contact i joins beads i and i + 1: the contacts between the beads begin at all but one.
        changes = [contact_changes(self.path, int(contact)) for contact in beads[:-1]]
        times = np.unique(np.concatenate((self.path.time, *changes)))
        return SensorSignal(times, self.path, beads, RECORDS[kind, quantity], number)
