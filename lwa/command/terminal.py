"""The end of every command of this project: output, exit status, one clear line for a fault.

Text is written in UTF-8 whatever the locale says, as its Greek letters need (a redirection on
Windows would be cp1252).
"""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any

import click

from lwa.base.errors import InputError, NoSolitaryWave
from lwa.command.interrupt import INTERRUPTED

HELP = {"help_option_names": ["-h", "--help"]}
"""Settings of a command: both ways to ask for help."""

CLOSED = 141
"""Exit status where the reader of the output went away, the shells' number for SIGPIPE."""

version = click.version_option(package_name="lwa", message="%(prog)s %(version)s")
"""The option ``--version`` of a command."""


def run(command: click.Command, name: str, arguments: Sequence[str] | None = None) -> None:
    """Run a command and end the process with its status.

    The status is the command's own (0, or 1 for comparisons that failed), 2 after one line on bad
    input, `INTERRUPTED` after Ctrl-C, and `CLOSED` where the reader of the output went away.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # a file name that is not UTF-8 stands as \udcff in a message
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    sys.exit(_status(lambda: command.main(arguments, prog_name=name, standalone_mode=False), name))


def _status(call: Callable[[], Any], name: str) -> int:
    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")
        result = _unless_closed(call)
        sys.stdout.flush()
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message(), err=True)
        return 2
    except click.ClickException as error:
        return _complain(name, error.format_message())
    except (InputError, NoSolitaryWave) as error:
        return _complain(name, str(error))
    except (click.Abort, KeyboardInterrupt):
        click.echo(f"{name}: interrupted", err=True)
        return INTERRUPTED
    except BrokenPipeError:
        _drop_output()
        return CLOSED
    except OSError as error:  # such as a disk that is full
        _drop_output()
        return _complain(name, f"{error.filename or 'the output'}: {error.strerror or error}")
    return result if isinstance(result, int) else 0


def _unless_closed(call: Callable[[], Any]) -> Any:
    """The result of a call of click, which replaces the output and exits where a pipe is closed."""
    output = sys.stdout
    try:
        return call()
    except SystemExit:
        if sys.stdout is output:
            raise
        sys.stdout = output
        raise BrokenPipeError from None


def _drop_output() -> None:
    """Discard output that is not flushed yet."""
    if sys.stdout is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(name: str, message: str) -> int:
    click.echo(f"{name}: {' '.join(message.split())}", err=True)
    return 2
