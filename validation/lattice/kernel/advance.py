"""The loop over the steps of an embedded pair, and the front of the motion."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import BLOCK, MARGIN, SHORTEST, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import SOURCES, ZERO, cached, part
from validation.lattice.kernel.force import contact_forces
from validation.lattice.kernel.pair import accepted
from validation.lattice.kernel.samples import store_knot

_STILL = 1e-13  # in units of the greatest compression: beads that have moved less are still


@part
def moving(now: Any) -> int:
    """Return the number of beads to be moved, a multiple of `BLOCK`."""
    return int(max(SHORTEST, -(-now.front // BLOCK) * BLOCK))


@part
def cut(plan: Plan, now: Any) -> tuple[float, float]:
    """Return the length of the next step and its end, which is the next stop if that is as near."""
    h, stop = now.h, plan.stops[now.stop]
    if now.t + h > stop - 1e-9 * h:
        now.planned = max(now.planned, h)
        return stop - now.t, stop
    return h, now.t + h


@part
def follow(beads: Beads, plan: Plan, now: Any) -> None:
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
        until, stages = now.tries + tries, len(plan.scheme.nodes) - 1
        moved, hi = now.tries == 0, plan.size
        while True:
            # The forces are compiled into each place that calls them, and take the most time there.
            if moved:
                contact_forces(chain, beads, plan, beads.y, ZERO, hi)
                beads.power[1, 0] = beads.v[0] * beads.force[0, 1] if chain.drive.driven else 0.0
                store_knot(chain, beads, knots, now)
            if not (now.t < plan.end and now.tries < until and now.stored < len(knots.time)):
                return now.t, sources
            hi = moving(now)
            now.tries += 1
            now.evaluations += stages * hi
            h, later = cut(plan, now)
            moved = accepted(chain, beads, plan, now, h, hi)
            if moved:
                now.steps += 1
                now.t = later
                now.stop += 1 if later == plan.stops[now.stop] else 0
                follow(beads, plan, now)

    return advance


advance = _built(SOURCES)
