"""Errors for invalid arguments and for waves that do not exist; loaded without SymPy."""

from __future__ import annotations


class InputError(ValueError):
    """Invalid argument; the message names the argument and says which values are valid."""


class NoSolitaryWave(ValueError):
    """Parameters without a solitary wave in the theory; the message says why."""
