"""A step of an embedded Runge–Kutta–Nyström pair, corrected for kinks.

h is the step, and x, from 0 to 1, the time within the step. The impulse of a contact in a step is
``h ∫ F dx``, its moment ``h² ∫ (1 - x) F dx``: they change the velocities and the displacements of
its two beads. At a contact that opens or closes, the pair's quadratures of ``F(p, p'/h)``, with a
quintic p close to the contact's compression, are replaced by accurate integrals
(`validation.lattice.kernel.kinks`).

The stages lack these corrections: the forces of the contact and its neighbours are computed at
displacements that err by the moment so far, and at velocities that err by the impulse. Over a step
this changes their impulses by stiffness × ``h³ ∫ (1 - x)²/2 F dx``, and by damping × moment. The
neighbours are corrected for it once more, and this second correction counts as error.
"""

from __future__ import annotations

import math
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import ROOM, TILE, Beads, Chain, Pair, Plan
from validation.lattice.kernel.compiled import (
    FIRST,
    ONE,
    ZERO,
    alone,
    index,
    inlined,
    part,
    summed,
)
from validation.lattice.kernel.force import (
    contact_forces,
    drag,
    drive_motion,
    elastic,
    push,
    stiffness,
    tile_bounds,
)

_SLIGHT = 10.0  # least effect of a contact that is corrected, in units of the tolerance
# A contact is corrected so often, or until the correction changes by less than _SETTLED times the
# tolerance. Measured: without the rounds damped gases err by up to ten times as much.
_ROUNDS, _SETTLED = 4, 0.02
# A contact is nearly open at a step's one end if δ there is less than _NEAR times δ at the other. A
# weak contact, whose force is less than _STRONG times the least that counts, is nearly open below
# _VERY_NEAR, as the pair's own error is smaller there. Measured: _NEAR for all takes a tenth more
# time for equal beads, _VERY_NEAR for all a quarter more for dimers at small tolerances.
# The singularity of damping, δ^{1/4} say, is felt farther away: at δ halved within a step, and a
# tolerance of 1e-10, the energy was off by 18 tolerances.
_NEAR, _VERY_NEAR, _NEAR_DAMPED, _STRONG = 0.3, 0.03, 0.6, 1e3
# Mean distance of the quintic from a p with ``p'' = 9 P₄(x)``, Legendre's polynomial: the distance
# is ``9 · 0.0365 (1 - (2x - 1)²)³``.
_MISFIT = 0.15
# Greatest distance of the quintic from a p whose second derivative jumps by 1.
_UNBENT = 0.014
# Share of a neighbour's correction that counts as error.
_SECOND = 0.5
# Step-size control of Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.4.
# An error scales as h^order. The next step is _SAFETY times the step with an error equal to the
# tolerance, as a rejected step costs as much as an accepted one. _GROWTH bounds the effect of an
# error that is small by chance, _SHRINKAGE that of an error too large for the power. Measured on
# nine scenes at 1e-6 … 1e-10: the work for the same error is the same to 4 % for a safety of 0.8 to
# 0.95 and a growth of 1.5 to 10; a safety of 0.7 costs 8 % more, 0.98 costs 11 % more.
_SAFETY, _GROWTH, _SHRINKAGE = 0.9, 5.0, 0.1
# In units of the tolerance: the power says nothing of such an error, or of NaN.
_HOPELESS = 1e9
# A third solution of low order, where a pair has one, weighs so much in the estimate of the error
# (Hairer, Nørsett and Wanner, II.10).
_THIRD = 0.01


def _mover(most: int) -> Any:
    """Compile a weighted sum over ``most`` stages, written out for loops that vectorise."""
    stages = index(most)

    @part
    def move(
        target: Array,
        base: Array,
        rate: Array,
        time: float,
        scale: float,
        weights: Array,
        push: Array,
        lo: int,
        hi: int,
    ) -> None:
        for i in range(index(lo), index(hi)):
            total = 0.0
            for s in range(stages):
                total += weights[s] * push[s, i]
            target[i] = base[i] + time * rate[i] + scale * total

    return move


# RKN86 has nine stages.
_move_few, _move_some, _move_all = _mover(4), _mover(9), _mover(ROOM)


@alone
def _move(
    target: Array,
    base: Array,
    rate: Array,
    time: float,
    scale: float,
    weights: Array,
    count: int,
    push: Array,
    lo: int,
    hi: int,
) -> None:
    """Compute target = base + time rate + scale Σ_s weights[s] push[s] over ``count`` stages.

    The weights of stages that are still to come are 0.
    """
    if count <= 4:
        _move_few(target, base, rate, time, scale, weights, push, lo, hi)
    elif count <= 9:
        _move_some(target, base, rate, time, scale, weights, push, lo, hi)
    else:
        _move_all(target, base, rate, time, scale, weights, push, lo, hi)


@summed
def _integral(row: Array, values: Array) -> float:
    """Return Σ row[s] values[s] over the stages s."""
    total = 0.0
    for s in range(index(len(row))):
        total += row[s] * values[s]
    return total


@part
def _error_scale(plan: Plan, h: float, q: int) -> float:
    """Return the factor from accelerations to row q of the errors, in units of the tolerance."""
    if q % 2 == 0:
        return float(h * h / plan.y)
    return float(h / plan.v)


@part
def _ends(
    chain: Chain, beads: Beads, h: float, i: int
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return δ, δ' and δ'' of contact i at both ends of a step, in units of the step."""
    y = beads.y
    v = beads.v
    push = beads.push
    last = len(beads.border) - 1
    next_y = beads.next_y
    next_v = beads.next_v
    a = push[0, i] - push[0, i + 1]
    end_a = push[last, i] - push[last, i + 1]
    if i == 0:
        a = a + beads.given[0]
        end_a = end_a + beads.given[1]
    d = y[i] - y[i + 1]
    end = next_y[i] - next_y[i + 1]
    start = chain.rest[i] + d, h * (v[i] - v[i + 1]), h * h * a
    return start, (
        chain.rest[i] + end,
        h * (next_v[i] - next_v[i + 1]),
        h * h * end_a,
    )


@part
def _motion(beads: Beads, h: float, i: int) -> kinks.Curve:
    """Return the motion of bead i over a step, from where it is, as far as it is given."""
    start = 0.0, h * beads.v[i], h * h * beads.given[0]
    moved = beads.next_y[i] - beads.y[i]
    end = moved, h * beads.next_v[i], h * h * beads.given[1]
    return kinks.fitted_curve(start, end, kinks.STRAIGHT)


@alone
def _stage_forces(
    chain: Chain,
    beads: Beads,
    pair: Pair,
    p: kinks.Curve,
    t: float,
    h: float,
    i: int,
    jumps: bool,
) -> None:
    """Compute a contact's compression, slope and force at the stages; they go to ``beads.points``.

    On the curve p the pair's quadrature and the integral err alike, by the error of p. But the
    stages after a jump of the force are so far off p that their own motion is taken.
    """
    law = chain.laws[chain.law[i]]
    r = chain.r[i]
    points = beads.points
    for s in range(len(pair.nodes)):
        d, slope = kinks.value_and_slope(p, pair.nodes[s])
        if jumps:
            ch = pair.nodes[s] * h
            rate = beads.v[i]
            y = beads.y[i] + ch * rate
            if i == 0 and chain.drive.driven:
                y, rate, _ = drive_motion(chain.drive, t + h / 2, t + ch)
            d = chain.rest[i] + y - beads.y[i + 1] - ch * beads.v[i + 1]
            slope = h * (rate - beads.v[i + 1])
            for j in range(s):
                bend = h * h * (beads.push[j, i] - beads.push[j, i + 1])
                d += pair.moments[s, j] * bend
                slope += pair.impulses[s, j] * bend
        points[0, s] = d
        points[1, s] = slope
        points[2, s] = push(law, r, d, slope / h)


@alone
def _clipped(
    chain: Chain, beads: Beads, plan: Plan, t: float, h: float, n: int
) -> float:
    """Return the squared error of a damped neighbour of a contact whose force jumps in a step.

    The stages after the jump have velocities so far off that a neighbour which does not push, as
    damping may not pull, may push at some of them, or the reverse. Elsewhere its force is linear in
    the velocity, and the errors of the stages cancel.
    """
    pair = plan.scheme
    law = chain.laws[chain.law[n]]
    r = chain.r[n]
    opened = chain.rest[n] + beads.y[n] - beads.y[n + 1] <= 0.0
    if not r > 0.0 or opened or law.sticks or beads.marks[n] > 0.0:
        return 0.0
    points = beads.points
    _stage_forces(chain, beads, pair, kinks.NO_CURVE, t, h, n, True)
    pushes = points[2, 0] > 0.0
    last = len(pair.nodes) - 1
    missed = 0.0
    for s in range(last + 1):
        d = points[0, s]
        wanted = 0.0
        if pushes and d > 0.0:
            wanted = elastic(law, d) + r * drag(law, d) * points[1, s] / h
        missed += pair.impulses[last, s] * (points[2, s] - wanted)
    missed *= h * chain.A[n]
    moved = missed / plan.v
    work = missed * (beads.v[n] - beads.v[n + 1]) / plan.energy
    squares = chain.inverse[n] ** 2 + chain.inverse[n + 1] ** 2
    return float(moved * moved * squares + work * work)


@inlined
def correct_contact(
    chain: Chain, beads: Beads, plan: Plan, t: float, h: float, i: int
) -> None:
    """Correct a step for the pair's error at contact i, which opens or closes."""
    pair = plan.scheme
    last = len(beads.border) - 1
    inverse = chain.inverse
    A = chain.A[i]
    r = chain.r[i]
    law = chain.laws[chain.law[i]]
    points = beads.points
    edges = beads.edges
    both = inverse[i] + inverse[i + 1]
    start, end = _ends(chain, beads, h, i)
    force = points[2]
    bend = -A * h * h * both
    impulse = moment = change = rough = 0.0
    found = kinks.STRAIGHT
    driven = i == 0 and chain.drive.driven
    drive = _motion(beads, h, i)
    # The force also depends on the corrected end, all the more the later it jumps.
    for _ in range(_ROUNDS):
        d = end[0] - both * moment
        rise = end[1] - both * h * impulse
        own = push(law, r, d, rise / h) - push(law, r, end[0], end[1] / h)
        corrected = d, rise, end[2] + bend * own
        p, count, top, jump = kinks.resolved(
            law, r, start, corrected, h, bend, found, edges
        )
        found = p[6]
        once, twice, third, work, given, rough = kinks.integrals(
            law, r, p, h, 1.0, points, edges, count, driven, drive, bend
        )
        _stage_forces(chain, beads, pair, p, t, h, i, jump != 0.0)
        before = impulse
        impulse = h * A * (once - _integral(pair.impulses[last], force))
        moment = h * h * A * (twice - _integral(pair.moments[last], force))
        change = impulse - before
        if r > 0.0:
            # The next round changes the correction by about this share of the change.
            steepness = r * drag(law, max(top, 0.0)) / h + stiffness(law, top)
            change *= min(1.0, abs(bend) * steepness)
        elif jump == 0.0:
            change = 0.0  # an elastic force hardly depends on the correction
        if abs(change) * both < _SETTLED * plan.v:
            break
    third = h * h * h * A * (third - _integral(pair.thirds, force))
    for q in range(len(pair.errors)):
        seen = A * _error_scale(plan, h, q) * _integral(pair.errors[q], force)
        beads.errors[q, i] += seen * inverse[i]
        beads.errors[q, i + 1] -= seen * inverse[i + 1]
    if chain.damped:
        heat = work - kinks.stored(law, corrected[0]) + kinks.stored(law, p[0])
        for s in range(last + 1):
            lost = (force[s] - elastic(law, points[0, s])) * points[1, s]
            heat -= pair.impulses[last, s] * lost
            beads.books[1] += A * pair.errors[1, s] * lost
        beads.books[0] += A * heat
    beads.next_v[i] -= impulse * inverse[i]
    beads.next_v[i + 1] += impulse * inverse[i + 1]
    beads.next_y[i] -= moment * inverse[i]
    beads.next_y[i + 1] += moment * inverse[i + 1]
    if driven:
        beads.books[2] = A * given
        for s in range(last + 1):
            power = A * force[s] * kinks.value_and_slope(drive, pair.nodes[s])[1]
            beads.books[2] -= pair.impulses[last, s] * power
            beads.books[3] += pair.errors[1, s] * power
    squares = inverse[i] ** 2 + inverse[i + 1] ** 2
    if r > 0.0:
        # ∫ (1 - x) F dx and the heat ∫ r δ^p (dδ/dt)² dt are as wrong as p is, the impulse is not.
        missed = _MISFIT * abs(rough) * A * r * drag(law, max(top, 0.0))
        heated = 2.0 * missed * abs(start[1]) / h / plan.energy
        moved = h * missed / plan.y
        beads.books[4] += heated * heated + moved * moved * squares
    if r > 0.0 and jump != 0.0:
        if i > 0:
            beads.books[4] += _clipped(chain, beads, plan, t, h, i - 1)
        beads.books[4] += _clipped(chain, beads, plan, t, h, i + 1)
    unsettled = change / plan.v
    beads.books[4] += unsettled * unsettled * squares
    for n in range(max(0, i - 1), i + 2):
        share = both if n == i else -inverse[max(i, n)]
        d = chain.rest[n] + beads.next_y[n] - beads.next_y[n + 1]
        if n != i and jump != 0.0 and beads.marks[n] > 0.0:
            # The jump bends the neighbour's curve, too, and shifts the place of its own jump.
            rate = abs(beads.next_v[n] - beads.next_v[n + 1])
            own = push(chain.laws[chain.law[n]], chain.r[n], kinks.OPENS, rate)
            shift = _UNBENT * h * h * A * abs(jump * share)
            missed = chain.A[n] * own * min(shift / max(rate, kinks.OPENS), h) / plan.v
            beads.books[4] += missed * missed * (inverse[n] ** 2 + inverse[n + 1] ** 2)
        if n == i:
            d = top
        closed = n == i or beads.force[1, n + 1] + chain.load[n] > 0.0
        other = chain.laws[chain.law[n]]
        if not (d > 0.0 and closed):
            if n != i and chain.r[n] > 0.0 and not other.sticks:
                # The neighbour has stopped pushing: its elastic energy turns into heat.
                idle = chain.A[n] * max(elastic(other, d), 0.0)
                beads.books[0] += idle * moment * share
            continue
        more = -chain.A[n] * stiffness(other, d) * third * share
        if chain.r[n] > 0.0:
            resisted = -chain.A[n] * chain.r[n] * drag(other, d) * moment * share
            more += resisted
            if n != i:
                # Heat c v² of a neighbour, whose velocity v changes by the correction.
                rate = beads.next_v[n] - beads.next_v[n + 1]
                beads.books[0] += 2.0 * resisted * rate
        if n != i:
            beads.next_v[n] -= more * inverse[n]
            beads.next_v[n + 1] += more * inverse[n + 1]
        elif jump != 0.0:
            more *= bend * (r * drag(law, d) / h + stiffness(law, d))
        missed = _SECOND * more / plan.v
        beads.books[4] += missed * missed * (inverse[n] ** 2 + inverse[n + 1] ** 2)


@inlined
def mark_kinks(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> int:
    """Estimate a step's errors, and mark contacts with kinks, with a force that matters.

    Returns the number of marks, which are in ``beads.marks``.
    """
    still = beads.still
    push = beads.push
    y = beads.y
    v = beads.v
    next_y = beads.next_y
    next_v = beads.next_v
    rest = chain.rest
    load = chain.load
    opens = chain.opens
    marks = beads.marks
    start = beads.force[0]
    end = beads.force[1]
    # A force F changes a velocity by h F/m; the errors of all beads add up.
    least = _SLIGHT * plan.v * plan.lightest / (h * math.sqrt(hi))
    count = 0
    nearly = _NEAR
    very_nearly = _VERY_NEAR
    if chain.damped:
        nearly = _NEAR_DAMPED
        very_nearly = _NEAR
    for lo in range(0, hi, TILE):
        up = min(lo + TILE, hi)
        for q in range(len(beads.errors)):
            scale = _error_scale(plan, h, q)
            weights = plan.scheme.errors[q]
            errors = beads.errors[q]
            _move_all(errors, still, still, 0.0, scale, weights, push, lo, up)
        for i in range(index(lo), index(up)):
            before = rest[i] + y[i] - y[i + ONE]
            after = rest[i] + next_y[i] - next_y[i + ONE]
            rise = h * (v[i] - v[i + ONE])
            end_rise = h * (next_v[i] - next_v[i + ONE])
            first = abs(start[i + ONE] + load[i])
            then = abs(end[i + ONE] + load[i])
            changed = chain.damped & ((first > 0.0) != (then > 0.0))
            force = max(first, then)
            most = max(before, after)
            strong = (force > least) | (
                chain.damped & ((before > 0.0) != (after > 0.0))
            )
            low = min(before, after)
            near = (most > 0.0) & (force > _STRONG * least)
            near = (near & (low < nearly * most)) | (
                (most > 0.0) & (low < very_nearly * most)
            )
            # A contact that is open at both ends can close in between if the tangent at an end
            # comes to δ > 0 within the step. Where the tangents meet does not tell, as δ may have
            # an inflection.
            reach = max(before + rise, after - end_rise)
            unseen = (most <= 0.0) & (reach > 0.0)
            mark = ((strong & (near | changed)) | unseen) & (opens[i] > 0.0)
            marks[i] = mark
            count += mark
    return count


@alone
def watch_drive(chain: Chain, beads: Beads, plan: Plan, t: float, h: float) -> int:
    """Mark the contact of a driven bead if it closes or opens anywhere within a step.

    Returns the number of new marks. The acceleration of the bead is given, so that δ can rise,
    fall and rise again. The difference between its motion and the quintic counts as error.
    """
    law = chain.laws[chain.law[0]]
    A = chain.A[0]
    r = chain.r[0]
    if not chain.opens[0] > 0.0:
        return 0
    start, end = _ends(chain, beads, h, FIRST)
    # Within the step δ changes by less than this from either end.
    reach = abs(start[1]) + abs(end[1]) + abs(start[2]) + abs(end[2])
    if not chain.damped and min(start[0], end[0]) > reach:
        return 0
    p = kinks.fitted_curve(start, end, kinks.STRAIGHT)
    count, top = kinks.find_edges(law, r, p, h, beads.edges)
    # The quintic's middle by the values at both ends: half their sum, 5/32 of the difference of the
    # slopes, 1/64 of the sum of the second derivatives.
    middle = (beads.y[0] + beads.next_y[0]) / 2
    middle += 5 * h * (beads.v[0] - beads.next_v[0]) / 32
    middle += h * h * (beads.given[0] + beads.given[1]) / 64
    given, _, _ = drive_motion(chain.drive, t + h / 2, t + h / 2)
    missed = abs(given - middle)
    if count > 1 or beads.marks[0] > 0.0 or abs(top) < missed:
        force = elastic(law, max(top, 0.0) + missed) - elastic(law, top)
        impulse = h * A * force
        moved = impulse * chain.inverse[1] / plan.v
        work = impulse * beads.v[0] / plan.energy
        beads.books[4] += moved * moved + work * work
    if count > 1 and not beads.marks[0] > 0.0:
        beads.marks[0] = 1.0
        return 1
    return 0


@inlined
def next_mark(marks: Array, i: int) -> int:
    """Return the first marked contact from contact i on; there is one."""
    while not marks[index(i)] > 0.0:
        i += 1
    return i


@inlined
def evaluate_stages(
    chain: Chain, beads: Beads, plan: Plan, t: float, h: float, hi: int
) -> None:
    """Compute the accelerations of beads 0 … hi-1 at the stages of a step h that begins at time t.

    Bead ``hi`` is the first one that does not move yet.
    Stage 0 is the last stage of the step before (`begin_step`). The last stage is the step's end,
    whose displacements and velocities stay in ``next_y`` and ``next_v``.
    """
    pair = plan.scheme
    stages = len(plan.scheme.nodes)
    y = beads.y
    v = beads.v
    next_y = beads.next_y
    next_v = beads.next_v
    # Row 0 of the forces, and entry 0 of ``beads.given`` below, hold the start of the step, which
    # estimates of errors compare with its end; row 1, and entry 1, the stage computed last.
    force = beads.force[1]
    push = beads.push
    inverse = chain.inverse
    # All stages go through a tile of beads while its memory is in the processor's cache. A force
    # depends on the bead ahead, so that stage s can be computed up to s beads before the tile's end
    # (`tile_bounds`): it lags by s beads, and ``hi + stages`` lets the last stage reach bead hi-1.
    for tile in range(0, hi + stages, TILE):
        for s in range(1, stages):
            lo, up, first, behind = tile_bounds(tile, s, hi)
            if lo >= up:
                continue
            ch = pair.nodes[s] * h
            moments = pair.moments[s]
            _move(next_y, y, v, ch, h * h, moments, s, push, lo, up)
            # Forces depend on velocities with damping alone; the step's end has them in any case.
            if chain.damped or s == stages - 1:
                _move(next_v, v, v, 0.0, h, pair.impulses[s], s, push, lo, up)
            # The motion of a driven bead is given. Steps end where intervals of the drive's file
            # meet: the middle of the step, t + h/2, tells its interval, also for a stage at an end.
            if chain.drive.driven and lo == 0:
                given = drive_motion(chain.drive, t + h / 2, t + ch)
                next_y[0], next_v[0], beads.given[1] = given
            contact_forces(chain, beads, plan, next_y, next_v, s, first, behind)
            # The stages share a row of forces: the last one of a tile is kept for the next tile.
            if first > 0:
                force[first] = beads.border[s]
            beads.border[s] = force[behind]
            for i in range(index(first), index(behind)):
                push[s, i] = (force[i] - force[i + ONE]) * inverse[i]


@inlined
def evaluate_end(chain: Chain, beads: Beads, plan: Plan, hi: int) -> None:
    """Compute the accelerations of beads 0 … hi-1 at a step's end, after a correction.

    Bead ``hi`` is the first one that does not move yet. Entry i of a row of forces is that of the
    contact behind bead i, entry i + 1 that of the contact ahead of it.
    """
    last = len(plan.scheme.nodes) - 1
    # Row 1 holds the forces at the stage that is computed last, here the step's end.
    force = beads.force[1]
    contact_forces(chain, beads, plan, beads.next_y, beads.next_v, last, FIRST, hi)
    for i in range(index(hi)):
        net = force[i] - force[i + ONE]
        beads.push[index(last), i] = net * chain.inverse[i]


@summed
def _squared_error(errors: Array, row: int, hi: int) -> float:
    """Return the sum over all beads of the squared errors of displacements and velocities."""
    total = 0.0
    ys = errors[row]
    vs = errors[row + 1]
    for i in range(index(hi)):
        total += ys[i] * ys[i] + vs[i] * vs[i]
    return total


@inlined
def step_error(beads: Beads, plan: Plan, h: float, hi: int) -> float:
    """Return the error of a step in units of the tolerance: of all beads, the heat and the work."""
    weights = plan.scheme.errors
    books = beads.books
    total = 0.0
    for q in range(0, len(weights), 2):
        squared = _squared_error(beads.errors, q, hi)
        for n in range(2):
            missed = h * _integral(weights[q + 1], beads.power[n])
            squared += ((missed - books[2 * n + 1]) / plan.energy) ** 2
        if q == 0:
            total = squared
        elif squared > 0.0:
            total = total * total / (total + _THIRD * squared)
    return math.sqrt(total + books[4])


@inlined
def end_step(
    beads: Beads, plan: Plan, now: Any, h: float, error: float, stopping: bool
) -> bool:
    """Add up a step with an error of at most 1, and plan the next step, a shorter one above 1.

    Returns True for a step that is made. The flag ``stopping`` is True for a step that was cut to
    end at the next stop.
    """
    pair = plan.scheme
    factor = 0.0
    wanted = now.h
    if error < _HOPELESS:
        factor = _SAFETY * max(error, 1e-9) ** (-1.0 / pair.order)
    now.h = h * min(_GROWTH, max(_SHRINKAGE, factor))
    if not error <= 1.0:
        if factor == 0.0:
            beads.push[1:] = 0.0  # overflows must not last
        return False
    impulses = pair.impulses[len(pair.impulses) - 1]
    now.lost += h * _integral(impulses, beads.power[0]) + beads.books[0]
    now.work += h * _integral(impulses, beads.power[1]) + beads.books[2]
    now.response = max(now.response, now.energy + now.work - now.lost)
    if stopping:
        now.t = plan.stops[now.stop]
        now.late = 0.0
        now.h = max(now.h, wanted)
        now.stop += 1
    else:
        # A plain sum of many equal steps would be rounded to one side (Kahan 1965).
        step = h - now.late
        t = now.t + step
        now.late = (t - now.t) - step
        now.t = t
    now.h = min(plan.longest, now.h)
    now.steps += 1
    return True


@inlined
def begin_step(beads: Beads, hi: int) -> None:
    """Move the beads, and their forces, to the end of a step, which is the start of the next."""
    last = len(beads.border) - 1
    for i in range(index(hi)):
        beads.y[i] = beads.next_y[i]
        beads.v[i] = beads.next_v[i]
        beads.force[ZERO, i + ONE] = beads.force[ONE, i + ONE]
        beads.push[ZERO, i] = beads.push[index(last), i]
    # Stage 0 of the next step is the last stage of this one: heat, and work of the drive.
    beads.power[0, 0] = beads.power[0, last]
    beads.power[1, 0] = beads.power[1, last]
    beads.given[0] = beads.given[1]
