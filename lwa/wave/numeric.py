"""The compact wave's closed forms in float64: NumPy functions of arrays of k and ω = m2/m1.

Letters as in `lwa.wave.closed`; lengths are in units of D. The sum G + H + I loses digits where
k > 2 and ω ≫ 1. The exact coefficients are therefore evaluated in extended precision
(`numpy.longdouble`, 64 bits of significand on x86) as polynomials in k - 2, a difference without
rounding error near k = 2. The ratio V²/B^{k-1} approaches 1 as k → 1: its logarithm is the log1p of
V²/B^{k-1} - 1, which is computed as (k - 1) times a rational function. Results are rounded to
float64 once, at the end, and are good to 2 ulps where the extended precision is available.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, Extended, finite
from lwa.base.exact import InputError, one_of
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, strain_power
from lwa.wave.closed import CompactWave

Function = Callable[[Extended, Extended], Extended]

_PI = np.longdouble("3.14159265358979323846264338327950288")
_LOG4 = np.longdouble("1.38629436111989061883446424291635313")


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
        return self._beta(k, omega).astype(np.float64)

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The number π/(βD) of sites under the wave."""
        return (_PI / self._beta(k, omega)).astype(np.float64)

    def fwhm(self, k: ArrayLike, omega: ArrayLike, quantity: str = "strain") -> Array:
        """FWHM of strain, contact force or velocity in units of D (`lwa.TravelingWave.fwhm`)."""
        beta = self._beta(k, omega)
        k = np.asarray(k, np.longdouble)
        # arccos(2^-x) = arctan √(4^x - 1), which keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        return np.asarray(2 * np.arctan(np.sqrt(np.expm1(x * _LOG4))) / beta).astype(np.float64)

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """Speed V = dx/dτ of the wave whose strain peaks at B."""
        k, omega, _ = self._wave(k, omega)
        root = np.sqrt(self._factor(k, omega)) * _positive(B, "B") ** ((k - 1) / 2)
        return np.asarray(root).astype(np.float64)

    def log_amplitude(self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0) -> Array:
        """Logarithm of the peak strain B of the wave of speed V, finite where B is out of range."""
        k, omega, _ = self._wave(k, omega)
        less_one = (k - 1) * self._excess(k, omega)  # V²/B^{k-1} - 1
        near = np.abs(less_one) < 0.5  # log1p keeps the digits that V²/B^{k-1} loses at k → 1
        log_factor = np.where(near, np.log1p(less_one), np.log(self._factor(k, omega)))
        log_B = (2 * np.log(_positive(V, "V")) - log_factor) / (k - 1)
        return np.asarray(log_B).astype(np.float64)

    def _beta(self, k: ArrayLike, omega: ArrayLike) -> Extended:
        k, _, coefficient_sum = self._wave(k, omega)
        return np.asarray((k - 1) / (2 * np.sqrt(coefficient_sum)))

    def _wave(self, k: ArrayLike, omega: ArrayLike) -> tuple[Extended, Extended, Extended]:
        """Return k, ω and (G+H+I)/D², broadcast; G, H, I are the wave equation's coefficients.

        At points without a wave all three are NaN, or `lwa.NoSolitaryWave` is raised (``missing``).
        """
        k = finite(k, "k").astype(np.longdouble)
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


def _positive(value: ArrayLike, name: str) -> Extended:
    array = finite(value, name)
    if not np.all(array > 0):
        raise InputError(f"{name} is {array.min()}: it must be positive")
    return array.astype(np.longdouble)


def _function(ratio: sp.Expr, k: sp.Symbol, m1: sp.Symbol, m2: sp.Symbol) -> Function:
    """Compile a rational expression homogeneous in the masses to a function of (k, ω)."""
    shifted, omega = sp.symbols("kappa omega", cls=sp.Dummy)
    ratio = ratio.subs({m1: 1, m2: omega, k: shifted + 2}, simultaneous=True)
    numerator, denominator = (
        sum(
            sp.factor(coefficient) * shifted**power
            for (power,), coefficient in sp.Poly(part, shifted).terms()
        )
        for part in sp.fraction(sp.cancel(ratio))
    )
    compiled = sp.lambdify((shifted, omega), numerator / denominator, "numpy", cse=True)
    # A theory without ω, or without k, gives a constant, which is broadcast.
    return lambda k, omega: np.asarray(compiled(k - 2, omega) + 0 * k)
