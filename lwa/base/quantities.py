"""The quantities of a wave that have a width, and the answer that there is no wave."""

from __future__ import annotations

from typing import Any

from lwa.base.exact import InputError, shorten

QUANTITIES = ("strain", "force", "velocity")

EXTENTS = ("length", "time")
"""What a width is: the extent in space, or the time that it takes to pass."""


def strain_power(quantity: str, k: Any) -> Any:
    """The power of the strain to which a quantity of the wave is proportional: k or 1.

    Raises `lwa.InputError` unless the quantity is "strain", "force" or "velocity".
    """
    return k if known(quantity) == "force" else 1


def known(quantity: str) -> str:
    """The quantity, refused unless it is one of `QUANTITIES`."""
    if not isinstance(quantity, str) or quantity not in QUANTITIES:
        raise InputError(
            f"quantity is {shorten(quantity)}: one of {', '.join(QUANTITIES)} is wanted"
        )
    return quantity


def known_extent(extent: str) -> None:
    """Raise `lwa.InputError` unless the extent is one of `EXTENTS`."""
    if extent not in EXTENTS:
        raise InputError(f"extent is {shorten(extent)}: {' or '.join(EXTENTS)} is wanted")


class NoSolitaryWave(ValueError):
    """The theory has no compact traveling wave for these parameters; the message says why."""
