"""A step of an embedded, adaptive Runge–Kutta–Nyström pair, corrected for kinks.

b, b', e, e' are the pair's coefficients (`validation.lattice.schemes`). h is the step, and
x = 0 … 1 the time within the step. p is a quintic close to a contact's compression, p_+ = max(p, 0)
(`validation.lattice.kernel.kinks`). The impulse of a contact in a step is ∫ F dt, its moment
h² ∫ (1 - x) F dx: they change the velocities and the displacements of its two beads.
"""

from __future__ import annotations

import math
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import WIDTH, Beads, Chain, Plan, Tableau
from validation.lattice.kernel.compiled import ONE, THREE, TWO, ZERO, index, part, summed
from validation.lattice.kernel.force import contact_forces, drive_motion, interval, power
from validation.lattice.kernel.kinks import (
    NEAR,
    Quintic,
    fitted_compression,
    kink,
    kink_integrals,
    meeting,
    quintic,
    summit,
)

_SLIGHT = 10.0  # least effect of a contact that is corrected, in units of the tolerance
# Step-size control of Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.4.
# An error scales as h^{lower + 1}. The next step is _SAFETY times the step with an error equal to
# the tolerance, as a rejected step costs as much as an accepted one. _GROWTH bounds the effect of
# an error that is small by chance, _SHRINKAGE that of an error too large for the power. Measured on
# nine scenes at 1e-6 … 1e-10: the work for the same error is the same to 4 % for a safety of 0.8 to
# 0.95 and a growth of 1.5 to 10; a safety of 0.7 costs 8 % more, 0.98 costs 11 % more.
_SAFETY, _GROWTH, _SHRINKAGE = 0.9, 5.0, 0.1
_HOPELESS = 1e9  # in units of the tolerance: the power says nothing of such an error


@part
def _add_up(
    sums: Array, q: Any, force: Array, row: Array, scale: float, stages: int, hi: int
) -> None:
    """Compute a weighted sum of forces, sums[q] = scale Σ_j row[j] force[j], 0 ≤ j < ``stages``."""
    for first in range(0, stages, WIDTH):
        a, b, c = scale * row[first], scale * row[first + 1], scale * row[first + 2]
        d, e = scale * row[first + 3], scale * row[first + 4]
        j = index(first)
        j1, j2, j3, j4 = j + ONE, j + index(2), j + index(3), j + index(4)
        for i in range(ONE, index(hi) + ONE):
            four = a * force[j, i] + b * force[j1, i] + c * force[j2, i] + d * force[j3, i]
            five = four + e * force[j4, i]
            sums[q, i] = five if first == 0 else sums[q, i] + five


@summed
def squared_error(sums: Array, inverse: Array, hi: int) -> float:
    """Return the sum of squares of the beads' errors, in units of the tolerances."""
    total = 0.0
    for i in range(index(hi)):
        y = (sums[TWO, i] - sums[TWO, i + ONE]) * inverse[i]
        v = (sums[THREE, i] - sums[THREE, i + ONE]) * inverse[i]
        total += y * y + v * v
    return total


@part
def _attempt(chain: Chain, beads: Beads, plan: Plan, t: float, h: float, hi: int) -> float:
    """Try a step of the beads 0 … hi-1 at time t; return the error in units of the tolerance."""
    stages = len(plan.scheme.nodes)
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    inverse, rest, force, sums = chain.inverse, chain.rest, beads.force, beads.sums
    rows, ends, nodes = plan.scheme.rows, plan.scheme.ends, plan.scheme.nodes
    drive, n, speed = chain.drive, interval(chain.drive, t + h / 2), 0.0
    for s in range(1, stages):
        _add_up(sums, ZERO, force, rows[s], h * h, s, hi)
        ch = nodes[s] * h
        behind = 0.0
        for i in range(index(hi)):
            ahead = sums[ZERO, i + ONE]
            next_y[i] = y[i] + ch * v[i] + (behind - ahead) * inverse[i]
            behind = ahead
        if drive.driven:
            next_y[0], speed, beads.given[1] = drive_motion(drive, n, t + ch)
        contact_forces(chain, beads, plan, next_y, index(s), hi)
        beads.power[1, s] = speed * force[s, 1]
    _add_up(sums, ONE, force, ends[0], h, stages, hi)
    _add_up(sums, TWO, force, ends[1], h * h / plan.y, stages, hi)
    _add_up(sums, THREE, force, ends[2], h / plan.v, stages, hi)
    for i in range(index(hi)):
        next_v[i] = v[i] + (sums[ONE, i] - sums[ONE, i + ONE]) * inverse[i]
    if drive.driven:
        next_v[0] = speed
    beads.given[2] = beads.given[3] = 0.0
    # Mark contacts that open or close within the step or near it, with a force that matters.
    # A compression δ changes a velocity by at most h A δ^k/m in a step.
    least = (_SLIGHT * plan.v / (h * plan.quickest)) ** (1.0 / chain.k)
    near, share = 0, 1.0
    for i in range(index(hi)):
        before = rest[i] + y[i] - y[i + ONE]
        after = rest[i] + next_y[i] - next_y[i + ONE]
        most = max(before, after)
        kinked = (most > least) & (min(before, after) < NEAR * most)
        sums[ZERO, i + ONE] = most if kinked else 0.0
        near += 1 if kinked else 0
    if plan.accelerated:
        for i in range(index(hi)):
            before = rest[i] + y[i] - y[i + ONE]
            after = rest[i] + next_y[i] - next_y[i + ONE]
            nearing, parting = h * (v[i] - v[i + ONE]), h * (next_v[i + ONE] - next_v[i])
            hidden = meeting(before, after, nearing, parting)
            sums[ZERO, i + ONE] = -1.0 if hidden else sums[ZERO, i + ONE]
            near += 1 if hidden else 0
    if near > 0:
        for i in range(hi):
            if sums[0, i + 1] > 0.0 and plan.scheme.points.shape[1] > 0:
                _correct_contact(chain, beads, plan, h, i)
            elif sums[0, i + 1] < 0.0 and chain.A[i] > 0.0:
                share = min(share, _hidden_contact(chain, beads, h, stages - 1, i, least))
    missed = (h * _integral(ends[2], beads.power[1]) - beads.given[3]) / plan.energy
    error = math.sqrt(squared_error(sums, inverse, hi) + missed * missed)
    # The error of which the rule of the next step makes ``share`` of this step.
    return max(error, (_SAFETY / share) ** (plan.scheme.lower + 1.0)) if share < 1.0 else error


@summed
def _hidden_contact(chain: Chain, beads: Beads, h: float, last: int, i: int, least: float) -> float:
    """Return the share of a step after which contact i, open at both ends, is compressed most.

    Returns 1 if the quintic fit of its compression nowhere exceeds ``least``. No stage need meet
    such a contact, so that the error does not tell: the step has to be shortened, to at most its
    half.
    """
    c, _ = fitted_compression(chain, beads, h, last, i)
    x = summit(c)
    return min(x, 0.5) if quintic(c, x) > least else 1.0


@summed
def _integral(row: Array, power: Array) -> float:
    """Return Σ row[s] power[s] over the stages s."""
    total = 0.0
    for s in range(len(row)):
        total += row[s] * power[s]
    return total


@part
def _correct_contact(chain: Chain, beads: Beads, plan: Plan, h: float, i: int) -> None:
    """Correct a step for the embedded pair's error at contact i, which opens or closes.

    Replaces the pair's integrals of A p_+^k by accurate ones; the pair's integral of the remaining
    force F - A p_+^k, which is smoother, remains.
    """
    inverse, scheme = chain.inverse, plan.scheme
    p, end = fitted_compression(chain, beads, h, len(scheme.nodes) - 1, i)
    factored = kink(p, end)
    if math.isnan(factored[0]):
        return
    # From the root to the step's end less from the root to its start; ∫ (1 - x) = ∫ (0 - x) + ∫ 1.
    twice, once = kink_integrals(chain, scheme.points, factored, 1.0)
    start_twice, start_once = kink_integrals(chain, scheme.points, factored, 0.0)
    pair_twice, pair_once, error, error_once = _pair_sums(chain, scheme, p)
    impulse = chain.A[i] * h * (once - start_once - pair_once)
    moment = chain.A[i] * h * h * (twice - start_twice - start_once - pair_twice)
    # The correction moves the contact by e ~ u^{k+2} from the root on, so that p is not quite its
    # compression: where ∫ k A p^{k-1} e counts, the pair's own estimate is the better judge.
    most = max(p[0], end)
    stiff = chain.k * chain.A[i] * power(chain, most) / most
    apart = (inverse[i] + inverse[i + 1]) * abs(moment)
    if h * stiff * apart * max(inverse[i], inverse[i + 1]) > (2.0 * chain.k + 2.0) * plan.v:
        return
    beads.next_v[i] -= impulse * inverse[i]
    beads.next_v[i + 1] += impulse * inverse[i + 1]
    beads.next_y[i] -= moment * inverse[i]
    beads.next_y[i + 1] += moment * inverse[i + 1]
    if i == 0:  # ∫ ΔF v dt with v = next_v - (1 - x) h a
        beads.given[2] = impulse * beads.next_v[0] - moment * beads.given[1]
        beads.given[3] = chain.A[0] * h * error_once * beads.next_v[0]
    beads.sums[2, i + 1] -= chain.A[i] * h * h * error / plan.y
    beads.sums[3, i + 1] -= chain.A[i] * h * error_once / plan.v


@summed
def _pair_sums(chain: Chain, scheme: Tableau, p: Quintic) -> tuple[float, float, float, float]:
    """Return the embedded pair's ∫ (1 - x) p_+^k dx and ∫ p_+^k dx over a step, and both errors.

    The four numbers are sums over the stages with the coefficients b, b', e and e'.
    """
    nodes, last = scheme.nodes, len(scheme.nodes) - 1
    once = twice = error = error_once = 0.0
    for s in range(last + 1):
        f = power(chain, quintic(p, nodes[s]))
        once += scheme.ends[0, s] * f
        twice += scheme.rows[last, s] * f
        error += scheme.ends[1, s] * f
        error_once += scheme.ends[2, s] * f
    return twice, once, error, error_once


@part
def accepted(chain: Chain, beads: Beads, plan: Plan, now: Any, h: float, hi: int) -> bool:
    """Try a step, set the next step from the error, and return True if the step is accepted."""
    error = _attempt(chain, beads, plan, now.t, h, hi)
    root = -1.0 / (plan.scheme.lower + 1)
    if not error <= 1.0:  # NaN included
        hopeless = not error < _HOPELESS
        now.h = h * (_SHRINKAGE if hopeless else max(_SHRINKAGE, _SAFETY * error**root))
        now.planned = 0.0
        if hopeless:
            beads.force[1:] = 0.0  # overflows must not last
        return False
    for i in range(index(hi)):
        beads.y[i], beads.v[i] = beads.next_y[i], beads.next_v[i]
    now.work += h * _integral(plan.scheme.ends[0], beads.power[1]) + beads.given[2]
    now.response = max(now.response, now.energy + now.work)
    beads.given[0] = beads.given[1]
    grow = h * min(_GROWTH, _SAFETY * max(error, 1e-9) ** root)
    now.h, now.planned = min(plan.longest, max(grow, now.planned)), 0.0
    return True
