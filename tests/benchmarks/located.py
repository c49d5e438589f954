"""A reference for the engine: DOP853 with every opening and closing of a contact located.

A step over the kink of F = A [δ]_+^k at δ = 0 loses its order. A sign change of an overlap within a
step is found on the step's cubic Hermite interpolant, its time by Brent's method on the dense
output (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.6); the step is then
taken again up to that time. The route shares nothing with the engine but the equations.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from scipy.optimize import brentq

from lwa.base.arrays import Array
from validation.lattice.cost import IntegrationError
from validation.lattice.equations import Motion
from validation.pulses.pulse import Pulse, highest_pulse
from validation.studies.accuracy import Task


class Located(scipy.integrate.DOP853):  # type: ignore[misc]
    """DOP853 on a `Motion`, with every opening and closing of a contact at the end of a step."""

    t: float
    y: Array
    f: Array

    _inside = np.linspace(0.0, 1.0, 9)[1:, None]  # places of a step at which overlaps are evaluated
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
        """Overlap of every contact, and its rate."""
        n = self.motion.size
        return self.motion.compression(state[:n]), self.motion.rate(state[n : 2 * n])

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
    task: Task, times: Array, method: Any, rtol: float, *, atol: float | None = None
) -> Array:
    """Force of the task's contact at some times, by a class such as `Located`.

    rtol, atol: of the local error, by default the same. Raises `IntegrationError` when the stepper
    fails.
    """
    motion = Motion(task.scene)
    force = np.zeros(len(times))
    options = {"rtol": rtol, "atol": rtol if atol is None else atol}
    stepper = method(motion, 0.0, motion.start, float(times[-1]), **options)
    done = 0
    while stepper.status == "running":
        message = stepper.step()
        if stepper.status == "failed":
            raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
        until = int(np.searchsorted(times, stepper.t, side="right"))
        if until > done:
            y = stepper.dense_output()(times[done:until])[: motion.size]
            force[done:until] = motion.force(motion.compression(y))[task.scene.contact_sensors[0]]
            done = until
    return force


def around(task: Task, truth: Pulse) -> Array:
    """Times of samples about a pulse: 4 of its widths before its peak, 3 behind or to the end."""
    times = truth.arrival + truth.fwhm * np.linspace(-4, 3, 300)
    return np.asarray(times[times <= task.scene.duration])


class Septic:
    """The spline of degree 7 through samples, as a signal; its own error is below 1e-12."""

    def __init__(self, times: Array, values: Array) -> None:
        self.times = times
        self.spline = scipy.interpolate.make_interp_spline(times, values, 7)

    def __call__(self, time: Any, /) -> Array:
        return np.asarray(self.spline(time))


def read(task: Task, times: Array, force: Array) -> Pulse:
    """The pulse of the dynamic force, from samples of the contact's force."""
    return highest_pulse(Septic(times, force - task.scene.load[task.scene.contact_sensors[0]]))


def located(task: Task, truth: Pulse) -> Pulse:
    """The pulse of a task by DOP853 with every kink located, sampled about where it is expected."""
    times = around(task, truth)
    # about the least tolerance that SciPy takes
    return read(task, times, integrate(task, times, Located, 2.5e-14, atol=2.5e-15))
