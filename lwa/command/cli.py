"""The command `lwa`, and how a command runs: UTF-8, exit status, one clear line for a fault."""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

import click

from lwa.base import INTERRUPTED, Refusal, cut
from lwa.base.progress import alive
from lwa.command.hints import help_end, next_step

HELP = {"help_option_names": ["-h", "--help"]}
"""Settings of a command: both ways to ask for help."""

CLOSED = (
    128 + 13
)  # exit status as in shells: 128 and SIGPIPE's number, which Windows lacks

version = click.version_option(package_name="lwa", message="%(prog)s %(version)s")
"""The option ``--version`` of a command."""


class Commands(click.Group):
    """A Click group that loads a command when it is called: `--help` loads none, for a quick start.

    table : module in ``package``, and summary, of each command by its name. The module has a Click
        command of that name, or an object whose ``command`` is one.
    """

    def __init__(
        self, package: str, table: Mapping[str, tuple[str, str]], **settings: Any
    ) -> None:
        # placeholders: Click lists their names, and suggests one for a mistyped name
        super().__init__(
            commands={name: click.Command(name) for name in table}, **settings
        )
        self.package, self.table = package, table

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """Return the command with a given name, or None."""
        if name not in self.table:
            return None
        loaded = getattr(import_module(f"{self.package}.{self.table[name][0]}"), name)
        command: click.Command = getattr(loaded, "command", loaded)
        return command

    def format_commands(
        self, context: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the list of commands without loading them."""
        with formatter.section("Commands"):
            formatter.write_dl(
                [(name, summary) for name, (_, summary) in self.table.items()]
            )


def run(
    command: click.Command, name: str, arguments: Sequence[str] | None = None
) -> None:
    """Run a command and end the process with its status.

    The status is that of the command (0, or 1 for comparisons that failed), 2 after one line on bad
    input, `INTERRUPTED` after Ctrl-C, and `CLOSED` where the reader of the output went away.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # UTF-8 for Greek letters whatever the locale says; a file name that is not UTF-8 stands
            # as \udcff in a message
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    # Numbers of 330 digits have coefficients of 10^5 at the highest orders; 3·10^5 are read in 1 s.
    sys.set_int_max_str_digits(300_000)
    given = sys.argv[1:] if arguments is None else arguments
    sys.exit(_status(command, name, given))


def _status(command: click.Command, name: str, arguments: Sequence[str]) -> int:
    """Run a command and return its exit status; what it refuses is one line on standard error."""
    output = sys.stdout
    status = 2
    try:
        if output is None:
            raise OSError(errno.EBADF, "it is closed")
        with alive(name):
            result = command.main(arguments, prog_name=name, standalone_mode=False)
        return result if isinstance(result, int) else 0
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message(), err=True)
        return 2
    except click.ClickException as error:
        fault = error.format_message()
    except Refusal as refusal:
        fault = next_step(refusal, command, name, arguments)
    except (click.Abort, KeyboardInterrupt) as error:
        status = INTERRUPTED
        interrupt = error.__cause__ or error  # click puts an Abort around it
        # A command may say how to go on.
        fault = ": ".join(["interrupted", *map(str, interrupt.args)])
    except (OSError, SystemExit) as error:
        if isinstance(error, SystemExit) and sys.stdout is output:
            raise
        # Click replaces the output, and exits, where a pipe is closed.
        sys.stdout = output
        if output is not None:  # discard what is not flushed yet
            os.dup2(os.open(os.devnull, os.O_WRONLY), output.fileno())
        if isinstance(error, SystemExit):
            return CLOSED
        fault = f"{error.filename or 'the output'}: {error.strerror or error}"
    click.echo(cut(f"{name}: {fault}"), err=True)
    return status


COMMANDS = {
    "derive": ("derivation", "Derive the long-wave equation of a chain."),
    "dispersion": ("modes", "Series of Ω²(κ), and the bands of a loaded chain."),
    "envelope": ("modes", "Nonlinear Schrödinger equation of a mode, and breathers."),
    "expansion": ("series", "Series in k - 1 of the lattice's own wave, summed."),
    "shock": ("driven", "Shock, or rarefaction, of a chain that a wall drives."),
    "strike": ("driven", "Leading pulse of equal beads that a mass strikes."),
    "wave": ("waves", "Compact traveling wave: β, width, FWHM, amplitude and speed."),
}
"""Module in `lwa.command`, and summary, of each command by its name."""


@click.group(
    cls=Commands,
    package="lwa.command",
    table=COMMANDS,
    context_settings=HELP,
    epilog=help_end(["lwa derive", "lwa wave --k 3/2 --masses 1"], "reference"),
)
@version
def lwa() -> None:
    """Long-wave theory of granular chains with contact force F = A δ^k.

    δ is the compression of a contact, A its stiffness. Numbers are integers, decimals or fractions
    (3/2); any of them may be a plain name instead, and results then hold the symbol. Results have
    the units in which the masses, stiffnesses and lengths are given.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
