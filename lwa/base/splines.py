"""A smooth rising function through points: the monotone C² spline of rational quadratics.

Between two points the spline g of ascending x and y is a ratio of quadratics,

    g = y + hΔ [Δθ² + d θ(1-θ)] / [Δ + (d + e - 2Δ) θ(1-θ)],    θ = (x - x_i)/h,

h the distance, Δ the slope of the chord, d and e the slopes at the ends. It rises wherever all
slopes are positive, and for one set of positive slopes g″ is continuous, and 0 at both ends:
Gregory and Delbourgo, IMA J. Numer. Anal. 2, 123 (1982). A cubic spline may fall between points
that rise, and monotone cubics have jumps in g″.

`ForceSpline` is such a spline of ln F over ln δ. It gives a power exactly and goes on as a power
below the first point; F, F′ and F″ are continuous.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import mpmath
import numpy as np

from lwa.base.arrays import Array

_SWEEPS = 1000  # most sweeps over the slopes; tens are enough for points of a smooth law
_CLOSE = 4e-16  # relative change of the slopes in the last sweep
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Gauss's rule for the energy between two points."""


def c2_slopes(x: Array, y: Array) -> Array:
    """Return the slopes of the spline at its points: at each the positive root, in turn."""
    h = np.diff(x)
    chords = np.diff(y) / h
    d = np.concatenate((chords[:1], np.sqrt(chords[1:] * chords[:-1]), chords[-1:])).tolist()
    last = len(d) - 1
    for _ in range(_SWEEPS):
        change = 0.0
        for i, old in enumerate(d):
            # g″ is the same on both sides (0 at an end): d² Σ 1/(hΔ) + d Σ (e/Δ - 1)/h = Σ Δ/h,
            # where e is the slope at the other end of a side.
            square = linear = constant = 0.0
            for side, other in ((i - 1, i - 1), (i, i + 1)):
                if 0 <= other <= last:
                    square += 1 / (h[side] * chords[side])
                    linear += (d[other] / chords[side] - 1) / h[side]
                    constant += chords[side] / h[side]
            root = math.sqrt(linear * linear + 4 * square * constant)
            d[i] = float(2 * constant / (linear + root))
            change = max(change, abs(d[i] / old - 1))
        if change < _CLOSE:
            break
    return np.array(d)


@dataclass(frozen=True, eq=False)
class ForceSpline:
    """A smooth rising force F(δ) through points.

    pieces : (8, intervals), in each interval the first ln δ, its length, the first ln F, the slope
        of the chord, both slopes at the ends, and ∫ F dδ and ∫ √F′ dδ at the first point. The first
        interval is a straight line: the power below the first point. end : the last ln δ.
    """

    pieces: Array
    end: float

    @classmethod
    def through(cls, compressions: Sequence[float], forces: Sequence[float]) -> ForceSpline:
        """Make the spline of points, both rows positive and ascending."""
        x, y = np.log(np.array((compressions, forces), float))
        d = c2_slopes(x, y)
        x = np.append(x[0] - 1, x)
        y, d = np.append(y[0] - d[0], y), np.append(d[0], d)
        h = np.diff(x)
        pieces = np.array((x[:-1], h, y[:-1], np.diff(y) / h, d[:-1], d[1:], 0 * h, 0 * h))
        spline = cls(pieces, float(x[-1] + 8 * np.spacing(abs(x[-1]))))
        for order in (-1, -2):
            gained = spline._gained(order, pieces[:, 1:], x[2:], np.exp)
            first = float(spline._of_power(order, pieces[:, 0], x[1], np.exp))
            pieces[5 - order, 1:] = first + np.append(0.0, np.cumsum(gained)[:-1])
        pieces.setflags(write=False)
        return spline

    def __call__(self, order: int, delta: Any) -> Any:
        """Return F, F′ or F″ (order 2), or ∫ F dδ (-1) or ∫ √F′ dδ (-2) from 0, at compressions δ.

        delta : an array or a number, also of mpmath. 0 where δ ≤ 0, NaN beyond the last point.
        """
        if isinstance(delta, mpmath.mpf):
            if delta <= 0:
                return mpmath.mpf(0)
            if (x := mpmath.log(delta)) > self.end:
                return mpmath.nan
            i = max(int(np.searchsorted(self.pieces[0], float(x), side="right")) - 1, 0)
            return self._value(order, x, i, self.pieces[:, i].tolist(), mpmath.exp)
        delta = np.asarray(delta, float)
        with np.errstate(all="ignore"):
            x = np.where(delta > 0, np.log(delta), np.nan)
            at = np.searchsorted(self.pieces[0, 1:], x, side="right")
            values = self._value(order, x, at, self.pieces[:, at], np.exp)
            return np.where(delta > 0, np.where(x <= self.end, values, np.nan), 0.0)[()]

    def _value(self, order: int, x: Any, i: Any, piece: Any, exp: Callable[[Any], Any]) -> Any:
        """Return a derivative or an integral at δ = e^x in the interval i with these numbers."""
        g, slope, bend = log_force(x, *piece[:6])
        if order == 0:
            return exp(g)
        if order == 1:
            return exp(g - x) * slope
        if order == 2:
            return exp(g - 2 * x) * (bend + slope * (slope - 1))
        power = self._of_power(order, piece, x, exp)
        later = piece[5 - order] + self._gained(order, piece, x, exp)
        return (power, later)[i > 0] if isinstance(i, int) else np.where(i > 0, later, power)

    def _of_power(self, order: int, piece: Any, x: Any, exp: Callable[[Any], Any]) -> Any:
        """Return an integral up to δ = e^x below the first point, where F is a power."""
        g, slope, _ = log_force(x, *piece[:6])
        power = exp(g + x) / (slope + 1)
        return power if order == -1 else 2 * (power * slope / (slope + 1)) ** 0.5

    def _gained(self, order: int, piece: Any, x: Any, exp: Callable[[Any], Any]) -> Any:
        """Return an integral from the first point of an interval, by Gauss's rule in x = ln δ."""
        half = (x - piece[0]) / 2
        total = 0 * half
        for node, weight in zip(NODES.tolist(), WEIGHTS.tolist(), strict=True):
            place = piece[0] + half * (1 + node)
            g, slope, _ = log_force(place, *piece[:6])
            rate = exp(g + place)  # δ F; δ √F′ is √(δ F d ln F/d ln δ)
            total += weight * (rate if order == -1 else (rate * slope) ** 0.5)
        return half * total


def log_force(x: Any, x0: Any, h: Any, y0: Any, chord: Any, d: Any, e: Any) -> tuple[Any, Any, Any]:
    """Return ln F and its first two derivatives by x = ln δ, in an interval with these numbers."""
    s = (x - x0) / h
    r, c = 1 - s, d + e - 2 * chord
    below = chord + c * s * r
    g = y0 + h * chord * (chord * s * s + d * s * r) / below
    rise = e * s * s + 2 * chord * s * r + d * r * r
    turn = e * s + chord * (r - s) - d * r - rise * c * (r - s) / below
    scale = chord * chord / (below * below)
    return g, scale * rise, 2 * scale / h * turn


@lru_cache(maxsize=64)
def read_spline(points: str) -> ForceSpline:
    """Return the spline through points "δ F, δ F, …"."""
    rows = [tuple(map(float, point.split())) for point in points.split(",")]
    compressions, forces = zip(*rows, strict=True)
    return ForceSpline.through(compressions, forces)
