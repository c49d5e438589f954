"""The result of an integration: records of the sensors and the final state."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.cost import IntegrationError
from validation.lattice.equations import Motion
from validation.lattice.signal import Path, SensorSignal, signal
from validation.pictures import Curve, Map, Panel, Pictured
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene

_SI = {
    "time": "s",
    "arrival": "s",
    "FWHM": "s",
    "force": "N",
    "compression": "m",
    "displacement": "m",
    "velocity": "m/s",
}
_MOST = 10  # sensors of one kind that are drawn as curves; more are drawn as a map
_FINEST = 1000  # places, and times, of a map


@dataclass(frozen=True, eq=False, repr=False)
class Run(Pictured):
    """Records of the sensors in a simulation, its final state, and the drift of its invariants.

    Forces are total: the static force of gravity and precompression is included. S is the number of
    samples; all arrays are read-only.

    time : (S,), sample times.
    contact_force, compression : (contacts, S), at the scene's contact sensors; the compression of a
        gap is negative.
    bead_force, bead_displacement, bead_velocity : (beads, S), at the bead sensors; the force is the
        mean of the bead's two contacts, the displacement counts from the equilibrium.
    displacements, velocities : (n,), of all beads at the end.
    energy_drift : change of the energy above equilibrium, plus the dissipated energy, less the
        drive's work, divided by the scene's scale of the energy: the initial energy, or the energy
        of the response to a drive (0 if this is 0).
    momentum_drift : change of the momentum divided by Σ m|v| at the end; None with a wall or drive.
    step : mean step.
    path : motion of the beads near sensors throughout the run, for `signal`.
    dissipated, work : energy that damped contacts have turned into heat, and work of the drive.
    """

    scene: Scene
    time: Array
    contact_force: Array
    compression: Array
    bead_force: Array
    bead_displacement: Array
    bead_velocity: Array
    displacements: Array
    velocities: Array
    energy_drift: float
    momentum_drift: float | None
    step: float
    path: Path | None = field(default=None, compare=False)
    dissipated: float = 0.0
    work: float = 0.0

    def __repr__(self) -> str:
        sensors = len(self.scene.bead_sensors) + len(self.scene.contact_sensors)
        recorded = f"{sensors} sensor{'s' * (sensors != 1)}, {len(self.time)} samples"
        steps = round(self.scene.duration / self.step)
        made = f"{steps} steps, energy drift {self.energy_drift:.1g}"
        return f"{type(self).__name__}({self.scene}; {made}; {recorded})"

    def label(self, quantity: str) -> str:
        """Return the name of a quantity, such as "bead 1 velocity", with its unit in a SI scene."""
        return (
            f"{quantity} ({_SI[quantity.split()[-1]]})"
            if self.scene.units
            else quantity
        )

    def columns(self) -> dict[str, Array]:
        """Return time and all records, each (S,), by names such as "bead 15 force (N)"."""
        scene = self.scene
        values = {"time": self.time}
        for row, i in enumerate(scene.bead_sensors):
            for quantity in ("force", "displacement", "velocity"):
                values[f"bead {i + 1} {quantity}"] = getattr(self, f"bead_{quantity}")[
                    row
                ]
        for row, i in enumerate(scene.contact_sensors):
            values[f"contact {i + 1} force"] = self.contact_force[row]
            values[f"contact {i + 1} compression"] = self.compression[row]
        return {self.label(name): row for name, row in values.items()}

    def pictured(self) -> list[Panel]:
        """Panels of force against time at all sensors; an x–t map for more than ten of a kind."""
        time, force = self.label("time"), self.label("force")
        curves, maps = [], []
        for kind in ("bead", "contact"):
            sensors, forces = (
                getattr(self.scene, f"{kind}_sensors"),
                getattr(self, f"{kind}_force"),
            )
            if len(sensors) <= _MOST:
                rows = zip(sensors, forces, strict=True)
                curves += [Curve(f"{kind} {i + 1}", self.time, row) for i, row in rows]
            else:
                x = np.argsort(sensors)[:: -(-len(sensors) // _FINEST)]
                t = slice(None, None, -(-len(self.time) // _FINEST))
                places = np.array(sensors, float)[x] + 1
                forces_map = Map(force, places, self.time[t], forces[x, t].T)
                maps.append(Panel(kind, time, map=forces_map))
        return (
            [Panel(time, force, tuple(curves), legend_above=True), *maps]
            if curves
            else maps
        )

    def signal(self, kind: str, number: int, quantity: str = "force") -> SensorSignal:
        """Return a quantity at a sensor as a function of time; the records are its samples.

        Parameters
        ----------
        kind : "contact" or "bead".
        number : number of the contact or bead, from 0, as in the scene's sensors.
        quantity : "force"; "compression" of a contact; "displacement" or "velocity" of a bead.

        Raises `SceneError` without such a sensor, and if the motion takes too much memory to store.
        """
        if self.path is None:
            raise SceneError(
                "the run has too many steps to keep the motion: read its samples"
            )
        return signal(self.path, kind, number, quantity)


def finished(
    motion: Motion, end: Array, records: dict[str, Array], *, steps: int, **fields: Any
) -> Run:
    """Return the `Run` of a motion with the final state ``end``.

    fields : further fields of the `Run`. Raises `IntegrationError` if a number is not finite.
    """
    n, scale = motion.size, motion.scales.energy
    final = {"displacements": end[:n].copy(), "velocities": end[n : 2 * n].copy()}
    arrays: dict[str, Any] = records | final
    dissipated, work = map(float, end[2 * n :])
    drift = motion.energy(end) - motion.initial_energy + dissipated - work
    step = motion.scene.duration / steps
    sums = [float(row.sum()) for row in arrays.values() if row.size]
    if not math.isfinite(drift + sum(sums)):
        raise IntegrationError(
            f"the motion overflows: choose other units, or a step of {step:g} is too long"
        )
    for array in arrays.values():
        array.setflags(write=False)
    return Run(
        scene=motion.scene,
        energy_drift=drift / scale if scale else 0.0,
        momentum_drift=motion.momentum_drift(end),
        step=step,
        dissipated=dissipated,
        work=work,
        **arrays,
        **fields,
    )
