"""Profiles of traveling waves of the lattice: strains, forces, velocities, peaks, widths, tails.

``A = D = 1``. A contact's strain is a(ξ) or ``b(ξ) = a(-ξ)``, ``ξ = x - ct``
(`validation.waves.newton`). The contact law ``r_+^k`` has no scale of its own, so that multiples of
a wave are waves: s times the strain with ``s^{k-1}`` times c². Waves are found at peak contact
force 1; `ExactWave.times` gives the others. On a background p0, which is multiplied by s too,
strains and forces are those added to p0 and ``p0^k``, and the force of peak 1 is the sum.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite
from lwa.base.frozen import Estimate
from lwa.base.words import QUANTITIES, QuantityName, one_of
from validation.pictures import Curve, Panel, Pictured
from validation.pulses.pulse import Piecewise, Pulse, highest_pulse
from validation.scenes.checks import between, integer
from validation.waves import newton

TOLERANCE = 1e-9  # tail and residual of a solitary wave over its peak strain, at most
# Relative error of a solitary wave's numbers by rounding, over k + 1/bend: a wave is bent by bend =
# (k - 1)(1 - p0) of its strain. 1.1 times the differences between grids or more (k = 1.02 … 60, p0
# = 0 … 0.9999, special ratios); of equal beads some number differs by 1/20 of its error or more.
ROUNDING = 2e-15
OUTSIDE = 0.6  # share of the half period at which a dimer's pulse has ended and its tail begins

Number = Literal["c2", "c", "tail", "peak", "fwhm"]
"""Numbers of an exact wave that have errors."""

_NUMBERS = get_args(Number)


@dataclass(frozen=True, eq=False)
class ExactWave(Pictured):
    """A traveling wave of the lattice as a function of ``ξ = x - ct``, accurate to rounding.

    Stiffness and spacing are 1.

    Parameters
    ----------
    masses : (float, float)
        m1 and m2.
    k : float
        Exponent.
    c2 : float
        c², the square of the speed dx/dt.
    half_period : float
        L; profiles have the period 2L, and a solitary wave ends before L.
    series : ndarray of complex, shape (n + 1,)
        Coefficients ``f_j`` of the force of contact 0, ``F_a = Re Σ f_j exp(iπjξ/L)``.
    tail : float
        Largest ``|o|``, the odd part of a, outside the pulse, divided by the peak strain.
    residual : float
        Largest error in the twice integrated equations of motion divided by the peak strain, on a
        grid twice as fine as the solution's.
    background : float
        p0, the strain far from the wave.
    """

    masses: newton.Pair
    k: float
    c2: float
    half_period: float
    series: newton.Series
    tail: float
    residual: float
    background: float = 0.0

    def __repr__(self) -> str:
        kind = "solitary" if self.solitary else f"tail {self.tail:.2g}"
        m1, m2 = self.masses
        parameters = f"masses=({m1:g}, {m2:g}), k={self.k:g}"
        return f"ExactWave({parameters}, c={self.c:.12g}, {kind})"

    @property
    def c(self) -> float:
        """Speed dx/dt of the wave."""
        return math.sqrt(self.c2)

    @property
    def omega(self) -> float:
        """Mass ratio m2/m1."""
        return self.masses[1] / self.masses[0]

    @property
    def solitary(self) -> bool:
        """True if tail and residual are below `TOLERANCE`."""
        return max(self.tail, self.residual) < TOLERANCE

    def estimate(self, name: Number, *arguments: Any) -> Estimate:
        """Return a number of a solitary wave with its error, from residual, tail and rounding.

        Parameters
        ----------
        name : {"c2", "c", "tail", "peak", "fwhm"}
            Name of an attribute or a method.
        *arguments
            Arguments of the method, as in ``wave.estimate("fwhm", "force")``.

        Examples
        --------
        >>> from validation import exact_wave
        >>> print(exact_wave([1], 1.5).estimate("fwhm", "force"))
        1.41193 ± 1e-05
        """
        value = getattr(self, one_of(name, _NUMBERS, "name"))
        if callable(value):
            value = value(*arguments)
        bend = (self.k - 1) * (1 - self.background)
        share = ROUNDING * (self.k + 1 / bend) + self.residual + self.tail
        if name == "tail":  # a share of the peak strain already
            return Estimate(value, share)
        return Estimate(value, share * value)

    def times(self, s: float) -> ExactWave:
        """Return the wave with all strains, the background's too, multiplied by s."""
        # s^k is a float within these limits.
        most = 10 ** (300 / self.k)
        s = between(s, "s", 1 / most, most)
        force = s**self.k
        stiffness = force / s
        return replace(
            self,
            c2=self.c2 * stiffness,
            series=self.series * force,
            background=self.background * s,
        )

    def strain(self, xi: ArrayLike, contact: int = 0) -> Array:
        """Strain a(ξ) of the contacts ahead of beads m1 (contact 0), or b(ξ) of the others (1)."""
        at = finite(xi, "xi")
        if integer(contact, "contact", 0) % 2:
            at = -at  # b is the mirror image of a
        return self._fading(at, self._strains)

    def force(self, xi: ArrayLike, contact: int = 0) -> Array:
        """Force F_a(ξ) or F_b(ξ) of a contact, above the static force."""
        strain = self.strain(xi, contact)
        return newton.rise(strain, self.k, self.background)

    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        """Velocity of beads m1 (bead 0) or m2 (bead 1) at ξ, 0 at the end of the period."""
        kind = integer(bead, "bead", 0) % 2
        at = finite(xi, "xi")
        # The contact half a site behind a bead m2 has the force F_a, whose Fourier coefficients are
        # ``series``. The one behind a bead m1 has F_b, the mirror image of F_a, with the conjugate
        # coefficients.
        behind = self.series if kind else self.series.conj()
        q = self._wavenumbers[1:]
        # In a wave v depends on ξ = x - ct, dv/dt = -c v', and so m c v' is the force half a site
        # ahead less the force half a site behind. The latter is Re Σ g e^{iqξ}, g = ``shifted``,
        # the former its mirror image, Re Σ g e^{-iqξ}: their difference is Σ 2 Im g sin qξ, and v
        # the sum of -2 Im g cos qξ / (q m c).
        shifted = behind[1:] * np.exp(-0.5j * q)
        momenta = -2 * shifted.imag / (q * self.c)
        velocities = np.append(0.0, momenta) / self.masses[kind]
        return self._fading(at, velocities)

    def peak(self, quantity: QuantityName) -> float:
        """Return the maximum of a quantity.

        Strain and force are those of contact 0, the velocity is that of bead 0.
        """
        # The interpolant of the crest loses some ulp, the place of the crest nothing that shows.
        crest = self._hump(quantity).arrival
        return float(self._profile(quantity)(crest))

    def fwhm(self, quantity: QuantityName = "strain") -> float:
        """Full width at half maximum of a quantity's highest hump, a length.

        Strain and force are those of contact 0, the velocity is that of bead 0.
        Raises `MeasureError` for a hump that does not fall to half its peak.
        """
        return self._hump(quantity).fwhm

    def pictured(self) -> list[Panel]:
        """Panel of strain, force and velocity as functions of ξ, each divided by its peak."""
        xi = np.linspace(-self.half_period, self.half_period, 2001)
        curves = []
        for name in QUANTITIES:
            profile = self._profile(name)
            share = profile(xi) / self.peak(name)
            curves.append(Curve(name, xi, share))
        return [Panel("ξ / D", "over its peak", curves)]

    def _hump(self, quantity: QuantityName) -> Pulse:
        """The highest hump of a quantity, over ξ in place of time."""
        # Half as many points as the solution has are enough for a search.
        L = self.half_period
        count = len(self.series) + 1
        points = np.linspace(-L, L, count)
        return highest_pulse(Piecewise(points, self._profile(quantity)))

    def _profile(self, quantity: QuantityName) -> Callable[[ArrayLike], Array]:
        """The method that computes a quantity as a function of ξ."""
        name = one_of(quantity, QUANTITIES, "quantity")
        profile: Callable[[ArrayLike], Array] = getattr(self, name)
        return profile

    @cached_property
    def _strains(self) -> newton.Series:
        """Fourier coefficients of the strain a, without the mean; compare ``series``, of F_a."""
        m1, m2 = self.masses
        inverse = (1 / m1, 1 / m2)
        strain = newton.respond(self.series, inverse, self.half_period) / self.c2
        # The imaginary part belongs to a sine that is 0 at every point of the grid.
        strain[-1] = strain[-1].real
        return strain

    @property
    def _wavenumbers(self) -> Array:
        """The wavenumbers q of the coefficients."""
        lowest = np.pi / self.half_period
        return np.asarray(lowest * np.arange(len(self.series)))

    def _fading(self, xi: Array, series: Any) -> Array:
        """Evaluate the Fourier sum ``Re Σ c_j e^{i q_j ξ}`` less its value at L.

        Beyond L a solitary wave has ended, while its Fourier sum is periodic.
        """
        q = self._wavenumbers
        phase = np.multiply.outer(xi, q)
        even = np.cos(phase) @ series.real
        odd = -np.sin(phase) @ series.imag
        at_end = np.cos(q * self.half_period) @ series.real
        ended = (np.abs(xi) >= self.half_period) & self.solitary
        return np.where(ended, 0.0, even + odd - at_end)


def at_unit_force(problem: newton.Problem, found: newton.Found) -> ExactWave:
    """Return the wave of a solution, scaled to peak contact force 1, with tail and residual."""
    series = newton.coefficients(found.force)
    wave = ExactWave(
        masses=found.masses,
        k=problem.k,
        c2=found.c2,
        half_period=problem.L,
        series=series,
        tail=0.0,
        residual=0.0,
        background=problem.p0,
    )
    peak = problem.p0 + wave.peak("strain")
    wave = wave.times(1 / peak)
    # The odd part of a wave of equal masses is rounding.
    tail = 0.0 if problem.uniform else _tail(wave)
    return replace(wave, tail=tail, residual=_residual(wave))


def _tail(wave: ExactWave) -> float:
    """The largest odd part ``|o|`` of the strain outside the pulse, of a wave of peak strain 1."""
    L = wave.half_period
    # Some twenty points for each oscillation of the tail.
    count = 4 * len(wave.series)
    outside = np.linspace(OUTSIDE * L, L, count)
    # The other contact's strain is the mirror image.
    twice_odd = wave.strain(outside) - wave.strain(outside, 1)
    return float(np.abs(twice_odd).max()) / 2


def _residual(wave: ExactWave) -> float:
    """The greatest error of the strain in the equations of motion, over the peak strain.

    The equations are those integrated twice (`validation.waves.newton.respond`).
    """
    # The contact law gives forces from the strains, and the equations give strains from the Fourier
    # coefficients of these forces, ``series``: for a solution the same strains. Newton's method has
    # made them equal at the points of the solution's grid: a grid twice as fine sees the error
    # between these points, too.
    twice = 2 * (len(wave.series) - 1)
    xi = newton.periodic_grid(wave.half_period, twice)
    series = newton.coefficients(wave.force(xi))
    response = replace(wave, series=series)
    off = response.strain(xi) - wave.strain(xi)
    largest = float(np.abs(off).max())
    # The peak force is 1, and so is the peak of the total strain. The wave's own is 1 - p0.
    return largest / (1 - wave.background)
