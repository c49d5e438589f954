"""Ground of the package: its errors, exact input, frozen values, tables, files, progress, LaTeX."""

from __future__ import annotations

import re
import signal
from functools import cache
from typing import Any

INTERRUPTED = 128 + signal.SIGINT
"""Exit status of a command after Ctrl-C, as in shells."""

LONGEST_MESSAGE = 300
"""Characters of a message, about four lines of a terminal; a longer one is not read."""


def cut(text: str, longest: int = LONGEST_MESSAGE) -> str:
    """Return the text on one line, without its middle where it is longer than ``longest``.

    >>> cut("the first and the last word are the ones that tell", 20)
    'the first … at tell'
    """
    line = " ".join(text.split())
    if len(line) <= longest:
        return line
    # The reason stands in front and the next step at the end: both stay.
    head = longest // 2
    tail = longest - head - 3  # " … "
    return f"{line[:head].rstrip()} … {line[-tail:].lstrip()}"


class Refusal(ValueError):
    """Base of the errors that a user reads: one line of at most `LONGEST_MESSAGE` characters.

    Parameters
    ----------
    reason : str
        The value that is refused, and which values are valid.
    **change : object
        Arguments by name that make the call valid, such as ``closure="full"``; None for an
        argument that is to be left out. The message ends with them, as keywords in Python and as
        the whole line to paste in the command `lwa`.

    Examples
    --------
    >>> raise InputError("three masses: the linear closure is that of two", closure="full")
    Traceback (most recent call last):
        ...
    lwa.base.InputError: three masses: the linear closure is that of two; try closure='full'
    """

    def __init__(self, reason: str, **change: object) -> None:
        self.reason = cut(reason)
        self.change = change
        message = reason
        if change:
            keywords = ", ".join(f"{name}={value!r}" for name, value in change.items())
            message = f"{reason}; try {keywords}"
        super().__init__(cut(message))


class InputError(Refusal):
    """Invalid argument; the message names the argument and says which values are valid."""


class NoSolitaryWave(Refusal):
    """Parameters without a solitary wave in the theory; the message says why."""


@cache
def _modules(package: str) -> dict[str, str]:
    """Modules of the public names of a package; the stub beside the file `package` lists them."""
    from pathlib import Path  # here: no command needs it

    stub = Path(package).with_suffix(".pyi").read_text(encoding="utf-8")
    # A name a line: "from lwa.cell import Cell as Cell".
    imports = re.findall(r"^from (\S+) import (\w+)", stub, re.MULTILINE)
    return {name: module for module, name in imports}


def public_names(package: str, file: str) -> tuple[Any, Any]:
    """Return the functions ``__getattr__`` and ``__dir__`` of a package, given its file.

    A public name is loaded on its first use (PEP 562): commands start before SymPy and NumPy do.
    """

    def load(name: str) -> Any:
        if name == "__version__":
            from importlib.metadata import (
                version,
            )  # here: it takes as long as all the rest

            return version("lwa")
        modules = _modules(file)
        if name == "__all__":
            return sorted(modules.keys() - {"D", "k"})  # of `lwa`, bound by name only
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(__import__(modules[name], fromlist=[name]), name)

    return load, lambda: sorted([*_modules(file), "__version__"])
