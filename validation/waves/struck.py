"""The pulse of a struck chain as a profile, made mirror symmetric.

The chain is that of `validation.pulses.steady`, masses 1, ω. At one of its last places the strains
of the two contacts of a cell are recorded, a(ξ) and b(ξ), and scaled to contact force 1. The pulse
leaves light beads in motion behind it and meets none, so that b(ξ) is not quite a(-ξ). Its
symmetric part (a(ξ) + b(-ξ))/2 has half of the tail on either side: to first order in the tail it
is one of the symmetric waves of `validation.waves.solver`. ξ = 0 is the mean of the two contacts'
centers of F - F_max/4^k, where that is positive.

As k → 1 the pulse needs ever longer to leave its wake; it is not waited for beyond `FARTHEST`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from validation.pulses.steady import PLACES, STRETCH, Chain, cells_apart
from validation.waves.fourier import ample_half_period
from validation.waves.profile import Profile

FARTHEST = 60  # cells from one place to the next
TOLERANCE = 1e-7  # of the run
_STEP = 0.01  # in ξ
_LONG = 2.0  # ample half periods on which the profile is kept


@dataclass(frozen=True, eq=False)
class Struck(Profile):
    """A struck chain's pulse at contact force 1; masses 1, ω.

    half_period : the ample one of `validation.waves.fourier`, on which things are read off.
    xi, front : a(ξ) made symmetric, on a wider grid.
    widths : FWHM of force and strain at a contact, the mean over the two as they are.
    """

    xi: Array
    front: Array
    widths: tuple[float, float]

    @property
    def samples(self) -> int:
        """The points of the grid."""
        return math.ceil(self.half_period / _STEP)

    @property
    def tail(self) -> float:
        """The largest |o| outside the pulse, half of what the chain is left with."""
        return self.rattle(self.pulse)

    @cached_property
    def _strain(self) -> Any:
        return scipy.interpolate.CubicSpline(self.xi, self.front)

    @cached_property
    def _impulse(self) -> tuple[Any, Any]:
        """∫ of the force from the left less that from the right, for m1 and m2."""
        pushes = (self.force(self.xi - 0.5, 1 - i) - self.force(self.xi + 0.5, i) for i in (0, 1))
        one, two = (scipy.interpolate.CubicSpline(self.xi, push) for push in pushes)
        return one.antiderivative(), two.antiderivative()

    def _front(self, xi: Array) -> Array:
        return np.asarray(self._strain(np.clip(xi, self.xi[0], self.xi[-1])))

    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        """Of the beads m1 or m2: what they have from ξ on, where they were at rest."""
        impulse = self._impulse[bead % 2]
        left = impulse(self.xi[-1]) - impulse(np.asarray(xi, float))
        return np.asarray(left / (self.masses[bead % 2] * self.c))


@lru_cache(maxsize=64)
def struck(k: float, omega: float) -> Struck:
    """Strike the chain, the heavy bead first, and read off its pulse; masses 1, ω.

    Raises `lwa.InputError` where the pulse does not come through.
    """
    if omega > 1:  # the mirror image, in units of the light bead's mass
        other = struck(k, 1 / omega)
        front = other.front[::-1].copy()
        return replace(other, masses=(1.0, omega), c2=other.c2 / omega, front=front)
    chain = Chain(k, omega, 2 * min(cells_apart(k, STRETCH), FARTHEST))
    record = chain.passed(chain.crossing, TOLERANCE)
    place = PLACES - 3  # the tail behind it has still to be recorded
    time, cell = record.run.time, slice(2 * place, 2 * place + 2)
    centers, peaks = [], []
    for part, whole in zip(record.parts[cell], record.run.contact_force[cell], strict=True):
        force = whole[part]
        # A leading pulse ends where its strain is a quarter of the peak's: on both sides, here.
        weights = np.maximum(force - force.max() / 4**k, 0)
        centers.append(np.average(time[part], weights=weights))
        peaks.append(float(force.max()))
    middle, peak = float(np.mean(centers)), math.sqrt(math.prod(peaks))
    width, strain_width, c, _ = chain.numbers(record)[:, place - 1].tolist()
    here = c * peak ** ((k - 1) / (2 * k))
    ample = ample_half_period((1.0, omega), k)
    half = np.arange(0, _LONG * ample, _STEP)
    xi = np.append(-half[:0:-1], half)
    a, b = (
        scipy.interpolate.CubicSpline(time, strain)(
            np.clip(middle + (site - xi) / here, 0, time[-1])
        )
        for strain, site in zip(record.run.compression[cell], (-0.5, 0.5), strict=True)
    )
    front = (a + b[::-1]) / 2 / peak ** (1 / k)
    return Struck((1.0, omega), k, c * c, ample, xi, front, (width, strain_width))
