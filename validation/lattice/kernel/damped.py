"""Steps of a chain with damped contacts, by an explicit Runge–Kutta pair of order 8.

The pair (Dormand and Prince's, `scipy.integrate.DOP853`) is written for y'' = f(t, y, y'): stage s
moves a bead by h x^q v + h² Σ_j a_sj f_j and changes its velocity by h Σ_j b_sj f_j, so that only
the forces f_j of the contacts are stored. Within a step time runs as t + h x^q with q = 1, or with
a greater q in the step after a contact has closed: there its force begins like (x^q)^p with a
broken exponent p, and the motion is smooth in x.

A step ends where a damped contact opens or closes (`validation.lattice.kernel.contacts`). It is
accepted if the error at its end, and the error of the interpolant at the watched beads, are small.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.kernel.advance import cut, follow, moving
from validation.lattice.kernel.arrays import Beads, Chain, Plan
from validation.lattice.kernel.compiled import ONE, SOURCES, TWO, ZERO, cached, index, part
from validation.lattice.kernel.contacts import damped_forces, first_change, settle, stored
from validation.lattice.kernel.force import drive_motion, interval
from validation.lattice.kernel.pair import squared_error

STEP, DENSE = 12, 16  # stages of a step, and with those of its interpolant
WIDTH = 6  # stages that are added up at a time
# Greatest difference of the interpolants of degree 7 and 6, in units of the tolerance. In steps of
# 2 to 4.5 decay times of a light bead the interpolant of degree 7 erred by 1/13 of it and less.
_ALLOWED = 50.0


class Scheme(NamedTuple):
    """Coefficients of the pair for q = 1, and in a second row for the q after a contact closes.

    times : (2, stages), x^q. rows : (2, stages, 2, columns), a and b. errors : (2, 3, 2, columns),
    those of the two embedded solutions, of displacement and velocity, and the greatest difference
    of the interpolants of degree 7 and 6. power : q.
    """

    times: Array
    rows: Array
    errors: Array
    power: int


class Steps(NamedTuple):
    """The motion of W watched beads in up to C steps.

    step : (C, 4), beginning, length, 0 or 1 for the row of `Scheme`, and end, which is not quite
    the sum of the first two. start : (C, W, 2), displacement and velocity. force : (C, W, `DENSE`),
    of the contacts behind the beads, by stage. watched : (W,), increasing numbers of the beads.
    """

    step: Array
    start: Array
    force: Array
    watched: NDArray[np.int_]


@part
def _add_up(
    beads: Beads, q: Any, rows: Array, a: float, b: float, stages: int, lo: int, hi: int
) -> None:
    """Compute two weighted sums of forces, sums[q] = a Σ rows[0, j] f_j, sums[q + 1] likewise."""
    force, sums = beads.force, beads.sums
    p = q + ONE
    for first in range(0, stages, WIDTH):
        a0, a1, a2 = a * rows[0, first], a * rows[0, first + 1], a * rows[0, first + 2]
        a3, a4, a5 = a * rows[0, first + 3], a * rows[0, first + 4], a * rows[0, first + 5]
        b0, b1, b2 = b * rows[1, first], b * rows[1, first + 1], b * rows[1, first + 2]
        b3, b4, b5 = b * rows[1, first + 3], b * rows[1, first + 4], b * rows[1, first + 5]
        j = index(first)
        j1, j2, j3, j4, j5 = j + ONE, j + index(2), j + index(3), j + index(4), j + index(5)
        for i in range(index(lo) + ONE, index(hi) + ONE):
            f0, f1, f2 = force[j, i], force[j1, i], force[j2, i]
            f3, f4, f5 = force[j3, i], force[j4, i], force[j5, i]
            one = a0 * f0 + a1 * f1 + a2 * f2 + a3 * f3 + a4 * f4 + a5 * f5
            two = b0 * f0 + b1 * f1 + b2 * f2 + b3 * f3 + b4 * f4 + b5 * f5
            sums[q, i] = one if first == 0 else sums[q, i] + one
            sums[p, i] = two if first == 0 else sums[p, i] + two


@part
def _stage(
    chain: Chain, beads: Beads, plan: Plan, now: Any, s: int, h: float, lo: int, hi: int
) -> None:
    """Move beads lo … hi-1 to stage s of a step h, and compute the forces there."""
    scheme, w = plan.scheme, now.warped
    _add_up(beads, ZERO, scheme.rows[w, s], h * h, h, s, lo, hi)
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    sums, inverse, drift = beads.sums, chain.inverse, h * scheme.times[w, s]
    for i in range(index(lo), index(hi)):
        next_y[i] = y[i] + drift * v[i] + (sums[0, i] - sums[0, i + ONE]) * inverse[i]
        next_v[i] = v[i] + (sums[1, i] - sums[1, i + ONE]) * inverse[i]
    if chain.drive.driven:
        next_y[0], next_v[0], a = drive_motion(chain.drive, now.interval, now.t + drift)
        beads.given[1] = a if s == STEP else beads.given[1]
    damped_forces(chain, beads, plan, s, h, lo, hi)


@part
def _error(chain: Chain, beads: Beads, plan: Plan, w: int, h: float, hi: int) -> float:
    """Return the error of a step in units of the tolerance, from both embedded solutions."""
    squares = (0.0, 0.0)
    for m in range(2):
        rows = plan.scheme.errors[w, m]
        _add_up(beads, TWO, rows, h * h / plan.y, h / plan.v, STEP, 0, hi)
        total = squared_error(beads.sums, chain.inverse, hi)
        for q in range(2):
            energy = 0.0
            for s in range(STEP):
                energy += rows[1, s] * beads.power[q, s]
            total += (h * energy / plan.energy) ** 2
        squares = (total, squares[0])
    fifth, third = squares
    # Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.10. It takes smooth
    # forces; where a contact closes, the lower order alone is safe: forces of contacts that are
    # closed by the motion behind it rise like broken powers of x.
    if w > 0 or fifth == 0.0:
        return math.sqrt(fifth)
    return fifth / math.sqrt(fifth + 0.01 * third)


@part
def _interpolated(
    chain: Chain, beads: Beads, plan: Plan, watched: Any, now: Any, h: float, hi: int
) -> float:
    """Compute the interpolant's stages; return its error from the first watched bead to the last.

    The step's own estimate does not bound the error between the step's ends: for a bead that is
    slowed down within the step, the estimate has zeros as a function of the step. The error is
    judged by the difference of the interpolants of degree 7 and 6, in units of `_ALLOWED`
    tolerances.
    """
    first, last, more = watched[0], watched[-1], DENSE - STEP
    for s in range(STEP + 1, DENSE):  # each stage needs the forces on one bead more than the next
        _stage(chain, beads, plan, now, s, h, max(0, first - more), min(hi, last + more))
    rows, size = plan.scheme.errors[now.warped, 2], max(0, min(hi, last) - first)
    _add_up(beads, TWO, rows, h * h / plan.y, h / plan.v, DENSE, first, first + size)
    return math.sqrt(squared_error(beads.sums[:, first:], chain.inverse[first:], size)) / _ALLOWED


@part
def _accept(chain: Chain, beads: Beads, plan: Plan, now: Any, h: float, hi: int) -> None:
    """Move the beads to the end of a step, and add up its work and dissipated energy."""
    y, next_y = beads.y, beads.sums[4]
    beads.given[0] = beads.given[1]
    for i in range(hi):
        if beads.contacts[0, i] < 0.5:  # an open contact turns what it still stores into heat
            now.lost += stored(chain, i, chain.rest[i] + y[i] - y[i + 1])
            now.lost -= stored(chain, i, chain.rest[i] + next_y[i] - next_y[i + 1])
    for i in range(index(hi)):
        y[i], beads.v[i] = next_y[i], beads.sums[5, i]
    for s in range(STEP):
        weight = h * plan.scheme.rows[now.warped, STEP, 1, s]
        now.lost += weight * beads.power[0, s]
        now.work += weight * beads.power[1, s]


@part
def _store(beads: Beads, steps: Steps, now: Any, h: float, end: float) -> None:
    """Store a step at the watched beads."""
    step = steps.step[now.stored]
    step[0], step[1], step[2], step[3] = now.t, h, now.warped, end
    for q in range(len(steps.watched)):
        j = steps.watched[q]
        steps.start[now.stored, q, 0], steps.start[now.stored, q, 1] = beads.y[j], beads.v[j]
        for s in range(DENSE):
            steps.force[now.stored, q, s] = beads.force[s, j]
    now.stored += 1


@part
def _begin(chain: Chain, beads: Beads, plan: Plan, now: Any, hi: int) -> None:
    """Settle the contacts, and compute the forces at the beginning of a step.

    A contact that closes at the end of a step that was cut, or at the start, matters. Its first
    step is as long as the last step of this kind could have been: without this bound two trials of
    three were rejected.
    """
    closing = settle(chain, beads, plan, hi) and (now.planned > 0.0 or now.tries == 0)
    now.warped = 1 if closing and plan.scheme.power > 1 else 0
    now.planned = 0.0
    if now.warped > 0:
        now.h = min(now.h, now.restart)
    for i in range(index(hi)):
        beads.next_y[i], beads.next_v[i] = beads.y[i], beads.v[i]
    damped_forces(chain, beads, plan, 0, 0.0, 0, hi)


def _built(sources: int) -> Any:
    """Compile `advance_damped`; its cache is for source code with the hash ``sources``."""

    @cached
    def advance_damped(
        chain: Chain, beads: Beads, plan: Plan, steps: Steps, now: Any, tries: int
    ) -> tuple[float, int]:
        """Integrate to the end, or for at most ``tries`` tried steps, or until ``steps`` are full.

        Returns the time that is reached, and ``sources``.
        """
        until, watching = now.tries + tries, len(steps.watched) > 0
        if now.tries == 0:
            _begin(chain, beads, plan, now, plan.size)
        while now.t < plan.end and now.tries < until and now.stored < len(steps.step):
            hi = moving(now)
            now.tries += 1
            now.evaluations += STEP * hi
            h, later = cut(plan, now)
            now.interval = interval(chain.drive, now.t + h / 2)
            for i in range(index(hi)):
                beads.contacts[1, i], beads.contacts[2, i] = 0.0, 0.0
            for s in range(1, STEP + 1):
                _stage(chain, beads, plan, now, s, h, 0, hi)
            error = _error(chain, beads, plan, now.warped, h, hi)
            place = first_change(chain, beads, plan, h, STEP, hi)
            for i in range(index(hi) + ONE):  # the interpolant's stages use `next_y` and `next_v`
                beads.sums[4, i], beads.sums[5, i] = beads.next_y[i], beads.next_v[i]
            if watching and error <= 1.0 and place == 1.0:
                error = max(error, _interpolated(chain, beads, plan, steps.watched, now, h, hi))
            # An error is O(x^8), or O(x^6) by the lower order, and x = t^{1/q}.
            q, order = (plan.scheme.power, 6) if now.warped > 0 else (1, 8)
            grow = 0.9 * max(error, 1e-9) ** (-q / order)
            if not error <= 1.0 or place < 1.0:
                shrink = 1.0 if error <= 1.0 else max(0.1, grow if error < 1e9 else 0.0)
                now.planned = max(now.planned, h) if error <= 1.0 else h * shrink
                # The force of a contact that should be open may be all of the error. So the change
                # comes first, if the step to it is clearly shorter.
                first = place < 0.9 and error < 1e9
                now.h = h * (place if first else min(shrink, place))
                if not error < 1e9:
                    beads.force[1:] = 0.0  # overflows must not last
                continue
            if watching:
                _store(beads, steps, now, h, later)
            _accept(chain, beads, plan, now, h, hi)
            now.response = max(now.response, now.energy + now.work - now.lost)
            now.steps += 1
            now.t = later
            now.stop += 1 if later == plan.stops[now.stop] else 0
            if now.warped > 0:
                now.restart = h * grow
            # At the end of a step dt/dx = q h, which is the natural step in time from there on.
            now.h = min(plan.longest, max(h * q * min(5.0, grow), now.planned))
            follow(beads, plan, now)
            _begin(chain, beads, plan, now, hi)
        return now.t, sources

    return advance_damped


advance_damped = _built(SOURCES)
