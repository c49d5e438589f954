"""A traveling wave of the lattice as trigonometric polynomials, and what is read off a profile.

The wave is that of `validation.waves.fourier`, A = D = 1: a contact's strain is a(ξ) = e + o or
b(ξ) = a(-ξ), ξ = x - ct. As the contact law r_+^k has no scale of its own, its multiples are waves,
too: r → s r with c² → s^{k-1} c². A wave is given at contact force 1, `ExactWave.scaled` at others.
On a background p0, which is multiplied by s as well, strains and forces are what the wave adds to
p0 and p0^k; the contact force that peaks at 1 is the sum.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from lwa.base.quantities import QUANTITIES, strain_power
from validation.pulses.pulse import MeasureError
from validation.scenes.checks import SceneError, positive
from validation.waves import fourier

TOLERANCE = 1e-9  # of the tail, over the peak strain, and of the residual, of a solitary wave
OUTSIDE = 0.6  # of the half period: where the pulse of a dimer has ended, and its tail is measured
_ROW = 16  # of Fourier coefficients that are summed up together


@dataclass(frozen=True, eq=False)
class Profile(ABC):
    """A pulse of a chain as a function of ξ = x - ct, mirror symmetric about a bead; A = D = 1.

    half_period : L, up to which it is known.
    """

    masses: tuple[float, float]
    k: float
    c2: float
    half_period: float
    background = 0.0

    @property
    @abstractmethod
    def samples(self) -> int:
        """On 0 … L, from which on its humps are told apart."""

    @abstractmethod
    def _front(self, xi: Array) -> Array:
        """a(ξ)."""

    def strain(self, xi: ArrayLike, contact: int = 0) -> Array:
        """a(ξ) (contact 0, m1 to its left) or b(ξ) = a(-ξ) (contact 1); a gap is negative."""
        at = np.asarray(xi, float)
        return self._front(-at if contact % 2 else at)

    @abstractmethod
    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        """Of the beads m1 (bead 0) or m2 (bead 1); far from the pulse a cell has no momentum."""

    @property
    def c(self) -> float:
        """The speed dx/dt."""
        return math.sqrt(self.c2)

    @property
    def omega(self) -> float:
        """ω = m2/m1."""
        return self.masses[1] / self.masses[0]

    @property
    def pulse(self) -> float:
        """The |ξ| within which it is read off: a dimer's without its tail."""
        if self.background:
            return self.half_period
        ample = fourier.ample_half_period((1.0, self.omega), self.k)
        return min(self.half_period, ample if self.omega == 1 else OUTSIDE * ample)

    def force(self, xi: ArrayLike, contact: int = 0) -> Array:
        """F_a(ξ) or F_b(ξ), above that of the background."""
        return fourier.rise(self.strain(xi, contact), self.k, self.background)

    def quantity(self, name: str, xi: ArrayLike) -> Array:
        """ "strain", "force" (of contact 0) or "velocity" (of bead m1), as in `lwa`."""
        strain_power(name, self.k)  # refuses other names
        return np.asarray(getattr(self, name)(xi))

    def peak(self, name: str) -> tuple[float, float]:
        """Where a quantity is greatest, and its value there."""
        xi = np.linspace(-self.half_period, self.half_period, 4 * self.samples + 1)
        return summit(lambda x: self.quantity(name, x), xi)

    def fwhm(self, name: str = "strain") -> float:
        """Full width at half maximum, in D, of the highest hump: roots of the profile itself.

        Raises `MeasureError` where the quantity does not fall to half its peak.
        """
        top, peak = self.peak(name)

        def above(r: Any, side: int) -> Array:
            return self.quantity(name, top + side * r) - peak / 2

        distance, width = np.linspace(0, self.half_period, 4 * self.samples), 0.0
        for side in (-1, 1):
            below = int(np.argmax(above(distance, side) < 0))
            if not below:
                raise MeasureError(f"the {name} has no FWHM: its tail is above half its peak")
            ends = distance[below - 1 : below + 1]
            width += scipy.optimize.brentq(above, *ends, (side,), xtol=1e-14, rtol=1e-14)
        return float(width)

    def over_peak(self, xi: ArrayLike) -> dict[str, Array]:
        """Strain, force and velocity, each over its peak."""
        return {name: self.quantity(name, xi) / self.peak(name)[1] for name in QUANTITIES}

    def plot(self, ax: Any = None) -> Any:
        """Draw `over_peak` on |ξ| ≤ L into Matplotlib's axes, or into new ones; returns them."""
        from lwa.wave.plots import axes  # optional, start-up

        ax = axes(ax)
        xi = np.linspace(-self.half_period, self.half_period, 2001)
        for (name, values), style in zip(self.over_peak(xi).items(), ("-", "--", ":"), strict=True):
            ax.plot(xi, values, style, label=name)
        ax.set(xlabel="ξ / D", ylabel="over its peak")
        ax.legend()
        return ax

    def rms_width(self, name: str = "strain") -> float:
        """√(∫ (ξ - mean)² f / ∫ f) over the pulse; positive values only (gaps do not count)."""
        n = 8 * self.samples
        xi = self.pulse * np.arange(-n, n) / n  # trapezia: exact for what has ended
        f = np.maximum(self.quantity(name, xi), 0.0)
        mean = (f @ xi) / f.sum()
        return math.sqrt(f @ (xi - mean) ** 2 / f.sum())

    def rattle(self, start: float) -> float:
        """The largest |o| on start ≤ |ξ| ≤ L: how far light beads are from their places."""
        outside = np.linspace(start, self.half_period, 2 * self.samples)
        return summit(lambda x: np.abs(self.strain(x) - self.strain(-x)) / 2, outside)[1]

    def apart(self, other: Profile) -> float:
        """The largest difference of two strains over the pulse."""
        xi = np.linspace(-self.pulse, self.pulse, 401)
        return float(np.abs(self.strain(xi) - other.strain(xi)).max())


@dataclass(frozen=True, eq=False)
class ExactWave(Profile):
    """One traveling wave; A = D = 1.

    masses, k, c2 : (m1, m2), the exponent, and the square of the speed dx/dt.
    half_period : L; profiles are periodic with 2L, a solitary wave's end before.
    even, odd : coefficients of E in cos(πjξ/L), j = 0 … n, and of O in sin(πjξ/L).
    tail : largest |o| outside the pulse, over the peak strain.
    residual : of the equations of motion, integrated twice, over the peak strain; on a grid twice
        as fine as that on which they were solved.
    background : p0, the strain far from the wave.
    """

    even: Array
    odd: Array
    tail: float
    residual: float
    background: float = 0.0

    @property
    def samples(self) -> int:
        """The points of the grid."""
        return len(self.even)

    @property
    def solitary(self) -> bool:
        """Whether the wave ends within L and has no tail, as far as its residual lets one say."""
        return max(self.tail, self.residual, self.rest) < TOLERANCE

    @cached_property
    def rest(self) -> float:
        """Of equal masses: the strain that the forces leave at L, where it is set to 0, over the
        peak strain. It is c² times that, ∫ (1-|s|) F(L-s) ds, the mean of (*) at q = 0."""
        if self.omega != 1:
            return 0.0
        even, c2 = self._strains[0], self.c2 * self.masses[0]
        return float(abs(self.even[0] / c2 - even[0]) / even.sum())

    def scaled(self, *, speed: Any = None, force: Any = None) -> ExactWave:
        """The same wave of another speed dx/dt, or of another peak force of its contacts.

        Raises `SceneError` unless one of the two is given, positive, and the strains are floats.
        """
        if (speed is None) == (force is None):
            raise SceneError("speed or force is wanted: a wave is scaled to one of the two")
        with np.errstate(over="ignore", under="ignore"):
            if speed is not None:
                what, now = f"speed is {speed}", np.float64(positive(speed, "speed") / self.c)
                now **= 2 / (self.k - 1)
            else:
                what, now = f"force is {force}", np.float64(positive(force, "force"))
                now = now ** (1 / self.k) / (self.background + self.peak("strain")[1])
            scale = float(now ** max(self.k, 2.0))
        if not 1e-200 < scale < 1e200:
            raise SceneError(f"{what}: {now:.1e} times the strain here is out of range")
        return self.times(float(now))

    def times(self, s: float) -> ExactWave:
        """The wave of s times these strains, on s times this background."""
        c2, force, p0 = float(self.c2 * s ** (self.k - 1)), s**self.k, s * self.background
        return replace(self, c2=c2, even=self.even * force, odd=self.odd * force, background=p0)

    @cached_property
    def _strains(self) -> tuple[Array, Array]:
        light, c2 = 1 / self.omega, self.c2 * self.masses[0]  # 1/m1 itself may be out of range
        odd = self.odd if light != 1 else 0 * self.odd  # but for rounding, over q²
        found = fourier.respond(self.even - 1j * odd, (1, light), self.half_period) / c2
        e, o = found.real, -found.imag
        e[0] = e[1::2].sum() - e[2::2].sum()  # the strain is 0 at L
        o[-1] = 0
        return e, o

    def _front(self, xi: Array) -> Array:
        return np.where(self._ended(xi), 0.0, self._sum(xi, *self._strains))

    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        one, two = (float(self._velocity(np.array(self.half_period), i)) for i in (0, 1))
        mean = (one + self.omega * two) / (1 + self.omega)
        return np.where(self._ended(xi), 0.0, self._velocity(xi, bead) - mean)

    def _velocity(self, xi: ArrayLike, bead: int) -> Array:
        sign, q = (-1 if bead % 2 else 1), np.pi / self.half_period * np.arange(1, self.samples)
        push = -2 * np.sin(q / 2) * self.even[1:] + sign * 2 * np.cos(q / 2) * self.odd[1:]
        row = np.append(0.0, -push / q) / (self.masses[bead % 2] * self.c)
        return self._sum(xi, row, 0 * row)

    def _sum(self, xi: ArrayLike, even: Array, odd: Array) -> Array:
        rows = np.append(even - 1j * odd, np.zeros(-self.samples % _ROW)).reshape(-1, _ROW)
        q = np.pi / self.half_period * np.arange(rows.size)
        # e^{iqξ} of every q from those of the first ones and of every 16th.
        first, every = (np.exp(1j * np.multiply.outer(xi, part)) for part in (q[:_ROW], q[::_ROW]))
        return np.asarray(((first @ rows.T) * every).real.sum(axis=-1))

    def _ended(self, xi: ArrayLike) -> NDArray[np.bool_]:
        """Where a wave that ends has ended: it is not repeated, and no rounding moves a bead."""
        return np.asarray((np.abs(xi) >= self.half_period) & self.solitary)


def at_unit_force(
    masses: tuple[float, float], problem: fourier.Problem, forces: Array, c2: float
) -> ExactWave:
    """The wave that solves a problem, scaled to a force 1 at its peak; its tail and residual."""
    even, odd = fourier.coefficients(problem.forces(forces))
    wave = ExactWave(masses, problem.k, c2, problem.L, even, odd, 0.0, 0.0, problem.p0)
    wave = wave.times(1 / (problem.p0 + wave.peak("strain")[1]))
    tail = 0.0 if problem.uniform else wave.rattle(OUTSIDE * problem.L)
    return replace(wave, tail=tail, residual=_residual(wave))


def _residual(wave: ExactWave) -> float:
    """max |r - r[F(r)]| on the grid twice as fine, for both contacts, over the peak strain."""
    xi = fourier.circle(wave.half_period, 2 * (len(wave.even) - 1))
    even, odd = fourier.coefficients(wave.force(xi))
    again = replace(wave, even=even, odd=odd)
    return float(np.abs(again.strain(xi) - wave.strain(xi)).max()) / (1 - wave.background)


def summit(f: Callable[[Any], Array], xi: Array) -> tuple[float, float]:
    """The maximum of a smooth function near the largest of its samples; its place to 1e-8."""
    value = f(xi)
    i = int(np.argmax(value))
    bounds = xi[max(i - 1, 0)], xi[min(i + 1, len(xi) - 1)]
    top = scipy.optimize.minimize_scalar(
        lambda x: -float(f(x)), bounds=bounds, method="bounded", options={"xatol": 1e-9}
    )
    peak, place = max((value[i], xi[i]), (-top.fun, top.x))
    return float(place), float(peak)
