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
from lwa.linear.bloch import dispersion_of_chain
from lwa.linear.network import Network, solved

_MOST = 100  # steps of Newton's method; strongly unlike links take ten
_ROUNDING = 1e-14  # of the mean compression: the step after the last one is exact
# Ratio of spring constants: a link that is so much stiffer is rigid for I, whose solution loses as
# many digits.
_RIGID = 1e8
_REACH = (
    -100,
    40,
)  # powers of 2 between which the mean compression under a force is sought
_PARTS = 65  # places between two bounds, of which the next bounds are neighbours
_BOLDEST = 3.0  # largest step of ln δ
_LARGEST = (
    1e6  # compression of a link in series over the least that it may have at first
)
_LEAST = 1e-14  # least mean compression over the largest of a wave
_SMALL = 0.1  # rise over e from which on a difference of compressions has 15 digits
_NODES = 10  # of Gauss's rule: laws with a singularity at δ = 0 err by 1e-20 over such a rise

Function = Callable[[Array], Array]


@dataclass(frozen=True)
class Statics:
    """Static states of a cell in floats.

    forces : for each link f, f′ and f″ of its compression, factor included.

    Arrays e of mean compressions have any shape; compressions have one more axis, of the links.
    """

    network: Network
    masses: Array
    forces: tuple[tuple[Function, ...], ...]

    def compressions(self, e: Array) -> Array:
        """Compressions of the links at mean compressions; NaN where there is no static state."""
        if self.network.size == 1:
            return np.asarray(e[..., None] * self.network.spans)
        return self._series(e) if self.network.in_series else self._network(e)

    def _series(self, e: Array) -> Array:
        """Newton's method for links that carry one force f, in ln f and the ln δ of the links.

        Logarithms keep the digits of a compression that is far smaller than the mean. A step to
        where a law does not rise, as beyond a pole, is halved in the logarithm.
        """
        spans, total = self.network.spans, self.network.size * e
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
                step = np.where(
                    np.isfinite(step), np.clip(step, -_BOLDEST, _BOLDEST), 0.0
                )
                before, delta = np.where(outside, before, delta), delta * np.exp(step)
                if not np.any(np.abs(step) > _ROUNDING):
                    break
        return np.asarray(delta)

    def _network(self, e: Array) -> Array:
        """Newton's method for the displacements inside the cell, damped: no contact is lost."""
        spans, incidence = self.network.spans, self.network.incidence[:, 1:]
        inner = np.zeros((*e.shape, self.network.size - 1))
        for _ in range(_MOST):
            delta = e[..., None] * spans + inner @ incidence.T
            force, springs = self.values(delta, 0), self.values(delta, 1)
            with np.errstate(all="ignore"):  # far beyond the wave forces are infinite
                step = -solved(
                    incidence.T @ (springs[..., None] * incidence), force @ incidence
                )
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
            return np.asarray(forces @ self.network.spans / self.network.size)

    def samples(self, e: Array) -> tuple[Array, Array, Array]:
        """F′, F″ and I at mean compressions, lengths in spacings."""
        network, size = self.network, self.network.size
        if size > 1:
            # Far below the largest e a compression, or a force, may be a rounding error.
            e = np.maximum(e, _LEAST * np.max(e))
        delta = self.compressions(e)
        springs = self.values(delta, 1)
        with np.errstate(all="ignore"):
            if network.in_series:
                compliances = 1 / (springs * network.spans**2)
                stiffness = size / compliances.sum(axis=-1)
                shares = stiffness[..., None] / (springs * network.spans)
                row = [compliances[..., n] * stiffness for n in network.order]
                dispersion = dispersion_of_chain(self.masses / self.masses.sum(), row)
            else:
                soft = np.minimum(
                    springs, _RIGID * np.abs(springs).min(axis=-1, keepdims=True)
                )
                stiffness, dispersion, shares = network.acoustic(soft, self.masses)
        bend = (self.values(delta, 2) * shares**3).sum(axis=-1) / size
        return stiffness, bend, dispersion + 0 * e

    def mean_compression(self, force: float) -> float:
        """The mean compression under a force > 0; raises `lwa.InputError` if it is not reached."""
        e: Array = np.exp2(np.arange(*_REACH))
        while e[-1] > e[0] * (1 + 4e-16):
            above = np.flatnonzero(
                ~(self.force(e) < force)
            )  # or NaN, beyond the reach of a law
            if not len(above) or not above[0]:
                raise InputError(f"force is {force:g}: the links do not reach it")
            low, high = e[above[0] - 1 : above[0] + 1]
            e = np.asarray(np.linspace(low, high, _PARTS))
        if np.isnan(self.force(e[-1:])[0]):
            raise InputError(f"force is {force:g}: the links do not reach it")
        return float(e[-1])

    def rise(self, e: float, force: float, added: float) -> float:
        """The rise of the mean compression from e to that under a force, which is larger by added.

        A small difference of compressions has lost its digits: the force added over the mean F′
        between them, by Gauss's rule, has not.
        """
        rough = self.mean_compression(force) - e
        if abs(rough) > _SMALL * e:
            return rough
        places, weights = np.polynomial.legendre.leggauss(_NODES)
        return added / float(
            self.samples(e + rough * (1 + places) / 2)[0] @ weights / 2
        )
