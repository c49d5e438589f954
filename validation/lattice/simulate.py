"""The equations of motion of a scene (`validation.lattice.equations`), integrated.

One `simulate` stands before two engines. SciPy's adaptive steppers, whose own interpolant gives the
samples, are the reference; tolerances are relative to the scene's own scales of velocity and
compression, so that a run does not depend on the units. The compiled symplectic splittings of
`validation.lattice.engine` follow the pulse with a moving window. Either keeps only the sensors'
samples.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import integrate

from lwa.exact import shorten
from validation.lattice.effort import EXCESS, Progress, adaptive, silent
from validation.lattice.equations import Array, Motion
from validation.lattice.run import IntegrationError, Run, frozen
from validation.lattice.schemes import SCHEMES
from validation.scenes.checks import SceneError, real
from validation.scenes.scene import Scene

_BLOCK = 1_000_000
"""Numbers that the interpolant gives at a time."""

METHODS = ("DOP853", "RK45", "RK23", "LSODA")
"""SciPy's: explicit Runge–Kutta pairs of order 8, 5 and 3, and Adams and BDF of varying order."""

COMPILED = tuple(SCHEMES)
"""The engine's splittings, of order 6, 6, 4, 4, 4 and 2; the first where in doubt."""


_NUMBERS = (
    "contact_force", "compression", "bead_force", "bead_velocity", "displacements", "velocities",
    "energy_drift",
)  # fmt: skip
"""Of a `Run`, that must be finite."""


def simulate(
    scene: Scene,
    *,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    method: str = "DOP853",
    step: float | None = None,
    window: bool | int | None = None,
    check: bool = False,
    progress: Progress = silent,
) -> Run:
    """Integrate a scene and return what its sensors recorded.

    Parameters
    ----------
    rtol, atol : of SciPy's methods: local error per step, relative to each component and to the
        scene's own scale of displacement and velocity. Of a compiled method: ``rtol`` is the
        error of a pulse's peak force that its step aims at, ``atol`` does not count.
    method : one of `METHODS` or of `COMPILED`.

    For compiled methods only:

    step : largest step, in place of that which ``rtol`` gives.
    window : whether to follow the pulse only. By default wherever the pulse runs away: not with
        a wall (gravity has one), not at k = 1, and not when it decays fast. False asks for all
        that happens behind, such as light beads that rattle. A number is that of the beads to
        follow behind the front.
    check : whether to measure the errors of step and window by further runs.

    progress : is shown what a run takes before it starts, and then how far it is.

    A contact that opens within a step is a kink which the error estimate may miss, as the run's
    energy drift then shows.

    Raises `SceneError` for a tolerance or method that cannot be meant, and for a run that takes
    longer or more memory than `validation.lattice.effort` allows, and `IntegrationError` when the
    integrator fails.

    >>> scene = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,))
    >>> simulate(scene).velocities.round(6) + 0.0  # equal masses exchange their velocities
    array([0., 1.])
    >>> simulate(scene, method="SRKN14").velocities.round(6) + 0.0
    array([0., 1.])
    """
    if method not in METHODS + COMPILED:
        raise SceneError(
            f"method is {shorten(method)}: one of {', '.join(METHODS)} (SciPy) or "
            f"{', '.join(COMPILED)} (compiled) is wanted"
        )
    for name, tolerance in (("rtol", rtol), ("atol", atol)):
        if not 1e-13 <= real(tolerance, name) <= 1e-2:
            raise SceneError(f"{name} is {tolerance:g}: it lies between 1e-13 and 0.01")
    if method not in COMPILED:
        for name, value in (("step", step), ("window", window), ("check", check or None)):
            if value is not None:
                wanted = f"it needs one of {', '.join(COMPILED)}"
                raise SceneError(f"{name} is {shorten(value)}: {wanted}")
    with np.errstate(over="ignore", invalid="ignore"):  # told by what comes of it
        if method in COMPILED:
            from validation.lattice.engine import follow  # numba takes its time

            run = follow(
                scene, method, rtol=rtol, step=step, window=window, check=check, progress=progress
            )
        else:
            run = _adaptive(scene, method, rtol, atol, progress)
    if not all(np.isfinite(getattr(run, name)).all() for name in _NUMBERS):
        raise IntegrationError("the motion overflows: choose other units")
    return run


def _adaptive(scene: Scene, method: str, rtol: float, atol: float, progress: Progress) -> Run:
    """`simulate` by a method of SciPy's."""
    motion = Motion(scene)
    scales = motion.scales(motion.start)
    y, v = scales.displacement, scales.velocity
    taken = adaptive(scene, method, rtol, scales.time)
    taken.check()
    stepper = getattr(integrate, method)(
        motion,
        0.0,
        motion.start,
        scene.duration,
        rtol=rtol,
        atol=atol * np.repeat([y, v], scene.size),
        first_step=min(1e-3 * y / v, scene.duration),  # SciPy's own guess depends on the units
    )
    time = np.linspace(0.0, scene.duration, scene.samples)
    recorder = _Recorder(motion, scene)
    steps = 0
    with progress(taken) as tell:
        while stepper.status == "running":
            if steps > EXCESS * taken.steps:
                raise IntegrationError(
                    f"{steps} steps of {method} reach t = {stepper.t:g} where {taken.steps:.0f} "
                    f"are enough for all of {scene.duration:g}: rounding hides the motion, or rtol "
                    "is too small for it"
                )
            message = stepper.step()
            steps += 1
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            recorder.record(time, stepper)
            tell(stepper.t / scene.duration)
    return _result(scene, motion, recorder, time, stepper, steps)


class _Recorder:
    """The sensors' samples."""

    def __init__(self, motion: Motion, scene: Scene) -> None:
        self.motion = motion
        self.contacts = list(scene.contact_sensors)
        self.beads = list(scene.bead_sensors)
        self.listening, self.done = bool(self.contacts or self.beads), 0
        self.contact_force, self.compression = np.empty((2, len(self.contacts), scene.samples))
        self.bead_force, self.bead_velocity = np.empty((2, len(self.beads), scene.samples))

    def record(self, time: Array, stepper: Any) -> None:
        """Keep the samples of the last step."""
        until = int(np.searchsorted(time, stepper.t, side="right"))
        if self.listening and until > self.done:
            state = stepper.dense_output()
            while self.done < until:  # few at a time, as all beads are computed
                part = slice(self.done, min(until, self.done + max(1, _BLOCK // len(stepper.y))))
                self._store(part, state(time[part]))
                self.done = part.stop

    def _store(self, samples: slice, states: Array) -> None:
        """Keep what the sensors see of the states, of shape (2n, samples)."""
        compression = self.motion.compression(states[: self.motion.size])
        force = self.motion.force(compression)
        self.compression[:, samples] = compression[self.contacts]
        self.contact_force[:, samples] = force[self.contacts]
        self.bead_velocity[:, samples] = states[self.motion.size :][self.beads]
        for row, bead in enumerate(self.beads):
            self.bead_force[row, samples] = self.motion.bead_force(bead, force)


def _result(
    scene: Scene,
    motion: Motion,
    recorder: _Recorder,
    time: Array,
    stepper: Any,
    steps: int,
) -> Run:
    n, start, end = scene.size, motion.start, stepper.y
    before, after = motion.energy(start), motion.energy(end)
    return Run(
        scene=scene,
        **frozen(
            time=time,
            contact_force=recorder.contact_force,
            compression=recorder.compression,
            bead_force=recorder.bead_force,
            bead_velocity=recorder.bead_velocity,
            displacements=end[:n].copy(),
            velocities=end[n:].copy(),
        ),
        energy_drift=(after - before) / before if before else 0.0,
        momentum_drift=motion.momentum_drift(start[n:], end[n:]),
        evaluations=int(stepper.nfev),
        bead_evaluations=int(stepper.nfev) * n,
        step=scene.duration / steps,
    )
