"""Progress of long computations on standard error, by `tqdm`."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from shutil import get_terminal_size
from typing import Any, TypeVar

EVERY = 30.0
"""Seconds to the first bar, and between two, where standard error is no terminal."""

QUIET = 5.0
"""Seconds of a terminal without a sign of life: ten with the start of Python on a busy machine,
which took up to 5 s at a load of 12."""

T = TypeVar("T")
Progress = Callable[[Iterable[T]], Iterable[T]]
"""A wrapper of an iterable that shows how far an iteration is, such as `tqdm.tqdm`."""


def shown(items: Iterable[T], label: str = "orders") -> Iterable[T]:
    """Yield the items behind a progress bar; see `bar`."""
    wrapped: Iterable[T] = bar(label, iterable=items)
    return wrapped


def bar(label: str, **settings: Any) -> Any:
    """Make a bar of `tqdm` with these settings; without a terminal it is drawn every 30 s."""
    from tqdm import tqdm  # here, so that `import lwa` does not load it

    # A terminal may say that it has no size: 80 columns are taken then, where tqdm draws nothing.
    columns, lines = get_terminal_size()
    settings |= {"ncols": columns, "nrows": lines}
    closed = sys.stderr is None
    if closed or not sys.stderr.isatty():
        settings |= {"delay": EVERY, "mininterval": EVERY, "disable": closed}
    return tqdm(desc=label, leave=False, file=sys.stderr, **settings)


@contextmanager
def alive(name: str) -> Iterator[None]:
    """Show on standard error, from time to time, that a command still computes.

    Compilers, SciPy's methods and SymPy's printers tell nobody how far they are. A line has the
    time so far, every `QUIET` seconds on a terminal and every `EVERY` seconds elsewhere; a bar that
    is there already is drawn again instead.
    """
    if sys.stderr is None:
        yield
        return
    # A thread: SymPy and compiled loops return to no loop that could show a line.
    ended = threading.Event()
    watch = threading.Thread(target=_show_time, args=(name, ended), daemon=True)
    watch.start()
    try:
        yield
    finally:
        ended.set()
        watch.join()


def _show_time(name: str, ended: threading.Event) -> None:
    """Show the time of a command until the command has ended."""
    start = time.monotonic()
    while not ended.wait(QUIET if sys.stderr.isatty() else EVERY):
        from tqdm import tqdm  # most commands end before

        bars = list(tqdm._instances)
        for one in bars:
            one.refresh()
            # A bar that tqdm did not draw itself is not wiped at its end.
            one.last_print_t = time.time()
        if not bars:
            minutes, seconds = divmod(round(time.monotonic() - start), 60)
            # A line of its own: the result may be the next thing on the terminal.
            print(f"{name}: still computing, {minutes}:{seconds:02}", file=sys.stderr)
