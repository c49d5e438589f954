"""The theory's traveling waves that the lattice is compared with.

`lwa.PhysicalWave` is the wave with a given peak force. This module finds the wave with a given
speed dx/dt or momentum, the width of a bead's force, the mean of its two contact forces, and the
leading powers of the theory's error as k → 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import scipy
import sympy as sp

from lwa import Dimer, PhysicalWave, TravelingWave, canonical_wave, homogenize
from lwa.base.exact import number
from lwa.wave.closed import CompactWave
from validation.scenes.checks import positive

QUANTITIES = ("FWHM of force", "FWHM of strain", "support π/β", "speed V_s at B = 1")
"""Lengths in D; force and strain are a contact's; the support is by the impulse ∫F dx / F_m."""


def theory_at(k: Any, omega: Any, closure: str = "linear") -> TravelingWave:
    """Return the theory's wave for masses 1 and ω, equal contacts A = 1 and D = 1.

    closure : "linear" (the paper's), "full", or "canonical" (full closure, canonical field).

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure).pde.traveling_wave()


def theory_values(wave: TravelingWave) -> dict[str, sp.Expr]:
    """Return the exact values of `QUANTITIES` for the theory's wave."""
    values = wave.fwhm("force"), wave.fwhm("strain"), wave.width, wave.speed(1)
    return dict(zip(QUANTITIES, values, strict=True))


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error, coefficient · ε^order, and bounds of a measurement."""

    order: int
    coefficient: sp.Expr
    constant: float  # |error| ≤ constant · ε^order at each k measured
    order_bound: float  # relative, for the fitted order
    coefficient_bound: float  # relative, for the fitted coefficient

    def bound(self, k: sp.Expr) -> float:
        """Return the bound of |error| at k = 1 + ε."""
        return self.constant * float(k - 1) ** self.order


# Powers and coefficients are derived, not fitted. Let v(x) be the strain of the wave with peak 1,
# ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
# -3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
# -3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. c² is
# 1 - ε/2 + 2ε²/5 for the lattice against 2/(k+1) for the theory. Errors: theory/lattice - 1.
_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
_SUPPORT = LeadingPower(1, sp.Rational(1, 20), 0.077, 0.2, 0.02)
_SPEED = LeadingPower(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01)
LEADING_POWERS = dict(zip(QUANTITIES, (_WIDTH, _WIDTH, _SUPPORT, _SPEED), strict=True))


def of_speed(wave: TravelingWave, speed: float) -> PhysicalWave:
    """Return the theory's wave with a given speed dx/dt; `SceneError` unless it is positive."""
    return _with(wave, "speed", speed, -1)


def of_momentum(wave: TravelingWave, momentum: float) -> PhysicalWave:
    """Return the theory's wave with a given momentum; `SceneError` unless it is positive."""
    return _with(wave, "momentum", momentum, 1)


def _with(wave: TravelingWave, name: str, amount: float, sign: int) -> PhysicalWave:
    """Return the wave at which a quantity, ∝ F^{(k + sign)/(2k)}, has the given amount."""
    unit, exponent = PhysicalWave(wave, sp.S.One), (wave.k + sign) / (2 * wave.k)
    ratio = positive(amount, name) / number(getattr(unit, name))
    return PhysicalWave(wave, math.exp(math.log(ratio) / number(exponent)))


def bead_fwhm(wave: CompactWave) -> float:
    """Return the FWHM of a bead's force, a length that does not depend on the amplitude."""
    k, D = number(wave.k), number(wave.D)
    beta = (k - 1) / (2 * D * math.sqrt(number(wave.coefficient_sum)))

    def force(x: float) -> float:
        """Return a bead's force: cos^p(β(x ± D/2)) summed, p = 2k/(k-1), each 0 off its arch."""
        sides = (beta * (x + side) for side in (-D / 2, D / 2))
        return math.fsum(math.cos(y) ** (2 * k / (k - 1)) for y in sides if abs(y) < math.pi / 2)

    half, end = force(0.0) / 2, (math.pi / beta + D) / 2
    return 2 * float(scipy.optimize.brentq(lambda x: force(x) - half, 0, end, xtol=1e-14 * end))
