"""The compact wave's closed forms in float64: NumPy functions of arrays of k and m2/m1, or ω.

Letters as in `lwa.wave.compact`; lengths are in units of D. The rational functions
``(G+H+I)/D²`` and ``(V²/B^{k-1} - 1)/(k-1)`` of k and the masses are compiled as polynomials in the
masses, with coefficients that are factored in k, so that a coefficient vanishes where it should.
Logarithms and powers near ``k = 1`` come by log1p and expm1. Relative errors are below 1e-11; next
to the edge of the domain of waves, where G + H + I or V² vanishes, the last digit of k or ω changes
the results by more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError, factored
from lwa.base.frozen import NoSolitaryWave, Value, strain_power
from lwa.base.words import QuantityName, one_of

LARGEST = 1e150
"""Largest mass ratio: V² holds the square of its reciprocal, the least that a double has."""

Missing = Literal["raise", "nan"]
"""Answers where no wave exists: raise `lwa.NoSolitaryWave`, or return NaN."""

MISSING: tuple[Missing, ...] = get_args(Missing)

# |V²/B^{k-1} - 1| up to which log1p of this difference has more digits than the logarithm
_NEAR_ONE = 0.5


class Domain(NamedTuple):
    """Values of the closed forms at points (k, ω), NaN where there is no wave.

    Parameters
    ----------
    k : Array
        The exponents.
    coefficient_sum : Array
        ``(G + H + I)/D²``.
    speed_factor : Array
        ``V²/B^{k-1}``.
    excess : Array
        ``(V²/B^{k-1} - 1)/(k - 1)``.
    """

    k: Array
    coefficient_sum: Array
    speed_factor: Array
    excess: Array


@dataclass(frozen=True)
class NumericWave(Value):
    """β, width, FWHM, speed and amplitude of an N:1 dimer's wave, for arrays of k and ω.

    The arguments k and ω of the methods broadcast against each other.

    Parameters
    ----------
    k : Symbol
        The exponent.
    masses : tuple of Symbol
        Masses of the cell, two different symbols.
    coefficient_sum, speed_factor : Expr
        ``(G + H + I)/D²`` and ``V²/B^{k-1}``, rational functions of k and the masses.
    missing : {"raise", "nan"}
        Raise `lwa.NoSolitaryWave` with the first point without a wave (``k ≤ 1``,
        ``G + H + I ≤ 0``, ``V² ≤ 0``), or return NaN at these points.

    Raises
    ------
    InputError
        For another wave, and for ω beyond 1e±150.

    Examples
    --------
    >>> from lwa import Dimer, homogenize
    >>> homogenize(Dimer("m1", "m2")).pde.traveling_wave().numeric().width(1.5, [1.0, 0.2733])
    array([4.96729413, 7.59281573])
    """

    k: sp.Expr
    masses: tuple[sp.Expr, ...]
    coefficient_sum: sp.Expr
    speed_factor: sp.Expr
    missing: Missing = "raise"

    def __post_init__(self) -> None:
        one_of(self.missing, MISSING, "missing")
        symbols = {self.k, *self.masses}
        held = self.coefficient_sum.free_symbols | self.speed_factor.free_symbols
        named = all(x.is_Symbol for x in symbols)
        if len(symbols) != 3 or not named or not held <= symbols:
            raise InputError(
                "functions of (k, ω) need a symbol k and a cell of two masses that are symbols, "
                "m1 and m2, with equal contacts"
            )

    @cached_property
    def _compiled(self) -> Callable[..., Any]:
        """The last three fields of `Domain` as functions of k and the masses."""
        masses = tuple(dict.fromkeys(self.masses))

        def by_masses(polynomial: sp.Expr) -> sp.Expr:
            """The polynomial in the masses, with coefficients factored in k."""
            total = sp.S.Zero
            for powers, coefficient in sp.Poly(polynomial, *masses).terms():
                monomial = sp.prod(map(sp.Pow, masses, powers))
                total += sp.factor(coefficient) * monomial
            return total

        forms = []
        # V²/B^{k-1} is 1 at k = 1, where this ratio is finite.
        excess = factored((self.speed_factor - 1) / (self.k - 1))
        for value in (self.coefficient_sum, self.speed_factor, excess):
            numerator, denominator = sp.fraction(value)
            forms.append(by_masses(numerator) / by_masses(denominator))
        compiled: Callable[..., Any] = sp.lambdify(
            (self.k, *masses), forms, "numpy", cse=True
        )
        return compiled

    def beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The wavenumber ``β D = (k-1) / (2 √((G+H+I)/D²))``."""
        at = self._domain(k, omega)
        return np.asarray((at.k - 1) / (2 * np.sqrt(at.coefficient_sum)))

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The number π/(βD) of sites under the wave."""
        return np.pi / self.beta(k, omega)

    def fwhm(
        self, k: ArrayLike, omega: ArrayLike, quantity: QuantityName = "strain"
    ) -> Array:
        """FWHM of strain, contact force or velocity in units of D (`lwa.CompactWave.fwhm`)."""
        beta = self.beta(k, omega)
        k = np.asarray(k, np.float64)
        # arccos(2^-x) = arctan √(4^x - 1), which keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        half_phase = np.arctan(np.sqrt(np.expm1(x * np.log(4.0))))
        return np.asarray(2 * half_phase / beta)

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """Speed ``V = dx/dτ`` of the wave whose strain peaks at B."""
        at = self._domain(k, omega)
        growth = _positive(B, "B") ** ((at.k - 1) / 2)
        return np.asarray(np.sqrt(at.speed_factor) * growth)

    def log_amplitude(
        self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0
    ) -> Array:
        """Logarithm of the peak strain B of the wave of speed V, finite where B is out of range."""
        at = self._domain(k, omega)
        less_one = (at.k - 1) * at.excess
        near = np.abs(less_one) < _NEAR_ONE
        # `where` evaluates both sides: far from 1 the logarithm's argument may be negative.
        log_near = np.log1p(np.where(near, less_one, 0.0))
        log_factor = np.where(near, log_near, np.log(at.speed_factor))
        log_square = 2 * np.log(_positive(V, "V"))
        return np.asarray((log_square - log_factor) / (at.k - 1))

    def _domain(self, k: ArrayLike, omega: ArrayLike) -> Domain:
        """Evaluate the closed forms; treat points without a wave as ``missing`` says."""
        k, omega = np.broadcast_arrays(finite(k, "k"), _positive(omega, "ω = m2/m1"))
        if not np.all((omega >= 1 / LARGEST) & (omega <= LARGEST)):
            raise InputError(
                f"ω = m2/m1 is not between {1 / LARGEST:g} and {LARGEST:g}"
            )
        with np.errstate(all="ignore"):  # outside the domain of waves
            coefficient_sum, factor, excess = np.broadcast_arrays(
                *self._compiled(k, 1.0, omega), k
            )[:3]
        conditions = {
            "k > 1": k > 1,
            "G+H+I > 0": coefficient_sum > 0,
            "V² > 0": factor > 0,
        }
        exists = np.ones(k.shape, bool)
        for name, holds in conditions.items():
            if self.missing == "raise" and not np.all(holds):
                first = np.argmin(holds)
                raise NoSolitaryWave(
                    f"k = {float(k.flat[first])}, ω = {float(omega.flat[first])}: "
                    f"a compact wave needs {name}"
                )
            exists &= holds
        nan = np.where(exists, 0.0, np.nan)  # added, it leaves a value or makes it NaN
        return Domain(k + nan, coefficient_sum + nan, factor + nan, excess + nan)


def _positive(value: ArrayLike, name: str) -> Array:
    """Read an array of positive numbers."""
    array = finite(value, name)
    if not np.all(array > 0):
        raise InputError(f"{name} is {array.min()}: it must be positive")
    return array
