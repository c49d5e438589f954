"""Waves on a background in float64: speed, width and profile for arrays of (p0, B).

What `compressed` writes as differences of W and F cancels where the wave is small beside the
load. Here differences are integrals of F′ and F″ over the strains of the wave, by Gauss's rule,

    V² = 2∫(1-s) F′(p0+sB) ds,    c = F′(p1) - V² = B∫(1-s²) F″(p1-sB) ds,
    n = (F(p1) - F(p0))/B - V² = B∫s(1-s) F″(p1-sB) ds,    p1 = p0 + B,

of one sign under a law that stiffens, so that nothing cancels. Where F′ is no polynomial on that
scale, as next to δ = 0, which the last coefficients of its expansion in Legendre polynomials tell,
the differences themselves are taken, which then lose little. With v = B (1 - y²), y = tanh θ,

    dξ/dθ = 2 (v/B) √(I F′(p0+v) / X),    X = 2n - y² (c - y² B ∫(1-s)² F″(p1 - s y² B) ds),

where the last integral is over strains far from p0 and always smooth: at fixed θ it is a matrix
times F″ at fixed places, and the width the integral of a polynomial in θ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, known
from lwa.law import Power
from lwa.wave.closed import LoadedWave
from lwa.wave.gauss import (
    DEEPEST,
    SMOOTH,
    STRAIN,
    THETA,
    Function,
    blocks,
    compiled,
    expansion,
    fitted,
    gauss,
    is_smooth,
    root,
)

_FEW = 16
"""Up to p0 = 4 B the definition of V² cancels less than extended precision has to spare."""

_MOST_PANELS = 350
"""Of θ; 1/cosh² θ is next to nothing for a float there."""


@dataclass(frozen=True)
class NumericBackground(Value):
    """V², V, widths and profiles of a cell's waves, for arrays of p0 and B that broadcast.

    Strains are as in `lwa.BackgroundWave`, whose p0 does not matter here; lengths are in D where D
    is a symbol. Where there is no wave the functions raise `lwa.NoSolitaryWave` and name the place.

    Raises `lwa.InputError` where masses, stiffnesses or the law's parameters are symbols, and for
    arguments that are not finite.

    >>> from lwa import Cell, Power, background_wave
    >>> numeric = background_wave(Cell([1]), law=Power("3/2")).numeric()
    >>> numeric.fwhm([1e-12, 1.0], 1.0).round(9)
    array([1.80837653, 3.15563101])
    """

    wave: LoadedWave

    def __post_init__(self) -> None:
        if free := self._I.free_symbols | self._slope_of(1).free_symbols - {STRAIN}:
            raise InputError(f"{min(map(str, free))!r} has no value: numbers are wanted")

    # --- what is asked for ------------------------------------------------------------------

    def speed_squared(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """V², good to 4 ulps for Hertz contacts at any p0/B."""
        return self._squared(*self._waves(p0, B))

    def speed(self, p0: ArrayLike, B: ArrayLike) -> Array:
        """V = dx/dτ."""
        return np.sqrt(self.speed_squared(p0, B))

    def fwhm(self, p0: ArrayLike, B: ArrayLike, quantity: str = "strain") -> Array:
        """Full width at half maximum of the rise of "strain", "force" or "velocity"."""
        p0, B = self._waves(p0, B)
        width = np.empty(p0.shape)
        pieces = (x.ravel() for x in (p0, B))
        for base, rise, part in zip(*map(blocks, (*pieces, width.ravel())), strict=True):
            part[:] = self._widths(base, rise, known(quantity))
        return width[()]

    def _widths(self, p0: Array, B: Array, quantity: str) -> Array:
        theta, tails, integral = expansion()
        y2 = np.tanh(theta) ** 2
        p1 = (p0 + B)[:, None]
        bend = self._bend(p1 - DEEPEST * gauss().s * B[:, None])
        slope = self._slope(p1 - y2 * B[:, None])
        n, c = self._moments(p0, B)
        X = 2 * n[:, None] - y2 * (c[:, None] - y2 * B[:, None] * (bend @ tails.T))
        with np.errstate(invalid="ignore", divide="ignore"):
            rate = (1 - y2) * np.sqrt(slope / X)
        half = np.full_like(B, np.arccosh(np.sqrt(2.0)))
        if quantity == "force":
            rise = self._slope(p0 + B) - c + n  # (F(p1) - F(p0))/B
            fall = 2 * slope * (1 - y2) * np.sqrt(y2)  # of F with θ, over B
            half = root(fall, rise / 2)
        length = legendre.legval(2 * half / THETA - 1, (rate @ integral.T).T, tensor=False)
        width: Array = 4.0 * self._root_I * np.asarray(length, np.float64)
        for i in np.flatnonzero(self._strange(bend, rate)):  # one by one, in many digits
            found = self.wave.on(sp.Rational(p0[i])).fwhm(sp.Rational(B[i]), quantity)
            width[i] = float(found)
        return width

    def profile(self, xi: ArrayLike, p0: float, B: float) -> Array:
        """v(ξ) of one wave at any places ξ."""
        base, rise = (float(x) for x in self._waves(p0, B))
        places = np.abs(np.asarray(xi, np.float64))
        if not np.all(np.isfinite(places)):
            raise InputError("xi must be finite")
        starts, coefficients = self._panels(base, rise, float(places.max(initial=0.0)))
        panel = np.searchsorted(starts, places, side="right") - 1
        here = coefficients[:, np.minimum(panel, coefficients.shape[1] - 1)]
        local = np.full(places.shape, 0.5)
        slopes = legendre.legder(here, axis=0) * 2
        for _ in range(50):  # Newton; θ in its panel
            gap = starts[panel] + legendre.legval(2 * local - 1, here, tensor=False) - places
            step = gap / np.maximum(legendre.legval(2 * local - 1, slopes, tensor=False), 1e-300)
            local = np.clip(local - step, 0.0, 1.0)
            if np.all(np.abs(step) < 1e-15):
                break
        beyond = panel >= coefficients.shape[1]
        theta = np.where(beyond, 0.0, np.minimum(panel + local, 350.0))
        return np.asarray(np.where(beyond, 0.0, rise / np.cosh(theta) ** 2), np.float64)

    # --- integrals over the strains of the wave ---------------------------------------------

    def _squared(self, p0: Array, B: Array) -> Array:
        """F′(p0) + B∫(1-s)² F″ where the wave is small beside the load, else its definition."""
        rule, shape = gauss(), p0.shape
        p0, B = p0.ravel(), B.ravel()
        bend = self._bend(p0[:, None] + rule.s * B[:, None])
        square = self._slope(p0) + B * (bend @ (rule.w * (1 - rule.s) ** 2))
        small = self._smooth(bend, p0, B * _FEW)
        if not np.all(small):
            square[~small] = self._direct_square(p0[~small], B[~small])
        return np.asarray(square.reshape(shape))

    def _direct_square(self, base: Array, rise: Array) -> Array:
        """V² by its definition, in extended precision."""
        (W, F), (p0, B) = self._extended, (x.astype(np.longdouble) for x in (base, rise))
        return np.asarray(2 * (W(p0 + B) - W(p0) - F(p0) * B) / B**2, np.float64)

    def _moments(self, p0: Array, B: Array) -> tuple[Array, Array]:
        """n and c of the module's first lines."""
        rule = gauss()
        bend = self._bend(p0[..., None] + rule.s * B[..., None]) * B[..., None]
        down = 1 - rule.s  # the module's s runs from p1 down
        n, c = bend @ (rule.w * down * rule.s), bend @ (rule.w * (1 - down**2))

        def direct(p0: Array, B: Array) -> tuple[Array, Array]:
            square, p1 = self._direct_square(p0, B), p0 + B
            return (self._force(p1) - self._force(p0)) / B - square, self._slope(p1) - square

        smooth = self._smooth(bend, p0, B)
        if not np.all(smooth):
            n[~smooth], c[~smooth] = direct(p0[~smooth], B[~smooth])
        return n, c

    def _smooth(self, samples: Array, p0: Array, B: Array) -> NDArray[np.bool_]:
        """Where Gauss's rule between p0 and p0 + B is good to rounding: far from δ = 0."""
        if isinstance(self.wave.law, Power):
            return 4 * p0 >= np.abs(B)  # 2.6^{-2n}
        return is_smooth(samples)

    def _panels(self, p0: float, B: float, reach: float) -> tuple[Array, Array]:
        """ξ at θ = i, and ξ(θ) less it on [i, i + 1] in Legendre polynomials, to ``reach``."""
        rule = gauss()
        integral = legendre.legint(np.eye(len(rule.s)), lbnd=-1, axis=0) / 2 @ fitted()
        starts, rows = [0.0], list[Array]()
        while starts[-1] <= reach and len(rows) < _MOST_PANELS:
            rate = self._rate(p0, B, len(rows) + rule.s)
            if self._strange(rate[None], most=1e-11)[0]:
                raise InputError(
                    f"p0 = {p0}, B = {B}: the law changes too much over the wave for float64; "
                    "`lwa.BackgroundWave.profile` gives more digits"
                )
            row = integral @ rate
            rows.append(row)
            starts.append(starts[-1] + float(row.sum()))  # P_n(1) = 1
            if starts[-1] == starts[-2]:
                break
        return np.array(starts), np.array(rows).T

    def _rate(self, p0: float, B: float, theta: Array) -> Array:
        """dξ/dθ at any θ."""
        share, y2 = 1 / np.cosh(theta) ** 2, np.tanh(theta) ** 2
        base, rise = np.full_like(theta, p0), np.full_like(theta, B)
        v = B * share
        rule = gauss()

        def weighted(start: Array, length: Array) -> Array:
            """∫(1-s)² F″(start + s length) ds."""
            bend = self._bend(start[:, None] + rule.s * length[:, None])
            return np.asarray(bend @ (rule.w * (1 - rule.s) ** 2))

        n, c = self._moments(base, rise)
        top = y2 < 0.5
        gap = np.empty_like(theta)  # (V² - Q(v)) B/(B - v)
        d = y2 * B
        above = weighted((base + rise)[top], -d[top])
        gap[top] = (2 * n - y2 * c)[top] + y2[top] ** 2 * B * above
        gap[top] /= share[top] ** 2
        if self._smooth(self._bend(base[:1, None] + rule.s * B), base[:1], rise[:1])[0]:
            below = B * weighted(base[:1], rise[:1]) - v[~top] * weighted(base[~top], v[~top])
        else:
            below = self._squared(base[:1], rise[:1]) - self._squared(base[~top], v[~top])
        gap[~top] = below / y2[~top]
        return np.asarray(2 * self._root_I * np.sqrt(self._slope(base + v) / gap))

    # --- the law as functions ---------------------------------------------------------------

    @property
    def _I(self) -> sp.Expr:
        D = self.wave.cell.spacing
        return self.wave.I.subs(D, 1) if D.is_Symbol else self.wave.I

    @cached_property
    def _root_I(self) -> float:
        return float(sp.sqrt(self._I))

    def _slope_of(self, n: int) -> sp.Expr:
        return self.wave.force(STRAIN, n).subs(self._unit, 1)

    @property
    def _unit(self) -> sp.Expr:
        D = self.wave.cell.spacing
        return D if D.is_Symbol and isinstance(self.wave.law, Power) else sp.S.One

    @cached_property
    def _extended(self) -> tuple[Function, Function]:
        """W and F."""
        return compiled(self._slope_of(-1), True), compiled(self._slope_of(0), True)

    @cached_property
    def _force(self) -> Function:
        return compiled(self._slope_of(0))

    @cached_property
    def _slope(self) -> Function:
        return compiled(self._slope_of(1))

    @cached_property
    def _bend(self) -> Function:
        return compiled(self._slope_of(2))

    # --- where there are waves --------------------------------------------------------------

    def _waves(self, p0: ArrayLike, B: ArrayLike) -> tuple[Array, Array]:
        """p0 and B as arrays of one shape, refused where there is no wave."""
        base, rise = np.broadcast_arrays(*(np.asarray(x, np.float64) for x in (p0, B)))
        if not (np.all(np.isfinite(base)) and np.all(np.isfinite(rise)) and np.all(rise != 0)):
            raise InputError("p0 and B must be finite, and B not 0")
        if isinstance(self.wave.law, Power):
            sign = 1 if self.wave.law.k > 1 else -1
            exists = (base >= 0) & (sign * rise > 0) & (base + rise > 0) & bool(self.wave.law.k - 1)
        else:
            exists = self._stiffens(base, rise)
        if not np.all(exists):
            i = int(np.argmin(exists))
            self.wave.on(float(base.flat[i])).speed(float(rise.flat[i]))  # says why
            raise NoSolitaryWave(f"no wave at p0 = {base.flat[i]}, B = {rise.flat[i]}")
        return base, rise

    def _stiffens(self, p0: Array, B: Array) -> NDArray[np.bool_]:
        """Whether F′ > 0 and Q(v) < Q(B) at some places between 0 and B."""
        rule = gauss()
        with np.errstate(all="ignore"):
            places = p0[..., None] + rule.s * B[..., None]
            bend = self._bend(places) * B[..., None]
            convex = np.all(bend > 0, axis=-1)
            top = self._squared(p0, B)
            below = np.stack([self._squared(p0, t * B) for t in rule.s], axis=-1)
            positive = np.all(self._slope(places) > 0, axis=-1)
            found: NDArray[np.bool_] = positive & (convex | np.all(below < top[..., None], axis=-1))
            return found

    def _strange(self, *samples: Array, most: float = SMOOTH) -> NDArray[np.bool_]:
        """Where a law changes too fast over the wave for the expansions; no power does."""
        if isinstance(self.wave.law, Power):
            return np.zeros(len(samples[0]), np.bool_)
        found: NDArray[np.bool_] = ~np.logical_and.reduce([is_smooth(x, most) for x in samples])
        return found
