"""The compact wave's closed forms in float64: NumPy functions of arrays of k and m2/m1, or ω.

The functions are those that `lwa.wave.source` writes, compiled; lengths are in units of D. Relative
errors are below 1e-11 where (G + H + I)/D² and ``V²/B^{k-1}`` are above 1e-3; nearer to the edge of
the domain of waves, where one of the two vanishes, they grow (`lwa.wave.source`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError
from lwa.base.frozen import NoSolitaryWave, Value, known_quantity
from lwa.base.words import QuantityName, one_of
from lwa.wave.arch import Arch
from lwa.wave.source import Functions, wave_functions

LARGEST = 1e6
"""Largest mass ratio: V² is of the size of its reciprocal's square, 1e-12, and cancels to 1e-4."""

Missing = Literal["raise", "nan"]
"""Answers where no wave exists: raise `lwa.NoSolitaryWave`, or return NaN."""


@dataclass(frozen=True)
class NumericWave(Value):
    """β, width, FWHM, speed and amplitude of an N:1 dimer's wave, for arrays of k and ω.

    The arguments k and ω of the methods broadcast against each other.

    Parameters
    ----------
    wave : Arch
        Closed forms of the wave; k and the two different masses of its cell are symbols.
    missing : {"raise", "nan"}
        Raise `lwa.NoSolitaryWave` with the first point without a wave (``k ≤ 1``,
        ``G + H + I ≤ 0``, ``V² ≤ 0``), or return NaN at these points.

    Raises
    ------
    InputError
        For another wave, and for ω beyond 1e±6.

    Examples
    --------
    >>> from lwa import Dimer, homogenize
    >>> homogenize(Dimer("m1", "m2")).pde.traveling_wave().numeric().width(1.5, [1.0, 0.2733])
    array([4.96729413, 7.59281573])
    """

    wave: Arch
    missing: Missing = "raise"

    def __post_init__(self) -> None:
        one_of(self.missing, get_args(Missing), "missing")  # refuses any other word
        symbols = {self.wave.k, *self.wave.cell.masses}
        held = sp.Tuple(self.wave.coefficient_sum, self.wave.speed_factor).free_symbols
        named = all(x.is_Symbol for x in symbols)
        if len(symbols) != 3 or not named or not held <= symbols:
            raise InputError(
                "functions of (k, ω) need a symbol k and a cell of two masses that are symbols, "
                "m1 and m2, with equal contacts"
            )

    @cached_property
    def _functions(self) -> Functions:
        """The wave's functions as expressions, by their names."""
        return wave_functions(self.wave)

    @cached_property
    def _compiled(self) -> Mapping[str, Callable[..., Any]]:
        """The functions of the wave by their names."""
        compiled: dict[str, Callable[..., Any]] = {}
        # A function may call the functions before it: they are compiled first.
        for f in self._functions.values():
            modules = [dict(compiled), "numpy"]
            compiled[f.name] = sp.lambdify(f.arguments, f.value, modules, cse=True)
        return compiled

    def beta(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The wavenumber ``β D = (k-1) / (2 √((G+H+I)/D²))``."""
        return self._values("beta", k, omega)

    def width(self, k: ArrayLike, omega: ArrayLike) -> Array:
        """The number π/(βD) of sites under the wave."""
        return self._values("width", k, omega)

    def fwhm(
        self, k: ArrayLike, omega: ArrayLike, quantity: QuantityName = "strain"
    ) -> Array:
        """FWHM of strain, contact force or velocity in units of D (`lwa.CompactWave.fwhm`)."""
        name = f"fwhm_{known_quantity(quantity)}"
        return self._values(name, k, omega)

    def speed(self, k: ArrayLike, omega: ArrayLike, B: ArrayLike = 1.0) -> Array:
        """Speed ``V = dx/dτ`` of the wave whose strain peaks at B."""
        return self._values("speed", k, omega, _positive(B, "B"))

    def log_amplitude(
        self, k: ArrayLike, omega: ArrayLike, V: ArrayLike = 1.0
    ) -> Array:
        """Logarithm of the peak strain B of the wave of speed V, finite where B is out of range.

        It is ``ln B = (ln V² - ln f)/(k-1)``, ``f = V²/B^{k-1}`` the wave's speed factor.
        """
        log_square = 2 * np.log(_positive(V, "V"))
        log_factor = self._values("log_speed_factor", k, omega)
        return (log_square - log_factor) / (np.asarray(k, np.float64) - 1)

    def _values(
        self, name: str, k: ArrayLike, omega: ArrayLike, *first: Array
    ) -> Array:
        """Values of a function of the wave; ``first`` are its arguments B or V."""
        return self._called(name, *self._points(k, omega), *first)

    def _called(self, name: str, k: Array, omega: Array, *first: Array) -> Array:
        """Values of a function, or floats without a meaning where there is no wave."""
        # The closed forms are homogeneous in the masses, and lengths are in units of D.
        m1, m2 = dict.fromkeys(self.wave.cell.masses)
        numbers = {self.wave.k: k, m1: 1.0, m2: omega, self.wave.D: 1.0}
        # B or V, which come first, are no symbols of the chain.
        arguments = self._functions[name].arguments[len(first) :]
        with np.errstate(all="ignore"):  # outside of the domain of waves
            found = self._compiled[name](*first, *map(numbers.get, arguments))
        return np.asarray(found)

    def _points(self, k: ArrayLike, omega: ArrayLike) -> tuple[Array, Array]:
        """Read points (k, ω); treat points without a wave as ``missing`` says, by a k of NaN."""
        k, omega = np.broadcast_arrays(finite(k, "k"), _positive(omega, "ω = m2/m1"))
        if not np.all((omega >= 1 / LARGEST) & (omega <= LARGEST)):
            raise InputError(
                f"ω = m2/m1 is not between {1 / LARGEST:g} and {LARGEST:g}"
            )
        # The conditions for a wave, in the words of the refusal
        conditions = {
            "k > 1": k > 1,
            "G+H+I > 0": self._called("coefficient_sum", k, omega) > 0,
            "V² > 0": self._called("speed_factor", k, omega) > 0,
        }
        for name, holds in conditions.items():
            if self.missing == "raise" and not np.all(holds):
                first = np.argmin(np.broadcast_to(holds, k.shape))
                raise NoSolitaryWave(
                    f"k = {float(k.flat[first])}, ω = {float(omega.flat[first])}: "
                    f"a compact wave needs {name}"
                )
            k = np.where(holds, k, np.nan)
        return k, omega


def _positive(value: ArrayLike, name: str) -> Array:
    """Read an array of positive numbers."""
    array = finite(value, name)
    if not np.all(array > 0):
        raise InputError(f"{name} is {array.min()}: it must be positive")
    return array
