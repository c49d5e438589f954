"""How long something takes, in words, and the progress of what takes long."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import TypeVar

LONG = 30.0
"""Seconds from which it is said that something takes long, with a progress bar on a terminal."""

T = TypeVar("T")
Progress = Callable[[Iterable[T]], Iterable[T]]
"""What the orders or cases of a computation are run through on their way, as `tqdm.tqdm`."""

_UNITS = (("years", 3.156e7), ("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0))


def words(seconds: float) -> str:
    """A duration in round words.

    >>> words(7.2e3), words(3), words(1e12)
    ('about 2 hours', 'about 3 s', 'over 1000 years')
    """
    if seconds > 1000 * _UNITS[0][1]:
        return "over 1000 years"
    for name, unit in _UNITS:
        if seconds >= 1.95 * unit:
            return f"about {_round(seconds / unit)} {name}"
    return f"about {_round(seconds)} s"


def _round(number: float) -> str:
    return f"{number:.0f}" if number > 10 else f"{number:.2g}"


def announce(what: str, seconds: float) -> bool:
    """Say on the standard error what takes how long, where it takes long; whether it does."""
    if seconds > LONG:
        # before the line: Python may lose a Ctrl-C that meets it in an import
        import_module("tqdm")
        print(f"{what}: {words(seconds)}", file=sys.stderr, flush=True)
    return seconds > LONG


def shown(orders: Iterable[int]) -> Iterable[int]:
    """The orders behind a progress bar, on a terminal."""
    from tqdm import tqdm  # here, so that `import lwa` does not load it

    bar: Iterable[int] = tqdm(orders, desc="orders", leave=False, disable=None)
    return bar
