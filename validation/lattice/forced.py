"""The equations of motion of a scene with damping or a drive.

Damping makes forces depend on velocities, and a drive makes the motion of bead 0 depend on time.
The state has two more components than without them: dissipated energy and work of the drive.
"""

from __future__ import annotations

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.scene import Scene


class ForcedMotion(Motion):
    """The time derivative, as in `Motion`, of the state (y, v, dissipated energy, drive's work)."""

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self.start = np.append(self.start, (0.0, 0.0))
        if scene.drive is not None:
            self.start[0], self.start[self.size], _ = scene.drive.at(0.0)

    @property
    def driven(self) -> float:
        drive = self.scene.drive
        return 0.0 if drive is None else float(self.masses.mean() * drive.fastest**2)

    def __call__(self, time: float, state: Array) -> Array:
        n, drive, work = self.size, self.scene.drive, 0.0
        y, v = state[:n].copy(), state[n : 2 * n].copy()
        acceleration = np.zeros(n)
        if drive is not None:
            y[0], v[0], acceleration[0] = drive.at(time)
        compression, rate = self.compression(y), self.rate(v)
        elastic, load = self.force(compression), self.load
        force = self.contact.damped(elastic, self.damping, compression, rate)
        push = np.zeros(n)
        push[: len(force)] = load - force
        push[1:] += (force - load)[: n - 1]
        free = slice(0 if drive is None else 1, None)
        acceleration[free] = push[free] / self.masses[free]
        if drive is not None:
            work = v[0] * (self.masses[0] * acceleration[0] - push[0])
        return np.concatenate((v, acceleration, (((force - elastic) * rate).sum(), work)))

    def balance(self, state: Array) -> float:
        gained = self.energy(state) - self.energy(self.start)
        dissipated, work = state[2 * self.size :]
        return float(self.scales.energy + gained + dissipated - work)


def motion_of(scene: Scene) -> Motion:
    """Return the equations of motion of a scene, a `ForcedMotion` with damping or a drive."""
    forced = scene.damping is not None or scene.drive is not None
    return ForcedMotion(scene) if forced else Motion(scene)
