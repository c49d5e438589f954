"""Integration by SciPy's methods, whose own interpolants give samples and signals."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.polynomial import chebyshev
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

METHODS = ("DOP853", "RK45", "RK23", "LSODA")
"""Explicit Runge–Kutta pairs of order 8, 5 and 3, and Adams and BDF formulas of varying order."""

# The interpolant of a step is a polynomial with so many coefficients.
_COEFFICIENTS = {"DOP853": 8, "RK45": 5, "RK23": 4, "LSODA": 13}


@dataclass(frozen=True, eq=False)
class NodePath:
    """Motion in each step as a polynomial through Chebyshev points; a `signal.Path`.

    time : (N + 1,), ends of the N steps. beads : (B,), numbers of the beads. state : (N, P, 2, B),
    displacements and velocities at P Chebyshev points of the second kind in each step.
    """

    time: Array
    beads: NDArray[np.int_]
    state: Array

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        step = np.searchsorted(self.time[1:-1], time, side="right")
        x = 2 * (time - self.time[step]) / np.diff(self.time)[step] - 1
        degree = self.state.shape[1] - 1
        # Interpolation by way of the Chebyshev coefficients, whose matrix is well conditioned.
        at_points = chebyshev.chebvander(chebyshev.chebpts2(degree + 1), degree)
        weights = chebyshev.chebvander(x, degree) @ np.linalg.inv(at_points)
        weights[x == -1] = np.eye(degree + 1)[0]  # free of rounding: touching beads press nothing
        state = self.state[..., np.searchsorted(self.beads, beads)]
        y, v = sum(
            (weights[:, p] * state[step, p].T.swapaxes(0, 1) for p in range(degree + 1)),
            np.zeros((2, len(beads), len(time))),
        )
        return y, v


def integrate(motion: Motion, method: str, rtol: float, atol: float, progress: RunProgress) -> Run:
    """Integrate a scene with one of `METHODS`; the arguments are those of `simulate`."""
    scales, end, n = motion.scales, motion.scene.duration, motion.size
    y, v, drive = scales.displacement, scales.velocity, motion.scene.drive
    energies = [scales.energy or 1.0] * (len(motion.start) - 2 * n)  # dissipated, and work
    longest = math.inf if drive is None else drive.longest_step
    most = step_limit(motion.scene, method, end / min(scales.time, longest))
    jacobian = (2 * n) ** 2 * 8 if method == "LSODA" else 0  # bytes; the others need none
    check_memory(motion.scene, method, 4, jacobian)
    stepper = getattr(scipy.integrate, method)(
        motion,
        0.0,
        motion.start,
        end,
        rtol=rtol,
        atol=atol * np.append(np.repeat([y, v], n), energies),
        max_step=longest,
        first_step=min(1e-3 * y / v, end),  # SciPy's own guess depends on the units
    )
    time, beads = sampled(motion)
    nodes = (1 + chebyshev.chebpts2(_COEFFICIENTS[method])) / 2
    moving = beads[beads < n]
    ends, states = [0.0], []
    with progress() as display:
        while stepper.status == "running":
            check_steps(method, len(ends), most, stepper.t, end)
            message = stepper.step()
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            if len(beads):
                state = stepper.dense_output()(ends[-1] + nodes * (stepper.t - ends[-1]))
                states.append(np.zeros((len(nodes), 2, len(beads))))
                states[-1][..., : len(moving)] = state.T[:, : 2 * n].reshape(-1, 2, n)[..., moving]
            ends.append(stepper.t)
            display(stepper.t / end)
    nothing = np.zeros((len(ends) - 1, len(nodes), 2, 0))
    path = NodePath(np.array(ends), beads, np.array(states) if states else nothing)
    records = {"time": time} | recorded(motion, beads, *path(beads, time))
    return finished(
        motion,
        stepper.y,
        records,
        motion.balance(stepper.y),
        steps=len(ends) - 1,
        evaluations=stepper.nfev,
        bead_evaluations=stepper.nfev * n,
        path=path,
    )
