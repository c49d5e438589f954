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

Drive: a first bead of infinite mass with a given motion. Steps end at the end of a ramp and at the
knots of a file.

Damping: forces depend on velocities, and a Runge–Kutta pair takes the steps
(`validation.lattice.kernel.damped`).

Front: beads ahead of the front have not moved yet and are left out.
"""

from __future__ import annotations

import math
import sys
from functools import lru_cache
from typing import Any

import numpy as np
import scipy

from validation.lattice.cost import RunProgress, check_memory, check_steps, step_limit
from validation.lattice.damped import COLUMNS, scheme_of, step_recorder
from validation.lattice.equations import Motion
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.arrays import (
    MARGIN,
    SHORTEST,
    WIDTH,
    Beads,
    Chain,
    Drive,
    Plan,
    Tableau,
    initial_progress,
)
from validation.lattice.kernel.damped import STEP, Scheme, advance_damped
from validation.lattice.kernel.symplectic import advance_split
from validation.lattice.knots import knot_recorder
from validation.lattice.result import Run, finished
from validation.lattice.schemes import SCHEMES, Pair
from validation.lattice.signal import recorded, sampled
from validation.scenes.checks import positive

_WEAK = 0.1  # least energy of the response in units of the energy that sets the tolerance
_POINTS = 8  # nodes of the quadrature at a kink
_NOISE = sys.float_info.epsilon  # in units of the greatest value: a bead that moves less is still
_BETWEEN_REPORTS = 5e7  # bead evaluations between two reports of progress: some tenths of a second
# The splitting's step per stage is (rtol/0.01)^0.4 in units of the scene's shortest time, measured
# on a Hertz dimer of 560 beads; at 0.2 it is still stable.
_KINKS, _COARSEST = 0.01, 0.2
_FIRST = 4.0  # first step of a pair over rtol^(1/7), in units of the scene's shortest time


def follow(
    motion: Motion, method: str, rtol: float, step: float | None, progress: RunProgress
) -> Run:
    """Integrate a scene by a method of `SCHEMES`; the arguments are those of `simulate`.

    A run whose tolerance is set by a drive, and whose response turns out far weaker, is made again.
    """
    while True:
        run, response = _integrated(motion, method, rtol, step, progress)
        if not 0 < response < _WEAK * motion.scales.energy:
            return run
        motion = Motion(motion.scene, response)


def _integrated(
    motion: Motion, method: str, rtol: float, step: float | None, progress: RunProgress
) -> tuple[Run, float]:
    """Return a run, and the greatest energy of its contacts and free beads."""
    plan, most = _plan(motion, method, rtol, step)
    n, end, damped = motion.size, motion.scene.duration, motion.scene.damping is not None
    chain = _chain(motion)
    stages, rows = (STEP, COLUMNS) if damped else (SCHEMES[method].stages, 2 * WIDTH)
    beads = _start(motion, len(chain.A), rows)
    time, needed = sampled(motion)
    recorder = (step_recorder if damped else knot_recorder)(
        motion, chain, plan.scheme, needed, time
    )
    now = initial_progress(plan, _front(motion), motion.free_energy)
    glance = 1 + int(_BETWEEN_REPORTS / (stages * max(n, SHORTEST)))
    go = advance_damped if damped else advance if method == "RKN86" else advance_split
    t = 0.0
    with progress() as display:
        while t < end:
            display(t / end)
            t, _ = go(chain, beads, plan, recorder.store, now, glance)
            if t < end:
                check_steps(method, int(now["tries"]), most, t, end)
            if t == end or now["stored"] == len(recorder.store[0]):
                now["stored"] = recorder.take(int(now["stored"]))
    accelerating = motion.masses[0] * (beads.v[0] ** 2 - motion.start[n] ** 2) / 2
    work = now["work"] + accelerating if motion.scene.drive else 0.0
    state = np.concatenate((beads.y[:n], beads.v[:n], (now["lost"], work)))
    run = finished(
        motion,
        state,
        {"time": time} | recorded(motion, needed, recorder.y, recorder.v),
        steps=int(now["steps"]),
        bead_evaluations=int(now["evaluations"]),
        path=recorder.path(),
    )
    return run, float(now["response"])


def _scheme(motion: Motion, method: str) -> Tableau | Scheme:
    """Return the coefficients of a method for the contacts of a scene."""
    if motion.scene.damping is not None:
        return scheme_of(motion.contact)
    return _tableau(method, motion.k if motion.contact.law is None else math.inf)


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
    """Return the integration plan, and the greatest number of steps."""
    scheme, scales, end = SCHEMES[method], motion.scales, float(motion.scene.duration)
    longest, drive, stops = (
        math.inf if step is None else positive(step, "step"),
        motion.scene.drive,
        [end],
    )
    if drive is not None:
        # Beside a wall no motion has an error that would bound the step, and the work's estimate
        # does not see the quintic's error, h^6, at a kink: 1/8 left 11 rtol in the work, 1/16 one.
        longest = min(longest, drive.longest_step / (16 if motion.size == 1 else 1))
        stops += [t for t in (drive.ramp, *drive.time) if 0 < t < end]
    if isinstance(scheme, Pair):
        most = step_limit(motion.scene, method, end / min(scales.time, longest))
        h = min(_FIRST * rtol ** (1 / 7) * scales.time, longest, end / 100)
    else:
        natural = min((rtol / _KINKS) ** 0.4, _COARSEST) * scheme.stages
        mean = natural * min(scales.time, end) if step is None else longest
        most = step_limit(motion.scene, method, end / mean)
        h = end / math.ceil(end / mean)
    check_memory(motion.scene, method, 16)
    plan = Plan(
        scheme=_scheme(motion, method),
        y=rtol * scales.displacement,
        v=rtol * scales.velocity,
        energy=rtol * (scales.energy or 1.0),
        h=h,
        longest=longest,
        end=end,
        deepest=scales.compression,
        quickest=motion.stiffnesses.max(initial=0.0) / motion.masses.min(),
        size=motion.size,
        stops=np.unique(stops),
        accelerated=motion.loaded or drive is not None,
    )
    return plan, most


def _chain(motion: Motion) -> Chain:
    """Build the kernel's chain, padded by beads of infinite mass; the first of them is the wall."""
    inverse, A, c, rest, load = rows = np.zeros((5, motion.size + 2 * SHORTEST))
    given = 1 / motion.masses, motion.stiffnesses, motion.damping, motion.rest, motion.load
    for row, values in zip(rows, given, strict=True):
        row[: len(values)] = values
    drive, law = motion.scene.drive, motion.contact
    driven = Drive(np.zeros(1), np.zeros((1, 4)), 0.0, 0.0, 0.0, False)
    if drive is not None:
        inverse[0] = 0.0
        amplitude, w = drive.oscillation
        driven = Drive(*drive.cubics, float(amplitude), w, float(drive.ramp), True)
    kind: dict[str, Any] = dict(generated=law.law is not None, pulls=law.pulls, **law.addresses)
    power = law.damping_power or 0.0
    # An integer would be another signature, for which numba compiles the engine again.
    return Chain(inverse, A, c, rest, load, float(motion.k), **kind, p=float(power), drive=driven)


def _front(motion: Motion) -> int:
    """Return the number of the first bead at rest, plus a margin."""
    y, v = np.abs(motion.start[: 2 * motion.size].reshape(2, motion.size))
    moving = np.flatnonzero((y > _NOISE * y.max()) | (v > _NOISE * v.max()))
    first = max([-1, *moving[-1:]] if motion.scene.drive is None else [0, *moving[-1:]]) + 1
    return min(motion.size, MARGIN + int(first))


def _start(motion: Motion, padded: int, stages: int) -> Beads:
    """Build the kernel's initial state, arrays with room for ``padded`` + 1 beads."""
    n = motion.size
    y, v, next_y, next_v = np.zeros((4, padded + 1))
    y[:n], v[:n] = motion.start[:n], motion.start[n : 2 * n]
    sums, contacts = np.zeros((6, padded + 1)), np.zeros((3, padded + 1))
    force, power, given = np.zeros((stages, padded + 1)), np.zeros((2, stages)), np.zeros(4)
    if motion.scene.drive is not None:
        given[0] = motion.scene.drive.at(0.0)[2]
    return Beads(y, v, next_y, next_v, force, sums, contacts, power, given)
