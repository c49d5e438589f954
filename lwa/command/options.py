"""Options that several commands have in common, and their readers: callbacks of click."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any

import click
import sympy as sp
from click.core import ParameterSource

from lwa.base.exact import integer, read_exact
from lwa.cell import D, k
from lwa.closure.consistency import BRANCHES, CLOSURES, FIELDS
from lwa.law import NAMES, read_law

Command = Callable[..., None]
Option = Callable[[Command], Command]

STYLES = ("text", "json", "latex")
"""Values of ``--format`` of every command."""

# --- readers ---


def called(option: click.Parameter) -> str:
    """Name of an option in messages, without its dashes."""
    return option.opts[0].lstrip("-")


def reader(read: Callable[[str, str], Any]) -> Callable[..., Any]:
    """Make a callback of click that reads a text under the name of its option; None when absent."""
    return lambda context, option, text: (
        None if text is None else read(text, called(option))
    )


quantity = reader(read_exact)
"""Callback that reads an integer, a decimal, a fraction or a plain name."""


def quantities(
    context: click.Context, option: click.Parameter, text: str | None
) -> tuple[sp.Expr, ...]:
    """Read quantities separated by commas; () when absent."""
    return (
        tuple(read_exact(part, called(option)) for part in text.split(","))
        if text
        else ()
    )


def angle(text: str, name: str) -> sp.Expr:
    """Read a quantity or a part of pi, such as pi, pi/3 or 2pi/3."""
    part = re.fullmatch(r"([0-9]*)\*?pi(?:/([1-9][0-9]*))?", text.strip())
    if part is None:
        return read_exact(text, name)
    return sp.Rational(int(part[1] or 1), int(part[2] or 1)) * sp.pi


def count(text: str, name: str) -> int:
    """Read an integer from 1 on."""
    return integer(read_exact(text, name), name, 1)


def given(option: str) -> bool:
    """True if the option was given on the command line."""
    source = click.get_current_context().get_parameter_source(option)
    return source is ParameterSource.COMMANDLINE


# --- options ---


def value(
    name: str,
    says: str,
    default: str | None = None,
    read: Any = quantity,
    metavar: str = "VALUE",
    **settings: Any,
) -> Option:
    """Make an option that a callback of click reads; a default is shown in the help."""
    if (
        default is not None
    ):  # None itself would be a default, and no required option missing
        settings |= {"default": default, "show_default": True}
    return click.option(name, callback=read, metavar=metavar, help=says, **settings)


def together(*options: Option) -> Option:
    """Combine several options into one decorator, in their order in the help."""
    return lambda command: reduce(
        lambda c, option: option(c), reversed(options), command
    )


def _choice(name: str, values: Sequence[str], says: str, *names: str) -> Option:
    kind = click.Choice(values)
    return click.option(
        name, *names, default=values[0], show_default=True, type=kind, help=says
    )


def exponent_option(default: str) -> Option:
    """Make the option ``--k``."""
    return value("--k", "Exponent k of the force A δ^k of a contact.", default)


def order_option(says: str, default: str | None = "4") -> Option:
    """Make the option ``--order``; without a default the command chooses."""
    return value("--order", says, default, reader(count), "N")


def law_option(says: str) -> Option:
    """Make the option ``--law``."""
    return value("--law", says, None, reader(read_law), "NAME[:PARAM,…]")


def style_option(languages: Sequence[str] = ()) -> Option:
    """Make the option ``--format``, the argument ``style`` of a command."""
    return _choice("--format", (*STYLES, *languages), "Form of the result.", "style")


def spheres_option(**settings: Any) -> Option:
    """Make the option ``--spheres``."""
    says = (
        "TOML or JSON file of the chain, in place of options on masses, contacts and spacing: "
        "spheres in SI, or any scene of lwa-validate run."
    )
    return value("--spheres", says, None, None, "FILE", type=click.Path(), **settings)


MASSES = value(
    "--masses",
    "Masses of the beads in one period of the chain.",
    "m1,m2",
    quantities,
    "M1,M2,…",
)
STIFFNESSES = value(
    "--stiffnesses",
    "Stiffness A of each contact in the period, the first between beads 1 and 2.  [default: all 1]",
    None,
    quantities,
    "A1,A2,…",
)
SPACING = value("--spacing", "Distance D between neighbouring beads at rest.", D.name)
FORCE = value(
    "--force",
    "Peak contact force of the wave, any static load included; in N if the chain is in SI.",
)
SPHERES = spheres_option()
BACKGROUND = value("--background", "Static strain of the chain, compression over D.")
PRECOMPRESSION = value(
    "--precompression", "Static force on the chain; in N if the chain is in SI."
)


def cell_options(languages: Sequence[str] = ()) -> Option:
    """Make the options that describe a chain and its contact law."""
    law = "Contact force A F(δ) by the name and the parameters of F, in place of --k: "
    return together(
        exponent_option(k.name),
        law_option(f"{law}{', '.join(NAMES)}."),
        MASSES,
        STIFFNESSES,
        SPACING,
        style_option(languages),
    )


def theory_options(languages: Sequence[str] = ()) -> Option:
    """Make the options that describe a chain and its long-wave theory."""
    return together(
        cell_options(languages),
        order_option("Highest power of D in the ansatz, an integer."),
        _choice(
            "--closure",
            CLOSURES,
            "How the motion of the other beads follows from that of the first: linear, the "
            "paper's ansatz, or full, which satisfies the equation of motion of every bead.",
        ),
        _choice(
            "--field",
            FIELDS,
            "Unknown u of the wave equation: displacement of the first bead, or the mass-weighted "
            "mean of all beads (center, which needs --closure full).",
        ),
        _choice(
            "--branch",
            BRANCHES,
            "Neighbours move together (acoustic) or against each other.",
        ),
    )


def series_options(exponent: str, order: str, default: str | None = "4") -> Option:
    """Make the options of a command on a series, with the defaults of ``--k`` and ``--order``."""
    highest = order_option(order, default)
    return together(
        exponent_option(exponent), MASSES, STIFFNESSES, highest, style_option()
    )
