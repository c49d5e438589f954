"""Errors for invalid arguments and for waves that do not exist, and the status after Ctrl-C.

The module is loaded without SymPy.
"""

from __future__ import annotations

import signal

INTERRUPTED = 128 + signal.SIGINT
"""Exit status of a command after Ctrl-C, as in shells."""


class InputError(ValueError):
    """Invalid argument; the message names the argument and says which values are valid."""


class NoSolitaryWave(ValueError):
    """Parameters without a solitary wave in the theory; the message says why."""
