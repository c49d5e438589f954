"""Speed, width and profile of a wave under a load in float64.

A wave of strain v on the strain p0, which rises by B at its peak, obeys::

    J(p0+v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,    V² = Q(B),

with ``J = I F′ + R V⁴``, R the sum of resonators (`lwa.loaded.wave`). Differences of W and F
cancel. Here they are integrals of ``F′`` and ``F″`` at the strains ``p = p0 + sB`` of the wave, s
from 0 at its foot to 1 at its peak::

    Q(B)        = 2 ∫ (1-s) F′ ds,
    Q(B) - Q(v) = B ∫ K F″ ds,    K = (1-s)² for s > v/B,  (1-s)² - (1 - sB/v)² below.

Under a law that stiffens the integrands keep one sign. All integrals are sums over one grid,
equally spaced in t with ``s = 1/(1 + exp(-π sinh t))``, the double-exponential rule of Takahasi and
Mori (Publ. RIMS 9, 721 (1974)). Integrals to a place on the way are the same sums with an end
correction, the integral of a polynomial through `_WINDOW` neighbours (`_cumulated`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.loaded.statics import Samples

# Nodes per unit of t, tried one after the other; 20 are too few for the width of a force. Twice as
# many nodes err by the square: a result that agrees to `_CLOSE` with that of half as many nodes is
# right to rounding.
_STEPS = (20, 28, 56, 112)
_CLOSE = 1e-8
_END = 4.0  # the largest |t|: s or 1 - s is 6e-38 there
_WINDOW = 20  # places of an end correction: the polynomial's error is below rounding at 20 nodes
_NEAR = -1.7  # first t of widths, where v = 2e-4 B
_FAR = -3.0  # first t of profiles, where v = 2e-14 B
_STEEPEST = 1.0  # largest d ln s between the nodes of an end correction at the foot
_LEAST = 1e-3  # size below which profiles are right to the absolute error of this size
_PLACES = 16  # nodes through which results are interpolated


class Grid:
    """Nodes of the double-exponential rule, from the foot of a wave to the peak.

    Distances ξ from the peak are wanted at the last nodes alone, the rows.

    Parameters
    ----------
    steps : int
        Number of nodes per unit of t.
    start : float
        Least t of the rows.

    Attributes
    ----------
    s, rest : Array
        The nodes, and 1 - s with all digits.
    ds : Array
        Weights of ``∫ … ds`` over all nodes.
    rows : slice
        The rows among the nodes.
    to_peak : Array
        Row j maps values at the nodes to ``∫ … dt`` from the node j to the peak.
    kernel : Array
        Row j maps ``F″`` at the nodes to ``(Q(B) - Q(v)) / (B - v)``, ``v = B s_j``.
    length : Array
        ``(1-s)^{1/2} ds/dt / (s (1-s))`` at the rows, the factor of dξ.
    """

    def __init__(self, steps: int, start: float = _NEAR) -> None:
        t = np.arange(-_END * steps, _END * steps + 1) / steps
        odds = np.exp(np.pi * np.sinh(t))  # s over 1 - s
        s = odds / (1 + odds)
        rest = 1 / (1 + odds)
        rate = np.pi * np.cosh(t) / steps  # d ln(s/(1-s)) from node to node
        ds = s * rest * rate
        # Towards the foot the nodes are too far apart for a polynomial through their neighbours.
        smooth = (rate < _STEEPEST) & (t >= start)
        rows = slice(int(np.argmax(smooth)), None)
        sums = _cumulated(len(t))
        # Integrals from the foot to a row
        to_node = sums[rows]
        # Integrals from a row to the peak: the nodes lie symmetrically about t = 0.
        mirrored = sums[::-1, ::-1]
        self.to_peak = mirrored[rows]
        # The kernel K/(1-u), u = v/B, is (1-s)²/(1-u) for s > u. Below it is
        # s (2 (1-s) - s (1-u)/u)/u, which does not cancel.
        u = s[rows, None]
        above_u = rest[rows, None]  # 1 - u
        kernel = to_node * (2 * s * rest * ds) / u
        kernel -= to_node * (s**2 * ds) * above_u / u**2
        kernel += self.to_peak * (rest**2 * ds) / above_u
        length = rate * np.sqrt(rest)
        self.s = s
        self.rest = rest
        self.ds = ds
        self.rows = rows
        self.kernel = kernel
        self.length = length[rows]

    def strains(self, p0: float, B: float) -> Array:
        """The strains at the nodes."""
        # Counted from p0 or from p0 + B, whichever is nearer: next to a pole at either end the
        # distance to the pole keeps its digits.
        from_peak = (p0 + B) - B * self.rest
        from_foot = p0 + B * self.s
        return np.where(self.rest < 0.5, from_peak, from_foot)

    @property
    def logs(self) -> Array:
        """ln s at the nodes, with all digits near the peak."""
        near_peak = np.log1p(-self.rest)
        return np.where(self.rest < 0.5, near_peak, np.log(self.s))

    @staticmethod
    def peak_first(values: Array) -> Array:
        """Put values at the rows in the order from the peak to the foot.

        The rows next to the foot go: there the integrals in `Nodes.places` are not right.
        """
        # These integrals know dξ at the rows alone, and the end correction next to the foot would
        # need it at the nodes before them, up to half a window.
        first = _WINDOW // 2
        return values[first:][::-1]


grid = cache(Grid)
"""The grid of so many nodes per unit of t, and of rows from this t on."""


def _cumulated(count: int) -> Array:
    """Matrix from a function's values at the places 0, 1, … to its integrals from the first.

    The integral over a cell is that of the polynomial through the `_WINDOW` nearest places; the
    function vanishes beyond the ends.
    """
    # The cell from 0 to 1, with as many places before it as after it
    before = _WINDOW // 2 - 1
    places = np.arange(-before, _WINDOW - before, dtype=float)
    # Gauss's rule of this many nodes is exact for the polynomial.
    x, w = np.polynomial.legendre.leggauss(_WINDOW)
    weights = _lagrange(places[:, None], (x + 1) / 2) @ w / 2
    cells = np.zeros((count - 1, count + _WINDOW))
    for i, row in enumerate(cells):
        row[i : i + _WINDOW] = weights
    sums = np.cumsum(cells, axis=0)
    # The columns of places beyond the ends go: there the function is 0.
    inside = sums[:, before : before + count]
    return np.vstack([np.zeros(count), inside])


def _interpolated(x: Array, y: Array, at: Array) -> Array:
    """Values at the places ``at`` of a function with values y at ascending x.

    They are those of the polynomial through the `_PLACES` nearest values.
    """
    nearest = np.searchsorted(x, at) - _PLACES // 2
    first = np.clip(nearest, 0, len(x) - _PLACES)
    # One column of places for each value that is wanted
    window = first + np.arange(_PLACES)[:, None]
    return np.asarray((y[window] * _lagrange(x[window], at)).sum(axis=0))


def _lagrange(x: Array, at: Array) -> Array:
    """Lagrange's polynomials at the places ``at``: the n-th is 1 at ``x[n]``, 0 at the others."""
    # The product of (at - x_m)/(x_n - x_m) over all m but n
    with np.errstate(all="ignore"):
        ratios = (at - x) / (x[:, None] - x)
    own = np.arange(len(x))
    ratios[own, own] = 1
    return np.asarray(ratios.prod(axis=1))


@dataclass(frozen=True, eq=False)
class Quadrature:
    """Speed, half widths and profile of the wave ``J v′² = v² (Q(B) - Q(v))`` on the strain p0.

    Methods raise `lwa.InputError` for a wave that the finest grid does not resolve.

    Parameters
    ----------
    law : callable
        Function of an array of strains that returns `Samples`.
    p0, B : float
        Static strain, and rise of the strain.
    resonance : float
        The sum R of the resonators.
    """

    law: Callable[[Array], Samples]
    p0: float
    B: float
    resonance: float = 0.0

    @cached_property
    def square(self) -> float:
        """The squared speed ``V² = Q(B)``."""
        return float(self._converged(Nodes.square))

    def half_width(self, of_force: bool = False) -> float:
        """The distance from the peak at which the strain, or the force F, has half of its rise."""
        # A width of the force is interpolated, and wants a finer grid.
        if of_force:
            return float(self._converged(Nodes.half_width_of_force, _STEPS[1:]).item())
        return float(self._converged(Nodes.half_width))

    def profile(self, places: Array) -> Array:
        """The ratio v/B at distances from the peak."""
        return self._converged(
            lambda nodes: nodes.profile(places), start=_FAR, least=_LEAST
        )

    def at(self, part: float) -> Samples:
        """The law where the wave has risen by a part of B."""
        return self.law(np.array(self.p0 + part * self.B))

    def refusal(self) -> str:
        """Reason why there is no wave; "" for a wave.

        A wave has ``0 < F′ < ∞``, ``BQ′(B) > 0``, ``Q(v) < Q(B)`` and ``J > 0``. As ``R V⁴``
        is not negative, J fails to be positive only where I does.
        """
        g = grid(_STEPS[0], _FAR)
        with np.errstate(all="ignore"):
            F1, F2, _ = self.law(g.strains(self.p0, self.B))
            slope_at_peak = F2 @ (2 * g.s * g.rest * g.ds)  # Q′(B)
            above_sound = F2 @ (g.rest**2 * g.ds)  # (Q(B) - Q(0))/B
            above_smaller = g.kernel @ F2  # (Q(B) - Q(v))/(B - v)
            gaps = np.append(above_smaller, [slope_at_peak, above_sound])
        if not np.all(F1 >= 0) or not np.isfinite(F1[-1]):
            return "F′ is not positive and finite from p0 to p0 + B"
        if np.any(F1 == 0):
            return (
                "F′ is 0 between p0 and p0 + B, or so small that its terms cancel to 0"
            )
        if not np.all(self.B * gaps > 0):
            return "the law does not stiffen towards p0 + B: a smaller wave would be as fast"
        # Each hundredth of the rise; closer to the foot I may be a rounding error.
        parts = np.linspace(0.01, 1, 100)
        law = self.law(self.p0 + self.B * parts)
        if not np.all(self.inertia(law) > 0):
            return "I is not positive from the load to the peak"
        return ""

    def inertia(self, law: Samples) -> Array:
        """The coefficient ``J = I F′ + R V⁴``."""
        J = law.slope * law.dispersion
        if self.resonance:  # V² costs time, and most lattices have no resonators
            J = J + self.resonance * self.square**2
        return J

    def _converged(
        self,
        compute: Callable[[Nodes], Array],
        steps: tuple[int, ...] = _STEPS,
        start: float = _NEAR,
        least: float = 0.0,
    ) -> Array:
        """Refine the grid until a result is the result of half as many nodes.

        The nodes are equally spaced in t, ``s = 1/(1 + exp(-π sinh t))``; t is 0 where the wave has
        half of its rise.

        Parameters
        ----------
        compute : callable
            Function from the wave at the nodes of a grid to the result.
        steps : tuple of int
            Nodes per unit of t of the grids, one after the other.
        start : float
            Least t of the rows, the nodes whose distances ξ from the peak are computed.
        least : float
            Size of a result below which its error is absolute.
        """
        for count in steps:
            # Every second node of the fine grid is a node of the coarse one.
            fine = grid(count, start)
            coarse = grid(count // 2, start)
            with np.errstate(all="ignore"):
                law = self.law(fine.strains(self.p0, self.B))
                found = compute(Nodes(self, fine, law))
                every_second = Samples(*(x[::2] for x in law))
                other = compute(Nodes(self, coarse, every_second))
                size = np.maximum(np.abs(found), least)
                if np.all(np.abs(found - other) <= _CLOSE * size):
                    return found
        raise InputError(
            f"p0 = {self.p0:.6g}, B = {self.B:.6g}: the law changes too much over the wave for "
            "float64"
        )


@dataclass(frozen=True, eq=False)
class Nodes:
    """A wave, and the law of the lattice at the nodes of a grid."""

    wave: Quadrature
    grid: Grid
    law: Samples

    def square(self) -> Array:
        """V²: ``2 ∫(1-s) F′ ds``, or ``F′(p0) + B ∫(1-s)² F″ ds`` for small waves."""
        g = self.grid
        F1 = self.law.slope
        # The sums of the weights are 1/2 and 1/3, but for rounding.
        first = g.ds * g.rest
        second = g.ds * g.rest**2
        change = self.wave.B / 3 * (self.law.bend @ second) / second.sum()
        # The change of a small wave keeps its digits in this sum, and would lose them as the
        # difference V² - F′(p0). Where it is negative, a quarter cancels no digit of F′(p0).
        if abs(change) < F1[0] / 4:
            return np.asarray(F1[0] + change)
        return np.asarray((F1 @ first) / first.sum())

    @cached_property
    def distances(self) -> Array:
        """The distances ``dξ = √J dv / (v √(Q(B) - Q(v)))`` between the nodes of the rows.

        With ``v = sB`` and the factor `Grid.length` they are ``length √J / √gap``, where the gap is
        ``B (Q(B) - Q(v))/(B - v)``.
        """
        B = self.wave.B
        J = self.wave.inertia(self.law)[self.grid.rows]
        # Roots first: their quotient neither over- nor underflows.
        above_smaller = np.sign(B) * (self.grid.kernel @ self.law.bend)
        root_of_gap = np.sqrt(above_smaller) * np.sqrt(abs(B))
        return np.asarray(self.grid.length * np.sqrt(J) / root_of_gap)

    @cached_property
    def places(self) -> Array:
        """The distances ξ of the rows from the peak, from the peak on.

        A row's ξ is the sum of the distances dξ from the row to the peak, by the weights of
        `Grid.to_peak`.
        """
        g = self.grid
        between_rows = g.to_peak[:, g.rows]
        return g.peak_first(between_rows @ self.distances)

    def half_width(self) -> Array:
        """The distance from the peak at which the strain has half of its rise."""
        # At half of the rise s is 1/2, at the middle one of all nodes.
        return np.asarray(self.places[len(self.grid.s) // 2])

    def half_width_of_force(self) -> Array:
        """The distance from the peak at which the force has half of its rise."""
        g = self.grid
        # Rise of the force from node to node, over B
        dF = self.law.slope * g.ds
        # The fall of the force from its peak to each row's node, in parts of the whole rise:
        # `to_peak` sums dF from the node to the peak.
        fall = g.peak_first(g.to_peak @ dF) / dF.sum()
        # ξ as a function of the fall, at one half
        return _interpolated(fall, self.places, np.array([0.5]))

    def profile(self, places: Array) -> Array:
        """The ratio v/B at distances from the peak."""
        g = self.grid
        # ln s is interpolated instead of s = v/B: the tail, an exponential, is a line in ξ.
        logs = g.peak_first(g.logs[g.rows])
        # Places beyond the last row get its v, on the finest grid 3e-13 B. The last rows of
        # two coarser grids differ by more than `Quadrature.profile` allows: the grid is refined.
        reached = np.minimum(places, self.places[-1])
        return np.exp(_interpolated(self.places, logs, reached))
