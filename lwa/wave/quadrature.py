"""Waves on a background in float64: speed, width and profile for arrays of (p0, B).

`lwa.wave.background` writes V² = Q(B) and Q(B) - Q(v) as differences of W and F, which cancel. Here
they are integrals of F′ and F″, at the strains p = p0 + sB of the wave, over 0 < s < 1. Under a law
that stiffens the integrands keep one sign:

    Q(B)        = 2 ∫ (1-s) F′ ds,
    Q(B) - Q(v) = B ∫ K F″ ds,    K = (1-s)² for s > v/B,  (1-s)² - (1 - sB/v)² below.

With v = B (1 - y²), y = tanh θ, the profile of the wave is

    dξ/dθ = 2 √(I F′(p0+v) y² / (Q(B) - Q(v))).

All integrals run over one grid in θ, s = 1/cosh²θ (`lwa.wave.panels`), which is refined until the
expansion of dξ/dθ in Legendre polynomials has converged.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError, demand_numbers, number
from lwa.base.frozen import Value
from lwa.base.quantities import (
    NOT_RISING,
    NOT_STIFFENING,
    NoSolitaryWave,
    known_quantity,
    refusal_under_power,
)
from lwa.cell import Cell
from lwa.law import ContactLaw
from lwa.linear.dispersion import Dispersion
from lwa.wave.panels import (
    FAR,
    LEVELS,
    NEAR,
    Grid,
    gauss,
    grid,
    integrated,
    inverse,
    value_at,
)

Function = Callable[[Array], Array]

_BLOCK = 256  # waves computed at once; their samples stay in the processor's cache
_CONVERGED = 1e-13  # bound on the last Legendre coefficients of dξ/dθ
_ROUNDING = 1e-9  # the bound on the finest panels, where p has rounding errors near a pole
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
        self._functions  # noqa: B018 - symbols are refused here

    def speed_squared(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Square V² = Q(B) of the speed; for power laws to k = 5 good to 4 ulps at any p0/B."""
        p0, B, unit = self._waves(p0, B)
        square: Any = _by_block(self._squares, p0, B)
        if self.law.homogeneous:  # V² scales as strain^{k-1}; extended precision keeps the ulps
            with np.errstate(over="ignore", under="ignore"):
                excess = np.longdouble(str(sp.N(self.law.exponent - 1, 25)))
                square = square * unit.astype(np.longdouble) ** excess
        return np.asarray(square, np.float64)[()]

    def speed(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Speed V = dx/dτ."""
        return np.sqrt(self.speed_squared(p0, B))

    def fwhm(self, p0: ArrayLike, B: ArrayLike, quantity: str = "strain") -> Array:
        """Full width at half maximum of the rise of "strain", "force" or "velocity"."""
        half_width = (
            self._force_half_width if known_quantity(quantity) == "force" else self._half_width
        )
        p0, B, _ = self._waves(p0, B)
        return 2 * _by_block(half_width, p0, B)[()]

    def profile(self, xi: ArrayLike, p0: float, B: float) -> Array:
        """Strain v(ξ) of one wave at the places ξ; 0 where it is below 1e-34 B."""
        places = np.abs(finite(xi, "xi"))
        base, rise, unit = self._waves(p0, B)
        if base.ndim:
            raise InputError("p0 or B is an array: a profile is that of one wave")
        *_, (_, g, _, _, rate) = self._resolved(base[None], rise[None], FAR)
        series = g.panels(rate)[0] @ integrated().T * g.lengths[:, None]  # ξ along each panel
        ends = np.cumsum(series.sum(axis=1))  # P_n(1) = 1
        panel = np.minimum(np.searchsorted(ends, places, side="right"), len(ends) - 1)
        ahead = places - (ends - series.sum(axis=1))[panel]
        theta = g.starts[panel] + g.lengths[panel] * inverse(series[panel], ahead)
        return np.where(places < ends[-1], unit * rise / np.cosh(theta) ** 2, 0.0)

    def _squares(self, p0: Array, B: Array) -> Array:
        """The square V² = F′(p0) + B ∫(1-s)² F″ ds for small waves, 2 ∫(1-s) F′ ds for others."""
        square, slope = np.empty_like(p0), self._functions[1]
        for rows, g, p, bend, _ in self._resolved(p0, B, rough=True):
            first, second = g.ds * g.y2, g.ds * g.y2**2  # weights of 1/2 and 1/3, but for rounding
            start = slope(p0[rows])
            change = B[rows] / 3 * (bend @ (second / second.sum()))
            small = np.abs(change) < start / 4
            direct = slope(p) @ (first / first.sum())
            square[rows] = np.where(small, start + change, direct)
        return square

    def _half_width(self, p0: Array, B: Array) -> Array:
        """The place ξ at which the strain has half of its rise."""
        half = np.empty_like(p0)
        for rows, g, _, _, rate in self._resolved(p0, B):
            half[rows] = (g.panels(rate) @ gauss()[1] * g.lengths)[:, : g.half].sum(axis=1)
        return half

    def _force_half_width(self, p0: Array, B: Array) -> Array:
        """The place ξ at which the force has half of its rise."""
        half, w = np.empty_like(p0), gauss()[1]
        for rows, g, p, _, rate in self._resolved(p0, B, NEAR):
            fall = self._functions[1](p) * g.ds  # of the force from one node to the next, over B
            falls = g.panels(fall)
            sums = np.cumsum(falls.sum(axis=2), axis=1)
            middle = fall.sum(axis=1) / 2
            panel = (sums < middle[:, None]).sum(axis=1)
            last = np.minimum(panel, len(g.starts) - 1)
            at = np.arange(len(rows)), last
            ahead = middle - (sums[at] - falls[at].sum(axis=1))
            local = inverse(falls[at] / w @ integrated().T, ahead)
            part, lengths = g.panels(rate), g.panels(rate) @ w * g.lengths
            place = (np.cumsum(lengths, axis=1) - lengths)[at]
            place += value_at(part[at] @ integrated().T, local) * g.lengths[last]
            half[rows] = np.where(panel == last, place, np.nan)
        return half

    def _resolved(
        self, p0: Array, B: Array, further: tuple[float, ...] = (), rough: bool = False
    ) -> Iterator[tuple[NDArray[np.intp], Grid, Array, Array, Array]]:
        """Yield (indices of waves, a grid that resolves them, p and F″ at its nodes, dξ/dθ).

        Waves that no grid resolves raise `lwa.InputError` or, if ``rough``, get the finest grid.
        """
        rows, (root_I, slope, _) = np.arange(len(p0)), self._functions
        for level in LEVELS:
            g, last = grid(*level, further), level == LEVELS[-1]
            p, bend, gap = self._sampled(g, p0[rows], B[rows])
            with np.errstate(all="ignore"):
                # Roots first: their quotient neither over- nor underflows.
                size, sign = np.sqrt(np.abs(B[rows]))[:, None], np.sign(B[rows])[:, None]
                root = np.sqrt(slope(p[:, : len(g.kernel)])) / np.sqrt(sign * gap)
                rate = 2 * root_I / size * root
            good = g.converged(rate, _ROUNDING if last else _CONVERGED) | (last and rough)
            yield rows[good], g, p[good], bend[good], rate[good]
            rows = rows[~good]
            if not len(rows):
                return
        i = rows[0]
        raise InputError(
            f"p0 = {p0[i]:.6g}, B = {B[i]:.6g}: the law changes too much over the wave for "
            "float64; `lwa.BackgroundWave` computes with more digits"
        )

    def _sampled(self, g: Grid, p0: Array, B: Array) -> tuple[Array, Array, Array]:
        """Compute p and F″ at the nodes, and (Q(B) - Q(v)) / (B y²) at the upper nodes."""
        # From p0 or p0 + B, whichever is nearer: p has its digits next to a pole at either.
        near = (p0 + B)[:, None] - B[:, None] * g.y2
        p = np.where(g.y2 < 0.5, near, p0[:, None] + B[:, None] * g.s)
        with np.errstate(all="ignore"):
            bend = self._functions[2](p)
            return p, bend, bend @ g.kernel.T

    @cached_property
    def _functions(self) -> tuple[float, Function, Function]:
        """The number √I, and the law's F′ and F″ compiled as functions of the strain."""
        D = self.cell.spacing
        if D.is_Symbol and self.law.homogeneous:  # a power law has no length of its own
            D = sp.S.One
        I = Dispersion(self.cell, self.law.exponent).I * D**2
        slope, bend = (self.law.of_strain(_STRAIN, D, n) for n in (1, 2))
        demand_numbers((I.free_symbols | slope.free_symbols) - {_STRAIN}, "numbers are wanted")
        return number(sp.sqrt(I)), _compiled(slope), _compiled(bend)

    def _waves(self, p0: ArrayLike, B: ArrayLike) -> tuple[Array, Array, Array]:
        """Return p0/unit, B/unit and unit, broadcast; unit is 1, or a power of two for δ^k."""
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
            rises, stiffens = _by_block(self._checks, base, rise)
            exists = rises & stiffens
        if not np.all(exists):
            i = int(np.argmin(exists))
            start, height = base.flat[i], rise.flat[i]
            if self.law.homogeneous:
                excess = self.law.exponent - 1
                reason = refusal_under_power(excess, sp.Float(start), sp.Float(height))
            else:
                reason = NOT_STIFFENING if rises.flat[i] else NOT_RISING
            raise NoSolitaryWave(f"p0 = {start}, B = {height}: {reason}")
        return base / unit, rise / unit, unit

    def _checks(self, p0: Array, B: Array) -> Array:
        """Test two conditions, a row each: 0 < F′ < ∞; B Q′(B) > 0 and Q(v) < Q(B) below B."""
        g, slope = grid(*LEVELS[1], FAR), self._functions[1]
        p, bend, gap = self._sampled(g, p0, B)
        with np.errstate(all="ignore"):
            top = slope(p0 + B)
            slopes = np.column_stack([slope(p), top])
            rises = np.column_stack([gap, bend @ (2 * g.s * g.y2 * g.ds)])  # the last is Q′(B)
        good = (slopes > 0).all(axis=1) & np.isfinite(top)
        return np.stack([good, (B[:, None] * rises > 0).all(axis=1)])


def _by_block(function: Callable[[Array, Array], Array], p0: Array, B: Array) -> Array:
    """Apply a function of two flat arrays to blocks of broadcast ones; results may have rows."""
    base, rise = p0.ravel(), B.ravel()
    starts = range(0, max(len(base), 1), _BLOCK)
    parts = [function(base[i : i + _BLOCK], rise[i : i + _BLOCK]) for i in starts]
    return np.concatenate(parts, axis=-1).reshape((*parts[0].shape[:-1], *p0.shape))


def _compiled(value: sp.Expr) -> Function:
    """Compile an expression in the strain to a function of arrays."""
    # NumPy has no integers of more than 63 bits.
    long = {x: sp.Float(x, 17) for x in value.atoms(sp.Rational) if x.p.bit_length() > 53}
    function = sp.lambdify(_STRAIN, value.xreplace(long), "numpy")

    return lambda p: np.broadcast_to(np.asarray(function(p), np.float64), p.shape)
