"""General integrators of other packages, given the same equations of motion in their best form.

CyRK : adaptive Runge–Kutta pairs in C++. numbalsoda : DOP853 and LSODA in Fortran and C++. Both
call the right-hand side as a C function, compiled by numba, and integrate the whole chain.

A package that is missing is left out with a word; where the environment names a continuous
integration (CI), it is an error.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import Failure, SceneError
from validation.studies.accuracy.tasks import Task, settings

Solve = Callable[[float, Task], Array]
"""From a tolerance to the displacements at the task's times, (n, S)."""

_STEPS = 10**8  # that numbalsoda may take: more than it needs


class PeerError(Failure):
    """A package that must be there is missing, or an integrator could not go on."""


@dataclass(frozen=True)
class Peer:
    """One integrator of a package, compared at its ``tolerances``; ``prepare`` compiles it, and
    tries it on a task."""

    package: str
    method: str
    prepare: Callable[[Task, str], Solve]
    tolerances: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """As in tables."""
        return f"{self.package} {self.method}"


def _constants(task: Task) -> Array:
    """Of the equations of k = 3/2 in C: n, and (4, n) of 1/m and, of the contact ahead of each
    bead, stiffness, rest compression and load, 0 where none is."""
    if task.scene.k != 1.5:
        raise SceneError(f"k is {task.scene.k:g}: peers are given the equations of k = 1.5")
    motion = Motion(task.scene)
    rows = np.zeros((4, motion.size))
    rows[0] = 1 / motion.masses
    rows[1:, : len(motion.rest)] = motion.stiffnesses, motion.rest, motion.load
    return np.append(float(motion.size), rows)


def _compiled(signature: Any, rate_first: bool) -> Any:
    """The equations as a C function of time, state, rate and constants."""
    import numba  # optional, as what calls it is

    @numba.njit
    def move(y: Any, rate: Any, c: Any) -> None:
        n, behind = int(c[0]), 0.0
        for i in range(n):
            rate[i] = y[n + i]
            ahead = y[i + 1] if i < n - 1 else 0.0
            d = c[1 + 2 * n + i] + y[i] - ahead
            force = (c[1 + n + i] * d * math.sqrt(d) if d > 0.0 else 0.0) - c[1 + 3 * n + i]
            rate[n + i] = (behind - force) * c[1 + i]
            behind = force

    def of_time(t: float, y: Any, rate: Any, c: Any) -> None:
        move(y, rate, c)

    def of_rate(rate: Any, t: float, y: Any, c: Any) -> None:
        move(y, rate, c)

    return numba.cfunc(signature)(of_rate if rate_first else of_time)


def _cyrk(task: Task, method: str) -> Solve:
    from CyRK import nbsolve2_ivp  # optional
    from CyRK.nb.numba_solver import cyjit_sig

    motion = _compiled(cyjit_sig, rate_first=True)

    def solve(tolerance: float, task: Task) -> Array:
        solution = nbsolve2_ivp(
            motion.address, (0.0, float(task.times[-1])), Motion(task.scene).start, method=method,
            args=_constants(task), t_eval=task.times, rtol=tolerance, atol=tolerance,
        )  # fmt: skip
        if not solution.success:
            raise PeerError(f"CyRK {method} stopped: {solution.message}")
        y = np.array(solution.y[: task.scene.size])
        solution.free()
        return y

    solve(1e-3, task)  # compiles what calls it
    return solve


def _numbalsoda(task: Task, method: str) -> Solve:
    import numbalsoda  # optional

    motion = _compiled(numbalsoda.lsoda_sig, rate_first=False)

    def solve(tolerance: float, task: Task) -> Array:
        states, well = getattr(numbalsoda, method.lower())(
            motion.address, Motion(task.scene).start, np.concatenate(([0.0], task.times)),
            _constants(task), rtol=tolerance, atol=tolerance, mxstep=_STEPS,
        )  # fmt: skip
        if not well:
            raise PeerError(f"numbalsoda {method} stopped at tolerance {tolerance:g}")
        return np.asarray(states[1:].T[: task.scene.size])

    solve(1e-3, task)  # compiles
    return solve


PEERS = (
    Peer("CyRK", "RK45", _cyrk, settings(1e-4, 1e-9)),
    Peer("CyRK", "TSIT5", _cyrk, settings(1e-4, 1e-11)),
    Peer("CyRK", "VERN7", _cyrk, settings(1e-4, 1e-12)),
    Peer("CyRK", "DOP853", _cyrk, settings(1e-4, 1e-12)),
    Peer("numbalsoda", "DOP853", _numbalsoda, settings(1e-4, 1e-12)),
    Peer("numbalsoda", "LSODA", _numbalsoda, (1e-5, 1e-7, 1e-9)),
)


def missing() -> tuple[str, ...]:
    """The packages of `PEERS` that cannot be imported.

    Raises `PeerError` if there is one and the environment has CI set.
    """
    absent = []
    for package in dict.fromkeys(peer.package for peer in PEERS):
        try:
            import_module(package)
        except ImportError as reason:
            says = f"{package} is missing where CI is set ({reason}): pip install 'lwa[peers]'"
            if os.environ.get("CI"):
                raise PeerError(says) from None
            absent.append(package)
    return tuple(absent)


def prepared(task: Task) -> Iterator[tuple[Peer, Solve]]:
    """The peers of packages that are there, compiled for the task."""
    absent = missing()
    return ((p, p.prepare(task, p.method)) for p in PEERS if p.package not in absent)
