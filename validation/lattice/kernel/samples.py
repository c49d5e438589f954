"""Interpolated motion of the watched beads within steps, between knots (the ends of steps).

Within a step a displacement is the polynomial with y, y', y'' and y''' at both ends (Hermite).
If the step was corrected for a kink of the bead's contact, the effect of the contact's force
``F(p, p'/h)`` (`validation.lattice.kernel.kinks`) is subtracted before the interpolation and added
afterwards.

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
from validation.lattice.kernel.force import drag, elastic, push, stiffness
from validation.lattice.kernel.kinks import Curve, value_and_slope

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
def _compression(
    knots: Knots, n: int, q: int, rest: float
) -> tuple[float, float, float]:
    """Return δ, δ' and δ'' of the contact between the beads of rows q and q + 1, at knot n."""
    near = knots.state[n, q]
    far = knots.state[n, q + 1]
    return rest + near[0] - far[0], near[1] - far[1], near[2] - far[2]


@part
def _rate(law: Any, r: float, d: float, v: float, a: float) -> float:
    """Return dF/dt of a contact of unit stiffness from δ, δ' and δ''."""
    rate = stiffness(law, d) * v
    if not r > 0.0 or not (d > 0.0 or law.pulls):
        return rate
    resistance = r * drag(law, d)
    force = elastic(law, d)
    # Damping may not pull unless the law ``sticks``: where the sum would pull more than the elastic
    # force does, the force is the elastic one if that attracts, and 0 otherwise.
    if not (law.sticks or force + resistance * v > min(force, 0.0)):
        return rate if force < 0.0 else 0.0
    rate += resistance * a
    if law.p > 0.0:
        rate += law.p * resistance / d * v * v
    return rate


@inlined
def _septic(a: Array, b: Array) -> tuple[Curve, float, float]:
    """Return the coefficients c0 … c5, c6 and c7 of y from y … y''' at x = 0 (a) and at x = 1 (b).

    The coefficients c0 … c5 are a curve without a bend.
    """
    c2 = a[2] / 2
    c3 = a[3] / 6
    # c4 … c7 solve the four conditions at x = 1, of which c0 … c3 leave the remainders r0 … r3.
    r0 = b[0] - a[0] - a[1] - c2 - c3
    r1 = b[1] - a[1] - 2 * c2 - 3 * c3
    r2 = b[2] - 2 * c2 - 6 * c3
    r3 = b[3] - 6 * c3
    c4 = 35 * r0 - 15 * r1 + 2.5 * r2 - r3 / 6
    c5 = -84 * r0 + 39 * r1 - 7 * r2 + r3 / 2
    c6 = 70 * r0 - 34 * r1 + 6.5 * r2 - r3 / 2
    c7 = -20 * r0 + 10 * r1 - 2 * r2 + r3 / 6
    return (a[0], a[1], c2, c3, c4, c5, kinks.STRAIGHT), c6, c7


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
    d, u, a = _compression(knots, n, q, chain.rest[i])
    end, end_u, end_a = _compression(knots, n + 1, q, chain.rest[i])
    bend = -near - far
    begin = (d, h * u, h * h * a)
    over = (end, h * end_u, h * h * end_a)
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
def _add_rates(
    chain: Chain, knots: Knots, n: int, q: int, r: int, h: float, ends: Array
) -> None:
    """Add the rate dF/dt of a contact's force to the jerks of its two beads, ``m y''' = ∓dF/dt``.

    The contact is ahead of the bead of row q, which is row r of ``ends``. The step h is from knot n
    to knot n + 1. Column j of ``ends`` holds the j-th derivative times ``h^j``, the derivative by
    the time in units of the step: the jerk is in column 3, with the factor h³.
    """
    i = knots.watched[q]
    scale = h * h * h * chain.A[i]
    for end in range(2):
        d, speed, a = _compression(knots, n + end, q, chain.rest[i])
        rate = scale * _rate(chain.laws[chain.law[i]], chain.r[i], d, speed, a)
        ends[end, r, 3] -= chain.inverse[i] * rate
        ends[end, r + 1, 3] += chain.inverse[i + 1] * rate


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
    ends : array, (2, R, 4)
        Working memory.
    points, edges : array
        Working memory, as in `Beads`.
    """
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
                # y, y', y'' and the jerk y''' in units of the step. A knot has no jerk (column 3 of
                # its state marks a kink): the jerk is a sum over the contacts, made below.
                row = ends[end, r]
                row[0] = state[0]
                row[1] = h * state[1]
                row[2] = h * h * state[2]
                row[3] = 0.0
            for s in range(first, last):
                y[r, s] = v[r, s] = 0.0
        # The contact between the beads of rows r and r + 1: its force changes the jerk of both, or,
        # with a kink in the step, which no polynomial follows, its effect is set apart. The beads
        # of the first and the last row, and those beside a gap in the rows, may lack a contact:
        # they are there as neighbours of the beads that are wanted.
        for r in range(len(rows) - 1):
            q = rows[r]
            kink = knots.state[n + 1, q, 3] > 0.0
            if kink:
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
                _add_rates(chain, knots, n, q, r, h, ends)
        # The polynomial of degree 7 with y, y', y'' and the jerk at both ends. It is added to the
        # effects of kinks, which y and v hold already.
        for r in range(len(rows)):
            low, c6, c7 = _septic(ends[0, r], ends[1, r])
            for s in range(first, last):
                x = (time[s] - start) / h
                smooth, slope = value_and_slope(low, x)
                x5 = x * x * x * x * x
                y[r, s] += smooth + x5 * x * (c6 + x * c7)
                v[r, s] += (slope + x5 * (6 * c6 + x * 7 * c7)) / h
