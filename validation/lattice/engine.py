"""The compiled engine: embedded pairs in Nyström form and a symplectic splitting.

Numba compiles the loops once and keeps them on disk. A run is the same to the last bit every time.

Pair: two solutions of y'' = f(y), or of y'' = f(y, y') for damped contacts, with adaptive steps h
(`validation.lattice.schemes`). The error of a step is the root of the sum over all beads of the
squared errors, in the scene's scales of displacement and velocity; ``rtol`` bounds this error.
F = A δ^k with k = 3/2 has no second derivative at a kink, the time at which a contact opens or
closes, and a step across a kink would err by O(h^{k+1}). So the force of such a contact is
integrated by a quadrature that knows the kink (`validation.lattice.kernel.kinks`).

Splitting: symplectic, with a fixed step. Every kink leaves an error of O(h^{k+1}), which sets the
step.

Drive: a first bead of infinite mass with a given motion. Steps end at the end of a ramp and at the
knots of a file.

Front: beads ahead of the front have not moved yet and are left out.

Tiles: all stages of a step are computed for some hundred beads before the next beads are looked at,
so that what a stage reads is still in the processor's cache.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.cost import (
    IntegrationError,
    RunProgress,
    check_memory,
    step_limit,
)
from validation.lattice.equations import Motion
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.arrays import (
    MARGIN,
    SHORTEST,
    WIDTH,
    Beads,
    Chain,
    Drive,
    Law,
    Pair,
    Plan,
    initial_progress,
)
from validation.lattice.kernel.kinks import POINTS
from validation.lattice.kernel.symplectic import advance_split
from validation.lattice.knots import Recorder
from validation.lattice.laws import Contact
from validation.lattice.result import Run, finished
from validation.lattice.schemes import SCHEMES, VERNER65
from validation.lattice.signal import recorded, sampled

_WEAK = (
    0.1  # least energy of the response in units of the energy that sets the tolerance
)
_NOISE = (
    sys.float_info.epsilon
)  # in units of the greatest value: a bead that moves less is still
_BETWEEN_REPORTS = (
    5e7  # bead evaluations between two reports of progress: some tenths of a second
)
# The splitting's step per stage is (rtol/0.01)^0.4 in units of the scene's shortest time, measured
# on a Hertz dimer of 560 beads; at 0.2 it is still stable.
_KINKS, _COARSEST = 0.01, 0.2
_FIRST = (
    4.0  # first step of a pair over rtol^(1/7), in units of the scene's shortest time
)


def integrate(
    motion: Motion, method: str, rtol: float, longest: float, progress: RunProgress
) -> Run:
    """Integrate a scene by a method of `SCHEMES`, in steps of at most ``longest``.

    A splitting's steps have this length, unless it is infinite. A run whose tolerance is set by a
    drive, and whose response turns out far weaker, is made again.
    """
    while True:
        run, response = _integrated(motion, method, rtol, longest, progress)
        least = 8 * _NOISE * motion.scales.energy  # rounding of the energy
        if not least < response < _WEAK * motion.scales.energy:
            return run
        motion = Motion(motion.scene, response)


def _integrated(
    motion: Motion, method: str, rtol: float, longest: float, progress: RunProgress
) -> tuple[Run, float]:
    """Return a run, and the greatest energy of its contacts and free beads."""
    plan, most = _plan(motion, method, rtol, longest)
    n, end = motion.size, motion.scene.duration
    chain = _chain(motion)
    beads = _start(motion, len(chain.A))
    time, needed = sampled(motion)
    recorder = Recorder(motion, chain, needed, time)
    now = initial_progress(plan, _front(motion), motion.free_energy)
    glance = 1 + int(
        _BETWEEN_REPORTS / (10 * max(n, SHORTEST))
    )  # a step has some ten stages
    go = advance if isinstance(plan.scheme, Pair) else advance_split
    t = 0.0
    with progress() as display:
        while t < end:
            display(t / end)
            t, _ = go(chain, beads, plan, recorder.knots, now, glance)
            if t < end and now["tries"] > most:
                raise IntegrationError(
                    f"{now['tries']} steps of {method} reach t = {t:g} of {end:g}: rounding hides "
                    "the motion, or rtol is too small for it"
                )
            if t == end or now["stored"] == len(recorder.knots.time):
                now["stored"] = recorder.take(int(now["stored"]))
    accelerating = motion.masses[0] * (beads.v[0] ** 2 - motion.start[n] ** 2) / 2
    work = now["work"] + accelerating if motion.scene.drive else 0.0
    state = np.concatenate((beads.y[:n], beads.v[:n], (now["lost"], work)))
    run = finished(
        motion,
        state,
        {"time": time} | recorded(motion, needed, recorder.y, recorder.v),
        steps=int(now["steps"]),
        path=recorder.path(),
    )
    return run, float(now["response"])


def _plan(motion: Motion, method: str, rtol: float, longest: float) -> tuple[Plan, int]:
    """Return the integration plan, and the greatest number of steps."""
    scales, end = motion.scales, float(motion.scene.duration)
    damped = motion.scene.damping is not None
    scheme = VERNER65 if damped and method == "RKN86" else SCHEMES[method]
    drive, stops = motion.scene.drive, [end]
    if drive is not None:
        # Beside a wall no motion has an error that would bound the step, and the work's estimate
        # does not see the quintic's error, h^6, at a kink: 1/8 left 11 rtol in the work, 1/16 one.
        longest = min(longest, drive.longest_step / (16 if motion.size == 1 else 2))
        stops += [t for t in (drive.ramp, *drive.time) if 0 < t < end]
    if isinstance(scheme, Pair):
        most = step_limit(motion.scene, method, end / min(scales.time, longest))
        h = min(_FIRST * rtol ** (1 / 7) * scales.time, longest, end / 100)
    else:
        natural = min((rtol / _KINKS) ** 0.4, _COARSEST) * len(scheme.drifts)
        mean = natural * min(scales.time, end) if math.isinf(longest) else longest
        most = step_limit(motion.scene, method, end / mean)
        h = end / math.ceil(end / mean)
    check_memory(motion.scene, method, 16)
    plan = Plan(
        scheme=scheme,
        y=rtol * scales.displacement,
        v=rtol * scales.velocity,
        energy=rtol * (scales.energy or 1.0),
        h=h,
        longest=longest,
        end=end,
        deepest=scales.compression,
        lightest=float(motion.masses.min()),
        size=motion.size,
        stops=np.array(sorted({*stops}), float),
        jumps=damped and motion.contact.damping_power == 0 and not motion.contact.pulls,
    )
    return plan, most


def _chain(motion: Motion) -> Chain:
    """Build the kernel's chain, padded by beads of infinite mass; the first of them is the wall."""
    rows = _lines(5, motion.size + 2 * SHORTEST, 0)
    c, A = motion.damping, motion.stiffnesses
    given = (
        1 / motion.masses,
        A,
        np.divide(c, A, 0 * c, where=c > 0),
        motion.rest,
        motion.load,
    )
    for row, values in zip(rows, given, strict=True):
        row[: len(values)] = values
    drive, contact = motion.scene.drive, motion.contact
    driven = Drive(np.zeros(1), np.zeros((1, 4)), 0.0, 0.0, 0.0, False)
    if drive is not None:
        rows[0, 0] = 0.0
        amplitude, w = drive.oscillation
        driven = Drive(*drive.cubics, float(amplitude), w, float(drive.ramp), True)
    law = Law(
        # A whole number would be another type, for which numba compiles the engine again.
        k=float(motion.k),
        p=float(contact.damping_power or 0),
        q=_exponent(contact),
        generated=contact.law is not None,
        pulls=contact.pulls,
        **contact.addresses,
    )
    inverse, A, r, rest, load = rows
    return Chain(
        inverse, A, r, rest, load, motion.scene.damping is not None, law, driven
    )


def _exponent(law: Contact) -> float:
    """Return q such that the forces are smooth in u, δ = u^q, where a contact opens or closes.

    F is a series in powers of δ^k, δ^p and δ. For q = 4 weak singularities may be left.
    """
    powers = law.k if law.law is None else 0.25, law.damping_power or 0.0
    return next(
        (q for q in (1.0, 2.0) if all((q * power).is_integer() for power in powers)),
        4.0,
    )


def _front(motion: Motion) -> int:
    """Return the number of the first bead at rest, plus a margin."""
    y, v = np.abs(motion.start[: 2 * motion.size].reshape(2, motion.size))
    moving = np.flatnonzero((y > _NOISE * y.max()) | (v > _NOISE * v.max()))
    first = (
        max([-1, *moving[-1:]] if motion.scene.drive is None else [0, *moving[-1:]]) + 1
    )
    return min(motion.size, MARGIN + int(first))


def _start(motion: Motion, padded: int) -> Beads:
    """Build the kernel's initial state, arrays with room for ``padded`` + 1 beads."""
    n = motion.size
    rows = _lines(9 + WIDTH, padded + 1, 1)
    y, v, next_y, next_v = rows[:4]
    y[:n], v[:n] = next_y[:n], next_v[:n] = motion.start[:n], motion.start[n : 2 * n]
    power, given = np.zeros((2, WIDTH)), np.zeros(2)
    if motion.scene.drive is not None:
        given[:] = motion.scene.drive.at(0.0)[2]
    return Beads(
        y,
        v,
        next_y,
        next_v,
        rows[9:],
        rows[4:9],
        power,
        given,
        np.zeros(4),
        np.zeros((8, POINTS)),
    )


def _lines(rows: int, columns: int, first: int) -> Array:
    """Return an array of zeros, with a column ``first`` at which lines of the cache begin.

    A row has an odd number of lines, so that rows do not compete for the same places in the cache.
    """
    width = 8 * (-(-columns // 8) | 1)
    memory = np.zeros(8 + rows * width)
    start = (-memory.ctypes.data // 8 - first) % 8
    return memory[start : start + rows * width].reshape(rows, width)
