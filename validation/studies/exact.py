"""Exact traveling waves of the lattice and the mass ratios of solitary waves, as reports."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from lwa.base.progress import Progress
from lwa.base.quantities import QUANTITIES
from lwa.command.options import quantities
from validation.pictures import Curve, Panel
from validation.report.command import EXPONENT, number, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.chains import numeric_cell
from validation.waves.profile import ExactWave
from validation.waves.resonances import resonances as special_ratios
from validation.waves.solver import exact_wave, measured

_SOLITARY = "solitary: nothing is left behind", "Errors: residual, tail and rounding."
_NANOPTERON = (
    "a nanopteron, not solitary:\nthe light beads rattle on both sides, with this tail",
    "Half period {:g}, one of a family. Errors: differences from the pulse of a struck chain.\n"
    "A contact's force may have several humps: a width is that of the highest hump, and jumps\n"
    "where the dip before another hump passes half of the peak.",
)
_COLUMNS = (
    Column("of", "of"),
    Column("amplitude", "amplitude", error=True),
    Column("fwhm", "FWHM", "D", error=True),
    Column("rms", "rms width", "D", error=True),
)
_SCALING = """\
Strain and force of a contact, velocity of a bead m1. Strains scale with the peak force F as
F^(1/k), velocities as F^((k+1)/2k), c as F^((k-1)/2k); widths do not depend on F."""


@study(
    EXPONENT,
    option("--masses", callback=quantities, default="1", says="Mass of all beads, or two in turn."),
    option("--speed", callback=number, says="Speed dx/dt of the wave, at A = D = 1."),
    option("--force", callback=number, says="Peak contact force, at A = 1; by default 1."),
    option("--background", default=0.0, says="Static compression divided by the peak; 0: no load."),
)
def exact(
    k: float,
    masses: tuple[sp.Expr, ...],
    speed: float | None = None,
    force: float | None = None,
    background: float = 0.0,
    progress: Progress[Any] = iter,
) -> Report:
    """Exact traveling wave of the lattice: speed, widths and tail.

    Takes a second or two, for unequal masses from k = 4 on up to half a minute.
    """
    values = [float(mass) for mass in numeric_cell(masses).masses]
    wave = exact_wave(values, k, background=background, progress=progress)
    return wave_report(wave if speed is force is None else wave.scaled(speed=speed, force=force))


def wave_report(wave: ExactWave) -> Report:
    """Return the report of a wave. Keys of the JSON document:

    ``k_value``, ``masses_value``, ``background_value``, ``half_period_value``, ``residual_value``,
    ``solitary``; with errors, as ``c2_error_value``: ``c2_value``, ``c_value``, ``tail_value`` and
    by quantity ``amplitude_value``, ``fwhm_value``, ``rms_value``.
    """
    numbers = measured(wave)
    kind, errors = _SOLITARY if wave.solitary else _NANOPTERON
    tail = f"{wave.tail:.2e}" if wave.solitary else numbers["tail"]
    rows = tuple((q, *(numbers[f"{c.key} {q}"] for c in _COLUMNS[1:])) for q in QUANTITIES)
    # One row of all numbers; "fwhm force" becomes an entry of fwhm_value.
    columns = tuple(Column(name.replace(" ", "."), error=True) for name in numbers)
    (values,) = Table(columns, (tuple(numbers.values()),)).document()
    load = f"; background strain {wave.background:g}: strains and forces are above it"
    return Report(
        f"masses {wave.masses[0]:g}, {wave.masses[1]:g}; k = {wave.k:g}; A = D = 1"
        f"{load if wave.background else ''}\nc² = {numbers['c2']}, c = {numbers['c']}\n"
        f"tail {tail} of the peak strain, residual {wave.residual:.1e}: {kind}",
        (Table(_COLUMNS, rows, note=f"{_SCALING}\n{errors.format(wave.half_period)}"),),
        panels=tuple(wave.pictured()),
        data={
            "k_value": wave.k,
            "masses_value": wave.masses,
            "background_value": wave.background,
            "half_period_value": wave.half_period,
            "residual_value": wave.residual,
            "solitary": wave.solitary,
            **values,
        },
    )


_RATIOS = (
    Column("mass_ratio", "m2/m1", format=".9f"),
    Column("c2_value", "c² at peak force 1", format=".9f"),
    Column("tail_value", "tail", format=".0e"),
    Column("residual_value", "residual", format=".0e"),
)


@study(EXPONENT, option("--count", default=3, says="Number of mass ratios, from the largest down."))
def resonances(k: float, count: int) -> Report:
    """Mass ratios m2/m1 < 1 of the dimers with a solitary wave.

    ``k_value`` and, in falling order, ``mass_ratios``, ``c2_value``, ``tail_value``,
    ``residual_value``.
    """
    waves, xi = special_ratios(k, count), np.linspace(-5, 5, 1001)
    rows = tuple((wave.omega, wave.c2, wave.tail, wave.residual) for wave in waves)
    curves = (Curve(f"m2/m1 = {w.omega:.4f}", xi, w.force(xi), "-") for w in waves)
    names = "mass_ratios", "c2_value", "tail_value", "residual_value"
    return Report(
        f"k = {k:g}: dimers with a solitary wave",
        (Table(_RATIOS, rows),),
        panels=(Panel("ξ / D", "force of a contact", tuple(curves)),),
        data={"k_value": k} | dict(zip(names, zip(*rows, strict=True), strict=True)),
    )
