"""The command `lwa`: derivations, waves and dispersion relations on the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError
from lwa.cell import Cell, D, k
from lwa.code.languages import LANGUAGES
from lwa.command import derivation, waves
from lwa.command.options import (
    FORCE,
    SPHERES,
    SPHERES_HELP,
    ChainInput,
    demand_free_names,
    given,
    law_option,
    of_cell,
    of_chain,
    of_series,
    setting,
    style_option,
)
from lwa.command.reading import angle, quantity
from lwa.command.rows import Answer
from lwa.command.terminal import HELP, run, version
from lwa.law import Power, demand_one
from lwa.spheres.hertz import EXPONENT
from lwa.theory import homogenize

STYLES = ("text", "json", "latex")


def _chain(spheres: str | None, options: dict[str, Any]) -> ChainInput:
    """Return the chain of a file, or of the options, which are removed; refuse both."""
    names = ("masses", "stiffnesses", "spacing", "k", "law")
    own = {name: options.pop(name) for name in names if name in options}
    if spheres is not None:
        for name in own:
            if given(name):
                raise InputError(f"--{name} and --spheres are both given: spheres have their own")
        from lwa.command.chain_file import read_chain

        return read_chain(spheres)
    law = own.get("law")
    if law is not None:
        demand_one(own["k"], law)
    cell = Cell(own["masses"], own["stiffnesses"], own.get("spacing", D))
    return ChainInput(cell, law or Power(own["k"]))


def _precompression(
    chain: ChainInput, background: sp.Expr | None, precompression: sp.Expr | None
) -> sp.Expr | None:
    """Return the static force of the file or of the options; refuse two loads."""
    static = chain.precompression
    if static and (background is not None or precompression is not None):
        raise InputError(f"the file has a precompression of {static}: give no other load")
    return static or precompression


def _answer(style: str, answer: Answer) -> None:
    if style == "json":
        click.echo(json.dumps(answer.json(), indent=2))
    else:
        click.echo(answer.latex() if style == "latex" else answer.text())


@click.group(context_settings=HELP)
@version
def lwa() -> None:
    """Long-wave theory of granular chains with contact force F = A δ^k.

    Numbers are integers, decimals or fractions (3/2); symbols are plain names.
    """


@lwa.command()
@of_chain((*STYLES, "python"))
def derive(style: str, **options: Any) -> None:
    """The ansatz, the wave equation and the defect between the equations of motion."""
    chain = _chain(None, options)
    demand_free_names(chain)
    theory = homogenize(chain.cell, law=chain.law, **options)
    if style == "python":
        click.echo(derivation.source(theory))
    else:
        _answer(style, derivation.derivation(theory, tex=style == "latex"))


@lwa.command()
@of_chain((*STYLES, *LANGUAGES))
@FORCE
@SPHERES
@click.option("--background", callback=quantity, help="Strain of the chain ahead of the wave.")
@click.option(
    "--precompression", callback=quantity, help="Static load; --force is its sum with the wave's."
)
def wave(
    style: str,
    force: sp.Expr | None,
    spheres: str | None,
    background: sp.Expr | None,
    precompression: sp.Expr | None,
    **options: Any,
) -> None:
    """The compact traveling wave: β, width, FWHM, amplitude and speed.

    With --force, a number or a name, the wave of that peak contact force, in space and time; with
    --spheres all of it in m, s, kg and N. With --background or --precompression the wave of the
    canonical field in a chain under load.
    """
    chain = _chain(spheres, options)
    load = waves.Load(force, background, _precompression(chain, background, precompression))
    other = not chain.law.homogeneous
    under_load = load.under(other)
    output = "wave under load" if under_load or other else "wave"
    load.demand_free(output)
    if under_load:
        _canonical(options)
    demand_free_names(chain, output=output)
    theory = homogenize(chain.cell, law=chain.law, **options)
    if style in LANGUAGES:
        if force is not None:
            raise InputError(f"--format {style} is for any force: --force goes with {_STYLES}")
        click.echo(waves.source(theory, load if under_load else None, style))
    elif under_load:
        _answer(style, waves.under_load(theory, load, chain.units))
    else:
        found = theory.pde.traveling_wave()
        if force is None and spheres is None:
            _answer(style, waves.compact(theory, found))
        else:
            _answer(style, waves.at_force(theory, found, waves.peak(force), chain.units))


_STYLES = ", ".join(STYLES)


def _canonical(options: dict[str, Any]) -> None:
    """Set the closure of waves under load; refuse any other."""
    for name, wanted in (("closure", "full"), ("field", "center"), ("branch", "acoustic")):
        if given(name) and options[name] != wanted:
            raise InputError(
                f"{name} is {options[name]!r}: under load the wave is that of the canonical field, "
                f"{name} {wanted!r}"
            )
        options[name] = wanted


@lwa.command()
@of_series("1", "Highest power of κ in Ω².", STYLES)
@click.option(
    "--precompression",
    callback=quantity,
    help="Static load: bands in s⁻¹ of the chain about it; k is 3/2 unless it is given.",
)
@setting("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity)
def dispersion(
    order: int, style: str, precompression: sp.Expr | None, spacing: sp.Expr, **options: Any
) -> None:
    """The linear chain: the series of Ω²(κ), Ω the frequency in τ and κ the wavenumber, times D.

    The exponent matters for unequal contacts, which share the strain by it. With --precompression,
    and masses, stiffnesses and spacing in SI, also the bands in s⁻¹ and the speeds in m/s.
    """
    from lwa.command import series  # here and below: each command loads its own modules
    from lwa.linear.dispersion import Dispersion, LoadedChain

    chain = _chain(None, options)
    demand_free_names(chain)
    cell, law, loaded = chain.cell, chain.law, None
    if precompression is not None:
        cell = Cell(cell.masses, cell.stiffnesses, spacing)
        law = law if given("k") else Power(EXPONENT)
        loaded = LoadedChain(cell, law, precompression)
    _answer(style, series.dispersion(Dispersion(cell, law.exponent), order, loaded))


@lwa.command()
@of_series(k.name, "Highest power of ε = k - 1.", STYLES)
@law_option("In place of --k: power:K; no other law has an ε.")
@FORCE
@SPHERES
def expansion(
    order: int, style: str, force: sp.Expr | None, spheres: str | None, **options: Any
) -> None:
    """The lattice's wave as a series in ε = k - 1, summed where k and the cell are numbers.

    With --spheres also the wave of the peak force --force (1 N where it is not given) on the first
    contact, in m, s and N, in an endless chain without load.
    """
    from lwa.command import series
    from lwa.expansion.expand import expand
    from lwa.expansion.physical import ExpandedWave

    if force is not None and spheres is None:
        raise InputError("--force goes with --spheres: other chains have no units")
    chain = _chain(spheres, options)
    demand_free_names(chain)
    found = expand(chain.cell, order, law=chain.law)
    physical = None
    if spheres is not None and chain.cell.spacing.is_number:
        physical = ExpandedWave(found, sp.S.One if force is None else force)
    _answer(style, series.expansion(found, physical, chain.units, waves.left_out(chain)))


@lwa.command()
@click.option("--spheres", metavar="FILE", required=True, help=SPHERES_HELP)
@click.option("--velocity", callback=quantity, help="Velocity of the striker.")
@click.option("--drop", callback=quantity, help="Height from which the striker falls.")
@click.option("--mass", callback=quantity, help="Mass of the striker; a bead of the chain if not.")
@style_option(STYLES)
def strike(
    spheres: str, velocity: sp.Expr | None, drop: sp.Expr | None, mass: sp.Expr | None, style: str
) -> None:
    """The leading pulse of a chain of equal beads that a mass strikes: force, speed and width."""
    from lwa.command import series
    from lwa.expansion.strike import pulse_of_strike

    chain = _chain(spheres, {})
    mass = chain.cell.masses[0] if mass is None else mass
    pulse = pulse_of_strike(chain.cell, mass, velocity, drop=drop, k=chain.law.exponent)
    _answer(style, series.strike(pulse, chain.units, waves.left_out(chain)))


@lwa.command("envelope")
@of_cell(STYLES)
@SPHERES
@click.option("--background", callback=quantity, help="Static strain.")
@click.option("--precompression", callback=quantity, help="Static force.")
@setting("--wavenumber", "pi", "κ per cell: a number, a name, or a part of pi.", callback=angle)
@click.option("--branch", help="acoustic, optical or a number from 0; optical where there is one.")
@click.option(
    "--frequency",
    callback=quantity,
    help="Frequency f of a breather: in Hz for a file in SI, else in radians per unit of time.",
)
@click.option("--detuning", callback=quantity, help="1 - f/f0 of a breather, f0 the band's edge.")
def envelope_of_a_mode(
    style: str,
    spheres: str | None,
    background: sp.Expr | None,
    precompression: sp.Expr | None,
    wavenumber: sp.Expr,
    branch: str | None,
    frequency: sp.Expr | None,
    detuning: sp.Expr | None,
    **options: Any,
) -> None:
    """The nonlinear Schrödinger equation of a mode of a chain under load, and its breathers.

    Symbols and plain numbers have frequencies in radians per unit of time. A file in SI, of spheres
    say, has m, N and Hz.
    """
    from lwa.command import envelopes
    from lwa.envelopes.schrodinger import envelope

    if frequency is not None and detuning is not None:
        raise InputError("--frequency and --detuning are both given: one says the other")
    chain = _chain(spheres, options)
    demand_free_names(chain, background, precompression, frequency, detuning, wavenumber)
    place, cell = int(branch) if branch and branch.isdecimal() else branch, chain.cell
    precompression = _precompression(chain, background, precompression)
    load = {"background": background, "precompression": precompression}
    found = envelope(cell, chain.law, **load, wavenumber=wavenumber, branch=place)
    symbols = {*cell.symbols, *found.compression.free_symbols, *wavenumber.free_symbols}
    if not symbols - {cell.spacing} and (cell.size > 2 or not sp.cos(wavenumber).is_Rational):
        found = found.numeric()  # exact results want a frequency that is algebraic
    breather = None
    if frequency is not None or detuning is not None:
        angular = frequency and frequency * (2 * sp.pi if chain.si else 1)
        breather = found.breather(angular, detuning=detuning)
    units = envelopes.UNITS if chain.si else {}
    _answer(style, envelopes.envelope(found, breather, units, chain.text))


@lwa.command("shock")
@of_cell(STYLES)
@SPHERES
@click.option("--behind", callback=quantity, help="Strain behind the front.")
@click.option("--piston", callback=quantity, help="Velocity of the wall, in place of --behind.")
@click.option("--ahead", callback=quantity, help="Strain ahead; 0, or the load of a file.")
def front_of_a_wall(
    style: str,
    spheres: str | None,
    behind: sp.Expr | None,
    piston: sp.Expr | None,
    ahead: sp.Expr | None,
    **options: Any,
) -> None:
    """The shock, or the rarefaction, of a chain that a wall drives."""
    from lwa.command import shocks
    from lwa.shocks.riemann import piston as driven
    from lwa.shocks.riemann import shock

    if (behind is None) == (piston is None):
        raise InputError("--behind or --piston: one of the two is wanted")
    chain = _chain(spheres, options)
    demand_free_names(chain, behind, piston, ahead)
    cell, law, static = chain.cell, chain.law, chain.precompression
    if ahead is None:
        ahead = law.compression(cell, static) / cell.spacing if static else sp.S.Zero
    found = driven(cell, law, piston, ahead) if behind is None else shock(cell, law, behind, ahead)
    _answer(style, shocks.shock(found, shocks.UNITS if chain.si else {}, chain.text))


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
