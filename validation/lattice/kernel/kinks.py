"""Kinks of the force, where a contact opens or closes in a step or near it, and their integrals.

F = A δ^k has no derivative of order k + 1 at a kink. Over the step, x = 0 … 1, the compression δ is
approximated by the quintic p(x) with the values of δ, δ' and δ'' at both ends. If p has exactly one
root r near the step, p = (x - r) q(x), and the integral of p_+^k = |x - r|^k |q|^k over the closed
side is computed by Gauss–Jacobi quadrature, to which the kink costs no accuracy.
"""

from __future__ import annotations

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Beads, Chain
from validation.lattice.kernel.compiled import part, summed
from validation.lattice.kernel.force import power, relative_acceleration

Quintic = tuple[float, float, float, float, float, float]
"""Coefficients of p; for a kink the root r, then the five coefficients of q."""

NEAR = 0.5  # a kink is near if δ at one end of a step is less than NEAR times δ at the other end
FAR = 1.0  # greatest distance of a kink from the step, in steps
_EVEN = 0.2  # least q over the step divided by the greatest
NONE: Quintic = (float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0)


@part
def quintic(c: Quintic, x: float) -> float:
    """Return the value at x of the quintic with coefficients c."""
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))))


@part
def fitted_quintic(d: float, v: float, a: float, end: float, end_v: float, end_a: float) -> Quintic:
    """Return the quintic of value d, slope v, second derivative a at 0; end, end_v, end_a at 1."""
    c2 = a / 2
    # c3, c4 and c5 solve the conditions at x = 1, of which d, v and c2 leave r0, r1 and r2.
    r0, r1, r2 = end - d - v - c2, end_v - v - 2 * c2, end_a - 2 * c2
    return (d, v, c2, 10 * r0 - 4 * r1 + r2 / 2, -15 * r0 + 7 * r1 - r2, 6 * r0 - 3 * r1 + r2 / 2)


@part
def fitted_compression(
    chain: Chain, beads: Beads, h: float, last: int, i: int
) -> tuple[Quintic, float]:
    """Return the quintic fit p of contact i's compression over a step, and p(1).

    last : the stage at the step's end.
    """
    y, v, force, inverse = beads.y, beads.v, beads.force, chain.inverse
    d = chain.rest[i] + y[i] - y[i + 1]
    end = chain.rest[i] + beads.next_y[i] - beads.next_y[i + 1]
    speed, later = h * (v[i] - v[i + 1]), h * (beads.next_v[i] - beads.next_v[i + 1])
    a = h * h * relative_acceleration(force[0], inverse, i)
    end_a = h * h * relative_acceleration(force[last], inverse, i)
    if i == 0:
        a, end_a = a + h * h * beads.given[0], end_a + h * h * beads.given[1]
    return fitted_quintic(d, speed, a, end, later, end_a), end


@part
def summit(c: Quintic) -> float:
    """Return the place of the greatest value of a quintic that rises at 0 and falls at 1."""
    low, high = 0.0, 1.0
    for _ in range(30):
        x = 0.5 * (low + high)
        slope = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))
        low, high = (x, high) if slope > 0.0 else (low, x)
    return low


@part
def meeting(before: float, after: float, nearing: float, parting: float) -> bool:
    """Return True if a contact that is open at both ends of a step may close and open within it.

    before, after : compressions. nearing, parting : rates at which the beads approach each other at
    the beginning and part at the end, times the step. The tangents then meet at δ > 0.
    """
    above = before * parting + (after + parting) * nearing > 0.0
    return (max(before, after) <= 0.0) & (nearing > 0.0) & (parting > 0.0) & above


@part
def kink(c: Quintic, end: float) -> Quintic:
    """Return the root r of a quintic p and the coefficients of q in p = (x - r) q(x).

    c : coefficients of p. end : p(1). Returns `NONE` if p has no root within `FAR` steps of the
    step, or if q varies too much for the quadrature.
    """
    rising = end > c[0]
    low, high, x = 0.0, 1.0, c[0] / (c[0] - end)
    if c[0] * end >= 0.0:
        low, high = (-FAR, 0.0) if rising else (1.0, 1.0 + FAR)
        if quintic(c, low if rising else high) >= 0.0:
            return NONE
    for _ in range(30):  # Newton's method, or bisection where it leaves the interval
        p = quintic(c, x)
        slope = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))
        low, high = (low, x) if (p > 0.0) == rising else (x, high)
        guess = x - p / slope
        guess = guess if low < guess < high else (low + high) / 2
        x, moved = guess, abs(guess - x)
        if moved < 1e-9:  # the remaining error is of the order of its square
            break
    # Horner's scheme gives the quotient q of p and x - r.
    q3 = c[4] + x * c[5]
    q2 = c[3] + x * q3
    q1 = c[2] + x * q2
    q0 = c[1] + x * q1
    sign = 1.0 if rising else -1.0
    start, finish = sign * q0, sign * (q0 + q1 + q2 + q3 + c[5])
    root = sign * (q0 + x * (q1 + x * (q2 + x * (q3 + x * c[5]))))
    if not min(start, finish, root) >= _EVEN * max(start, finish, root):
        return NONE
    return x, q0, q1, q2, q3, c[5]


@summed
def kink_integrals(chain: Chain, points: Array, p: Quintic, z: float) -> tuple[float, float]:
    """Return ∫ (z - x) p_+^k dx and ∫ p_+^k dx from the root r of p to z, for p = (x - r) q(x).

    p : r and the coefficients of q; both integrals of `NONE` are 0. points : nodes and weights of
    ∫ u^k f(u) du from 0 to 1. With x = r + (z - r) u, p_+^k is u^k times a smooth function.
    """
    side = z - p[0]
    if not side * p[1] > 0.0:  # open from r to z, or `NONE`
        return 0.0, 0.0
    once = twice = 0.0
    for m in range(points.shape[1]):
        u = points[0, m]
        x = p[0] + side * u
        q = p[1] + x * (p[2] + x * (p[3] + x * (p[4] + x * p[5])))
        f = points[1, m] * power(chain, side * q)
        once += f
        twice += f * (1.0 - u)
    return side * side * twice, side * once
