"""Integrals of a contact's force over a step in which the contact opens or closes.

F has no derivative of order k + 1 where a contact opens or closes, and jumps there with some
dampings and laws. A quadrature that does not know the place errs by ``O(h^{k+1})``, or ``O(h)``.
Over the step, x from 0 to 1, the compression is close to the quintic ``p(x)`` with the values of δ,
δ' and δ'' at both ends. `integrals` integrates ``F(p, p')`` between the places at which the contact
opens, closes, or begins or ceases to be damped (`find_edges`), for unit stiffness, by Gauss's rule
in u, ``x = z + (e - z) u^q``, z the root of p at one end of an interval and e the other end, so
that F is smooth in u.

A damped contact that is pulled open can stop pushing before it parts: the force tells, not δ.

`part` and `alone` are numba's ``njit`` with options, and `index` makes an index unsigned, so that a
loop vectorises (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.compiled import FIRST, alone, call, index, part
from validation.lattice.kernel.force import drag, elastic, power, push

State = tuple[float, float, float]
"""A contact's p, p' and p''."""
Bend = tuple[float, float, float]
"""Numbers e, s and b of a part of p whose second derivative is ``s [x - e]_+^b``, ``0 ≤ b < 1``."""
Curve = tuple[float, float, float, float, float, float, Bend]
"""Coefficients c0 … c5 of p, and a bend that p has besides."""

POINTS = 12  # of the rule: three of the machine's vectors
# The rule is exact up to degree 23, and the force of a power law, along the curve, has degree k and
# some more: intervals are halved for exponents above _STEEP. One rule erred by 13 % at k = 200.
_STEEP = 16.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(POINTS)
_U, _W = (1 + _NODES) / 2, _WEIGHTS / 2
STRAIGHT = (1.0, 0.0, 0.0)  # no bend
NO_CURVE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, STRAIGHT)
# A plain False is a type of its own, for which numba would compile `integrals` once more.
NOT_DRIVEN: Any = np.bool_(False)
_PLACES = 8  # parts of a step at whose ends a contact is looked at
# Each part has at most one turning point of p, and on both sides of it a contact that closes or
# opens and begins or ceases to be damped; beside these the step's ends.
EDGES = 4 * _PLACES + 2
# Width at which the search for a place ends: at 1e-10 the energy lost errs by 15 times an rtol of
# 1e-11.
_CLOSE = 1e-13
OPENS = 1e-100  # a compression at which a contact is about to open, in any units


class Kinks(NamedTuple):
    """A contact's motion over a step, and where its force is not smooth.

    Parameters
    ----------
    curve : Curve
        The compression p.
    intervals : int
        Number of the intervals in which the force is smooth; their ends are in `Beads.edges`.
    top : float
        Greatest compression.
    jump : float
        Jump of the force for unit stiffness, or 0.
    """

    curve: Curve
    intervals: int
    top: float
    jump: float


class Integrals(NamedTuple):
    """Integrals over x of a contact's force F, for unit stiffness.

    Parameters
    ----------
    impulse, moment, third : float
        Integrals of ``F``, ``(1 - x) F`` and ``(1 - x)²/2 F``.
    work, driven : float
        Integrals of ``F p'``, and of ``F b'`` for the motion b of a driven bead.
    missed : float
        Error of the elastic force's work beside a driven bead, which the rule leaves.
    rough : float
        How far p is from a solution, for a damped or driven contact and for a force that jumps: the
        force, times its effect on p'', has parts of degrees 4 and 5 in Legendre's polynomials, and
        the second derivative of a quintic, a cubic, has none. The size of these parts, without
        those of the bend that p has besides.
    closed : float
        Length of the intervals in which the contact pushes.
    """

    impulse: float
    moment: float
    third: float
    work: float
    driven: float
    missed: float
    rough: float
    closed: float


@part
def stored(law: Any, d: float) -> float:
    """Return the elastic energy ``∫ F dδ``, from 0 to d, for unit stiffness; 0 if d is negative."""
    if not d > 0.0:
        return 0.0
    if law.generated:
        return float(call(law.energy, d))
    return float(elastic(law, d) * d / (law.k + 1.0))


@part
def bent(bend: Bend, x: float) -> tuple[float, float, float]:
    """Return a bend at x, its slope and its second derivative, ``s [x - e]_+^b``.

    The bend is the tuple of e, s and b; it is 0 up to the place e.
    """
    e, s, b = bend
    if s == 0.0 or not x > e:
        return 0.0, 0.0, 0.0
    late = x - e
    second = s * power(b, late)
    slope = second * late / (1.0 + b)
    return slope * late / (2.0 + b), slope, second


@part
def value_and_slope(c: Curve, x: float) -> tuple[float, float]:
    """Return ``p(x)`` and ``p'(x)`` of a curve c: a polynomial of c[0] … c[5], and a bend c[6]."""
    p = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))))
    slope = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))
    more, steeper, _ = bent(c[6], x)
    return p + more, slope + steeper


@part
def fitted_curve(
    start: State,
    end: State,
    bend: Bend,
) -> Curve:
    """Return the quintic with p, p' and p'' at both ends of the step, with a bend."""
    d = start[0]
    v = start[1]
    c2 = start[2] / 2
    b0, b1, b2 = bent(bend, 1.0)
    # c3, c4 and c5 solve the conditions at x = 1, of which the bend, d, v and c2 leave r0, r1, r2.
    r0 = end[0] - b0 - d - v - c2
    r1 = end[1] - b1 - v - 2 * c2
    r2 = end[2] - b2 - 2 * c2
    c3 = 10 * r0 - 4 * r1 + r2 / 2
    c4 = -15 * r0 + 7 * r1 - r2
    c5 = 6 * r0 - 3 * r1 + r2 / 2
    return d, v, c2, c3, c4, c5, bend


@part
def _margin(law: Any, r: float, c: Curve, h: float, x: float) -> float:
    """Return a continuous function of x which is positive where damping does not pull.

    With damping it is the force of a closed contact over ``r δ^p``, the factor of the rate dδ/dt in
    it: elastic force/(r δ^p) + rate; of an open contact the rate alone. Without damping, r = 0, the
    function is the compression.
    """
    p, slope = value_and_slope(c, x)
    if not r > 0.0:
        return p
    push_apart = max(elastic(law, p), 0.0) / (r * drag(law, p)) if p > 0.0 else 0.0
    return push_apart + slope / h


@alone
def _crossing(law: Any, r: float, c: Curve, h: float, a: float, b: float) -> float:
    """Return the place between a and b at which `_margin` changes its sign; for r = 0 p does.

    The places are within one of the `_PLACES` parts of a step, of which there are eight.
    """
    left = _margin(law, r, c, h, a)
    right = _margin(law, r, c, h, b)
    # The Illinois variant of the rule of false position. Sixty steps are a bound: bisection of an
    # eighth of a step comes to `_CLOSE` in 41.
    for _ in range(60):
        x = 0.5 * (a + b)
        if right != left:
            x = b - right * (b - a) / (right - left)
        if abs(x - b) < _CLOSE:
            return x
        middle = _margin(law, r, c, h, x)
        if middle * right < 0.0:
            a = b
            left = right
        else:
            left *= 0.5
        b = x
        right = middle
    return b


@part
def _turning_point(c: Curve, a: float, b: float) -> float:
    """Return the place between a and b at which the slope of p changes its sign.

    Thirty halvings leave 1e-9 of the interval, and p, flat there, errs by the square of it.
    """
    _, slope = value_and_slope(c, a)
    for _ in range(30):
        x = 0.5 * (a + b)
        _, middle = value_and_slope(c, x)
        if middle * slope > 0.0:
            a = x
        else:
            b = x
    return 0.5 * (a + b)


@part
def _state(
    law: Any, r: float, c: Curve, h: float, x: float
) -> tuple[float, float, float]:
    """Return p, p' and a number that is negative where damping would pull, at a place.

    The number is the `_margin` of a damped contact that does not stick, and 1 of any other.
    """
    p, slope = value_and_slope(c, x)
    margin = 1.0
    # The margin can be negative only where a closed contact expands.
    if r > 0.0 and not law.sticks and p > 0.0 and slope < 0.0:
        margin = _margin(law, r, c, h, x)
    return p, slope, margin


@alone
def _add_edges(
    law: Any,
    r: float,
    c: Curve,
    h: float,
    a: float,
    b: float,
    first: tuple[float, float, float],
    last: tuple[float, float, float],
    edges: Array,
    n: int,
) -> int:
    """Add the edges between a and b, where p has one root at most; return their number so far.

    first, last : `_state` of the contact at a and b: p, p' and the margin, which is negative where
    damping would pull. The margin has a root where damping begins or ceases.
    """
    closes = first[0] <= 0.0 and last[0] > 0.0
    opens = first[0] > 0.0 and last[0] <= 0.0
    root = b
    margin = first[2]
    end_margin = last[2]
    if closes or opens:
        root = _crossing(law, 0.0, c, h, a, b)
    if closes:
        edges[n] = a = root
        n += 1
        margin = 1.0  # at the root of p the margin is the rate, and δ rises
    if opens and r > 0.0 and not law.sticks:
        end_margin = -1.0  # the rate, and δ falls: damping ceased before the root
    if margin * end_margin < 0.0:
        edges[n] = _crossing(law, r, c, h, a, root if opens else b)
        n += 1
    if opens:
        edges[n] = root
        n += 1
    return n


@alone
def find_edges(
    law: Any, r: float, c: Curve, h: float, edges: Array
) -> tuple[int, float]:
    """Return the number of intervals of a step in which the force is smooth, and the greatest p.

    The places between the intervals, 0 and 1 among them, go to ``edges``.
    """
    n = FIRST + 1
    low = 0.0
    before = _state(law, r, c, h, 0.0)
    top = c[0]
    edges[0] = 0.0
    for m in range(1, _PLACES + 1):
        high = m / _PLACES
        after = _state(law, r, c, h, high)
        # States are p, p' and the margin (`_state`).
        same = (before[0] > 0.0) == (after[0] > 0.0)
        sign = 1.0 if before[0] > 0.0 else -1.0
        # A contact may open and close again between two places, or the reverse: p has one sign at
        # both, and comes nearer to 0 before it turns.
        if same and sign * before[1] < 0.0 and sign * after[1] > 0.0:
            turn = _turning_point(c, low, high)
            middle = _state(law, r, c, h, turn)
            n = _add_edges(law, r, c, h, low, turn, before, middle, edges, n)
            low = turn
            before = middle
            top = max(top, middle[0])
        if before[0] > 0.0 or after[0] > 0.0:
            n = _add_edges(law, r, c, h, low, high, before, after, edges, n)
        low = high
        before = after
        top = max(top, after[0])
    edges[n] = 1.0
    return n, top


@part
def _find_jump(
    law: Any, r: float, c: Curve, h: float, edges: Array, count: int
) -> Bend:
    """Return the last jump of the force: its place e, its size s and an exponent b.

    They are a `Bend` of p for a factor 1 from force to p''. A force that begins as ``r δ^b dδ/dt``
    with b < 1 almost jumps, and counts as a jump: near its beginning e, δ = p'(e) (x - e), so that
    it is ``s (x - e)^b``, ``s = r p'(e)^b p'(e)/h``. Other jumps have b = 0, and s = 0 is none.
    """
    found = 1.0, 0.0, 0.0
    for n in range(count):
        p, slope = value_and_slope(c, edges[n])
        # This edge is a root of p, within 1e-9 of a step; at others only damping begins or ceases.
        if abs(p) < 1e-9 * abs(slope):
            force = push(law, r, OPENS, slope / h)
            if slope > 0.0 and r > 0.0 and law.p > 0.0 and law.p < 1.0:
                found = edges[n], r * slope / h * drag(law, slope), law.p
            else:
                found = edges[n], force if slope > 0.0 else -force, 0.0
    return found


@alone
def resolved(
    law: Any,
    r: float,
    start: State,
    end: State,
    h: float,
    bend: float,
    guess: Bend,
    edges: Array,
) -> Kinks:
    """Return a contact's motion over a step, with the places at which its force is not smooth.

    A jump bends the curve where it is, and where it is depends on the curve: a second call with the
    bend that the first one found leaves no more than the quintic's own error.

    Parameters
    ----------
    law : record
        The law, a record of `validation.lattice.kernel.arrays.LAW`.
    r : float
        Damping coefficient over stiffness.
    start, end : tuple of float
        p, p' and p'' at both ends.
    h : float
        The step.
    bend : float
        Change of p'' by a force of 1.
    guess : Bend
        The curve's bend, as far as it is known; `STRAIGHT` at first.
    edges : array
        Room for the places of `find_edges`.
    """
    c = fitted_curve(start, end, guess)
    count, top = find_edges(law, r, c, h, edges)
    # The force changes by ``jump [x - place]_+^b``.
    place, jump, b = _find_jump(law, r, c, h, edges, count)
    # A jump that changes p' by less than 1e-12 of it counts as none. Between a driven bead and a
    # wall the force bends nothing, but its jump heats.
    if bend != 0.0 and abs(bend * jump) < 1e-12 * abs(start[1]):
        return Kinks(c, count, top, 0.0)
    c = fitted_curve(start, end, (place, bend * jump, b))
    count, top = find_edges(law, r, c, h, edges)
    return Kinks(c, count, top, jump)


@part
def _root(c: Curve, x: float, side: float) -> float:
    """Return the root of p near an end x of an interval, on its outer side (±1); NaN without one.

    p is the compression along the curve c; x, and lengths below, are in units of the step. The root
    is the z of the substitution ``x = z + (e - z) u^q``, e the far end of the interval, by which
    `integrals` makes the contact's force F(p), not smooth at p = 0, smooth in u (q by `LAW`). It
    shapes the places of the points alone, and need not be accurate: two steps of Newton's method
    are enough.
    """
    p, slope = value_and_slope(c, x)
    # The tangent's root is at x - p/slope. None is looked for if this is farther than 1.5 steps (a
    # root within one step is wanted; the half more is a margin, as p bends), or on the inner side.
    # A root within 1e-9 of a step is at x itself, but for rounding and the search (`_CLOSE`).
    if not abs(p) < 1.5 * abs(slope) or (
        side * p * slope > 0.0 and abs(p) > 1e-9 * abs(slope)
    ):
        return math.nan
    r = x - p / slope
    p, slope = value_and_slope(c, r)
    r = r - p / slope if slope != 0.0 else math.nan
    off = side * (r - x)
    if off > -1e-9 and off < 1.0:
        return max(r, x) if side > 0.0 else min(r, x)
    return math.nan


@part
def _place_points(
    q: float, zero: float, near: float, far: float, points: Array
) -> None:
    """Place Gauss's rule in u between near and far; x = zero + (far - zero) u^q, q = 1 or 4.

    The places x go to row 0 of ``points``, their weights in an integral over x to row 1.
    """
    span = far - zero
    start = (near - zero) / span
    if q == 4.0:
        start = math.sqrt(math.sqrt(start))
    scale = abs(span) * (1.0 - start)
    for m in range(index(POINTS)):
        u = start + (1.0 - start) * _U[m]
        # The derivative q u^{q-1} of u^q
        pace = 4.0 * u * u * u if q == 4.0 else 1.0
        points[0, m] = zero + span * u * pace / q
        points[1, m] = scale * _W[m] * pace


@part
def _legendre(x: float) -> tuple[float, float]:
    """Return the values at x of Legendre's polynomials of degrees 4 and 5 on 0 … 1."""
    t = 2.0 * x - 1.0
    second = 1.5 * t * t - 0.5
    third = (5.0 * t * second - 2.0 * t) / 3.0
    fourth = (7.0 * t * third - 3.0 * second) / 4.0
    return fourth, (9.0 * t * fourth - 4.0 * third) / 5.0


@alone
def integrals(
    law: Any,
    r: float,
    found: Kinks,
    h: float,
    until: float,
    bend: float,
    points: Array,
    edges: Array,
    driven: bool,
    bead: Curve,
) -> Integrals:
    """Return the integrals of a contact's force over a step up to ``x = until``.

    Parameters
    ----------
    law : record
        The law, a record of `validation.lattice.kernel.arrays.LAW`.
    r : float
        Damping coefficient over stiffness.
    found : Kinks
        The contact's motion.
    h : float
        The step.
    until : float
        End of the integrals.
    bend : float
        Change of p'' by a force of 1.
    points, edges : array
        Working memory, and the places that belong to ``found``.
    driven : bool
        True for the contact of a driven bead.
    bead : Curve
        The motion of the driven bead.
    """
    c = found.curve
    # Places and weights of Gauss's rule (`_place_points`)
    x = points[0]
    w = points[1]
    once = twice = third = work = given = even = odd = closed = 0.0
    held = missed = 0.0
    for n in range(found.intervals):
        a = edges[n]
        b = edges[n + 1]
        p, slope = value_and_slope(c, 0.5 * (a + b))
        # Idle: the contact does not push in this interval, and c[6][1], the bend of p, is 0.
        idle = push(law, r, p, slope / h) == 0.0 and c[6][1] == 0.0
        if idle or not a < min(b, until):
            continue
        low = _root(c, a, -1.0)
        high = _root(c, b, 1.0)
        b = min(b, until)
        closed += b - a
        # The rule is made for one root of p, where F is not smooth. With a root at both ends of the
        # interval each half has its own rule; with one root, or none, one rule takes all of it.
        middle = 0.5 * (a + b)
        if math.isnan(low) and (slope < 0.0 or not math.isnan(high)):
            middle = a
        elif math.isnan(high):
            middle = b
        for near, far, zero in ((a, middle, low), (b, middle, high)):
            start = near
            steepness = law.k
            while start != far:
                # A steep force pushes near the far end alone: that half is halved again.
                end = far
                if steepness > _STEEP:
                    end = 0.5 * (start + far)
                    steepness *= 0.5
                if math.isnan(zero):
                    _place_points(1.0, start, start, end, points)
                else:
                    _place_points(law.q, zero, start, end, points)
                for m in range(index(POINTS)):
                    p, slope = value_and_slope(c, x[m])
                    force = w[m] * push(law, r, p, slope / h)
                    left = 1.0 - x[m]
                    once += force
                    twice += left * force
                    third += 0.5 * left * left * force
                    work += slope * force
                    # What the force does to p'', less the second derivative of the bend that p has
                    # besides its quintic, times Legendre's polynomials.
                    if r > 0.0 or driven or found.jump != 0.0:
                        _, _, known = bent(c[6], x[m])
                        fourth, fifth = _legendre(x[m])
                        even += fourth * (bend * force - w[m] * known)
                        odd += fifth * (bend * force - w[m] * known)
                    if driven:
                        given += value_and_slope(bead, x[m])[1] * force
                        held += w[m] * slope * elastic(law, p)
                start = end
        if driven:
            # The elastic force is known to have done this work.
            p, _ = value_and_slope(c, a)
            end_p, _ = value_and_slope(c, b)
            missed += abs(held - (stored(law, end_p) - stored(law, p)))
            held = 0.0
    # ``even`` and ``odd`` are the parts of degrees 4 and 5 that p'' lacks. At some places of a kink
    # the part of degree 4 is 0 and that of degree 5 is not; the latter changes p half as much.
    rough = math.hypot(even, 0.5 * odd)
    return Integrals(once, twice, third, work, given, missed, rough, closed)
