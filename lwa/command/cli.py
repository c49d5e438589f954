"""The command `lwa`, and how a command runs: UTF-8, exit status, one clear line for a fault."""

from __future__ import annotations

import errno
import io
import os
import re
import shlex
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from itertools import pairwise
from typing import Any

import click

from lwa.base import INTERRUPTED, LONGEST_MESSAGE, Refusal, cut
from lwa.base.progress import alive

HELP = {"help_option_names": ["-h", "--help"]}
"""Settings of a command: both ways to ask for help."""

CLOSED = 128 + 13
"""Exit status of a closed pipe, as in shells: 128 and SIGPIPE's number, which Windows lacks."""

version = click.version_option(package_name="lwa", message="%(prog)s %(version)s")
"""The option ``--version`` of a command."""


def called(option: click.Parameter | None) -> str:
    """Name of an option in messages, without its dashes."""
    # Click's own types allow a value without an option.
    return option.opts[0].lstrip("-") if option else "value"


def help_end(examples: Sequence[str], page: str) -> str:
    """The end of a command's help.

    Parameters
    ----------
    examples : sequence of str
        Lines that run one after another in an empty folder.
    page : str
        Name of the book's page on the command, without an ending; empty for none.
    """
    # Click leaves the lines of a paragraph after \b as they are.
    parts = ["\b\nExamples:", *(f"  {line}" for line in examples)]
    if page:
        parts += ["", f"In the book: {page}.html"]
    return "\n".join(parts)


class Commands(click.Group):
    """A Click group that loads a command when it is called: `--help` loads none, for a quick start.

    Parameters
    ----------
    package : str
        The package of the commands' modules.
    table : mapping
        Name of a module and summary of each command, by the command's name. The module has a Click
        command of that name, or an object whose ``command`` is one.
    **settings
        Further arguments of the group.
    """

    def __init__(
        self, package: str, table: Mapping[str, tuple[str, str]], **settings: Any
    ) -> None:
        # Click lists these placeholders, and suggests their names for a mistyped one. Their modules
        # are left out here: `resolve_command` loads the one that is called.
        commands = {
            name: click.Command(name, short_help=summary)
            for name, (_, summary) in table.items()
        }
        super().__init__(commands=commands, **settings)
        self.package = package
        self.table = table

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Load the command that the first word names; the rest of the line is returned."""
        name, command, rest = super().resolve_command(ctx, args)
        if name is not None:
            module, _ = self.table[name]
            loaded = getattr(import_module(f"{self.package}.{module}"), name)
            # Not every module has a Click command: a study of `validation` holds its own one.
            command = getattr(loaded, "command", loaded)
        return name, command, rest


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
    sys.set_int_max_str_digits(MOST_DIGITS)
    given = sys.argv[1:] if arguments is None else arguments
    sys.exit(_status(command, name, given))


def _status(command: click.Command, name: str, arguments: Sequence[str]) -> int:
    """Run a command and return its exit status; a refusal is one line on standard error."""
    output = sys.stdout
    status = 2
    try:
        if output is None:
            raise OSError(errno.EBADF, "it is closed")
        with alive(name):
            result = command.main(arguments, prog_name=name, standalone_mode=False)
        return result if isinstance(result, int) else 0
    except click.exceptions.NoArgsIsHelpError as help_text:
        help_text.show()
        return status
    except click.ClickException as error:
        fault = error.format_message()
        context = getattr(error, "ctx", None)
        if context is not None:
            fault += f" Try: {context.command_path} --help"
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


def next_step(
    refusal: Refusal, command: click.Command, name: str, arguments: Sequence[str]
) -> str:
    """The reason of a refusal and, behind "; try:", a whole line to paste.

    The line is the user's own with the arguments of `Refusal.change`, or with the example of the
    option that the reason names. Without either, the fault is in a file of the line, if there is
    one: the user's own line reads a record again, and the keys of a scene are shown. Else it is the
    last example of the command's help, or of those before the refused one.
    """
    if TRY in refusal.reason:  # the reason has a line of its own, on a file
        return refusal.reason
    line: list[str] = []
    for word in arguments:  # --k=2 is --k 2
        line += word.split("=", 1) if word.startswith("--") else [word]
    chosen: Any = command
    if isinstance(command, click.Group):
        # Options of the group itself end it, so that the first word is a command.
        _, chosen, _ = command.resolve_command(click.Context(command), line)
    change = _change(refusal, chosen.params, line)
    # A file stands in place of the options of a chain: a wrong one is left out.
    if "--spheres" in line and change.keys() & CHAIN:
        change = {name: None for name in change if f"--{name}" in line}
    files = [*filter(os.path.isfile, line)]
    if files and not change and files[-1].endswith((".toml", ".json")):
        return cut(f"{refusal.reason}; change it in the file{TRY}{KEYS}")
    examples = re.findall(rf"^  ({name} .*)", chosen.epilog or "", re.MULTILINE)
    refused = shlex.join([name, *arguments])
    if refused in examples:
        # The example before it writes its file.
        examples = examples[: examples.index(refused)]
    proposed = [f"{name} --help", *examples][-1]
    if change or files:
        changes = _changed(line, change)
        whole = shlex.join([name, *line, *changes])
        # A message is cut in its middle: the whole line stands at its end, or is not there.
        if len(whole) < LONGEST_MESSAGE - _SHORTEST_REASON:
            proposed = whole
        elif changes:
            proposed = shlex.join(changes)
    room = LONGEST_MESSAGE - len(f"{name}: {TRY}{proposed}")
    return f"{cut(refusal.reason, room)}{TRY}{proposed}"


def _changed(line: list[str], change: Mapping[str, object]) -> list[str]:
    """Remove the options of a change from a line, in place; return the words that replace them.

    The change has the values of options by name that make a refused line valid. A mapping is an
    option that is given several times, as ``--column force=2``; a tuple or list is written with
    commas, and None, an empty tuple or an empty mapping leaves the option out.
    """
    words = []
    for name, value in change.items():
        flag = f"--{name}"
        while flag in line:
            at = line.index(flag)
            del line[at : at + 2]  # the option and its value
        texts = [str(value)]
        if isinstance(value, Mapping):
            texts = [f"{key}={part}" for key, part in value.items()]
        elif isinstance(value, tuple | list):
            texts = [",".join(map(str, value))]
        for text in texts:
            if value not in (None, ()):
                words += [flag, text]
    return words


_SHORTEST_REASON = 100
"""Characters that a reason keeps beside a long line: a line and a quarter of a terminal."""

TRY = "; try: "
"""Mark between the reason of a refusal and the line to paste."""

KEYS = "lwa-validate run --keys"
"""The line that shows all keys of a file."""

_SUBJECT = re.compile(r"(\w+) is |'(\w+)' has no value")
"""The option at the start of a reason, or the symbol for which a number is wanted."""


CHAIN = ("k", "law", "masses", "stiffnesses", "spacing")
"""Options of a chain, which a file replaces."""


def _change(
    refusal: Refusal, options: Sequence[click.Parameter], line: Sequence[str]
) -> dict[str, object]:
    """Values by option that the refused line shall have; None for an option to leave out.

    They are those of the refusal, else the example of the option that its reason is about.
    """
    change: dict[str, object] = {}
    for option in options:
        for known in (called(option), option.name):  # on the command line and in Python
            if known in refusal.change:
                change[called(option)] = refusal.change[known]
    # [1] is the option that the reason names, [2] a symbol without a value; one of them is None.
    subject = _SUBJECT.match(refusal.reason)
    if change or subject is None:
        return change
    near = re.search(r"did you mean ([\w-]+)", refusal.reason)
    # The word behind each word, such as the value behind an option
    values = dict(pairwise(line))
    for option in options:
        name = called(option)
        # Options of `lwa` have an example; the default of others is a valid text.
        default = option.default if isinstance(option.default, str) else None
        example = near[1] if near else getattr(option.type, "example", default)
        text = values.get(f"--{name}", default)
        meant = name == subject[1] or subject[2] in re.split(r"\W", text or "")
        # A refusal of the example itself is about something else.
        if meant and example != text:
            change[name] = example
    # F is the symbol of a force that is not given; 10 is the example of --force.
    if subject[2] == "F" and not change:
        change["force"] = "10"
    return change


COMMANDS = {
    "derive": ("derivation", "Derive the long-wave equation of a chain."),
    "dispersion": ("modes", "Frequencies of linear waves, and bands under a load."),
    "envelope": ("modes", "Nonlinear Schrödinger equation of a mode, and breathers."),
    "expansion": ("series", "The beads' own solitary wave, as a series in k - 1."),
    "shock": ("driven", "Shock, or rarefaction, of a chain that a wall drives."),
    "strike": ("driven", "Leading pulse of equal beads that a mass strikes."),
    "wave": ("waves", "Compact traveling wave: β, width, FWHM, amplitude and speed."),
}
"""Module in `lwa.command`, and summary, of each command by its name."""


MOST_DIGITS = 300_000
"""Digits of an integer that are printed: numbers of 330 digits have coefficients of 10⁵ at the
highest orders; 3·10⁵ take a second."""


@click.group(
    cls=Commands,
    package="lwa.command",
    table=COMMANDS,
    context_settings=HELP,
    epilog=help_end(["lwa derive", "lwa wave --k 3/2 --masses 1"], "reference"),
)
@version
def lwa() -> None:
    """Long-wave theory of granular chains, whose contacts push with the force A δᵏ.

    δ is the compression of a contact, A its stiffness. Numbers are integers, decimals or fractions
    (3/2); any of them may be a plain name instead, and results then hold the symbol. Results have
    the units in which the masses, stiffnesses and lengths are given.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
