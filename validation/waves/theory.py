"""The theory's traveling waves that the lattice is compared with.

`lwa.PhysicalWave` is the wave of a given peak force. Here are its inverses, the wave of a given
speed dx/dt or momentum, and the width of the force inside a bead, the mean of the bead's two
contact forces.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.typing import ArrayLike

from lwa import Dimer, PhysicalWave, TravelingWave, canonical_wave, homogenize
from lwa.base.arrays import Array
from lwa.base.exact import number
from lwa.wave.closed import CompactWave
from validation.scenes.checks import SceneError, positive


@dataclass(frozen=True)
class Compacton:
    """One wave of a chain with equal contacts, of peak strain B; all parameters numbers.

    Raises `SceneError` unless B is a positive number; ``of_speed``, ``of_bead_force`` and
    ``of_momentum`` unless the amount is positive and B a float.
    """

    wave: TravelingWave
    B: float
    k: float = field(init=False)
    beta: float = field(init=False)
    spacing: float = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "B", positive(self.B, "B"))
        own = {"k": self.wave.k, "beta": self.wave.beta, "spacing": self.wave.D}
        for name, value in own.items():
            object.__setattr__(self, name, number(value))

    @classmethod
    def of_speed(cls, wave: TravelingWave, speed: float) -> Compacton:
        """The wave of a speed dx/dt, which goes as B^{(k-1)/2}."""
        unit = cls(wave, 1.0)
        return cls(wave, _strain("speed", speed, unit.speed, (unit.k - 1) / 2))

    @classmethod
    def of_bead_force(cls, wave: TravelingWave, force: float) -> Compacton:
        """The wave whose bead force, which goes as B^k, has this peak."""
        unit = cls(wave, 1.0)
        return cls(wave, _strain("force", force, float(unit.bead_force(0.0)), unit.k))

    @classmethod
    def of_momentum(cls, wave: TravelingWave, momentum: float) -> Compacton:
        """The wave that carries this momentum, which goes as B^{(k+1)/2}."""
        unit = cls(wave, 1.0)
        return cls(wave, _strain("momentum", momentum, unit.momentum, (unit.k + 1) / 2))

    @property
    def m(self) -> float:
        """2/(k-1), the power of the cosine."""
        return 2 / (self.k - 1)

    @property
    def support(self) -> float:
        """π/β, a length."""
        return math.pi / self.beta

    @cached_property
    def speed(self) -> float:
        """dx/dt."""
        unit = number(self.wave.speed(1)) * number(self.wave.speed_scale)
        return float(unit * self.B ** ((self.k - 1) / 2))

    @property
    def momentum(self) -> float:
        """∫ (mass per length) (bead velocity) dx, with the mass of a cell spread evenly over it."""
        cell = self.wave.cell
        density = number(cell.mass) / (cell.size * self.spacing)
        return density * self.speed * self.B * self.arch_integral(self.m)

    def arch_integral(self, power: float) -> float:
        """∫ cos^power(βx) dx over the support."""
        return float(scipy.special.beta((power + 1) / 2, 0.5)) / self.beta

    def compression(self, x: ArrayLike) -> Array:
        """D v, of a contact at x."""
        return self.spacing * self.B * arch(self.beta * np.asarray(x, float), self.m)

    def velocity(self, x: ArrayLike) -> Array:
        """V v, of a bead at x, in the direction of the wave."""
        return self.speed / self.spacing * self.compression(x)

    def contact_force(self, x: ArrayLike) -> Array:
        """A (D v)^k, of a contact at x."""
        return number(self.wave.cell.stiffness(self.wave.k)) * self.compression(x) ** self.k

    def bead_force(self, x: ArrayLike) -> Array:
        """The mean of the contact forces at x - D/2 and x + D/2, of a bead at x."""
        centre, half = np.asarray(x, float), self.spacing / 2
        return (self.contact_force(centre - half) + self.contact_force(centre + half)) / 2

    def fwhm(self, quantity: str) -> float:
        """Full width at half maximum of "strain", "force" (of a contact) or "bead force"."""
        if quantity != "bead force":
            return number(self.wave.fwhm(quantity))
        half = self.bead_force(0.0) / 2
        end = (self.support + self.spacing) / 2
        return 2 * float(
            scipy.optimize.brentq(lambda x: self.bead_force(x) - half, 0.0, end, xtol=1e-14 * end)
        )


def arch(y: Array, power: float) -> Array:
    """cos^power y on |y| < π/2, 0 outside."""
    return np.where(np.abs(y) < np.pi / 2, np.cos(y), 0.0) ** power


def theory_at(k: Any, omega: Any, closure: str = "linear") -> TravelingWave:
    """The theory's wave for masses 1 and ω, equal contacts A = 1 and D = 1.

    closure : "linear" (the paper's), "full", or "canonical" (the canonical field of the full one).

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure).pde.traveling_wave()


def of_speed(wave: TravelingWave, speed: float) -> PhysicalWave:
    """The wave with a speed dx/dt, which scales as F^{(k-1)/(2k)}.

    Raises `SceneError` unless the speed is positive and the force is a float.
    """
    unit, k = PhysicalWave(wave, sp.S.One), wave.k
    return _with(wave, "speed", speed, unit.speed, (k - 1) / (2 * k))


def of_momentum(wave: TravelingWave, momentum: float) -> PhysicalWave:
    """The wave with a momentum, which scales as F^{(k+1)/(2k)}.

    Raises `SceneError` unless the momentum is positive and the force is a float.
    """
    unit, k = PhysicalWave(wave, sp.S.One), wave.k
    return _with(wave, "momentum", momentum, unit.momentum, (k + 1) / (2 * k))


def _with(
    wave: TravelingWave, name: str, amount: float, unit: sp.Expr, exponent: sp.Expr
) -> PhysicalWave:
    """The wave with an amount that is ``unit`` at force 1 and scales as F^exponent."""
    log = math.log(positive(amount, name) / number(unit)) / number(exponent)
    if abs(log) > 700:
        raise SceneError(f"{name} is {amount:g}: the force e^{log:.0f} is no float")
    return PhysicalWave(wave, math.exp(log))


def bead_fwhm(wave: CompactWave) -> float:
    """Full width at half maximum of the force inside a bead, a length; the same at every force.

    The force is cos^p(β(x - D/2)) + cos^p(β(x + D/2)), p = 2k/(k-1), each term on its own arch.
    """
    k, D = number(wave.k), number(wave.D)
    beta = (k - 1) / (2 * D * math.sqrt(number(wave.dispersion)))

    def force(x: float) -> float:
        sides = (beta * (x + side) for side in (-D / 2, D / 2))
        return math.fsum(math.cos(y) ** (2 * k / (k - 1)) for y in sides if abs(y) < math.pi / 2)

    half, end = force(0.0) / 2, (math.pi / beta + D) / 2
    found: float = scipy.optimize.brentq(lambda x: force(x) - half, 0, end, xtol=1e-14 * end)
    return 2 * found


def _strain(name: str, amount: float, unit: float, power: float) -> float:
    """B where an amount is ``unit`` at B = 1 and goes as B^power."""
    log = math.log(positive(amount, name) / unit) / power
    if abs(log) > 700:
        raise SceneError(f"{name} is {amount:g}: the strain e^{log:.0f} is no float")
    return math.exp(log)
