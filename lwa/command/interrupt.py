"""The first moments of a command: what it is made of takes most of a second to load.

Ctrl-C meets a process in the middle of an import then, where Python may lose it or print where it
was. Nothing is written yet, so that the process may end on the spot.
"""

from __future__ import annotations

import os
import signal
from importlib import import_module
from types import FrameType

INTERRUPTED = 130
"""Exit status after Ctrl-C, as the shells have it."""


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
