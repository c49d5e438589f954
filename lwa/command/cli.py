"""The command `lwa`: derivations, waves and dispersion relations on the command line."""

from __future__ import annotations

from collections.abc import Sequence

import click

from lwa.command.terminal import HELP, Commands, run, version

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


@click.group(cls=Commands, package="lwa.command", table=COMMANDS, context_settings=HELP)
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
