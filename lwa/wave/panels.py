"""Gauss quadrature, panel by panel along the flank of a wave, for `lwa.wave.quadrature`.

A wave of the rise B has the strain p0 + sB, s = 1/cosh²θ, 0 ≤ θ < ∞; K is the kernel of the
integral equation Q(B) - Q(v) = B ∫ K F″ ds, v = uB, and y² = 1 - u. Towards s = 0, where F′ of an
unloaded contact is singular, the integrands decay as a power of s, and panels in θ become longer.
Towards s = 1 panels are halved as often as steep laws, contacts about to open and waves next to
their limiting amplitude demand.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lwa.base.arrays import Array

POINTS = 20
"""Gauss points of a panel."""

LEVELS = ((1, 0), (2, 3), (6, 4), (24, 3), (24, 23))
"""Grids, coarse to fine: panels above v = B/2, halvings of the first (23: last digit of θ²)."""

NEAR = (1.8,)
"""End of the upper panels for widths of the force, at v = 0.1 B."""

# The poles of tanh θ, i π/2 away, let n Gauss points err by 4.4^{-n} on a panel of length 1.5.
FAR = tuple(np.arange(2.0, 41.0, 1.5))
"""Ends of the upper panels for profiles; v is below 1e-34 B at the last."""

_HALF = float(np.arccosh(np.sqrt(2.0)))  # θ at v = B/2
_TAIL = (2.5, 5.0, 9.0, 20.0)  # ends of the panels behind; v = 1.7e-17 B at the last


class Grid(NamedTuple):
    """Gauss nodes and weights on panels in θ; upper panels, on which dξ/dθ is computed, come first.

    ``s``, ``y2`` = 1 - s and ``ds``, the weights of ∫ … ds, have one entry per node; ``starts`` and
    ``lengths`` have one per upper panel, of which ``half`` lie above v = B/2. Row j of ``kernel``
    maps F″ at the nodes to ∫ K F″ ds / y² at the upper node j.
    """

    s: Array
    y2: Array
    ds: Array
    starts: Array
    lengths: Array
    half: int
    kernel: Array

    def panels(self, values: Array) -> Array:
        """Select the values at the upper nodes, shape (…, upper panels, `POINTS`)."""
        return values[..., : len(self.kernel)].reshape(*values.shape[:-1], len(self.starts), POINTS)

    def converged(self, rate: Array, bound: float) -> NDArray[np.bool_]:
        """True for each wave that the panels resolve: last two Legendre coefficients below a bound.

        rate : dξ/dθ at the upper nodes, one row per wave. The bound is relative to its maximum.
        """
        last = np.abs(self.panels(rate) @ _fitted()[-2:].T).max(axis=(1, 2))
        resolved: NDArray[np.bool_] = last <= bound * np.abs(rate).max(axis=1)
        return resolved


@cache
def gauss(kind: type[np.floating[Any]] = np.float64) -> tuple[Any, Any]:
    """Gauss–Legendre nodes and weights on [0, 1], computed in extended precision."""
    basis = np.eye(POINTS + 1, dtype=np.longdouble)[-1]
    slope = legendre.legder(basis)
    x = legendre.leggauss(POINTS)[0].astype(np.longdouble)
    x = x - legendre.legval(x, basis) / legendre.legval(x, slope)  # one step of Newton's method
    w = 1 / ((1 - x**2) * legendre.legval(x, slope) ** 2)
    return ((x + 1) / 2).astype(kind), w.astype(kind)


@cache
def _fitted() -> Array:
    """Matrix from values at the Gauss points to Legendre coefficients."""
    x, w = gauss()
    odd = 2 * np.arange(POINTS) + 1
    return np.asarray((legendre.legvander(2 * x - 1, POINTS - 1) * (w[:, None] * odd)).T)


@cache
def integrated() -> Array:
    """Matrix from values at the Gauss points to Legendre coefficients of their integral from 0."""
    matrix: Array = legendre.legint(np.eye(POINTS), lbnd=-1, axis=0) / 2 @ _fitted()
    return matrix


@cache
def grid(parts: int, halvings: int, further: tuple[float, ...] = ()) -> Grid:
    """Build panels for a wave: ``parts`` above v = B/2, the first one halved ``halvings`` times.

    further : ends of further upper panels.
    """
    x, w = gauss()
    above = [0.0, *(_HALF / parts / 2.0 ** np.arange(halvings, 0, -1))]
    above += [_HALF * i / parts for i in range(1, parts + 1)]
    ends = [*above, *further]
    upper = len(ends) - 1
    edges = np.array([*ends, *(end for end in _TAIL if end > ends[-1])])
    starts, lengths = edges[:-1], np.diff(edges)
    fine_x, fine_w = gauss(np.longdouble)
    fine = (starts[:, None] + lengths[:, None] * fine_x).ravel()
    s, y2 = ((1 / np.cosh(fine) ** 2).astype(np.float64), (np.tanh(fine) ** 2).astype(np.float64))
    ds = (_measure(fine) * (lengths[:, None] * fine_w).ravel()).astype(np.float64)
    theta = fine.astype(np.float64)  # s, y2 and ds are rounded once: V² sums them

    def row(panel: int, at: float) -> Array:
        weights: Array = np.where(theta < at, _above(theta, at), _below(theta, at)) * ds
        block = slice(POINTS * panel, POINTS * (panel + 1))
        weights[block] = 0.0
        low, high = edges[panel], edges[panel + 1]
        # K has a kink at θ = at: on this panel F″ is interpolated, to either side of the kink.
        for start, length, kernel in ((low, at - low, _above), (at, high - at, _below)):
            nodes = start + length * x
            part = kernel(nodes, at) * _measure(nodes) * length * w
            local = 2 * (nodes - low) / (high - low) - 1
            weights[block] += part @ legendre.legvander(local, POINTS - 1) @ _fitted()
        return weights

    kernel = np.array([row(i // POINTS, at) for i, at in enumerate(theta[: POINTS * upper])])
    return Grid(s, y2, ds, starts[:upper], lengths[:upper], len(above) - 1, kernel)


def _measure(theta: Any) -> Any:
    """The weight |ds/dθ| of integrals over θ in place of s = 1/cosh²θ."""
    return 2 * np.tanh(theta) / np.cosh(theta) ** 2


def _above(theta: Array, at: float) -> Any:
    """The integral equation's kernel, K/y² = (1-s)²/y² at s > u = v/B; y and u at θ = ``at``."""
    return np.tanh(theta) ** 4 / np.tanh(at) ** 2


def _below(theta: Array, at: float) -> Any:
    """The integral equation's kernel, K/y² = s (2 - s - s/u) / u at s < u = v/B, s = 1/cosh²θ."""
    s, u = 1 / np.cosh(theta) ** 2, 1 / np.cosh(at) ** 2
    # 1 - s/u = sinh(θ-θ_u) sinh(θ+θ_u) / cosh²θ does not cancel
    apart = np.sinh(theta - at) * np.sinh(theta + at) * s
    return s / u * (np.tanh(theta) ** 2 + apart)


def value_at(coefficients: Any, x: Array) -> Any:
    """Legendre series at x in [0, 1], one row of coefficients for each x."""
    return legendre.legval(2 * x - 1, np.moveaxis(coefficients, -1, 0), tensor=False)


def inverse(coefficients: Array, target: Array) -> Array:
    """The x in [0, 1] at which growing Legendre series reach their targets, by Newton's method."""
    slopes = np.moveaxis(legendre.legder(np.moveaxis(coefficients, -1, 0), scl=2), 0, -1)
    x: Any = np.full(target.shape, 0.5)
    for _ in range(60):
        slope = np.maximum(value_at(slopes, x), 1e-300)  # 0 at the end of a flat panel
        step = (value_at(coefficients, x) - target) / slope
        x = np.clip(x - step, 0.0, 1.0)
        if np.all(np.abs(step) < 1e-15):
            break
    return np.asarray(x, np.float64)
