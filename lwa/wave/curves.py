"""A wave in numbers: its curves over time, and its answers to an array of peak forces.

A contact's force passes as F cos^{mk}(βξ), m = 2/(k-1), ξ = x - (dx/dt) t. A bead bears the mean of
its two contacts, half a spacing before and behind it. All that depends on the peak force F is a
power of it: the strain is as F^{1/k} and the speed as F^{(k-1)/(2k)}.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from lwa.base.exact import InputError, shorten
from lwa.base.quantities import known, strain_power

if TYPE_CHECKING:
    from lwa.wave.physical import PhysicalWave

DIGITS = 20
"""With which numbers are evaluated before they become floats."""


def number(value: sp.Expr) -> float:
    """The float of an exact number.

    Raises `lwa.InputError` where it holds a symbol.
    """
    if value.free_symbols:
        names = ", ".join(sorted(map(str, value.free_symbols)))
        raise InputError(f"{names}: a curve needs numbers for all symbols; give them by at(…)")
    return float(sp.N(value, DIGITS))


def real(values: ArrayLike, name: str) -> Array:
    """An array of finite numbers, checked."""
    try:
        array = np.asarray(values)
        array = array.astype(float, casting="unsafe" if array.dtype.kind == "O" else "safe")
    except (TypeError, ValueError):
        raise InputError(f"{name} is {shorten(values)}: real numbers are wanted") from None
    if not np.all(np.isfinite(array)):
        raise InputError(
            f"{name} is {array[~np.isfinite(array)].flat[0]}: finite numbers are wanted"
        )
    return array


def arch(y: Array, power: float) -> Array:
    """cos^power y on |y| < π/2, 0 outside."""
    return np.where(np.abs(y) < np.pi / 2, np.cos(y), 0.0) ** power


def curve(answer: PhysicalWave, t: ArrayLike, quantity: str, of: str) -> Array:
    """A quantity of a contact or a bead at the times t; see `lwa.PhysicalWave.curve`."""
    wave = answer.wave
    k, D = number(wave.k), number(wave.D)
    beta = number((wave.k - 1) / (2 * wave.D * sp.sqrt(wave.dispersion)))
    peaks = {
        "strain": answer.strain,
        "force": answer.contact_force,
        "velocity": answer.bead_velocity,
    }
    peak, power = number(peaks[known(quantity)]), 2 * strain_power(quantity, k) / (k - 1)
    xi = -number(answer.speed) * real(t, "t")
    if of == "bead" and quantity != "velocity":
        sides = (arch(beta * (xi + side), power) for side in (D / 2, -D / 2))
        return np.asarray(peak * sum(sides) / 2)
    return np.asarray(peak * arch(beta * xi, power))


@dataclass(frozen=True, eq=False)
class PhysicalWaves:
    """The waves of many peak forces, as `lwa.PhysicalWave` has one: float64 arrays of their shape.

    ``unit`` is the wave of peak force 1. Raises `lwa.InputError` unless all forces are positive,
    and where the chain holds symbols.
    """

    unit: PhysicalWave
    force: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", real(self.force, "force"))
        if not np.all(self.force > 0):
            raise InputError(f"force is {self.force.min()}: it must be positive")
        number(self.unit.speed)

    def _power(self, value: sp.Expr, power: Callable[[Any], Any]) -> Array:
        return np.asarray(number(value) * self.force ** number(power(self.unit.wave.k)))

    @property
    def contact_force(self) -> Array:
        """The peak force of the contacts."""
        return self._power(self.unit.contact_force, lambda k: sp.S.One)

    @property
    def bead_force(self) -> Array:
        """The peak force of a bead, the mean of its two contacts."""
        return self._power(self.unit.bead_force, lambda k: sp.S.One)

    @property
    def strain(self) -> Array:
        """B, the peak strain."""
        return self._power(self.unit.strain, lambda k: 1 / k)

    @property
    def compression(self) -> Array:
        """D B, the mean peak compression of the contacts."""
        return self._power(self.unit.compression, lambda k: 1 / k)

    @property
    def speed(self) -> Array:
        """dx/dt."""
        return self._power(self.unit.speed, lambda k: (k - 1) / (2 * k))

    @property
    def bead_velocity(self) -> Array:
        """B dx/dt, the peak velocity of the beads."""
        return self._power(self.unit.bead_velocity, lambda k: (k + 1) / (2 * k))

    def fwhm(self, quantity: str = "force", extent: str = "length") -> Array:
        """Full width at half maximum, as `lwa.PhysicalWave.fwhm`."""
        width = self.unit.fwhm(quantity, extent)
        if extent == "length":
            return self._power(width, lambda k: sp.S.Zero)
        return self._power(width, lambda k: (1 - k) / (2 * k))
