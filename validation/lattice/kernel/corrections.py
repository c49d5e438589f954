"""Corrections of a step at the contacts that open or close in it.

h is the step, and x, from 0 to 1, the time within the step. The impulse of a contact in a step is
``h ∫ F dx``, its moment ``h² ∫ (1 - x) F dx``: they change the velocities and the displacements of
its two beads. At a contact that opens or closes, the pair's quadratures of ``F(p, p'/h)``, with a
quintic p close to the contact's compression, are replaced by accurate integrals
(`validation.lattice.kernel.kinks`).

The stages lack these corrections: the forces of the contact and its neighbours are computed at
displacements that err by the moment so far, and at velocities that err by the impulse. Over a step
this changes their impulses by stiffness × ``h³ ∫ (1 - x)²/2 F dx``, and by damping × moment. The
neighbours are corrected for it once more, and this second correction counts as error.

`part`, `inlined` and `alone` are numba's ``njit`` with options, and `index` makes an index
unsigned, so that a loop vectorises (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

import math
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.kernel import kinks
from validation.lattice.kernel.arrays import (
    AFTER,
    HEAT,
    HEAT_ERROR,
    SQUARES,
    WORK,
    WORK_ERROR,
    Beads,
    Chain,
    Forcing,
    Pair,
    Plan,
)
from validation.lattice.kernel.compiled import ONE, alone, index, inlined, part
from validation.lattice.kernel.force import (
    drag,
    drive_motion,
    elastic,
    push,
    stiffness,
)
from validation.lattice.kernel.pair import error_scale, integral

_SLIGHT = 10.0  # least effect of a contact that is corrected, in units of the tolerance
# A damped contact is marked also where its damping may begin or end, however weak its force. It is
# left out if bounds of its impulse and of its heat are less than _FAINT tolerances, as half of the
# contacts at the front of a pulse are.
_FAINT = 0.01
# A contact is corrected so often, or until the correction changes by less than _SETTLED times the
# tolerance. Measured: without the rounds damped gases err by up to ten times as much.
_ROUNDS, _SETTLED = 4, 0.02
# A contact that closes x before a step's end moves there by -x when the velocity at the end is
# corrected by 1. Its impulse then changes by its greatest stiffness, times the square of the part
# of the step in which it pushes, times 1/(k (k + 1)), 0.27 with Hertz's exponent k. With this share
# the greatest energy drift in 1,520 runs of colliding balls is 1.5 rtol, without a second round
# 36 rtol. With a share of 0.25 it is 2.1, and dimers take 2 to 5 % longer.
_FELT = 0.125
# A contact is nearly open at a step's one end if δ there is less than _NEAR times δ at the other. A
# weak contact, whose force is less than _STRONG times the least that counts, is nearly open below
# _VERY_NEAR, as the pair's own error is smaller there. Measured: with _STRONG = 1e3 chains take up
# to a third more time for the same errors.
# The singularity of damping, δ^{1/4} say, is felt farther away: with _NEAR, and a tolerance of
# 1e-10, a sample of a driven chain was off by 1,100 tolerances, and the energy of a driven bead by
# 120; with _NEAR_DAMPED by 0.02 and 35, in as many steps.
_NEAR, _VERY_NEAR, _NEAR_DAMPED, _STRONG = 0.3, 0.03, 0.6, 1e4
# Mean distance of the quintic from a p with ``p'' = 9 P₄(x)``, Legendre's polynomial: the distance
# is ``9 · 0.0365 (1 - (2x - 1)²)³``.
_MISFIT = 0.15
# Greatest distance of the quintic from a p whose second derivative jumps by 1.
_UNBENT = 0.014
# Force of a law where its contact opens: more is a jump. A power has 1e-100 at most.
_NO_JUMP = 1e-50
# Place in a step at which the motion of a driven bead is compared with its quintic, whose error is
# nearly odd about the middle where the drive has an inflection.
_OFF_MIDDLE = 0.3
# Share of a neighbour's correction that counts as error.
_SECOND = 0.5


@inlined
def _ends(
    chain: Chain, beads: Beads, plan: Plan, h: float, i: int
) -> tuple[kinks.State, kinks.State]:
    """Return δ, δ' and δ'' of contact i at both ends of a step, in units of the step."""
    last = len(plan.scheme.nodes) - 1  # the last stage, at the step's end
    # ``push`` holds the beads' accelerations by stage. A driven bead, which is bead 0, has 0 there,
    # and its acceleration at the step's two ends is in ``given``, which is 0 without a drive.
    a = beads.push[0, i] - beads.push[0, i + 1]
    end_a = beads.push[last, i] - beads.push[last, i + 1]
    if i == 0:
        a += beads.given[0]
        end_a += beads.given[1]
    start = (
        chain.rest[i] + (beads.y[i] - beads.y[i + 1]),
        h * (beads.v[i] - beads.v[i + 1]),
        h * h * a,
    )
    end = (
        chain.rest[i] + (beads.next_y[i] - beads.next_y[i + 1]),
        h * (beads.next_v[i] - beads.next_v[i + 1]),
        h * h * end_a,
    )
    return start, end


@inlined
def mark_kinks(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    h: float,
    hi: int,
) -> int:
    """Mark the contacts of beads 0 … hi-1 that open or close within a step, or nearly do.

    There F(δ) has no smooth derivatives (a kink), and the pair's quadrature errs. A contact whose
    force is too weak to matter is left out. ``plan.v`` is the error of a velocity that is allowed
    in a step.

    Returns the number of marks, which are in ``beads.marks``.
    """
    y = beads.y
    v = beads.v
    next_y = beads.next_y
    next_v = beads.next_v
    rest = chain.rest
    load = chain.load
    opens = chain.opens
    marks = beads.marks
    # Forces at both ends of the step, less the static ones; that of contact i is in column i + 1.
    start = beads.force[0]
    end = beads.force[1]
    # A force F changes a velocity by h F/m. The error of a step is the root of the sum of the
    # squared errors of all beads, so that each contact may have a share of 1/√hi.
    least = _SLIGHT * plan.v * plan.lightest / (h * math.sqrt(hi))
    count = 0
    damped = forcing is not None and forcing.damped
    near = _NEAR_DAMPED if damped else _NEAR
    for i in range(index(hi)):
        before = rest[i] + y[i] - y[i + ONE]
        after = rest[i] + next_y[i] - next_y[i + ONE]
        rise = h * (v[i] - v[i + ONE])
        end_rise = h * (next_v[i] - next_v[i + ONE])
        first = abs(start[i + ONE] + load[i])
        then = abs(end[i + ONE] + load[i])
        force = max(first, then)
        # Damping has stopped the force of a contact that expands: all its energy turns into heat.
        # Without damping this force is one at the front, too weak for a float.
        force = math.inf if damped & (force <= 0.0) else force
        most = max(before, after)
        # The error of a kink grows with the force: a strong contact is corrected from farther away.
        share = near if force > _STRONG * least else _VERY_NEAR
        nearly_open = (most > 0.0) & (min(before, after) < share * most)
        # A damping force can begin or end with a jump, which matters however weak the force is at
        # the step's ends, and while δ > 0, as damping may not pull.
        parted = damped & ((before > 0.0) != (after > 0.0))
        changed = damped & ((first > 0.0) != (then > 0.0))
        # A contact that is open at both ends can close in between if the tangent of δ at an end
        # comes to δ > 0 within the step: with one inflection at most δ lies below one of both
        # tangents where it is greatest. The motion of a driven bead has no more in a step
        # (`validation.scenes.forcing.Drive.longest_step`). Measured: of 3,000 aimed grazes none is
        # missed. That both tangents meet at δ > 0 is not asked for: they need not.
        reach = max(before + rise, after - end_rise)
        unseen = (most <= 0.0) & (reach > 0.0)
        seen = ((force > least) | parted) & (nearly_open | changed)
        mark = (seen | unseen) & (opens[i] > 0.0)
        marks[i] = mark
        count += mark
    return count


@inlined
def next_mark(marks: Array, i: int) -> int:
    """Return the first marked contact from contact i on; there is one."""
    while not marks[index(i)] > 0.0:
        i += 1
    return i


@part
def _drive_curve(beads: Beads, h: float) -> kinks.Curve:
    """Return the motion of the driven bead, bead 0, over a step: a quintic that starts at 0."""
    # Entries 0 and 1 of ``beads.given`` are the bead's accelerations at the step's two ends. A
    # curve of a step of length 1 has the velocities times h and the accelerations times h².
    start = 0.0, h * beads.v[0], h * h * beads.given[0]
    moved = beads.next_y[0] - beads.y[0]
    end = moved, h * beads.next_v[0], h * h * beads.given[1]
    return kinks.fitted_curve(start, end, kinks.STRAIGHT)


@alone
def _drive_misfit(forcing: Forcing, beads: Beads, t: float, h: float) -> float:
    """Return the distance of a driven bead's motion in a step from its quintic."""
    curved, _ = kinks.value_and_slope(_drive_curve(beads, h), _OFF_MIDDLE)
    given, _, _ = drive_motion(forcing, t + h / 2, t + _OFF_MIDDLE * h)
    return float(abs(given - beads.y[0] - curved))


@inlined
def _follow_curve(
    law: Any, r: float, p: kinks.Curve, pair: Pair, h: float, points: Array
) -> None:
    """Compute a contact's δ, δ' and force at the stages along a curve p; they go to ``points``.

    δ' is the derivative by x, h times the rate; the force is that for unit stiffness.
    The correction is the integral of the force less the pair's quadrature of it. With both along p
    the error of p, a quintic, cancels in the difference.
    """
    for s in range(len(pair.nodes)):
        d, slope = kinks.value_and_slope(p, pair.nodes[s])
        points[0, s] = d
        points[1, s] = slope
        points[2, s] = push(law, r, d, slope / h)


@alone
def _follow_stages(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    pair: Pair,
    t: float,
    h: float,
    i: int,
) -> None:
    """Compute a contact's δ, δ' and force by the stages' own motion; they go to ``beads.points``.

    δ' is the derivative by x, h times the rate; the force is that for unit stiffness. The stages
    after a jump of the force are far off the curve of the contact.
    """
    points = beads.points
    for s in range(len(pair.nodes)):
        ch = pair.nodes[s] * h  # time from the step's start to stage s
        rate = beads.v[i]
        y = beads.y[i] + ch * rate
        # The motion of a driven bead is given. ``t + h/2``, the middle of the step, tells in which
        # interval of the drive's file the step lies: a stage at its end may lie in two.
        # Stage 0 is the last one of the step before: at a knot the cubics of both intervals differ
        # by rounding, of which a power such as δ^{1/4} makes 1e-4.
        if forcing is not None and forcing.driven and i == 0 and s > 0:
            y, rate, _ = drive_motion(forcing, t + h / 2, t + ch)
        d = chain.rest[i] + y - beads.y[i + 1] - ch * beads.v[i + 1]
        slope = h * (rate - beads.v[i + 1])
        # Stage s has moved a bead by h² Σ_j moments[s, j] f_j and changed its velocity by
        # h Σ_j impulses[s, j] f_j, with its accelerations f_j = ``beads.push[j]`` at the stages
        # before. A driven bead has 0 there: its inverse mass is 0.
        for j in range(s):
            bend = h * h * (beads.push[j, i] - beads.push[j, i + 1])
            d += pair.moments[s, j] * bend
            slope += pair.impulses[s, j] * bend
        points[0, s] = d
        points[1, s] = slope
        points[2, s] = push(chain.laws[chain.law[i]], chain.r[i], d, slope / h)


@alone
def _clipped(
    chain: Chain,
    forcing: Forcing,
    beads: Beads,
    pair: Pair,
    t: float,
    h: float,
    n: int,
) -> float:
    """Return the error of contact n's impulse by stages at which its damping is cut off wrongly.

    Contact n is beside a corrected contact, whose force jumps in the step. Damping may not pull, so
    the force of a contact is cut off at 0. At the stages after the jump the velocities are so far
    off that the force may be cut off although it is not in the step, or the reverse. Without the
    cut the force is linear in the velocity, and the errors of the stages cancel: this force, or 0
    throughout for a contact that does not push at the step's start, is taken for the true one.
    """
    law = chain.laws[chain.law[n]]
    last = len(pair.nodes) - 1
    _follow_stages(chain, forcing, beads, pair, t, h, n)
    # At the stages: δ, h dδ/dt and the force for unit stiffness
    d, slope, force = beads.points
    missed = 0.0
    if not d[0] > 0.0:
        return missed
    for s in range(last + 1):
        wanted = 0.0
        if force[0] > 0.0 and d[s] > 0.0:
            wanted = elastic(law, d[s])
            wanted += chain.r[n] * drag(law, d[s]) * slope[s] / h
        missed += pair.impulses[last, s] * (force[s] - wanted)
    return float(h * chain.A[n] * missed)


@part
def _steepness(law: Any, r: float, d: float, h: float) -> float:
    """Return how a contact's force ``F(d) + r d^p dδ/dt`` grows with its compression d in a step.

    Stiffness is 1, and r the damping coefficient over stiffness. A compression that is greater by ε
    at the end of the step h has grown faster by ε/h: damping adds ``r d^p/h`` to the elastic
    stiffness. An open contact is not damped, and its negative d has no power p.
    """
    return r * drag(law, max(d, 0.0)) / h + stiffness(law, d)


@inlined
def _replace_estimates(
    chain: Chain, beads: Beads, plan: Plan, h: float, i: int
) -> None:
    """Take a corrected contact's share away from the pair's estimates of the errors.

    Row q of ``errors`` is in turn of displacement and of velocity, and column i belongs to bead i.
    Row 2 of ``beads.points`` is the contact's force at the stages, for unit stiffness.
    """
    for q in range(len(plan.scheme.errors)):
        seen = integral(plan.scheme.errors[q], beads.points[2])
        seen *= chain.A[i] * error_scale(plan, h, q)
        beads.errors[q, i] += seen * chain.inverse[i]
        beads.errors[q, i + 1] -= seen * chain.inverse[i + 1]


@part
def _correct_heat(
    chain: Chain, beads: Beads, pair: Pair, i: int, work: float, stored: float
) -> None:
    """Correct the heat of a step: the work of a contact's force, less the energy it stores.

    ``work`` and ``stored`` are accurate. The pair's quadrature of the heat over the stages, which
    `validation.lattice.kernel.pair.end_step` adds, is taken away; the weights are those of an
    impulse, in the last row of ``impulses`` and row 1 of ``errors``.
    """
    law = chain.laws[chain.law[i]]
    last = len(pair.nodes) - 1
    heat = work - stored
    # At the stages: δ, h dδ/dt and the force for unit stiffness
    d, slope, force = beads.points
    for s in range(last + 1):
        lost = (force[s] - elastic(law, d[s])) * slope[s]
        heat -= pair.impulses[last, s] * lost
        beads.books[HEAT_ERROR] += chain.A[i] * pair.errors[1, s] * lost
    beads.books[HEAT] += chain.A[i] * heat


@alone
def _correct_work(
    chain: Chain, beads: Beads, pair: Pair, drive: kinks.Curve, work: float
) -> None:
    """Correct the work of the drive, which moves the first bead along a curve, in a step.

    ``work`` is accurate, for unit stiffness. The pair's quadrature of the power over the stages is
    taken away, as in `_correct_heat`; row 2 of ``beads.points`` is the contact's force there.
    """
    last = len(pair.nodes) - 1
    A = chain.A[0]
    beads.books[WORK] = A * work
    for s in range(last + 1):
        # Speed and power by x: over the step they are h times those by time.
        _, speed = kinks.value_and_slope(drive, pair.nodes[s])
        power = A * beads.points[2, s] * speed
        beads.books[WORK] -= pair.impulses[last, s] * power
        beads.books[WORK_ERROR] += pair.errors[1, s] * power


@part
def _count_error(books: Array, missed: float, near: float, far: float) -> None:
    """Count an error of a contact's impulse, over the tolerance of velocities, for both beads.

    near, far : inverse masses of the two beads.
    """
    books[SQUARES] += missed * missed * (near * near + far * far)


@inlined
def _correct_neighbour(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    t: float,
    h: float,
    n: int,
    share: float,
    moment: float,
    third: float,
    jump: float,
) -> None:
    """Correct the impulse of contact n by the moments of a corrected contact beside it.

    share : ``-1/m`` of the bead between both contacts: a moment of the corrected contact changes δ
    of contact n by ``moment/m``, and a force changes δ″ by ``force/m``. moment, third : corrections
    of ``h² ∫ (1 - x) F dx`` and ``h³ ∫ (1 - x)²/2 F dx`` of the corrected contact. jump : jump of
    its force, 0 without one.
    """
    law = chain.laws[chain.law[n]]
    A = chain.A[n]
    r = 0.0 if forcing is None else chain.r[n]
    near = chain.inverse[n]
    far = chain.inverse[n + 1]
    # Compression and rate at the step's end, as they are corrected so far; ``pressed`` below is the
    # total force there before the corrections.
    d = chain.rest[n] + beads.next_y[n] - beads.next_y[n + 1]
    rate = beads.next_v[n] - beads.next_v[n + 1]
    # A mark of 1 says that the neighbour has a kink of its own in this step and is corrected by
    # itself; what is missed by that, or without a mark, is counted as error.
    if jump != 0.0 and beads.marks[n] > 0.0:
        # The jump bends the neighbour's curve, too, and shifts the place of its own jump: by the
        # distance over the speed, at most a step. `OPENS` stands for a δ, or a speed, of 0.
        fast = abs(rate)
        own = A * push(law, r, kinks.OPENS, fast)
        shift = _UNBENT * h * h * abs(jump * share)
        missed = own * min(shift / max(fast, kinks.OPENS), h)
        _count_error(beads.books, missed / plan.v, near, far)
    elif forcing is not None and jump != 0.0 and r > 0.0 and not law.sticks:
        # The jump changes velocities, so that damping is cut off at the wrong stages.
        missed = _clipped(chain, forcing, beads, plan.scheme, t, h, n)
        _count_error(beads.books, missed / plan.v, near, far)
    pressed = beads.force[1, n + 1] + chain.load[n]
    if beads.marks[n] == 0.0 and (d > 0.0) != (pressed > 0.0):
        # The correction closes, or opens, a neighbour that just touches, at any time of the step.
        missed = h * (A * push(law, r, d, rate) - pressed)
        _count_error(beads.books, missed / plan.v, near, far)
    if law.pulls or (d > 0.0 and pressed > 0.0):
        resisted = -A * r * drag(law, d) * moment * share
        more = resisted - A * stiffness(law, d) * third * share
        beads.next_v[n] -= more * near
        beads.next_v[n + 1] += more * far
        _count_error(beads.books, _SECOND * more / plan.v, near, far)
        # The neighbour's heat is ∫ c v² dt, with v its rate and c = A r d^p. The correction changes
        # v by some Δv, whose integral is moment/m, and so the heat by 2 c v ∫ Δv dt.
        beads.books[HEAT] += 2.0 * resisted * rate
    elif r > 0.0 and not law.sticks:
        # The neighbour has stopped pushing: its elastic energy turns into heat.
        beads.books[HEAT] += A * max(elastic(law, d), 0.0) * moment * share


@part
def _is_faint(
    chain: Chain, plan: Plan, h: float, i: int, start: kinks.State, end: kinks.State
) -> bool:
    """Return True for a contact that cannot push enough to matter, between a step's two ends."""
    law = chain.laws[chain.law[i]]
    # A state is δ, δ' and δ'' by x: the tangent at the step's start comes to start[0] + start[1] at
    # its end, the tangent at the end to end[0] - end[1] at the start. The greatest of these and of
    # both δ is taken for the greatest compression.
    deepest = max(start[0], end[0], start[0] + start[1], end[0] - end[1])
    fastest = max(abs(start[1]), abs(end[1]))
    most = chain.A[i] * push(law, chain.r[i], deepest, fastest / h)
    kicked = h * most * max(chain.inverse[i], chain.inverse[i + 1]) / plan.v
    # While a contact opens, its elastic energy can turn into heat without a push.
    heated = most * (deepest + fastest) / plan.energy
    # Both are in units of the tolerances ``plan.v`` and ``plan.energy``. A law that is no power may
    # push more at a compression less than the deepest: it counts as not faint.
    return not law.generated and max(kicked, heated) < _FAINT


@inlined
def correct_contact(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    t: float,
    h: float,
    i: int,
) -> bool:
    """Correct a step for the pair's error at contact i, which opens or closes.

    Returns False for a damped contact that is too faint to be corrected; its mark is taken away.

    The error is the pair's quadrature of the contact's force less the accurate integral. Both are
    taken along the curve of the compression, which ends where the corrected beads are: the rounds
    repeat the correction from its own end. Then the contact's beads and its neighbours are
    corrected, and what is left is counted as error: the misfit of the curve (``misfit``), the last
    change of the impulse (``change``) and part of the effect on the contact itself.
    """
    pair = plan.scheme
    last = len(pair.nodes) - 1
    law = chain.laws[chain.law[i]]
    A = chain.A[i]
    r = 0.0 if forcing is None else chain.r[i]
    near = chain.inverse[i]
    far = chain.inverse[i + 1]
    both = near + far
    bend = -A * h * h * both  # change of p'' by a force of 1
    # States: δ, δ' and δ'' by x at the step's two ends
    start, end = _ends(chain, beads, plan, h, i)
    damped = forcing is not None and forcing.damped
    if damped and _is_faint(chain, plan, h, i, start, end):
        beads.marks[i] = 0.0
        return False
    driven = kinks.NOT_DRIVEN
    drive = kinks.NO_CURVE
    if forcing is not None:
        driven = i == 0 and forcing.driven
        drive = _drive_curve(beads, h)
    force = beads.points[2]  # the contact's, at the stages, for unit stiffness
    impulse = moment = change = steepness = top = closed = 0.0
    known = kinks.STRAIGHT
    # The force also depends on the corrected end, all the more the later it jumps.
    for _ in range(_ROUNDS):
        # The state at the end with the corrections of the beads so far; ``own`` is the change of
        # the contact's force by them.
        d = end[0] - both * moment
        rise = end[1] - both * h * impulse
        own = push(law, r, d, rise / h) - push(law, r, end[0], end[1] / h)
        corrected = d, rise, end[2] + bend * own
        found = kinks.resolved(law, r, start, corrected, h, bend, known, beads.edges)
        known = found.curve[6]  # the bend, for the next round
        sums = kinks.integrals(
            law, r, found, h, 1.0, bend, beads.points, beads.edges, driven, drive
        )
        if found.jump == 0.0:
            _follow_curve(law, r, found.curve, pair, h, beads.points)
        else:
            _follow_stages(chain, forcing, beads, pair, t, h, i)
        # Accurate integral less the pair's quadrature, as an impulse and as a moment
        before = impulse
        impulse = h * A * (sums.impulse - integral(pair.impulses[last], force))
        moment = h * h * A * (sums.moment - integral(pair.moments[last], force))
        # A corrected curve may miss the contact that it is corrected for.
        top = max(top, found.top)
        closed = max(closed, sums.closed)
        steepness = _steepness(law, r, top, h)
        change = impulse - before
        if r > 0.0 and abs(elastic(law, kinks.OPENS)) < _NO_JUMP:
            # The next round changes the correction by about this share of the change.
            change *= min(1.0, abs(bend) * steepness)
        elif found.jump == 0.0:
            # An elastic force feels the correction only while the contact pushes.
            change *= _FELT * abs(bend) * steepness * closed * closed
        if abs(change) * both < _SETTLED * plan.v:
            break
    if r > 0.0:
        after = 0.0
        if found.intervals > 1:
            after = 1.0 - beads.edges[1]  # from the first place inside the step on
        elif start[0] < end[0]:
            after = 1.0  # the contact has just closed
        beads.books[AFTER] = max(beads.books[AFTER], after)
    third = h * h * h * A * (sums.third - integral(pair.thirds, force))
    _replace_estimates(chain, beads, plan, h, i)
    beads.next_v[i] -= impulse * near
    beads.next_v[i + 1] += impulse * far
    beads.next_y[i] -= moment * near
    beads.next_y[i + 1] += moment * far
    misfit = _MISFIT * sums.rough
    resisted = 0.0
    if forcing is not None:
        # Heat and work see the stages' velocities, which err where a contact opens or closes: up to
        # 1,500 tolerances of energy. Where a neighbour does, too, its jump bends this curve, of
        # which the stages know. Entry -1 of the marks, before contact 0, is padding: 0. Beside a
        # jump of the force the last round has followed the stages already.
        lone = beads.marks[i - 1] + beads.marks[i + 1] == 0.0
        if found.jump == 0.0 and sums.closed < 1.0 and lone:
            _follow_stages(chain, forcing, beads, pair, t, h, i)
        if forcing.damped:
            stored = kinks.stored(law, corrected[0]) - kinks.stored(law, start[0])
            _correct_heat(chain, beads, pair, i, sums.work, stored)
        if driven:
            _correct_work(chain, beads, pair, drive, sums.driven)
            misfit += _drive_misfit(forcing, beads, t, h)
        # The moment ∫ (1 - x) F dx and the heat ∫ r δ^p (dδ/dt)² dt of damping are as wrong as p.
        resisted = misfit * A * r * drag(law, top + misfit)
        heated = 2.0 * resisted * abs(start[1]) / h / plan.energy
        beads.books[SQUARES] += heated * heated
        _count_error(beads.books, h * resisted / plan.y, near, far)
    depth = top + misfit
    # The impulse of an elastic force is as wrong, but less so where the contact is hardly closed:
    # half of that error is counted.
    missed = 0.5 * misfit * h * A * stiffness(law, depth)
    if found.jump != 0.0:
        # The jump comes too early or too late by the misfit there over the slope. The misfit
        # of `_MISFIT` is 2.2 times its mean in the middle of the step.
        place = known[0]  # where the bend begins
        _, slope = kinks.value_and_slope(found.curve, place)
        arch = 4.0 * place * (1.0 - place)
        shift = 2.2 * misfit * arch * arch * arch / max(abs(slope), kinks.OPENS)
        missed += h * A * abs(found.jump) * min(shift, 1.0)
    if driven:
        # Damping c δ^p brakes a graze by the impulse c δ^p times the depth.
        missed += resisted
        # No motion of another bead may limit the step: the rule of the integrals errs, too.
        share = 1.0
        # A steep force of a small δ is 0 as a float, and tells nothing of damping.
        own = elastic(law, top)
        if own > 0.0 and not law.generated:
            # Its errors of damping and of the elastic force are as their sizes.
            fastest = max(abs(start[1]), abs(end[1])) / h
            share += r * drag(law, top) * fastest / own
        work = (missed * abs(beads.v[0]) + A * sums.missed * share) / plan.energy
        beads.books[SQUARES] += work * work
    _count_error(beads.books, math.hypot(missed, change) / plan.v, near, far)
    # The stages lack this contact's own correction: its impulse errs by stiffness × third and by
    # damping × moment. Beside a jump the force was taken from these stages, so that the correction
    # made up for this, and what is left is the effect of that correction in turn.
    if top > 0.0:
        resisted = r * drag(law, top) * moment
        more = A * both * (stiffness(law, top) * third + resisted)
        if found.jump != 0.0:
            more *= bend * steepness
        _count_error(beads.books, _SECOND * more / plan.v, near, far)
    jump = A * found.jump
    # The contact behind is joined by bead i, the contact ahead by bead i + 1.
    for n, share in ((i - 1, -near), (i + 1, -far)):
        if n >= 0:
            _correct_neighbour(
                chain, forcing, beads, plan, t, h, n, share, moment, third, jump
            )
    return True
