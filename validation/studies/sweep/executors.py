"""Where the points of a sweep are computed: by any executor of `concurrent.futures`."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterator
from concurrent import futures
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager, nullcontext
from itertools import islice

from lwa.base.exact import InputError, shorten
from lwa.base.progress import Progress
from validation.lattice.threads import threads
from validation.pulses.steady import Point, point
from validation.scenes.checks import Failure, SceneError
from validation.studies.sweep.journal import Journal, Key

PATIENCE = 5  # seconds within which a cluster must answer
_UNDERWAY = 256  # points that an executor is given at a time


class SweepError(Failure):
    """The executor gave up; what was finished is kept. The message says where it stood."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """The executor of the Dask cluster whose scheduler is at an address such as tcp://host:8786.

    `lwa` must be installed where its workers are. Raises `lwa.InputError` when Dask is not
    installed, or no scheduler with workers answers within `PATIENCE`.
    """
    try:
        import distributed  # an optional package
    except ImportError:
        raise InputError("cluster needs Dask: pip install 'lwa[cluster]'") from None

    async def call() -> None:
        arguments = distributed.Security().get_connection_args("client")
        # its own timeout does not count while who answers is silent
        called = distributed.connect(address, timeout=PATIENCE, **arguments)
        await (await asyncio.wait_for(called, PATIENCE)).close()

    with ExitStack() as stack:
        # of a scheduler that is gone they log tracebacks, and then `compute` tells it in one line
        for name in ("distributed", "distributed.client", "tornado.application"):
            log = logging.getLogger(name)
            stack.callback(log.setLevel, log.level)
            log.setLevel(logging.CRITICAL)
        try:
            # First a call, as a client that fails leaves a thread behind; in a thread of its own,
            # as a notebook's has a loop already.
            with futures.ThreadPoolExecutor(1) as thread:
                thread.submit(asyncio.run, call()).result()
            client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
            stack.enter_context(client).wait_for_workers(1, timeout=PATIENCE)
        except Exception:  # whatever answers there
            raise InputError(
                f"cluster is {shorten(address)}: no Dask scheduler with workers answers there "
                f"within {PATIENCE} s; an address such as tcp://127.0.0.1:8786 is wanted"
            ) from None
        yield client.get_executor()


def entered(
    executor: Executor | AbstractContextManager[Executor] | None,
) -> AbstractContextManager[Executor]:
    """A context that gives an executor: the default one, one that is there, or itself."""
    if executor is None:
        return threads()
    if isinstance(executor, Executor):
        return nullcontext(executor)
    if isinstance(executor, AbstractContextManager):
        return executor
    raise SceneError(f"executor is {shorten(executor)}: a concurrent.futures.Executor is wanted")


def compute(
    executor: Executor, todo: list[Key], stretch: int, journal: Journal, progress: Progress[Key]
) -> None:
    """Each point into the journal as soon as it is finished, whatever happens to the others."""
    waiting = iter(todo)
    underway: dict[Future[Point], Key] = {}
    with closing(key for key in progress(todo)) as ticks:
        next(ticks)
        try:
            while True:
                for key in islice(waiting, _UNDERWAY - len(underway)):
                    underway[executor.submit(point, *key, stretch)] = key
                if not underway:
                    return
                done = futures.wait(underway, return_when=futures.FIRST_COMPLETED).done
                for future in [future for future in underway if future in done]:
                    journal.add(_result(future, underway[future]))
                    del underway[future]
                    next(ticks, None)
        except (BrokenExecutor, CancelledError) as error:
            gone = "the workers are gone before the sweep is done: killed, or out of memory?"
            raise SweepError(gone) from error
        finally:
            for future, key in underway.items():
                if key in journal.points:  # it was being kept when Ctrl-C came
                    continue
                if not future.cancel() and future.done() and future.exception() is None:
                    journal.add(future.result())


def _result(future: Future[Point], key: Key) -> Point:
    try:
        return future.result()
    except (BrokenExecutor, CancelledError):
        raise
    except Exception as error:  # beyond what a point can say of itself
        reason = f"{type(error).__name__}: {error}"
        raise SweepError(f"k = {key[0]}, omega = {key[1]} is not computed: {reason}") from error
