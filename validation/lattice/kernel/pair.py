"""A step of an embedded Runge–Kutta–Nyström pair, corrected for kinks.

h is the step, and x = 0 … 1 the time within the step. The impulse of a contact in a step is
h ∫ F dx, its moment h² ∫ (1 - x) F dx: they change the velocities and the displacements of its two
beads. At a contact that opens or closes, the pair's quadratures of F(p, p'/h), with a quintic p
close to the contact's compression, are replaced by accurate integrals
(`validation.lattice.kernel.kinks`).

The stages lack these corrections: the forces of the contact and its neighbours are computed at
displacements that err by the moment so far, and at velocities that err by the impulse. Over a step
this changes their impulses by stiffness × h³ ∫ (1 - x)²/2 F dx, and by damping × moment. The
neighbours are corrected for it once more, and this second correction counts as error.
"""

from __future__ import annotations

import math
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import TILE, Beads, Chain, Plan
from validation.lattice.kernel.compiled import ONE, ZERO, index, inlined, part, summed
from validation.lattice.kernel.force import (
    contact_forces,
    drive_motion,
    stiffness,
    tile_bounds,
)

_SLIGHT = 10.0  # least effect of a contact that is corrected, in units of the tolerance
# A contact is nearly open at a step's one end if δ there is less than _NEAR times δ at the other. A
# weak contact, whose force is less than _STRONG times the least that counts, is nearly open below
# _VERY_NEAR, as the pair's own error is smaller there. Measured: _NEAR for all takes a tenth more
# time for equal beads, _VERY_NEAR for all a quarter more for dimers at small tolerances.
_NEAR, _VERY_NEAR, _STRONG = 0.3, 0.03, 1e3
_JUMP = 0.25  # least effect of a jump at which a step ends, in units of the tolerance
# Step-size control of Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.4.
# An error scales as h^{lower + 1}. The next step is _SAFETY times the step with an error equal to
# the tolerance, as a rejected step costs as much as an accepted one. _GROWTH bounds the effect of
# an error that is small by chance, _SHRINKAGE that of an error too large for the power. Measured on
# nine scenes at 1e-6 … 1e-10: the work for the same error is the same to 4 % for a safety of 0.8 to
# 0.95 and a growth of 1.5 to 10; a safety of 0.7 costs 8 % more, 0.98 costs 11 % more.
_SAFETY, _GROWTH, _SHRINKAGE = 0.9, 5.0, 0.1
_HOPELESS = (
    1e9  # in units of the tolerance: the power says nothing of such an error, or of NaN
)


@part
def _add_up(
    sums: Array,
    q: Any,
    force: Array,
    row: Array,
    scale: float,
    stages: int,
    lo: int,
    hi: int,
) -> None:
    """Compute a weighted sum of forces, sums[q] = scale Σ_j row[j] force[j], 0 ≤ j < ``stages``."""
    # One pass over four rows or over all nine: the weights of stages that are still to come are 0.
    a, b, c, d = scale * row[0], scale * row[1], scale * row[2], scale * row[3]
    if stages <= 4:
        for i in range(index(lo) + ONE, index(hi) + ONE):
            first = a * force[ZERO, i] + b * force[ONE, i]
            sums[q, i] = first + (c * force[index(2), i] + d * force[index(3), i])
        return
    e, f, g = scale * row[4], scale * row[5], scale * row[6]
    k, m = scale * row[7], scale * row[8]
    for i in range(index(lo) + ONE, index(hi) + ONE):
        first = a * force[ZERO, i] + b * force[ONE, i] + c * force[index(2), i]
        second = (
            d * force[index(3), i] + e * force[index(4), i] + f * force[index(5), i]
        )
        third = g * force[index(6), i] + k * force[index(7), i] + m * force[index(8), i]
        sums[q, i] = first + second + third


@summed
def _integral(row: Array, power: Array) -> float:
    """Return Σ row[s] power[s] over the stages s."""
    total = 0.0
    for s in range(index(len(row))):
        total += row[s] * power[s]
    return total


@part
def _fitted(
    chain: Chain, beads: Beads, h: float, last: int, i: int, opened: bool
) -> kinks.Quintic:
    """Return the quintic fit of contact i's compression over a step.

    last : the stage at the step's end. opened : True for a fit without the contact's own force at
    the end.
    """
    y, v, f, inverse, rest = beads.y, beads.v, beads.force, chain.inverse, chain.rest
    end = rest[i] + beads.next_y[i] - beads.next_y[i + 1]
    end_rate = beads.next_v[i] - beads.next_v[i + 1]
    own = (
        0.0 if opened else chain.A[i] * kinks.push(chain.law, chain.r[i], end, end_rate)
    )
    own -= chain.load[i]
    a = (f[0, i] - f[0, i + 1]) * inverse[i] - (f[0, i + 1] - f[0, i + 2]) * inverse[
        i + 1
    ]
    end_a = (f[last, i] - own) * inverse[i] - (own - f[last, i + 2]) * inverse[i + 1]
    if i == 0:
        a, end_a = a + beads.given[0], end_a + beads.given[1]
    d, rate = rest[i] + y[i] - y[i + 1], v[i] - v[i + 1]
    return kinks.fitted_quintic(
        d, h * rate, h * h * a, end, h * end_rate, h * h * end_a
    )


@inlined
def correct_contact(chain: Chain, beads: Beads, plan: Plan, h: float, i: int) -> None:
    """Correct a step for the pair's error at contact i, which opens or closes."""
    pair, last, inverse = plan.scheme, len(plan.scheme.moments) - 1, chain.inverse
    A, r, law, p = (
        chain.A[i],
        chain.r[i],
        chain.law,
        _fitted(chain, beads, h, last, i, False),
    )
    count, top = kinks.find_intervals(law, r, p, h, beads.points)
    once, twice, third, work = kinks.integrals(law, r, p, h, 1.0, count, beads.points)
    force = beads.points[2]
    kinks.forces_along(law, r, p, h, pair.nodes, force)
    once = A * (once - _integral(pair.impulses[last], force))
    twice = A * (twice - _integral(pair.moments[last], force))
    third = A * (third - _integral(pair.thirds, force))
    error, error_once = (
        _integral(pair.errors[0], force),
        _integral(pair.errors[1], force),
    )
    if chain.damped:
        end, _ = kinks.value_and_slope(p, 1.0)
        heat = work - kinks.stored(law, end) + kinks.stored(law, p[0])
        for s in range(last + 1):
            d, slope = kinks.value_and_slope(p, pair.nodes[s])
            lost = (force[s] - (kinks.elastic(law, d) if d > 0.0 else 0.0)) * slope
            heat -= pair.impulses[last, s] * lost
            beads.corrections[1] += A * pair.errors[1, s] * lost
        beads.corrections[0] += A * heat
    impulse, moment = h * once, h * h * twice
    beads.next_v[i] -= impulse * inverse[i]
    beads.next_v[i + 1] += impulse * inverse[i + 1]
    beads.next_y[i] -= moment * inverse[i]
    beads.next_y[i + 1] += moment * inverse[i + 1]
    beads.sums[2, i + 1] -= h * h * A * error / plan.y
    beads.sums[3, i + 1] -= h * A * error_once / plan.v
    if i == 0 and chain.drive.driven:
        # ∫ ΔF v dt with v = next_v - (1 - x) h a + (1 - x)²/2 h² da/dt, a at the step's end.
        change = h * h * third * (beads.given[1] - beads.given[0])
        beads.corrections[2] = (
            impulse * beads.next_v[0] - moment * beads.given[1] + change
        )
        beads.corrections[3] = h * A * error_once * beads.next_v[0]
    for n in range(max(0, i - 1), i + 2):
        both = inverse[i] + inverse[i + 1] if n == i else -inverse[max(i, n)]
        d = top if n == i else chain.rest[n] + beads.next_y[n] - beads.next_y[n + 1]
        closed = n == i or beads.force[last, n + 1] + chain.load[n] > 0.0
        if d > 0.0 and chain.A[n] > 0.0 and closed:
            more = -chain.A[n] * stiffness(law, d) * h * h * h * third * both
            if chain.damped:
                more -= chain.A[n] * chain.r[n] * kinks.drag(law, d) * moment * both
            if n != i:
                beads.next_v[n] -= more * inverse[n]
                beads.next_v[n + 1] += more * inverse[n + 1]
            missed = abs(more) / plan.v
            beads.sums[3, n + 1] += missed if beads.sums[3, n + 1] > 0.0 else -missed


@inlined
def place_of_jump(
    chain: Chain, beads: Beads, plan: Plan, h: float, hi: int
) -> tuple[float, int]:
    """Return the share of a step up to just behind the first closing whose jump matters, or 1.

    Contacts that close at the end of the step are counted, and marked in row 4 of ``beads.sums``:
    the step sees them open throughout.
    """
    place, count, last = 1.0, 0, len(plan.scheme.moments) - 1
    for i in range(hi):
        before = chain.rest[i] + beads.y[i] - beads.y[i + 1]
        after = chain.rest[i] + beads.next_y[i] - beads.next_y[i + 1]
        beads.sums[4, i + 1] = 0.0
        if before <= 0.0 and after > 0.0 and chain.A[i] > 0.0:
            p = _fitted(chain, beads, h, last, i, True)
            x = kinks.change(chain.law, chain.r[i], p, h, 0.0, 1.0, True)
            _, slope = kinks.value_and_slope(p, x)
            jump = chain.A[i] * chain.r[i] * abs(slope)  # h times the jump of the force
            jump *= max(chain.inverse[i], chain.inverse[i + 1])
            behind = (
                2.0 * _JUMP * plan.v / (jump + 1e-300)
            )  # share of a step in which it counts
            if 1.0 - x > behind:
                # In a step that errs the fit says little: the place is looked for once more.
                place = min(place, max(x + 0.5 * behind, _SHRINKAGE))
            else:
                beads.sums[4, i + 1], beads.force[last, i + 1] = 1.0, -chain.load[i]
                count += 1
    return place, count


@inlined
def mark_kinks(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> int:
    """Estimate a step's errors, and mark contacts with kinks, with a force that matters.

    Returns the number of marks, which are in row 0 of ``beads.sums``.
    """
    pair, last = plan.scheme, len(plan.scheme.moments) - 1
    beads.corrections[:] = 0.0
    y, v, next_y, next_v, rest = (
        beads.y,
        beads.v,
        beads.next_y,
        beads.next_v,
        chain.rest,
    )
    marks, jumped, load = beads.sums[0], beads.sums[4], chain.load
    start, end = beads.force[0], beads.force[last]
    least = (
        _SLIGHT * plan.v * plan.lightest / h
    )  # a force F changes a velocity by h F/m
    count = 0
    for lo in range(0, hi, TILE):
        up = min(lo + TILE, hi)
        for q in range(2):
            scale = h * h / plan.y if q == 0 else h / plan.v
            _add_up(
                beads.sums,
                index(q + 2),
                beads.force,
                pair.errors[q],
                scale,
                last + 1,
                lo,
                up,
            )
        if chain.law.pulls:
            continue
        for i in range(index(lo), index(up)):
            before, after = (
                rest[i] + y[i] - y[i + ONE],
                rest[i] + next_y[i] - next_y[i + ONE],
            )
            rise, end_rise = h * (v[i] - v[i + ONE]), h * (next_v[i] - next_v[i + ONE])
            first, then = start[i + ONE] + load[i], end[i + ONE] + load[i]
            changed = chain.damped & ((first > 0.0) != (then > 0.0))
            force, most = max(first, then), max(before, after)
            strong = (force > least) | (
                chain.damped & ((before > 0.0) != (after > 0.0))
            )
            low, near = min(before, after), (most > 0.0) & (force > _STRONG * least)
            near = (near & (low < _NEAR * most)) | (
                (most > 0.0) & (low < _VERY_NEAR * most)
            )
            # A contact that is open at both ends can close in between where the tangents at the
            # ends meet at δ > 0.
            meeting = (after - end_rise) * rise - before * end_rise > 0.0
            unseen = (most <= 0.0) & (rise > 0.0) & (end_rise < 0.0) & meeting
            kink = (strong & (near | changed)) | unseen
            mark = kink & (chain.A[i] > 0.0) & (jumped[i + ONE] == 0.0)
            marks[i + ONE] = 1.0 if mark else 0.0
            count += 1 if mark else 0
    return count


@inlined
def next_mark(marks: Array, i: int) -> int:
    """Return the first marked contact from contact i on; there is one."""
    while not marks[index(i) + ONE] > 0.0:
        i += 1
    return i


@inlined
def evaluate_stages(
    chain: Chain, beads: Beads, plan: Plan, t: float, h: float, hi: int, again: bool
) -> None:
    """Compute the forces at all stages of a step h of the beads 0 … hi-1 at time t.

    again : True for the forces at the step's end alone, after its motion was corrected.
    """
    pair, last = plan.scheme, len(plan.scheme.moments) - 1
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    inverse, force, sums = chain.inverse, beads.force, beads.sums
    for tile in range(0, hi + last, TILE):
        for s in range(last if again else 1, last + 1):
            lo, up, first, behind = tile_bounds(tile, s, hi)
            if lo >= up:
                continue
            ch = pair.nodes[s] * h
            for q in range(0 if again else (2 if chain.damped or s == last else 1)):
                row, scale = (
                    (pair.moments[s], h * h) if q == 0 else (pair.impulses[s], h)
                )
                _add_up(sums, index(q), force, row, scale, s, lo, up)
            if not again:
                for i in range(index(lo), index(up)):
                    net = (sums[ZERO, i] - sums[ZERO, i + ONE]) * inverse[i]
                    next_y[i] = y[i] + ch * v[i] + net
                if chain.damped or s == last:
                    for i in range(index(lo), index(up)):
                        next_v[i] = (
                            v[i] + (sums[ONE, i] - sums[ONE, i + ONE]) * inverse[i]
                        )
                if chain.drive.driven and lo == 0:
                    given = drive_motion(chain.drive, t + h / 2, t + ch)
                    next_y[0], next_v[0], beads.given[1] = given
            contact_forces(chain, beads, plan, next_y, next_v, index(s), first, behind)


@summed
def step_error(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> float:
    """Return the error of a step in units of the tolerance: of all beads, the heat and the work."""
    total, sums, inverse = 0.0, beads.sums, chain.inverse
    for i in range(index(hi)):
        y = (sums[index(2), i] - sums[index(2), i + ONE]) * inverse[i]
        v = (sums[index(3), i] - sums[index(3), i + ONE]) * inverse[i]
        total += y * y + v * v
    for n in range(2):
        missed = h * _integral(plan.scheme.errors[1], beads.power[n])
        total += ((missed - beads.corrections[2 * n + 1]) / plan.energy) ** 2
    return math.sqrt(total)


@inlined
def end_step(beads: Beads, plan: Plan, now: Any, h: float, error: float) -> None:
    """Add up a step with an error of at most 1, and plan the next step, a shorter one above 1."""
    pair, stop, factor = plan.scheme, plan.stops[now.stop], 0.0
    if error < _HOPELESS:
        factor = _SAFETY * max(error, 1e-9) ** (-1.0 / (pair.lower + 1))
    now.h = h * min(_GROWTH, max(_SHRINKAGE, factor))
    if error <= 1.0:
        impulses = pair.impulses[len(pair.impulses) - 1]
        now.lost += h * _integral(impulses, beads.power[0]) + beads.corrections[0]
        now.work += h * _integral(impulses, beads.power[1]) + beads.corrections[2]
        now.response = max(now.response, now.energy + now.work - now.lost)
        now.h = min(plan.longest, max(now.h, now.planned))
        stopping = now.t + h > stop - 1e-9 * h
        now.t = stop if stopping else now.t + h
        now.stop += 1 if stopping else 0
        now.steps += 1
    elif factor == 0.0:
        beads.force[1:] = 0.0  # overflows must not last
    now.planned = 0.0


@inlined
def begin_step(beads: Beads, plan: Plan, hi: int) -> None:
    """Move the beads, and their forces, to the end of a step, which is the start of the next."""
    last, power = index(len(plan.scheme.moments) - 1), beads.power
    for i in range(index(hi)):
        beads.y[i], beads.v[i] = beads.next_y[i], beads.next_v[i]
        beads.force[ZERO, i + ONE] = beads.force[last, i + ONE]
    power[0, 0], power[1, 0] = power[0, last], power[1, last]
    beads.given[0] = beads.given[1]
