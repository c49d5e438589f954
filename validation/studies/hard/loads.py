"""A hard case under load: waves on a background, p0/B over 24 decades, in float64 and 50 digits.

Of `lwa.BackgroundWave` come exact expressions of V², which mpmath evaluates at `DIGITS` digits, and
widths to 50 digits; `lwa.NumericBackground` gives both in float64. Beside V² stands Nesterenko's
relation for Hertz contacts as it is printed, with its differences, ζ = 1 + B/p0:

    V²/c0² = (4/15) (3 + 2 ζ^{5/2} - 5 ζ) / (ζ - 1)².
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from lwa import Cell, Power, background_wave
from lwa.wave.background import BackgroundWave
from validation.report.panel import Curve, Panel
from validation.report.table import Finding
from validation.studies.hard.case import Parts, case
from validation.studies.hard.floats import DIGITS, PRINTED, in_ulps

RATIOS = 10.0 ** np.arange(-12, 12.5, 0.5)
"""p0/B."""

WIDTHS = RATIOS[::12]
"""Where widths are compared, which take longer to 50 digits."""

B = 0.7  # the rise; no power of 2
ALLOWED, NEAR = 4.0, 1e-12  # ulps of V²; of a width, relatively


def squared(wave: BackgroundWave, p0: float) -> Any:
    """V² at these floats themselves, in mpmath's working precision."""
    value = wave.on(sp.Rational(p0)).stiffness(sp.Rational(B))
    return mp.mpf(sp.N(value, DIGITS))


def width_error(wave: BackgroundWave, p0: float, quantity: str) -> float:
    """Of the float64 width, relatively."""
    true = wave.on(sp.Rational(p0)).fwhm(sp.Rational(B), quantity, 50)
    return abs(float(sp.Float(float(wave.numeric().fwhm(p0, B, quantity)), 50) / true - 1))


@case(
    f"V² to less than {ALLOWED:g} ulps and widths to {NEAR:g} at any load, as differences are "
    "integrals there. Nesterenko's relation as printed loses two digits for each decade of p0/B "
    "and has none left from p0 = 10⁸ B on.",
    Panel("p0 / B", "loss of V², in ulps", scale="xy"),
)
def under_load() -> Parts:
    """p0/B = 1e-12 … 1e12: does V² - c0² cancel, and how well are widths known, in float64?"""
    for k in (sp.Rational(11, 10), sp.Rational(3, 2), sp.Integer(2), sp.Integer(3)):
        wave = background_wave(Cell((1,), spacing=1), law=Power(k))
        with mp.workdps(DIGITS):
            true = np.array([squared(wave, p0) for p0 in RATIOS * B], object)
        ulps = in_ulps(wave.numeric().speed_squared(RATIOS * B, B), true)
        hertz = k == sp.Rational(3, 2)
        yield Finding(f"V² at k = {k}: largest loss in ulps", float(ulps.max()), 0, ALLOWED,
                      key="loss_ulps" if hertz else "")  # fmt: skip
        yield Curve.of(f"k = {k}", RATIOS, np.maximum(ulps, 0.01))
        if hertz:
            zeta = 1 + 1 / RATIOS
            with np.errstate(divide="ignore", invalid="ignore"):
                relation = 4 * (3 + 2 * zeta**2.5 - 5 * zeta) / (15 * (zeta - 1) ** 2)
                lost = in_ulps(relation * np.sqrt(RATIOS * B), true)
            yield Finding("Nesterenko's relation as printed: loss in ulps at p0 = 10⁸ B",
                          float(lost[RATIOS == 1e8][0]), 2.0**50,
                          key="printed_loss_ulps")  # fmt: skip
            finite = np.isfinite(lost)
            yield Curve.of(PRINTED, RATIOS[finite], np.maximum(lost[finite], 0.01))
    for name, masses in (("equal beads", (1,)), ("masses 1, 1/4", (1, "1/4"))):
        wave = background_wave(Cell(masses, spacing=1), law=Power("3/2"))
        for quantity in ("strain", "force"):
            worst = max(width_error(wave, p0, quantity) for p0 in WIDTHS * B)
            yield Finding(f"FWHM of the {quantity}, {name}: largest relative error", worst, 0, NEAR,
                          key=f"{quantity}_error" if len(masses) == 1 else "")  # fmt: skip
