"""The loop over the steps of an embedded pair, and the front of the motion."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import (
    BLOCK,
    MARGIN,
    SHORTEST,
    Beads,
    Chain,
    Knots,
    Plan,
)
from validation.lattice.kernel.compiled import SOURCES, cached, inlined
from validation.lattice.kernel.pair import (
    begin_step,
    correct_contact,
    end_step,
    evaluate_stages,
    mark_kinks,
    next_mark,
    place_of_jump,
    step_error,
)
from validation.lattice.kernel.samples import store_knot

_STILL = (
    1e-13  # in units of the greatest compression: beads that have moved less are still
)


@inlined
def moving(now: Any) -> int:
    """Return the number of beads to be moved, a multiple of `BLOCK`."""
    return int(max(SHORTEST, -(-now.front // BLOCK) * BLOCK))


@inlined
def advance_front(beads: Beads, plan: Plan, now: Any) -> None:
    """Move the front to the first bead that is still."""
    while (
        now.front < plan.size
        and abs(beads.y[now.front - MARGIN]) > _STILL * plan.deepest
    ):
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
        until, hi, h = now.tries + tries, plan.size, 0.0
        # The motion at a step's end is known, but not its forces: at first, or after a correction.
        moved = stale = now.tries == 0
        while True:
            if moved and not stale:
                begin_step(beads, plan, hi)
                advance_front(beads, plan, now)
                store_knot(chain, beads, knots, now)
            if not stale:
                if not (
                    now.t < plan.end
                    and now.tries < until
                    and now.stored < len(knots.time)
                ):
                    return now.t, sources
                hi = moving(now)
                now.tries += 1
                h = now.h
                if now.t + h > plan.stops[now.stop] - 1e-9 * h:
                    now.planned, h = max(now.planned, h), plan.stops[now.stop] - now.t
            # Compiled once for both: the loops of the forces take a tenth of the compilation.
            evaluate_stages(chain, beads, plan, now.t, h, hi, stale)
            if stale:
                stale = False
                continue
            place, jumps = (
                place_of_jump(chain, beads, plan, h, hi) if plan.jumps else (1.0, 0)
            )
            if place < 1.0:
                now.planned, now.h = max(now.planned, h), h * place
                moved = False
                continue
            marks = mark_kinks(chain, beads, plan, h, hi)
            i = -1
            for _ in range(marks):
                i = next_mark(beads.sums[0], i + 1)
                correct_contact(chain, beads, plan, h, i)
            error = step_error(chain, beads, plan, h, hi)
            moved = error <= 1.0
            stale = moved and jumps + marks > 0
            end_step(beads, plan, now, h, error)

    return advance


advance = _built(SOURCES)
