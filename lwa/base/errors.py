"""The errors that this package raises for what a caller gives; loaded without SymPy."""

from __future__ import annotations


class InputError(ValueError):
    """An argument that cannot be meant: the message names it and says what would be right."""


class NoSolitaryWave(ValueError):
    """Parameters for which the theory has no solitary wave; the message says why."""
