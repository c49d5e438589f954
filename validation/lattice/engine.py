"""The compiled engine: symmetric splittings at a fixed step, on a window that moves with the pulse.

A step alternates kicks v += b_s h F(y)/m and drifts y += a_s h v (`validation.lattice.schemes`): it
is symplectic, time-reversible, and keeps the momentum to rounding. Numba compiles it once and
caches it on disk. The loops over beads hold no branch, so that they vectorise.

Order. F = A δ^k with k = 3/2 has no second derivative where a contact opens or closes: with every
such passage a step errs by O(h^{k+1}) whatever the scheme, which leaves h^{5/2} of order 4 and of
order 6. The step that ``rtol`` asks for follows from that law, not from the scheme's own order.

Window. Ahead nothing moves: the front advances with the first bead that does. Behind, beads more
than ``reach`` from the front are left to fly on freely, with their energy on the books, once the
contact that is cut is open but for a trace of the peak force and no strong blow is to come (the
thresholds of `validation.lattice.kernel`), or four reaches behind in any case. As contacts carry no
tension, the pulse does not depend on what is cut, unless it decays so fast (`_DECAY`) that its own
tail may overtake it. As a pulse decays, the step grows with its time scale, F^{(1-k)/2k}.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from validation.lattice import effort
from validation.lattice.effort import Effort, Progress
from validation.lattice.equations import Array, Motion
from validation.lattice.kernel import BLOCK, MARGIN, SHORTEST, advance, beginning
from validation.lattice.run import IntegrationError, Run, Window, frozen
from validation.lattice.schemes import LAWS, SCHEMES
from validation.scenes.checks import SceneError, integer, positive
from validation.scenes.scene import Scene

_SUPPORTS = 4.0
"""Supports of the long-wave pulse that the window reaches back."""
_DECAY = 0.9
"""Of a pulse's peak, a reach later: where less is left, the window by default gives way."""
_WINDOW = 2
"""Reaches that a window holds, about."""
_GLANCE = 0.2
"""Seconds, about, from one look at the progress to the next, or at Ctrl-C."""


def follow(
    scene: Scene,
    method: str,
    *,
    rtol: float,
    step: float | None,
    window: Any,
    check: bool,
    progress: Progress,
) -> Run:
    """`validation.simulate` for a method of `SCHEMES`."""
    reach = _reach(scene, window)
    chain = _Chain(scene, method, rtol, step, progress)
    run = chain.run(reach)
    if window is None and run.window is not None and run.window.decay < _DECAY:
        reach = None
        run = chain.run(reach)
    if not check:
        return run
    if not scene.contact_sensors and not scene.bead_sensors:
        raise SceneError("check compares what sensors record: the scene has none")
    return replace(
        run,
        step_error=_difference(run, chain.run(reach, coarser=2.0)),
        window_error=None if reach is None else _difference(run, chain.run(reach, whole=True)),
    )


def _reach(scene: Scene, window: Any) -> int | None:
    """Beads to follow behind the front; None for the whole chain."""
    returns = scene.wall is not None or scene.k == 1
    if window is False or not scene.stiffnesses or (window is None and returns):
        return None
    if returns:
        raise SceneError(
            f"window is {window}: behind a wall, and at k = 1, waves come back; "
            "the whole chain is wanted"
        )
    if window is not None and window is not True:
        return integer(window, "window", BLOCK)
    moving = np.zeros(scene.size, bool)
    moving[: len(scene.velocities)] = scene.velocities
    masses = np.array(scene.masses)
    masses = masses if moving.all() else masses[~moving]  # a striker may be of any mass
    support = math.pi / (scene.k - 1) * math.sqrt(scene.k * (scene.k + 1) / 6)
    behind = _SUPPORTS * support * masses.max() / masses.mean()
    reach = 2 * MARGIN + math.ceil(behind if behind < scene.size else scene.size)
    return None if window is None and reach >= scene.size else reach


class _Chain:
    """A scene in the kernel's arrays, padded by beads of infinite mass: the first is the wall."""

    def __init__(
        self, scene: Scene, method: str, rtol: float, step: float | None, progress: Progress
    ) -> None:
        self.scene, self.motion, self.scheme = scene, Motion(scene), SCHEMES[method]
        self.method, self.progress = method, progress
        motion, n = self.motion, scene.size
        self.start = motion.start.reshape(2, n)
        scales = motion.scales(motion.start)
        self.energy, self.deepest = scales.energy, scales.compression
        # inverse masses, stiffnesses, rest compressions, loads
        self.lattice = np.zeros((4, n + 2 * SHORTEST))
        self.lattice[0, :n] = 1 / motion.masses
        for row, values in enumerate((motion.stiffnesses, motion.rest, motion.load), 1):
            self.lattice[row, : len(values)] = values
        self.adapt = step is None
        if step is None:
            step = effort.step(method, rtol) * min(scales.time, scene.duration)
        self.step = positive(step, "step")

    def _effort(self, reach: int | None, step: float) -> Effort:
        n, steps = self.scene.size, self.scene.duration / step
        beads = n if reach is None else min(n, _WINDOW * reach)
        found = effort.compiled(self.scene, self.method, steps, beads)
        found.check()
        return found

    def run(self, reach: int | None, *, whole: bool = False, coarser: float = 1.0) -> Run:
        """Integrate; ``whole`` takes a window's steps but moves all beads."""
        scene, scheme, n, end = self.scene, self.scheme, self.scene.size, self.scene.duration
        taken = self._effort(None if whole else reach, self.step * coarser)
        count = math.ceil(taken.steps)
        y, v = np.zeros((2, self.lattice.shape[1]))
        y[:n], v[:n] = self.start
        size = np.abs(self.start)
        noise = np.finfo(float).eps * size.max(axis=1, keepdims=True)
        moved = np.flatnonzero((size > noise).any(axis=0))  # rounding noise is no front
        front = min(n, MARGIN + (moved[-1] + 1 if len(moved) else 0))
        time = np.linspace(0.0, end, scene.samples)
        contacts = np.array(scene.contact_sensors, int)
        beads = np.array(scene.bead_sensors, int)
        watched = np.union1d(np.append(contacts, beads - 1), np.append(contacts, beads) + 1)
        watched = np.union1d(watched, beads)[int(0 in beads) :]  # not bead -1
        seen = np.repeat(np.stack((y, v))[:, watched, None], len(time), axis=2)
        left = np.full(len(y), np.inf)
        inverse, A, rest, load = self.lattice
        force, glance = np.zeros(len(y) + 1), max(1, int(_GLANCE * taken.steps / taken.seconds))
        at = beginning(front, end / count, A.max(), self.deepest, scene.k)
        with self.progress(taken) as tell:
            while (t := at[1][0]) < end:
                tell(t / end)
                at = advance(
                    y, v, inverse, A, rest, load, LAWS.get(scene.k, 0), scene.k,
                    scheme.kicks, scheme.drifts, end / count, end, self.deepest,
                    self.adapt and reach is not None, n, reach or n, whole or reach is None,
                    time, watched, seen[0], seen[1], left, force, at, at[0][0] + glance,
                )  # fmt: skip
        steps, evaluations, rear = at[0][0], at[0][1], at[0][4]
        lost, decay = at[1][-2:]
        if not (np.isfinite(y).all() and np.isfinite(v).all()):
            raise IntegrationError(f"the motion overflows: a step of {end / count:g} is too long")
        state = np.concatenate((y[:n], v[:n]))
        energy = self.motion.energy(state, rear) + lost
        y[:rear] += v[:rear] * (end - left[:rear])
        for row, j in enumerate(watched):
            flying = time > left[j]
            seen[0, row, flying] = y[j] + v[j] * (time[flying] - end)
            seen[1, row, flying] = v[j]

        def contact(i: NDArray[np.int_]) -> tuple[Array, Array]:
            """Compression and force; contact -1 is a padded one, without stiffness."""
            row = np.searchsorted(watched, i)
            compression = rest[i, None] + seen[0, row] - seen[0, row + 1]
            force = A[i, None] * np.maximum(compression, 0.0) ** scene.k
            return compression, np.where(time > left[i, None], 0.0, force)

        compression, contact_force = contact(contacts)
        bead_force = (contact(beads - 1)[1] + contact(beads)[1]) / 2
        window = None
        if reach is not None and not whole:
            before = np.maximum(beads - 1, 0)
            until = frozen(
                contact_until=np.minimum(left[contacts], end),
                bead_until=np.minimum(left[before], end),
            )
            window = Window(reach, rear, decay, **until)
        return Run(
            scene=scene,
            **frozen(
                time=time,
                contact_force=contact_force,
                compression=compression,
                bead_force=bead_force,
                bead_velocity=seen[1, np.searchsorted(watched, beads)],
                displacements=y[:n].copy(),
                velocities=v[:n].copy(),
            ),
            energy_drift=(energy - self.energy) / self.energy if self.energy else 0.0,
            momentum_drift=self.motion.momentum_drift(self.start[1], v[:n]),
            evaluations=steps * scheme.stages,
            bead_evaluations=evaluations,
            step=end / steps,
            window=window,
        )


def _difference(run: Run, other: Run) -> float:
    """Largest difference of a sensor's force while both followed it, over the largest force."""
    worst = top = 0.0
    for kind in ("contact", "bead"):
        force, otherwise = (getattr(one, f"{kind}_force") for one in (run, other))
        known = np.ones(force.shape, bool)
        for window in (run.window, other.window):
            if window is not None:
                known &= run.time <= getattr(window, f"{kind}_until")[:, None]
        worst = max(worst, np.abs(np.where(known, force - otherwise, 0.0)).max(initial=0.0))
        top = max(top, force.max(initial=0.0))
    return float(worst / top) if top else float(worst)
