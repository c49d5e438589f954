"""The command `lwa`: derivations, waves and dispersion relations on the command line."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from functools import reduce, wraps
from typing import Any

import click
import sympy as sp
from click.core import ParameterSource

from lwa.cell import Cell, D, k
from lwa.closure.consistency import BRANCHES, CLOSURES, FIELDS
from lwa.code.languages import LANGUAGES
from lwa.command.document import (
    SI,
    dispersion_json,
    expansion_json,
    force_json,
    theory_json,
    wave_json,
)
from lwa.command.letters import demand_own
from lwa.command.source import theory_latex, theory_python, wave_latex
from lwa.command.terminal import quantities, quantity, run
from lwa.command.text import dispersion_text, expansion_text, force_text, theory_text, wave_text
from lwa.duration import announce
from lwa.exact import InputError, exact
from lwa.expansion.expand import expand
from lwa.linear.dispersion import Dispersion
from lwa.spheres.hertz import EXPONENT
from lwa.theory import Theory, homogenize

Command = Callable[..., None]
Option = Callable[[Command], Command]

THEORY = {
    "text": theory_text,
    "json": theory_json,
    "latex": theory_latex,
    "python": theory_python,
}
WAVE = {"text": wave_text, "json": wave_json, "latex": wave_latex} | {
    language: lambda _, wave, language=language: wave.code(language) for language in LANGUAGES
}
FORCE = {"text": force_text, "json": force_json}
DISPERSION = {"text": dispersion_text, "json": dispersion_json}
EXPANSION = {"text": expansion_text, "json": expansion_json}


def _option(name: str, default: Any, help_text: str, **settings: Any) -> Option:
    return click.option(name, default=default, show_default=True, help=help_text, **settings)


def _exponent(default: str) -> Option:
    return _option("--k", default, "Exponent of the contact law.", callback=quantity)


def _order(help_text: str) -> Option:
    return _option("--order", 4, help_text, type=int)


def _style(formats: Iterable[str]) -> Option:
    return click.option(
        "--format", "style", type=click.Choice(list(formats)), default="text", show_default=True,
        help="How to print the result.",
    )  # fmt: skip


MASSES = _option("--masses", "m1,m2", "Masses of the cell's particles.", callback=quantities)
STIFFNESSES = click.option(
    "--stiffnesses", callback=quantities, help="Stiffnesses of its contacts; equal by default."
)


def _chain(formats: Iterable[str]) -> Option:
    """The options that name a chain and its theory."""
    options = (
        _exponent(k.name),
        MASSES,
        STIFFNESSES,
        _option("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity),
        _order("Highest power of D in the ansatz."),
        _option("--closure", "linear", f"Consistency condition: {' or '.join(CLOSURES)}."),
        _option("--field", "first", f"Field described: {' or '.join(FIELDS)} (closure full)."),
        _option("--branch", "acoustic", f"{' or '.join(BRANCHES).capitalize()}."),
        _style(formats),
    )
    return lambda command: reduce(lambda c, option: option(c), reversed(options), command)


def _series(k: str, order: str, formats: Iterable[str]) -> Option:
    """The options of a command on a series: its cell, exponent and order; ``k`` by default."""

    def decorated(command: Command) -> Command:
        @wraps(command)
        def of_cell(
            masses: tuple[sp.Expr, ...], stiffnesses: tuple[sp.Expr, ...], **options: Any
        ) -> None:
            cell = Cell(masses, stiffnesses)
            _demand_own(cell, options["k"])
            command(cell, **options)

        given: Command = of_cell
        for option in (_style(formats), _order(order), STIFFNESSES, MASSES, _exponent(k)):
            given = option(given)
        return given

    return decorated


def _theory(
    k: sp.Expr,
    masses: tuple[sp.Expr, ...],
    stiffnesses: tuple[sp.Expr, ...],
    spacing: sp.Expr,
    order: int,
    **kind: str,
) -> Theory:
    cell = Cell(masses, stiffnesses, spacing)
    _demand_own(cell, k)
    return homogenize(cell, order, k=k, **kind)


def _demand_own(cell: Cell, *more: sp.Expr) -> None:
    """Symbols have names of their own in what the command prints."""
    demand_own(str(click.get_current_context().info_name), (*cell.symbols, *more))


SECONDS_A_TERM = 3e-4
"""To convert and to write a term of a coefficient."""


def _write_out(theory: Theory) -> None:
    """Where that takes long, say so and show the progress; what is written is kept."""
    length = sum(found.length(jet) for found in theory.orders for jet in found)
    if announce(f"{length} terms to be written", length * SECONDS_A_TERM):
        from tqdm import tqdm  # here, for a quick start of the others

        with tqdm(total=length, desc="terms", leave=False, disable=None) as progress:
            for found in theory.orders:
                for jet in found:
                    found.written(jet)
                    progress.update(found.length(jet))


def _show(result: Any) -> None:
    click.echo(result if isinstance(result, str) else json.dumps(result, indent=2))


@click.group()
def lwa() -> None:
    """Long-wave theory of granular chains with contact force F = A δ^k.

    Numbers are integers, decimals or fractions (3/2); symbols are plain names.
    """


@lwa.command()
@_chain(THEORY)
def derive(style: str, **chain: Any) -> None:
    """The ansatz, the wave equation and the defect between the equations of motion."""
    theory = _theory(**chain)
    _write_out(theory)
    _show(THEORY[style](theory))


@lwa.command()
@_chain(WAVE)
@click.option("--force", callback=quantity, help="Peak contact force, for speed, compression, ….")
@click.option(
    "--spheres", metavar="FILE", help="Beads, a TOML file (`lwa.spheres.beads`), in SI units."
)
def wave(style: str, force: sp.Expr | None, spheres: str | None, **chain: Any) -> None:
    """The compact traveling wave: β, width, FWHM, amplitude and speed.

    With --force, a number or a name, the wave of that peak contact force, in space and time; with
    --spheres all of it in m, s, kg and N.
    """
    if spheres is not None:
        chain |= _of_spheres(spheres)
    theory = _theory(**chain)
    found = theory.pde.traveling_wave()
    if style in FORCE and (force is not None or spheres is not None):
        units = {} if spheres is None else SI
        _show(FORCE[style](theory, found, exact("F", "force") if force is None else force, units))
    elif force is not None:
        raise InputError(f"--format {style} is for any force: --force goes with {', '.join(FORCE)}")
    else:
        _show(WAVE[style](theory, found))


def _of_spheres(file: str) -> dict[str, Any]:
    """The chain of a file of spheres, which no other option may describe."""
    from lwa.spheres.beads import (
        read_spheres,  # here, so that other commands do not load the parsers
    )

    context = click.get_current_context()
    for name in ("k", "masses", "stiffnesses", "spacing"):
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            raise InputError(f"--{name} and --spheres are both given: spheres have their own")
    cell = Cell.of_spheres(read_spheres(file))
    parts = {name: getattr(cell, name) for name in ("masses", "stiffnesses", "spacing")}
    return {"k": EXPONENT, **parts}


@lwa.command()
@_series("1", "Highest power of κ in Ω².", DISPERSION)
def dispersion(cell: Cell, k: sp.Expr, order: int, style: str) -> None:
    """The linear chain: the series of Ω²(κ), Ω the frequency in τ and κ the wavenumber, times D.

    The exponent matters for unequal contacts only, which share the strain by it.
    """
    _show(DISPERSION[style](Dispersion(cell, k), order))


@lwa.command()
@_series(k.name, "Highest power of ε = k - 1.", EXPANSION)
def expansion(cell: Cell, k: sp.Expr, order: int, style: str) -> None:
    """The lattice's wave as a series in ε = k - 1, summed where k and the cell are numbers."""
    _show(EXPANSION[style](expand(cell, order, k=k)))


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
