"""The loops of the compiled engine; `validation.lattice.engine` says what they do and why.

All loops over beads are without a branch, and over contiguous arrays, so that they vectorise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit

from validation.lattice.equations import Array

_Function = TypeVar("_Function", bound=Callable[..., Any])

MARGIN = 4
"""Still beads that the window holds at its front."""
SHORTEST = 32
"""Beads below which the vector loops take no less time."""
_OPEN = 1e-3
"""Of the peak force: what a contact behind may push and count as open."""
_BLOW = 0.05
"""Of a bead's peak momentum: what the next one may still get from a bead that is left behind."""
_LONGEST = 4
"""Reaches: further behind, beads are left whatever they do, so that the cost stays bounded."""
_STILL = 1e-13
"""Of the peak compression: beads that have moved less are still."""
_NOTHING = 1e-60
"""Of the greatest compression: what counts as open, lest the front decay into denormal numbers."""
BLOCK = 8
"""What the window's length is a multiple of: the doubles of the widest vector register."""


def _compiled(function: _Function) -> _Function:
    """By numba; no flag that would let rounding depend on the order of a sum (reassoc)."""
    flags = {"nnan", "ninf", "nsz", "arcp", "contract"}
    return cast(_Function, njit(cache=True, fastmath=flags)(function))


@_compiled
def _step(
    y: Array, v: Array, inverse: Array, A: Array, rest: Array, load: Array, f: Array,
    law: int, k: float, kicks: Array, drifts: Array, h: float, nothing: float, lo: int, hi: int,
) -> None:  # fmt: skip
    """One step of the beads lo … hi-1; f[i] is the force on bead i from behind, less its load."""
    size = hi - lo
    yw, vw, iw, here, ahead = y[lo:hi], v[lo:hi], inverse[lo:hi], f[lo:hi], f[lo + 1 : hi + 1]
    yn, Aw, rw, lw = y[lo + 1 : hi + 1], A[lo:hi], rest[lo:hi], load[lo:hi]
    for s in range(len(drifts)):
        if s == 0:
            pass  # the forces of the last stage, which a first kick of 0 does not ask for
        elif law == 3:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                d = d if d > nothing else 0.0
                ahead[i] = Aw[i] * (d * np.sqrt(d)) - lw[i]
        elif law == 1:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                ahead[i] = Aw[i] * (d if d > nothing else 0.0) - lw[i]
        elif law == 2:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                d = d if d > nothing else 0.0
                ahead[i] = Aw[i] * (d * np.sqrt(np.sqrt(d))) - lw[i]
        elif law == 4:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                d = d if d > nothing else 0.0
                ahead[i] = Aw[i] * (d * d) - lw[i]
        elif law == 5:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                d = d if d > nothing else 0.0
                ahead[i] = Aw[i] * (d * d * d) - lw[i]
        else:
            for i in range(size):
                d = rw[i] + yw[i] - yn[i]
                d = d if d > nothing else 0.0
                ahead[i] = Aw[i] * d**k - lw[i]
        b, a = h * kicks[s], h * drifts[s]
        for i in range(size):
            u = vw[i] + b * (here[i] - ahead[i]) * iw[i]
            vw[i] = u
            yw[i] = yw[i] + a * u


@_compiled
def _net(y: Array, A: Array, rest: Array, load: Array, k: float, i: int) -> float:
    """The force of contact i, less its load."""
    d = rest[i] + y[i] - y[i + 1]
    force: float = (A[i] * d**k if d > 0.0 else 0.0) - load[i]
    return force


Counts = tuple[int, int, int, int, int, int, int, int, int, int]
Reals = tuple[float, float, float, float, float, float, float, float]
At = tuple[Counts, Reals]
"""Where `advance` is: numbers of steps and bead evaluations, the front, where it was one reach ago,
the rear, the samples that are taken, the watched beads that are followed (from, to), the reaches
passed, the steps of the present length; time, that from which the steps have this length, their
length, the compression that it is made for, the peak force of this reach and the last, the energy
of the contacts that were cut, and the smallest ratio of two such peaks."""


def beginning(front: int, h: float, stiffest: float, deepest: float, k: float) -> At:
    """Where `advance` begins."""
    return (0, 0, front, front, 0, 0, 0, 0, 0, 0), (
        0.0, 0.0, h, deepest, 0.0, stiffest * deepest**k, 0.0, 1.0
    )  # fmt: skip


@_compiled
def advance(
    y: Array, v: Array, inverse: Array, A: Array, rest: Array, load: Array, law: int, k: float,
    kicks: Array, drifts: Array, first_h: float, end: float, deepest: float, adapt: bool,
    n: int, reach: int, whole: bool, times: Array, watched: Array,
    seen_y: Array, seen_v: Array, left: Array, f: Array, at: At, until: int,
) -> At:  # fmt: skip
    """Integrate y and v on from where they are, to the end or to the step ``until``.

    Fills the watched beads' samples while they are followed, and ``left`` with the times at which
    beads were left behind; their y and v stay as they were then.
    """
    counts, reals = at
    steps, evaluations, front, mark, lo, done, begin, stop, legs, count = counts
    t, base, h, scale, top, peak, lost, decay = reals
    if steps == 0:
        for i in range(n):
            f[i + 1] = _net(y, A, rest, load, k, i)
    stiffest, heaviest = A.max(), 1 / inverse[min(1, n - 1) : n].min()  # not the striker
    old, nothing = np.zeros((3, len(watched))), _NOTHING * deepest
    while t < end and steps < until:
        hi = n if whole else front
        hi = lo + max(SHORTEST, -(-(hi - lo) // BLOCK) * BLOCK)
        while stop < len(watched) and watched[stop] < hi:
            stop += 1
        count += 1
        later, dt = base + count * h, h
        if later > end - 1e-9 * h:
            later, dt = end, end - t
        due = done
        while due < len(times) and times[due] <= later:
            due += 1
        if due > done:
            for q in range(begin, stop):
                j = watched[q]
                back = _net(y, A, rest, load, k, j - 1) if j > lo else 0.0
                old[0, q], old[1, q] = y[j], v[j]
                old[2, q] = (back - _net(y, A, rest, load, k, j)) * inverse[j]
        _step(y, v, inverse, A, rest, load, f, law, k, kicks, drifts, dt, nothing, lo, hi)
        steps += 1
        evaluations += (len(drifts) - 1) * (hi - lo)
        if due > done:
            for q in range(begin, stop):
                # The quintic with the positions, velocities and accelerations of both ends.
                j = watched[q]
                back = _net(y, A, rest, load, k, j - 1) if j > lo else 0.0
                acceleration = (back - _net(y, A, rest, load, k, j)) * inverse[j]
                c0, c1, c2 = old[0, q], dt * old[1, q], dt * dt * old[2, q] / 2
                r0 = y[j] - c0 - c1 - c2
                r1 = dt * v[j] - c1 - 2 * c2
                r2 = dt * dt * acceleration - 2 * c2
                c3 = 10 * r0 - 4 * r1 + r2 / 2
                c4 = -15 * r0 + 7 * r1 - r2
                c5 = 6 * r0 - 3 * r1 + r2 / 2
                for s in range(done, due):
                    x = (times[s] - t) / dt
                    seen_y[q, s] = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))))
                    slope = c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))
                    seen_v[q, s] = slope / dt
            done = due
        t = later
        if not adapt and whole:
            continue
        if steps % 4 == 0:
            for i in range(lo, hi):
                top = max(top, f[i + 1])
        while front < n and abs(y[front - MARGIN]) > _STILL * scale:
            front += 1
        if front - mark >= reach:
            # The pulse has advanced by the window's reach: how high was it?
            legs += 1
            if legs > 2 and peak > 0.0:  # the first may hold the striker's blow
                decay = min(decay, top / peak)
            peak, top, mark = top, 0.0, front
            now = min(deepest, (peak / stiffest) ** (1 / k))
            if adapt and now > 0.0 and abs(now - scale) > 0.07 * scale:
                scale = now
                h, base, count = first_h * (deepest / scale) ** ((k - 1) / 2), t, 0
        momentum = math.sqrt(heaviest * peak * (peak / stiffest) ** (1 / k))
        while not whole and front - lo > reach:
            force = _net(y, A, rest, load, k, lo)
            blow = (v[lo] - v[lo + 1]) / (inverse[lo] + inverse[lo + 1])
            if front - lo <= _LONGEST * reach and (force > _OPEN * peak or blow > _BLOW * momentum):
                break
            lost += max(force, 0.0) * max(y[lo] - y[lo + 1], 0.0) / (k + 1)
            left[lo] = t
            lo += 1
            f[lo] = 0.0
        while begin < stop and watched[begin] < lo:
            begin += 1
    counts = steps, evaluations, front, mark, lo, done, begin, stop, legs, count
    return counts, (t, base, h, scale, top, peak, lost, decay)
