"""The theory's traveling wave in numbers, as the lattice would see it.

The strain is v(x) = B cos^m(βx), m = 2/(k-1), on |x| ≤ π/(2β) (Porter et al. 2008). The
lattice knows it through its contacts and beads, in the units of the cell:

    contact   compression D v, force A (D v)^k,
    bead      velocity V v, and the mean of the forces half a spacing D before and behind it.

The integral of an arch, ∫ cos^q(βx) dx = √π Γ((q+1)/2) / (Γ(q/2+1) β), gives impulse and momentum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.typing import ArrayLike

from lwa import Cell, Dimer, Power, TravelingWave, background_wave, canonical_wave, homogenize
from lwa.background.quadrature import NumericBackground
from lwa.compact.numeric import Array
from validation.scenes.checks import SceneError, positive


@dataclass(frozen=True)
class Compacton:
    """One wave of a chain with equal contacts, of peak strain B; all parameters numbers.

    Raises `SceneError` unless B is a positive number.
    """

    wave: TravelingWave
    B: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "B", positive(self.B, "B"))

    @classmethod
    def of_speed(cls, wave: TravelingWave, speed: float) -> Compacton:
        """The wave of a speed dx/dt: B^{(k-1)/2} is proportional to it.

        This and the next two raise `SceneError` unless the amount is positive and B a float.
        """
        unit = cls(wave, 1.0)
        return cls(wave, _strain("speed", speed, unit.speed, (unit.k - 1) / 2))

    @classmethod
    def of_bead_force(cls, wave: TravelingWave, force: float) -> Compacton:
        """The wave whose bead force has this peak: B^k is proportional to it."""
        unit = cls(wave, 1.0)
        return cls(wave, _strain("force", force, float(unit.bead_force(0.0)), unit.k))

    @classmethod
    def of_momentum(cls, wave: TravelingWave, momentum: float) -> Compacton:
        """The wave that carries this momentum: B^{(k+1)/2} is proportional to it."""
        unit = cls(wave, 1.0)
        return cls(wave, _strain("momentum", momentum, unit.momentum, (unit.k + 1) / 2))

    @cached_property
    def k(self) -> float:
        """The exponent of the contact law."""
        return _float(self.wave.k)

    @cached_property
    def m(self) -> float:
        """2/(k-1), the power of the cosine."""
        return _float(self.wave.m)

    @cached_property
    def spacing(self) -> float:
        """D."""
        return _float(self.wave.D)

    @cached_property
    def beta(self) -> float:
        """β."""
        return _float(self.wave.beta)

    @cached_property
    def support(self) -> float:
        """π/β, a length."""
        return math.pi / self.beta

    @cached_property
    def speed(self) -> float:
        """dx/dt."""
        unit = _float(self.wave.speed(1)) * _float(self.wave.speed_scale)
        return float(unit * self.B ** ((self.k - 1) / 2))

    @cached_property
    def momentum(self) -> float:
        """∫ (mass per length) (bead velocity) dx, with the mass of a cell spread evenly over it."""
        cell = self.wave.cell
        density = _float(cell.mass) / (cell.size * self.spacing)
        return density * self.speed * self.B * self.arch_integral(self.m)

    def arch_integral(self, power: float) -> float:
        """∫ cos^power(βx) dx over the support."""
        gammas = math.lgamma((power + 1) / 2) - math.lgamma(power / 2 + 1)
        return math.sqrt(math.pi) * math.exp(gammas) / self.beta

    def arch(self, x: ArrayLike, power: float) -> Array:
        """cos^power(βx) on the support, 0 outside."""
        angle = np.clip(self.beta * np.asarray(x, float), -np.pi / 2, np.pi / 2)
        return np.asarray(np.cos(angle) ** power)

    def compression(self, x: ArrayLike) -> Array:
        """D v, of a contact at x."""
        return self.spacing * self.B * self.arch(x, self.m)

    def velocity(self, x: ArrayLike) -> Array:
        """V v, of a bead at x, in the direction of the wave."""
        peak = self.speed * self.B
        return peak * self.arch(x, self.m)

    def contact_force(self, x: ArrayLike) -> Array:
        """A (D v)^k, of a contact at x."""
        stiffness = _float(self.wave.cell.stiffness(self.wave.k))
        peak = float(stiffness * (self.spacing * self.B) ** self.k)
        return peak * self.arch(x, self.k * self.m)

    def bead_force(self, x: ArrayLike) -> Array:
        """The mean of the contact forces at x - D/2 and x + D/2, of a bead at x."""
        centre, half = np.asarray(x, float), self.spacing / 2
        mean: Array = (self.contact_force(centre - half) + self.contact_force(centre + half)) / 2
        return mean

    def fwhm(self, quantity: str) -> float:
        """Full width at half maximum of "strain", "force" (of a contact) or "bead force"."""
        if quantity != "bead force":
            return _float(self.wave.fwhm(quantity))
        half = self.bead_force(0.0) / 2
        end = (self.support + self.spacing) / 2
        return 2 * float(
            scipy.optimize.brentq(lambda x: self.bead_force(x) - half, 0.0, end, xtol=1e-14 * end)
        )


@dataclass(frozen=True)
class Loaded:
    """The wave of equal beads under a load, whose strain rises from p0 to 1; m = A = D = 1."""

    k: float
    p0: float

    @cached_property
    def _numeric(self) -> NumericBackground:
        return background_wave(Cell((1,), spacing=1), law=Power(self.k)).numeric()

    @cached_property
    def c2(self) -> float:
        """c²."""
        return float(self.k * self._numeric.speed_squared(self.p0, 1 - self.p0))

    @cached_property
    def narrower(self) -> float:
        """The FWHM of the wave without a load over this one's."""
        return float(self._numeric.fwhm(0.0, 1.0) / self._numeric.fwhm(self.p0, 1 - self.p0))

    @cached_property
    def kappa(self) -> float:
        """κ of the lattice's end of a wave so fast, e^{-κ|ξ|}: c/c0 = sinh(κ/2)/(κ/2)."""
        excess = math.sqrt(self.c2 / (self.k * self.p0 ** (self.k - 1)))
        half = scipy.optimize.brentq(
            lambda x: math.log(math.sinh(x) / x / excess), 1e-5, 300, xtol=1e-12
        )
        return 2 * float(half)

    def strain(self, xi: ArrayLike) -> Array:
        """v(ξ), above p0."""
        return self._numeric.profile(xi, self.p0, 1 - self.p0)


def theory_at(k: Any, omega: Any, closure: str = "linear") -> TravelingWave:
    """The theory's wave for masses 1 and ω, equal contacts A = 1 and D = 1.

    closure : "linear", the paper's, or "full", or "canonical": the full closure's canonical field.

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure).pde.traveling_wave()


def _strain(name: str, amount: float, unit: float, power: float) -> float:
    """B where an amount is ``unit`` at B = 1 and goes as B^power."""
    log = math.log(positive(amount, name) / unit) / power
    if abs(log) > 700:
        raise SceneError(f"{name} is {amount:g}: the strain e^{log:.0f} is no float")
    return math.exp(log)


def _float(value: Any) -> float:
    return float(sp.N(value, 17))
