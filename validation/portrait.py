"""Exact waves and special mass ratios as tables, as documents for JSON, and as pictures.

Importing this module teaches `validation.report` and `validation.plots` what they are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lwa.quantities import QUANTITIES
from validation.plots import figure
from validation.profile import ExactWave
from validation.report import document, table, text
from validation.resonances import Resonances

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
    widths = table(
        ("of", "amplitude", "FWHM (D)", "rms width (D)"),
        [
            (
                q,
                f"{wave.peak(q)[1]:.9g}",
                f"{wave.fwhm(q):.9g}",
                f"{wave.rms_width(q):.9g}",
            )
            for q in QUANTITIES
        ],
    )
    return "\n".join(
        (
            f"masses {wave.masses[0]:g}, {wave.masses[1]:g}; k = {wave.k:g}; A = D = 1",
            f"c² = {wave.c2:.12g}, c = {wave.c:.12g}",
            f"tail {wave.tail:.2e} of the peak strain, residual {wave.residual:.1e}: {kind}",
            "",
            widths,
            "Strain and force are those of a contact, the velocity is that of a bead m1. At "
            "another peak force F\nstrains go as F^(1/k), velocities as F^((k+1)/2k), "
            "c as F^((k-1)/2k); widths stay.\n"
            + (
                "Relative errors are of the size of the residual."
                if wave.solitary
                else f"One of a family: all depends on its half period, {wave.half_period:g}."
            ),
        )
    )


@document.register(ExactWave)
def _(wave: ExactWave) -> dict[str, Any]:
    return {
        "k_value": wave.k,
        "masses_value": list(wave.masses),
        "c2_value": wave.c2,
        "c_value": wave.c,
        "half_period_value": wave.half_period,
        "amplitude_value": {q: wave.peak(q)[1] for q in QUANTITIES},
        "fwhm_value": {q: wave.fwhm(q) for q in QUANTITIES},
        "rms_value": {q: wave.rms_width(q) for q in QUANTITIES},
        "tail_value": wave.tail,
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
