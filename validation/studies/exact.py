"""Exact solitary waves of the lattice and the mass ratios of dimers with one, as reports."""

from __future__ import annotations

import sympy as sp

from lwa.base.words import QUANTITIES
from lwa.command.options import quantities
from validation.report.study import EXPONENT, Report, option, study
from validation.report.table import Column, Estimates, Table
from validation.waves.solver import exact_wave, resonances as special_ratios

_COLUMNS = (
    Column("of", "of"),
    Estimates("amplitude", "amplitude"),
    Estimates("fwhm", "FWHM (D)"),
)
_NOTE = """\
Strain and force of a contact, velocity of a bead m1. Strains scale with the peak force F as
F^(1/k), velocities as F^((k+1)/2k), c as F^((k-1)/2k); widths do not depend on F."""

_ERRORS = "residual, tail and rounding"


@study(
    EXPONENT,
    option(
        "--masses", "Mass of all beads, or two in turn.", read=quantities, default="1"
    ),
    page="exact",
    examples=(
        "lwa-validate exact --k 5/2",
        "lwa-validate exact --masses 1,0.3428457811 --plot wave.svg",
    ),
)
def exact(k: float, masses: tuple[sp.Expr, ...]) -> Report:
    """Exact solitary wave of the lattice: speed, widths and amplitudes.

    The peak contact force is 1. Two masses have a solitary wave at special ratios only
    (`resonances`).

    ``k_value``, ``masses_value``, ``half_period_value``, ``residual_value``, ``solitary``;
    with errors, as ``c2_error_value``: ``c2_value``, ``c_value``, ``tail_value`` and by quantity
    ``amplitude_value``, ``fwhm_value``; ``rows``, the printed table.
    """
    wave = exact_wave(masses, k)
    # The numbers of the wave as a whole, then those of the rows again, by quantity.
    data = {
        "k_value": wave.k,
        "masses_value": wave.masses,
        "half_period_value": wave.half_period,
        "residual_value": wave.residual,
        "solitary": wave.solitary,
        "c2": wave.estimate("c2"),
        "c": wave.estimate("c"),
        "tail": wave.estimate("tail"),
    }
    rows = []
    for quantity in QUANTITIES:
        amplitude = wave.estimate("peak", quantity)
        fwhm = wave.estimate("fwhm", quantity)
        rows.append({"of": quantity, "amplitude": amplitude, "fwhm": fwhm})
        data |= {f"amplitude.{quantity}": amplitude, f"fwhm.{quantity}": fwhm}
    table = Table(_COLUMNS, rows, "rows", note=_NOTE, errors=_ERRORS)
    # The wave's own masses: a ratio that was given in seven digits is a special one.
    return Report(
        f"masses {wave.masses[0]:.6g}, {wave.masses[1]:.6g}; k = {wave.k:g}; A = D = 1\n"
        f"c² = {data['c2']}, c = {data['c']}\n"
        f"solitary: tail {wave.tail:.0e} of the peak strain, residual {wave.residual:.0e}",
        (table,),
        panels=wave.pictured(),
        data=data,
    )


_RATIOS = (
    # Seven digits of a ratio are wanted by `exact`: JSON has them.
    Column("mass_ratio_value", "m2/m1", format=".6g"),
    # Tail and residual tell how exact a row is; six digits are far from rounding.
    Column("c2_value", "c² at peak force 1", format=".6g"),
    Column("tail_value", "tail", format=".0e"),
    Column("residual_value", "residual", format=".0e"),
)


@study(
    EXPONENT,
    # Two are published (Jayaprakash et al. 2011); the third shows how the row goes on.
    option("--count", "Number of mass ratios, from the largest down.", default=3),
    page="exact",
    examples=("lwa-validate resonances --count 1",),
)
def resonances(k: float, count: int) -> Report:
    """Mass ratios m2/m1 < 1 of the dimers with a solitary wave.

    ``k_value``; ``mass_ratios`` in falling order; ``rows``, the printed table:
    ``mass_ratio_value``, ``c2_value``, ``tail_value``, ``residual_value``.
    """
    waves = special_ratios(k, count)
    rows = []
    for wave in waves:
        rows.append(
            {
                "mass_ratio_value": wave.omega,
                "c2_value": wave.c2,
                "tail_value": wave.tail,
                "residual_value": wave.residual,
            }
        )
    return Report(
        f"k = {waves[0].k:g}: dimers with a solitary wave",
        (Table(_RATIOS, rows, "rows"),),
        data={
            "k_value": waves[0].k,
            "mass_ratios": [wave.omega for wave in waves],
        },
    )
