"""Symbols, quantities and widths of a wave, and the error raised where no wave exists."""

from __future__ import annotations

from typing import Any

import sympy as sp

from lwa.base.errors import NoSolitaryWave as NoSolitaryWave
from lwa.base.exact import one_of

NO_WAVE = (
    "there is no wave unless contacts stay closed, F′ > 0, and speeds grow towards B (under δ^k: "
    "p0 + B > 0 and (k-1) B > 0)"
)
"""Reason for the refusal of a wave on a background."""

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

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
