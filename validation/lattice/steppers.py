"""Integration by SciPy's `solve_ivp`, whose dense output gives samples and signals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.cost import (
    IntegrationError,
    RunProgress,
    check_memory,
    check_steps,
    step_limit,
)
from validation.lattice.equations import Motion
from validation.lattice.result import Run, finished
from validation.lattice.signal import Beads, recorded, sampled

METHODS = ("DOP853", "RK45", "RK23", "LSODA", "Radau", "BDF")
"""Names of `solve_ivp`: explicit Runge–Kutta pairs of order 8, 5 and 3, and implicit methods."""


@dataclass(frozen=True, eq=False)
class DensePath:
    """Dense output of `solve_ivp` for the states of n beads; a `signal.Path`."""

    solution: Any
    n: int

    @property
    def time(self) -> Array:
        """Ends of the steps, shape (N + 1,)."""
        return np.asarray(self.solution.ts)

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        states = np.zeros((2, self.n + 1, len(time)))  # the last row is a wall's
        if len(time):  # SciPy has no value at no time
            states[:, :-1] = self.solution(time)[: 2 * self.n].reshape(2, self.n, -1)
        y, v = states[:, np.asarray(beads)]
        return y, v


def integrate(motion: Motion, method: str, rtol: float, atol: float, progress: RunProgress) -> Run:
    """Integrate a scene with one of `METHODS`; the arguments are those of `simulate`."""
    scales, end, n = motion.scales, motion.scene.duration, motion.size
    y, v, drive = scales.displacement, scales.velocity, motion.scene.drive
    longest = math.inf if drive is None else drive.longest_step
    most = step_limit(motion.scene, method, end / min(scales.time, longest))
    jacobian = (2 * n + 2) ** 2 * 8 if method in METHODS[3:] else 0  # bytes; the others need none
    check_memory(motion.scene, method, 4, jacobian)
    calls = 0
    with progress() as display:

        def rates(t: float, state: Array) -> NDArray[np.float64]:
            nonlocal calls
            calls += 1
            # at most 12 a step, and one for each number of the state in a Jacobian
            check_steps(method, calls // (2 * n + 20), most, t, end)
            display(min(t / end, 1.0))
            return motion(t, state)

        found = scipy.integrate.solve_ivp(
            rates,
            (0.0, end),
            motion.start,
            method,
            dense_output=True,
            rtol=rtol,
            atol=atol * np.repeat([y, v, scales.energy or 1.0], [n, n, 2]),
            max_step=longest,
            first_step=min(1e-3 * y / v, end),  # SciPy's own guess depends on the units
        )
        display(1.0)
    if not found.success:
        raise IntegrationError(f"integration stopped at t = {found.t[-1]:g}: {found.message}")
    time, beads = sampled(motion)
    watched, path = beads if len(beads) else np.zeros(1, int), DensePath(found.sol, n)
    records = {"time": time} | recorded(motion, watched, *path(watched, time))
    steps, last = len(found.t) - 1, found.y[:, -1]
    return finished(motion, last, records, steps=steps, bead_evaluations=found.nfev * n, path=path)
