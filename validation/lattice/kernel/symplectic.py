"""The symplectic loop: kicks and drifts with a fixed step (`validation.lattice.schemes.Splitting`).

A kick adds b h F(y)/m to the velocities, a drift adds a h v to the displacements. The last kick of
a step and the first kick of the next step use the same forces.
"""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.advance import advance_front, moving
from validation.lattice.kernel.arrays import TILE, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import ONE, SOURCES, ZERO, cached, index
from validation.lattice.kernel.force import contact_forces, tile_bounds
from validation.lattice.kernel.samples import store_knot


def _built(sources: int) -> Any:
    """Compile `advance_split`; its cache is for source code with the hash ``sources``."""

    @cached
    def advance_split(
        chain: Chain, beads: Beads, plan: Plan, knots: Knots, now: Any, tries: int
    ) -> tuple[float, int]:
        """Integrate to the end, or for at most ``tries`` steps, or until the knots are full.

        Returns the time that is reached, and ``sources``.
        """
        kicks, drifts, h, until = (
            plan.scheme.kicks,
            plan.scheme.drifts,
            plan.h,
            now.tries + tries,
        )
        y, v, force, inverse = beads.y, beads.v, beads.force, chain.inverse
        last = len(drifts)
        contact_forces(chain, beads, plan, y, v, ZERO, 0, plan.size)
        if now.tries == 0:
            store_knot(chain, beads, knots, now)
        while now.t < plan.end and now.tries < until and now.stored < len(knots.time):
            hi = moving(now)
            for tile in range(0, hi + last, TILE):
                for s in range(last):
                    lo, up, first, behind = tile_bounds(tile, s, hi)
                    if lo < up:
                        b, a = h * kicks[s], h * drifts[s]
                        for i in range(index(lo), index(up)):
                            u = (
                                v[i]
                                + b
                                * (force[ZERO, i] - force[ZERO, i + ONE])
                                * inverse[i]
                            )
                            v[i] = u
                            y[i] = y[i] + a * u
                        contact_forces(chain, beads, plan, y, v, ZERO, first, behind)
            b = h * kicks[last]
            for i in range(index(hi)):
                v[i] = v[i] + b * (force[ZERO, i] - force[ZERO, i + ONE]) * inverse[i]
            now.tries += 1
            now.steps += 1
            # no sum of steps: equal steps are rounded to one side, 1e-10 after 1e5 of them
            now.t = now.steps * h if now.t + 1.5 * h < plan.end else plan.end
            advance_front(beads, plan, now)
            store_knot(chain, beads, knots, now)
        return now.t, sources

    return advance_split


advance_split = _built(SOURCES)
