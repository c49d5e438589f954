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
class StepsPath:
    """Motion in each step as a polynomial; a `signal.Path`.

    time : (N + 1,), ends of the N steps. beads : (B,), numbers of the beads. motion : displacements
    and velocities (2, B) as a polynomial in each step.
    """

    time: Array
    beads: NDArray[np.int_]
    motion: scipy.interpolate.BPoly

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        chosen = self.motion.c[..., np.searchsorted(self.beads, beads)]
        y, v = np.moveaxis(scipy.interpolate.BPoly.construct_fast(chosen, self.time)(time), 0, 2)
        return y, v


def integrate(motion: Motion, method: str, rtol: float, atol: float, progress: RunProgress) -> Run:
    """Integrate a scene with one of `METHODS`; the arguments are those of `simulate`."""
    scales, end, n = motion.scales, motion.scene.duration, motion.size
    y, v, drive = scales.displacement, scales.velocity, motion.scene.drive
    energy = scales.energy or 1.0
    longest = math.inf if drive is None else drive.longest_step
    most = step_limit(motion.scene, method, end / min(scales.time, longest))
    jacobian = (2 * n + 2) ** 2 * 8 if method == "LSODA" else 0  # bytes; the others need none
    check_memory(motion.scene, method, 4, jacobian)
    stepper = getattr(scipy.integrate, method)(
        motion,
        0.0,
        motion.start,
        end,
        rtol=rtol,
        atol=atol * np.repeat([y, v, energy], [n, n, 2]),
        max_step=longest,
        first_step=min(1e-3 * y / v, end),  # SciPy's own guess depends on the units
    )
    time, beads = sampled(motion)
    watched = beads if len(beads) else np.zeros(1, int)
    moving = watched[watched < n]
    nodes = (1 + chebyshev.chebpts2(_COEFFICIENTS[method])) / 2
    ends, states = [0.0], []
    with progress() as display:
        while stepper.status == "running":
            check_steps(method, len(ends), most, stepper.t, end)
            message = stepper.step()
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            state = stepper.dense_output()(ends[-1] + nodes * (stepper.t - ends[-1]))
            states.append(np.zeros((len(nodes), 2, len(watched))))
            states[-1][..., : len(moving)] = state.T[:, : 2 * n].reshape(-1, 2, n)[..., moving]
            ends.append(stepper.t)
            display(stepper.t / end)
    # Bernstein's basis has no rounding at a step's beginning: touching beads press nothing there.
    basis = scipy.interpolate.BPoly(np.eye(len(nodes))[:, None], [0, 1])(nodes)
    coefficients = np.tensordot(np.linalg.inv(basis), np.array(states), (1, 1))
    path = StepsPath(np.array(ends), watched, scipy.interpolate.BPoly(coefficients, ends))
    records = {"time": time} | recorded(motion, watched, *path(watched, time))
    return finished(
        motion,
        stepper.y,
        records,
        steps=len(ends) - 1,
        bead_evaluations=stepper.nfev * n,
        path=path,
    )
