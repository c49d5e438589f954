"""The command `lwa`, also as `python -m lwa`, and the start of every command of this project."""

from __future__ import annotations

import gc
import sys
from importlib import import_module

from lwa.base import INTERRUPTED


def start(name: str, module: str) -> None:
    """Load the module of the command ``name``, which takes most of a second, and call its ``main``.

    Ctrl-C ends the process in one line while the module is loaded, too.
    """
    # Libraries and the engine's compilation make millions of objects that last. To look through
    # them for garbage after every 700 new ones, Python's default, took 0.1 s of a short command's
    # 1.2 s, and 1.1 s of the 15 s of the first `lwa-validate run` on a machine.
    gc.set_threshold(300_000)
    try:
        import_module(module).main()
    except KeyboardInterrupt:
        print(f"{name}: interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)


def main() -> None:
    """Run the command `lwa`: the entry point of `lwa` and of `python -m lwa`."""
    start("lwa", "lwa.command.cli")


if __name__ == "__main__":
    main()
