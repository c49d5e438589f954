"""The loops of the compiled engine; `validation.lattice.engine` says what they do and why.

Those over all beads hold no branch, and contiguous arrays, so that they vectorise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from lwa.compact.numeric import Array

MARGIN = 4  # still beads that the window holds at its front
SHORTEST = 32  # beads below which the vector loops take no less time
BLOCK = 8  # what the window's length is a multiple of: the doubles of the widest vector register
_OPEN = 1e-3  # of the peak force: what a contact behind may push and count as open
_BLOW = 0.05  # of a bead's peak momentum: what the next may still get from a bead left behind
_LONGEST = 4  # reaches: further behind, beads are left in any case, to bound the cost
_STILL = 1e-13  # of the peak compression: beads that have moved less are still
_NOTHING = 1e-60  # of the greatest compression: open, lest the front decay into denormal numbers


class Chain(NamedTuple):
    """Inverse masses; contacts' stiffnesses, rest compressions and loads; their law, and k."""

    inverse: Array
    A: Array
    rest: Array
    load: Array
    law: int
    k: float


class Beads(NamedTuple):
    """y and v; the force on each bead from behind, less its load; when beads were left behind."""

    y: Array
    v: Array
    force: Array
    left: Array


class Samples(NamedTuple):
    """Times; the watched beads, their y, v and y'' before a step (3, W), and y and v (W, S)."""

    time: Array
    watched: NDArray[np.int_]
    before: Array
    y: Array
    v: Array


class Plan(NamedTuple):
    """A splitting, its first step, and what it moves: ``size`` beads, or a window of them.

    deepest : the greatest compression. stiffest : of the contacts. heaviest : but for the striker.
    reach : of the window, 0 without. adapt : whether the step grows as the pulse decays.
    """

    kicks: Array
    drifts: Array
    h: float
    end: float
    deepest: float
    stiffest: float
    heaviest: float
    size: int
    reach: int
    adapt: bool


_COUNTS = ("steps", "evaluations", "front", "mark", "lo", "done", "begin", "stop", "legs", "count")
_REALS = ("t", "base", "h", "scale", "top", "peak", "lost", "decay")
_PLACE = np.dtype([(name, int) for name in _COUNTS] + [(name, float) for name in _REALS])


def beginning(plan: Plan, k: float, front: int) -> Any:
    """Where `advance` is, to begin with: a record that it changes.

    steps, evaluations : their numbers; evaluations times the beads that each one moves.
    front, mark, lo : the first bead that is still, that of one reach ago, the rear.
    done : samples that are taken. begin, stop : watched beads that are followed.
    legs : reaches passed. count : of steps of the present length h, from base on.
    t : the time. scale : the compression that the step is made for.
    top, peak : the greatest force in this reach, and in the last.
    lost : energy of the contacts that were cut. decay : the smallest ratio of two such peaks.
    """
    at = np.zeros(1, _PLACE)[0]
    at["front"] = at["mark"] = front
    at["h"], at["scale"], at["decay"] = plan.h, plan.deepest, 1.0
    at["peak"] = plan.stiffest * plan.deepest**k
    return at


_Function = TypeVar("_Function", bound=Callable[..., Any])
# Without "reassoc" rounding does not depend on the order of a sum; in numba's own error model
# every division by zero would be an exception's way out.
_OPTIONS: Any = dict(fastmath={"nnan", "ninf", "nsz", "arcp", "contract"}, error_model="numpy")
_compiled: Callable[[_Function], _Function] = njit(cache=True, **_OPTIONS)
# Written out where it is called: to pass the arrays would take as long as the rest.
_part: Callable[[_Function], _Function] = njit(inline="always", **_OPTIONS)


@_compiled
def _step(chain: Chain, beads: Beads, plan: Plan, h: float, lo: int, hi: int) -> None:
    """One step of the beads lo … hi-1."""
    size, law, k, nothing = hi - lo, chain.law, chain.k, _NOTHING * plan.deepest
    y, v, here, inverse = beads.y[lo:hi], beads.v[lo:hi], beads.force[lo:hi], chain.inverse[lo:hi]
    next_y, ahead = beads.y[lo + 1 : hi + 1], beads.force[lo + 1 : hi + 1]
    A, rest, load = chain.A[lo:hi], chain.rest[lo:hi], chain.load[lo:hi]
    kicks, drifts = plan.kicks, plan.drifts
    for s in range(len(drifts)):
        if s == 0:
            pass  # the forces of the last stage, which a first kick of 0 does not ask for
        elif law == 3:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * (d * np.sqrt(d)) - load[i]
        elif law == 1:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * d - load[i]
        elif law == 2:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * (d * np.sqrt(np.sqrt(d))) - load[i]
        elif law == 4:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * (d * d) - load[i]
        elif law == 5:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * (d * d * d) - load[i]
        else:
            for i in range(size):
                d = rest[i] + y[i] - next_y[i]
                d = d if d > nothing else 0.0
                ahead[i] = A[i] * d**k - load[i]
        b, a = h * kicks[s], h * drifts[s]
        for i in range(size):
            u = v[i] + b * (here[i] - ahead[i]) * inverse[i]
            v[i] = u
            y[i] = y[i] + a * u


@_compiled
def _net(chain: Chain, y: Array, i: int) -> float:
    """The force of contact i, less its load."""
    d = chain.rest[i] + y[i] - y[i + 1]
    return float((chain.A[i] * d**chain.k if d > 0.0 else 0.0) - chain.load[i])


@_compiled
def _acceleration(chain: Chain, y: Array, i: int, lo: int) -> float:
    """Of bead i, where lo is the first that is followed."""
    back = _net(chain, y, i - 1) if i > lo else 0.0
    return float((back - _net(chain, y, i)) * chain.inverse[i])


@_part
def _sample(chain: Chain, beads: Beads, seen: Samples, at: Any, h: float, due: int) -> None:
    """The samples within a step: of the quintic with y, y' and y'' of both ends."""
    y, v, before, time, seen_y, seen_v = beads.y, beads.v, seen.before, seen.time, seen.y, seen.v
    for q in range(at.begin, at.stop):
        j = seen.watched[q]
        c0, c1, c2 = before[0, q], h * before[1, q], h * h * before[2, q] / 2
        r0 = y[j] - c0 - c1 - c2
        r1 = h * v[j] - c1 - 2 * c2
        r2 = h * h * _acceleration(chain, y, j, at.lo) - 2 * c2
        c3 = 10 * r0 - 4 * r1 + r2 / 2
        c4 = -15 * r0 + 7 * r1 - r2
        c5 = 6 * r0 - 3 * r1 + r2 / 2
        for s in range(at.done, due):
            x = (time[s] - at.t) / h
            seen_y[q, s] = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))))
            slope = c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))
            seen_v[q, s] = slope / h
    at.done = due


@_compiled
def _grow_step(chain: Chain, plan: Plan, at: Any) -> None:
    """A reach further on: how high is the pulse, and the step that goes with it."""
    at.legs += 1
    if at.legs > 2 and at.peak > 0.0:  # the first may hold the striker's blow
        at.decay = min(at.decay, at.top / at.peak)
    at.peak, at.top, at.mark = at.top, 0.0, at.front
    now = min(plan.deepest, (at.peak / plan.stiffest) ** (1 / chain.k))
    if plan.adapt and now > 0.0 and abs(now - at.scale) > 0.07 * at.scale:
        at.scale, at.base, at.count = now, at.t, 0
        at.h = plan.h * (plan.deepest / now) ** ((chain.k - 1) / 2)


@_part
def _cut_rear(chain: Chain, beads: Beads, plan: Plan, at: Any) -> None:
    """Leave beads behind that are further than the reach, and have no say in the pulse."""
    y, v, inverse, k = beads.y, beads.v, chain.inverse, chain.k
    while at.front - at.lo > plan.reach:
        lo = at.lo
        momentum = math.sqrt(plan.heaviest * at.peak * (at.peak / plan.stiffest) ** (1 / k))
        force = _net(chain, y, lo)
        blow = (v[lo] - v[lo + 1]) / (inverse[lo] + inverse[lo + 1])
        near = at.front - lo <= _LONGEST * plan.reach
        if near and (force > _OPEN * at.peak or blow > _BLOW * momentum):
            break
        at.lost += max(force, 0.0) * max(y[lo] - y[lo + 1], 0.0) / (k + 1)
        beads.left[lo] = at.t
        at.lo = lo + 1
        beads.force[lo + 1] = 0.0


@_compiled
def advance(chain: Chain, beads: Beads, plan: Plan, seen: Samples, at: Any, steps: int) -> float:
    """Integrate on from where the beads are, to the end or by so many steps; the time there.

    Beads that are left behind stay as they were then.
    """
    until = at.steps + steps
    if at.steps == 0:
        for i in range(plan.size):
            beads.force[i + 1] = _net(chain, beads.y, i)
    time, watched, stages = seen.time, seen.watched, len(plan.drifts) - 1
    while at.t < plan.end and at.steps < until:
        hi = at.lo + max(SHORTEST, -(-(at.front - at.lo) // BLOCK) * BLOCK)
        while at.stop < len(watched) and watched[at.stop] < hi:
            at.stop += 1
        while at.begin < at.stop and watched[at.begin] < at.lo:
            at.begin += 1
        at.count += 1
        later, h = at.base + at.count * at.h, at.h
        if later > plan.end - 1e-9 * h:
            later, h = plan.end, plan.end - at.t
        due = at.done
        while due < len(time) and time[due] <= later:
            due += 1
        if due > at.done:
            for q in range(at.begin, at.stop):
                j = watched[q]
                seen.before[0, q], seen.before[1, q] = beads.y[j], beads.v[j]
                seen.before[2, q] = _acceleration(chain, beads.y, j, at.lo)
        _step(chain, beads, plan, h, at.lo, hi)
        at.steps += 1
        at.evaluations += stages * (hi - at.lo)
        if due > at.done:
            _sample(chain, beads, seen, at, h, due)
        at.t = later
        if plan.reach:
            if at.steps % 4 == 0:
                top = at.top
                for i in range(at.lo, hi):
                    top = max(top, beads.force[i + 1])
                at.top = top
            while at.front < plan.size and abs(beads.y[at.front - MARGIN]) > _STILL * at.scale:
                at.front += 1
            if at.front - at.mark >= plan.reach:
                _grow_step(chain, plan, at)
            _cut_rear(chain, beads, plan, at)
    return float(at.t)
