"""Run a command as a program: UTF-8 output, exit status, one clear line for a fault."""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
from collections.abc import Sequence

import click

from lwa.base.errors import InputError, NoSolitaryWave

HELP = {"help_option_names": ["-h", "--help"]}
"""Settings of a command: both ways to ask for help."""

# Exit statuses as in shells: 128 and the number of the signal, SIGPIPE's 13 and SIGINT's 2
CLOSED, INTERRUPTED = 128 + 13, 128 + signal.SIGINT

version = click.version_option(package_name="lwa", message="%(prog)s %(version)s")
"""The option ``--version`` of a command."""


def run(command: click.Command, name: str, arguments: Sequence[str] | None = None) -> None:
    """Run a command and end the process with its status.

    The status is that of the command (0, or 1 for comparisons that failed), 2 after one line on bad
    input, `INTERRUPTED` after Ctrl-C, and `CLOSED` where the reader of the output went away.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # UTF-8 for Greek letters whatever the locale says; a file name that is not UTF-8 stands
            # as \udcff in a message
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    sys.exit(_status(command, name, arguments))


def _status(command: click.Command, name: str, arguments: Sequence[str] | None) -> int:
    output, status, fault = sys.stdout, 2, ""
    try:
        if output is None:
            raise OSError(errno.EBADF, "it is closed")
        result = command.main(arguments, prog_name=name, standalone_mode=False)
        output.flush()
        return result if isinstance(result, int) else 0
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message(), err=True)
        return 2
    except click.ClickException as error:
        fault = error.format_message()
    except (InputError, NoSolitaryWave) as error:
        fault = str(error)
    except (click.Abort, KeyboardInterrupt):
        status, fault = INTERRUPTED, "interrupted"
    except (OSError, SystemExit) as error:
        if isinstance(error, SystemExit) and sys.stdout is output:
            raise
        sys.stdout = output  # click replaces the output, and exits, where a pipe is closed
        if output is not None:  # discard what is not flushed yet
            os.dup2(os.open(os.devnull, os.O_WRONLY), output.fileno())
        if isinstance(error, SystemExit | BrokenPipeError):
            return CLOSED
        fault = f"{error.filename or 'the output'}: {error.strerror or error}"
    click.echo(f"{name}: {' '.join(fault.split())}", err=True)
    return status
