"""Symbols, quantities and widths of a wave, and the error raised where no wave exists."""

from __future__ import annotations

from typing import Any

import sympy as sp

from lwa.base.errors import NoSolitaryWave as NoSolitaryWave
from lwa.base.exact import one_of

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

SPEED = sp.Symbol("V_s", positive=True)
"""V_s = dx/dτ, the speed of a wave, unless the caller gives another."""

QUANTITIES = ("strain", "force", "velocity")
"""The quantities of a wave that have a width."""

EXTENTS = ("length", "time")
"""The kinds of a width: an extent in space, or the time of passage."""


def known(quantity: str) -> str:
    """Return the quantity; raise `lwa.InputError` unless it is among `QUANTITIES`."""
    return one_of(quantity, QUANTITIES, "quantity")


def known_extent(extent: str) -> None:
    """Raise `lwa.InputError` unless the extent is among `EXTENTS`."""
    one_of(extent, EXTENTS, "extent")


def strain_power(quantity: str, k: Any) -> Any:
    """The exponent q of a quantity that scales as strain^q: k for the force, else 1."""
    return k if known(quantity) == "force" else 1
