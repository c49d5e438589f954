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

`part` and `inlined` are numba's ``njit`` with options (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import Beads, Chain, Forcing, Knots, Numbers
from validation.lattice.kernel.compiled import FIRST, cached, inlined, part
from validation.lattice.kernel.force import push
from validation.lattice.kernel.kinks import State, value_and_slope

# Places of a step at which a smooth force is computed, and the matrix from accelerations there to
# the coefficients of x², x³, … in y. The polynomial of degree 7 alone, which cannot follow a force
# of degree 6, erred by up to 93 tolerances in damped chains at 1e-10, where knots err by 1.
_PLACES = np.linspace(0.0, 1.0, 7)
_POWERS = np.arange(len(_PLACES))[:, None]
_FIT = np.linalg.inv(_PLACES[:, None] ** _POWERS.T) / (_POWERS + 1) / (_POWERS + 2)


@part
def store_knot(forcing: Forcing | None, beads: Beads, knots: Knots, now: Any) -> None:
    """Store the present motion of the watched beads as the next knot.

    A state is displacement, velocity, acceleration, and 1 if the step to the knot was corrected for
    a kink of the contact ahead of the bead. The acceleration is that of the first stage, at the
    start of the next step. A driven bead, of infinite mass, has a given acceleration.
    """
    if len(knots.watched) == 0:
        return
    knots.time[now.stored] = now.t
    for q in range(len(knots.watched)):
        j = knots.watched[q]
        state = knots.state[now.stored, q]
        state[0] = beads.y[j]
        state[1] = beads.v[j]
        state[2] = beads.push[0, j]
        if j == 0 and forcing is not None and forcing.driven:
            state[2] = beads.given[0]
        state[3] = beads.marks[j]
    now.stored += 1


@part
def _between(rest: float, near: Array, far: Array) -> State:
    """Return δ, δ' and δ'' of a contact from y, y' and y'' of the beads behind and ahead of it."""
    return rest + near[0] - far[0], near[1] - far[1], near[2] - far[2]


@part
def _scaled(chain: Chain, knots: Knots, n: int, q: int, h: float) -> State:
    """Return δ, δ' and δ'' of the contact ahead of the bead of row q at knot n, in units of h."""
    rest = chain.rest[knots.watched[q]]
    d, rate, bent = _between(rest, knots.state[n, q], knots.state[n, q + 1])
    return d, h * rate, h * h * bent


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
    # Half of the acceleration at x = 0 that the smooth forces leave to the rest
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


@part
def _effect(
    law: Any,
    r: float,
    found: kinks.Kinks,
    h: float,
    bend: float,
    x: float,
    points: Array,
    edges: Array,
) -> tuple[float, float]:
    """Return ``∫ (x - s) F ds`` and ``∫ F ds`` over a contact's force F up to the place x."""
    sums = kinks.integrals(
        law, r, found, h, x, bend, points, edges, kinks.NOT_DRIVEN, found.curve
    )
    return sums.moment - (1.0 - x) * sums.impulse, sums.impulse


@inlined
def _take_kink_away(
    chain: Chain,
    knots: Knots,
    n: int,
    q: int,
    r: int,
    h: float,
    ends: Array,
    moved: Array,
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
    the curve p of its compression, is integrated up to each sample and added to y and v there, and
    up to the `_PLACES` and added to ``moved``. From the accelerations in ``ends`` it is taken away,
    so that the polynomial follows the smooth rest of the motion.

    ends : y, y' and y'' by x of each row, at both ends of the step. moved : what kinks add to y and
    to y' of each row at the `_PLACES`. first, last : the samples first … last - 1 lie in the step.
    """
    i = knots.watched[q]
    law = chain.laws[chain.law[i]]
    ratio = chain.r[i]
    scale = h * h * chain.A[i]
    near = scale * chain.inverse[i]
    far = scale * chain.inverse[i + 1]
    begin = _scaled(chain, knots, n, q, h)
    over = _scaled(chain, knots, n + 1, q, h)
    bend = -near - far  # change of p'' by a force of 1
    found = kinks.resolved(law, ratio, begin, over, h, bend, kinks.STRAIGHT, edges)
    p = found.curve
    # A force that jumps bends the curve: a second call knows the bend, p[6], of the size p[6][1].
    if p[6][1] != 0.0:
        found = kinks.resolved(law, ratio, begin, over, h, bend, p[6], edges)
        p = found.curve
    for m in range(1, len(_PLACES)):
        moment, impulse = _effect(law, ratio, found, h, bend, _PLACES[m], points, edges)
        moved[0, r, m] -= near * moment
        moved[0, r + 1, m] += far * moment
        moved[1, r, m] -= near * impulse
        moved[1, r + 1, m] += far * impulse
    for s in range(first, last):
        x = (time[s] - knots.time[n]) / h
        moment, impulse = _effect(law, ratio, found, h, bend, x, points, edges)
        y[r, s] -= near * moment
        y[r + 1, s] += far * moment
        v[r, s] -= near * impulse / h
        v[r + 1, s] += far * impulse / h
    for end in range(2):
        delta, slope = value_and_slope(p, float(end))
        force = push(law, ratio, delta, slope / h)
        ends[end, r, 2] += near * force
        ends[end, r + 1, 2] -= far * force


@inlined
def _add_smooth_force(
    chain: Chain, i: int, r: int, h: float, ends: Array, moved: Array, pushes: Array
) -> None:
    """Add the force of contact i along its compression to the accelerations of its beads.

    The contact is ahead of the bead of row r. Its compression is a quintic without the kinks of
    its neighbours, plus their effects, ``moved`` from the ``ends``. A quintic of the whole motion
    errs where a neighbour's force jumps: by up to 549 tolerances in four scenes, now 6.

    ends : y, y' and y'' by x of each row, at both ends of the step, without the effects of kinks.
    moved : what kinks add to y and to y' of each row at the `_PLACES`. pushes : accelerations of
    each row by smooth forces there, by x.
    """
    law = chain.laws[chain.law[i]]
    rest = chain.rest[i]
    begin = _between(rest, ends[0, r], ends[0, r + 1])
    over = _between(rest, ends[1, r], ends[1, r + 1])
    p = kinks.fitted_curve(begin, over, kinks.STRAIGHT)
    for m in range(len(_PLACES)):
        d, slope = value_and_slope(p, _PLACES[m])
        d += moved[0, r, m] - moved[0, r + 1, m]
        slope += moved[1, r, m] - moved[1, r + 1, m]
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
    moved: Array,
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
    ends, moved, pushes : array, (2, R, 3), (2, R, 7) and (R, 7)
        Working memory: the motion at both ends; what kinks add to y and y' at the `_PLACES`; the
        accelerations by smooth forces there.
    points, edges : array
        Working memory: three rows for the points of a quadrature, and the places between which a
        contact's force is smooth.
    """
    c = points[0, : len(_PLACES) + 2]  # room for the coefficients of `_fit_curve`
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
        # Contacts between the beads of rows r and r + 1. Entry 3 of a state is above 0 if the step
        # to its knot was corrected for a kink of the contact ahead of the bead. The beads of the
        # first and the last row, and those beside a gap in the rows, may lack a contact: they are
        # there as neighbours of the beads that are wanted.
        moved[:] = 0.0
        for r in range(len(rows) - 1):
            q = rows[r]
            if knots.state[n + 1, q, 3] > 0.0:
                _take_kink_away(
                    chain,
                    knots,
                    n,
                    q,
                    r,
                    h,
                    ends,
                    moved,
                    time,
                    first,
                    last,
                    y,
                    v,
                    points,
                    edges,
                )
        # The last of the places is the step's end.
        for r in range(len(rows)):
            for derivative in range(2):
                ends[1, r, derivative] -= moved[derivative, r, len(_PLACES) - 1]
        for r in range(len(rows) - 1):
            q = rows[r]
            if not knots.state[n + 1, q, 3] > 0.0:
                i = knots.watched[q]
                _add_smooth_force(chain, i, r, h, ends, moved, pushes)
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
