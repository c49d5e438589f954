"""Integration by SciPy's `solve_ivp`, whose dense output gives samples and signals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from lwa.base.arrays import Array
from validation.lattice.cost import IntegrationError, check_memory, step_limit
from validation.lattice.equations import Motion
from validation.lattice.result import Run
from validation.lattice.signal import Beads

METHODS = ("DOP853", "RK45", "RK23", "LSODA", "Radau", "BDF")
"""Names of `solve_ivp`: explicit Runge–Kutta pairs of order 8, 5 and 3, and implicit methods."""


@dataclass(frozen=True, eq=False)
class DensePath:
    """Dense output of `solve_ivp`; a `validation.lattice.signal.Path`."""

    motion: Motion
    solution: Any

    @property
    def time(self) -> Array:
        """Ends of the steps, shape (N + 1,)."""
        return np.asarray(self.solution.ts)

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        n = self.motion.size
        states = np.zeros((2, n + 1, len(time)))  # the last row is a wall's
        if len(time):  # SciPy has no value at no time
            states[:, :-1] = self.solution(time)[: 2 * n].reshape(2, n, -1)
        y, v = states[:, beads]
        return y, v


def integrate(motion: Motion, method: str, rtol: float, longest: float) -> Run:
    """Integrate a scene with one of `METHODS`, with steps of at most ``longest``.

    ``rtol`` bounds the errors in a step, relative to the state and to the scene's scales.
    """
    scales = motion.scales
    scene = motion.scene
    n = motion.size
    y = scales.displacement
    v = scales.velocity
    if scene.drive is not None:
        longest = min(longest, scene.drive.longest_step)
    step_limit(scene, method, scene.duration / min(scales.time, longest))
    # Implicit methods, the last three, store a Jacobian, of 8 bytes an entry. Dense output gives
    # the motion of all beads at the samples, and a copy with a wall's.
    numbers = 2 * n + 2
    jacobian = 8 * numbers**2 * (method in METHODS[3:])
    dense = 8 * 2 * numbers * scene.samples
    check_memory(scene, method, rows=4, more=jacobian + dense)
    found = scipy.integrate.solve_ivp(
        motion,
        (0.0, scene.duration),
        motion.start,
        method,
        dense_output=True,
        rtol=rtol,
        # Displacements and velocities of n beads, and two energies
        atol=rtol * np.repeat([y, v, scales.energy or 1.0], [n, n, 2]),
        max_step=longest,
        # SciPy's own guess depends on the units. Here: a thousandth of the time in which a bead
        # with the scale of the velocity moves by that of the displacement.
        first_step=min(1e-3 * y / v, scene.duration),
    )
    if not found.success:
        raise IntegrationError(
            f"integration stopped at t = {found.t[-1]:g}: {found.message}"
        )
    # A copy: a view would keep the states of all steps in memory.
    end = found.y[:, -1].copy()
    return Run(motion, end, len(found.t) - 1, DensePath(motion, found.sol))
