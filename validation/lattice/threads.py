"""Executors of many runs: threads, as compiled runs release Python's lock, or a Dask cluster."""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager

from lwa.base.exact import InputError, shorten
from validation.scenes.checks import integer


def cores() -> int:
    """Number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@contextmanager
def threads(count: int | None, name: str = "workers") -> Iterator[Executor]:
    """Yield an executor of ``count`` threads, or one for each core (None).

    At the end, waiting tasks are dropped, and running tasks, which cannot be stopped, finish.
    Raises `lwa.InputError` for a bad count; the message calls it ``name``.
    """
    # More than 1,024 threads are taken for a slip.
    wanted = cores() if count is None else integer(count, name, 1, 1024)
    pool = ThreadPoolExecutor(wanted)
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def cluster(address: str, patience: float = 5.0) -> Iterator[Executor]:
    """Yield an executor of a running Dask cluster, given the address of its scheduler.

    The workers must have `lwa` installed. Raises `lwa.InputError` without Dask, and if no scheduler
    with workers answers within ``patience`` seconds.
    """
    try:
        import distributed  # an optional package
    except ImportError:
        raise InputError(
            "cluster needs Dask: pip install 'lwa[cluster]'", cluster=None
        ) from None

    # A client hangs if another program answers at the address: a plain call comes first, which
    # fails after ``patience`` seconds.
    async def call() -> None:
        await (await asyncio.wait_for(distributed.connect(address), patience)).close()

    with ExitStack() as stack:
        for name in ("distributed", "distributed.client", "tornado.application"):
            log = logging.getLogger(name)  # prints tracebacks when a scheduler is lost
            stack.callback(log.setLevel, log.level)
            log.setLevel(logging.CRITICAL)
        try:
            # A loop of asyncio in a thread of its own: a notebook's thread runs one already.
            with ThreadPoolExecutor(1) as thread:
                thread.submit(asyncio.run, call()).result()
            client = distributed.Client(address, timeout=patience, set_as_default=False)
            stack.enter_context(client).wait_for_workers(1, timeout=patience)
        except Exception:
            raise InputError(
                f"cluster is {shorten(address)}: no Dask scheduler with workers answers; one "
                "such as tcp://127.0.0.1:8786 is wanted"
            ) from None
        yield client.get_executor()
