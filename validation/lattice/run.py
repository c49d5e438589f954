"""A run of a scene: what its sensors recorded, and how well the motion kept its invariants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lwa.numeric import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import Failure
from validation.scenes.scene import Scene


class IntegrationError(Failure):
    """The integrator could not go on; the message says where and why."""


@dataclass(frozen=True, eq=False)
class Window:
    """What a compiled run on a moving window followed of the chain.

    Beyond the times given here a sensor's contact counts as open and its beads fly on freely.

    reach : beads that are followed behind the front at least.
    left : number of beads left behind by the end.
    decay : smallest ratio of the pulse's peak force to that one reach before; well below 1, the
        tail may overtake the pulse, and then matters.
    contact_until, bead_until : times up to which each contact and bead sensor was followed.
    """

    reach: int
    left: int
    decay: float
    contact_until: Array
    bead_until: Array


@dataclass(frozen=True, eq=False)
class Run:
    """What a scene's sensors recorded, and how well the motion kept its invariants.

    Arrays are read-only; S is the number of samples.

    scene : what was simulated.
    time : (S,).
    contact_force, compression : (contacts, S), at the scene's contact sensors; a gap is a
        negative compression. Static forces are included.
    bead_force, bead_velocity : (beads, S), at the bead sensors; the force is the mean of the
        bead's two contacts.
    displacements, velocities : (n,), at the end.
    energy_drift : change of the energy above equilibrium over its initial value (0 if that is 0);
        beads left behind by a window keep what they had.
    momentum_drift : change of the momentum over Σ m|v| at the end; None with a wall.
    evaluations : of the equations of motion.
    bead_evaluations : the same, times the beads that each one moved.
    step : mean step.
    window : None when the whole chain was integrated throughout.
    """

    scene: Scene
    time: Array
    contact_force: Array
    compression: Array
    bead_force: Array
    bead_velocity: Array
    displacements: Array
    velocities: Array
    energy_drift: float
    momentum_drift: float | None
    evaluations: int
    bead_evaluations: int
    step: float
    window: Window | None = None


def frozen(**arrays: Array) -> dict[str, Any]:
    """The same arrays, read-only from here on."""
    for array in arrays.values():
        array.setflags(write=False)
    return arrays


def finished(
    motion: Motion,
    end: Array,
    records: dict[str, Array],
    *,
    energy: float,
    evaluations: int,
    bead_evaluations: int,
    steps: int,
    window: Window | None = None,
) -> Run:
    """The run that came to this state and energy, with what its sensors recorded."""
    n, before = motion.size, motion.scales.energy
    return Run(
        scene=motion.scene,
        **frozen(**records, displacements=end[:n].copy(), velocities=end[n:].copy()),
        energy_drift=(energy - before) / before if before else 0.0,
        momentum_drift=motion.momentum_drift(end),
        evaluations=evaluations,
        bead_evaluations=bead_evaluations,
        step=motion.scene.duration / steps,
        window=window,
    )
