"""The options that several commands of `lwa` have in common."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import click
import sympy as sp
from click.core import ParameterSource

from lwa.cell import Cell, D, k
from lwa.closure.consistency import BRANCHES, CLOSURES, FIELDS
from lwa.command.reading import contact_law, count, quantities, quantity
from lwa.command.reserved_names import demand_free
from lwa.law import NAMES, ContactLaw
from lwa.spheres.hertz import EXPONENT

Command = Callable[..., None]
Option = Callable[[Command], Command]


def setting(
    name: str, default: Any, help_text: str, names: Sequence[str] = (), **settings: Any
) -> Option:
    """Make an option whose default value is shown in the help."""
    return click.option(
        name, *names, default=default, show_default=True, help=help_text, **settings
    )


def together(*options: Option) -> Option:
    """Combine several options into one decorator, in their order in the help."""
    return lambda command: reduce(lambda c, option: option(c), reversed(options), command)


def _choice(name: str, values: Sequence[str], help_text: str) -> Option:
    """Make an option with a few names for its values, the first by default."""
    return setting(name, values[0], help_text, type=click.Choice(values))


def exponent(default: str) -> Option:
    """The option ``--k``."""
    return setting("--k", default, "Exponent of the contact law.", callback=quantity)


def order_option(help_text: str) -> Option:
    """The option ``--order``."""
    return setting("--order", "4", help_text, callback=count)


def law_option(help_text: str) -> Option:
    """The option ``--law``."""
    return click.option(
        "--law",
        metavar="NAME[:PARAM,…]",
        callback=contact_law,
        help=help_text,
        shell_complete=lambda _, __, start: [name for name in NAMES if name.startswith(start)],
    )


def style_option(formats: Sequence[str]) -> Option:
    """The option ``--format``."""
    choice = click.Choice(formats)
    return setting("--format", "text", "How to print the result.", names=("style",), type=choice)


MASSES = setting("--masses", "m1,m2", "Masses of the cell's particles.", callback=quantities)
STIFFNESSES = click.option(
    "--stiffnesses", callback=quantities, help="Stiffnesses of its contacts; equal by default."
)


def of_cell(formats: Sequence[str]) -> Option:
    """The options that name a chain and its contact law."""
    return together(
        exponent(k.name),
        law_option(f"Contact law in place of the power: {', '.join(NAMES)}."),
        MASSES,
        STIFFNESSES,
        setting("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity),
        style_option(formats),
    )


def of_chain(formats: Sequence[str]) -> Option:
    """The options that name a chain and its theory."""
    return together(
        of_cell(formats),
        order_option("Highest power of D in the ansatz."),
        _choice("--closure", CLOSURES, "Consistency condition; linear is the paper's."),
        _choice("--field", FIELDS, "Field described; center wants closure full."),
        _choice("--branch", BRANCHES, "Branch of the motion."),
    )


def of_series(k: str, order: str, formats: Sequence[str]) -> Option:
    """The options of a command on a series: its cell, exponent and order; ``k`` by default."""
    return together(exponent(k), MASSES, STIFFNESSES, order_option(order), style_option(formats))


def given(option: str) -> bool:
    """True if the option was given on the command line."""
    source = click.get_current_context().get_parameter_source(option)
    return source is ParameterSource.COMMANDLINE


def si_units(k: sp.Expr) -> dict[str, str]:
    """SI units by key for the exponent k; values under other keys have none (τ is a length)."""
    lengths = ("spacing", "width", "fwhm", "compression", "compressions", "static_compression")
    return {
        "masses": "kg",
        "stiffnesses": f"N/m^({k})",
        "beta": "1/m",
        **dict.fromkeys(lengths, "m"),
        "fwhm_time": "s",
        **dict.fromkeys(("force", "precompression"), "N"),
        **dict.fromkeys(("speed", "bead_velocity", "sound_speed", "time_scale"), "m/s"),
    }


@dataclass(frozen=True)
class ChainInput:
    """A chain as the options of a command or a file describe it.

    precompression : static force of the chain, 0 for none.
    si : True if the numbers are in SI.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr = sp.S.Zero
    si: bool = False

    @property
    def units(self) -> dict[str, str]:
        """Units of the results by key; {} for a chain that is not in SI."""
        return si_units(self.law.exponent if self.law.homogeneous else EXPONENT) if self.si else {}

    @property
    def text(self) -> str:
        """The chain on one line."""
        masses = ", ".join(map(str, self.cell.masses))
        return f"masses {masses}; contact force A F, F = {self.law.F}"


def demand_free_names(chain: ChainInput, *values: sp.Expr | None, output: str = "") -> None:
    """Refuse symbols of a chain, and of values, that are named like a quantity of the output.

    output: a key of `NAMES`, the command's own name when empty.
    """
    output = output or str(click.get_current_context().info_name)
    more = (value for value in values if value is not None)
    cell = chain.cell
    demand_free(output, (*cell.masses, cell.spacing, *chain.law.symbols, *more))
    demand_free(output, cell.stiffnesses, own="A")


SPHERES_HELP = "Chain of a file: spheres, or any scene of `lwa-validate run`; in SI where it is."
FORCE = click.option("--force", callback=quantity, help="Peak contact force, for speed, widths, ….")
SPHERES = click.option("--spheres", metavar="FILE", help=SPHERES_HELP)
