"""Interpolated motion of the watched beads within steps, between knots (the ends of steps).

Within a step a bead's displacement y is the sum of two parts. The first is the effect of the
forces of its contacts, ``F(p, p'/h)`` along the quintic p of a contact's compression
(`validation.lattice.kernel.kinks`), integrated twice. The second, the rest, is small and smooth:
the polynomial of degree 7 with the ``y``, ``y'`` and ``y''`` that are left at both ends, and
``y''' = 0`` there.

A smooth force is integrated as a polynomial. If the step was corrected for a kink of the contact,
its force is integrated up to each sample.

Letters: n numbers the steps, step n leading from knot n to knot n + 1; row q of the arrays belongs
to bead ``watched[q]``, row q + 1 to the next bead; h is the step, x, from 0 to 1, the time in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import Beads, Chain, Knots, Numbers
from validation.lattice.kernel.compiled import FIRST, cached, inlined, part
from validation.lattice.kernel.force import push
from validation.lattice.kernel.kinks import State, value_and_slope

# Places of a step at which a smooth force is computed, and the matrix from accelerations there to
# the coefficients of x², x³, … in y. The polynomial of degree 7 alone, which cannot follow a force
# of degree 6, erred by up to 93 tolerances in damped chains at 1e-10, where knots err by 1.
_PLACES = np.linspace(0.0, 1.0, 7)
_POWERS = np.arange(len(_PLACES))[:, None]
_FIT = np.linalg.inv(_PLACES[:, None] ** _POWERS.T) / (_POWERS + 1) / (_POWERS + 2)
# A plain False is a type of its own, for which numba would compile `kinks.integrals` once more.
NOT_DRIVEN: Any = np.bool_(False)


@part
def store_knot(chain: Chain, beads: Beads, knots: Knots, now: Any) -> None:
    """Store the present motion of the watched beads as the next knot."""
    if len(knots.watched) == 0:
        return
    knots.time[now.stored] = now.t
    for q in range(len(knots.watched)):
        j = knots.watched[q]
        state = knots.state[now.stored, q]
        state[0] = beads.y[j]
        state[1] = beads.v[j]
        state[2] = beads.push[0, j]
        if j == 0 and chain.drive.driven:
            state[2] = beads.given[0]
        state[3] = beads.marks[j]
    now.stored += 1


@part
def _state(chain: Chain, knots: Knots, n: int, q: int, h: float) -> State:
    """Return δ, δ' and δ'' of the contact ahead of the bead of row q at knot n, in units of h."""
    near = knots.state[n, q]
    far = knots.state[n, q + 1]
    d = chain.rest[knots.watched[q]] + near[0] - far[0]
    return d, h * (near[1] - far[1]), h * h * (near[2] - far[2])


@inlined
def _fit_curve(a: Array, b: Array, pushes: Array, c: Array) -> None:
    """Compute the coefficients c of y, a polynomial of degree 8 in x.

    Parameters
    ----------
    a, b : array, (3,)
        y, y' and y'' at x = 0 and at x = 1.
    pushes : array, (7,)
        Accelerations by smooth forces at the `_PLACES`.
    c : array, (9,)
        Room for the coefficients.
    """
    c[0] = a[0]
    c[1] = a[1]
    for m in range(len(_PLACES)):
        c[m + 2] = 0.0
        for k in range(len(_PLACES)):
            c[m + 2] += _FIT[m, k] * pushes[k]
    c2 = (a[2] - pushes[0]) / 2
    # The rest has c4 … c7 besides, from what is left of y, y' and y'' at x = 1, r0, r1 and r2.
    r0 = b[0] - c2
    r1 = b[1] - 2 * c2
    r2 = b[2] - 2 * c2 - pushes[len(_PLACES) - 1]
    for m in range(len(c)):
        r0 -= c[m]
        r1 -= m * c[m]
    c[2] += c2
    c[4] += 35 * r0 - 15 * r1 + 2.5 * r2
    c[5] += -84 * r0 + 39 * r1 - 7 * r2
    c[6] += 70 * r0 - 34 * r1 + 6.5 * r2
    c[7] += -20 * r0 + 10 * r1 - 2 * r2


@inlined
def _take_kink_away(
    chain: Chain,
    knots: Knots,
    n: int,
    q: int,
    r: int,
    h: float,
    ends: Array,
    time: Array,
    first: int,
    last: int,
    y: Array,
    v: Array,
    points: Array,
    edges: Array,
) -> None:
    """Move the effect of a contact's force from the motion at a step's ends to its samples.

    The contact is ahead of the bead of row q, which is row r of ``ends``, y and v. Its force, along
    the curve p of its compression, is integrated up to each sample and added to y and v there; it
    is taken away from ``ends``, so that the polynomial follows the smooth rest of the motion.
    """
    i = knots.watched[q]
    law = chain.laws[chain.law[i]]
    ratio = chain.r[i]
    scale = h * h * chain.A[i]
    near = scale * chain.inverse[i]
    far = scale * chain.inverse[i + 1]
    begin = _state(chain, knots, n, q, h)
    over = _state(chain, knots, n + 1, q, h)
    bend = -near - far
    found = kinks.resolved(law, ratio, begin, over, h, bend, kinks.STRAIGHT, edges)
    p = found.curve
    if p[6][1] != 0.0:
        found = kinks.resolved(law, ratio, begin, over, h, bend, p[6], edges)
        p = found.curve
    for s in range(first, last + 1):
        x = (time[s] - knots.time[n]) / h if s < last else 1.0
        sums = kinks.integrals(
            law, ratio, found, h, x, bend, points, edges, NOT_DRIVEN, p
        )
        once = sums.impulse
        moment = sums.moment - (1.0 - x) * once  # ∫ (x - s) F(s) ds
        if s < last:
            y[r, s] -= near * moment
            y[r + 1, s] += far * moment
            v[r, s] -= near * once / h
            v[r + 1, s] += far * once / h
        else:
            ends[1, r, 0] += near * moment
            ends[1, r, 1] += near * once
            ends[1, r + 1, 0] -= far * moment
            ends[1, r + 1, 1] -= far * once
    for end in range(2):
        delta, slope = value_and_slope(p, float(end))
        force = push(law, ratio, delta, slope / h)
        ends[end, r, 2] += near * force
        ends[end, r + 1, 2] -= far * force


@inlined
def _add_smooth_force(
    chain: Chain, knots: Knots, n: int, q: int, r: int, h: float, pushes: Array
) -> None:
    """Add a contact's force along the curve of its compression to the accelerations of its beads.

    The contact is ahead of the bead of row q, which is row r of ``pushes``; these are in units of
    the step h, from knot n to knot n + 1, and at its `_PLACES`.
    """
    i = knots.watched[q]
    law = chain.laws[chain.law[i]]
    begin = _state(chain, knots, n, q, h)
    over = _state(chain, knots, n + 1, q, h)
    p = kinks.fitted_curve(begin, over, kinks.STRAIGHT)
    for m in range(len(_PLACES)):
        d, slope = value_and_slope(p, _PLACES[m])
        force = chain.A[i] * push(law, chain.r[i], d, slope / h) - chain.load[i]
        pushes[r, m] -= h * h * chain.inverse[i] * force
        pushes[r + 1, m] += h * h * chain.inverse[i + 1] * force


@cached
def interpolate(
    chain: Chain,
    knots: Knots,
    rows: Numbers,
    time: Array,
    step: Numbers,
    y: Array,
    v: Array,
    ends: Array,
    pushes: Array,
    points: Array,
    edges: Array,
) -> None:
    """Compute displacements and velocities of watched beads; they go to y and v, both (R, S).

    Parameters
    ----------
    chain : Chain
        The chain.
    knots : Knots
        Motion at the ends of the steps.
    rows : array of int, (R,)
        Rows q of the beads; only beads between two others of them come out right.
    time : array, (S,)
        Increasing times.
    step : array of int, (S,)
        Number of the step that holds each time.
    y, v : array, (R, S)
        Room for the results.
    ends, pushes : array, (2, R, 3) and (R, 7)
        Working memory.
    points, edges : array
        Working memory, as in `Beads`.
    """
    c = points[0, : len(_PLACES) + 2]
    last = FIRST
    while last < len(time):
        # Samples first … last - 1 lie in one step, n.
        first = last
        n = step[last]
        while last < len(time) and step[last] == n:
            last += 1
        start = knots.time[n]
        h = knots.time[n + 1] - knots.time[n]
        for r in range(len(rows)):
            for end in range(2):
                state = knots.state[n + end, rows[r]]
                # y, y' and y'' in units of the step.
                row = ends[end, r]
                row[0] = state[0]
                row[1] = h * state[1]
                row[2] = h * h * state[2]
            for s in range(first, last):
                y[r, s] = v[r, s] = 0.0
            pushes[r] = 0.0
        # The contact between the beads of rows r and r + 1. The beads of the first and the last
        # row, and those beside a gap in the rows, may lack a contact: they are there as neighbours
        # of the beads that are wanted.
        for r in range(len(rows) - 1):
            q = rows[r]
            kinked = knots.state[n + 1, q, 3] > 0.0
            if kinked:
                _take_kink_away(
                    chain,
                    knots,
                    n,
                    q,
                    r,
                    h,
                    ends,
                    time,
                    first,
                    last,
                    y,
                    v,
                    points,
                    edges,
                )
            else:
                _add_smooth_force(chain, knots, n, q, r, h, pushes)
        # The effects of kinks are in y and v already.
        for r in range(len(rows)):
            _fit_curve(ends[0, r], ends[1, r], pushes[r], c)
            for s in range(first, last):
                x = (time[s] - start) / h
                smooth = slope = 0.0
                for m in range(len(_PLACES) + 1, -1, -1):
                    slope = slope * x + smooth
                    smooth = smooth * x + c[m]
                y[r, s] += smooth
                v[r, s] += slope / h
