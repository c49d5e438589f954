"""Waves on a background in float64, for arrays of (p0, B), by `lwa.wave.quadrature`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array, finite, function_of
from lwa.base.exact import InputError, demand_numbers, number
from lwa.base.frozen import Value
from lwa.base.quantities import (
    NoSolitaryWave,
    known_quantity,
    refusal_under_power,
)
from lwa.cell import Cell
from lwa.law import ContactLaw
from lwa.linear.dispersion import Dispersion
from lwa.wave.quadrature import Quadrature

_BLOCK = 256  # waves computed at once; their samples stay in the processor's cache
_STRAIN = sp.Symbol("p", positive=True)


@dataclass(frozen=True)
class NumericBackground(Value):
    """Speeds, widths and profiles of the waves of a cell under a law, for arrays of p0 and B.

    p0 and B broadcast; strains are those of `lwa.BackgroundWave`; lengths are in units of D for a
    spacing that is a symbol under a power law. The functions raise `lwa.NoSolitaryWave`, with p0
    and B, where there is no wave.

    Raises `lwa.InputError` for symbols among masses, stiffnesses and the law's parameters, for
    arguments that are not finite, and for a law that changes too much over a wave for float64.

    >>> from lwa import Power, background_wave
    >>> numeric = background_wave(Cell([1]), law=Power("3/2")).numeric()
    >>> numeric.fwhm([1e-12, 1.0], 1.0).round(9)
    array([1.80837653, 3.15563101])
    """

    cell: Cell
    law: ContactLaw

    def __post_init__(self) -> None:
        self._rule  # noqa: B018 - symbols are refused here

    def speed_squared(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Square V² = Q(B) of the speed; for power laws to k = 5 good to 8 ulps at any p0/B."""
        p0, B, unit = self.scaled(p0, B)
        square = _by_block(self._rule.squares, p0, B)
        if self.law.homogeneous:
            square = _rescaled(square, unit, self.law.exponent - 1)
        return square[()]

    def speed(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Speed V = dx/dτ."""
        return np.sqrt(self.speed_squared(p0, B))

    def fwhm(self, p0: ArrayLike, B: ArrayLike, quantity: str = "strain") -> Array:
        """Full width at half maximum of the rise of "strain", "force" or "velocity"."""
        rate = (lambda p, F1: F1) if known_quantity(quantity) == "force" else None
        p0, B, _ = self.scaled(p0, B)
        return 2 * _by_block(partial(self._rule.half_widths, rate=rate), p0, B)[()]

    def profile(self, xi: ArrayLike, p0: float, B: float) -> Array:
        """Strain v(ξ) of one wave at the places ξ, right to 1e-9 of the larger of v and B/1000."""
        places = np.abs(finite(xi, "xi"))
        base, rise, unit = self.scaled(p0, B)
        if base.ndim:
            raise InputError("p0 or B is an array: a profile is that of one wave")
        ratio = self._rule.profile(base[None], rise[None], places.ravel())
        return np.asarray(unit * rise * ratio.reshape(places.shape))

    @cached_property
    def _rule(self) -> Quadrature:
        """The quadrature with the number I, and the law's F′ and F″ compiled."""
        D = self.cell.spacing
        if D.is_Symbol and self.law.homogeneous:  # a power law has no length of its own
            D = sp.S.One
        I = Dispersion(self.cell, self.law.exponent).I * D**2
        slope, bend = (self.law.of_strain(_STRAIN, D, n) for n in (1, 2))
        demand_numbers((I.free_symbols | slope.free_symbols) - {_STRAIN}, "numbers are wanted")
        value, F1, F2 = number(I), function_of(_STRAIN, slope), function_of(_STRAIN, bend)
        return Quadrature(lambda p: (F1(p), F2(p), np.full(p.shape, value)))

    def scaled(self, p0: ArrayLike, B: ArrayLike) -> tuple[Array, Array, Array]:
        """Return p0/unit, B/unit and unit, broadcast; unit is 1, or a power of two for δ^k.

        Raises `lwa.NoSolitaryWave` where there is no wave.
        """
        base, rise = np.broadcast_arrays(finite(p0, "p0"), finite(B, "B"))
        if not np.all(rise):
            raise InputError("B is 0: a wave rises or falls by B")
        unit = np.ones_like(base)
        if self.law.homogeneous:
            sign = float(sp.sign(self.law.exponent - 1))
            with np.errstate(over="ignore"):
                exists = (base >= 0) & (sign * rise > 0) & (base + rise > 0)
                unit = np.ldexp(0.5, np.frexp(np.maximum(base, base + rise))[1])  # rounds nothing
        else:
            reasons = _by_block(self._rule.refusals, base, rise)
            exists = reasons == ""
        if not np.all(exists):
            i = int(np.argmin(exists))
            start, height = base.flat[i], rise.flat[i]
            if self.law.homogeneous:
                excess = self.law.exponent - 1
                reason = refusal_under_power(excess, sp.Float(start), sp.Float(height))
            else:
                reason = reasons.flat[i]
            raise NoSolitaryWave(f"p0 = {start}, B = {height}: {reason}")
        return base / unit, rise / unit, unit


def _rescaled(square: Array, unit: Array, excess: sp.Expr) -> Array:
    """The product V² · unit^{k-1}, unit = 2^e, without the rounding error of e (k-1)."""
    e = np.frexp(unit)[1] - 1
    high = float(np.float32(excess))
    whole = np.floor(e * high)
    part = e * high - whole + e * float(excess - sp.Rational(high))
    with np.errstate(over="ignore", under="ignore"):
        return np.asarray(np.ldexp(square * np.exp2(part), whole.astype(int)))


def _by_block(
    function: Callable[[Array, Array], NDArray[Any]], p0: Array, B: Array
) -> NDArray[Any]:
    """Apply a function of two flat arrays to blocks of broadcast ones; results may have rows."""
    base, rise = p0.ravel(), B.ravel()
    starts = range(0, max(len(base), 1), _BLOCK)
    parts = [function(base[i : i + _BLOCK], rise[i : i + _BLOCK]) for i in starts]
    return np.concatenate(parts, axis=-1).reshape((*parts[0].shape[:-1], *p0.shape))
