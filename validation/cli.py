"""The command `lwa-validate`: the lattice, measured against the theory.

A study is loaded when it is called: `COMMANDS` says of each where it stands and what its help says.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

import click

from lwa.command.terminal import run

COMMANDS = {
    "limits": (
        "limits",
        "Equal masses, m1 ≫ m2 and k → 1: widths, speed and amplitude, held to bounds.",
    ),
    "paper": (
        "porter2008.experiment",
        "The steel:PTFE chain of the paper: speed, peak force and FWHM.",
    ),
    "figures": (
        "porter2008.gallery",
        "The paper's figures: force records, N:1 chains, force against speed, and the FWHM.",
    ),
    "exact": (
        "exact",
        "An exact traveling wave of the lattice: speed, widths, and the tail if it has one.",
    ),
    "resonances": (
        "exact",
        "The mass ratios m2/m1 < 1 at which a dimer has a solitary wave.",
    ),
    "hard": (
        "hard.verdicts",
        "Extreme k and ω, lost contacts, long runs, float64 against 50 digits: what holds there.",
    ),
    "accuracy": (
        "accuracy.workprecision",
        "Speed against error: integrators on fixed tasks, and theories against true waves.",
    ),
    "run": (
        "run",
        "A scene from a file, TOML or JSON: arrival, peak force, FWHM and speed at its sensors.",
    ),
    "sweep": (
        "sweep.atlas",
        "Maps over k and m2/m1: width, speed and decay of a struck chain's pulse.",
    ),
}
"""Name → the module in `validation.studies` that has NAME_command, and its help in one line."""


class Studies(click.Group):
    """A group whose commands are loaded one by one."""

    def list_commands(self, context: click.Context) -> list[str]:
        """Their names."""
        return list(COMMANDS)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """One of them."""
        if name not in COMMANDS:
            return None
        module, _ = COMMANDS[name]
        # here, for a quick start: a study loads SciPy and what else it needs
        found: click.Command = getattr(
            import_module(f"validation.studies.{module}"), f"{name}_command"
        )
        return found

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of them, without loading any."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, says) for name, (_, says) in COMMANDS.items()])


@click.group(cls=Studies)
def validate() -> None:
    """The lattice of F = A δ^k contacts, measured against the long-wave theory.

    Ends with 1 when a comparison does not hold and with 2 on bad input.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    run(validate, "lwa-validate", arguments)
