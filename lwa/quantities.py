"""What a width can be of, and the exception for a wave that is none."""

from __future__ import annotations

from typing import Any

from lwa.exact import InputError, shorten

QUANTITIES = ("strain", "force", "velocity")


def strain_power(quantity: str, k: Any) -> Any:
    """The power of the strain to which a quantity of the wave is proportional: k or 1.

    Raises `lwa.InputError` unless the quantity is "strain", "force" or "velocity".
    """
    if quantity not in QUANTITIES:
        raise InputError(
            f"quantity is {shorten(quantity)}: one of {', '.join(QUANTITIES)} is wanted"
        )
    return k if quantity == "force" else 1


class NoSolitaryWave(ValueError):
    """The theory has no compact traveling wave for these parameters; the message says why."""
