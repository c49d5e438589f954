"""Static states of a lattice in floats: compressions, F′, F″ and I at any mean compression.

The displacements w inside a cell minimise the energy at a mean compression e = D p per spacing.
The energy is stationary there, hence F″ is the sum over the links of f″ (dδ/de)³ / P.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.links.bloch import Graph, acoustic, solved

_MOST = 100  # steps of Newton's method; strongly unlike links take ten
_ROUNDING = 1e-14  # of the mean compression: the step after the last one is exact
_RIGID = 1e8  # ratio of spring constants
_REACH = -100, 40  # powers of 2 between which the mean compression under a force is sought
_PARTS = 65  # places between two bounds, of which the next bounds are neighbours
_BOLDEST = 3.0  # largest step of ln δ
_LARGEST = 1e6  # compression of a link in series over the least that it may have at first
_LEAST = 1e-14  # least mean compression over the largest of a wave

Function = Callable[[Array], Array]


@dataclass(frozen=True)
class Statics:
    """Static states of a cell in floats.

    forces : for each link f, f′ and f″ of its compression, factor included.

    Arrays e of mean compressions have any shape; compressions have one more axis, of the links.
    """

    graph: Graph
    masses: Array
    forces: tuple[tuple[Function, ...], ...]

    def compressions(self, e: Array) -> Array:
        """Compressions of the links at mean compressions; NaN where there is no static state."""
        if self.graph.size == 1:
            return np.asarray(e[..., None] * self.graph.spans)
        return self._series(e) if self.graph.in_series else self._network(e)

    def _series(self, e: Array) -> Array:
        """Newton's method for links that carry one force f, in ln f and the ln δ of the links.

        Logarithms keep the digits of a compression that is far smaller than the mean. A step to
        where a law does not rise, as beyond a pole, is halved in the logarithm.
        """
        spans, total = self.graph.spans, self.graph.size * e
        delta = e[..., None] * spans
        before = delta / _LARGEST
        with np.errstate(all="ignore"):
            for _ in range(_MOST):
                force, springs = self.values(delta, 0), self.values(delta, 1)
                logs, gain = np.log(force * spans), force / springs  # dδ = gain d ln f
                missing = total - ((delta - logs * gain) / spans).sum(axis=-1)
                mean = missing / (gain / spans).sum(axis=-1)
                step = (mean[..., None] - logs) * gain / delta
                outside = ~((force > 0) & (springs > 0))
                step = np.where(outside, np.log(before / delta) / 2, step)
                step = np.where(np.isfinite(step), np.clip(step, -_BOLDEST, _BOLDEST), 0.0)
                before, delta = np.where(outside, before, delta), delta * np.exp(step)
                if not np.any(np.abs(step) > _ROUNDING):
                    break
        return np.asarray(delta)

    def _network(self, e: Array) -> Array:
        """Newton's method for the displacements inside the cell, damped: no contact is lost."""
        spans, incidence = self.graph.spans, self.graph.incidence[:, 1:]
        inner = np.zeros((*e.shape, self.graph.size - 1))
        for _ in range(_MOST):
            delta = e[..., None] * spans + inner @ incidence.T
            force, springs = self.values(delta, 0), self.values(delta, 1)
            step = -solved(incidence.T @ (springs[..., None] * incidence), force @ incidence)
            with np.errstate(all="ignore"):
                change = step @ incidence.T
                reach = np.where(change * delta < 0, -delta / (2 * change), 1.0)
                step *= np.minimum(1.0, reach.min(axis=-1))[..., None]
                inner += step
                if not np.any(np.abs(step).max(axis=-1) > _ROUNDING * e):
                    break
        return np.asarray(e[..., None] * spans + inner @ incidence.T)

    def values(self, delta: Array, n: int) -> Array:
        """The n-th derivative of each link's force at compressions of shape (…, links)."""
        with np.errstate(all="ignore"):
            columns = [force[n](delta[..., i]) for i, force in enumerate(self.forces)]
        return np.stack(columns, axis=-1)

    def force(self, e: Array) -> Array:
        """The mean force at mean compressions."""
        forces = self.values(self.compressions(e), 0)
        with np.errstate(invalid="ignore"):  # opposite infinities far beyond the wave
            return np.asarray(forces @ self.graph.spans / self.graph.size)

    def samples(self, e: Array) -> tuple[Array, Array, Array, Array]:
        """F′, F″, I and the shares dδ/de of the links at mean compressions, lengths in spacings."""
        if self.graph.size > 1:
            # Far below the largest e a compression, or a force, may be a rounding error.
            e = np.maximum(e, _LEAST * np.max(e))
        delta = self.compressions(e)
        springs, size = self.values(delta, 1), self.graph.size
        with np.errstate(all="ignore"):
            # A link that is so much stiffer is rigid for I, whose solution loses as many digits.
            soft = np.minimum(springs, _RIGID * np.abs(springs).min(axis=-1, keepdims=True))
            stiffness, dispersion, shares = acoustic(self.graph, soft, self.masses)
            if self.graph.in_series:
                stiffness = size / (1 / (springs * self.graph.spans**2)).sum(axis=-1)
                shares = stiffness[..., None] / (springs * self.graph.spans)
        bend = (self.values(delta, 2) * shares**3).sum(axis=-1) / size
        return stiffness, bend, dispersion, shares

    def mean_compression(self, force: float) -> float:
        """The mean compression under a force > 0; raises `lwa.InputError` if it is not reached."""
        e: Array = np.exp2(np.arange(*_REACH))
        while e[-1] > e[0] * (1 + 4e-16):
            above = np.flatnonzero(~(self.force(e) < force))
            if not len(above) or not above[0] or np.isnan(self.force(e[above[:1]]))[0]:
                raise InputError(f"force is {force}: the links do not reach it")
            low, high = e[above[0] - 1 : above[0] + 1]
            e = np.asarray(np.linspace(low, high, _PARTS))
        return float(e[-1])
