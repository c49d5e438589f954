"""Options of the compiler, and a cache of machine code that knows all sources of the kernel.

Numba compiles a cached function again if the function's own file changes or a value in its closure,
not if a function that it calls changes. So every cached function has `SOURCES` in its closure.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core.event import Event, Listener, register
from numba.extending import intrinsic

Function = TypeVar("Function", bound=Callable[..., Any])

SOURCES = int.from_bytes(
    hashlib.blake2b(
        b"".join(file.read_bytes() for file in sorted(Path(__file__).parent.glob("*.py"))),
        digest_size=7,
    ).digest()
)
"""A hash of all files of the kernel."""

# Without "reassoc" sums keep their order, so that rounding is reproducible; without "nnan" and
# "ninf" an overflow is detected. In numba's own error model a division by zero raises an exception,
# a branch that keeps loops from vectorising. The code allocates nothing ("_nrt"): counting
# references to arrays would take longer than the arithmetic.
_OPTIONS: Any = dict(
    fastmath={"nsz", "arcp", "contract"}, error_model="numpy", nogil=True, _nrt=False
)
compiled: Callable[[Function], Function] = njit(**_OPTIONS)
# Sums and maxima in the order of the machine's registers, the same in every run.
summed: Callable[[Function], Function] = njit(
    **_OPTIONS | {"fastmath": {"nsz", "arcp", "contract", "reassoc"}}
)
# Inlined into the caller: passing the arrays would take as long as the computation.
part: Callable[[Function], Function] = njit(inline="always", **_OPTIONS)
# Unsigned indices: a signed one may count from the end, which keeps a loop from vectorising.
index = np.uint64
ZERO, ONE, TWO, THREE = map(index, range(4))


def _call(typing: Any, address: Any, x: Any) -> Any:
    """Call the compiled function of one float at an address (an intrinsic of Numba)."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.FunctionType(ir.DoubleType(), [ir.DoubleType()])
        return builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), [arguments[1]])

    return types.float64(types.int64, types.float64), generate


call: Any = intrinsic(_call)


def cached(function: Function) -> Function:
    """Compile a function; its machine code is kept on disk if numba finds a writable directory."""
    try:
        result, kept = njit(cache=True, **_OPTIONS)(function), True
    except (RuntimeError, OSError):  # numba finds no directory for its cache
        result, kept = compiled(function), False
    register("numba:compile", _Announcement(result, kept))  # type: ignore[no-untyped-call]
    return result  # type: ignore[no-any-return]


@cache
def _say(message: str) -> None:
    """Print a line about the compilation, once."""
    print(message, file=sys.stderr, flush=True)


class _Announcement(Listener):
    """Announcement of a compilation, made when no cache holds the machine code."""

    def __init__(self, function: Any, kept: bool) -> None:
        self.function, self.kept = function, kept

    def on_start(self, event: Event) -> None:
        """Print a line before numba compiles the announced function; numba calls this method."""
        if event.data["dispatcher"] is not self.function:
            return
        if not self.kept:
            _say("no directory for machine code can be written: it is compiled for this run only")
        elif sys.stderr.isatty():
            _say("the engine is compiled for this machine, once")

    def on_end(self, event: Event) -> None:
        """Do nothing after a compilation; numba requires this method."""
