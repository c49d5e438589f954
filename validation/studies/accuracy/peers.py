"""General integrators of other packages, given the same equations of motion in their best form.

CyRK : adaptive Runge–Kutta pairs in C++, the right-hand side compiled by numba to a C function.
numbalsoda : DOP853 and LSODA in Fortran and C++, the right-hand side compiled likewise.
diffrax : adaptive Runge–Kutta pairs compiled by XLA; the right-hand side in JAX, vectorised.
heyoka : Taylor's method to machine precision by automatic differentiation, compiled by LLVM. Its
    error is that of the kinks of [δ]_+^k, which a polynomial does not see: a largest step keeps it
    in bounds, in the tolerance's place.

All integrate the whole chain. A package that is missing is left out with a word; where the
environment names a continuous integration (CI), it is an error.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from lwa.compact.numeric import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import Failure, SceneError
from validation.studies.accuracy.tasks import Task

Solve = Callable[..., Array]
"""From a tolerance (heyoka: the largest step) to the displacements at the task's times, (n, S); of
a package in `MANY` also for another task of as many beads, given second."""

_STEPS = 10**8  # that numbalsoda may take: more than it needs

MANY = ("CyRK", "numbalsoda")
"""Packages whose compiled equations take other chains."""


class PeerError(Failure):
    """A package that must be there is missing, or an integrator could not go on."""


@dataclass(frozen=True)
class Peer:
    """One integrator of a package; ``prepare`` compiles it for a task."""

    package: str
    method: str
    prepare: Callable[[Task, str], Solve]

    @property
    def name(self) -> str:
        """As in tables."""
        return f"{self.package} {self.method}"


def _hertz(task: Task) -> tuple[Motion, Array]:
    """The equations, of k = 3/2 without a power, and (3, n): stiffness, rest compression and load
    of a contact ahead of every bead, 0 where none is."""
    if task.scene.k != 1.5:
        raise SceneError(f"k is {task.scene.k:g}: peers are given the equations of k = 1.5")
    motion = Motion(task.scene)
    rows = np.zeros((3, motion.size))
    rows[:, : len(motion.rest)] = motion.stiffnesses, motion.rest, motion.load
    return motion, rows


def _constants(task: Task) -> Array:
    """Of the equations in C: n, and (4, n) of 1/m and `_hertz`."""
    motion, contacts = _hertz(task)
    return np.concatenate(([motion.size], 1 / motion.masses, *contacts))


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

    def solve(tolerance: float, task: Task = task) -> Array:
        solution = nbsolve2_ivp(
            motion.address, (0.0, float(task.times[-1])), Motion(task.scene).start, method=method,
            args=_constants(task), t_eval=task.times, rtol=tolerance, atol=tolerance,
        )  # fmt: skip
        if not solution.success:
            raise PeerError(f"CyRK {method} stopped: {solution.message}")
        y = np.array(solution.y[: task.scene.size])
        solution.free()
        return y

    solve(1e-3)  # compiles what calls it
    return solve


def _numbalsoda(task: Task, method: str) -> Solve:
    import numbalsoda  # optional

    motion = _compiled(numbalsoda.lsoda_sig, rate_first=False)

    def solve(tolerance: float, task: Task = task) -> Array:
        states, well = getattr(numbalsoda, method.lower())(
            motion.address, Motion(task.scene).start, np.concatenate(([0.0], task.times)),
            _constants(task), rtol=tolerance, atol=tolerance, mxstep=_STEPS,
        )  # fmt: skip
        if not well:
            raise PeerError(f"numbalsoda {method} stopped at tolerance {tolerance:g}")
        return np.asarray(states[1:].T[: task.scene.size])

    solve(1e-3)  # compiles
    return solve


def _diffrax(task: Task, method: str) -> Solve:
    import diffrax  # optional, with JAX
    import jax
    import jax.numpy as jnp

    motion, contacts = _hertz(task)
    start, n, end = motion.start, motion.size, float(task.times[-1])
    with jax.enable_x64(True):
        masses, A, rest, load = map(jnp.array, (motion.masses, *contacts))

        def rate(t: Any, state: Any, constants: Any) -> Any:
            y, v = state[:n], state[n:]
            d = jnp.maximum(rest + y - jnp.append(y[1:], 0.0), 0.0)
            force = A * d * jnp.sqrt(d) - load
            push = jnp.append(0.0, force[:-1]) - force
            return jnp.concatenate((v, push / masses))

        @jax.jit  # type: ignore[untyped-decorator]
        def run(tolerance: Any) -> tuple[Any, Any]:
            control = diffrax.PIDController(rtol=tolerance, atol=tolerance)
            solution = diffrax.diffeqsolve(
                diffrax.ODETerm(rate), getattr(diffrax, method)(), 0.0, end, 1e-3,
                jnp.array(start), saveat=diffrax.SaveAt(ts=jnp.array(task.times)),
                stepsize_controller=control, max_steps=None, throw=False,
            )  # fmt: skip
            return solution.ys, solution.result == diffrax.RESULTS.successful

    def solve(tolerance: float) -> Array:
        with jax.enable_x64(True):
            states, well = run(tolerance)
        if not well:
            raise PeerError(f"diffrax {method} stopped at tolerance {tolerance:g}")
        return np.asarray(states).T[:n]

    solve(1e-3)  # compiles
    return solve


def _heyoka(task: Task, method: str) -> Solve:
    import heyoka  # optional

    motion, contacts = _hertz(task)
    start, n = motion.start, motion.size
    y, v = (heyoka.make_vars(*(f"{name}{i}" for i in range(n))) for name in "yv")
    force: list[Any] = [0.0]
    for i, (A, rest, load) in enumerate(zip(*contacts, strict=True)):
        d = rest + y[i] - (y[i + 1] if i + 1 < n else 0.0)
        closed = heyoka.gt(d, 0.0)
        # not the power of a negative gap, which would be no number
        force.append(A * heyoka.select(closed, heyoka.select(closed, d, 1.0) ** 1.5, 0.0) - load)
    system = [(y[i], v[i]) for i in range(n)]
    system += [(v[i], (force[i] - force[i + 1]) / motion.masses[i]) for i in range(n)]
    # below the error of the kinks, if there are any
    tolerance = 1e-9 if 0.0 in task.scene.load else 1e-13
    stepper = heyoka.taylor_adaptive(system, list(start), tol=tolerance, compact_mode=True)

    def solve(longest: float) -> Array:
        stepper.time = 0.0
        stepper.state[:] = start
        found: Any = ()
        for propagate, until in (("until", task.times[0]), ("grid", task.times)):
            found = getattr(stepper, f"propagate_{propagate}")(until, max_delta_t=longest)
            if found[0] != heyoka.taylor_outcome.time_limit:
                raise PeerError(f"heyoka stopped: {found[0]}")
        return np.array(found[-1].T[:n])

    return solve


PEERS = (
    *(Peer("CyRK", method, _cyrk) for method in ("RK45", "TSIT5", "VERN7", "DOP853")),
    *(Peer("numbalsoda", method, _numbalsoda) for method in ("DOP853", "LSODA")),
    *(Peer("diffrax", method, _diffrax) for method in ("Tsit5", "Dopri8")),
    Peer("heyoka", "Taylor", _heyoka),
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


def prepared(task: Task, absent: Collection[str]) -> Iterator[tuple[Peer, Solve]]:
    """The peers of packages that are there, compiled for the task."""
    return ((p, p.prepare(task, p.method)) for p in PEERS if p.package not in absent)
