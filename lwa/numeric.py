"""The closed forms in float64: vectorised NumPy functions of (k, ω), ω = m2/m1, lengths in D.

The exact coefficients are turned into code in the variable k - 2, which floating point holds
exactly near k = 2, where the terms of G + H + I cancel for ω ≫ 1. What grows without bound as
k → 1 is computed from its logarithm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lwa.exact import InputError, shorten
from lwa.wave import NoSolitaryWave, strain_power

if TYPE_CHECKING:
    from lwa.wave import TravelingWave

Array = NDArray[np.float64]
Function = Callable[[Array, Array], Any]


@dataclass(frozen=True)
class NumericWave:
    """β, width, FWHM, speed and amplitude of a dimer's wave, for arrays of k and ω.

    k and ω broadcast against each other. Where there is no wave (k ≤ 1, G + H + I ≤ 0, V² ≤ 0)
    the functions raise `lwa.NoSolitaryWave` and name the first such point, or, with
    ``missing="nan"``, return NaN there.

    >>> import numpy as np
    >>> from lwa import Dimer, homogenize
    >>> wave = homogenize(Dimer("m1", "m2")).pde.traveling_wave().numeric()
    >>> np.round(wave.beta(1.5, [1.0, 1e-12]) * np.sqrt(10), 9)
    array([2., 1.])
    """

    dispersion: Function
    speed_factor: Function
    missing: Literal["raise", "nan"] = "raise"

    @classmethod
    def of(cls, wave: TravelingWave, missing: Literal["raise", "nan"] = "raise") -> NumericWave:
        """The functions of a wave whose k, m1 and m2 are three symbols."""
        if missing not in ("raise", "nan"):
            raise InputError(f"missing is {shorten(missing)}: 'raise' or 'nan' is wanted")
        free = (wave.k, *wave.cell.masses)
        if len(free) != 3 or len(set(free)) != 3 or not all(x.is_Symbol for x in free):
            raise InputError("functions of (k, ω) need the symbols k, m1, m2 in a dimer's theory")
        return cls(_function(wave.dispersion, *free), _function(wave.speed_factor, *free), missing)

    def beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """β D = (k-1) / (2 √((G+H+I)/D²))."""
        k, dispersion, _ = self._wave(k, omega)
        beta: Array = (k - 1) / (2 * np.sqrt(dispersion))
        return beta

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """π/(βD), the number of sites under the wave."""
        return np.pi / self.beta(k, omega)

    def fwhm(self, k: ArrayLike, omega: ArrayLike, quantity: str = "strain") -> Array:
        """FWHM of strain, contact force or velocity, over D (see `lwa.TravelingWave.fwhm`)."""
        beta = self.beta(k, omega)
        k = np.asarray(k, float)
        # arccos(2^-x) = arctan √(4^x - 1), which keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        fwhm: Array = 2 * np.arctan(np.sqrt(np.expm1(x * np.log(4.0)))) / beta
        return fwhm

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """V = dx/dτ of the wave whose strain peaks at B."""
        k, _, factor = self._wave(k, omega)
        return np.sqrt(factor) * _positive(B, "B") ** ((k - 1) / 2)

    def log_amplitude(self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0) -> Array:
        """ln B of the wave of speed V; finite where B, its peak strain, over- or underflows."""
        k, _, factor = self._wave(k, omega)
        return (2 * np.log(_positive(V, "V")) - np.log(factor)) / (k - 1)

    def _wave(self, k: ArrayLike, omega: ArrayLike) -> tuple[Array, Array, Array]:
        k, omega = np.broadcast_arrays(np.asarray(k, float), np.asarray(omega, float))
        if not (np.all(np.isfinite(k)) and np.all(np.isfinite(omega)) and np.all(omega > 0)):
            raise InputError("k and ω = m2/m1 must be finite, and ω positive")
        with np.errstate(all="ignore"):  # outside the domain, which the next lines tell
            dispersion, factor = self.dispersion(k, omega), self.speed_factor(k, omega)
            exists = (k > 1) & (dispersion > 0) & (factor > 0)
        if np.all(exists):
            return k, dispersion, factor
        if self.missing == "raise":
            first = np.argmin(exists)
            raise NoSolitaryWave(
                f"no compact wave at k = {k.flat[first]}, ω = {omega.flat[first]}: it needs "
                "k > 1, G+H+I > 0 and V² > 0"
            )
        nan = np.where(exists, 0.0, np.nan)
        return k + nan, dispersion + nan, factor + nan


def _positive(value: ArrayLike, name: str) -> Array:
    array = np.asarray(value, float)
    if not np.all((array > 0) & np.isfinite(array)):
        raise InputError(f"{name} must be positive and finite")
    return array


def _function(ratio: sp.Expr, k: sp.Symbol, m1: sp.Symbol, m2: sp.Symbol) -> Function:
    """A function of (k, ω) from a rational expression homogeneous in the masses."""
    shifted, omega = sp.symbols("kappa omega")
    ratio = ratio.subs({m1: 1, m2: omega, k: shifted + 2}, simultaneous=True)
    numerator, denominator = (
        sum(
            sp.factor(coefficient) * shifted**power
            for (power,), coefficient in sp.Poly(part, shifted).terms()
        )
        for part in sp.fraction(sp.cancel(ratio))
    )
    compiled = sp.lambdify((shifted, omega), numerator / denominator, "numpy", cse=True)
    return lambda k, omega: compiled(k - 2, omega) + 0.0 * k
