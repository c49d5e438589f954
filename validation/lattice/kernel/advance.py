"""The loop over the steps of an integration, the front of the motion, and splitting steps."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import BLOCK, MARGIN, SHORTEST, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import ONE, SOURCES, ZERO, cached, index, part
from validation.lattice.kernel.force import contact_forces
from validation.lattice.kernel.pair import accepted
from validation.lattice.kernel.samples import store_knot

_STILL = 1e-13  # in units of the greatest compression: beads that have moved less are still


@part
def _split(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> None:
    """Advance beads 0 … hi-1 by a step h of a splitting scheme; y and v are updated in place."""
    kicks, drifts = plan.scheme.kicks, plan.scheme.drifts
    y, v, force, inverse = beads.y, beads.v, beads.force, chain.inverse
    for s in range(len(drifts)):
        if s > 0:  # the first kick is 0
            contact_forces(chain, beads, plan, y, ZERO, hi)
        b, a = h * kicks[s], h * drifts[s]
        for i in range(index(hi)):
            u = v[i] + b * (force[ZERO, i] - force[ZERO, i + ONE]) * inverse[i]
            v[i] = u
            y[i] = y[i] + a * u


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
        until, pair = now.tries + tries, len(plan.scheme.nodes) > 0
        stages = max(len(plan.scheme.nodes), len(plan.scheme.drifts)) - 1
        moved, hi = now.tries == 0, plan.size
        while True:
            # The forces are compiled into each place that calls them, and take the most time there.
            if moved and (pair or len(knots.watched) > 0):
                contact_forces(chain, beads, plan, beads.y, ZERO, hi)
                beads.power[1, 0] = beads.v[0] * beads.force[0, 1] if chain.drive.driven else 0.0
                store_knot(chain, beads, knots, now)
            if not (now.t < plan.end and now.tries < until and now.stored < len(knots.time)):
                return now.t, sources
            hi = moving(now)
            now.tries += 1
            now.evaluations += stages * hi
            h, later = cut(plan, now)
            moved = True
            if pair:
                moved = accepted(chain, beads, plan, now, h, hi)
            else:
                _split(chain, beads, plan, h, hi)
                # no sum of steps: equal steps are rounded to one side, 1e-10 after 1e5 of them
                later = (now.steps + 1) * h if later < plan.end else later
            if moved:
                now.steps += 1
                now.t = later
                now.stop += 1 if later == plan.stops[now.stop] else 0
                follow(beads, plan, now)

    return advance


advance = _built(SOURCES)
