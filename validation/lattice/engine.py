"""The compiled engine: symmetric splittings at a fixed step, on a window that moves with the pulse.

A step alternates kicks v += b_s h F(y)/m and drifts y += a_s h v (`validation.lattice.schemes`): it
is symplectic, time-reversible, and keeps the momentum to rounding. Numba compiles it once and
caches it on disk.

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
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.numeric import Array
from validation.lattice import effort
from validation.lattice.effort import RunProgress
from validation.lattice.equations import Motion
from validation.lattice.kernel import (
    BLOCK,
    MARGIN,
    SHORTEST,
    Beads,
    Chain,
    Plan,
    Samples,
    advance,
    beginning,
)
from validation.lattice.run import IntegrationError, Run, Window, finished, frozen
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
    motion: Motion, method: str, rtol: float, step: float | None, window: Any, progress: RunProgress
) -> Run:
    """`validation.simulate` for a method of `SCHEMES`."""
    reach = _reach(motion, window)
    natural = effort.step(method, rtol) * min(motion.scales.time, motion.scene.duration)
    longest = positive(natural if step is None else step, "step")
    run = _integrated(motion, method, longest, step is None, reach, progress)
    if window is None and run.window is not None and run.window.decay < _DECAY:
        return _integrated(motion, method, longest, False, None, progress)
    return run


def _reach(motion: Motion, window: Any) -> int | None:
    """Beads to follow behind the front; None for the whole chain."""
    scene, n, k = motion.scene, motion.size, motion.k
    returns = scene.wall is not None or k == 1
    if window is False or not scene.stiffnesses or (window is None and returns):
        return None
    if returns:
        raise SceneError(
            f"window is {window}: behind a wall, and at k = 1, waves come back; "
            "the whole chain is wanted"
        )
    if window is not None and window is not True:
        return integer(window, "window", BLOCK)
    still = motion.start[n:] == 0
    masses = motion.masses[still] if still.any() else motion.masses  # a striker may be of any mass
    support = math.pi / (k - 1) * math.sqrt(k * (k + 1) / 6)
    reach = 2 * MARGIN + math.ceil(min(n, _SUPPORTS * support * masses.max() / masses.mean()))
    return None if window is None and reach >= n else reach


def _integrated(
    motion: Motion,
    method: str,
    step: float,
    adapt: bool,
    reach: int | None,
    progress: RunProgress,
) -> Run:
    """The run, of a window that reaches so far back or of the whole chain."""
    n, end, scheme = motion.size, motion.scene.duration, SCHEMES[method]
    moved = n if reach is None else min(n, _WINDOW * reach)
    taken = effort.compiled(motion.scene, method, end / step, moved)
    taken.check()
    chain = _chain(motion)
    beads, seen = _start(motion, len(chain.A))
    plan = Plan(
        scheme.kicks, scheme.drifts, end / math.ceil(taken.steps), end,
        motion.scales.compression, chain.A.max(), 1 / chain.inverse[min(1, n - 1) : n].min(), n,
        reach or 0, adapt,
    )  # fmt: skip
    at = beginning(plan, chain.k, n if reach is None else _front(motion))
    glance = int(_GLANCE * taken.steps / taken.seconds)
    t = 0.0
    with progress(taken) as tell:
        while t < end:
            tell(t / end)
            t = advance(chain, beads, plan, seen, at, max(1, glance))
    if not (np.isfinite(beads.y).all() and np.isfinite(beads.v).all()):
        raise IntegrationError(f"the motion overflows: a step of {plan.h:g} is too long")
    rear, energy = int(at["lo"]), motion.energy(_state(beads, n), at["lo"]) + float(at["lost"])
    _fly_on(beads, seen, rear, end)
    return finished(
        motion,
        _state(beads, n),
        _recorded(motion.scene, chain, beads, seen),
        energy=energy,
        evaluations=int(at["steps"]) * scheme.stages,
        bead_evaluations=int(at["evaluations"]),
        steps=int(at["steps"]),
        window=None if reach is None else _window(motion.scene, reach, rear, at, beads.left),
    )


def _chain(motion: Motion) -> Chain:
    """Padded by beads of infinite mass: the first is the wall."""
    inverse, A, rest, load = rows = np.zeros((4, motion.size + 2 * SHORTEST))
    given = 1 / motion.masses, motion.stiffnesses, motion.rest, motion.load
    for row, values in zip(rows, given, strict=True):
        row[: len(values)] = values
    return Chain(inverse, A, rest, load, LAWS.get(motion.k, 0), motion.k)


def _front(motion: Motion) -> int:
    """The first bead that is still, and a margin."""
    size = np.abs(motion.start.reshape(2, motion.size))
    noise = np.finfo(float).eps * size.max(axis=1, keepdims=True)
    moving = np.flatnonzero((size > noise).any(axis=0))  # rounding noise is no front
    return min(motion.size, MARGIN + (int(moving[-1]) + 1 if len(moving) else 0))


def _start(motion: Motion, padded: int) -> tuple[Beads, Samples]:
    """The beads as they start, and who is watched: those of the sensors, and of their contacts."""
    scene, n = motion.scene, motion.size
    y, v, force, left = np.zeros((4, padded + 1))
    y[:n], v[:n], left[:] = motion.start[:n], motion.start[n:], np.inf
    contacts, beads = _sensors(scene)
    watched = np.unique(np.concatenate((contacts, contacts + 1, beads - 1, beads, beads + 1)))
    watched = watched[watched >= 0]
    time = np.linspace(0.0, scene.duration, scene.samples)
    seen = np.repeat(np.stack((y, v))[:, watched, None], len(time), axis=2)
    return Beads(y, v, force, left), Samples(time, watched, np.zeros((3, len(watched))), *seen)


def _sensors(scene: Scene) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    return np.array(scene.contact_sensors, int), np.array(scene.bead_sensors, int)


def _state(beads: Beads, n: int) -> Array:
    return np.concatenate((beads.y[:n], beads.v[:n]))


def _fly_on(beads: Beads, seen: Samples, rear: int, end: float) -> None:
    """Beads that were left behind have kept their velocities since."""
    y, v, left = beads.y, beads.v, beads.left
    y[:rear] += v[:rear] * (end - left[:rear])
    for row, j in enumerate(seen.watched):
        flying = seen.time > left[j]
        seen.y[row, flying] = y[j] + v[j] * (seen.time[flying] - end)
        seen.v[row, flying] = v[j]


def _recorded(scene: Scene, chain: Chain, beads: Beads, seen: Samples) -> dict[str, Array]:
    """By the sensors."""

    def contact(i: NDArray[np.int_]) -> tuple[Array, Array]:
        """Compression and force; contact -1 is a padded one, without stiffness."""
        row = np.searchsorted(seen.watched, i)
        compression = chain.rest[i, None] + seen.y[row] - seen.y[row + 1]
        force = chain.A[i, None] * np.maximum(compression, 0.0) ** scene.k
        return compression, np.where(seen.time > beads.left[i, None], 0.0, force)

    contacts, sensors = _sensors(scene)
    compression, force = contact(contacts)
    return {
        "time": seen.time,
        "contact_force": force,
        "compression": compression,
        "bead_force": (contact(sensors - 1)[1] + contact(sensors)[1]) / 2,
        "bead_velocity": seen.v[np.searchsorted(seen.watched, sensors)],
    }


def _window(scene: Scene, reach: int, rear: int, at: Any, left: Array) -> Window:
    contacts, beads = _sensors(scene)
    until = frozen(
        contact_until=np.minimum(left[contacts], scene.duration),
        bead_until=np.minimum(left[np.maximum(beads - 1, 0)], scene.duration),
    )
    return Window(reach, rear, float(at["decay"]), **until)
