"""Progress of long computations on standard error, by `tqdm`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any, TypeVar

EVERY = 30.0
"""Seconds to the first bar, and between two, where standard error is no terminal."""

T = TypeVar("T")
Progress = Callable[[Iterable[T]], Iterable[T]]
"""A wrapper of an iterable that shows how far an iteration is, such as `tqdm.tqdm`."""


def announced(what: str) -> Progress[Any]:
    """Print to standard error that a computation takes minutes; return `shown`, its progress."""
    # Imported before the line is printed: Python may lose a Ctrl-C during an import.
    import_module("tqdm")
    print(f"{what}: this may take minutes", file=sys.stderr, flush=True)
    return shown


def shown(items: Iterable[T], label: str = "orders") -> Iterable[T]:
    """Yield the items behind a progress bar; see `bar`."""
    wrapped: Iterable[T] = bar(label, iterable=items)
    return wrapped


def bar(label: str, **settings: Any) -> Any:
    """Make a bar of `tqdm` with these settings; without a terminal it is drawn every 30 s."""
    from tqdm import tqdm  # here, so that `import lwa` does not load it

    closed = sys.stderr is None
    if closed or not sys.stderr.isatty():
        settings |= {"delay": EVERY, "mininterval": EVERY, "disable": closed}
    return tqdm(desc=label, leave=False, file=sys.stderr, **settings)
