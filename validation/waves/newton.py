"""Traveling waves of the lattice, solved by Newton's method with Fourier coefficients.

Beads of masses m1 and m2 alternate at distance 1, and contacts push with ``F = r_+^k``
(``A = D = 1``). In a wave of speed c all quantities depend on ``ξ = x - ct`` alone. a(ξ) is the
strain of the contacts ahead of beads m1, b(ξ) the strain of the contacts ahead of beads m2,
``F_a = a_+^k`` and ``F_b = b_+^k``. The equations of motion are::

    c² a'' = -Σ F_a(ξ) + F_b(ξ-1)/m1 + F_b(ξ+1)/m2,      Σ = 1/m1 + 1/m2,

and the same for b with a and b, m1 and m2 exchanged. Sought are mirror symmetric waves,
``b(ξ) = a(-ξ)``. Then ``a = e + o`` with e even and o odd, likewise ``F_a = E + O``. With
``Δ = 1/m2 - 1/m1`` the Fourier coefficients (of cos qξ for e and E, of sin qξ for o and O; q is the
wavenumber) satisfy the equations (1)::

    c² q² e = Σ (1 - cos q) E + Δ sin q O,      c² q² o = Δ sin q E + Σ (1 + cos q) O.

Profiles are trigonometric polynomials of period 2L, ``-L ≤ ξ ≤ L`` (L is the half period),
spectrally accurate.

**The tail.** At q → 0 the second equation has a pole: forces that end leave strains ``o = ±T``
behind. T is 0 for a solitary wave. `SpecialRatio` imposes ``T = 0`` with one more unknown, m2.

**Under a load.** On a background strain p0, a and b are the additional strains, r → 0 far away, and
``F = (p0 + r)_+^k - p0^k``; equations (1) stay.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array

MOST_STEPS = 25  # most steps of Newton's method, which takes 4 to 12 where it converges
FEWEST = 40  # fewest points on 0 … L
# Share of an unknown's size. With longer steps a far start is lost, or leads to any special ratio;
# most starts of special ratios take fewer steps than with 0.3.
_LONGEST_STEP = 0.1
# Step over the unknowns' sizes after which a further step would be rounding.
_CONVERGED = 1e-12
# Step below which the steps are rounding if one is more than a quarter of the one before.
_STALLED = 1e-9
Pair = tuple[float, float]  # m1 and m2, or their inverses
Series = NDArray[np.complex128]  # coefficients of e^{iqξ}, q = 0, π/L, …, πn/L


def widening(masses: Pair) -> float:
    """Return the canonical wave's width divided by its width at equal masses, ``√(12 I/D²)``.

    D is 1, and I the coefficient in the dispersion ``Ω² = κ² (1 - (I/D²) κ² + …)`` of the linear
    chain, Ω the frequency in units in which its long waves have the speed 1, κ the wavenumber times
    D: ``I/D² = (m1² - m1 m2 + m2²)/(3 (m1 + m2)²)``, which is 1/12 at equal masses.
    """
    m1, m2 = masses
    square = m1**2 - m1 * m2 + m2**2
    return 2 * math.sqrt(square) / (m1 + m2)


def ample_half_period(masses: Pair, k: float) -> float:
    """Return a half period L: a pulse of equal masses ends within L, a dimer's within 0.6 L."""
    # The strain falls like exp(-3 (k-1) ξ²) near k = 1, and doubly exponentially, with exponents
    # like k^ξ, at large k. Measured at k = 1.02 … 30: one site before this L it is at most 4e-15
    # of its peak, and at L it is rounding.
    steepness = k - 1 if k < 2 else math.log2(k)
    length = 1 + 3.7 / math.sqrt(steepness)
    if masses[0] == masses[1]:
        return length
    # Eight sites or more show the oscillations behind a dimer's pulse. The factor 1.15 makes 0.6 L
    # enough for the pulse: from there on the strain of waves at special ratios (k = 1.1 … 5) is at
    # most 3e-13 of its peak.
    return max(8.0, 1.15 * length * widening(masses))


def points_needed(masses: Pair, k: float, half_period: float) -> int:
    """Return a number of points on 0 … L, L the half period, that resolves the wave to rounding."""
    # Points per site. Measured at k = 1.02 … 60 and at special ratios down to 0.06: four fifths of
    # these points give the same speeds to rounding; half of them do so for equal masses alone.
    narrow = 9 * math.sqrt(k - 1)  # the pulse's width falls like this
    steep = 7 * max(k - 2, 0)  # its flanks at large k
    light = 1.5 * math.sqrt(max(masses) / min(masses))  # light beads oscillate as fast
    per_site = 3 + narrow + steep + light
    return max(FEWEST, math.ceil(per_site * half_period))


def rise(strain: Array, k: float, p0: float) -> Array:
    """Return ``(p0 + r)_+^k - p0^k``, r the strain: the dynamic force, without cancellation."""
    total = np.maximum(p0 + strain, 0)
    if not p0:
        return total**k
    relative = np.maximum(strain / p0, -1)  # -1 for an open contact
    with np.errstate(divide="ignore"):
        growth = np.expm1(k * np.log1p(relative))
    # The power of a large logarithm loses digits, the difference of unlike powers none.
    return np.asarray(np.where(relative > 1, total**k - p0**k, p0**k * growth))


def respond(force: Series, inverse: Pair, half_period: float) -> Series:
    """Return the Fourier coefficients (…, n + 1) of c² a from those of F_a, both of ``e^{iqξ}``.

    With the coefficients a_q of the strain, f of F_a, and f* (conjugate) of ``F_b(ξ) = F_a(-ξ)``,
    the equation of motion, which is (1) in the module's docstring, is::

        c² q² a_q = (1/m1 + 1/m2) f - (e^{-iq}/m1 + e^{iq}/m2) f*,        q = 0 … πn/L.

    The mean of a is set to 0. ``inverse`` holds 1/m1 and 1/m2.
    """
    # F_a of equal masses is even, and its coefficients are real. Their imaginary part is rounding,
    # which 1/q² would enlarge.
    if inverse[0] == inverse[1]:
        force = force.real.astype(complex)
    q = np.pi * np.arange(force.shape[-1]) / half_period
    # The right side nearly cancels at small q. Without the difference of large terms it is
    # (1/m1 + 1/m2)(f - f*) - [(e^{-iq} - 1)/m1 + (e^{iq} - 1)/m2] f*, and f - f* = 2i Im f.
    by_first = inverse[0] * np.expm1(-1j * q)
    by_second = inverse[1] * np.expm1(1j * q)
    twice_odd = 2j * force.imag
    mirrored = (by_first + by_second) * force.conj()
    strain = sum(inverse) * twice_odd - mirrored
    strain[..., 0] = 0
    q[0] = q[1]  # no division by 0: the mean is 0 already
    return np.asarray(strain / q**2)


def coefficients(force: Array) -> Series:
    """Return f of ``F_a = Re Σ f_q e^{iqξ}`` from F_a on a `periodic_grid`."""
    n = len(force) // 2
    series = scipy.fft.rfft(force) / n
    # The mean and the fastest cosine stand once in a Fourier sum, not twice.
    series[[0, n]] /= 2
    return np.asarray(series)


def periodic_grid(half_period: float, n: int) -> Array:
    """Return the 2n grid points ξ of a period: 0 … L, then from -L to 0."""
    right = np.arange(n + 1)
    left = np.arange(1 - n, 0)
    return np.asarray(half_period / n * np.append(right, left))


@dataclass(frozen=True, eq=False)
class Found:
    """A solution: the forces F_a at the grid points, c² and the masses."""

    force: Array
    c2: float
    masses: Pair


class Problem:
    """The wave equations on a periodic grid.

    F_a is the `rise` of the strain a, and a follows from F_a by equations (1).

    Parameters
    ----------
    masses : (float, float)
        m1 and m2.
    k : float
        Exponent.
    half_period : float, optional
        L; by default `ample_half_period`.
    points : int, optional
        Number of points on 0 … L; by default `points_needed`.
    p0 : float
        Background strain.
    """

    # The unknowns are the forces F_a at ``count`` grid points (at all of them, or for equal masses,
    # where o = 0, at 0 … L), c² and 1/m2, in which equations (1) are linear. As many equations:
    # F_a is the rise of a at each point, F_a(0) = 1 - p0^k fixes c², and `_closing` 1/m2.

    def __init__(
        self,
        masses: Pair,
        k: float,
        half_period: float | None = None,
        points: int | None = None,
        p0: float = 0.0,
    ) -> None:
        self.masses = masses
        self.uniform = masses[0] == masses[1]
        self.k = k
        self.p0 = p0
        # F_a(0), 1 - p0^k, without cancellation where p0 is near 1
        self.height = 1.0
        if p0:
            self.height = -math.expm1(k * math.log(p0))
        self.L = half_period or ample_half_period(masses, k)
        self.n = points or points_needed(masses, k, self.L)
        self.count = 2 * self.n
        if self.uniform:  # half of the matrix's rows and columns, an eighth of the time
            self.count = self.n + 1
        self.xi = periodic_grid(self.L, self.n)[: self.count]

    def wave(self, force: Array, c2: float) -> Found:
        """Solve for the wave near a force on the grid and a squared speed.

        Raises `numpy.linalg.LinAlgError` if Newton's method does not converge.
        """
        m1, m2 = self.masses
        # The unknowns are the forces at the first ``count`` grid points, c² and 1/m2. The grid
        # begins at ξ = 0, where the force, force[0], shall be ``height``. 1/m2 is an unknown in
        # every problem: where m2 is given, `_closing` sets it.
        share = self.height / force[0]
        scaled = share * force[: self.count]
        start = np.append(scaled, [c2, 1 / m2])
        # `newton` measures its steps in these sizes, and no step is longer than a tenth of them.
        # Forces have the size of twice their peak, so that a step changes them by a fifth of the
        # peak at most; c² and 1/m2 have their own size, but c² may be 0 at a bad start.
        sizes = np.where(start == 0, 1.0, np.abs(start))
        sizes[: self.count] = 2 * self.height
        x = newton(self._step, start, sizes)
        # For equal masses the unknown forces are those at 0 … L: the others are their mirror image.
        forces = self._everywhere(x[:-2])
        c2, inverse = x[-2:].tolist()
        return Found(forces, c2, (m1, 1 / inverse))

    def _everywhere(self, forces: Array) -> Array:
        """F_a at all grid points, (…, 2n), from the unknown forces, (…, count).

        Those of equal masses are at 0 … L, and F_a is even; others are at all points already.
        """
        if not self.uniform:
            return forces
        mirrored = forces[..., self.n - 1 : 0 : -1]
        return np.concatenate((forces, mirrored), axis=-1)

    def _strains(self, forces: Array, inverse: Pair) -> Array:
        """Return c² a, shifted to 0 at L, from the unknown forces, one row or an array of rows.

        The ``count`` unknown forces, and the strains returned, are those at the first points of
        the periodic grid, which begins at the peak: for equal masses at ξ = 0 … L, the other half
        is their mirror image; else at all 2n points. The shift sets the mean of the strain, which
        the response leaves open, such that a is 0 far from the peak.
        """
        force = scipy.fft.rfft(self._everywhere(forces))
        response = respond(force, inverse, self.L)
        strain = scipy.fft.irfft(response, 2 * self.n)
        at_end = strain[..., [self.n]]
        return np.asarray(strain - at_end)[..., : self.count]

    @cached_property
    def _responses(self) -> tuple[Array, Array]:
        """Matrices of the strains c² a, linear in the forces, by 1/m1 and by 1/m2."""
        unit_forces = np.eye(self.count)  # each row a force 1 at one grid point
        by_first = self._strains(unit_forces, (1, 0)).T
        by_second = self._strains(unit_forces, (0, 1)).T
        return by_first, by_second

    def _closing(self, force: Array, inverse: float) -> tuple[float, Array]:
        """Return the error of the condition that 1/m2 is the given one, and its derivatives.

        The derivatives are those by all unknowns: the forces, c² and 1/m2.
        """
        derivatives = np.zeros(self.count + 2)
        derivatives[-1] = 1
        return inverse - 1 / self.masses[1], derivatives

    def _step(self, unknowns: Array) -> Array:
        """Return the Newton step to be subtracted from the unknowns.

        The equations ask that the forces are the `rise` of the strains a of these forces, that the
        force at 0 is the peak's, and the condition of `_closing`. With the response R, the matrix
        of c² a by the forces, and the slope s of the rise by c² a, the forces' own rows of the
        Jacobian are ``1 - s R``, ``s a`` by c² and ``-s ∂(R F)/∂(1/m2)``.
        """
        force = unknowns[:-2]
        c2, inverse = unknowns[-2:]
        first = 1 / self.masses[0]
        # The strain is not computed by the matrices below, whose rounding shows in long waves on a
        # background.
        a = self._strains(force, (first, inverse)) / c2
        missed = force - rise(a, self.k, self.p0)
        closing, of_closing = self._closing(force, inverse)
        too_high = force[0] - self.height
        faults = np.append(missed, [too_high, closing])
        pressed = np.maximum(self.p0 + a, 0)
        slope = self.k * pressed ** (self.k - 1) / c2
        by_first, by_second = self._responses
        response = by_first * first + by_second * inverse
        by_forces = np.eye(self.count) - slope[:, np.newaxis] * response
        by_c2 = slope * a
        by_inverse = -slope * (by_second @ force)
        of_forces = np.column_stack((by_forces, by_c2, by_inverse))
        at_peak = np.zeros(self.count + 2)
        at_peak[0] = 1
        jacobian = np.vstack((of_forces, at_peak, of_closing))
        return np.linalg.solve(jacobian, faults)


class SpecialRatio(Problem):
    """The wave equations with m2 as one more unknown, and the condition ``T = 0``."""

    def _closing(self, force: Array, inverse: float) -> tuple[float, Array]:
        """Return the error of the condition that no strain is left behind, and its derivatives."""
        # At small q the coefficient of o is T/q, that of O is q ∫_0^∞ ξ O dξ and that of E is
        # ∫_0^∞ E dξ: the second equation (1) gives c² T = Δ ∫_0^∞ E dξ + 2Σ ∫_0^∞ ξ O dξ. E and O
        # are the even and the odd part of F_a, so that both integrals over 0 … ∞ are half of those
        # of F_a and ξ F_a over all ξ: c² T = ∫ [(ξ - 1/2)/m1 + (ξ + 1/2)/m2] F_a dξ.
        # The force at the grid's end ξ = L is 0.
        places = np.where(self.xi < self.L, self.xi, 0)
        step = self.L / self.n
        by_first = step * (places - 1 / 2)
        by_second = step * (places + 1 / 2)
        tail = by_first / self.masses[0] + by_second * inverse
        by_c2 = 0.0
        by_inverse = float(by_second @ force)
        fault = float(tail @ force)
        return fault, np.append(tail, (by_c2, by_inverse))


@np.errstate(all="ignore")  # an overflow or c² < 0 does not converge
def newton(change: Callable[[Array], Array], x: Array, sizes: Array) -> Array:
    """Return a root near x, found by damped Newton steps; `LinAlgError` without convergence.

    Parameters
    ----------
    change : callable
        The full Newton step at x, to be subtracted.
    x : ndarray, shape (N,)
        The start.
    sizes : ndarray, shape (N,)
        Typical sizes of the unknowns.
    """
    before = math.inf
    for _ in range(MOST_STEPS):
        step = change(x)
        shares = np.abs(step) / sizes
        size = shares.max()
        if size > _LONGEST_STEP:
            step *= _LONGEST_STEP / size
        x = x - step
        # Steps that no longer shrink as Newton's do are rounding.
        stalled = size < _STALLED and size > before / 4
        if size < _CONVERGED or stalled:
            return x
        before = size
    raise np.linalg.LinAlgError("no convergence")
