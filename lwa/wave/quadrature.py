"""Waves on a background in float64: speed, width and profile for arrays of (p0, B).

`lwa.wave.background` writes V² = Q(B) and Q(B) - Q(v) as differences of W and F, which cancel. Here
they are integrals of F′ and F″, at the strains p = p0 + sB of the wave, over 0 < s < 1. Under a law
that stiffens the integrands keep one sign:

    Q(B)        = 2 ∫ (1-s) F′ ds,
    Q(B) - Q(v) = B ∫ K F″ ds,    K = (1-s)² for s > v/B,  (1-s)² - (1 - sB/v)² below.

With v = B (1 - y²), y = tanh θ, the profile of the wave is

    dξ/dθ = 2 √(I F′(p0+v) y² / (Q(B) - Q(v))).

All integrals run over one grid in θ, s = 1/cosh²θ, of Gauss panels. Towards s = 0, where F′ of an
unloaded contact is singular, the panels become longer; towards s = 1 they are halved until the
expansion of dξ/dθ in Legendre polynomials has converged, as steep laws, contacts about to open and
waves next to their limiting amplitude demand. K is a matrix on that grid. At small v the wave of
half the rise has the same form, so that a profile is a sequence of octaves.
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
from lwa.base.quantities import NoSolitaryWave, known
from lwa.cell import Cell
from lwa.law import ContactLaw
from lwa.linear.dispersion import Dispersion
from lwa.wave.panels import (
    CONVERGED,
    LEVELS,
    ROUNDING,
    Grid,
    gauss,
    grid,
    integrated,
    inverse,
    strains,
    value_at,
)

_BLOCK = 256
"""Waves computed at once; their samples stay in the processor's cache."""


@dataclass(frozen=True)
class NumericBackground(Value):
    """Speeds, widths and profiles of the waves of a cell under a law, for arrays of p0 and B.

    p0 and B broadcast; strains are those of `lwa.BackgroundWave`; lengths are in units of D for a
    spacing that is a symbol under a power law. The functions raise `lwa.NoSolitaryWave`, which
    names the place, for a p0 and B without a wave.

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
        slope = self.law.of_strain(_STRAIN, self._D, 1)
        free = (self._I.free_symbols | slope.free_symbols) - {_STRAIN}
        demand_numbers(free, "numbers are wanted")

    def latex_rows(self) -> list[str]:
        return self.law.latex_rows()

    def speed_squared(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Square V² = Q(B) of the speed; for power laws to k = 5 good to 4 ulps at any p0/B."""
        p0, B, unit = self._waves(p0, B)
        square = self._by_block(self._squares, p0, B)
        with np.errstate(over="ignore", under="ignore"):
            return np.asarray(square * self._scale(unit), np.float64)[()]

    def speed(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """Speed V = dx/dτ."""
        return np.sqrt(self.speed_squared(p0, B))

    def fwhm(self, p0: ArrayLike, B: ArrayLike, quantity: str = "strain") -> Array:
        """Full width at half maximum of the rise of "strain", "force" or "velocity"."""
        force = known(quantity) == "force"
        p0, B, _ = self._waves(p0, B)
        half = self._by_block(lambda p0, B: self._half_widths(p0, B, force), p0, B)
        return 2 * half[()]

    def profile(self, xi: ArrayLike, p0: float, B: float) -> Array:
        """Strain v(ξ) of one wave at the places ξ."""
        places = np.abs(finite(xi, "xi"))
        base, rise, unit = self._waves(p0, B)
        if base.ndim:
            raise InputError("p0 or B is an array: a profile is that of one wave")
        found = self._panels(base[None], rise[None], float(places.max(initial=0.0)))
        at, theta, lengths, rises, rows = (np.array(x) for x in zip(*found, strict=True))
        panel = np.searchsorted(at, places, side="right") - 1
        last = at[-1] + rows[-1].sum()  # P_n(1) = 1
        local = inverse(rows[panel], places - at[panel])
        v = unit * rises[panel] / np.cosh(theta[panel] + lengths[panel] * local) ** 2
        return np.asarray(np.where(places < last, v, 0.0), np.float64)

    # --- a block of waves -------------------------------------------------------------------

    @staticmethod
    def _by_block(function: Callable[[Array, Array], Array], p0: Array, B: Array) -> Array:
        base, rise = p0.ravel(), B.ravel()
        starts = range(0, max(len(base), 1), _BLOCK)
        parts = [function(base[i : i + _BLOCK], rise[i : i + _BLOCK]) for i in starts]
        return np.concatenate(parts).reshape(p0.shape)

    def _squares(self, p0: Array, B: Array) -> Array:
        """V² = F′(p0) + B ∫(1-s)² F″ ds for small waves, 2 ∫(1-s) F′ ds for others."""
        found = np.empty_like(p0)
        for rows, g, p, bend, _ in self._resolved(p0, B, rough=True):
            first, second = g.ds * g.y2, g.ds * g.y2**2  # weights of 1/2 and 1/3, but for rounding
            start = self._slope(p0[rows])
            change = B[rows] / 3 * (bend @ (second / second.sum()))
            small = np.abs(change) < start / 4
            direct = self._slope(p) @ (first / first.sum())
            found[rows] = np.where(small, start + change, direct)
        return found

    def _half_widths(self, p0: Array, B: Array, force: bool, deep: bool = False) -> Array:
        """The place ξ at which the strain, or the force, has half of its rise."""
        found = np.empty_like(p0)
        for rows, g, p, _, rate in self._resolved(p0, B, deep):
            part, (_, w) = g.panels(rate), gauss()
            pieces = part @ w * g.lengths
            if not force:
                found[rows] = pieces.sum(axis=1)
                continue
            fall = self._slope(p) * g.ds
            sums = np.cumsum(g.panels(fall).sum(axis=2), axis=1)
            half = fall.sum(axis=1) / 2
            panel = (sums < half[:, None]).sum(axis=1)
            if not deep and np.any(late := panel == sums.shape[1]):
                at = rows[late]
                found[at] = self._half_widths(p0[at], B[at], True, True)
                rows, half, panel, fall, part, pieces, sums = (
                    x[~late] for x in (rows, half, panel, fall, part, pieces, sums)
                )
            each = np.arange(len(rows)), np.minimum(panel, sums.shape[1] - 1)
            before = sums[each] - g.panels(fall)[each].sum(axis=1)
            local = inverse(g.panels(fall)[each] / w @ integrated().T, half - before)
            more = value_at(part[each] @ integrated().T, local) * g.lengths[each[1]]
            ahead = np.cumsum(pieces, axis=1)[each] - pieces[each] + more
            found[rows] = np.where(panel < sums.shape[1], ahead, np.nan)
        return found

    def _resolved(
        self, p0: Array, B: Array, deep: bool = False, rough: bool = False
    ) -> Iterator[tuple[NDArray[np.intp], Grid, Array, Array, Array]]:
        """Yield (indices of waves, a grid that resolves them, p and F″ at its nodes, dξ/dθ).

        Waves that no grid resolves raise `lwa.InputError` or, if ``rough``, get the finest grid.
        """
        rows = np.arange(len(p0))
        for level in LEVELS:
            g = grid(*level, deep)
            base, rise = p0[rows], B[rows]
            p, bend, rate = self._rates(g, base, rise, np.zeros_like(base))
            last = level == LEVELS[-1]
            good = g.converged(rate, ROUNDING if last else CONVERGED) | (last and rough)
            yield rows[good], g, p[good], bend[good], rate[good]
            rows = rows[~good]
            if not len(rows):
                return
        i = rows[0]
        raise InputError(
            f"p0 = {p0[i]:.6g}, B = {B[i]:.6g}: the law changes too much over the wave for "
            "float64; `lwa.BackgroundWave` computes with more digits"
        )

    def _rates(self, g: Grid, p0: Array, B: Array, passed: Array) -> tuple[Array, Array, Array]:
        """Compute p and F″ at the nodes, and dξ/dθ at the upper nodes.

        passed : Q of the whole wave less Q(B), for the part of its flank below B.
        """
        p = strains(g, p0, B)
        n = len(g.kernel)
        with np.errstate(all="ignore"):
            bend = self._bend(p)
            gap = (passed / B)[:, None] / g.y2[:n] + bend @ g.kernel.T  # (Q(B) - Q(v)) / (B y²)
            size, sign = np.sqrt(np.abs(B))[:, None], np.sign(B)[:, None]
            root = np.sqrt(self._slope(p[:, :n])) / np.sqrt(sign * gap)
            return p, bend, 2 * self._root_I / size * root

    def _panels(
        self, p0: Array, B: Array, reach: float
    ) -> list[tuple[float, float, float, float, Array]]:
        """Panels of one wave to ξ = ``reach``: (ξ and θ at the start, length, B, ξ - ξ(start)).

        The last entry is a row of Legendre coefficients. Below v = B/2 the profile is computed as
        that of a wave of rise B/2, with Q(B) - Q(v) corrected by the integral above.
        """
        rows, at, passed, least = [], 0.0, np.zeros(1), _LEAST * abs(B[0])
        ((_, g, _, bend, rate),) = (x for x in self._resolved(p0, B) if len(x[0]))
        while True:
            for j, values in enumerate(g.panels(rate)[0]):
                coefficients = integrated() @ values * g.lengths[j]
                rows.append((at, g.starts[j], g.lengths[j], B[0], coefficients))
                at += float(coefficients.sum())
            end = float(g.starts[-1] + g.lengths[-1])
            passed = passed + B * np.tanh(end) ** 2 * (bend @ g.last)
            B, g = B / np.cosh(end) ** 2, grid(2)  # Q(v) = Q(B) at θ = iπ/4
            if at > reach or abs(B[0]) < least:
                return rows
            _, bend, rate = self._rates(g, p0, B, passed)
            if not g.converged(rate)[0]:
                raise InputError(f"p0 = {p0[0]:.6g}: no profile to ξ = {reach:.6g} in float64")

    # --- the law ----------------------------------------------------------------------------

    @property
    def _D(self) -> sp.Expr:
        """The spacing, or 1 for a symbol under a power law, which has no length of its own."""
        D = self.cell.spacing
        return sp.S.One if D.is_Symbol and self.law.homogeneous else D

    @cached_property
    def _I(self) -> sp.Expr:
        return Dispersion(self.cell, self.law.exponent).I * self._D**2

    @cached_property
    def _root_I(self) -> float:
        return number(sp.sqrt(self._I))

    @cached_property
    def _slope(self) -> Callable[[Array], Array]:
        return _compiled(self.law.of_strain(_STRAIN, self._D, 1))

    @cached_property
    def _bend(self) -> Callable[[Array], Array]:
        return _compiled(self.law.of_strain(_STRAIN, self._D, 2))

    def _scale(self, unit: Array) -> Any:
        """The factor unit^{k-1} of V², in extended precision."""
        if not self.law.homogeneous:
            return 1.0
        return unit.astype(np.longdouble) ** np.longdouble(str(sp.N(self.law.exponent - 1, 25)))

    # --- existence --------------------------------------------------------------------------

    def _waves(self, p0: ArrayLike, B: ArrayLike) -> tuple[Array, Array, Array]:
        """Return p0/unit, B/unit and unit, broadcast; unit is 1, or a power of two for δ^k."""
        base, rise = np.broadcast_arrays(finite(p0, "p0"), finite(B, "B"))
        if not np.all(rise):
            raise InputError("B is 0: a wave rises or falls by B")
        with np.errstate(all="ignore"):
            if self.law.homogeneous:
                excess = float(self.law.exponent - 1)
                exists = (base >= 0) & (excess * rise > 0) & (base + rise > 0)
            else:
                pieces = (base, rise)
                exists = self._by_block(self._exists, *pieces).astype(bool)
        if not np.all(exists):
            i = int(np.argmin(exists))
            raise NoSolitaryWave(
                f"p0 = {base.flat[i]}, B = {rise.flat[i]}: there is no wave unless contacts stay "
                "closed, F′ > 0, and speeds grow towards B"
            )
        unit = np.ones_like(base)
        if self.law.homogeneous:  # a power of two, by which nothing is rounded
            unit = np.ldexp(0.5, np.frexp(np.maximum(base, base + rise))[1])
        return base / unit, rise / unit, unit

    def _exists(self, p0: Array, B: Array) -> Array:
        """1.0 for each wave that exists, 0 < F′ < ∞, B Q′(B) > 0, Q(v) < Q(B) below B; else 0.0."""
        g = grid(*LEVELS[1])
        good = np.isfinite(self._slope(p0 + B)) & (self._slope(p0 + B) > 0)
        passed = np.zeros_like(p0)
        for _ in range(20):  # to v = 1e-6 B
            p = strains(g, p0, B)
            bend = self._bend(p)
            gap = passed[:, None] / g.y2[: len(g.kernel)] + B[:, None] * (bend @ g.kernel.T)
            good &= (self._slope(p) > 0).all(axis=1) & (gap > 0).all(axis=1)
            good &= passed + B * (bend @ g.first) > 0
            end = float(g.starts[-1] + g.lengths[-1])
            passed = passed + B * np.tanh(end) ** 2 * (bend @ g.last)
            B = B / np.cosh(end) ** 2
        return good.astype(np.float64)


_STRAIN = sp.Symbol("p", positive=True)

_LEAST = 1e-280
"""Strains of a profile, relative to the peak, below which they are taken as 0."""


def _compiled(value: sp.Expr) -> Callable[[Array], Array]:
    """Compile an expression in the strain to a function of arrays."""
    long = {x: sp.Float(x, 17) for x in value.atoms(sp.Rational) if x.p.bit_length() > 53}
    function = sp.lambdify(_STRAIN, value.xreplace(long), "numpy")

    def evaluated(p: Array) -> Array:
        result = np.asarray(function(p), np.float64)
        return result if result.shape == p.shape else np.full_like(p, result)

    return evaluated
