"""Where the points of a sweep are computed: by processes of this machine, or by a Dask cluster.

Both are executors of `concurrent.futures`, and any other one serves a sweep as well.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, TypeVar

from lwa.exact import InputError, shorten
from validation.scenes.checks import integer

PATIENCE = 5
"""Seconds within which a cluster must answer."""

_Result = TypeVar("_Result")


class _Pool(ProcessPoolExecutor):
    """Its workers do not hear Ctrl-C, which is for the parent to act on."""

    def submit(self, fn: Callable[..., _Result], /, *args: Any, **kwargs: Any) -> Future[_Result]:
        """Submit a call; this is where workers are started, who inherit the mask."""
        if not hasattr(signal, "pthread_sigmask"):
            return super().submit(fn, *args, **kwargs)
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _end_with_parent() -> None:
    """In a worker: end when the process that started it is gone, however it went."""

    def watch() -> None:
        parent = multiprocessing.parent_process()
        if parent is not None:
            parent.join()
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def processes(jobs: int | None = None) -> Iterator[Executor]:
    """A pool of so many processes, by default one for each processor that this one may use.

    They are started anew (spawn), as a fork would not survive numba's and BLAS's threads: a script
    that calls this needs ``if __name__ == "__main__"``. On an exception they are ended at once.
    """
    if jobs is None:
        affinity = getattr(os, "sched_getaffinity", None)
        jobs = len(affinity(0)) if affinity else os.cpu_count() or 1
    jobs = integer(jobs, "jobs", 1, 1024)
    others = set(multiprocessing.active_children())
    pool = _Pool(jobs, multiprocessing.get_context("spawn"), _end_with_parent)
    try:
        yield pool
    except BaseException:
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """The executor of the Dask cluster whose scheduler is at an address such as tcp://host:8786.

    `lwa` must be installed where its workers are. Raises `lwa.InputError` when Dask is not
    installed, or nothing answers within `PATIENCE`.
    """
    try:
        import distributed
        from distributed.comm import connect
        from distributed.comm.addressing import parse_address, parse_host_port
        from distributed.comm.registry import get_backend
    except ImportError:
        raise InputError("cluster needs Dask: pip install 'lwa[cluster]'") from None
    try:
        scheme, place = parse_address(address)
        get_backend(scheme)
        if scheme != "inproc":
            parse_host_port(place)
    except (ValueError, TypeError):
        raise InputError(
            f"cluster is {shorten(address)}: the address of a Dask scheduler is wanted, such as "
            "tcp://127.0.0.1:8786"
        ) from None

    async def call() -> None:
        arguments = distributed.Security().get_connection_args("client")
        await (await connect(address, timeout=PATIENCE, **arguments)).close()

    try:
        # First a call, as a client that fails leaves threads and messages behind; in a thread of
        # its own, as a notebook's has a loop already.
        with ThreadPoolExecutor(1) as thread:
            thread.submit(asyncio.run, call()).result()
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except Exception:  # whatever answers there
        raise InputError(
            f"cluster is {address}: no Dask scheduler answers there within {PATIENCE} s"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise InputError(f"cluster is {address}: its scheduler has no workers") from None
        yield client.get_executor()
