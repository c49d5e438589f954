"""Options that several commands have in common, their readers, and the end of a command's help."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from functools import reduce, wraps
from typing import Any

import click
import sympy as sp
from click.core import ParameterSource

from lwa.base.exact import InputError, integer, positive, read_exact
from lwa.base.words import BRANCHES, CLOSURES, FIELDS, one_of
from lwa.cell import D, exponent, k
from lwa.command.answer import Answer
from lwa.command.chain import take_chain
from lwa.command.cli import CHAIN, called, help_end
from lwa.law import NAMES, read_law

Function = Callable[..., Answer | str]
Option = Callable[[Any], Any]
Reader = Callable[[str, str], Any]
"""Function of a text and of the option's name in messages."""

STYLES = ("text", "json", "latex")
"""Values of ``--format`` of every command."""

# --- readers ---


class Read(click.ParamType[Any]):
    """The type of an option's value: a text that a reader takes.

    Parameters
    ----------
    read : callable
        Function of the text and of the option's name; raises `lwa.InputError` for other texts.
    example : str, optional
        A valid text, which the refusal of another one proposes.
    """

    name = "value"

    def __init__(self, read: Reader, example: str | None) -> None:
        self.read = read
        self.example = example

    # Click calls this for defaults, too, so that a default is a text that the reader takes.
    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Read the text of an option."""
        return self.read(value, called(param))


class Words(click.Choice[str]):
    """One of several words; the refusal of another word names those that are spelt alike."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str:
        """Return a word that is among the choices; see `lwa.base.words.one_of`."""
        return one_of(value, self.choices, called(param))


def row(read: Reader) -> Reader:
    """Make the reader of several texts that are separated by commas."""
    # No brackets and no blanks: a shell passes such a list without quotes.
    return lambda text, name: tuple(read(part, name) for part in text.split(","))


quantities = row(read_exact)
"""Reader of quantities that are separated by commas."""


def _exponent(text: str, name: str) -> sp.Expr:
    """Read an exponent k, a positive number or a name."""
    return exponent(positive(text, name))


def not_negative(text: str, name: str) -> sp.Expr:
    """Read a positive quantity or zero."""
    # A load of zero is no load, and as valid as a missing one.
    number = read_exact(text, name)
    if number.is_zero:
        return number
    return positive(number, name)


def angle(text: str, name: str) -> sp.Expr:
    """Read a quantity or a part of pi, such as pi, pi/3 or 2pi/3."""
    # A number of parts and a denominator, either of them absent where it is 1.
    part = re.fullmatch(r"([0-9]*)\*?pi(?:/([1-9][0-9]*))?", text.strip())
    if part is None:
        return read_exact(text, name)
    # Exact, so that the edges of a band are told from wavenumbers beside them.
    return sp.Rational(int(part[1] or 1), int(part[2] or 1)) * sp.pi


def count(text: str, name: str) -> int:
    """Read an integer from 1 on."""
    return integer(read_exact(text, name), name, 1)


# --- commands ---

ALTERNATIVES: dict[str, Sequence[str]] = {
    "law": ["k"],
    "spheres": CHAIN,
    "precompression": ["background"],
    "background": ["force"],
    "behind": ["piston"],
    "velocity": ["drop"],
    "frequency": ["detuning"],
}
"""Options that another one replaces, by that option."""


def given(option: str) -> bool:
    """True if the option was given on the command line."""
    # Click knows where a value comes from: an option that is given as its default is given.
    source = click.get_current_context().get_parameter_source(option)
    return source is ParameterSource.COMMANDLINE


def command(
    *examples: str, page: str, languages: Sequence[str] = ()
) -> Callable[[Function], click.Command]:
    """Make a decorator that turns a function of a chain into a command.

    The function takes the chain of the options (`lwa.command.chain`), and the further options as
    keywords; it returns the answer. Its docstring is the help of the command.

    Parameters
    ----------
    *examples : str
        Lines that run one after another in an empty folder, shown at the end of the help.
    page : str
        Page of the book on the command.
    languages : sequence of str
        Values of ``--format`` beside `STYLES`.
    """

    def decorate(function: Function) -> click.Command:
        """Turn a function of a chain into a command."""
        # Literals of reStructuredText have no marks on a terminal.
        says = inspect.cleandoc(function.__doc__ or "").replace("``", "")

        @click.option(
            "--format",
            "style",
            type=Words([*STYLES, *languages]),
            default=STYLES[0],
            show_default=True,
            help="Form of the result.",
        )
        @wraps(function)
        def answer(style: str, **options: Any) -> None:
            # Click has no options that exclude each other.
            for option, replaced in ALTERNATIVES.items():
                for other in filter(given, replaced):
                    if given(option):
                        raise InputError(
                            f"--{option} and --{other} are both given: one says the other",
                            **{other: None},  # proposed: the line without this option
                        )
            # `take_chain` removes the options that describe the chain: the others are left.
            made = function(take_chain(options), **options)
            # The source code of a wave is a text already.
            click.echo(made if isinstance(made, str) else getattr(made, style)())

        return click.command(help=says, epilog=help_end(examples, page))(answer)

    return decorate


# --- options ---


def value(
    name: str,
    says: str,
    example: str,
    read: Reader = read_exact,
    default: str | None = None,
    metavar: str = "VALUE",
) -> Option:
    """Make an option.

    Parameters
    ----------
    name : str
        The option with its dashes.
    says : str
        Help of the option.
    example : str
        A valid text, for refusals of other texts.
    read : callable
        Reader of the text, by default that of one quantity.
    default : str, optional
        Text in place of an absent option, shown in the help.
    metavar : str
        Word for the text in the help.
    """
    return click.option(
        name,
        type=Read(read, example),
        default=default,
        show_default=default is not None,
        metavar=metavar,
        help=says,
    )


def together(*options: Option) -> Option:
    """Combine several options into one decorator, in their order in the help."""
    # Decorators apply from the last to the first; Click lists options in the order of application.
    return lambda function: reduce(
        lambda made, option: option(made), reversed(options), function
    )


def exponent_option(default: str) -> Option:
    """Make the option ``--k``."""
    # 3/2 is the exponent of spheres, and the example of every refusal.
    says = "Exponent k of the force A δ^k of a contact."
    return value("--k", says, "3/2", _exponent, default)


def order_option(says: str, default: str | None = "4") -> Option:
    """Make the option ``--order``; without a default the command chooses."""
    return value("--order", says, "4", count, default, "N")


def law_option(says: str) -> Option:
    """Make the option ``--law``."""
    return value("--law", says, "hertz2:1,2", read_law, metavar="NAME[:PARAM,…]")


# The file is read by the command, whose refusals have the line to paste.
SPHERES = click.option(
    "--spheres",
    metavar="FILE",
    type=click.Path(),
    help="TOML or JSON file of the chain, in place of options on masses, contacts and spacing: "
    "spheres in SI, or any scene of lwa-validate run.",
)
# The example is the dimer of the paper, steel and PTFE, in grams.
MASSES = value(
    "--masses",
    "Masses of the beads in one period of the chain.",
    "0.45,0.123",
    row(positive),
    "m1,m2",
    "M1,M2,…",
)
STIFFNESSES = value(
    "--stiffnesses",
    "Stiffness A of each contact in the period, the first between beads 1 and 2.  "
    "[default: all 1]",
    "1,1",
    row(positive),
    metavar="A1,A2,…",
)
# A symbol by default: results are then in units of D.
SPACING = value(
    "--spacing", "Distance D between neighbouring beads at rest.", "1", positive, D.name
)
# Forces are those of contacts, which sensors between beads measure.
FORCE = value(
    "--force",
    "Peak contact force of the wave, any static load included; in N if the chain is in SI.",
    "10",
    positive,
)
BACKGROUND = value(
    "--background",
    "Static strain of the chain, compression over D.",
    "1/10",
    not_negative,
)
PRECOMPRESSION = value(
    "--precompression",
    "Static force on the chain; in N if the chain is in SI.",
    "1",
    not_negative,
)


# Names alone: what their parameters mean stands in the book.
CELL = together(
    exponent_option(k.name),
    law_option(
        "Contact force A F(δ) by the name and the parameters of F, in place of --k: "
        f"{', '.join(NAMES)}."
    ),
    MASSES,
    STIFFNESSES,
    SPACING,
)
"""Options of a chain and its contact law."""

THEORY = together(
    CELL,
    order_option("Highest power of D in the ansatz, an integer."),
    click.option(
        "--closure",
        type=Words(CLOSURES),
        help="How the motion of the other beads follows from that of the first: linear, the "
        "paper's ansatz, or full, which satisfies the equation of motion of every bead.  "
        "[default: linear for one or two masses, else full]",
    ),
    click.option(
        "--field",
        type=Words(FIELDS),
        help="Unknown u of the wave equation: displacement of the first bead, or the "
        "mass-weighted mean of all beads.  [default: first with --closure linear, else center]",
    ),
    click.option(
        "--branch",
        type=Words(BRANCHES),
        # The branch of compact waves; the optical one is an oscillation in place.
        default=BRANCHES[0],
        show_default=True,
        help="Neighbours move together (acoustic) or against each other.",
    ),
)
"""Options of a chain and its long-wave theory."""
