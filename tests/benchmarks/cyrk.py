"""Runge–Kutta pairs of CyRK, in C++, given the same equations of motion in their best form.

The right-hand side is a C function, compiled by numba; the whole chain is integrated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import SceneError
from validation.studies.accuracy import Task

Solve = Callable[[float, Task, Array], Array]
"""Force of a task's contact, (S,), as a function of tolerance, task and times (S,)."""

METHODS = {"RK45": 1e-9, "TSIT5": 1e-11, "VERN7": 1e-12, "DOP853": 1e-12}
"""Methods with their finest tolerances."""


def constants(task: Task) -> Array:
    """Constants of the equations of k = 3/2 in C.

    n, then (4, n): 1/m and, for the contact ahead of each bead, stiffness, rest compression and
    load, 0 without a contact. Raises `SceneError` for another k.
    """
    if task.scene.k != 1.5:
        raise SceneError(f"k is {task.scene.k:g}: peers are given the equations of k = 1.5")
    motion = Motion(task.scene)
    rows = np.zeros((4, motion.size))
    rows[0] = 1 / motion.masses
    rows[1:, : len(motion.rest)] = motion.stiffnesses, motion.rest, motion.load
    return np.append(float(motion.size), rows)


def _compiled(signature: Any) -> Any:
    """The equations as a C function of rate, time, state and constants."""
    import numba

    def move(rate: Any, t: float, y: Any, c: Any) -> None:
        n, behind = int(c[0]), 0.0
        for i in range(n):
            rate[i] = y[n + i]
            ahead = y[i + 1] if i < n - 1 else 0.0
            d = c[1 + 2 * n + i] + y[i] - ahead
            force = (c[1 + n + i] * d * math.sqrt(d) if d > 0.0 else 0.0) - c[1 + 3 * n + i]
            rate[n + i] = (behind - force) * c[1 + i]
            behind = force

    return numba.cfunc(signature)(move)


def prepared(task: Task, method: str) -> Solve:
    """A method of CyRK, compiled and tried on a task."""
    from CyRK import nbsolve2_ivp  # optional
    from CyRK.nb.numba_solver import cyjit_sig

    motion = _compiled(cyjit_sig)

    def solve(tolerance: float, task: Task, times: Array) -> Array:
        solution = nbsolve2_ivp(
            motion.address,
            (0.0, float(times[-1])),
            Motion(task.scene).start[: 2 * task.scene.size],
            method=method,
            args=constants(task),
            t_eval=times,
            rtol=tolerance,
            atol=tolerance,
        )
        if not solution.success:
            raise RuntimeError(f"CyRK {method} stopped: {solution.message}")
        chain = Motion(task.scene)
        force = chain.force(chain.compression(np.array(solution.y[: task.scene.size])))
        solution.free()
        return np.asarray(force[task.scene.contact_sensors[0]])

    solve(1e-3, task, np.array([0.5, 1.0]) * task.scene.duration)  # compiles what calls it
    return solve
