"""A run of a scene, however it was integrated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import Failure, SceneError
from validation.scenes.scene import Scene

_MOST = 10
"""Names in the legend of a picture."""


class IntegrationError(Failure):
    """The integrator could not go on; the message says where and why."""


@dataclass(frozen=True, eq=False)
class Run:
    """What a scene's sensors recorded, and how well the motion kept its invariants.

    Arrays are read-only; S is the number of samples.

    time : (S,).
    contact_force, compression : (contacts, S), at the scene's contact sensors; a gap is a
        negative compression. Static forces are included.
    bead_force, bead_displacement, bead_velocity : (beads, S), at the bead sensors; the force is the
        mean of the bead's two contacts, the displacement is from the equilibrium.
    displacements, velocities : (n,), at the end.
    energy_drift : change of the energy above equilibrium over its initial value (0 if that is 0);
        beads that a window has left behind keep their energy.
    momentum_drift : change of the momentum over Σ m|v| at the end; None with a wall.
    evaluations : of the equations of motion; bead_evaluations : times the beads each one moved.
    step : the mean one.
    window : number of beads that were followed behind the front; what lies further behind is NaN
        in all arrays. None for the whole chain.
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
    evaluations: int
    bead_evaluations: int
    step: float
    window: int | None = None

    def plot(self, ax: Any = None) -> Any:
        """Draw the forces at the sensors over time into ``ax``, Matplotlib's axes, or a new
        picture's.

        Returns the axes. Raises `SceneError` for a scene without sensors.
        """
        from lwa.wave.plots import axes  # optional, start-up

        contacts, beads = self.scene.contact_sensors, self.scene.bead_sensors
        names = [*(f"contact {i + 1}" for i in contacts), *(f"bead {i + 1}" for i in beads)]
        if not names:
            raise SceneError("plot is asked for, but the scene names no sensors")
        ax = axes(ax)
        for name, force in zip(names, (*self.contact_force, *self.bead_force), strict=True):
            ax.plot(self.time, force, label=name)
        ax.set(xlabel="time", ylabel="force")
        if len(names) <= _MOST:
            # above: within the axes it would lie on a pulse
            place = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0)}
            ax.legend(**place, ncols=min(5, len(names)), fontsize="small", frameon=False)
        return ax


def finished(
    motion: Motion,
    end: Array,
    records: dict[str, Array],
    energy: float,
    momentum: float | None,
    steps: int,
    evaluations: int,
    bead_evaluations: int,
    window: int | None = None,
) -> Run:
    """The run that came to this state, energy and change of momentum."""
    n, before = motion.size, motion.scales.energy
    arrays = records | {"displacements": end[:n].copy(), "velocities": end[n:].copy()}
    for array in arrays.values():
        array.setflags(write=False)
    return Run(
        scene=motion.scene,
        energy_drift=(energy - before) / before if before else 0.0,
        momentum_drift=momentum,
        evaluations=evaluations,
        bead_evaluations=bead_evaluations,
        step=motion.scene.duration / steps,
        window=window,
        **arrays,
    )
