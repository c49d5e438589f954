"""Gauss panels along the flank of a wave, and the integrals of `lwa.wave.quadrature` on them.

Letters as in `lwa.wave.quadrature`: a wave of the rise B has the strain p0 + sB, s = 1/cosh²θ,
0 ≤ θ < ∞, K is the kernel of Q(B) - Q(v). Towards s = 0, where F′ of an
unloaded contact is singular, panels in θ become longer, as the integrands decay with s; towards
s = 1 they are halved as often as steep laws, contacts about to open and waves next to their
limiting amplitude demand.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lwa.base.arrays import Array, Extended

POINTS = 20
"""Gauss points of a panel."""

_HALF = float(np.arccosh(np.sqrt(2.0)))
"""θ at v = B/2."""

_TAIL = (2.5, 5.0, 9.0, 20.0)
"""Ends of the panels below v = B/2; s is 1.7e-17 at the last."""

LEVELS = ((1, 0), (2, 3), (6, 4), (24, 3), (24, 23))
"""Panels above v = B/2, and halvings of the first; 23 more reach the last digit of θ²."""

CONVERGED = 1e-13
"""Bound on the last two Legendre coefficients of dξ/dθ on a panel, relative to dξ/dθ."""

ROUNDING = 1e-9
"""Bound in place of `CONVERGED` on the finest panels, where p has rounding errors near a pole."""


class Grid(NamedTuple):
    """Gauss panels in θ from 0 to ∞; the upper ones reach down to v = B/2, or 0.1 B if ``deep``.

    ``s``, ``y2`` = 1 - s and ``ds``, the weights of ∫ … ds, have one entry per node. ``starts`` and
    ``lengths`` have one per upper panel. Row j of ``kernel`` maps F″ at the nodes to ∫ K F″ ds / y²
    at the upper node j; ``first`` and ``last`` map to θ = 0 and to the end of the upper panels.
    """

    s: Array
    y2: Array
    ds: Array
    starts: Array
    lengths: Array
    kernel: Array
    first: Array
    last: Array

    def panels(self, values: Array) -> Array:
        """Values at the upper nodes, panel by panel."""
        return values[..., : len(self.kernel)].reshape(*values.shape[:-1], len(self.starts), POINTS)

    def converged(self, rate: Array, most: float = CONVERGED) -> NDArray[np.bool_]:
        """True for each wave whose dξ/dθ (``rate``, at the upper nodes) the panels resolve."""
        last = np.abs(self.panels(rate) @ _fitted()[-2:].T).max(axis=(1, 2))
        found: NDArray[np.bool_] = last <= most * np.abs(rate).max(axis=1)
        return found


@cache
def gauss() -> tuple[Array, Array]:
    """Nodes and weights on [0, 1]."""
    x, w = _extended_gauss()
    return x.astype(np.float64), w.astype(np.float64)


def _extended_gauss() -> tuple[Extended, Extended]:
    """Gauss nodes and weights on [0, 1] in extended precision, w = 2/((1-x²) P_n′²).

    NumPy's nodes after one step of Newton's method.
    """
    basis = np.eye(POINTS + 1, dtype=np.longdouble)[-1]
    slope = legendre.legder(basis)
    x = legendre.leggauss(POINTS)[0].astype(np.longdouble)
    x = x - legendre.legval(x, basis) / legendre.legval(x, slope)
    return (x + 1) / 2, 1 / ((1 - x**2) * legendre.legval(x, slope) ** 2)


@cache
def _fitted() -> Array:
    """The matrix from values at the Gauss points to coefficients in Legendre polynomials."""
    x, w = gauss()
    odd = 2 * np.arange(POINTS) + 1
    return (legendre.legvander(2 * x - 1, POINTS - 1) * (w[:, None] * odd)).T


@cache
def integrated() -> Array:
    """The matrix from values on [0, 1] to Legendre coefficients of their integral from 0."""
    matrix: Array = legendre.legint(np.eye(POINTS), lbnd=-1, axis=0) / 2 @ _fitted()
    return matrix


@cache
def grid(parts: int = 1, halvings: int = 0, deep: bool = False) -> Grid:
    """The grid with ``parts`` panels above v = B/2, the first halved ``halvings`` times."""
    x, w = gauss()
    above = [0.0, *(_HALF / parts / 2.0 ** np.arange(halvings, 0, -1))]
    above += [_HALF * i / parts for i in range(1, parts + 1)] + [1.3, 1.8] * deep
    edges = np.array([*above, *_TAIL])
    starts, lengths = edges[:-1], np.diff(edges)
    fine_x, fine_w = _extended_gauss()
    fine = (starts[:, None] + lengths[:, None] * fine_x).ravel()
    s, y2 = ((1 / np.cosh(fine) ** 2).astype(np.float64), (np.tanh(fine) ** 2).astype(np.float64))
    ds = (_measure(fine) * (lengths[:, None] * fine_w).ravel()).astype(np.float64)
    theta = fine.astype(np.float64)  # s, y2 and ds are rounded once: V² sums them
    upper = len(above) - 1

    def row(at: float) -> Array:
        panel = int(np.searchsorted(edges[: upper + 1], at, side="right")) - 1
        own = slice(POINTS * panel, POINTS * (panel + 1))
        found = np.zeros_like(theta)
        found[: own.start] = (_above(theta, at) * ds)[: own.start]
        found[own.start :] = (_below(theta, at) * ds)[own.start :]
        if panel < upper:  # K bends at its node: F″ goes there by its values at the nodes
            low, high = edges[panel], edges[panel + 1]
            found[own] = 0.0
            for start, length, kernel in ((low, at - low, _above), (at, high - at, _below)):
                nodes = start + length * x
                part = kernel(nodes, at) * _measure(nodes) * length * w
                local = 2 * (nodes - low) / (high - low) - 1
                found[own] += part @ legendre.legvander(local, POINTS - 1) @ _fitted()
        return found

    kernel = np.array([row(at) for at in theta[: POINTS * upper]])
    last = row(float(edges[upper]))
    return Grid(s, y2, ds, starts[:upper], lengths[:upper], kernel, 2 * s * y2 * ds, last)


def _measure(theta: Any) -> Any:
    """The weight |ds/dθ|."""
    return 2 * np.tanh(theta) / np.cosh(theta) ** 2


def _above(theta: Array, at: float) -> Array:
    """The kernel K/y² at s > u = v/B, with y and u at θ = ``at``."""
    found: Array = np.tanh(theta) ** 4 / np.tanh(at) ** 2
    return found


def _below(theta: Array, at: float) -> Array:
    """The kernel K/y² = s (2 - s - s/u) / u at s < u = v/B.

    Here 1 - s/u = sinh(θ-θ_u) sinh(θ+θ_u) / cosh²θ, which does not cancel.
    """
    s, u = 1 / np.cosh(theta) ** 2, 1 / np.cosh(at) ** 2
    apart = np.sinh(theta - at) * np.sinh(theta + at) * s
    found: Array = s / u * (np.tanh(theta) ** 2 + apart)
    return found


def strains(g: Grid, p0: Array, B: Array) -> Array:
    """Strains p0 + sB at the nodes, computed from p0 or p0 + B, whichever is nearer."""
    near = (p0 + B)[:, None] - B[:, None] * g.y2
    found: Array = np.where(g.y2 < 0.5, near, p0[:, None] + B[:, None] * g.s)
    return found


def value_at(coefficients: Any, x: Array) -> Array:
    """Legendre series at x in [0, 1], one row of coefficients for each x."""
    found: Array = legendre.legval(2 * x - 1, np.moveaxis(coefficients, -1, 0), tensor=False)
    return found


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
