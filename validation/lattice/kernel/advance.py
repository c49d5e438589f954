"""The loop over the steps of an embedded pair, and the front of the motion.

`inlined` is numba's ``njit`` with options (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import (
    BLOCK,
    MARGIN,
    SHORTEST,
    SQUARES,
    Beads,
    Chain,
    Forcing,
    Knots,
    Plan,
)
from validation.lattice.kernel.compiled import cached, inlined
from validation.lattice.kernel.corrections import (
    correct_contact,
    mark_kinks,
    next_mark,
)
from validation.lattice.kernel.pair import (
    begin_step,
    end_step,
    estimate_errors,
    evaluate_stages,
    step_error,
)
from validation.lattice.kernel.samples import store_knot

# In units of the greatest compression: beads that have moved less are still. With `MARGIN` beads
# besides this is far below the least rtol (`validation.lattice.kernel.arrays` has a measurement).
_STILL = 1e-13


@inlined
def moving(now: Any) -> int:
    """Return the number of beads to be moved, a multiple of `BLOCK`."""
    return int(max(SHORTEST, -(-now.front // BLOCK) * BLOCK))


@inlined
def advance_front(beads: Beads, plan: Plan, now: Any) -> None:
    """Move the front ahead until the last `MARGIN` beads before it are still, or to the end."""
    still = _STILL * plan.deepest
    while now.front < plan.size and abs(beads.y[now.front - MARGIN]) > still:
        now.front += 1


@cached
def advance(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    knots: Knots,
    now: Any,
    tries: int,
) -> float:
    """Integrate to the end, or for at most ``tries`` tried steps, or until the knots are full.

    Returns the time that is reached. The integration also stops at a time to which no step can
    be added, and where the response is greater than ``plan.most``.
    """
    until = now.tries + tries
    h = now.h
    hi = plan.size  # beads that are moved; all of them at the start
    # The forces at the time reached are computed once more after a step that was corrected, and
    # first of all at the start of a run. A call that goes on finds them, and a stored knot.
    again = now.tries == 0
    while True:
        if not again:
            full = now.stored == len(knots.time)
            if now.t == plan.end or full or now.response > plan.most:
                return float(now.t)
            h = now.h
            left = plan.stops[now.stop] - now.t
            # A rest of rounding would be a step of no length.
            stopping = h > left - 1e-9 * h
            if stopping:
                h = left
            if now.tries == until or now.t + h == now.t:
                return float(now.t)
            hi = moving(now)
            now.tries += 1
        evaluate_stages(chain, forcing, beads, plan, now.t, h, hi, again)
        made = again
        if again:
            again = False
        else:
            estimate_errors(beads, plan, h, hi)
            beads.books[:] = 0.0
            marks = mark_kinks(chain, forcing, beads, plan, h, hi)
            corrected = False
            i = -1
            for _ in range(marks):
                i = next_mark(beads.marks, i + 1)
                if correct_contact(chain, forcing, beads, plan, now.t, h, i):
                    corrected = True
                if beads.books[SQUARES] > 1.0:
                    break  # the step is refused, whatever the other contacts add
            error = step_error(beads, plan, h, hi)
            made = end_step(beads, plan, now, h, error, stopping)
            again = made and corrected
        if made and not again:
            begin_step(beads, plan, hi)
            advance_front(beads, plan, now)
            store_knot(forcing, beads, knots, now)
