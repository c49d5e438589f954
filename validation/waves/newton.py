"""Traveling waves of the lattice, solved by Newton's method with Fourier coefficients.

Beads of masses m1 and m2 alternate at distance 1, contacts push with F = r_+^k (A = D = 1). In a
wave of speed c all quantities depend on ξ = x - ct alone. With a(ξ) the strain of the contacts
behind beads m1, b(ξ) the strain of the other contacts, F_a = a_+^k and F_b = b_+^k, the equations
of motion are

    c² a'' = -Σ F_a(ξ) + F_b(ξ-1)/m1 + F_b(ξ+1)/m2,      Σ = 1/m1 + 1/m2,

and the same for b with a ↔ b, m1 ↔ m2. Sought are mirror symmetric waves, b(ξ) = a(-ξ). Then
a = e + o with e even and o odd, likewise F_a = E + O. With Δ = 1/m2 - 1/m1 the Fourier coefficients
(of cos qξ for e and E, of sin qξ for o and O; q is the wavenumber) satisfy

    c² q² e = Σ (1 - cos q) E + Δ sin q O,      c² q² o = Δ sin q E + Σ (1 + cos q) O.     (*)

Profiles are trigonometric polynomials of period 2L, |ξ| ≤ L (L is the half period), spectrally
accurate.

**The tail.** At q → 0 the second line of (*) has a pole: forces that end leave strains o = ±T
behind. T is 0 for a solitary wave. `Problem.wave` can impose T = 0 with one more unknown, m2.

**Under a load.** On a background strain p0, a and b are the additional strains, r → 0 far away, and
F = (p0 + r)_+^k - p0^k; (*) stays.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array
from lwa.base.exact import InputError

MOST_STEPS = 25  # of Newton's method
FEWEST = 40  # points on 0 … L
Pair = tuple[float, float]  # m1 and m2, or their inverses
Solution = TypeVar("Solution")


def widening(masses: Pair) -> float:
    """Return the canonical wave's width divided by its width at equal masses, √(12 I/D²)."""
    m1, m2 = masses
    return 2 * math.sqrt(m1 * m1 - m1 * m2 + m2 * m2) / (m1 + m2)


def ample_half_period(masses: Pair, k: float) -> float:
    """Return a half period L: a pulse of equal masses ends within L, a dimer's within 0.6 L."""
    # The strain divided by its peak falls like exp(-3 (k-1) ξ²) near k = 1, like exp(-k^ξ) above.
    length = 1 + 3.7 / math.sqrt(k - 1 if k < 2 else math.log2(k))
    return (
        length if masses[0] == masses[1] else max(8.0, 1.15 * length * widening(masses))
    )


def points_needed(masses: Pair, k: float, half_period: float) -> int:
    """Return a number of points on 0 … L = ``half_period`` that resolves the wave to rounding."""
    # Points per site, in this order: for the pulse's width as k grows, for its steeper flanks at
    # large k, for the oscillation of light beads.
    beads = math.sqrt(sum(masses) / min(masses) - 1)
    dense = 3 + 9 * math.sqrt(k - 1) + 7 * max(k - 2, 0) + 1.5 * beads
    return max(FEWEST, math.ceil(dense * half_period))


def rise(strain: Array, k: float, p0: float) -> Array:
    """Return (p0 + r)_+^k - p0^k, r the strain: force less static force, without cancellation."""
    if not p0:
        return np.asarray(np.maximum(strain, 0) ** k)
    with np.errstate(divide="ignore"):  # an open contact
        return np.asarray(p0**k * np.expm1(k * np.log1p(np.maximum(strain / p0, -1))))


def respond(
    force: NDArray[np.complex128], inverse: Pair, half_period: float
) -> NDArray[np.complex128]:
    """Return the Fourier coefficients of c² a from those of F_a by (*); e^{iqξ}, q = 0 … πn/L.

    inverse : (1/m1, 1/m2). The mean of a is set to 0.
    """
    q = np.pi * np.arange(len(force)) / half_period
    mirrored = inverse[0] * np.expm1(-1j * q) + inverse[1] * np.expm1(1j * q)
    strain = 2j * sum(inverse) * force.imag - mirrored * force.conj()
    strain[0] = 0
    return np.asarray(strain / np.maximum(q, q[1]) ** 2)


def coefficients(force: Array) -> tuple[Array, Array]:
    """Return the coefficients of cos qξ in E and of sin qξ in O, from F_a on a `periodic_grid`."""
    n = len(force) // 2
    series = scipy.fft.rfft(force) / n
    series[[0, n]] /= 2
    return series.real, -series.imag


def periodic_grid(half_period: float, n: int) -> Array:
    """Return the 2n grid points ξ of a period: 0 … L, then from -L to 0."""
    return np.asarray(
        half_period / n * np.append(np.arange(n + 1), np.arange(1 - n, 0))
    )


class Problem:
    """The wave equations on a periodic grid: F_a = `rise` of the strain a, and a from F_a by (*).

    masses, k : (m1, m2) and the exponent. half_period, points : L, by default `ample_half_period`,
    and the number of points on 0 … L, by default `points_needed`. p0 : background strain.
    """

    # F_a(0) = 1 - p0^k fixes c². The unknowns are c² and the forces F_a at ``count`` grid points:
    # at all of them, or for equal masses, where o = 0, at 0 … L.

    def __init__(
        self,
        masses: Pair,
        k: float,
        half_period: float | None = None,
        points: int | None = None,
        p0: float = 0.0,
    ) -> None:
        self.masses, self.k, self.p0 = masses, k, p0
        self.L = half_period or ample_half_period(masses, k)
        self.n = points or points_needed(masses, k, self.L)
        self.height = -math.expm1(k * math.log(p0)) if p0 else 1.0
        self.uniform = masses[0] == masses[1]
        self.count = self.n + 1 if self.uniform else 2 * self.n
        self.xi = periodic_grid(self.L, self.n)[: self.count]
        self.inverse = 1 / masses[0], 1 / masses[1]

    def forces(self, z: Array) -> Array:
        """Return F_a at all grid points, (2 points,), from the unknown forces z, (count,)."""
        return np.append(z, z[self.n - 1 : 0 : -1]) if self.uniform else z

    def strains(self, z: Array, inverse: Pair) -> Array:
        """Return c² a, shifted to 0 at L, at the first ``count`` grid points, from the forces z."""
        force = scipy.fft.rfft(self.forces(z))
        # Of equal masses the imaginary part is rounding, which 1/q² would enlarge.
        force = np.asarray(force.real if self.uniform else force, complex)
        a = scipy.fft.irfft(respond(force, inverse, self.L), 2 * self.n)
        return np.asarray(a - a[self.n])[: self.count]

    def responses(self, at: NDArray[np.int_], inverse: Pair) -> Array:
        """Return the rows and columns ``at`` (grid points) of the Jacobian of `strains`."""
        n = self.n
        plus, minus = (
            respond(np.full(n + 1, f, complex), inverse, self.L) for f in (1, 1j)
        )
        minus = 1j * minus
        # Strain due to a force at one place and due to a force at its mirror image, as functions
        # of the difference and of the sum of two places; two periods, as the sum exceeds one.
        both = (
            (plus, 0 * plus)
            if self.uniform
            else ((plus - minus) / 2, (plus + minus) / 2)
        )
        near, mirrored = (np.tile(scipy.fft.irfft(row, 2 * n), 2) for row in both)

        def to(j: NDArray[np.int_]) -> Array:
            row = near[n - j] + mirrored[n + j]
            return np.asarray(near[at[:, None] - j] + mirrored[at[:, None] + j] - row)

        if not self.uniform:
            return to(at)
        return np.asarray((to(at) + to(-at)) * np.where(at % n == 0, 0.5, 1.0))

    def wave(
        self, z: Array, c2: float, free: bool = False
    ) -> tuple[Array, float, float]:
        """Solve for the wave near the forces ``z`` and squared speed ``c2``.

        free : True to impose T = 0 with one more unknown, m2.
        Returns the forces, c² and 1/m2.
        Raises `numpy.linalg.LinAlgError` if Newton's method does not converge.
        """
        last = (self.inverse[1],) if free else ()
        size = np.append(
            np.full(self.count, 2 * self.height), [abs(x) or 1.0 for x in (c2, *last)]
        )
        start = np.append(z[: self.count] * (self.height / z[0]), (c2, *last))
        x = newton(lambda x: self._step(x, free), start, size)
        return (
            x[: self.count],
            float(x[self.count]),
            float(x[-1]) if free else self.inverse[1],
        )

    def _step(self, x: Array, free: bool) -> Array:
        """Return the Newton step to be subtracted from the unknowns x."""
        count, xi = self.count, self.xi
        z, c2 = x[:count], x[count]
        inverse = self.inverse[0], x[-1] if free else self.inverse[1]
        a = self.strains(z, inverse) / c2
        slope = self.k * np.maximum(self.p0 + a, 0) ** (self.k - 1) / c2
        fault = z - rise(a, self.k, self.p0)
        columns, rows, faults = [slope * a], [np.eye(1, count)[0]], [z[0] - self.height]
        corner = np.zeros((1 + free,) * 2)
        if free:
            # c² T = Δ ∫_0^∞ E dξ + 2Σ ∫_0^∞ ξ O dξ = ∫ [(ξ - 1/2)/m1 + (ξ + 1/2)/m2] F_a dξ, and
            # its derivative by 1/m2.
            one, two = (self.L / self.n * (xi * (xi < self.L) + s / 2) for s in (-1, 1))
            tail = inverse[0] * one + inverse[1] * two
            rows, faults = [*rows, tail], [*faults, tail @ z]
            columns.append(-slope * self.strains(z, (0, 1)))
            corner[1, 1] = two @ z
        # The force of an open contact is known: it leaves the linear system.
        on = slope != 0
        known = np.where(on, 0, fault)
        right = (fault + slope * self.strains(known, inverse))[on]
        at = np.flatnonzero(on)
        matrix = np.eye(len(at)) - slope[at][:, None] * self.responses(at, inverse)
        border = np.array(rows)
        solved = np.linalg.solve(
            np.block([[matrix, np.array(columns).T[on]], [border[:, on], corner]]),
            np.append(right, faults - border @ known),
        )
        known[on] = solved[: len(at)]
        return np.append(known, solved[len(at) :])


@np.errstate(all="ignore")  # an overflow or c² < 0 does not converge
def newton(change: Callable[[Array], Array], x: Array, sizes: Array) -> Array:
    """Return a root near x, found by damped Newton steps; `LinAlgError` without convergence.

    change : the full Newton step at x, to be subtracted. sizes : typical sizes of the unknowns.
    """
    before = math.inf
    for _ in range(MOST_STEPS):
        step = change(x)
        size = float(np.max(np.abs(step) / sizes))
        if not math.isfinite(size):
            break
        x = x - step * (min(1.0, 0.3 / size) if size > 0 else 1.0)
        # Rounding stops the fall of the steps.
        if size < 1e-12 or (size < 1e-9 and size > before / 4):
            return x
        before = size
    raise np.linalg.LinAlgError("no convergence")


def continued(
    solution: Solution,
    begin: float,
    end: float,
    step: float,
    solve: Callable[[float, Sequence[tuple[float, Solution]]], Solution],
) -> Solution:
    """Continue a solution from one value of a parameter to another, in adaptive steps.

    begin, end : the parameter's values. step : length of the first step.
    solve : returns the solution at a value, given the last one or two values with their solutions;
        its `lwa.InputError` halves the step, and is raised at a hundredth of the first step.
    """
    path, size = [(begin, solution)], step
    while path[-1][0] != end:
        left = end - path[-1][0]
        value = end if abs(left) <= size else path[-1][0] + math.copysign(size, left)
        try:
            path.append((value, solve(value, path[-2:])))
        except InputError:
            size /= 2
            if size < step / 100:
                raise
        else:
            size *= 1.5
    return path[-1][1]
