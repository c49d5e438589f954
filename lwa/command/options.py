"""The options that several commands of `lwa` have in common."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import reduce, wraps
from typing import Any

import click
import sympy as sp
from click.core import ParameterSource

from lwa.cell import Cell, D, k
from lwa.closure.consistency import BRANCHES, CLOSURES, FIELDS
from lwa.command.reserved_names import demand_free
from lwa.command.terminal import contact_law, count, quantities, quantity
from lwa.law import NAMES

Command = Callable[..., None]
Option = Callable[[Command], Command]


def setting(name: str, default: Any, help_text: str, **settings: Any) -> Option:
    """An option whose default the help shows."""
    return click.option(name, default=default, show_default=True, help=help_text, **settings)


def exponent(default: str) -> Option:
    """``--k``."""
    return setting("--k", default, "Exponent of the contact law.", callback=quantity)


def order_option(help_text: str) -> Option:
    """``--order``."""
    return setting("--order", "4", help_text, callback=count)


def law_option(help_text: str) -> Option:
    """``--law``."""
    return click.option("--law", metavar="NAME[:PARAM,…]", callback=contact_law, help=help_text)


def style_option(formats: Iterable[str]) -> Option:
    """``--format``, one of these."""
    return click.option(
        "--format", "style", type=click.Choice(list(formats)), default="text", show_default=True,
        help="How to print the result.",
    )  # fmt: skip


MASSES = setting("--masses", "m1,m2", "Masses of the cell's particles.", callback=quantities)
STIFFNESSES = click.option(
    "--stiffnesses", callback=quantities, help="Stiffnesses of its contacts; equal by default."
)


def _with(options: tuple[Option, ...], command: Command) -> Command:
    return reduce(lambda c, option: option(c), reversed(options), command)


def of_chain(formats: Iterable[str]) -> Option:
    """The options that name a chain and its theory."""
    options = (
        exponent(k.name),
        law_option(f"Contact law in place of the power: {', '.join(NAMES)}."),
        MASSES,
        STIFFNESSES,
        setting("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity),
        order_option("Highest power of D in the ansatz."),
        setting("--closure", "linear", f"Consistency condition: {' or '.join(CLOSURES)}."),
        setting("--field", "first", f"Field described: {' or '.join(FIELDS)} (closure full)."),
        setting("--branch", "acoustic", f"{' or '.join(BRANCHES).capitalize()}."),
        style_option(formats),
    )
    return lambda command: _with(options, command)


def of_series(k: str, order: str, formats: Iterable[str]) -> Option:
    """The options of a command on a series: its cell, exponent and order; ``k`` by default."""

    def decorated(command: Command) -> Command:
        @wraps(command)
        def of_cell(
            masses: tuple[sp.Expr, ...], stiffnesses: tuple[sp.Expr, ...], **options: Any
        ) -> None:
            cell = Cell(masses, stiffnesses)
            demand_free_names(cell, options["k"])
            command(cell, **options)

        options = (exponent(k), MASSES, STIFFNESSES, order_option(order), style_option(formats))
        return _with(options, of_cell)

    return decorated


def given(option: str) -> bool:
    """Whether the option stands on the command line."""
    source = click.get_current_context().get_parameter_source(option)
    return source is ParameterSource.COMMANDLINE


def demand_free_names(cell: Cell, *more: sp.Expr, output: str = "") -> None:
    """Refuse symbols of a chain with names that the output has for something else.

    output: a key of `NAMES`, the command's own name when empty.
    """
    output = output or str(click.get_current_context().info_name)
    demand_free(output, (*cell.masses, cell.spacing, *more))
    demand_free(output, cell.stiffnesses, own="A")


FORCE = click.option("--force", callback=quantity, help="Peak contact force, for speed, widths, ….")
SPHERES = click.option(
    "--spheres", metavar="FILE", help="Beads, a TOML file (`lwa.spheres.beads`), in SI units."
)
