"""Ctrl-C while a command loads its modules, which takes most of a second.

In the middle of an import Python may lose the signal or print a traceback. Nothing is written yet,
so that the process may end at once.
"""

from __future__ import annotations

import os
import signal
from importlib import import_module
from types import FrameType

INTERRUPTED = 130
"""Exit status after Ctrl-C, the shells' number for SIGINT."""


def start(name: str, module: str) -> None:
    """Load the module of the command ``name`` and call its ``main``."""

    def end(number: int, frame: FrameType | None) -> None:
        os.write(2, f"{name}: interrupted\n".encode())
        os._exit(INTERRUPTED)

    heard = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if heard:  # not where it is ignored, as in the background
        signal.signal(signal.SIGINT, end)
    main = import_module(module).main
    if heard:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    main()
