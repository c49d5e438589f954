"""Threads side by side: the compiled engine holds no lock."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager

from validation.scenes.checks import integer


def cores() -> int:
    """Those that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@contextmanager
def threads(count: int | None = None, name: str = "workers") -> Iterator[Executor]:
    """So many threads, by default one for each core; ``name`` is what a bad number is called.

    On an exception the tasks that wait are dropped; those underway, which nothing can end, are
    waited for.
    """
    wanted = cores() if count is None else integer(count, name, 1, 1024)
    pool = ThreadPoolExecutor(wanted)
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)
