"""The command `lwa`: derivations, waves and dispersion relations on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

import click

from lwa.command.terminal import HELP, run, version

COMMANDS = {
    "derive": "derivation",
    "wave": "waves",
    "dispersion": "modes",
    "expansion": "series",
    "strike": "driven",
    "envelope": "modes",
    "shock": "driven",
}
"""Module of each command in `lwa.command`."""


class Commands(click.Group):
    """A Click group that loads a command's module when it is used, for a quick start."""

    def list_commands(self, context: click.Context) -> list[str]:
        """Return the names of all commands."""
        return sorted(COMMANDS)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """Return the command with a given name, or None."""
        if name not in COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"lwa.command.{COMMANDS[name]}"), name)
        return command


@click.group(cls=Commands, context_settings=HELP)
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
