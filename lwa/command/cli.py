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
from lwa.law import ContactLaw, Power
from lwa.spheres.hertz import EXPONENT
from lwa.theory import Theory, homogenize

STYLES = ("text", "json", "latex")


def _theory(output: str, *, k: sp.Expr, law: ContactLaw | None, **chain: Any) -> Theory:
    cell = _cell(chain)
    demand_free_names(cell, k, *(law.symbols if law else ()), output=output)
    return homogenize(cell, k=k, law=law, **chain)


def _cell(chain: dict[str, Any]) -> Cell:
    """Take the options of a cell out of those of a chain."""
    return Cell(*(chain.pop(name) for name in ("masses", "stiffnesses", "spacing")))


def _chain(
    spheres: str | None, options: dict[str, Any], symbols: Sequence[sp.Expr | None]
) -> tuple[Cell, ContactLaw, sp.Expr, bool, str]:
    """Read a chain: cell, law, static load, whether it is in SI, and the chain in text.

    symbols : values of the other options; symbols in them must not have names of the output.
    """
    units, static = _from_file(spheres, options) if spheres is not None else ({}, sp.S.Zero)
    cell, law = _cell(options), options["law"] or Power(options["k"])
    demand_free_names(cell, *law.symbols, *(x for x in symbols if x is not None))
    said = f"masses {derivation.listed(cell.masses)}; contact force A F, F = {law.F}"
    return cell, law, static, bool(units), said


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
def derive(style: str, **chain: Any) -> None:
    """The ansatz, the wave equation and the defect between the equations of motion."""
    theory = _theory("derive", **chain)
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
    **chain: Any,
) -> None:
    """The compact traveling wave: β, width, FWHM, amplitude and speed.

    With --force, a number or a name, the wave of that peak contact force, in space and time; with
    --spheres all of it in m, s, kg and N. With --background or --precompression the wave of the
    canonical field in a chain under load.
    """
    units: dict[str, str] = {}
    if spheres is not None:
        units, static = _from_file(spheres, chain)
        if static and (background is not None or precompression is not None):
            raise InputError(f"the file has a precompression of {static}: give no other load")
        precompression = static or precompression
    load = waves.Load(force, background, precompression)
    law = chain["law"]
    other = law is not None and not law.homogeneous
    under_load = load.under(other)
    output = "wave under load" if under_load or other else "wave"
    load.demand_free(output)
    if under_load:
        _canonical(chain)
    theory = _theory(output, **chain)
    if style in LANGUAGES:
        if force is not None:
            raise InputError(f"--format {style} is for any force: --force goes with {_STYLES}")
        click.echo(waves.source(theory, load if under_load else None, style))
    elif under_load:
        _answer(style, waves.under_load(theory, load, units))
    else:
        found = theory.pde.traveling_wave()
        if force is None and spheres is None:
            _answer(style, waves.compact(theory, found))
        else:
            _answer(style, waves.at_force(theory, found, waves.peak(force), units))


_STYLES = ", ".join(STYLES)


def _canonical(chain: dict[str, Any]) -> None:
    """Set the closure of waves under load; refuse another one."""
    for name, wanted in (("closure", "full"), ("field", "center"), ("branch", "acoustic")):
        if given(name) and chain[name] != wanted:
            raise InputError(
                f"{name} is {chain[name]!r}: under load the wave is that of the canonical field, "
                f"{name} {wanted!r}"
            )
        chain[name] = wanted


def _from_file(file: str, chain: dict[str, Any]) -> tuple[dict[str, str], sp.Expr]:
    """Put the chain of a file in place of the options; return its units and its static load.

    Raises `lwa.InputError` where an option describes a chain too.
    """
    for name in ("k", "law", "masses", "stiffnesses", "spacing"):
        if given(name):
            raise InputError(f"--{name} and --spheres are both given: spheres have their own")
    from lwa.command.chain_file import read_chain

    found = read_chain(file)
    chain |= {name: getattr(found.cell, name) for name in ("masses", "stiffnesses", "spacing")}
    chain |= {"k": found.law.exponent} if found.law.homogeneous else {"law": found.law}
    exponent = found.law.exponent if found.law.homogeneous else EXPONENT
    return (waves.si_units(exponent) if found.si else {}), found.precompression


@lwa.command()
@of_series("1", "Highest power of κ in Ω².", STYLES)
@click.option(
    "--precompression",
    callback=quantity,
    help="Static load: bands in s⁻¹ of the chain about it; k is 3/2 unless it is given.",
)
@setting("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity)
def dispersion(
    cell: Cell, k: sp.Expr, order: int, style: str, precompression: sp.Expr | None, spacing: sp.Expr
) -> None:
    """The linear chain: the series of Ω²(κ), Ω the frequency in τ and κ the wavenumber, times D.

    The exponent matters for unequal contacts, which share the strain by it. With --precompression,
    and masses, stiffnesses and spacing in SI, also the bands in s⁻¹ and the speeds in m/s.
    """
    from lwa.command import series  # here and below: each command loads what it needs
    from lwa.linear.dispersion import Dispersion, LoadedChain

    loaded = None
    if precompression is not None:
        cell = Cell(cell.masses, cell.stiffnesses, spacing)
        k = k if given("k") else EXPONENT
        loaded = LoadedChain(cell, Power(k), precompression)
    _answer(style, series.dispersion(Dispersion(cell, k), order, loaded))


@lwa.command()
@of_series(k.name, "Highest power of ε = k - 1.", STYLES)
@law_option("In place of --k: power:K; no other law has an ε.")
@FORCE
@SPHERES
def expansion(
    cell: Cell,
    k: sp.Expr,
    law: ContactLaw | None,
    order: int,
    style: str,
    force: sp.Expr | None,
    spheres: str | None,
) -> None:
    """The lattice's wave as a series in ε = k - 1, summed where k and the cell are numbers.

    With --spheres also the wave of the peak force --force (1 N where it is not given) on the first
    contact, in m, s and N, in an endless chain without load.
    """
    from lwa.command import series
    from lwa.expansion.expand import expand
    from lwa.expansion.physical import ExpandedWave

    units: dict[str, str] = {}
    notes: list[str] = []
    if spheres is not None:
        chain: dict[str, Any] = {"k": k, "law": law}
        units, static = _from_file(spheres, chain)
        k, law = chain.pop("k"), chain.pop("law")
        cell = Cell(**chain)
        force = sp.S.One if force is None else force
        notes = waves.left_out(static, units)
    elif force is not None:
        raise InputError("--force goes with --spheres: other chains have no units")
    found = expand(cell, order, k=k, law=law)
    physical = None
    if force is not None and cell.spacing.is_number:
        physical = ExpandedWave(found, force)
    _answer(style, series.expansion(found, physical, units, notes))


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
    from lwa.command.chain_file import read_chain
    from lwa.expansion.strike import pulse_of_strike

    found = read_chain(spheres)
    mass = found.cell.masses[0] if mass is None else mass
    pulse = pulse_of_strike(found.cell, mass, velocity, drop=drop, k=found.law.exponent)
    units = waves.si_units(found.law.exponent) if found.si else {}
    _answer(style, series.strike(pulse, units, waves.left_out(found.precompression, units)))


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
    **chain: Any,
) -> None:
    """The nonlinear Schrödinger equation of a mode of a chain under load, and its breathers.

    Symbols and plain numbers have frequencies in radians per unit of time. A file in SI, of spheres
    say, has m, N and Hz.
    """
    from lwa.command import envelopes
    from lwa.envelopes.schrodinger import envelope

    if frequency is not None and detuning is not None:
        raise InputError("--frequency and --detuning are both given: one says the other")
    values = (background, precompression, frequency, detuning, wavenumber)
    cell, law, static, si, said = _chain(spheres, chain, values)
    place = int(branch) if branch and branch.isdecimal() else branch
    if static and (background is not None or precompression is not None):
        raise InputError(f"the file has a precompression of {static}: give no other load")
    load = {"background": background, "precompression": static or precompression}
    found = envelope(cell, law, **load, wavenumber=wavenumber, branch=place)
    symbols = {*cell.symbols, *found.compression.free_symbols, *wavenumber.free_symbols}
    if not symbols - {cell.spacing} and (cell.size > 2 or not sp.cos(wavenumber).is_Rational):
        found = found.numeric()  # exact results want a frequency that is algebraic
    breather = None
    if frequency is not None or detuning is not None:
        angular = frequency and frequency * (2 * sp.pi if si else 1)
        breather = found.breather(angular, detuning=detuning)
    _answer(style, envelopes.envelope(found, breather, envelopes.UNITS if si else {}, said))


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
    **chain: Any,
) -> None:
    """The shock, or the rarefaction, of a chain that a wall drives."""
    from lwa.command import shocks
    from lwa.shocks.riemann import piston as driven
    from lwa.shocks.riemann import shock

    if (behind is None) == (piston is None):
        raise InputError("--behind or --piston: one of the two is wanted")
    cell, law, static, si, said = _chain(spheres, chain, (behind, piston, ahead))
    if ahead is None:
        ahead = law.compression(cell, static) / cell.spacing if static else sp.S.Zero
    found = driven(cell, law, piston, ahead) if behind is None else shock(cell, law, behind, ahead)
    _answer(style, shocks.shock(found, shocks.UNITS if si else {}, said))


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
