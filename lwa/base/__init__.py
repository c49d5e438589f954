"""Ground of the package: its errors, exact input, frozen values, tables, files, progress, LaTeX."""

from __future__ import annotations

import signal

INTERRUPTED = 128 + signal.SIGINT
"""Exit status of a command after Ctrl-C, as in shells."""


class InputError(ValueError):
    """Invalid argument; the message names the argument and says which values are valid."""


class NoSolitaryWave(ValueError):
    """Parameters without a solitary wave in the theory; the message says why."""
