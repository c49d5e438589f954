"""The command `lwa`, also as `python -m lwa`, and the start of every command of this project."""

from __future__ import annotations

import os
import signal
from importlib import import_module
from types import FrameType

from lwa.base import INTERRUPTED


def start(name: str, module: str) -> None:
    """Load the module of the command ``name``, which takes most of a second, and call its ``main``.

    Ctrl-C ends the process at once while the module is loaded: in the middle of an import Python
    may lose the signal or print a traceback.
    """

    def end(number: int, frame: FrameType | None) -> None:
        os.write(2, f"{name}: interrupted\n".encode())
        os._exit(INTERRUPTED)

    handler = signal.getsignal(signal.SIGINT)
    if handler is signal.default_int_handler:  # else the signal is ignored, as in the background
        signal.signal(signal.SIGINT, end)
    main = import_module(module).main
    signal.signal(signal.SIGINT, handler)
    main()


def main() -> None:
    """Entry point of `python -m lwa`, which then loads the command."""
    start("lwa", "lwa.command.cli")


if __name__ == "__main__":
    main()
