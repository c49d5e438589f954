"""Interpolated motion of the watched beads within steps, between knots (the ends of steps).

Within a step a displacement is the polynomial with y, y', y'' and y''' at both ends (Hermite).
If the step was corrected for a kink of the bead's contact, the effect of the contact's force
F(p, p'/h) (`validation.lattice.kernel.kinks`) is subtracted before the interpolation and added
afterwards.

Letters: n numbers the steps, step n leading from knot n to knot n + 1; row q of the arrays belongs
to bead ``watched[q]``, row q + 1 to the next bead; h is the step, x = 0 … 1 the time within it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import Beads, Chain, Knots, Law
from validation.lattice.kernel.compiled import SOURCES, cached, inlined, inner, part
from validation.lattice.kernel.force import stiffness
from validation.lattice.kernel.kinks import Quintic, fitted_quintic, value_and_slope


@part
def store_knot(chain: Chain, beads: Beads, knots: Knots, now: Any) -> None:
    """Store the present motion of the watched beads as the next knot."""
    if len(knots.watched) == 0:
        return
    knots.time[now.stored] = now.t
    for q in range(len(knots.watched)):
        j, state = knots.watched[q], knots.state[now.stored, q]
        force = beads.force[0, j] - beads.force[0, j + 1]
        state[0], state[1], state[2] = beads.y[j], beads.v[j], force * chain.inverse[j]
        if j == 0 and chain.drive.driven:
            state[2] = beads.given[0]
        state[3] = 0.0 if chain.law.pulls else beads.sums[0, j + 1]
    now.stored += 1


@part
def _compression(knots: Knots, n: int, q: int, rest: float) -> tuple[float, float, float]:
    """Return δ, δ' and δ'' of the contact between the beads of rows q and q + 1, at knot n."""
    near, far = knots.state[n, q], knots.state[n, q + 1]
    return rest + near[0] - far[0], near[1] - far[1], near[2] - far[2]


@part
def _quintic(knots: Knots, n: int, q: int, rest: float) -> Quintic:
    """Return the quintic of the contact between the beads of rows q and q + 1 in step n."""
    h = knots.time[n + 1] - knots.time[n]
    d, v, a = _compression(knots, n, q, rest)
    end, end_v, end_a = _compression(knots, n + 1, q, rest)
    return fitted_quintic(d, h * v, h * h * a, end, h * end_v, h * h * end_a)


@part
def _rate(law: Law, r: float, d: float, v: float, a: float) -> float:
    """Return dF/dt of a contact of unit stiffness from δ, δ' and δ''."""
    rate = stiffness(law, d) * v
    if r > 0.0:
        if not (law.pulls or kinks.pushes(law, r, d, v)):
            return 0.0
        resistance = r * kinks.drag(law, d)
        rate += resistance * a
        if law.p > 0.0:
            rate += law.p * resistance / d * v * v
    return float(rate)


@inner
def _effect(
    law: Law, r: float, p: Quintic, h: float, x: float, points: Array
) -> tuple[float, float]:
    """Return the effect of a unit contact's force up to x on y and y' of a bead with h² = mass."""
    # Over the part of the step up to x the quintic's coefficients are c_j x^j.
    x2 = x * x
    part_of = p[0], x * p[1], x2 * p[2], x2 * x * p[3], x2 * x2 * p[4], x2 * x2 * x * p[5]
    once, twice, _, _, _ = kinks.integrals(law, r, part_of, h * x, points)
    return x2 * twice, x * once


@inlined
def _smooth_ends(
    chain: Chain, knots: Knots, n: int, rows: NDArray[np.int_], ends: Array, points: Array
) -> None:
    """Compute y, y', y'' and y''' at the ends of step n, less the effects of contacts with kinks.

    They go to ``ends``, (2, R, 4).
    """
    h = knots.time[n + 1] - knots.time[n]
    for end in range(2):
        for r in range(len(rows)):
            state, row = knots.state[n + end, rows[r]], ends[end, r]
            row[0], row[1], row[2], row[3] = state[0], h * state[1], h * h * state[2], 0.0
        for r in range(len(rows) - 1):
            q = rows[r]
            i = knots.watched[q]
            scale, rest, ratio = h * h * chain.A[i], chain.rest[i], chain.r[i]
            near, far = scale * chain.inverse[i], scale * chain.inverse[i + 1]
            if knots.state[n + 1, q, 3] > 0.0:
                p = _quintic(knots, n, q, rest)
                moment, impulse = _effect(chain.law, ratio, p, h, float(end), points)
                delta, slope = value_and_slope(p, float(end))
                changes = moment, impulse, kinks.push(chain.law, ratio, delta, slope / h)
                for m in range(3):
                    ends[end, r, m] += near * changes[m]
                    ends[end, r + 1, m] -= far * changes[m]
            else:
                d, v, a = _compression(knots, n + end, q, rest)
                rate = h * _rate(chain.law, ratio, d, v, a)
                ends[end, r, 3] -= near * rate
                ends[end, r + 1, 3] += far * rate


@part
def _septic(a: Array, b: Array) -> tuple[Quintic, float, float]:
    """Return the coefficients c0 … c5, c6 and c7 of y from y … y''' at x = 0 (a) and at x = 1 (b).

    The coefficients c0 … c5 are a tuple.
    """
    c2, c3 = a[2] / 2, a[3] / 6
    # c4 … c7 solve the four conditions at x = 1, of which c0 … c3 leave the remainders r0 … r3.
    r0, r1 = b[0] - a[0] - a[1] - c2 - c3, b[1] - a[1] - 2 * c2 - 3 * c3
    r2, r3 = b[2] - 2 * c2 - 6 * c3, b[3] - 6 * c3
    c4, c5 = 35 * r0 - 15 * r1 + 2.5 * r2 - r3 / 6, -84 * r0 + 39 * r1 - 7 * r2 + r3 / 2
    c6, c7 = 70 * r0 - 34 * r1 + 6.5 * r2 - r3 / 2, -20 * r0 + 10 * r1 - 2 * r2 + r3 / 6
    return (a[0], a[1], c2, c3, c4, c5), c6, c7


def _built(sources: int) -> Any:
    """Compile `interpolate`; its cache is for source code with the hash ``sources``."""

    @cached
    def interpolate(
        chain: Chain,
        knots: Knots,
        rows: NDArray[np.int_],
        time: Array,
        step: NDArray[np.int_],
        y: Array,
        v: Array,
        ends: Array,
        points: Array,
    ) -> int:
        """Compute displacements and velocities of watched beads; they go to y and v, both (R, S).

        rows : (R,), rows q of the beads; only beads between two others of them come out right.
        time : (S,), increasing. step : (S,), number of the step that holds each time. ends :
        (2, R, 4), working memory. points : as in `Beads`. Returns ``sources``.
        """
        last = 0
        while last < len(time):
            first, n = last, step[last]
            while last < len(time) and step[last] == n:
                last += 1
            start, h = knots.time[n], knots.time[n + 1] - knots.time[n]
            _smooth_ends(chain, knots, n, rows, ends, points)
            for r in range(len(rows)):
                low, c6, c7 = _septic(ends[0, r], ends[1, r])
                for s in range(first, last):
                    x = (time[s] - start) / h
                    smooth, slope = value_and_slope(low, x)
                    x5 = x * x * x * x * x
                    y[r, s] = smooth + x5 * x * (c6 + x * c7)
                    v[r, s] = (slope + x5 * (6 * c6 + x * 7 * c7)) / h
            for r in range(len(rows) - 1):
                q, i = rows[r], knots.watched[rows[r]]
                if knots.state[n + 1, q, 3] > 0.0:
                    p = _quintic(knots, n, q, chain.rest[i])
                    scale = h * h * chain.A[i]
                    near, far = scale * chain.inverse[i], scale * chain.inverse[i + 1]
                    for s in range(first, last):
                        x = (time[s] - start) / h
                        moment, impulse = _effect(chain.law, chain.r[i], p, h, x, points)
                        y[r, s], y[r + 1, s] = y[r, s] - near * moment, y[r + 1, s] + far * moment
                        v[r, s] -= near * impulse / h
                        v[r + 1, s] += far * impulse / h
        return sources

    return interpolate


interpolate = _built(SOURCES)
