"""Exact solitary waves of the lattice and the mass ratios of dimers with one, as reports."""

from __future__ import annotations

import numpy as np
import sympy as sp

from lwa.base.frozen import QUANTITIES
from lwa.command.options import quantities
from validation.pictures import Curve, Panel
from validation.report.command import EXPONENT, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.waves.solver import exact_wave, measured
from validation.waves.solver import resonances as special_ratios

_COLUMNS = (
    Column("of", "of"),
    Column("amplitude", "amplitude", error=True),
    Column("fwhm", "FWHM", "D", error=True),
)
_NOTE = """\
Strain and force of a contact, velocity of a bead m1. Strains scale with the peak force F as
F^(1/k), velocities as F^((k+1)/2k), c as F^((k-1)/2k); widths do not depend on F.
Errors: residual, tail and rounding."""


@study(
    EXPONENT,
    option(
        "--masses",
        callback=quantities,
        default="1",
        says="Mass of all beads, or two in turn.",
    ),
)
def exact(k: float, masses: tuple[sp.Expr, ...]) -> Report:
    """Exact solitary wave of the lattice: speed, widths and amplitudes.

    The peak contact force is 1. Two masses have a solitary wave at special ratios only
    (`resonances`).

    ``k_value``, ``masses_value``, ``half_period_value``, ``residual_value``, ``solitary``;
    with errors, as ``c2_error_value``: ``c2_value``, ``c_value``, ``tail_value`` and by quantity
    ``amplitude_value``, ``fwhm_value``.
    """
    wave = exact_wave(masses, k)
    numbers = measured(wave)
    rows = tuple(
        (q, numbers[f"amplitude {q}"], numbers[f"fwhm {q}"]) for q in QUANTITIES
    )
    # One row of all numbers; "fwhm force" becomes an entry of fwhm_value.
    columns = tuple(Column(name.replace(" ", "."), error=True) for name in numbers)
    (values,) = Table(columns, (tuple(numbers.values()),)).document()
    return Report(
        f"masses {wave.masses[0]:.6g}, {wave.masses[1]:.6g}; k = {wave.k:g}; A = D = 1\n"
        f"c² = {numbers['c2']}, c = {numbers['c']}\n"
        f"solitary: tail {wave.tail:.0e} of the peak strain, residual {wave.residual:.0e}",
        (Table(_COLUMNS, rows, note=_NOTE),),
        panels=tuple(wave.pictured()),
        data={
            "k_value": wave.k,
            "masses_value": wave.masses,
            "half_period_value": wave.half_period,
            "residual_value": wave.residual,
            "solitary": wave.solitary,
            **values,
        },
    )


_RATIOS = (
    Column("mass_ratios", "m2/m1", format=".6g"),
    Column("c2_value", "c² at peak force 1", format=".6g"),
    Column("tail_value", "tail", format=".0e"),
    Column("residual_value", "residual", format=".0e"),
)


@study(
    EXPONENT,
    option("--count", default=3, says="Number of mass ratios, from the largest down."),
)
def resonances(k: float, count: int) -> Report:
    """Mass ratios m2/m1 < 1 of the dimers with a solitary wave.

    ``k_value`` and, in falling order, ``mass_ratios``, ``c2_value``, ``tail_value``,
    ``residual_value``.
    """
    waves, xi = special_ratios(k, count), np.linspace(-5, 5, 1001)
    rows = tuple((wave.omega, wave.c2, wave.tail, wave.residual) for wave in waves)
    curves = (Curve(f"m2/m1 = {w.omega:.4f}", xi, w.force(xi), "-") for w in waves)
    return Report(
        f"k = {waves[0].k:g}: dimers with a solitary wave",
        (Table(_RATIOS, rows),),
        panels=(Panel("ξ / D", "force of a contact", tuple(curves)),),
        data={"k_value": waves[0].k}
        | {
            c.key: values
            for c, values in zip(_RATIOS, zip(*rows, strict=True), strict=True)
        },
    )
