"""Interpolated motion of the watched beads within steps, between knots (the ends of steps).

Within a step a displacement is the polynomial of degree 7 with y, y', y'' and y''' at both ends
(Hermite). If a contact of the bead opens or closes, the double integral of the contact's p_+^k
(`validation.lattice.kernel.kinks`) is subtracted before the interpolation and added afterwards.

Letters: n numbers the steps, step n leading from knot n to knot n + 1; row q of the arrays belongs
to bead ``watched[q]``, row q + 1 to the next bead; h is the step, x = 0 … 1 the time within it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Beads, Chain, Knots
from validation.lattice.kernel.compiled import SOURCES, cached, part
from validation.lattice.kernel.force import power, stiffness
from validation.lattice.kernel.kinks import (
    NEAR,
    NONE,
    Quintic,
    fitted_quintic,
    kink,
    kink_integrals,
    quintic,
)

Four = tuple[float, float, float, float]


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
    now.stored += 1


@part
def _compression(chain: Chain, knots: Knots, n: int, q: int) -> tuple[float, float, float]:
    """Return δ, δ' and δ'' of the contact between the beads of rows q and q + 1, at knot n."""
    near, far = knots.state[n, q], knots.state[n, q + 1]
    rest = chain.rest[knots.watched[q]]
    return rest + near[0] - far[0], near[1] - far[1], near[2] - far[2]


@part
def _kink(chain: Chain, points: Array, knots: Knots, n: int, q: int) -> Quintic:
    """Return the `kink` in step n of the contact ahead of the bead of row q, or `NONE`."""
    if points.shape[1] == 0 or q < 0:
        return NONE
    h = knots.time[n + 1] - knots.time[n]
    d, v, a = _compression(chain, knots, n, q)
    end, end_v, end_a = _compression(chain, knots, n + 1, q)
    most = max(d, end)
    if not (most > 0.0 and min(d, end) < NEAR * most):
        return NONE
    return kink(fitted_quintic(d, h * v, h * h * a, end, h * end_v, h * h * end_a), end)


@part
def _rate(chain: Chain, knots: Knots, n: int, q: int, side: float) -> float:
    """Return dF/dt of the contact ahead of the bead of row q, at knot n; 0 without a contact.

    side : 1 for the limit from later times, -1 for the limit from earlier times.
    """
    if q < 0:
        return 0.0
    d, v, _ = _compression(chain, knots, n, q)
    return float(chain.A[knots.watched[q]] * stiffness(chain, d, side * v > 0.0) * v)


@part
def _knot(chain: Chain, knots: Knots, n: int, q: int, h: float, side: float) -> Four:
    """Return y, y', y'' and y''' of the bead of row q at knot n, in units of time h."""
    state = knots.state[n, q]
    jerk = _rate(chain, knots, n, q - 1, side) - _rate(chain, knots, n, q, side)
    return (
        state[0],
        h * state[1],
        h * h * state[2],
        h * h * h * jerk * chain.inverse[knots.watched[q]],
    )


@part
def _without_kink(
    chain: Chain, points: Array, knot: Four, p: Quintic, unit: float, z: float
) -> Four:
    """Subtract from y, y', y'' and y''' at x = z the contribution of a kink p.

    The contribution is ``unit`` times p_+^k to y'', and the integrals from p's root on to y' and y.
    """
    if math.isnan(p[0]):
        return knot
    y, v = kink_integrals(chain, points, p, z)
    # p = (x - r) q, p' = q + (x - r) q', and (p_+^k)' = k p_+^{k-1} p'
    q = p[1] + z * (p[2] + z * (p[3] + z * (p[4] + z * p[5])))
    rise = p[2] + z * (2 * p[3] + z * (3 * p[4] + z * 4 * p[5]))
    d, slope = (z - p[0]) * q, q + (z - p[0]) * rise
    rate = stiffness(chain, d, (slope > 0.0) == (z == 0.0)) * slope
    return (
        knot[0] - unit * y,
        knot[1] - unit * v,
        knot[2] - unit * power(chain, d),
        knot[3] - unit * rate,
    )


@part
def _polynomial(
    chain: Chain, points: Array, knots: Knots, n: int, q: int, behind: Quintic, ahead: Quintic
) -> tuple[Quintic, float, float]:
    """Return the coefficients c0 … c5 (a tuple), c6 and c7 of y over step n.

    behind, ahead : kinks of the bead's two contacts, whose contributions are left out.
    """
    h = knots.time[n + 1] - knots.time[n]
    push, pull = _units(chain, knots, q, h)
    a, b = _knot(chain, knots, n, q, h, 1.0), _knot(chain, knots, n + 1, q, h, -1.0)
    for p, unit in ((behind, push), (ahead, pull)):
        a = _without_kink(chain, points, a, p, unit, 0.0)
        b = _without_kink(chain, points, b, p, unit, 1.0)
    c2, c3 = a[2] / 2, a[3] / 6
    # c4 … c7 solve the four conditions at x = 1, of which c0 … c3 leave the remainders r0 … r3.
    r0, r1 = b[0] - a[0] - a[1] - c2 - c3, b[1] - a[1] - 2 * c2 - 3 * c3
    r2, r3 = b[2] - 2 * c2 - 6 * c3, b[3] - 6 * c3
    c4, c5 = 35 * r0 - 15 * r1 + 2.5 * r2 - r3 / 6, -84 * r0 + 39 * r1 - 7 * r2 + r3 / 2
    c6, c7 = 70 * r0 - 34 * r1 + 6.5 * r2 - r3 / 2, -20 * r0 + 10 * r1 - 2 * r2 + r3 / 6
    return (a[0], a[1], c2, c3, c4, c5), c6, c7


@part
def _units(chain: Chain, knots: Knots, q: int, h: float) -> tuple[float, float]:
    """Return two factors for the bead of row q: h² A/m of the contact behind, -h² A/m ahead.

    These factors times p_+^k are the contacts' contributions to the acceleration of the bead (mass
    m) in units of time h.
    """
    i = knots.watched[q]
    unit = h * h * chain.inverse[i]
    return unit * chain.A[i - 1], -unit * chain.A[i]


def _built(sources: int) -> Any:
    """Compile `interpolate`; its cache is for source code with the hash ``sources``."""

    @cached
    def interpolate(
        chain: Chain,
        points: Array,
        knots: Knots,
        rows: NDArray[np.int_],
        time: Array,
        step: NDArray[np.int_],
        y: Array,
        v: Array,
    ) -> int:
        """Compute displacements and velocities of watched beads; they go to y and v, both (R, S).

        rows : (R,), rows q of the beads. time : (S,). step : (S,), number of the step that holds
        each time. Returns ``sources``.
        """
        for r in range(len(rows)):
            q, n = rows[r], -1
            behind = ahead = low = NONE
            start = h = c6 = c7 = push = pull = 0.0
            for s in range(len(time)):
                if step[s] != n:
                    n = step[s]
                    start, h = knots.time[n], knots.time[n + 1] - knots.time[n]
                    push, pull = _units(chain, knots, q, h)
                    behind = _kink(chain, points, knots, n, q - 1)
                    ahead = _kink(chain, points, knots, n, q)
                    low, c6, c7 = _polynomial(chain, points, knots, n, q, behind, ahead)
                x = (time[s] - start) / h
                pull_y, pull_v = kink_integrals(chain, points, ahead, x)
                push_y, push_v = kink_integrals(chain, points, behind, x)
                smooth = quintic(low, x) + x * x * x * x * x * x * (c6 + x * c7)
                y[r, s] = smooth + push * push_y + pull * pull_y
                slope = 4 * low[4] + x * (5 * low[5] + x * (6 * c6 + x * 7 * c7))
                slope = low[1] + x * (2 * low[2] + x * (3 * low[3] + x * slope))
                v[r, s] = (slope + push * push_v + pull * pull_v) / h
        return sources

    return interpolate


interpolate = _built(SOURCES)
