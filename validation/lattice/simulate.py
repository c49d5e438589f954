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
import scipy

from lwa.exact import shorten
from lwa.numeric import Array
from validation.lattice.effort import EXCESS, RunProgress, adaptive, silent
from validation.lattice.equations import Motion
from validation.lattice.run import IntegrationError, Run, finished
from validation.lattice.schemes import SCHEMES
from validation.scenes.checks import SceneError, one_of, real
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
    progress: RunProgress = silent,
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

    progress : is shown what a run takes before it starts, and then how far it is.

    Raises `SceneError` for a tolerance or method that cannot be meant, and for a run that takes
    longer or more memory than `validation.lattice.effort` allows, and `IntegrationError` when the
    integrator fails.

    >>> scene = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,))
    >>> simulate(scene).velocities.round(6) + 0.0  # equal masses exchange their velocities
    array([0., 1.])
    >>> simulate(scene, method="SRKN14").velocities.round(6) + 0.0
    array([0., 1.])
    """
    one_of(method, METHODS + COMPILED, "method")
    for name, tolerance in (("rtol", rtol), ("atol", atol)):
        if not 1e-13 <= real(tolerance, name) <= 1e-2:
            raise SceneError(f"{name} is {tolerance:g}: it lies between 1e-13 and 0.01")
    if method not in COMPILED:
        for name, value in (("step", step), ("window", window)):
            if value is not None:
                wanted = f"it needs one of {', '.join(COMPILED)}"
                raise SceneError(f"{name} is {shorten(value)}: {wanted}")
    with np.errstate(over="ignore", invalid="ignore"):  # told by what comes of it
        motion = Motion(scene)
        if method in COMPILED:
            from validation.lattice.engine import follow  # start-up: numba takes its time

            run = follow(motion, method, rtol, step, window, progress)
        else:
            run = _adaptive(motion, method, rtol, atol, progress)
    if not all(np.isfinite(getattr(run, name)).all() for name in _NUMBERS):
        raise IntegrationError("the motion overflows: choose other units")
    return run


def twice(scene: Scene, fine: float, coarse: float, **options: Any) -> tuple[Run, Run]:
    """`simulate` at two tolerances: by what a number differs is its error, see
    `validation.pulses.pulse.compared`."""
    run, check = (simulate(scene, rtol=t, atol=t, **options) for t in (fine, coarse))
    return run, check


def _adaptive(motion: Motion, method: str, rtol: float, atol: float, progress: RunProgress) -> Run:
    """`simulate` by a method of SciPy's."""
    scales, end = motion.scales, motion.scene.duration
    y, v = scales.displacement, scales.velocity
    taken = adaptive(motion.scene, method, rtol, scales.time)
    taken.check()
    stepper = getattr(scipy.integrate, method)(
        motion,
        0.0,
        motion.start,
        end,
        rtol=rtol,
        atol=atol * np.repeat([y, v], motion.size),
        first_step=min(1e-3 * y / v, end),  # SciPy's own guess depends on the units
    )
    recorder = _Recorder(motion)
    steps = 0
    with progress(taken) as tell:
        while stepper.status == "running":
            if steps > EXCESS * taken.steps:
                raise IntegrationError(
                    f"{steps} steps of {method} reach t = {stepper.t:g} where {taken.steps:.0f} "
                    f"are enough for all of {end:g}: rounding hides the motion, or rtol "
                    "is too small for it"
                )
            message = stepper.step()
            steps += 1
            if stepper.status == "failed":
                raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
            recorder.record(stepper)
            tell(stepper.t / end)
    return finished(
        motion,
        stepper.y,
        recorder.records,
        energy=motion.energy(stepper.y),
        evaluations=int(stepper.nfev),
        bead_evaluations=int(stepper.nfev) * motion.size,
        steps=steps,
    )


class _Recorder:
    """The sensors' samples."""

    def __init__(self, motion: Motion) -> None:
        scene = motion.scene
        self.motion, self.done = motion, 0
        self.contacts, self.beads = list(scene.contact_sensors), list(scene.bead_sensors)
        self.time = np.linspace(0.0, scene.duration, scene.samples)
        self.records = {"time": self.time} | {
            name: np.empty((len(sensors), scene.samples))
            for name, sensors in (
                ("contact_force", self.contacts), ("compression", self.contacts),
                ("bead_force", self.beads), ("bead_velocity", self.beads),
            )
        }  # fmt: skip

    def record(self, stepper: Any) -> None:
        """Keep the samples of the last step."""
        until = int(np.searchsorted(self.time, stepper.t, side="right"))
        if (self.contacts or self.beads) and until > self.done:
            state = stepper.dense_output()
            while self.done < until:  # few at a time, as all beads are computed
                part = slice(self.done, min(until, self.done + max(1, _BLOCK // len(stepper.y))))
                self._keep(part, state(self.time[part]))
                self.done = part.stop

    def _keep(self, part: slice, states: Array) -> None:
        """What the sensors see of the states, of shape (2n, samples)."""
        motion, kept = self.motion, self.records
        compression = motion.compression(states[: motion.size])
        force = motion.force(compression)
        kept["compression"][:, part] = compression[self.contacts]
        kept["contact_force"][:, part] = force[self.contacts]
        kept["bead_velocity"][:, part] = states[motion.size :][self.beads]
        for row, bead in enumerate(self.beads):
            kept["bead_force"][row, part] = motion.bead_force(bead, force)
