"""The pulse of a task to about twelve digits, by two routes that share nothing but the equations.

One is the engine's own at its finest tolerance. The other is SciPy's DOP853 with every opening and
closing of a contact located, as a step over the kink of F = A [δ]_+^k at δ = 0 loses its order. A
sign change of an overlap within a step is found on its cubic Hermite interpolant, its time by
Brent's method on the step's dense output (Hairer, Nørsett & Wanner, Solving Ordinary Differential
Equations I, II.6); the step is taken again up to there.

`integrate` drives any of SciPy's steppers, on the whole chain or on a window that moves with the
pulse: beads join ahead before they move, and those behind leave where an open contact, which
carries no tension, parts them from the pulse.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import integrate as scipy
from scipy.optimize import brentq

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.run import IntegrationError
from validation.lattice.simulate import simulate
from validation.pulses.pulse import Pulse
from validation.scenes.checks import SceneError
from validation.studies.accuracy.tasks import Task, errors

# Beads that a window follows behind the front at least, that join at once, and that are still at
# the front: displaced by less than this over the largest displacement.
_REACH, _AHEAD, _MARGIN, _STILL = 48, 32, 6, 1e-13

FINEST = 1e-13
"""The smallest tolerance that `validation.simulate` takes."""


class Part(Motion):
    """The beads lo … hi-1 of a chain on their own; the last keeps its wall if there is one."""

    def __init__(self, whole: Motion, lo: int, hi: int) -> None:
        contacts = slice(lo, hi - 1 if hi < whole.size else len(whole.rest))
        self.size, self.k, self.loaded = hi - lo, whole.k, whole.loaded
        self.masses = whole.masses[lo:hi]
        self.stiffnesses, self.rest, self.load = (
            row[contacts] for row in (whole.stiffnesses, whole.rest, whole.load)
        )


class Located(scipy.DOP853):  # type: ignore[misc]
    """DOP853 on a `Motion`, with every opening and closing of a contact at the end of a step."""

    t: float
    y: Array
    f: Array

    _inside = np.linspace(0.0, 1.0, 9)[1:, None]  # where in a step the overlaps are looked at
    _on = 1e-9  # overlap, over the displacements' scale, of a contact just opening or closing

    def __init__(self, motion: Motion, *arguments: Any, **options: Any) -> None:
        super().__init__(motion, *arguments, **options)
        self.motion, self.events = motion, 0

    def _step_impl(self) -> tuple[bool, str | None]:
        before = self.t, self.y, self.f
        going, message = super()._step_impl()
        while going and (time := self._kink(*before)) is not None:
            self.events += 1
            self.t, self.y, self.f = before
            self.h_abs = time - self.t
            going, message = super()._step_impl()
        return going, message

    def _overlaps(self, state: Array) -> tuple[Array, Array]:
        """Of all contacts: the overlap and its rate."""
        n = self.motion.size
        v = np.append(state[n:], 0.0)[: len(self.motion.rest) + 1]
        return self.motion.compression(state[:n]), v[:-1] - v[1:]

    def _kink(self, t: float, y: Array, f: Array) -> float | None:
        """The time of the first change of sign of an overlap in the step from t; None without."""
        h, x = self.t - t, self._inside
        (a, da), (b, db) = self._overlaps(y), self._overlaps(self.y)
        da, db = h * da, h * db
        p = a + x * (da + x * (3 * (b - a) - 2 * da - db + x * (2 * (a - b) + da + db)))
        on = np.abs(a) <= self._on
        side = np.where(on, np.sign(da), np.sign(a))
        crossed = p * side < -self._on
        if not crossed.any():
            return None
        first = np.where(crossed.any(axis=0), crossed.argmax(axis=0), len(x))
        self.t_old = t
        dense = self._dense_output_impl()

        def overlap(time: float, i: Any) -> float:
            return float(self.motion.compression(dense(time)[: self.motion.size])[i])

        times = []
        for i in np.flatnonzero(crossed.any(axis=0) & (first <= first.min() + 1)):
            start, end = t + (1e-3 * h if on[i] else 0.0), t + h * float(x[first[i], 0])
            changes = overlap(start, i) * overlap(end, i) < 0
            times.append(brentq(overlap, start, end, (i,), 1e-14 * end) if changes else end)
        time = float(min(times))
        return time if time < t + (1 - 1e-9) * h else None


def integrate(
    task: Task, method: Any, rtol: float, *, window: bool = False, atol: float | None = None
) -> Array:
    """The force of the task's contact at its times, by a class such as `scipy.integrate.DOP853` or
    `Located`; rtol and atol, by default the same, are of the local error.

    Raises `SceneError` for a window in front of a wall, `IntegrationError` when the stepper fails.
    """
    scene, whole = task.scene, Motion(task.scene)
    if window and not task.windowed:
        raise SceneError("window is True: behind a wall waves come back; the whole chain is wanted")
    state = whole.start.reshape(2, -1)
    moved = np.flatnonzero(state.any(axis=0)).max(initial=-1)
    lo, hi = 0, min(whole.size, int(moved) + 1 + _AHEAD) if window else whole.size
    force = np.zeros(len(task.times))
    t, done = 0.0, 0
    options = {"rtol": rtol, "atol": rtol if atol is None else atol}
    while t < scene.duration:
        part = Part(whole, lo, hi)
        stepper = method(part, t, state[:, lo:hi].ravel(), scene.duration, **options)
        while stepper.status == "running":
            reached = np.abs(stepper.y[: part.size])
            if hi < whole.size and reached[-_MARGIN] > _STILL * reached.max():
                break  # the front has come near the last bead
            message = stepper.step()
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            until = int(np.searchsorted(task.times, stepper.t, side="right"))
            if until > done:
                if lo <= task.contact < hi - 1:
                    y = stepper.dense_output()(task.times[done:until])[: part.size]
                    force[done:until] = part.force(part.compression(y))[task.contact - lo]
                done = until
        t, state[:, lo:hi] = stepper.t, stepper.y.reshape(2, -1)
        if t < scene.duration:
            options["first_step"] = min(stepper.step_size, scene.duration - t)
            # One of the gaps behind parts the pulse from what it has left.
            behind = part.compression(state[0, lo:hi])[: hi - lo - _AHEAD - _REACH]
            parted = np.flatnonzero(behind < 0).max(initial=-1)
            lo, hi = lo + int(parted) + 1, min(whole.size, hi + _AHEAD)
    return force


def compiled(task: Task) -> Pulse:
    """By the engine at its finest tolerance, on a window where there may be one."""
    return task.read(task.force(simulate(task.scene, rtol=FINEST)))


def located(task: Task) -> Pulse:
    """By DOP853 with every kink located, on a window where there may be one."""
    # about the least tolerance that SciPy takes
    return task.read(integrate(task, Located, 2.5e-14, window=task.windowed, atol=2.5e-15))


def reference(task: Task) -> tuple[Pulse, float]:
    """The truth where it is known, else the engine's result; its largest relative difference from
    the located one."""
    pulse = task.truth or compiled(task)
    return pulse, max(errors(located(task), pulse).values())
