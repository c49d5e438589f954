"""Leading powers of the theory's error as k → 1.

The powers and the coefficients are derived, not fitted. Let v(x) be the strain of the wave with
peak 1, ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
-3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
-3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. Hence the
errors, theory divided by lattice less 1, are to leading order

    FWHM of force and strain        (3/20 - ln 2 / 15) ε
    support π/β, by the impulse     1/20 ε
    speed at equal strain           -3/40 ε²     (c² = 1 - ε/2 + 2ε²/5 against 2/(k + 1)).
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from lwa import TravelingWave

QUANTITIES = ("FWHM of force", "FWHM of strain", "support π/β", "speed V_s at B = 1")
"""Lengths in D; force and strain are a contact's; the support is by the impulse ∫F dx / F_m."""


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error, coefficient · ε^order, and bounds of a measurement.

    constant : |error| ≤ constant · ε^order at each k measured.
    order_bound, coefficient_bound : relative bounds for the fitted order and coefficient.
    """

    order: int
    coefficient: sp.Expr
    constant: float
    order_bound: float
    coefficient_bound: float

    def bound(self, k: sp.Expr) -> float:
        """Return the bound of |error| at k = 1 + ε."""
        return self.constant * float(k - 1) ** self.order


_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
_SUPPORT = LeadingPower(1, sp.Rational(1, 20), 0.077, 0.2, 0.02)
_SPEED = LeadingPower(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01)
LAWS = dict(zip(QUANTITIES, (_WIDTH, _WIDTH, _SUPPORT, _SPEED), strict=True))


def theory_values(wave: TravelingWave) -> dict[str, sp.Expr]:
    """Return the exact values of `QUANTITIES` for the theory's wave."""
    values = wave.fwhm("force"), wave.fwhm("strain"), wave.width, wave.speed(1)
    return dict(zip(QUANTITIES, values, strict=True))
