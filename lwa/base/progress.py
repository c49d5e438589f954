"""Durations in words, and the progress of long computations."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from time import monotonic
from typing import Any, TypeVar

EVERY = 30.0
"""Seconds between two lines of progress without a terminal."""

T = TypeVar("T")
Progress = Callable[[Iterable[T]], Iterable[T]]
"""A wrapper of an iterable that shows how far an iteration is, such as `tqdm.tqdm`."""

_UNITS = (("years", 3.156e7), ("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0))


def words(seconds: float) -> str:
    """A duration in rounded words.

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


def announced(what: str) -> Progress[Any]:
    """Say on standard error that a computation is long; return `shown`, for its progress."""
    # before the line: Python may lose a Ctrl-C that meets it in an import
    import_module("tqdm")
    print(f"{what}: this may take minutes", file=sys.stderr, flush=True)
    return shown


def shown(items: Iterable[T], label: str = "orders") -> Iterable[T]:
    """Yield the items behind a progress bar on a terminal; elsewhere print a line every 30 s."""
    if sys.stderr is None or not sys.stderr.isatty():
        return _counted(items, label)
    from tqdm import tqdm  # here, so that `import lwa` does not load it

    bar: Iterable[T] = tqdm(items, desc=label, leave=False, file=sys.stderr)
    return bar


def _counted(items: Iterable[T], label: str) -> Iterator[T]:
    items = list(items)
    tell = lines(label)
    for done, item in enumerate(items, start=1):
        yield item
        tell(done / len(items))


def lines(label: str) -> Callable[[float], None]:
    """Make a function of the completed fraction that prints the time left every 30 s."""
    start = said = monotonic()

    def tell(fraction: float) -> None:
        nonlocal said
        now = monotonic()
        if now - said >= EVERY and 0 < fraction < 1:
            said, left = now, (now - start) * (1 / fraction - 1)
            print(f"{label}: {fraction:.0%} done, {words(left)} left", file=sys.stderr, flush=True)

    return tell
