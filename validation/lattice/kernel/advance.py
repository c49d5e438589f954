"""The loop over the steps of an integration."""

from __future__ import annotations

from typing import Any

from validation.lattice.kernel.arrays import BLOCK, SHORTEST, Beads, Chain, Knots, Plan
from validation.lattice.kernel.compiled import SOURCES, ZERO, cached
from validation.lattice.kernel.force import press
from validation.lattice.kernel.pair import accepted
from validation.lattice.kernel.samples import keep
from validation.lattice.kernel.splitting import split
from validation.lattice.kernel.window import follow


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
            press(chain, beads.y, beads.force, ZERO, 0, plan.size, 0.0)
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
                split(chain, beads, plan, h, at.lo, hi)
            elif not accepted(chain, beads, plan, at, h, hi):
                continue
            at.steps += 1
            at.t = later
            follow(chain, beads, plan, at)
            keep(chain, beads, plan, knots, at, hi)
        return at.t, sources

    return advance


advance = _built(SOURCES)
