"""Waves on a background in float64: speed, width and profile for arrays of (p0, B).

A wave of strain v on the strain p0, which rises by B at its peak, obeys

    J(p0+v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,    V² = Q(B),

with J = I F′ for the canonical field (`lwa.wave.background`). Differences of W and F cancel. Here
they are integrals of F′ and F″ at the strains p = p0 + sB of the wave, 0 < s < 1:

    Q(B)        = 2 ∫ (1-s) F′ ds,
    Q(B) - Q(v) = B ∫ K F″ ds,    K = (1-s)² for s > v/B,  (1-s)² - (1 - sB/v)² below.

Under a law that stiffens the integrands keep one sign. All integrals are sums over one grid,
equally spaced in t with s = 1/(1 + exp(-π sinh t)), the double-exponential rule of Takahasi and
Mori (Publ. RIMS 9, 721 (1974)). Integrals to a place on the way are the same sums with an end
correction, the integral of a polynomial through `_WINDOW` neighbours (`_cumulated`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.quantities import NOT_RISING, NOT_STIFFENING, VANISHING

Rate = Callable[[Array, Array], Array]
Samples = Callable[[Array], tuple[Array, Array, Array]]

_STEPS = (20, 28, 56, 112)  # nodes per unit of t, tried one after the other; 20 for no force
_END = 4.0  # the largest |t|: s or 1 - s is 6e-38 there
_WINDOW = 20  # places of an end correction
_NEAR, _FAR = -1.7, -3.0  # first t of widths, where v = 2e-4 B, and of profiles, 2e-14 B
_STEEPEST = 1.0  # largest d ln s between the nodes of an end correction at the foot
CLOSE = 1e-8  # difference to half as many nodes; twice as many err 2^20 times less
_LEAST = 1e-3  # size below which profiles are right to the absolute error of this size
_PLACES = 16  # nodes through which results are interpolated


class Grid(NamedTuple):
    """Nodes of the double-exponential rule, from the foot of a wave, s = 0, to the peak, s = 1.

    s, y2, ds : the nodes, 1 - s, and the weights of ∫ … ds.
    rows : the nodes of dξ, on the side of the peak.
    above : row j maps values at the nodes to ∫ … dt from the node j to the peak.
    kernel : row j maps F″ at the nodes to (Q(B) - Q(v)) / (B - v), v = B s_j.
    length : (1-s)^{1/2} ds/dt / (s (1-s)), the factor of dξ at the rows.
    """

    s: Array
    y2: Array
    ds: Array
    rows: slice
    above: Array
    kernel: Array
    length: Array

    def strains(self, p0: Array, B: Array) -> Array:
        """The strains at the nodes, one row per wave."""
        # From p0 or p0 + B, whichever is nearer: p has its digits next to a pole at either.
        near = (p0 + B)[:, None] - B[:, None] * self.y2
        return np.where(self.y2 < 0.5, near, p0[:, None] + B[:, None] * self.s)


@cache
def grid(steps: int, start: float = _NEAR) -> Grid:
    """Build the grid of ``steps`` nodes per unit of t, with rows from t = ``start`` on."""
    t = np.arange(-_END * steps, _END * steps + 1) / steps
    grown = np.exp(np.pi * np.sinh(t))
    s, y2, rate = grown / (1 + grown), 1 / (1 + grown), np.pi * np.cosh(t) / steps
    ds = s * y2 * rate
    below = _cumulated(len(t))
    rows = slice(int(np.argmax((rate < _STEEPEST) & (t >= start))), None)
    above, below, u, w = below[::-1, ::-1][rows], below[rows], s[rows, None], y2[rows, None]
    # K/(1-u), u = v/B, is s (2 (1-s) - s (1-u)/u)/u below u, which does not cancel
    kernel = below * (2 * s * y2 * ds) / u - below * (s**2 * ds) * w / u**2
    kernel += above * (y2**2 * ds) / w
    return Grid(s, y2, ds, rows, above, kernel, (rate * np.sqrt(y2))[rows])


def _cumulated(count: int) -> Array:
    """Matrix from a function's values at the places 0, 1, … to its integrals from the first.

    The integral over a cell is that of the polynomial through the `_WINDOW` nearest places; the
    function vanishes beyond the ends.
    """
    places = range(1 - _WINDOW // 2, _WINDOW // 2 + 1)
    x, w = np.polynomial.legendre.leggauss(_WINDOW)
    x = (x + 1) / 2
    weights = [w @ np.prod([(x - i) / (j - i) for i in places if i != j], axis=0) for j in places]
    cells = np.zeros((count - 1, count + _WINDOW))
    for i, row in enumerate(cells):
        row[i : i + _WINDOW] = np.array(weights) / 2
    sums = np.cumsum(cells, axis=0)[:, -places[0] : count - places[0]]
    return np.vstack([np.zeros(count), sums])


def _interpolated(x: Array, y: Array, at: Array) -> Array:
    """Values at the places ``at`` of functions with values y at ascending x, one row each.

    The polynomial through the `_PLACES` nearest values is evaluated by Neville's scheme.
    """
    first = (x[:, :, None] < at[:, None, :]).sum(axis=1) - _PLACES // 2
    first = np.clip(first, 0, x.shape[1] - _PLACES)
    window = first[:, None, :] + np.arange(_PLACES)[:, None]
    rows = np.arange(len(x))[:, None, None]
    x, y = x[rows, window], y[rows, window]
    for n in range(1, _PLACES):
        left, right = x[:, :-n], x[:, n:]
        y = ((at[:, None] - left) * y[:, 1:] - (at[:, None] - right) * y[:, :-1]) / (right - left)
    return np.asarray(y[:, 0])


@dataclass(frozen=True)
class Quadrature:
    """Speeds, half widths and profiles of the waves J v′² = v² (Q(B) - Q(v)), for flat arrays.

    samples : function of an array of strains; returns F′, F″ and J/F′, arrays of its shape.
    close : difference to half as many nodes at which a result is taken.

    Methods take arrays of p0 and B of one shape, and raise `lwa.InputError` for a wave that the
    finest grid does not resolve.
    """

    samples: Samples
    close: float = CLOSE

    def squares(self, p0: Array, B: Array) -> Array:
        """The squares V² = Q(B): 2 ∫(1-s) F′ ds, or F′(p0) + B ∫(1-s)² F″ ds for small waves."""

        def compute(g: Grid, B: Array, F1: Array, F2: Array, _: Array) -> Array:
            first, second = g.ds * g.y2, g.ds * g.y2**2  # weights of 1/2 and 1/3, but for rounding
            start, change = F1[:, 0], B / 3 * (F2 @ (second / second.sum()))
            direct = F1 @ (first / first.sum())
            square = np.where(np.abs(change) < start / 4, start + change, direct)
            return np.asarray(square[:, None])

        return self._converged(compute, p0, B)[:, 0]

    def half_widths(self, p0: Array, B: Array, rate: Rate | None = None) -> Array:
        """The distances from the peak at which a quantity has half of its rise.

        rate : the quantity's derivative by the strain, as a function of the strain and F′; None
            for the strain itself. NaN for a quantity that is below half where v < B/1000.
        """

        def compute(g: Grid, B: Array, _: Array, F2: Array, J: Array, *rates: Array) -> Array:
            dxi, ahead = _lengths(g, B, F2, J), g.above[:, g.rows]
            if not rates:
                return np.asarray(dxi @ ahead[[len(g.s) // 2 - len(g.s)]].T)
            back = slice(None, _WINDOW // 2 - 1, -1)  # from the peak; the last rows have no window
            (change,) = rates
            fall = ((change * g.ds) @ g.above.T)[:, back] / (change @ g.ds)[:, None]
            half = np.full((len(B), 1), 0.5)
            found = _interpolated(fall, (dxi @ ahead.T)[:, back], half)
            return np.asarray(np.where(fall[:, -1:] > half, found, np.nan))

        return self._converged(compute, p0, B, rate)[:, 0]

    def profile(self, p0: Array, B: Array, places: Array) -> Array:
        """The ratio v/B at distances from the peak, one row per wave."""

        def compute(g: Grid, B: Array, _: Array, F2: Array, J: Array) -> Array:
            back = slice(None, _WINDOW // 2 - 1, -1)
            dxi = _lengths(g, B, F2, J)
            xi = (dxi @ g.above[:, g.rows].T)[:, back]
            logs = np.where(g.y2 < 0.5, np.log1p(-g.y2), np.log(g.s))[g.rows][back]
            at = np.broadcast_to(places, (len(B), places.size))
            inside = _interpolated(xi, np.broadcast_to(logs, xi.shape), np.minimum(at, xi[:, -1:]))
            # v decays exponentially behind the last node under a load, and ends there without
            slope = (g.ds / g.s)[g.rows][back][-1] / dxi[:, back][:, -1:]
            beyond = slope * np.maximum(at - xi[:, -1:], 0)
            return np.asarray(np.exp(inside - beyond))

        return self._converged(compute, p0, B, start=_FAR)

    def refusals(self, p0: Array, B: Array) -> NDArray[np.str_]:
        """Reasons why there are no waves, "" for a wave: 0 < F′ < ∞, BQ′(B) > 0, Q(v) < Q(B)."""
        g = grid(_STEPS[0], _FAR)
        with np.errstate(all="ignore"):
            F1, F2, _ = self.samples(g.strains(p0, B))
            ends = [F2 @ (2 * g.s * g.y2 * g.ds), F2 @ (g.y2**2 * g.ds)]  # Q′(B), (Q(B) - Q(0))/B
            rises = B[:, None] * np.column_stack([F2 @ g.kernel.T, *ends])
        missed = {
            NOT_RISING: ~(F1 >= 0).all(axis=1) | ~np.isfinite(F1[:, -1]),
            VANISHING: (F1 == 0).any(axis=1),
            NOT_STIFFENING: ~(rises > 0).all(axis=1),
        }
        return np.select(list(missed.values()), list(missed), "")

    def _converged(
        self,
        compute: Callable[..., Array],
        p0: Array,
        B: Array,
        rate: Rate | None = None,
        start: float = _NEAR,
    ) -> Array:
        """Refine the grid until a result is the result of half as many nodes."""
        left, result = np.arange(len(p0)), np.empty(0)
        for steps in _STEPS[rate is not None :]:
            rise = B[left]
            with np.errstate(all="ignore"):
                p = grid(steps, start).strains(p0[left], rise)
                F1, F2, I = self.samples(p)
                nodes = (F1, F2, F1 * I) if rate is None else (F1, F2, F1 * I, rate(p, F1))
                found = compute(grid(steps, start), rise, *nodes)
                rough = compute(grid(steps // 2, start), rise, *(x[:, ::2] for x in nodes))
                size = np.maximum(np.abs(found), _LEAST)
                good = (np.abs(found - rough) <= self.close * size).all(axis=1)
            result = result if result.size else np.empty((len(p0), *found.shape[1:]))
            result[left[good]] = found[good]
            left = left[~good]
            if not len(left):
                return result
        at = f"p0 = {p0[left[0]]:.6g}, B = {B[left[0]]:.6g}"
        raise InputError(f"{at}: the law changes too much over the wave for float64")


def _lengths(g: Grid, B: Array, F2: Array, J: Array) -> Array:
    """The distances dξ between the nodes of the rows."""
    # Roots first: their quotient neither over- nor underflows.
    gap = np.sqrt(np.sign(B)[:, None] * (F2 @ g.kernel.T)) * np.sqrt(np.abs(B))[:, None]
    return np.asarray(g.length * np.sqrt(J[:, g.rows]) / gap)
