"""Range of the moving beads: from a window's rear, if there is one, to the front."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import MARGIN, Beads, Chain, Plan
from validation.lattice.kernel.compiled import part
from validation.lattice.kernel.force import elastic

_STILL = 1e-13  # in units of the greatest compression: beads that have moved less are still


@part
def follow(chain: Chain, beads: Beads, plan: Plan, at: Any) -> None:
    """Move the front to the first bead that is still, and a window's rear after the front.

    The energy and the time of contacts and beads that the window leaves go to ``at`` and ``beads``.
    """
    while at.front < plan.size and abs(beads.y[at.front - MARGIN]) > _STILL * plan.deepest:
        at.front += 1
    while plan.window > 0 and at.front - at.lo > plan.window:
        lo = at.lo
        at.lost += elastic(chain, beads, lo)
        beads.left[lo] = at.t
        at.lo = lo + 1
        for s in range(len(beads.force)):
            beads.force[s, lo + 1] = 0.0
