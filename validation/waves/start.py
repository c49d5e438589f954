"""Starts of Newton's method: the theory's wave, a near wave, and the pulse of a struck chain."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from validation.pulses.pulse import leading_pulses
from validation.pulses.steady import PLACES, STRETCH, StruckDimer, cells_apart
from validation.waves import newton
from validation.waves.profile import LatticeWave

FARTHEST = 60  # cells from one place to the next; as k → 1 a pulse leaves its wake ever more slowly
TOLERANCE = 1e-7  # rtol of the struck chain
_CENTER = 2001  # times between which the center of a pulse is summed
_STEP = 0.01  # grid of the struck chain's profile, in ξ
_LONG = 2.0  # ample half periods on which the profile is kept

Start = tuple[Array, float]
"""Forces F_a on the grid of a `validation.waves.newton.Problem`, and c²."""


def initial(problem: newton.Problem, wave: LatticeWave | None = None) -> Start:
    """Return forces and c² to start from: those of a wave of near masses and k, or the theory's."""
    k, (m1, m2) = problem.k, problem.masses
    if wave is not None:
        force, c2 = wave.force(problem.xi), wave.c2 * sum(wave.masses) / (m1 + m2)
    else:
        # The force cos^{2k/(k-1)}(βξ), and c² = 4/((k+1)(m1+m2)). The two contacts' forces are
        # shifted by (m2-m1)/(m1+m2), so that both beads move alike.
        beta = (k - 1) * math.sqrt(6 / (k * (k + 1))) / newton.widening(problem.masses)
        phase = beta * (problem.xi - (m2 - m1) / (m1 + m2) / 2)
        force = np.cos(np.clip(phase, -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
        c2 = 4 / ((k + 1) * (m1 + m2))
    # c² of the wave scaled to force 1 at ξ = 0; `newton.Problem.wave` scales the forces.
    return force, c2 * float(force[0]) ** ((1 - k) / k)


@dataclass(frozen=True, eq=False)
class StruckPulse(LatticeWave):
    """Symmetric part of a struck chain's pulse, scaled to contact force 1; masses 1, ω."""

    xi: Array  # a grid beyond the half period
    strains: Array  # symmetric part of the strain on the grid
    widths: tuple[float, float]  # FWHM of force and strain, means over the two recorded contacts

    @property
    def samples(self) -> int:
        """Number of points on 0 … L that resolve the profile."""
        return math.ceil(self.half_period / _STEP)

    @property
    def tail(self) -> float:
        """Largest |o| outside the pulse, o being the odd part of the strain."""
        return self.odd_strain(self.pulse)

    @cached_property
    def _spline(self) -> Any:
        return scipy.interpolate.CubicSpline(self.xi, self.strains)

    @cached_property
    def _impulse(self) -> tuple[Any, Any]:
        """Antiderivatives, as functions of ξ, of the net force on m1 and on m2."""
        pushes = (self.force(self.xi - 0.5, 1 - i) - self.force(self.xi + 0.5, i) for i in (0, 1))
        one, two = (scipy.interpolate.CubicSpline(self.xi, push) for push in pushes)
        return one.antiderivative(), two.antiderivative()

    def _behind(self, xi: Array) -> Array:
        return np.asarray(self._spline(np.clip(xi, self.xi[0], self.xi[-1])))

    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        """Velocity of beads m1 or m2 from the impulse of the net force; 0 ahead of the pulse."""
        impulse = self._impulse[bead % 2]
        left = impulse(self.xi[-1]) - impulse(np.asarray(xi, float))
        return np.asarray(left / (self.masses[bead % 2] * self.c))


@lru_cache(maxsize=64)
def struck_pulse(k: float, omega: float) -> StruckPulse:
    """Strike the first bead, a heavy one, of a chain of masses 1, ω, and record the pulse.

    Raises `lwa.InputError` if the pulse does not reach the last place.
    """
    if omega > 1:  # the mirror image, in units of the light bead's mass
        other = struck_pulse(k, 1 / omega)
        strains = other.strains[::-1].copy()
        return replace(other, masses=(1.0, omega), c2=other.c2 / omega, strains=strains)
    chain = StruckDimer(k, omega, 2 * min(cells_apart(k, STRETCH), FARTHEST))
    places = [n * chain.sites for n in range(1, PLACES + 1)]
    run, quarter = chain.run(places, chain.crossing(places[-1]), TOLERANCE), 0.25**k
    place = PLACES - 3  # the tail behind the pulse is recorded there, too
    cell = run.scene.contact_sensors[2 * place : 2 * place + 2]
    centers, peaks = [], []
    for contact in cell:
        force = run.signal("contact", contact)
        # A leading pulse ends at a quarter of its peak strain: the same cut on both sides.
        (cut,) = leading_pulses(force, k, (quarter,))
        # ξ = 0 is the mean of the two contacts' centers of max(F - F_max/4^k, 0).
        time = np.linspace(cut.rise, cut.fall, _CENTER)
        centers.append(np.average(time, weights=force(time) - quarter * cut.peak))
        peaks.append(cut.peak)
    middle, peak = float(np.mean(centers)), math.sqrt(math.prod(peaks))
    width, strain_width, c, _ = chain.numbers(chain.passages(run))[:, place - 1].tolist()
    speed = c * peak ** ((k - 1) / (2 * k))
    ample = newton.ample_half_period((1.0, omega), k)
    half = np.arange(0, _LONG * ample, _STEP)
    xi = np.append(-half[:0:-1], half)
    a, b = (
        run.signal("contact", contact, "compression")(
            np.clip(middle + (site - xi) / speed, 0, run.scene.duration)
        )
        for contact, site in zip(cell, (-0.5, 0.5), strict=True)
    )
    # Light beads are in motion behind the pulse and at rest ahead, so that b(ξ) is not quite a(-ξ).
    # The symmetric part (a(ξ) + b(-ξ))/2 has half of the tail on either side; to first order in the
    # tail it is a symmetric wave of the lattice.
    strains = (a + b[::-1]) / 2 / peak ** (1 / k)
    return StruckPulse((1.0, omega), k, c * c, ample, xi, strains, (width, strain_width))
