"""The loop over the steps of an integration, the range of moving beads, and splitting steps."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import BLOCK, MARGIN, SHORTEST, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import ONE, SOURCES, ZERO, cached, compiled, index, part
from validation.lattice.kernel.force import NOTHING, elastic, press
from validation.lattice.kernel.pair import accepted
from validation.lattice.kernel.samples import keep

_STILL = 1e-13  # in units of the greatest compression: beads that have moved less are still


@compiled
def _split(chain: Chain, beads: Beads, plan: Plan, h: float, lo: int, hi: int) -> None:
    """Make a splitting step h of the beads lo … hi-1; y and v are updated in place."""
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


@part
def _follow(chain: Chain, beads: Beads, plan: Plan, at: Any) -> None:
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


def _built(sources: int) -> Any:
    """Compile `advance`; its cached machine code belongs to the hash ``sources``."""

    @cached
    def advance(
        chain: Chain, beads: Beads, plan: Plan, knots: Knots, at: Any, tries: int
    ) -> tuple[float, int]:
        """Integrate on to the end, for at most ``tries`` tried steps, or until the knots are full.

        Returns the time that is reached, and ``sources``.
        """
        until, pair = at.tries + tries, len(plan.scheme.nodes) > 0
        stages = max(len(plan.scheme.nodes), len(plan.scheme.drifts)) - 1
        if at.tries == 0:
            press(chain, beads.y, beads.force, ZERO, at.lo, plan.size, 0.0)
        hi = at.lo + max(SHORTEST, -(-(at.front - at.lo) // BLOCK) * BLOCK)
        if at.kept == 0:
            keep(chain, beads, plan, knots, at, hi)
        while at.t < plan.end and at.tries < until and at.kept < len(knots.time):
            hi = at.lo + max(SHORTEST, -(-(at.front - at.lo) // BLOCK) * BLOCK)
            at.tries += 1
            at.evaluations += stages * (hi - at.lo)
            h = at.h
            later = at.t + h if pair else (at.steps + 1) * h
            if later > plan.end - 1e-9 * h:
                later, h = plan.end, plan.end - at.t
            if not pair:
                _split(chain, beads, plan, h, at.lo, hi)
            elif not accepted(chain, beads, plan, at, h, hi):
                continue
            at.steps += 1
            at.t = later
            _follow(chain, beads, plan, at)
            keep(chain, beads, plan, knots, at, hi)
        return at.t, sources

    return advance


advance = _built(SOURCES)
