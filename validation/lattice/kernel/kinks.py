"""Integrals of a contact's force over a step in which the contact opens or closes.

F has no derivative of order k + 1 where a contact opens or closes, and a quadrature that does not
know the place errs by O(h^{k+1}). Over the step, x = 0 … 1, the compression is close to the quintic
p(x) with the values of δ, δ' and δ'' at both ends. `integrals` integrates F(p, p') over the
intervals in which the contact pushes (`find_intervals`), for unit stiffness, by Gauss's rule in u,
x = z + (e - z) u^q, z the root of p at one end of the interval and e the other end, so that F is
smooth in u.

A damped contact that is pulled open can stop pushing before it parts: the force tells, not δ.
"""

from __future__ import annotations

import math

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Law
from validation.lattice.kernel.compiled import call, index, part, summed

Quintic = tuple[float, float, float, float, float, float]
"""Coefficients c0 … c5 of p."""

POINTS = 12  # of the rule: three of the machine's vectors
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(POINTS)
_U, _W = (1 + _NODES) / 2, _WEIGHTS / 2
_PLACES = 8  # parts of a step at whose ends a contact is looked at


@part
def elastic(law: Law, d: float) -> float:
    """Return the elastic force F(d) at a compression d ≥ 0."""
    if law.generated:
        return float(call(law.force, d))
    return float(d * np.sqrt(d) if law.k == 1.5 else (d if law.k == 1.0 else d**law.k))


@part
def drag(law: Law, d: float) -> float:
    """Return the factor d^p of r dδ/dt in the damping force, at a compression d ≥ 0."""
    if law.p == 0.0:
        return 1.0
    if law.p == 0.25:  # of a constant coefficient of restitution of Hertzian contacts
        return float(np.sqrt(np.sqrt(d)))
    return float(np.sqrt(d) if law.p == 0.5 else d**law.p)


@part
def push(law: Law, r: float, d: float, rate: float) -> float:
    """Return the force at a compression d and a rate dδ/dt; contacts do not pull."""
    if not d > 0.0:
        return 0.0
    return (
        max(elastic(law, d) + r * drag(law, d) * rate, 0.0)
        if r > 0.0
        else elastic(law, d)
    )


@part
def pushes(law: Law, r: float, d: float, rate: float) -> bool:
    """Return True if a contact has a force at a compression d and a rate dδ/dt."""
    return d > 0.0 and (not r > 0.0 or elastic(law, d) + r * drag(law, d) * rate > 0.0)


@part
def stored(law: Law, d: float) -> float:
    """Return the elastic energy; 0 for d ≤ 0."""
    if not d > 0.0:
        return 0.0
    return (
        float(call(law.energy, d))
        if law.generated
        else elastic(law, d) * d / (law.k + 1.0)
    )


@part
def value_and_slope(c: Quintic, x: float) -> tuple[float, float]:
    """Return p(x) and p'(x)."""
    p = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))))
    return p, c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))


@part
def fitted_quintic(
    d: float, v: float, a: float, end: float, end_v: float, end_a: float
) -> Quintic:
    """Return the quintic of value d, slope v, second derivative a at 0; end, end_v, end_a at 1."""
    c2 = a / 2
    # c3, c4 and c5 solve the conditions at x = 1, of which d, v and c2 leave r0, r1 and r2.
    r0, r1, r2 = end - d - v - c2, end_v - v - 2 * c2, end_a - 2 * c2
    return (
        d,
        v,
        c2,
        10 * r0 - 4 * r1 + r2 / 2,
        -15 * r0 + 7 * r1 - r2,
        6 * r0 - 3 * r1 + r2 / 2,
    )


@part
def _margin(law: Law, r: float, c: Quintic, h: float, x: float, closing: bool) -> float:
    """Return a continuous function of x which is positive where the contact pushes.

    closing : True for a contact that closes; otherwise the contact ends to push, or pushes again.
    """
    p, slope = value_and_slope(c, x)
    if closing or not r > 0.0:
        return p
    return (elastic(law, p) / (r * drag(law, p)) if p > 0.0 else 0.0) + slope / h


@part
def change(
    law: Law, r: float, c: Quintic, h: float, a: float, b: float, closing: bool
) -> float:
    """Return the place between a and b at which the contact begins or ends to push."""
    # A contact that pushes again before it has parted does so by its force.
    closing = closing and not value_and_slope(c, a)[0] > 0.0
    left, right = _margin(law, r, c, h, a, closing), _margin(law, r, c, h, b, closing)
    for _ in range(60):  # the Illinois variant of the rule of false position
        x = b - right * (b - a) / (right - left) if right != left else 0.5 * (a + b)
        if (
            abs(x - b) < 1e-13
        ):  # at 1e-10 the energy lost errs by 15 times an rtol of 1e-11
            return x
        middle = _margin(law, r, c, h, x, closing)
        if middle * right < 0.0:
            a, left = b, right
        else:
            left *= 0.5
        b, right = x, middle
    return b


@part
def _root(c: Quintic, x: float, side: float) -> float:
    """Return the root of p near an end x of an interval, on its outer side (±1); NaN without one.

    The root shapes the substitution alone: two steps of Newton's method are enough.
    """
    p, slope = value_and_slope(c, x)
    # No root within a step of x, or on the inner side.
    if not abs(p) < 1.5 * abs(slope) or (
        side * p * slope > 0.0 and abs(p) > 1e-9 * abs(slope)
    ):
        return math.nan
    r = x - p / slope
    p, slope = value_and_slope(c, r)
    r = r - p / slope if slope != 0.0 else math.nan
    off = side * (r - x)
    if off > -1e-9 and off < 1.0:
        return x if off < 0.0 else r
    return math.nan


@summed
def forces_along(law: Law, r: float, c: Quintic, h: float, x: Array, f: Array) -> None:
    """Compute the forces of a contact with the compression p at places x; they go to f."""
    if law.k == 1.5 and law.p in (0.0, 0.25, 0.5) and not law.generated:  # vectorises
        for m in range(index(len(x))):
            p, slope = value_and_slope(c, x[m])
            d = p if p > 0.0 else 0.0
            root = np.sqrt(d)
            resistance = (
                root if law.p == 0.5 else (1.0 if law.p == 0.0 else np.sqrt(root))
            )
            force = d * root + r * resistance * slope / h
            f[m] = force if (force > 0.0) & (p > 0.0) else 0.0
    else:
        for m in range(index(len(x))):
            p, slope = value_and_slope(c, x[m])
            f[m] = push(law, r, p, slope / h)


@part
def _summit(c: Quintic, a: float, b: float) -> float:
    """Return the place of the maximum of p between a and b, where p first rises and then falls."""
    for _ in range(30):
        x = 0.5 * (a + b)
        a, b = (x, b) if value_and_slope(c, x)[1] > 0.0 else (a, x)
    return 0.5 * (a + b)


@part
def find_intervals(
    law: Law, r: float, c: Quintic, h: float, points: Array
) -> tuple[int, float]:
    """Return the number of intervals of a step in which the contact pushes, and the greatest p.

    F(p, p'/h) is the force of a contact whose compression is the quintic with coefficients c.
    Begins, ends, and the roots at both go to rows 4 … 7 of ``points``.
    """
    count, start, top, before, rise = 0, 0.0, c[0], c[0], c[1]
    pushed = pushes(law, r, before, rise / h)
    for m in range(1, _PLACES + 1):
        low, high = (m - 1) / _PLACES, m / _PLACES
        p, slope = value_and_slope(c, high)
        now = pushes(law, r, p, slope / h)
        # A contact can close, and open or cease to push, between two places.
        within, peak = (
            not now and before <= 0.0 and rise > 0.0 and (p > 0.0 or slope < 0.0),
            high,
        )
        if within and not p > 0.0:
            peak = _summit(c, low, high)
            deepest, _ = value_and_slope(c, peak)
            within, top = deepest > 0.0, max(top, deepest)
        if within or (now and not pushed):
            start = change(law, r, c, h, low, peak, True)
        opens = within or (pushed and not now)
        if opens or (now and m == _PLACES):
            end = 1.0
            if opens:
                first = low if pushed else (start if p > 0.0 else peak)
                end = change(law, r, c, h, first, high, False)
            points[4, count], points[5, count] = start, end
            points[6, count] = (
                start if start > 0.0 and not r > 0.0 else _root(c, start, -1.0)
            )
            points[7, count] = end if end < 1.0 and not r > 0.0 else _root(c, end, 1.0)
            count += 1
        pushed, before, rise, top = now, p, slope, max(top, p)
    return count, top


@summed
def integrals(
    law: Law, r: float, c: Quintic, h: float, until: float, count: int, points: Array
) -> tuple[float, float, float, float]:
    """Return ∫ F, ∫ (1 - x) F, ∫ (1 - x)²/2 F and ∫ F p' over a step up to x = until.

    The intervals in which the contact pushes are those of `find_intervals`, ``count`` of them.
    """
    x, w, f = points[0], points[1], points[2]
    once = twice = third = work = 0.0
    for n in range(count):
        a, b, low, high = (
            points[4, n],
            min(points[5, n], until),
            points[6, n],
            points[7, n],
        )
        if not a < b:
            continue
        middle = b if math.isnan(high) else (a if math.isnan(low) else 0.5 * (a + b))
        for near, far, root in ((a, middle, low), (b, middle, high)):
            if near == far:
                continue
            q, zero = (1.0, near) if math.isnan(root) else (law.q, root)
            span = far - zero
            start = (near - zero) / span
            if q > 1.0:
                start = np.sqrt(start) if q == 2.0 else np.sqrt(np.sqrt(start))
            scale = abs(span) * (1.0 - start)
            for m in range(index(len(x))):
                u = start + (1.0 - start) * _U[m]
                pace = 1.0 if q == 1.0 else (2.0 * u if q == 2.0 else 4.0 * u * u * u)
                x[m], w[m] = zero + span * u * pace / q, scale * _W[m] * pace
            forces_along(law, r, c, h, x, f)
            for m in range(index(len(x))):
                force, left = w[m] * f[m], 1.0 - x[m]
                once += force
                twice += left * force
                third += 0.5 * left * left * force
                work += value_and_slope(c, x[m])[1] * force
    return once, twice, third, work
