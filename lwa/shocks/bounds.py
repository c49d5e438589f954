"""Bounds of the differences between the theory of a shock and chains that a wall drives.

Measured on 330 chains of equal beads, driven until their pulses were steady:
powers k = 0.3 … 7 with load, k = 1.05 … 10 without, hertz2, magnetic, polynomial, lennard-jones,
c₋/c₊ up to 200. With V the speed and B the rise of the leading pulse,

    ρ = 1 - V²/F′(p₊+B)

says how much the law stiffens (or softens, for falling strains) along the pulse: ρ → 0 for small
jumps, where every rule is exact, and ρ → 1 for hard spheres. Toda's law has no error up to
c₋ = 2 c₊ (Venakides, Deift & Oba, Comm. Pure Appl. Math. 44, 1171 (1991)).
"""

from __future__ import annotations

RESTING = 2.0
"""c₋/c₊ up to which the beads at the wall come to rest beside it (a theorem for Toda's law)."""

RULE_SPEED, RULE_FORCE = 0.0025, 0.02
"""Relative errors of the doubling rule on the lattice's own wave, without load, k = 1.05 … 5."""


def speed_error(rho: float) -> float:
    """Relative error of the doubling rule's speed on the canonical wave."""
    return 0.01 * rho + 0.08 * rho**3


def rise_error(rho: float) -> float:
    """Error of the doubling rule's peak strain on the canonical wave, over the rise."""
    # the first term is the canonical wave's, the second the rule's own, 1.4 % for k → 1
    return 0.065 * rho**2 + min(0.015, rho / 4)


def leading_error(off: float, rho: float) -> float:
    """Relative error of El's leading edge, from which the doubling rule differs by ``off``."""
    return off + (1 + off) * speed_error(rho)


def trailing_error(off: float) -> float:
    """Error of El's trailing edge over c₋, by the same ``off``."""
    # measured 5 to 7 times the difference at the leading edge; 2 % is what the runs resolve
    return 0.02 + 8 * off
