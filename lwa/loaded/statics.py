"""Static states of a lattice in floats: compressions, slopes and dispersion at a mean compression.

The displacements w inside a cell minimise the energy at a mean compression ``e = D p`` per spacing.
The energy is stationary there, hence ``F″`` is the sum over the links of ``f″ (dδ/de)³ / P``.

Arrays of mean compressions have any shape. Arrays of compressions, and of displacements inside the
cell, have one more axis, of the links or of the particles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.linear.springs import Network, solved

_MOST = 100  # most steps of Newton's method; strongly unlike links take ten
_ROUNDING = 1e-14  # last step of Newton's method, over the mean compression
# Most halvings of a step of Newton's method; the last one is lost in rounding.
_HALVINGS = 60
# Spring constant of an open link in Newton's method, over the largest one, for a regular matrix
_OPEN = 1e-9
# Largest ratio of spring constants. The solution for I loses as many digits, and the result of a
# stiffer link, rigid in effect, differs by one part in this number: half of a double's digits each.
_RIGID = 1e8
# Relative rounding of forces that are differences, such as exp(δ) - 1
_NOISE = 1e-9
# Exponents of the powers of 2, the last one left out, among which the first bounds of a mean
# compression are sought: 8e-31 to 5e11 in the unit of length
_REACH = (-100, 40)
# Places between two bounds, of which the next bounds are neighbours: 64 steps are six bits, and
# nine rounds the 52 bits of a double
_PARTS = 65
# Largest step of ln δ: 1 to 5 find the states of the same random cells in as many steps, 10 fails
_BOLDEST = 3.0
# Compression of a link in series over the least that it may have at first: 10 to 1e15 do as well,
# since steps back towards the least one are halved in the logarithm
_LARGEST = 1e6
_LEAST = 1e-14  # least mean compression over the largest of a wave
_SMALL = 0.1  # rise over e from which on a difference of compressions has 15 digits
_NODES = 10  # nodes of Gauss's rule, by which laws singular at δ = 0 err by 1e-20 over such a rise

Function = Callable[[Array], Array]


class Samples(NamedTuple):
    """The static law and the dispersion at strains, lengths in spacings.

    Parameters
    ----------
    slope, bend : Array
        ``F′`` and ``F″``.
    dispersion : Array
        The coefficient I in ``Ω² = c² (q² - I q⁴ + …)``, resonators left out.
    """

    slope: Array
    bend: Array
    dispersion: Array


@dataclass(frozen=True)
class Statics:
    """Static states of a cell in floats.

    Parameters
    ----------
    network : Network
        The links.
    masses : Array
        Masses of the particles.
    laws : tuple of tuples of callables
        For each link its law F(δ) and the first two derivatives.
    factors : Array
        Factor of each link's force.
    """

    network: Network
    masses: Array
    laws: tuple[tuple[Function, ...], ...]
    factors: Array

    def compressions(self, e: Array) -> Array:
        """Compressions of the links at mean compressions; NaN where there is no static state."""
        if self.network.size == 1:
            return e[..., None] * self.network.spans
        return self._series(e) if self.network.in_series else self._network(e)

    def _series(self, e: Array) -> Array:
        """Newton's method for links that carry one force f, in ln f and the ln δ of the links.

        A static state at the mean compression e has, for each link of the law ``F_l``::

            cosine_l F_l(δ_l) = f,    Σ_l δ_l/cosine_l = P e,    δ_l > 0.

        To first order link l has at ln f the compression ``δ_l + g_l (ln f - logs_l)``, with
        ``g_l = dδ_l/d ln f`` and ``logs_l`` the ln f that belongs to the present ``δ_l``.

        Logarithms keep the digits of a compression that is far smaller than the mean. If a step
        takes a link to where its law does not rise, as beyond a pole, this link goes half of the
        way in the logarithm back to its last compression inside; the other links wait.
        """
        spans = self.network.spans  # the cosines: each link joins neighbours
        total = self.network.size * e
        delta = e[..., None] * spans
        inside = delta / _LARGEST  # the last compressions at which the laws rise
        with np.errstate(all="ignore"):
            for _ in range(_MOST):
                force = self.values(delta, 0)
                springs = self.values(delta, 1)
                rises = (force > 0) & (springs > 0)
                # dδ/d ln f = F/F′ of each link
                gain = force / springs
                logs = np.log(force * spans)
                # ``common`` is the ln f at which, to first order, the compressions add up to the
                # total; ``at_unit_force`` are their terms at ln f = 0.
                at_unit_force = (delta - logs * gain) / spans
                missing = total - at_unit_force.sum(axis=-1)
                common = missing / (gain / spans).sum(axis=-1)
                forward = (common[..., None] - logs) * gain / delta
                back = np.log(inside / delta) / 2
                # The forces of links that rise mean nothing while another link is beyond its law.
                held = np.where(rises, 0.0, back)
                step = np.where(rises.all(axis=-1, keepdims=True), forward, held)
                # Far from the state the first order overshoots.
                bounded = np.clip(step, -_BOLDEST, _BOLDEST)
                step = np.where(np.isfinite(step), bounded, 0.0)
                inside = np.where(rises, delta, inside)
                delta = delta * np.exp(step)
                if np.all(np.abs(step) <= _ROUNDING):
                    break
        return delta

    def _network(self, e: Array) -> Array:
        """Newton's method for the displacements w inside the cell, at which the energy is least.

        The compressions are ``δ = e spans + Bw``, B the incidence matrix. Where the energy is least
        the particles bear no force, and a step Δw makes this so to first order::

            Bᵀ F(δ) = 0,    Bᵀ F′(δ) B Δw = -Bᵀ F(δ).

        The energy is convex where laws rise. Its slope along a step tells if the step is too long.
        """
        # The first particle stays where it is.
        incidence = self.network.incidence[:, 1:]
        delta = e[..., None] * self.network.spans
        # Trial values far above the wave's have infinite forces.
        with np.errstate(all="ignore"):
            for _ in range(_MOST):
                force = self.values(delta, 0)
                springs = self.values(delta, 1)
                stiffest = springs.max(axis=-1, keepdims=True)
                held = np.maximum(springs, _OPEN * stiffest)
                matrix = incidence.T @ (held[..., None] * incidence)
                unbalanced = force @ incidence  # on each particle
                change = -solved(matrix, unbalanced) @ incidence.T
                step = self._part(delta, change) * change
                delta = delta + step
                largest = np.abs(step).max(axis=-1)
                if not np.any(largest > _ROUNDING * e):
                    break
        return delta

    def _part(self, delta: Array, change: Array) -> Array:
        """The part 1, 1/2, 1/4, … of a step behind which the energy is no steeper than before."""
        force = self.values(delta, 0)
        # The energy's slope along the step, and what rounding may add to this slope
        steep = np.abs((force * change).sum(axis=-1))
        steep += _NOISE * (np.abs(force) * np.abs(change)).sum(axis=-1)
        part = np.ones_like(steep)
        for _ in range(_HALVINGS):
            ahead = self.values(delta + part[..., None] * change, 0)
            slope = (ahead * change).sum(axis=-1)
            fine = np.abs(slope) <= steep
            if np.all(fine | np.isnan(steep)):
                break
            part = np.where(fine, part, part / 2)
        return np.asarray(part[..., None])

    def values(self, delta: Array, n: int) -> Array:
        """The n-th derivative of each link's force at compressions of shape (…, links)."""
        # A trial step may lie beyond a law's pole or range: inf and NaN there are answers.
        with np.errstate(all="ignore"):
            columns = [law[n](delta[..., i]) for i, law in enumerate(self.laws)]
            return np.stack(columns, axis=-1) * self.factors

    def force(self, e: Array) -> Array:
        """The mean force at mean compressions."""
        forces = self.values(self.compressions(e), 0)
        with np.errstate(invalid="ignore"):  # opposite infinities far beyond the wave
            return forces @ self.network.spans / self.network.size

    def samples(self, e: Array) -> Samples:
        """``F′``, ``F″`` and I at mean compressions."""
        size = self.network.size
        if size > 1:
            # Far below the largest e a compression, or a force, may be a rounding error.
            e = np.maximum(e, _LEAST * np.max(e))
        delta = self.compressions(e)
        springs = self.values(delta, 1)
        with np.errstate(all="ignore"):
            is_open = springs == 0
            of_closed = np.where(is_open, np.inf, np.abs(springs))
            softest = of_closed.min(axis=-1, keepdims=True)
            # An open link still holds a particle that no other link holds.
            springs = np.where(is_open, softest / _RIGID, springs)
            springs = np.minimum(springs, softest * _RIGID)
            stiffness, dispersion, shares = self.network.acoustic(springs, self.masses)
        bends = self.values(delta, 2) * shares**3
        bend = bends.sum(axis=-1) / size
        # I of a chain of alike links is one number for all e.
        return Samples(stiffness, bend, dispersion + 0 * e)

    def mean_compression(self, force: float) -> float:
        """The mean compression under a force > 0; raises `lwa.InputError` if it is not reached."""
        unreached = InputError(f"force is {force:g}: the links do not reach it")
        e: Array = np.exp2(np.arange(*_REACH))
        # 4e-16 is two units of the last place: the bounds are neighbours.
        while e[-1] > e[0] * (1 + 4e-16):
            # A force beyond the reach of a law is NaN.
            above = np.flatnonzero(~(self.force(e) < force))
            if not len(above) or above[0] == 0:
                raise unreached
            low, high = e[above[0] - 1 : above[0] + 1]
            e = np.linspace(low, high, _PARTS)
        if np.isnan(self.force(e[-1:])[0]):
            raise unreached
        return float(e[-1])

    def rise(self, e: float, force: float, added: float) -> float:
        """The rise of the mean compression from e to that under ``force``.

        The lattice at e carries ``force`` less ``added``: the difference of two forces has more
        digits than the forces, if it is computed before they become floats. A small difference of
        compressions has lost its digits; ``added`` over the mean ``F′`` between them, by Gauss's
        rule, has not.
        """
        rough = self.mean_compression(force) - e
        if abs(rough) > _SMALL * e:
            return rough
        places, weights = np.polynomial.legendre.leggauss(_NODES)
        # Gauss's places and weights are those of the interval from -1 to 1.
        between = e + rough * (1 + places) / 2
        mean_slope = self.samples(between).slope @ weights / 2
        return added / float(mean_slope)
