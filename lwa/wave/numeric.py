"""The compact wave's closed forms in float64: NumPy functions of arrays of k and ω = m2/m1.

Letters as in `lwa.wave.closed`; lengths are in units of D. The exact coefficients are polynomials
in k - 2, a difference without rounding error near k = 2. Where the terms of a polynomial cancel, as
those of G + H + I do next to the edge of the domain of waves, the polynomial is evaluated in
fractions. The ratio V²/B^{k-1} approaches 1 as k → 1: its logarithm is the log1p of
V²/B^{k-1} - 1, which is computed as (k - 1) times a rational function. Results are good to 8 ulps;
ln B near B = 1 is good to 8 ulps of the two logarithms of which it is the difference.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import sympy as sp
from flint import fmpq
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError, one_of
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, strain_power
from lwa.wave.closed import CompactWave

Function = Callable[[Array, Array], Array]

_CANCELLED = 4  # largest sum of the sizes of the terms over the size of their sum


@dataclass(frozen=True)
class NumericWave(Value):
    """β, width, FWHM, speed and amplitude of an N:1 dimer's wave, for arrays of k and ω.

    wave : a wave with the symbol k for its exponent and two symbols m1, m2 for its masses.
    missing : "raise" `lwa.NoSolitaryWave`, with the first such point, where there is no wave
        (k ≤ 1, G + H + I ≤ 0, V² ≤ 0), or return "nan" at these points.

    k and ω broadcast against each other. Raises `lwa.InputError` for any other wave.

    >>> from lwa import Dimer, homogenize
    >>> homogenize(Dimer("m1", "m2")).pde.traveling_wave().numeric().width(1.5, [1.0, 0.2733])
    array([4.96729413, 7.59281573])
    """

    wave: CompactWave
    missing: Literal["raise", "nan"] = "raise"

    def __post_init__(self) -> None:
        one_of(self.missing, ("raise", "nan"), "missing")
        free = self._symbols
        given = set(self.wave.coefficient_sum.free_symbols | self.wave.speed_factor.free_symbols)
        if len(set(free)) != 3 or not all(x.is_Symbol for x in free) or not given <= set(free):
            raise InputError(
                "functions of (k, ω) need a symbol k and a cell of two masses that are symbols, "
                "m1 and m2, with equal contacts"
            )

    def latex_rows(self) -> list[str]:
        return self.wave.latex_rows()

    @property
    def _symbols(self) -> tuple[sp.Expr, ...]:
        """The symbol k and the distinct masses, in their order."""
        return (self.wave.k, *dict.fromkeys(self.wave.cell.masses))

    @cached_property
    def _sum(self) -> Function:
        return _function(self.wave.coefficient_sum, *self._symbols)

    @cached_property
    def _factor(self) -> Function:
        return _function(self.wave.speed_factor, *self._symbols)

    @cached_property
    def _excess(self) -> Function:
        """The function (V²/B^{k-1} - 1) / (k - 1) of (k, ω)."""
        return _function((self.wave.speed_factor - 1) / (self.wave.k - 1), *self._symbols)

    def beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The wavenumber β D = (k-1) / (2 √((G+H+I)/D²))."""
        return self._beta(k, omega)

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The number π/(βD) of sites under the wave."""
        return np.pi / self._beta(k, omega)

    def fwhm(self, k: ArrayLike, omega: ArrayLike, quantity: str = "strain") -> Array:
        """FWHM of strain, contact force or velocity in units of D (`lwa.TravelingWave.fwhm`)."""
        beta = self._beta(k, omega)
        k = np.asarray(k, np.float64)
        # arccos(2^-x) = arctan √(4^x - 1), which keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        return np.asarray(2 * np.arctan(np.sqrt(np.expm1(x * np.log(4.0)))) / beta)

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """Speed V = dx/dτ of the wave whose strain peaks at B."""
        k, omega, _ = self._wave(k, omega)
        root = np.sqrt(self._factor(k, omega))
        return np.asarray(root * _positive(B, "B") ** ((k - 1) / 2))

    def log_amplitude(self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0) -> Array:
        """Logarithm of the peak strain B of the wave of speed V, finite where B is out of range."""
        k, omega, _ = self._wave(k, omega)
        less_one = (k - 1) * self._excess(k, omega)  # V²/B^{k-1} - 1
        near = np.abs(less_one) < 0.5  # log1p keeps the digits that V²/B^{k-1} loses at k → 1
        log_factor = np.where(near, np.log1p(less_one), np.log(self._factor(k, omega)))
        log_B = (2 * np.log(_positive(V, "V")) - log_factor) / (k - 1)
        return np.asarray(log_B)

    def _beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        k, _, coefficient_sum = self._wave(k, omega)
        return np.asarray((k - 1) / (2 * np.sqrt(coefficient_sum)))

    def _wave(self, k: ArrayLike, omega: ArrayLike) -> tuple[Array, Array, Array]:
        """Return k, ω and (G+H+I)/D², broadcast; G, H, I are the wave equation's coefficients.

        At points without a wave all three are NaN, or `lwa.NoSolitaryWave` is raised (``missing``).
        """
        k = finite(k, "k")
        k, omega = np.broadcast_arrays(k, _positive(omega, "ω = m2/m1"))
        with np.errstate(all="ignore"):  # outside the domain of waves, see below
            coefficient_sum = self._sum(k, omega)
            conditions = {"k > 1": k > 1, "G+H+I > 0": coefficient_sum > 0}
            conditions["V² > 0"] = self._factor(k, omega) > 0
            exists = np.logical_and.reduce(list(conditions.values()))
        if self.missing == "raise" and not np.all(exists):
            first = np.argmin(exists)
            missed = next(name for name, holds in conditions.items() if not holds.flat[first])
            at = f"k = {float(k.flat[first])}, ω = {float(omega.flat[first])}"
            raise NoSolitaryWave(f"{at}: a compact wave needs {missed}")
        nan = np.where(exists, 0.0, np.nan)
        return k + nan, omega + nan, coefficient_sum + nan


def _positive(value: ArrayLike, name: str) -> Array:
    array = finite(value, name)
    if not np.all(array > 0):
        raise InputError(f"{name} is {array.min()}: it must be positive")
    return array


def _function(ratio: sp.Expr, k: sp.Symbol, m1: sp.Symbol, m2: sp.Symbol) -> Function:
    """Compile a rational expression homogeneous in the masses to a function of (k, ω)."""
    shifted = sp.Dummy("kappa")
    parts = sp.fraction(sp.cancel(ratio.subs(k, shifted + 2)))
    top, bottom = (_polynomial(sp.Poly(part, shifted), m1, m2) for part in parts)
    return lambda k, omega: np.asarray(top(k - 2, omega) / bottom(k - 2, omega))


def _polynomial(polynomial: sp.Poly, m1: sp.Symbol, m2: sp.Symbol) -> Function:
    """Compile a polynomial with integer coefficients in κ = k - 2 and masses to one of (κ, ω).

    The larger mass is 1, so that no power overflows. Floats lose digits in proportion to
    Σ|terms|/|Σ terms|; beyond `_CANCELLED` the terms are fractions, in which nothing is rounded.
    """
    arguments = polynomial.gen, m1, m2
    terms = [sp.factor(c) * polynomial.gen**n for (n,), c in polynomial.terms()]
    sizes = sp.lambdify(arguments, sp.Add(*map(sp.Abs, terms)), "numpy", cse=True)
    total = sp.lambdify(arguments, sp.Add(*terms), "numpy", cse=True)

    def function(kappa: Array, omega: Array) -> Array:
        masses = np.minimum(1, 1 / omega), np.minimum(1, omega)
        value = np.array(total(kappa, *masses) + 0 * kappa)  # a constant is broadcast
        rows = np.abs(value) * _CANCELLED < sizes(kappa, *masses)
        kappa, omega = (_fractions(x[rows]) for x in (kappa, omega))
        value[rows] = _floats(total(kappa, np.minimum(1, 1 / omega), np.minimum(1, omega)))
        return value

    return function


_fractions = np.frompyfunc(lambda x: fmpq(*x.as_integer_ratio()), 1, 1)
_floats = np.frompyfunc(lambda x: int(fmpq(x).p) / int(fmpq(x).q), 1, 1)
