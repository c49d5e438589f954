"""Errors of a shock's theory, as measured on driven chains of equal beads.

The chains were driven until their pulses were steady: powers with a load, k from 0.3 to 7, and
without, k from 1.05 to 10, and the laws hertz2, magnetic, polynomial and lennard-jones, c₋/c₊ up to
200. `tests/test_errors.py` drives some of them again, random ones among them. The measure is the
leading pulse's steepness Δ, by its saturating form::

    ρ = 1 - e^{-Δ} = 1 - V²/F′(p₊+B),

which vanishes for small jumps, where every rule is exact, and tends to 1 for hard spheres.
"""

from __future__ import annotations

from math import expm1

RESTING = 2.0
"""c₋/c₊ up to which the beads at the wall come to rest beside it.

A theorem for Toda's law (Venakides, Deift & Oba, Comm. Pure Appl. Math. 44, 1171 (1991)).
"""


def speed_error(delta: float) -> float:
    """Relative error of the doubling rule's speed on the canonical wave of a steepness."""
    rho = -expm1(-delta)
    return 0.01 * rho + 0.08 * rho**3


def rise_error(delta: float) -> float:
    """Error of the doubling rule's peak strain on the canonical wave, over the rise."""
    rho = -expm1(-delta)
    # The first term is the canonical wave's, the second the rule's own: the lattice's peak is 1.3 %
    # higher for powers without load, k from 1.02 to 1.1. For small jumps it is less.
    return 0.065 * rho**2 + 0.015


def leading_error(off: float, delta: float) -> float:
    """Relative error of El's leading edge, from which the doubling rule differs by ``off``."""
    return off + (1 + off) * speed_error(delta)


def trailing_error(off: float) -> float:
    """Error of El's trailing edge over c₋, by the same ``off``."""
    # measured 5 to 7 times the difference at the leading edge; 2 % is what the runs resolve
    return 0.02 + 8 * off
