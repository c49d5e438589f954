"""A step of a symplectic splitting."""

from __future__ import annotations

from validation.lattice.kernel.arrays import Beads, Chain, Plan
from validation.lattice.kernel.compiled import ONE, ZERO, compiled, index
from validation.lattice.kernel.force import NOTHING, press


@compiled
def split(chain: Chain, beads: Beads, plan: Plan, h: float, lo: int, hi: int) -> None:
    """Advance beads lo … hi-1 by one step h; y and v are updated in place."""
    nothing, kicks, drifts = NOTHING * plan.deepest, plan.scheme.kicks, plan.scheme.drifts
    y, v, force, inverse = beads.y, beads.v, beads.force, chain.inverse
    for s in range(len(drifts)):
        if s > 0:  # the first kick is 0
            press(chain, y, force, ZERO, lo, hi, nothing)
        b, a = h * kicks[s], h * drifts[s]
        for i in range(index(lo), index(hi)):
            u = v[i] + b * (force[ZERO, i] - force[ZERO, i + ONE]) * inverse[i]
            v[i] = u
            y[i] = y[i] + a * u
