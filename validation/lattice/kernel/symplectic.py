"""The symplectic loop: kicks and drifts with a fixed step (`validation.lattice.schemes.Splitting`).

A kick adds b h F(y)/m to the velocities, a drift adds a h v to the displacements. The last kick of
a step and the first kick of the next step use the same forces.
"""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.advance import advance_front, moving
from validation.lattice.kernel.arrays import TILE, Beads, Chain, Forcing, Knots, Plan
from validation.lattice.kernel.compiled import FIRST, cached, index
from validation.lattice.kernel.force import contact_forces, tile_bounds
from validation.lattice.kernel.samples import store_knot


@cached
def advance_split(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    knots: Knots,
    now: Any,
    tries: int,
) -> float:
    """Integrate to the end, or for at most ``tries`` steps, or until the knots are full.

    Returns the time that is reached.
    """
    kicks = plan.scheme.kicks
    drifts = plan.scheme.drifts
    h = plan.h
    until = now.tries + tries
    last = len(drifts)
    y = beads.y
    v = beads.v
    # The steps go through the chain in tiles, since memory is slow: all stages of a step are done
    # in a tile before the next tile. Stage s ends s beads before the end of the tile: the force of
    # the last bead needs the bead ahead, which belongs to the next tile (`tile_bounds`).
    # The accelerations, also for the knots
    push = beads.push[0]
    # A stage for the dissipated power, and the first contact: both are number 0.
    contact_forces(chain, forcing, beads, plan, y, v, push, FIRST, FIRST, plan.size)
    if now.tries == 0:
        store_knot(forcing, beads, knots, now)
    while now.t < plan.end and now.tries < until and now.stored < len(knots.time):
        hi = moving(now)
        for tile in range(0, hi + last, TILE):
            for s in range(last):
                lo, up, first, behind = tile_bounds(tile, s, hi)
                if lo >= up:
                    continue
                b = h * kicks[s]
                a = h * drifts[s]
                for i in range(index(lo), index(up)):
                    u = v[i] + b * push[i]
                    v[i] = u
                    y[i] = y[i] + a * u
                contact_forces(
                    chain, forcing, beads, plan, y, v, push, FIRST, first, behind
                )
        b = h * kicks[last]
        for i in range(index(hi)):
            v[i] = v[i] + b * push[i]
        now.tries += 1
        now.steps += 1
        # No sum of steps: equal steps are rounded to one side, 1e-10 after 1e5 of them. Half a step
        # more keeps rounding from adding a step.
        now.t = now.steps * h if now.t + 1.5 * h < plan.end else plan.end
        advance_front(beads, plan, now)
        store_knot(forcing, beads, knots, now)
    return float(now.t)
