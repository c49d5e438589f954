"""The loop over the steps of an embedded pair, and the front of the motion."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import BLOCK, MARGIN, SHORTEST, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import SOURCES, ZERO, cached, inlined
from validation.lattice.kernel.force import contact_forces
from validation.lattice.kernel.pair import (
    accept_step,
    correct_contact,
    evaluate_stages,
    mark_kinks,
    place_of_jump,
    reject_step,
    step_error,
)
from validation.lattice.kernel.samples import store_knot

_STILL = 1e-13  # in units of the greatest compression: beads that have moved less are still


@inlined
def moving(now: Any) -> int:
    """Return the number of beads to be moved, a multiple of `BLOCK`."""
    return int(max(SHORTEST, -(-now.front // BLOCK) * BLOCK))


@inlined
def advance_front(beads: Beads, plan: Plan, now: Any) -> None:
    """Move the front to the first bead that is still."""
    while now.front < plan.size and abs(beads.y[now.front - MARGIN]) > _STILL * plan.deepest:
        now.front += 1


def _built(sources: int) -> Any:
    """Compile `advance`; its cache is for source code with the hash ``sources``."""

    @cached
    def advance(
        chain: Chain, beads: Beads, plan: Plan, knots: Knots, now: Any, tries: int
    ) -> tuple[float, int]:
        """Integrate to the end, or for at most ``tries`` tried steps, or until the knots are full.

        Returns the time that is reached, and ``sources``.
        """
        until, moved, fresh, hi = now.tries + tries, now.tries == 0, now.tries > 0, plan.size
        while True:
            # The loops of the forces are compiled at each place that calls them.
            if not fresh:
                contact_forces(chain, beads, plan, beads.y, beads.v, ZERO, hi)
                fresh = True
            if moved:
                store_knot(chain, beads, knots, now)
            if not (now.t < plan.end and now.tries < until and now.stored < len(knots.time)):
                return now.t, sources
            hi = moving(now)
            now.tries += 1
            h, stop = now.h, plan.stops[now.stop]
            stopping = now.t + h > stop - 1e-9 * h
            if stopping:
                now.planned, h = max(now.planned, h), stop - now.t
            evaluate_stages(chain, beads, plan, now.t, h, hi)
            place, jumps = place_of_jump(chain, beads, plan, h, hi) if plan.jumps else (1.0, 0)
            if place < 1.0:
                now.planned, now.h = max(now.planned, h), h * place
                moved, fresh = False, True
                continue
            marks = mark_kinks(chain, beads, plan, h, hi)
            if marks > 0:
                for i in range(hi):
                    if beads.sums[0, i + 1] > 0.0:
                        correct_contact(chain, beads, plan, h, i)
            error = step_error(chain, beads, plan, h, hi)
            moved = error <= 1.0
            fresh = not moved or jumps + marks == 0
            if moved:
                accept_step(beads, plan, now, h, hi, error)
                now.steps += 1
                now.t = stop if stopping else now.t + h
                now.stop += 1 if stopping else 0
                advance_front(beads, plan, now)
            else:
                reject_step(beads, plan, now, h, error)

    return advance


advance = _built(SOURCES)
