"""The compact wave's closed forms in float64: NumPy functions of arrays of k and ω = m2/m1.

Letters as in `lwa.wave.closed`; lengths are in units of D. The rational functions (G+H+I)/D² and
(V²/B^{k-1} - 1)/(k-1) of k and the masses are compiled with coefficients of the masses that are
factored in k, so that a coefficient vanishes where it should. The masses are scaled by a power of
two: no power overflows, and nothing is rounded. Logarithms and powers near k = 1 come by log1p and
expm1. Measured over random k and ω, relative errors are below 1e-11; next to the edge of the domain
of waves, where G + H + I or V² vanishes, the last digit of k or ω changes the results by more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.algebra.rational import factored
from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError, one_of
from lwa.base.frozen import NoSolitaryWave, Value, strain_power
from lwa.wave.closed import CompactWave

LARGEST = 1e150
"""Largest mass ratio: V² holds the square of its reciprocal, the least that a double has."""


@dataclass(frozen=True)
class NumericWave(Value):
    """β, width, FWHM, speed and amplitude of an N:1 dimer's wave, for arrays of k and ω.

    wave : a wave with the symbol k for its exponent and two symbols m1, m2 for its masses.
    missing : "raise" `lwa.NoSolitaryWave`, with the first such point, where there is no wave
        (k ≤ 1, G + H + I ≤ 0, V² ≤ 0), or return "nan" at these points.

    k and ω broadcast against each other. Raises `lwa.InputError` for any other wave, and for ω
    beyond 1e±150.

    >>> from lwa import Dimer, homogenize
    >>> homogenize(Dimer("m1", "m2")).pde.traveling_wave().numeric().width(1.5, [1.0, 0.2733])
    array([4.96729413, 7.59281573])
    """

    wave: CompactWave
    missing: Literal["raise", "nan"] = "raise"

    def __post_init__(self) -> None:
        one_of(self.missing, ("raise", "nan"), "missing")
        free = self._symbols
        given = set(
            self.wave.coefficient_sum.free_symbols | self.wave.speed_factor.free_symbols
        )
        if (
            len(set(free)) != 3
            or not all(x.is_Symbol for x in free)
            or not given <= set(free)
        ):
            raise InputError(
                "functions of (k, ω) need a symbol k and a cell of two masses that are symbols, "
                "m1 and m2, with equal contacts"
            )

    @property
    def _symbols(self) -> tuple[sp.Expr, ...]:
        """The symbol k and the distinct masses, in their order."""
        return (self.wave.k, *dict.fromkeys(self.wave.cell.masses))

    @cached_property
    def _compiled(self) -> Callable[..., Any]:
        """(G+H+I)/D², V²/B^{k-1} and (V²/B^{k-1} - 1)/(k - 1) as functions of k and the masses."""
        factor = self.wave.speed_factor
        excess = factored((factor - 1) / (self.wave.k - 1))
        masses = self._symbols[1:]

        def by_masses(part: sp.Expr) -> sp.Expr:
            terms = sp.Poly(part, *masses).terms()
            return sp.Add(
                *(sp.factor(c) * sp.prod(map(sp.Pow, masses, e)) for e, c in terms)
            )

        forms = [
            by_masses(top) / by_masses(bottom)
            for top, bottom in map(
                sp.fraction, (self.wave.coefficient_sum, factor, excess)
            )
        ]
        return sp.lambdify(self._symbols, forms, "numpy", cse=True)  # type: ignore[no-any-return]

    def beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The wavenumber β D = (k-1) / (2 √((G+H+I)/D²))."""
        k, coefficient_sum, *_ = self._wave(k, omega)
        return np.asarray((k - 1) / (2 * np.sqrt(coefficient_sum)))

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The number π/(βD) of sites under the wave."""
        return np.pi / self.beta(k, omega)

    def fwhm(self, k: ArrayLike, omega: ArrayLike, quantity: str = "strain") -> Array:
        """FWHM of strain, contact force or velocity in units of D (`lwa.TravelingWave.fwhm`)."""
        beta = self.beta(k, omega)
        k = np.asarray(k, np.float64)
        # arccos(2^-x) = arctan √(4^x - 1), which keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        return np.asarray(2 * np.arctan(np.sqrt(np.expm1(x * np.log(4.0)))) / beta)

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """Speed V = dx/dτ of the wave whose strain peaks at B."""
        k, _, factor, _ = self._wave(k, omega)
        return np.asarray(np.sqrt(factor) * _positive(B, "B") ** ((k - 1) / 2))

    def log_amplitude(
        self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0
    ) -> Array:
        """Logarithm of the peak strain B of the wave of speed V, finite where B is out of range."""
        k, _, factor, excess = self._wave(k, omega)
        less_one = (k - 1) * excess  # V²/B^{k-1} - 1
        near = (
            np.abs(less_one) < 0.5
        )  # log1p keeps the digits that V²/B^{k-1} loses at k → 1
        log_factor = np.where(
            near, np.log1p(np.where(near, less_one, 0.0)), np.log(factor)
        )
        return np.asarray((2 * np.log(_positive(V, "V")) - log_factor) / (k - 1))

    def _wave(
        self, k: ArrayLike, omega: ArrayLike
    ) -> tuple[Array, Array, Array, Array]:
        """Return k, (G+H+I)/D², V²/B^{k-1} and (V²/B^{k-1} - 1)/(k - 1), broadcast.

        At points without a wave all are NaN, or `lwa.NoSolitaryWave` is raised (``missing``).
        """
        k, omega = np.broadcast_arrays(finite(k, "k"), _positive(omega, "ω = m2/m1"))
        if not np.all((omega >= 1 / LARGEST) & (omega <= LARGEST)):
            raise InputError(
                f"ω = m2/m1 is not between {1 / LARGEST:g} and {LARGEST:g}"
            )
        with np.errstate(all="ignore"):  # outside the domain of waves
            coefficient_sum, factor, excess = self._compiled(k, 1.0, omega)
            conditions = {
                "k > 1": k > 1,
                "G+H+I > 0": coefficient_sum > 0,
                "V² > 0": factor > 0,
            }
            exists = np.logical_and.reduce(np.broadcast_arrays(*conditions.values()))
        if self.missing == "raise" and not np.all(exists):
            first = np.argmin(exists)
            missed = next(
                name
                for name, holds in conditions.items()
                if not np.broadcast_to(holds, k.shape).flat[first]
            )
            at = f"k = {float(k.flat[first])}, ω = {float(omega.flat[first])}"
            raise NoSolitaryWave(f"{at}: a compact wave needs {missed}")
        nan = np.where(exists, 0.0, np.nan)
        return k + nan, coefficient_sum + nan, factor + nan, excess + nan


def _positive(value: ArrayLike, name: str) -> Array:
    array = finite(value, name)
    if not np.all(array > 0):
        raise InputError(f"{name} is {array.min()}: it must be positive")
    return array
