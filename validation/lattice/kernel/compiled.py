"""Numba's options for the kernel, and a cache of machine code that is tied to all its files.

Numba compiles a cached function again if the function's own file changes, not if a function that it
calls changes. So the stamp of every cached function is that of all files of the kernel, `SOURCES`.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.cpu import CPUTargetOptions
from numba.core.event import Event, Listener, register
from numba.core.options import TargetOptions
from numba.core.typed_passes import IRLegalization, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes
from numba.extending import intrinsic

from validation.scenes import forcing

Function = TypeVar("Function", bound=Callable[..., Any])

_FILES = sorted(Path(__file__).parent.glob("*.py")), [Path(forcing.__file__)]
SOURCES = hashlib.blake2b(
    b"".join(file.read_bytes() for files in _FILES for file in files)
).hexdigest()
"""A hash of all files with compiled functions."""


class _Linked(JITCodeLibrary):
    """LLVM code of a function that is optimised and translated in its callers alone.

    Numba links the code of a function into that of each function that calls it, and optimises and
    translates the whole. It does both for the function by itself, too, where nobody calls it from
    Python: this took a tenth of a first command's time. The methods replace numba's own.
    """

    def _optimize_final_module(self) -> None:
        """Leave the optimisation by LLVM to the functions that call this one."""

    def _finalize_final_module(self) -> None:
        """Leave the translation to machine code to the functions that call this one.

        Numba's flag says that the code is complete, so that it may be linked.
        """
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """The object of which numba calls `set_env`, and nothing else: this library."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing: numba would write to an address of the translated code."""


class _Compiler(Compiler):
    """Numba's compiler without passes that take a twentieth of the time and change nothing here.

    They look for arithmetic of whole arrays, for functions within functions, and for the ends of
    references to Python's objects.
    """

    def define_pipelines(self) -> list[Any]:
        """Return the one list of passes."""
        idle = NopythonRewrites, InlineClosureLikes, IRLegalization
        [pipeline] = super().define_pipelines()  # type: ignore[no-untyped-call]
        pipeline.passes = [step for step in pipeline.passes if step[0] not in idle]
        return [pipeline]


class _Linker(_Compiler):
    """The compiler of functions that compiled functions alone call."""

    def define_pipelines(self) -> list[Any]:
        """Return the one list of passes, which fill a library that is linked."""
        state = self.state
        state.library = _Linked(state.targetctx.codegen(), state.func_id.func_name)  # type: ignore[no-untyped-call]
        return super().define_pipelines()


# Numba has a flag for arguments that share no memory, but no option for it. Without it each
# vectorised loop asks at run time whether its arrays overlap: short chains took a fifth more time.
CPUTargetOptions.noalias = TargetOptions.Mapping("noalias")  # type: ignore[no-untyped-call]
# Without "reassoc" sums keep their order, so that rounding is reproducible; without "nnan" and
# "ninf" an overflow is detected. In numba's own error model a division by zero raises an exception,
# a branch that keeps loops from vectorising. The code allocates nothing ("_nrt"): counting
# references to arrays would take longer than the arithmetic. No wrapper for callers in C.
_OUTER: Any = dict(
    fastmath={"nsz", "arcp", "contract"},
    error_model="numpy",
    nogil=True,
    no_cfunc_wrapper=True,
    noalias=True,
    _nrt=False,
    pipeline_class=_Compiler,
)
# Called by compiled functions alone: wrappers for Python took a third of the time to compile.
_INNER: Any = _OUTER | {"no_cpython_wrapper": True, "pipeline_class": _Linker}
# Functions with one caller, which numba inlines before it compiles them.
inlined: Callable[[Function], Function] = njit(inline="always", **_INNER)
# Long functions with several callers, which stay apart.
alone: Callable[[Function], Function] = njit(**_INNER)
# Small functions with many callers, inlined by LLVM, as the calls would take a quarter of a run's
# time. Inlining by numba gives the same code, but takes three times as long to compile.
part: Callable[[Function], Function] = njit(forceinline=True, **_INNER)
# Sums and maxima in the order of the machine's registers, the same in every run: inlined, too. They
# are optimised before, by numba's own compiler, so that the order is the same in every caller.
_SUMMED: Any = _INNER | {"pipeline_class": Compiler}
_SUMMED["fastmath"] = _OUTER["fastmath"] | {"reassoc"}
summed: Callable[[Function], Function] = njit(forceinline=True, **_SUMMED)
# Unsigned indices: a signed one may count from the end, which keeps a loop from vectorising.
# Sums take `ONE`: of an unsigned integer plus a plain 1 numba makes a signed one.
index = np.uint64
ZERO, ONE = index(0), index(1)
# A plain 0 is a type of its own, for which numba compiles a function once more.
FIRST: Any = np.int64(0)


def _call(typing: Any, address: Any, x: Any) -> Any:
    """Call the compiled function of one float at an address (an intrinsic of Numba)."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.FunctionType(ir.DoubleType(), [ir.DoubleType()])
        return builder.call(
            builder.inttoptr(arguments[0], kind.as_pointer()), [arguments[1]]
        )

    return types.float64(types.int64, types.float64), generate


call: Any = intrinsic(_call)


def cached(function: Function) -> Function:
    """Compile a function; its machine code is kept on disk if numba can write to a directory."""
    try:
        compiled: Any = njit(cache=True, **_OUTER)(function)
    except (RuntimeError, OSError):  # numba finds no directory for its cache
        return njit(**_OUTER)(function)  # type: ignore[no-any-return]
    if compiled is function:  # NUMBA_DISABLE_JIT
        return function
    cache = compiled._cache
    # In place of the time and size of one file.
    cache._cache_file._source_stamp = SOURCES
    known = cache.load_overload
    keep = cache.save_overload

    def load_if_possible(signature: Any, context: Any) -> Any:
        """Load the machine code; without one that can be used numba compiles anew."""
        try:
            return known(signature, context)
        except Exception:  # pickled by another version of this package, or damaged
            cache.flush()
            return None

    def keep_if_possible(signature: Any, code: Any) -> None:
        """Store the machine code; say so if the disk takes none."""
        try:
            keep(signature, code)
        except OSError as error:
            print(
                f"the engine's machine code is not kept: {error.strerror}",
                file=sys.stderr,
            )

    cache.load_overload = load_if_possible
    cache.save_overload = keep_if_possible
    return compiled  # type: ignore[no-any-return]


class _Announcement(Listener):
    """Message on a terminal before the engine is compiled, which takes some ten seconds."""

    def on_start(self, event: Event) -> None:
        """Print the message; numba calls this method before it compiles a function."""
        if (
            event.data["dispatcher"].__name__.startswith("advance")
            and sys.stderr.isatty()
        ):
            print(
                "the engine is compiled for scenes of this kind, once",
                file=sys.stderr,
                flush=True,
            )

    def on_end(self, event: Event) -> None:
        """Do nothing after a compilation; numba requires this method."""


register("numba:compile", _Announcement())  # type: ignore[no-untyped-call]
