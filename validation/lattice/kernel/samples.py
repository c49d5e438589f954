"""Interpolated motion of the watched beads within steps, between knots (the ends of steps).

Within a step a displacement is the polynomial with y, y', y'' and y''' at both ends (Hermite).
If a contact of the bead opens or closes, the effect of its force F(p, p'/h)
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
from validation.lattice.kernel.compiled import SOURCES, cached, inner, part
from validation.lattice.kernel.force import stiffness
from validation.lattice.kernel.kinks import (
    Quintic,
    drag,
    fitted_quintic,
    integrals,
    law_of,
    near_kink,
    push,
    pushes,
    value_and_slope,
)

Four = tuple[float, float, float, float]
_NONE: Quintic = (float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0)


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


@inner
def _compression(chain: Chain, knots: Knots, n: int, q: int) -> tuple[float, float, float]:
    """Return δ, δ' and δ'' of the contact between the beads of rows q and q + 1, at knot n."""
    near, far = knots.state[n, q], knots.state[n, q + 1]
    rest = chain.rest[knots.watched[q]]
    return rest + near[0] - far[0], near[1] - far[1], near[2] - far[2]


@inner
def _kink(chain: Chain, knots: Knots, n: int, q: int) -> Quintic:
    """Return the quintic of the contact ahead of the bead of row q in step n, if it has a kink.

    Returns `_NONE` otherwise.
    """
    if q < 0 or chain.pulls or not chain.A[knots.watched[q]] > 0.0:
        return _NONE
    h, law = knots.time[n + 1] - knots.time[n], law_of(chain, knots.watched[q])
    d, v, a = _compression(chain, knots, n, q)
    end, end_v, end_a = _compression(chain, knots, n + 1, q)
    changed = pushes(law, d, v) != pushes(law, end, end_v)
    if near_kink(d, end, h * v, h * end_v, True, changed):
        return fitted_quintic(d, h * v, h * h * a, end, h * end_v, h * h * end_a)
    return _NONE


@inner
def _rate(chain: Chain, knots: Knots, n: int, q: int, kink: Quintic) -> float:
    """Return dF/dt of the contact ahead of the bead of row q, at knot n.

    The rate is 0 without a contact, and for a contact with a kink.
    """
    if q < 0 or not math.isnan(kink[0]):
        return 0.0
    i = knots.watched[q]
    d, v, a = _compression(chain, knots, n, q)
    rate, law = chain.A[i] * stiffness(chain, d) * v, law_of(chain, i)
    if chain.damped:
        if not (chain.pulls or pushes(law, d, v)):
            return 0.0
        rate += drag(law, d) * a
        if chain.p > 0.0:
            rate += chain.p * drag(law, d) / d * v * v
    return float(rate)


@inner
def _effect(
    chain: Chain, i: int, p: Quintic, unit: float, h: float, x: float, points: Array
) -> tuple[float, float]:
    """Return the effect of contact i up to x on y and y' of a bead; unit : ± h² over its mass."""
    if math.isnan(p[0]) or x == 0.0:
        return 0.0, 0.0
    # Over the part of the step up to x the quintic's coefficients are c_j x^j.
    x2 = x * x
    part_of = p[0], x * p[1], x2 * p[2], x2 * x * p[3], x2 * x2 * p[4], x2 * x2 * x * p[5]
    once, twice, _, _, _ = integrals(law_of(chain, i), part_of, h * x, points)
    return unit * x2 * twice, unit * x * once


@inner
def _knot(
    chain: Chain, knots: Knots, n: int, q: int, h: float, behind: Quintic, ahead: Quintic
) -> Four:
    """Return y, y', y'' and y''' of the bead of row q at knot n, in units of time h.

    behind, ahead : its contacts, if they have kinks; y''' lacks their forces.
    """
    state = knots.state[n, q]
    jerk = _rate(chain, knots, n, q - 1, behind) - _rate(chain, knots, n, q, ahead)
    return (
        state[0],
        h * state[1],
        h * h * state[2],
        h * h * h * jerk * chain.inverse[knots.watched[q]],
    )


@inner
def _without_kink(
    chain: Chain, knot: Four, i: int, p: Quintic, unit: float, h: float, x: float, points: Array
) -> Four:
    """Subtract from y, y' and y'' at x = 0 or 1 the effect of contact i with a kink."""
    if math.isnan(p[0]):
        return knot
    y, v = _effect(chain, i, p, unit, h, x, points)
    d, slope = value_and_slope(p, x)
    return knot[0] - y, knot[1] - v, knot[2] - unit * push(law_of(chain, i), d, slope / h), knot[3]


@inner
def _polynomial(
    chain: Chain, knots: Knots, n: int, q: int, behind: Quintic, ahead: Quintic, points: Array
) -> tuple[Quintic, float, float]:
    """Return the coefficients c0 … c5 (a tuple), c6 and c7 of y over step n.

    behind, ahead : the bead's two contacts, if they have kinks; their effects are left out.
    """
    h, i = knots.time[n + 1] - knots.time[n], knots.watched[q]
    unit = h * h * chain.inverse[i]
    a = _knot(chain, knots, n, q, h, behind, ahead)
    b = _knot(chain, knots, n + 1, q, h, behind, ahead)
    for p, contact, force in ((behind, i - 1, unit), (ahead, i, -unit)):
        a = _without_kink(chain, a, contact, p, force, h, 0.0, points)
        b = _without_kink(chain, b, contact, p, force, h, 1.0, points)
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
        points: Array,
    ) -> int:
        """Compute displacements and velocities of watched beads; they go to y and v, both (R, S).

        rows : (R,), rows q of the beads. time : (S,). step : (S,), number of the step that holds
        each time. points : working memory, as in `Beads`. Returns ``sources``.
        """
        for r in range(len(rows)):
            q, n, i = rows[r], -1, knots.watched[rows[r]]
            behind = ahead = low = _NONE
            start = h = c6 = c7 = unit = 0.0
            for s in range(len(time)):
                if step[s] != n:
                    n = step[s]
                    start, h = knots.time[n], knots.time[n + 1] - knots.time[n]
                    unit = h * h * chain.inverse[i]
                    behind, ahead = _kink(chain, knots, n, q - 1), _kink(chain, knots, n, q)
                    low, c6, c7 = _polynomial(chain, knots, n, q, behind, ahead, points)
                x = (time[s] - start) / h
                push_y, push_v = _effect(chain, i - 1, behind, unit, h, x, points)
                pull_y, pull_v = _effect(chain, i, ahead, -unit, h, x, points)
                smooth, slope = value_and_slope(low, x)
                x5 = x * x * x * x * x
                y[r, s] = smooth + x5 * x * (c6 + x * c7) + push_y + pull_y
                v[r, s] = (slope + x5 * (6 * c6 + x * 7 * c7) + push_v + pull_v) / h
        return sources

    return interpolate


interpolate = _built(SOURCES)
