"""The compiled engine: a pair or a splitting, on a window that moves with the pulse.

Numba compiles it once and caches it on disk. A run is the same to the bit every time.

Pair. The adaptive one for y'' = f(y) (`validation.lattice.schemes.nystrom`). The error of a step is
the root of the sum of its beads' squares, in the scene's scales of displacement and velocity, and
is kept at ``rtol``; the next step follows from it alone. F = A δ^k with k = 3/2 has no second
derivative where a contact opens or closes: the step would err by O(h^{k+1}) there, and little less
next to it. So p_+^k, for a polynomial p that is nearly the contact's δ, is taken off its force, and
is integrated by a quadrature that knows the kink.

Splitting. Symplectic, at a fixed step (`validation.lattice.schemes.splitting`): with every kink it
errs by O(h^{k+1}), and its step follows from that.

Samples come from Hermite's polynomial with y, y', y'' and y''' at the ends of two steps,
or of one with a kink; what p_+^k brings about is no part of it.

Window. Ahead nothing moves: the front advances with the first bead that does. Behind, beads more
than ``reach`` from the front are left to fly on freely, with their energy on the books, once the
contact that is cut is open but for a trace of the peak force and no strong blow is to come (the
thresholds of `validation.lattice.kernel`), or eight reaches behind in any case. As contacts carry
no tension, a struck chain's pulse does not depend on what is cut, unless it decays so fast
(`_DECAY`, `_LEFT`) that its own tail may overtake it: then, where too little was passed to tell,
and where something was left that was no such contact, the run is made again with the whole chain,
whoever asked for a window. Blows within, and contacts of many kinds, get none. As a pulse decays,
the step grows with its time scale, F^{(1-k)/2k}, and the error that is allowed shrinks with it.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice import effort, kernel
from validation.lattice.effort import EXCESS, RunProgress
from validation.lattice.equations import Motion, power
from validation.lattice.kernel import Beads, Chain, Plan, Samples, Tableau, advance, beginning
from validation.lattice.run import IntegrationError, Run, finished
from validation.lattice.schemes import LAWS, SCHEMES
from validation.lattice.schemes.nystrom import Pair
from validation.scenes.checks import SceneError, integer, positive
from validation.scenes.scene import Scene

# In supports of the long-wave pulse: what the window reaches back, and after what it is looked at.
_BACK, _LOOK = 2.0, 4.0
# Of a pulse's peak, a look later and at the end: where less is left, the window gives way.
_DECAY, _LEFT = 0.9, 0.5
_WINDOW = 2  # reaches that a window holds, about
_UNEVEN = 4.0  # stiffnesses: the greatest over the least that a window is for
_POINTS = 8  # of the quadrature at a kink
_NOISE = sys.float_info.epsilon  # of the greatest: rounding is no front
_GLANCE = 0.2  # seconds, about, from one look at the progress to the next, or at Ctrl-C


@dataclass(frozen=True)
class Given:
    """step : of a splitting; of a pair the one that is expected."""

    method: str
    rtol: float
    step: float
    longest: float


def follow(
    motion: Motion, method: str, rtol: float, step: float | None, window: Any, progress: RunProgress
) -> Run:
    """`validation.simulate` for a method of `SCHEMES`."""
    reach = _reach(motion, window)
    end = motion.scene.duration
    natural = effort.step(method, rtol) * min(motion.scales.time, end)
    longest = math.inf if step is None else positive(step, "step")
    shorter = step is None or (natural < longest and isinstance(SCHEMES[method], Pair))
    given = Given(method, rtol, natural if shorter else longest, longest)
    run, kept = _integrated(motion, given, reach, progress)
    return run if kept else _integrated(motion, given, None, progress)[0]


def _say_if_compiled() -> None:
    """On a terminal: that the loops are compiled first, which takes its time once."""
    loops: Any = advance  # numba's
    if loops.overloads or not sys.stderr.isatty():
        return
    written = Path(kernel.__file__).stat().st_mtime
    kept = Path(loops.stats.cache_path).glob("kernel.advance-*.nbi")
    if not any(file.stat().st_mtime > written for file in kept):
        print("the engine is compiled for this machine, once", file=sys.stderr, flush=True)


def _returns(motion: Motion) -> bool:
    """Whether waves come back: behind a wall, and at k = 1."""
    return motion.scene.wall is not None or motion.k == 1


def _reach(motion: Motion, window: Any) -> int | None:
    """Beads to follow behind the front; None for the whole chain."""
    scene, returns = motion.scene, _returns(motion)
    if window is False or not scene.stiffnesses or (window is None and returns):
        return None
    if returns:
        raise SceneError(
            f"window is {window}: behind a wall, and at k = 1, waves come back; "
            "the whole chain is wanted"
        )
    reach = _supports(motion, _BACK)
    if window is not None and window is not True:
        reach = max(reach, integer(window, "window", kernel.BLOCK))
    # In so few beads nothing would be known of the pulse's decay; of several blows, or in contacts
    # of many kinds, a later pulse may be the faster one; and from within, waves go both ways.
    few = motion.size < 2.5 * _supports(motion, _LOOK)
    inner = not scene.displacements and any(scene.velocities[1:])
    uneven = motion.stiffnesses.max() > _UNEVEN * motion.stiffnesses.min()
    return None if few or inner or uneven else reach


def _supports(motion: Motion, number: float) -> int:
    """Beads of so many of the pulse's supports, and a margin at both ends."""
    n, k = motion.size, motion.k
    still = motion.start[n:] == 0
    masses = motion.masses[still] if still.any() else motion.masses  # a striker may be of any mass
    support = math.pi / (k - 1) * math.sqrt(k * (k + 1) / 6)
    back = min(n, number * support * masses.max() / masses.mean())
    return 2 * kernel.MARGIN + math.ceil(float(back))


def _integrated(
    motion: Motion, given: Given, reach: int | None, progress: RunProgress
) -> tuple[Run, bool]:
    """The run, and whether nothing behind a window can have a say in the pulse."""
    n, end = motion.size, motion.scene.duration
    moved = n if reach is None else min(n, _WINDOW * reach)
    taken = effort.compiled(motion.scene, given.method, end / given.step, moved)
    taken.check()
    _say_if_compiled()
    chain = _chain(motion)
    beads, seen = _start(motion, len(chain.A))
    plan = _plan(motion, given, chain, reach, end / math.ceil(taken.steps))
    at = beginning(plan, chain.k, _front(motion))
    glance = max(1, int(_GLANCE * taken.steps / taken.seconds))
    t = 0.0
    with progress(taken) as tell:
        while t < end:
            tell(t / end)
            t = advance(chain, beads, plan, seen, at, glance)
            if t < end and at["tries"] > EXCESS * taken.steps:
                raise IntegrationError(effort.beyond(taken, int(at["tries"]), t))
    rear, steps, tries, moves = (int(at[name]) for name in ("lo", "steps", "tries", "evaluations"))
    state = np.concatenate((beads.y[:n], beads.v[:n]))
    if not np.isfinite(state).all():
        raise IntegrationError(f"the motion overflows: a step of {plan.h:g} is too long")
    energy = motion.energy(state, rear) + float(at["lost"])
    if rear:
        _fly_on(beads, seen, rear, end)
        state[:rear] = beads.y[:rear]
    records = _recorded(motion.scene, chain, beads, seen)
    evaluations = tries * SCHEMES[given.method].stages
    run = finished(motion, state, records, energy, steps, evaluations, moves, reach)
    kept = at["legs"] > 2 and at["decay"] >= _DECAY and at["left"] >= _LEFT
    return run, not rear or bool(kept)


@lru_cache
def _tableau(method: str, k: float) -> Tableau:
    scheme = SCHEMES[method]
    nothing, table = np.zeros(0), np.zeros((0, 0))
    if not isinstance(scheme, Pair):
        return Tableau(scheme.kicks, scheme.drifts, nothing, table, table, 0, table)
    points = table
    if k < scheme.order:  # else no kink is left that the pair sees
        u, w = scipy.special.roots_jacobi(_POINTS, 0.0, k)
        points = np.stack(((1 + u) / 2, w / 2 ** (k + 1)))
    return Tableau(nothing, nothing, *scheme.arrays(kernel.WIDTH), scheme.lower, points)


def _plan(motion: Motion, given: Given, chain: Chain, reach: int | None, step: float) -> Plan:
    """Of the whole run."""
    n, scales, inverse = motion.size, motion.scales, chain.inverse
    stiffest = chain.A.max()
    # without a window the splitting's step stays: rattling at the rear does not slow down
    adapt = isinstance(SCHEMES[given.method], Pair) or (
        given.longest == math.inf and reach is not None
    )
    return Plan(
        _tableau(given.method, motion.k), given.rtol * scales.displacement,
        given.rtol * scales.velocity, step, given.longest, motion.scene.duration,
        scales.compression, stiffest,
        1 / inverse[min(1, n - 1) : n].min(), stiffest * inverse.max(), n,
        0 if _returns(motion) else _supports(motion, _LOOK), reach or 0, adapt,
    )  # fmt: skip


def _chain(motion: Motion) -> Chain:
    """Padded by beads of infinite mass: the first is the wall."""
    inverse, A, rest, load = rows = np.zeros((4, motion.size + 2 * kernel.SHORTEST))
    given = 1 / motion.masses, motion.stiffnesses, motion.rest, motion.load
    for row, values in zip(rows, given, strict=True):
        row[: len(values)] = values
    return Chain(inverse, A, rest, load, LAWS.get(motion.k, 0), motion.k)


def _front(motion: Motion) -> int:
    """The first bead that is still, and a margin."""
    y, v = np.abs(motion.start.reshape(2, motion.size))
    moving = np.flatnonzero((y > _NOISE * y.max()) | (v > _NOISE * v.max()))
    return min(motion.size, kernel.MARGIN + (int(moving[-1]) + 1 if len(moving) else 0))


def _start(motion: Motion, padded: int) -> tuple[Beads, Samples]:
    """The beads as they start, and the samples of the sensors' beads and of their contacts'."""
    scene, n = motion.scene, motion.size
    y, v, next_y, next_v, left = np.zeros((5, padded + 1))
    y[:n], v[:n], left[:] = motion.start[:n], motion.start[n:], np.inf
    sums, force = np.zeros((4, padded + 1)), np.zeros((2 * kernel.WIDTH, padded + 1))
    near = {i + m for i in scene.contact_sensors for m in (0, 1)}
    near |= {j + m for j in scene.bead_sensors for m in (-1, 0, 1) if j + m >= 0}
    watched = np.array(sorted(near), int)
    # np.linspace takes three times as long
    time = np.arange(scene.samples) / (scene.samples - 1) * scene.duration
    seen_y, seen_v = np.empty((2, len(watched), len(time)))
    seen_y[:], seen_v[:] = y[watched, None], v[watched, None]
    knots, room = np.zeros((3, 4, len(watched))), np.zeros((17, 12))
    beads = Beads(y, v, next_y, next_v, left, force, sums, kinks=np.zeros((padded + 1, 7)))
    return beads, Samples(time, watched, knots, seen_y, seen_v, room)


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
        force = chain.A[i, None] * power(compression, scene.k)
        if beads.left[0] < scene.duration:  # the first is left first
            force[seen.time > beads.left[i, None]] = 0.0
        return compression, force

    contacts, sensors = (np.array(row, int) for row in (scene.contact_sensors, scene.bead_sensors))
    none = np.zeros((0, len(seen.time)))
    compression, force = contact(contacts) if len(contacts) else (none, none)
    mean, y, v = none, none, none
    if len(sensors):
        row = np.searchsorted(seen.watched, sensors)
        mean, y, v = (contact(sensors - 1)[1] + contact(sensors)[1]) / 2, seen.y[row], seen.v[row]
    return {
        "time": seen.time,
        "contact_force": force,
        "compression": compression,
        "bead_force": mean,
        "bead_displacement": y,
        "bead_velocity": v,
    }
