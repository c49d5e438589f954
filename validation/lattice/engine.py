"""The compiled engine: an embedded Runge–Kutta–Nyström pair and a symplectic splitting.

Numba compiles the loops once and keeps them on disk. A run is the same to the last bit every time.

Pair: two solutions of y'' = f(y) with adaptive steps h (`validation.lattice.schemes`). The error of
a step is the root of the sum over all beads of the squared errors, in the scene's scales of
displacement and velocity; ``rtol`` bounds this error. F = A δ^k with k = 3/2 has no second
derivative at a kink, the time at which a contact opens or closes, and a step across a kink would
err by O(h^{k+1}). So A p_+^k, with a polynomial p close to the contact's compression δ and
p_+ = max(p, 0), is integrated by a quadrature that knows the kink
(`validation.lattice.kernel.kinks`).

Splitting: symplectic, with a fixed step. Every kink leaves an error of O(h^{k+1}), which sets the
step.

Piston: a first bead of infinite mass. Its work is its velocity times the impulse of its contact.

Window: beads ahead of the front have not moved yet and are always left out. A window of N beads
also leaves out the beads more than N behind the front: their energy is still counted, their motion
is NaN. A second run, with a window of 2N beads, shows how much the leading pulse depends on N. The
second run is returned, with NaN for the beads outside the first run's window.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import scipy

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.arrays import (
    BLOCK,
    MARGIN,
    SHORTEST,
    WIDTH,
    Beads,
    Chain,
    Plan,
    Tableau,
    initial_progress,
)
from validation.lattice.knots import Recorder
from validation.lattice.run import (
    WINDOW_CHANGE,
    IntegrationError,
    Run,
    RunProgress,
    check_steps,
    finished,
    mean_step,
    most_steps,
)
from validation.lattice.schemes import SCHEMES, Pair
from validation.lattice.signal import recorded, sampled
from validation.scenes.checks import SceneError, integer, positive

_SUPPORTS = 8  # supports of the long-wave pulse in a window of the engine's choice
_POINTS = 8  # nodes of the quadrature at a kink
_NOISE = sys.float_info.epsilon  # in units of the greatest value: a bead that moves less is still
_BETWEEN_REPORTS = 5e7  # bead evaluations between two reports of progress: some tenths of a second
# The splitting's step per stage is (rtol/0.01)^0.4 in units of the scene's shortest time, measured
# on a Hertz dimer of 560 beads; at 0.2 it is still stable.
_KINKS, _COARSEST = 0.01, 0.2
_EXTRA_STEPS = 100  # added to the expected number of steps: a first step of a pair is shorter


def follow(
    motion: Motion, method: str, rtol: float, step: float | None, window: Any, progress: RunProgress
) -> Run:
    """Integrate a scene by a method of `SCHEMES`; the arguments are those of `simulate`."""
    beads = _window(motion, window)
    plan, most = _plan(motion, method, rtol, step)

    def integrated(window: int, followed: Array | None = None) -> tuple[Run, Array]:
        plan_of_window = plan._replace(window=window if window < motion.size else 0)
        return _integrated(motion, method, plan_of_window, most, progress, followed)

    if beads is None:
        return integrated(0)[0]
    short, left = integrated(beads)
    long, _ = integrated(2 * beads, left)
    _compare(motion, rtol, short, long)
    return replace(long, window=beads)


def _window(motion: Motion, window: Any) -> int | None:
    """Return the number of beads to integrate behind the front; None for the whole chain."""
    if window is False:
        return None
    if motion.scene.wall is not None or (motion.k == 1 and window is True):
        raise SceneError(
            f"window is {window}: behind a wall, and at k = 1, waves come back; "
            "the whole chain is wanted"
        )
    if window is True:
        # π/β with β = (k-1) √(6/(k(k+1))) of equal beads and D = 1, √10/5 at k = 3/2
        support = math.pi / (motion.k - 1) * math.sqrt(motion.k * (motion.k + 1) / 6)
        beads = math.ceil(min(_SUPPORTS * support, motion.size)) + MARGIN
    else:
        beads = integer(window, "window", BLOCK)
    return beads if beads < motion.size else None


def _compare(motion: Motion, rtol: float, short: Run, long: Run) -> None:
    """Raise `IntegrationError` if a longer window of beads changes the leading pulse.

    The velocities of both runs at the end are compared, from the fastest bead to the front.
    """
    followed = np.isfinite(short.velocities)
    v, longer_v = short.velocities[followed], long.velocities[followed]
    leading = slice(int(np.argmax(np.abs(longer_v))), None)
    change = np.abs(v - longer_v)[leading].max() / motion.scales.velocity
    if change > WINDOW_CHANGE * rtol:
        raise IntegrationError(
            f"a window of {short.window} beads is too short: twice as many change the leading "
            f"pulse by {change:.1g} where rtol is {rtol:g}; more or the whole chain is wanted"
        )


def _integrated(
    motion: Motion,
    method: str,
    plan: Plan,
    most: int,
    progress: RunProgress,
    followed: Array | None,
) -> tuple[Run, Array]:
    """Integrate a scene in at most ``most`` steps.

    followed : for each bead the time after which its records are NaN, or infinity; by default the
        time at which the moving window of integrated beads leaves the bead.

    Returns the run and these times.
    """
    n, end, stages = motion.size, motion.scene.duration, SCHEMES[method].stages
    chain = _chain(motion)
    beads = _start(motion, len(chain.A))
    time, needed = sampled(motion)
    recorder = Recorder(chain, plan.scheme.points, needed, time)
    now = initial_progress(plan, _front(motion))
    glance = 1 + int(_BETWEEN_REPORTS / (stages * max(n, SHORTEST)))
    t = 0.0
    with progress() as display:
        while t < end:
            display(t / end)
            t, _ = advance(chain, beads, plan, recorder.knots, now, glance)
            if t < end:
                check_steps(method, int(now["tries"]), most, t, end)
            if t == end or now["stored"] == len(recorder.knots.time):
                now["stored"] = recorder.take(int(now["stored"]))
    drive = motion.scene.drive
    paid = () if drive is None else (0.0, beads.v[0] * float(now["impulse"]))
    state = np.concatenate((beads.y[:n], beads.v[:n], paid))
    if not np.isfinite(state).all():
        raise IntegrationError(f"the motion overflows: a step of {plan.h:g} is too long")
    left = beads.left if followed is None else followed
    path = recorder.path(left)
    run = finished(
        motion,
        state,
        {"time": time} | recorded(motion, needed, recorder.y, recorder.v),
        motion.balance(state, int(now["lo"])) + float(now["lost"]),
        steps=int(now["steps"]),
        behind=np.isfinite(left[:n]),
        evaluations=int(now["tries"]) * stages,
        bead_evaluations=int(now["evaluations"]),
        window=plan.window or None,
        path=path,
    )
    return run, left


@lru_cache
def _tableau(method: str, k: float) -> Tableau:
    """Return the coefficients of a method, and the quadrature for kinks of exponent k."""
    scheme = SCHEMES[method]
    nothing, table = np.zeros(0), np.zeros((0, 0))
    points = table
    if k < scheme.order:  # else the scheme sees no kink
        u, w = scipy.special.roots_jacobi(_POINTS, 0.0, k)  # of ∫ (1 + u)^k f(u) du from -1 to 1
        points = np.stack(((1 + u) / 2, w / 2 ** (k + 1)))
    if not isinstance(scheme, Pair):
        return Tableau(scheme.kicks, scheme.drifts, nothing, table, table, 0, points)
    return Tableau(nothing, nothing, *scheme.arrays(WIDTH), scheme.lower, points)


def _plan(motion: Motion, method: str, rtol: float, step: float | None) -> tuple[Plan, int]:
    """Return the integration plan for the whole chain, and the greatest number of steps."""
    scheme, scales, end = SCHEMES[method], motion.scales, motion.scene.duration
    longest = math.inf if step is None else positive(step, "step")
    if isinstance(scheme, Pair):
        mean = min(mean_step(method, rtol) * min(scales.time, end), longest)
        careful = _EXTRA_STEPS
    else:
        natural = min((rtol / _KINKS) ** 0.4, _COARSEST) * scheme.stages
        mean = natural * min(scales.time, end) if step is None else longest
        careful = 0
    most = most_steps(motion.scene, method, end / mean, 16)
    plan = Plan(
        scheme=_tableau(method, motion.k if motion.contact.law is None else math.inf),
        y=rtol * scales.displacement,
        v=rtol * scales.velocity,
        h=end / math.ceil(end / mean + careful),
        longest=longest,
        end=end,
        deepest=scales.compression,
        quickest=motion.stiffnesses.max(initial=0.0) / motion.masses.min(),
        size=motion.size,
        window=0,
    )
    return plan, most


def _chain(motion: Motion) -> Chain:
    """Build the kernel's chain, padded by beads of infinite mass; the first of them is the wall."""
    inverse, A, rest, load = rows = np.zeros((4, motion.size + 2 * SHORTEST))
    given = 1 / motion.masses, motion.stiffnesses, motion.rest, motion.load
    for row, values in zip(rows, given, strict=True):
        row[: len(values)] = values
    if motion.scene.drive is not None:
        inverse[0] = 0.0
    law = motion.contact
    kind: dict[str, Any] = dict(generated=law.law is not None, pulls=law.pulls, **law.addresses)
    return Chain(inverse, A, rest, load, motion.k, **kind)


def _front(motion: Motion) -> int:
    """Return the number of the first bead at rest, plus a margin."""
    y, v = np.abs(motion.start[: 2 * motion.size].reshape(2, motion.size))
    moving = np.flatnonzero((y > _NOISE * y.max()) | (v > _NOISE * v.max()))
    return min(motion.size, MARGIN + (int(moving[-1]) + 1 if len(moving) else 0))


def _start(motion: Motion, padded: int) -> Beads:
    """Build the kernel's initial state, arrays with room for ``padded`` + 1 beads."""
    n = motion.size
    y, v, next_y, next_v, left = np.zeros((5, padded + 1))
    y[:n], v[:n], left[:] = motion.start[:n], motion.start[n : 2 * n], np.inf
    sums, force = np.zeros((4, padded + 1)), np.zeros((2 * WIDTH, padded + 1))
    return Beads(y, v, next_y, next_v, left, force, sums)
