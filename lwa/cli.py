"""The command `lwa`: derivations and waves on the command line."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import click
import sympy as sp

from lwa.cell import Cell, D, k
from lwa.closure import BRANCHES, CLOSURES, FIELDS
from lwa.render import theory_json, wave_json
from lwa.source import theory_latex, theory_python, wave_latex, wave_python
from lwa.terminal import quantities, quantity, run
from lwa.text import theory_text, wave_text
from lwa.theory import Theory, homogenize

Command = Callable[..., None]

THEORY = {
    "text": theory_text,
    "json": theory_json,
    "latex": theory_latex,
    "python": theory_python,
}
WAVE = {"text": wave_text, "json": wave_json, "latex": wave_latex, "python": wave_python}


@click.group()
def lwa() -> None:
    """Long-wave theory of granular chains with contact force F = A δ^k.

    Numbers are integers, decimals or fractions (3/2); symbols are plain names.
    """


def _chain(command: Command) -> Command:
    """The options that name a chain and its theory."""
    options = [
        click.option("--k", "exponent", callback=quantity, default=k.name, show_default=True,
                     help="Exponent of the contact law."),
        click.option("--masses", callback=quantities, default="m1,m2", show_default=True,
                     help="Masses of the cell's particles."),
        click.option("--stiffnesses", callback=quantities,
                     help="Stiffnesses of its contacts; equal ones by default."),
        click.option("--spacing", callback=quantity, default=D.name, show_default=True,
                     help="Distance of neighbouring particles."),
        click.option("--order", type=int, default=4, show_default=True,
                     help="Highest power of D in the ansatz."),
        click.option("--closure", default="linear", show_default=True,
                     help=f"The consistency condition: {' or '.join(CLOSURES)}."),
        click.option("--field", default="first", show_default=True,
                     help=f"The field described: {' or '.join(FIELDS)} (closure full)."),
        click.option("--branch", default="acoustic", show_default=True,
                     help=f"{' or '.join(BRANCHES)}."),
        click.option("--format", "style", type=click.Choice(list(THEORY)), default="text",
                     show_default=True, help="How to print the result."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def _theory(
    exponent: sp.Expr,
    masses: Sequence[sp.Expr],
    stiffnesses: Sequence[sp.Expr],
    spacing: sp.Expr,
    order: int,
    closure: str,
    field: str,
    branch: str,
) -> Theory:
    cell = Cell(tuple(masses), stiffnesses=tuple(stiffnesses), spacing=spacing)
    return homogenize(cell, order, k=exponent, closure=closure, branch=branch, field=field)


def _show(result: Any) -> None:
    click.echo(result if isinstance(result, str) else json.dumps(result, indent=2))


@lwa.command()
@_chain
def derive(style: str, **chain: Any) -> None:
    """The ansatz, the wave equation and the defect between the equations of motion."""
    _show(THEORY[style](_theory(**chain)))


@lwa.command()
@_chain
def wave(style: str, **chain: Any) -> None:
    """The compact traveling wave: β, width, FWHM, amplitude and speed."""
    theory = _theory(**chain)
    _show(WAVE[style](theory, theory.pde.traveling_wave()))


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
