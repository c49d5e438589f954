"""Integration by SciPy's methods, whose own interpolants give samples and signals."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.cost import beyond, mean_step, most_steps
from validation.lattice.equations import Motion
from validation.lattice.run import IntegrationError, Run, RunProgress, finished
from validation.lattice.signal import Beads, recorded, sampled

METHODS = ("DOP853", "RK45", "RK23", "LSODA")
"""Explicit Runge–Kutta pairs of order 8, 5 and 3, and Adams and BDF formulas of varying order."""

_BLOCK = 2**20  # numbers that are read off the interpolants at a time
# The interpolant of a step is a polynomial with so many coefficients.
_COEFFICIENTS = {"DOP853": 8, "RK45": 5, "RK23": 4, "LSODA": 13}


@dataclass(frozen=True, eq=False)
class NodePath:
    """Motion in each step as a polynomial through Chebyshev nodes; a `signal.Path`.

    time : (N + 1,), ends of the N steps. beads : (B,), numbers of the beads. state : (N, P, 2, B),
    displacements and velocities at the P nodes of each step.
    """

    time: Array
    beads: NDArray[np.int_]
    state: Array
    kinks: dict[int, Array] = field(default_factory=dict)

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        block = 1 + _BLOCK // (1 + self.state[0].size)
        parts = [self._at(beads, time[i : i + block]) for i in range(0, len(time), block)]
        y, v = np.concatenate(parts, axis=2) if parts else np.empty((2, len(beads), 0))
        return y, v

    def _at(self, beads: Beads, time: Array) -> Array:
        step = np.searchsorted(self.time[1:-1], time, side="right")
        start = self.time[step]
        x = (time - start) / (self.time[step + 1] - start)
        # The barycentric formula (Berrut and Trefethen 2004, eq. 5.4).
        nodes = chebyshev(self.state.shape[1])
        weights = (-1.0) ** np.arange(len(nodes))
        weights[[0, -1]] /= 2
        apart = x[:, None] - nodes
        share = np.where(apart == 0, 1.0, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            between = weights / apart / (weights / apart).sum(axis=1, keepdims=True)
        share = np.where(share.any(axis=1, keepdims=True), share, between)
        state = self.state[step][..., np.searchsorted(self.beads, beads)]
        return np.asarray(np.einsum("sp,spqb->qbs", share, state))


def chebyshev(count: int) -> Array:
    """Return the Chebyshev points of the second kind from 0 to 1, both ends included."""
    return np.asarray((1 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2)


def integrate(motion: Motion, method: str, rtol: float, atol: float, progress: RunProgress) -> Run:
    """Integrate a scene with one of `METHODS`; the arguments are those of `simulate`."""
    scales, end, n = motion.scales, motion.scene.duration, motion.size
    y, v, drive = scales.displacement, scales.velocity, motion.scene.drive
    longest = math.inf if drive is None else drive.longest_step
    steps = max(end / scales.time / mean_step(method, rtol), end / longest)
    jacobian = (2 * n) ** 2 * 8 if method == "LSODA" else 0
    most = most_steps(motion.scene, method, steps, 4, jacobian)
    stepper = getattr(scipy.integrate, method)(
        motion,
        0.0,
        motion.start,
        end,
        rtol=rtol,
        atol=atol * np.append(np.repeat([y, v], n), [scales.energy] * (len(motion.start) - 2 * n)),
        max_step=longest,
        first_step=min(1e-3 * y / v, end),  # SciPy's own guess depends on the units
    )
    time, beads = sampled(motion)
    nodes, held = chebyshev(_COEFFICIENTS[method]), beads[beads < n]
    ends, states = [0.0], []
    with progress() as tell:
        while stepper.status == "running":
            if len(ends) > most:
                raise IntegrationError(beyond(method, len(ends), stepper.t, end))
            message = stepper.step()
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            if len(beads):
                state = stepper.dense_output()(ends[-1] + nodes * (stepper.t - ends[-1]))
                states.append(np.zeros((len(nodes), 2, len(beads))))
                states[-1][..., : len(held)] = state.T[:, : 2 * n].reshape(-1, 2, n)[..., held]
            ends.append(stepper.t)
            tell(stepper.t / end)
    nothing = np.zeros((len(ends) - 1, len(nodes), 2, 0))
    path = NodePath(np.array(ends), beads, np.array(states) if states else nothing)
    records = {"time": time} | recorded(motion, beads, *path(beads, time))
    evaluations = int(stepper.nfev)
    energy, momentum = motion.balance(stepper.y), motion.momentum_drift(stepper.y)
    moves, made = evaluations * n, len(ends) - 1
    return finished(
        motion, stepper.y, records, energy, momentum, made, evaluations, moves, None, path
    )
