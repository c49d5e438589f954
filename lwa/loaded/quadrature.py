"""Speed, width and profile of a wave under a load in float64.

A wave of strain v on the strain p0, which rises by B at its peak, obeys

    J(p0+v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,    V² = Q(B),

with J = I F′ (`lwa.loaded.wave`). Differences of W and F cancel. Here they are integrals of F′ and
F″ at the strains p = p0 + sB of the wave, 0 < s < 1:

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

from lwa.base.arrays import Array
from lwa.base.exact import InputError

Samples = Callable[[Array], tuple[Array, Array, Array]]

# Nodes per unit of t, tried one after the other; 20 are too few for the width of a force. Twice as
# many nodes err by the square: a result equal to `_CLOSE` by half as many is right to rounding.
_STEPS = (20, 28, 56, 112)
_CLOSE = 1e-8
_END = 4.0  # the largest |t|: s or 1 - s is 6e-38 there
_WINDOW = 20  # places of an end correction: the polynomial's error is below rounding at 20 nodes
_NEAR, _FAR = (
    -1.7,
    -3.0,
)  # first t of widths, where v = 2e-4 B, and of profiles, 2e-14 B
_STEEPEST = 1.0  # largest d ln s between the nodes of an end correction at the foot
_LEAST = 1e-3  # size below which profiles are right to the absolute error of this size
_PLACES = 16  # nodes through which results are interpolated


class Grid(NamedTuple):
    """Nodes of the double-exponential rule, from the foot of a wave, s = 0, to the peak, s = 1.

    s, y2, ds : the nodes, 1 - s, and the weights of ∫ … ds.
    rows : the nodes of dξ, on the side of the peak.
    above : row j maps values at the nodes to ∫ … dt from the node j to the peak, j in rows.
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

    @property
    def half(self) -> int:
        """The row of the node s = 1/2, which is the middle one of all nodes."""
        return len(self.s) // 2 - int(self.rows.start)

    def strains(self, p0: float, B: float) -> Array:
        """The strains at the nodes."""
        # From p0 or p0 + B, whichever is nearer: p has its digits next to a pole at either.
        return np.where(self.y2 < 0.5, (p0 + B) - B * self.y2, p0 + B * self.s)

    def distances(self, B: float, F2: Array, J: Array) -> Array:
        """The distances dξ between the nodes of the rows."""
        # Roots first: their quotient neither over- nor underflows.
        gap = np.sqrt(np.sign(B) * (self.kernel @ F2)) * np.sqrt(abs(B))
        return np.asarray(self.length * np.sqrt(J[self.rows]) / gap)

    def from_peak(self, values: Array) -> Array:
        """Values at the rows, the first at the peak; the last rows have no window for `above`."""
        return values[: _WINDOW // 2 - 1 : -1]


@cache
def grid(steps: int, start: float = _NEAR) -> Grid:
    """Build the grid of ``steps`` nodes per unit of t, with rows from t = ``start`` on."""
    t = np.arange(-_END * steps, _END * steps + 1) / steps
    grown = np.exp(np.pi * np.sinh(t))
    s, y2, rate = grown / (1 + grown), 1 / (1 + grown), np.pi * np.cosh(t) / steps
    ds = s * y2 * rate
    below = _cumulated(len(t))
    rows = slice(int(np.argmax((rate < _STEEPEST) & (t >= start))), None)
    above, below, u, w = (
        below[::-1, ::-1][rows],
        below[rows],
        s[rows, None],
        y2[rows, None],
    )
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
    weights = [
        w @ np.prod([(x - i) / (j - i) for i in places if i != j], axis=0)
        for j in places
    ]
    cells = np.zeros((count - 1, count + _WINDOW))
    for i, row in enumerate(cells):
        row[i : i + _WINDOW] = np.array(weights) / 2
    sums = np.cumsum(cells, axis=0)[:, -places[0] : count - places[0]]
    return np.vstack([np.zeros(count), sums])


def _interpolated(x: Array, y: Array, at: Array) -> Array:
    """Values at the places ``at`` of a function with values y at ascending x.

    The polynomial through the `_PLACES` nearest values is evaluated by Neville's scheme.
    """
    first = np.clip(np.searchsorted(x, at) - _PLACES // 2, 0, len(x) - _PLACES)
    window = first + np.arange(_PLACES)[:, None]
    x, y = x[window], y[window]
    for n in range(1, _PLACES):
        left, right = x[:-n], x[n:]
        y = ((at - left) * y[1:] - (at - right) * y[:-1]) / (right - left)
    return np.asarray(y[0])


@dataclass(frozen=True)
class Quadrature:
    """Speed, half widths and profile of the wave J v′² = v² (Q(B) - Q(v)) on the strain p0.

    samples : function of an array of strains; returns F′, F″ and J/F′, arrays of its shape.

    Methods raise `lwa.InputError` for a wave that the finest grid does not resolve.
    """

    samples: Samples
    p0: float
    B: float

    def square(self) -> float:
        """The square V² = Q(B): 2 ∫(1-s) F′ ds, or F′(p0) + B ∫(1-s)² F″ ds for small waves."""

        def compute(g: Grid, F1: Array, F2: Array, _: Array) -> Array:
            first, second = (
                g.ds * g.y2,
                g.ds * g.y2**2,
            )  # weights of 1/2 and 1/3, but for rounding
            change = self.B / 3 * (F2 @ second) / second.sum()
            small = abs(change) < F1[0] / 4
            return np.asarray(F1[0] + change if small else (F1 @ first) / first.sum())

        return float(self._converged(compute))

    def half_width(self, of_force: bool = False) -> float:
        """The distance from the peak at which the strain, or the force F, has half of its rise."""

        def compute(g: Grid, F1: Array, F2: Array, J: Array) -> Array:
            dxi, above = g.distances(self.B, F2, J), g.above[:, g.rows]
            if not of_force:
                return np.asarray(above[g.half] @ dxi)
            fall = g.from_peak(g.above @ (F1 * g.ds)) / (F1 @ g.ds)
            return _interpolated(fall, g.from_peak(above @ dxi), np.array([0.5]))

        return float(self._converged(compute, coarsest=int(of_force)).item())

    def profile(self, places: Array) -> Array:
        """The ratio v/B at distances from the peak."""

        def compute(g: Grid, _: Array, F2: Array, J: Array) -> Array:
            dxi = g.distances(self.B, F2, J)
            xi = g.from_peak(g.above[:, g.rows] @ dxi)
            logs = g.from_peak(
                np.where(g.y2 < 0.5, np.log1p(-g.y2), np.log(g.s))[g.rows]
            )
            inside = _interpolated(xi, logs, np.minimum(places, xi[-1]))
            # v decays exponentially behind the last node under a load, and ends there without
            slope = g.from_peak((g.ds / g.s)[g.rows])[-1] / g.from_peak(dxi)[-1]
            return np.asarray(np.exp(inside - slope * np.maximum(places - xi[-1], 0)))

        return self._converged(compute, start=_FAR, least=_LEAST)

    def refusal(self) -> str:
        """Reason why there is no wave, "" for a wave: 0 < F′ < ∞, BQ′(B) > 0, Q(v) < Q(B)."""
        g = grid(_STEPS[0], _FAR)
        with np.errstate(all="ignore"):
            F1, F2, _ = self.samples(g.strains(self.p0, self.B))
            ends = (
                F2 @ (2 * g.s * g.y2 * g.ds),
                F2 @ (g.y2**2 * g.ds),
            )  # Q′(B), (Q(B) - Q(0))/B
            rises = self.B * np.append(g.kernel @ F2, ends)
        if not np.all(F1 >= 0) or not np.isfinite(F1[-1]):
            return "F′ is not positive and finite from p0 to p0 + B"
        if np.any(F1 == 0):
            return (
                "F′ is 0 between p0 and p0 + B, or so small that its terms cancel to 0"
            )
        if np.all(rises > 0):
            return ""
        return (
            "the law does not stiffen towards p0 + B: a smaller wave would be as fast"
        )

    def _converged(
        self,
        compute: Callable[..., Array],
        coarsest: int = 0,
        start: float = _NEAR,
        least: float = 0.0,
    ) -> Array:
        """Refine the grid until a result is the result of half as many nodes."""
        for steps in _STEPS[coarsest:]:
            g, rough = grid(steps, start), grid(steps // 2, start)
            with np.errstate(all="ignore"):
                F1, F2, I = self.samples(g.strains(self.p0, self.B))
                nodes = F1, F2, F1 * I
                found, other = (
                    compute(g, *nodes),
                    compute(rough, *(x[::2] for x in nodes)),
                )
                if np.all(
                    np.abs(found - other) <= _CLOSE * np.maximum(np.abs(found), least)
                ):
                    return found
        raise InputError(
            f"p0 = {self.p0:.6g}, B = {self.B:.6g}: the law changes too much over the wave for "
            "float64"
        )
