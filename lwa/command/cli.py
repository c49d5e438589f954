"""The command `lwa`: derivations, waves and dispersion relations on the command line."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError, exact
from lwa.base.progress import announce
from lwa.cell import Cell, D, k
from lwa.code.languages import LANGUAGES
from lwa.command.document import (
    SI,
    dispersion_json,
    expansion_json,
    force_json,
    theory_json,
    wave_json,
)
from lwa.command.load import (
    background_json,
    background_text,
    loaded_json,
    loaded_text,
    precompressed_json,
    precompressed_text,
)
from lwa.command.options import (
    FORCE,
    SPHERES,
    demand_free_names,
    given,
    law_option,
    of_chain,
    of_series,
    setting,
)
from lwa.command.reserved_names import demand_free
from lwa.command.source import theory_latex, theory_python, wave_latex
from lwa.command.terminal import (
    HELP,
    quantity,
    run,
    version,
)
from lwa.command.text import dispersion_text, expansion_text, force_text, theory_text, wave_text
from lwa.expansion.expand import expand
from lwa.expansion.physical import ExpandedWave
from lwa.law import ContactLaw, Law, Power
from lwa.linear.dispersion import Dispersion
from lwa.linear.loaded import LoadedChain
from lwa.spheres.hertz import EXPONENT
from lwa.theory import Theory, homogenize
from lwa.wave.background import BackgroundWave
from lwa.wave.precompressed import PrecompressedWave

THEORY = {
    "text": theory_text,
    "json": theory_json,
    "latex": theory_latex,
    "python": theory_python,
}
WAVE = {"text": wave_text, "json": wave_json, "latex": wave_latex} | {
    language: lambda _, wave, language=language: wave.code(language) for language in LANGUAGES
}
FORCED = {"text": force_text, "json": force_json}
BACKGROUND = {"text": background_text, "json": background_json}
PRECOMPRESSED = {"text": precompressed_text, "json": precompressed_json}
LOADED = {"text": loaded_text, "json": loaded_json}
DISPERSION = {"text": dispersion_text, "json": dispersion_json}
EXPANSION = {"text": expansion_text, "json": expansion_json}


def _theory(
    output: str,
    *,
    k: sp.Expr,
    masses: tuple[sp.Expr, ...],
    stiffnesses: tuple[sp.Expr, ...],
    spacing: sp.Expr,
    order: int,
    law: ContactLaw | None,
    **kind: Any,
) -> Theory:
    cell = Cell(masses, stiffnesses, spacing)
    demand_free_names(cell, k, *(law.symbols if law else ()), output=output)
    return homogenize(cell, order, k=k, law=law, **kind)


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


@click.group(context_settings=HELP)
@version
def lwa() -> None:
    """Long-wave theory of granular chains with contact force F = A δ^k.

    Numbers are integers, decimals or fractions (3/2); symbols are plain names.
    """


@lwa.command()
@of_chain(THEORY)
def derive(style: str, **chain: Any) -> None:
    """The ansatz, the wave equation and the defect between the equations of motion."""
    theory = _theory("derive", **chain)
    _write_out(theory)
    _show(THEORY[style](theory))


@lwa.command()
@of_chain(WAVE)
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
    if spheres is not None:
        chain |= _of_spheres(spheres)
    units = {} if spheres is None else SI
    loaded = _under_load(background, precompression, chain["law"])
    output = "wave under load" if loaded or isinstance(chain["law"], Law) else "wave"
    for load, own in ((force, "F"), (precompression, "F0"), (background, "p0")):
        demand_free(output, () if load is None else (load,), own)
    if loaded:
        _wave_under_load(style, force, background, precompression, units, chain)
        return
    theory = _theory(output, **chain)
    found = theory.pde.traveling_wave()
    if style in FORCED and (force is not None or spheres is not None):
        peak = exact("F", "force") if force is None else force
        _show(FORCED[style](theory, found, peak, units))
    elif force is not None:
        raise InputError(
            f"--format {style} is for any force: --force goes with {', '.join(FORCED)}"
        )
    else:
        _show(WAVE[style](theory, found))


def _under_load(
    background: sp.Expr | None, precompression: sp.Expr | None, law: ContactLaw | None
) -> bool:
    """Whether a load is given, or a law under which there are no other waves."""
    if background is not None and precompression is not None:
        raise InputError("--background and --precompression are both given: one says the other")
    load = precompression if background is None else background
    return load is not None and (not load.is_zero or isinstance(law, Law))


def _wave_under_load(
    style: str,
    force: sp.Expr | None,
    background: sp.Expr | None,
    precompression: sp.Expr | None,
    units: Mapping[str, str],
    chain: dict[str, Any],
) -> None:
    if style not in FORCED:
        raise InputError(f"--format {style} has no wave under load: {', '.join(FORCED)} have")
    for name, wanted in (("closure", "full"), ("field", "center"), ("branch", "acoustic")):
        if given(name) and chain[name] != wanted:
            raise InputError(
                f"{name} is {chain[name]!r}: under load the wave is that of the canonical field, "
                f"{name} {wanted!r}"
            )
        chain[name] = wanted
    theory = _theory("wave under load", **chain)
    if precompression is not None:
        peak = exact("F", "force") if force is None else force
        loaded = PrecompressedWave(theory.cell, theory.law, peak, precompression)
        _show(PRECOMPRESSED[style](theory, loaded, units))
    elif force is not None:
        raise InputError("--force goes with --precompression, a force; --background is a strain")
    else:
        assert background is not None
        _show(BACKGROUND[style](theory, BackgroundWave(theory.cell, theory.law, background)))


def _of_spheres(file: str) -> dict[str, Any]:
    """The chain of a file of spheres, which no other option may describe."""
    from lwa.spheres.beads import (
        read_spheres,  # here, so that other commands do not load the parsers
    )

    for name in ("k", "law", "masses", "stiffnesses", "spacing"):
        if given(name):
            raise InputError(f"--{name} and --spheres are both given: spheres have their own")
    cell = Cell.of_spheres(read_spheres(file))
    parts = {name: getattr(cell, name) for name in ("masses", "stiffnesses", "spacing")}
    return {"k": EXPONENT, **parts}


@lwa.command()
@of_series("1", "Highest power of κ in Ω².", DISPERSION)
@click.option(
    "--precompression",
    callback=quantity,
    help="Static load: bands in s⁻¹ of the chain about it; k is 3/2 unless it is given.",
)
@setting("--spacing", D.name, "Distance of neighbouring particles.", callback=quantity)
def dispersion(
    cell: Cell,
    k: sp.Expr,
    order: int,
    style: str,
    precompression: sp.Expr | None,
    spacing: sp.Expr,
) -> None:
    """The linear chain: the series of Ω²(κ), Ω the frequency in τ and κ the wavenumber, times D.

    The exponent matters for unequal contacts, which share the strain by it. With --precompression,
    and masses, stiffnesses and spacing in SI, also the bands in s⁻¹ and the speeds in m/s.
    """
    if precompression is None:
        _show(DISPERSION[style](Dispersion(cell, k), order))
        return
    cell = Cell(cell.masses, cell.stiffnesses, spacing)
    k = k if given("k") else EXPONENT
    loaded = LoadedChain(cell, Power(k), precompression)
    _show(LOADED[style](Dispersion(cell, k), loaded, order))


@lwa.command()
@of_series(k.name, "Highest power of ε = k - 1.", EXPANSION)
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

    With --spheres, in m, s, kg and N; with --force also the wave of that peak force on the first
    contact, in space and time.
    """
    if spheres is not None:
        chain = _of_spheres(spheres)
        k = chain.pop("k")
        cell = Cell(**chain)
    elif force is not None:
        raise InputError("--force goes with --spheres: other chains have no units")
    found = expand(cell, order, k=k, law=law)
    _show(EXPANSION[style](found, None if force is None else ExpandedWave(found, force)))


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa`."""
    run(lwa, "lwa", arguments)
