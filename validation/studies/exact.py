"""Exact waves and special mass ratios as tables, as documents for JSON, and as pictures.

Importing this module teaches `validation.report.text` and `validation.report.figure` what they are.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
import sympy as sp

from lwa.command.terminal import quantities
from lwa.exact import InputError
from lwa.quantities import QUANTITIES
from validation.report.command import EXPONENT, number, output, show, wanted
from validation.report.figure import figure
from validation.report.text import document, table, text
from validation.waves.profile import ExactWave
from validation.waves.resonances import Resonances, resonances
from validation.waves.solver import exact_wave, measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["ExactWave", "Resonances"]


@text.register(ExactWave)
def _(wave: ExactWave) -> str:
    kind = (
        "solitary: nothing is left behind"
        if wave.solitary
        else "a nanopteron, not solitary:\nthe light beads rattle on both sides, with this tail"
    )
    found = measured(wave)
    widths = table(
        ("of", "amplitude", "FWHM (D)", "rms width (D)"),
        [(q, *(str(found[f"{what} {q}"]) for what in ("amplitude", "fwhm", "rms")))
         for q in QUANTITIES],
    )  # fmt: skip
    tail = f"{wave.tail:.2e}" if wave.solitary else str(found["tail"])
    return "\n".join(
        (
            f"masses {wave.masses[0]:g}, {wave.masses[1]:g}; k = {wave.k:g}; A = D = 1",
            f"c² = {found['c2']}, c = {found['c']}",
            f"tail {tail} of the peak strain, residual {wave.residual:.1e}: {kind}",
            "",
            widths,
            "Strain and force are those of a contact, the velocity is that of a bead m1. At "
            "another peak force F\nstrains go as F^(1/k), velocities as F^((k+1)/2k), "
            "c as F^((k-1)/2k); widths stay.\n"
            + (
                "Errors are those of residual, tail and rounding."
                if wave.solitary
                else f"One of a family, of half period {wave.half_period:g}: errors are the "
                "differences from the pulse of a struck chain."
            ),
        )
    )


@document.register(ExactWave)
def _(wave: ExactWave) -> dict[str, Any]:
    found = measured(wave)

    def each(what: str) -> dict[str, Any]:
        parts = {q: found[f"{what} {q}"] for q in QUANTITIES}
        return {
            f"{what}_value": {q: part.value for q, part in parts.items()},
            f"{what}_error_value": {q: part.error for q, part in parts.items()},
        }

    return {
        "k_value": wave.k,
        "masses_value": list(wave.masses),
        "c2_value": wave.c2,
        "c2_error_value": found["c2"].error,
        "c_value": wave.c,
        "c_error_value": found["c"].error,
        "half_period_value": wave.half_period,
        **each("amplitude"),
        **each("fwhm"),
        **each("rms"),
        "tail_value": wave.tail,
        "tail_error_value": found["tail"].error,
        "residual_value": wave.residual,
        "solitary": wave.solitary,
    }


@figure.register(ExactWave)
def _(wave: ExactWave) -> Figure:
    from matplotlib.figure import Figure

    picture = Figure(figsize=(7, 4.5), layout="constrained")
    axes = picture.subplots()
    xi = np.linspace(-wave.half_period, wave.half_period, 2001)
    for i, name in enumerate(QUANTITIES):
        value = wave.quantity(name, xi)
        axes.plot(xi, value / np.abs(value).max(), ("-", "--", ":")[i], label=name)
    axes.set(xlabel="ξ / D", ylabel="over its peak")
    axes.legend()
    return picture


@text.register(Resonances)
def _(result: Resonances) -> str:
    rows = [
        (f"{w.omega:.9f}", f"{w.c2:.9f}", f"{w.tail:.0e}", f"{w.residual:.0e}")
        for w in result.waves
    ]
    header = ("m2/m1", "c² at peak force 1", "tail", "residual")
    return f"k = {result.k:g}: dimers with a solitary wave\n{table(header, rows)}"


@document.register(Resonances)
def _(result: Resonances) -> dict[str, Any]:
    return {
        "k_value": result.k,
        "mass_ratios": list(result.mass_ratios),
        "c2_value": [wave.c2 for wave in result.waves],
        "tail_value": [wave.tail for wave in result.waves],
        "residual_value": [wave.residual for wave in result.waves],
    }


@figure.register(Resonances)
def _(result: Resonances) -> Figure:
    from matplotlib.figure import Figure

    picture = Figure(figsize=(7, 4.5), layout="constrained")
    axes = picture.subplots()
    xi = np.linspace(-5, 5, 1001)
    for wave in result.waves:
        axes.plot(xi, wave.force(xi), label=f"m2/m1 = {wave.omega:.4f}")
    axes.set(xlabel="ξ / D", ylabel="force of a contact")
    axes.legend()
    return picture


@click.command("exact")
@EXPONENT
@click.option(
    "--masses", callback=quantities, default="1", show_default=True,
    help="One mass, or the two of a dimer.",
)  # fmt: skip
@click.option("--speed", callback=wanted, help="Scale the wave to this speed, at D = 1.")
@click.option(
    "--force", callback=wanted, help="Scale the wave to this peak force, at A = 1; by default 1."
)
@output
def exact_command(
    k: sp.Expr,
    masses: tuple[sp.Expr, ...],
    speed: sp.Expr | None,
    force: sp.Expr | None,
    style: str,
    picture: Path | None,
) -> None:
    """An exact traveling wave of the lattice: speed, widths, and the tail if it has one."""
    if speed is not None and force is not None:
        raise InputError("speed and force: a wave is scaled to one of the two")
    wave: ExactWave = exact_wave([number(m, "mass") for m in masses], number(k, "k"))
    if speed is not None:
        wave = wave.scaled(speed=number(speed, "speed"))
    if force is not None:
        wave = wave.scaled(force=number(force, "force"))
    show(wave, style, picture)


@click.command("resonances")
@EXPONENT
@click.option("--count", type=int, default=3, show_default=True, help="How many, from above.")
@output
def resonances_command(k: sp.Expr, count: int, style: str, picture: Path | None) -> None:
    """The mass ratios m2/m1 < 1 at which a dimer has a solitary wave."""
    found: Resonances = resonances(number(k, "k"), count)
    show(found, style, picture)
