"""Symbols, quantities and widths of a wave, and the error raised where no wave exists."""

from __future__ import annotations

from typing import Any

import sympy as sp

from lwa.base import NoSolitaryWave as NoSolitaryWave
from lwa.base.exact import one_of

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

FALL = sp.Symbol("B", negative=True)
"""B of a wave of lower strain, in a chain that softens."""

SPEED = sp.Symbol("V_s", positive=True)
"""V_s = dx/dτ, the speed of a wave, unless the caller gives another."""

QUANTITIES = ("strain", "force", "velocity")
"""The quantities of a wave that have a width."""

EXTENTS = ("length", "time")
"""The kinds of a width: an extent in space, or the time of passage."""


def strain_power(quantity: str, k: Any) -> Any:
    """The exponent q of a quantity that scales as strain^q: k for the force, else 1.

    Raises `lwa.InputError` unless the quantity is among `QUANTITIES`.
    """
    return k if known_quantity(quantity) == "force" else 1


def known_quantity(quantity: str) -> str:
    """Return the quantity; raise `lwa.InputError` unless it is among `QUANTITIES`."""
    return one_of(quantity, QUANTITIES, "quantity")


def known_extent(extent: str) -> str:
    """Return the extent; raise `lwa.InputError` unless it is among `EXTENTS`."""
    return one_of(extent, EXTENTS, "extent")


NOT_RISING = "F′ is not positive and finite from p0 to p0 + B"
VANISHING = "F′ is 0 between p0 and p0 + B, or so small that its terms cancel to 0"
NOT_STIFFENING = "the law does not stiffen towards p0 + B: a smaller wave would be as fast"


def refusal_under_power(excess: sp.Expr, p0: sp.Expr, B: sp.Expr) -> str:
    """Reason why δ^k has no wave of the rise B on the strain p0; empty if there may be a wave.

    excess : k - 1. Speeds scale as strain^{(k-1)/2}.
    """
    stiffens, softens = excess.is_positive, excess.is_negative
    cases = {
        "at k = 1 the chain is linear, and its waves disperse": excess.is_zero,
        "k < 1 and there is no load: the speed falls with the strain": softens and p0.is_zero,
        "k > 1: speeds grow with the strain, and only B > 0 has a wave": stiffens and B.is_negative,
        "k < 1: speeds fall with the strain, and only B < 0 has a wave": softens and B.is_positive,
        "the contacts would open": p0.is_negative or (p0 + B).is_nonpositive,
    }
    return next((reason for reason, holds in cases.items() if holds), "")
