"""A step of an embedded Runge–Kutta–Nyström pair: its stages, its error and the length of the next.

h is the step, and x, from 0 to 1, the time within the step. Between the stages and the error the
step is corrected for contacts that open or close (`validation.lattice.kernel.corrections`).

`part`, `summed`, `inlined` and `alone` are numba's ``njit`` with options, and `index` makes an
index unsigned, so that a loop vectorises (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

import math
from typing import Any

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import (
    AFTER,
    GROUP,
    HEAT,
    HEAT_ERROR,
    SQUARES,
    TILE,
    WORK,
    WORK_ERROR,
    Beads,
    Chain,
    Forcing,
    Plan,
)
from validation.lattice.kernel.compiled import (
    ONE,
    ZERO,
    index,
    inlined,
    part,
    summed,
)
from validation.lattice.kernel.force import contact_forces, drive_motion, tile_bounds

# Step-size control of Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.4.
# An error scales as h^order. The next step is _SAFETY times the step with an error equal to the
# tolerance, as a rejected step costs as much as an accepted one. _GROWTH bounds the effect of an
# error that is small by chance, _SHRINKAGE that of an error too large for the power. Measured on
# nine scenes at 1e-6 … 1e-10: the work for the same error is the same to 4 % for a safety of 0.8 to
# 0.95 and a growth of 1.5 to 10; a safety of 0.7 costs 8 % more, 0.98 costs 11 % more.
_SAFETY, _GROWTH, _SHRINKAGE = 0.9, 5.0, 0.1
# The error of a step with a kink of a damped contact is mostly that of the part after the kink, of
# about this order: the next try ends a little after the kink. Measured on chains of 10 to 60 beads:
# a tenth to a fifth fewer tries for the same error than by the pair's order alone, and the same to
# 5 % for orders of 2.5 to 4.
_KINK_SAFETY, _KINK_ORDER = 0.8, 2.5
# Error, in units of the tolerance, of which the power says nothing; nor does it of NaN.
_HOPELESS = 1e9
# A third solution of low order, where a pair has one, weighs so much in the estimate of the error
# (Hairer, Nørsett and Wanner, II.10).
_THIRD = 0.01
# Where that solution is far off, the estimate says too little of an integral: 90 times for the work
# of a driven bead at a stiff contact. Heat and work err by a thousandth, at least, of the
# difference of the two other solutions; measured 1e-4 to 2e-2. The share is that of squares.
_LEAST = 1e-3**2
# The difference of the two better solutions may be small by chance. Between errors e and d relative
# to the motion, of orders 8 and 4 in the step, e/d² is about constant: the estimate is no less than
# _EXPECTED times d², nor than that difference. Where δ^40 to δ^200 with damping begins to push, the
# error was 400 … 1,300 times the estimate, and 0.06 … 0.12 d².
_EXPECTED = 0.01


@part
def _add_stages(
    target: Array,
    scale: float,
    weights: Array,
    count: int,
    push: Array,
    lo: int,
    hi: int,
) -> None:
    """Add ``scale Σ_s weights[s] push[s]`` over ``count`` stages to beads lo … hi-1 of ``target``.

    Four stages at a time, written out: a loop over the stages of a bead would not vectorise. The
    weights of stages beyond ``count`` are 0.
    """
    for s in range(index(0), index(count), index(GROUP)):
        a = scale * weights[s]
        b = scale * weights[s + ONE]
        c = scale * weights[s + index(2)]
        d = scale * weights[s + index(3)]
        for i in range(index(lo), index(hi)):
            target[i] += (
                a * push[s, i]
                + b * push[s + ONE, i]
                + c * push[s + index(2), i]
                + d * push[s + index(3), i]
            )


@part
def _add_stages_twice(
    y: Array,
    v: Array,
    y_scale: float,
    v_scale: float,
    y_weights: Array,
    v_weights: Array,
    count: int,
    push: Array,
    lo: int,
    hi: int,
) -> None:
    """Add stages to beads of two rows y and v, each with its own weights, as `_add_stages` does.

    What both rows need is read once: two thirds of the time.
    """
    for s in range(index(0), index(count), index(GROUP)):
        a = y_scale * y_weights[s]
        b = y_scale * y_weights[s + ONE]
        c = y_scale * y_weights[s + index(2)]
        d = y_scale * y_weights[s + index(3)]
        e = v_scale * v_weights[s]
        f = v_scale * v_weights[s + ONE]
        g = v_scale * v_weights[s + index(2)]
        k = v_scale * v_weights[s + index(3)]
        for i in range(index(lo), index(hi)):
            first = push[s, i]
            second = push[s + ONE, i]
            third = push[s + index(2), i]
            fourth = push[s + index(3), i]
            y[i] += a * first + b * second + c * third + d * fourth
            v[i] += e * first + f * second + g * third + k * fourth


@summed
def integral(row: Array, values: Array) -> float:
    """Return ``Σ row[s] values[s]`` over the stages s."""
    total = 0.0
    for s in range(index(len(row))):
        total += row[s] * values[s]
    return total


@inlined
def evaluate_stages(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    t: float,
    h: float,
    hi: int,
    again: bool,
) -> None:
    """Compute the accelerations of beads 0 … hi-1 at the stages of a step h that begins at time t.

    Bead ``hi`` is the first one that does not move yet. With ``again`` the last stage alone is
    computed once more, where a correction moved the beads.
    Stage 0 is the last stage of the step before (`begin_step`). The last stage is the step's end,
    whose displacements and velocities stay in ``next_y`` and ``next_v``.
    """
    pair = plan.scheme
    stages = len(plan.scheme.nodes)
    y = beads.y
    v = beads.v
    next_y = beads.next_y
    next_v = beads.next_v
    # Entry 0 of ``beads.given`` below holds the start of the step, entry 1 the stage computed last,
    # and so do rows 0 and 1 of the forces.
    push = beads.push
    # All stages go through a tile of beads while its memory is in the processor's cache. A force
    # depends on the bead ahead, so that stage s can be computed up to s beads before the tile's end
    # (`tile_bounds`): it lags by s beads, and ``hi + stages`` lets the last stage reach bead hi-1.
    # The force behind the first of them is that of the same stage in the tile before: later stages
    # of that tile end behind it.
    for tile in range(0, hi + stages, TILE):
        for s in range(stages - 1 if again else 1, stages):
            lo, up, first, behind = tile_bounds(tile, s, hi)
            if lo >= up:
                continue
            if not again:
                ch = pair.nodes[s] * h
                # Forces depend on velocities with damping alone; the end has them in any case.
                if s == stages - 1 or (forcing is not None and forcing.damped):
                    for i in range(index(lo), index(up)):
                        next_y[i] = y[i] + ch * v[i]
                        next_v[i] = v[i]
                    _add_stages_twice(
                        next_y,
                        next_v,
                        h * h,
                        h,
                        pair.moments[s],
                        pair.impulses[s],
                        s,
                        push,
                        lo,
                        up,
                    )
                else:
                    for i in range(index(lo), index(up)):
                        next_y[i] = y[i] + ch * v[i]
                    _add_stages(next_y, h * h, pair.moments[s], s, push, lo, up)
                # The motion of a driven bead is given. Steps end where intervals of the drive's
                # file meet: the middle of the step tells its interval, also for a stage at an end.
                if forcing is not None and forcing.driven and lo == 0:
                    given = drive_motion(forcing, t + h / 2, t + ch)
                    next_y[0], next_v[0], beads.given[1] = given
            contact_forces(
                chain, forcing, beads, plan, next_y, next_v, push[s], s, first, behind
            )


@part
def error_scale(plan: Plan, h: float, q: int) -> float:
    """Return the factor from accelerations to row q of the errors, in units of the tolerance."""
    if q % 2 == 0:
        return float(h * h / plan.y)
    return float(h / plan.v)


@inlined
def estimate_errors(beads: Beads, plan: Plan, h: float, hi: int) -> None:
    """Compute the pair's estimates of the errors of beads 0 … hi-1, in units of the tolerance."""
    for lo in range(0, hi, TILE):
        up = min(lo + TILE, hi)
        for q in range(0, len(beads.errors), 2):
            # Rows of errors, and of their weights, are of displacement and velocity in turn.
            y = beads.errors[q]
            v = beads.errors[q + 1]
            for i in range(index(lo), index(up)):
                y[i] = 0.0
                v[i] = 0.0
            _add_stages_twice(
                y,
                v,
                error_scale(plan, h, 0),
                error_scale(plan, h, 1),
                plan.scheme.errors[q],
                plan.scheme.errors[q + 1],
                len(plan.scheme.nodes),
                beads.push,
                lo,
                up,
            )


@summed
def _squared_error(errors: Array, row: int, hi: int) -> float:
    """Return the sum over all beads of the squared errors of displacements and velocities.

    Both kinds of errors are in units of their tolerances (`error_scale`).
    """
    total = 0.0
    ys = errors[row]
    vs = errors[row + 1]
    for i in range(index(hi)):
        total += ys[i] * ys[i] + vs[i] * vs[i]
    return total


@inlined
def step_error(beads: Beads, plan: Plan, h: float, hi: int) -> float:
    """Return the error of a step in units of the tolerance: of all beads, the heat and the work.

    e is the root of the sum of the squares. With a third solution, whose difference is d, the
    estimate is ``e²/√(e² + 0.01 d²)``, or the lesser of e and ``rtol d²/100`` if that is more;
    ``total`` is its square.
    """
    weights = plan.scheme.errors
    books = beads.books
    total = least = 0.0
    for q in range(0, len(weights), 2):
        # Row q of the weights is of displacements; row q + 1, of velocities, is of all integrals
        # over the step. Corrected contacts are taken out of the estimates.
        heat = h * integral(weights[q + 1], beads.power[HEAT]) - books[HEAT_ERROR]
        work = h * integral(weights[q + 1], beads.power[WORK]) - books[WORK_ERROR]
        missed = (heat * heat + work * work) / plan.energy**2
        squared = _squared_error(beads.errors, q, hi) + missed
        if q == 0:
            total = squared
            least = _LEAST * missed
        elif squared > 0.0:
            expected = _EXPECTED * plan.rtol * squared
            total = max(
                total * total / (total + _THIRD * squared),
                min(total, expected * expected),
            )
    # Besides the pair's own errors: those of the corrections at kinks
    return math.sqrt(total + least + books[SQUARES])


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
        # An error of 0 has no such power; from 1e-9 down `_GROWTH` is less than the factor.
        factor = _SAFETY * max(error, 1e-9) ** (-1.0 / pair.order)
        # Share of the step after the first kink of a damped contact, 0 without one. The part before
        # the kink is kept, and the part after it is shortened by its own error.
        after = beads.books[AFTER]
        if error > 1.0 and after > 0.0:
            kept = _KINK_SAFETY * error ** (-1.0 / _KINK_ORDER)
            factor = min(factor, 1.0 - after + after * kept)
    now.h = h * min(_GROWTH, max(_SHRINKAGE, factor))
    if not error <= 1.0:
        if factor == 0.0:
            beads.push[1:] = 0.0  # overflows must not last
        return False
    # The last row of ``impulses`` integrates over the step, here the dissipated power and that of
    # the drive at the stages. The books hold what the corrections at kinks add to the integrals.
    impulses = pair.impulses[len(pair.impulses) - 1]
    now.lost += h * integral(impulses, beads.power[HEAT]) + beads.books[HEAT]
    now.work += h * integral(impulses, beads.power[WORK]) + beads.books[WORK]
    # The energy of a law that attracts is less than 0.
    now.response = max(now.response, abs(now.energy + now.work - now.lost))
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
def begin_step(beads: Beads, plan: Plan, hi: int) -> None:
    """Move beads 0 … hi-1, and their forces, to the end of a step, the start of the next one."""
    last = len(plan.scheme.nodes) - 1  # the last stage, at the step's end
    for i in range(index(hi)):
        beads.y[i] = beads.next_y[i]
        beads.v[i] = beads.next_v[i]
        # There are two rows of forces: row 0 of the step's start, row 1 of the stage computed last,
        # which is the last stage. Column i + 1 holds the contact ahead of bead i. The accelerations
        # ``push`` have a row for every stage, and column i belongs to bead i.
        beads.force[ZERO, i + ONE] = beads.force[ONE, i + ONE]
        beads.push[ZERO, i] = beads.push[index(last), i]
    # Stage 0 of the next step is the last stage of this one: dissipated power, power of the drive.
    for balance in (HEAT, WORK):
        beads.power[balance, 0] = beads.power[balance, last]
    # The driven bead's accelerations at the step's start and end
    beads.given[0] = beads.given[1]
