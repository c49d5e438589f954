"""The theory's traveling waves that the lattice is compared with.

`lwa.PhysicalWave` is the wave with a given peak force. This module finds the wave with a given
speed dx/dt or momentum, and the width of a bead's force, the mean of its two contact forces.
"""

from __future__ import annotations

import math
from typing import Any

import scipy
import sympy as sp

from lwa import Dimer, PhysicalWave, TravelingWave, canonical_wave, homogenize
from lwa.base.exact import number
from lwa.wave.closed import CompactWave
from validation.scenes.checks import SceneError, positive


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


def of_speed(wave: TravelingWave, speed: float) -> PhysicalWave:
    """Return the theory's wave with a given speed dx/dt, which scales as F^{(k-1)/(2k)}.

    Raises `SceneError` unless the speed is positive and the force is a float.
    """
    unit, k = PhysicalWave(wave, sp.S.One), wave.k
    return _with(wave, "speed", speed, unit.speed, (k - 1) / (2 * k))


def of_momentum(wave: TravelingWave, momentum: float) -> PhysicalWave:
    """Return the theory's wave with a given momentum, which scales as F^{(k+1)/(2k)}.

    Raises `SceneError` unless the momentum is positive and the force is a float.
    """
    unit, k = PhysicalWave(wave, sp.S.One), wave.k
    return _with(wave, "momentum", momentum, unit.momentum, (k + 1) / (2 * k))


def _with(
    wave: TravelingWave, name: str, amount: float, unit: sp.Expr, exponent: sp.Expr
) -> PhysicalWave:
    """Return the wave with a given amount, which is ``unit`` at force 1 and ~ F^exponent."""
    log = math.log(positive(amount, name) / number(unit)) / number(exponent)
    if abs(log) > 700:
        raise SceneError(f"{name} is {amount:g}: the force e^{log:.0f} is no float")
    return PhysicalWave(wave, math.exp(log))


def bead_fwhm(wave: CompactWave) -> float:
    """Return the FWHM of a bead's force, a length that does not depend on the amplitude.

    The force is cos^p(β(x - D/2)) + cos^p(β(x + D/2)), p = 2k/(k-1), each term on its own arch.
    """
    k, D = number(wave.k), number(wave.D)
    beta = (k - 1) / (2 * D * math.sqrt(number(wave.coefficient_sum)))

    def force(x: float) -> float:
        sides = (beta * (x + side) for side in (-D / 2, D / 2))
        return math.fsum(math.cos(y) ** (2 * k / (k - 1)) for y in sides if abs(y) < math.pi / 2)

    half, end = force(0.0) / 2, (math.pi / beta + D) / 2
    found: float = scipy.optimize.brentq(lambda x: force(x) - half, 0, end, xtol=1e-14 * end)
    return 2 * found
