"""The equations of a traveling wave of the lattice, in Fourier coefficients, and Newton's method.

Beads of masses m1 and m2 alternate at distance 1, contacts push with F = r_+^k (A = D = 1). In a
wave of speed c everything depends on ξ = x - ct alone; with a(ξ) the strain of the contacts whose
left bead is m1, b(ξ) that of the others and F_a = a_+^k, F_b = b_+^k, the equations of motion are

    c² a'' = -Σ F_a(ξ) + F_b(ξ-1)/m1 + F_b(ξ+1)/m2,      Σ = 1/m1 + 1/m2,

and the same for b with a ↔ b, m1 ↔ m2. The waves sought here are mirror symmetric,
b(ξ) = a(-ξ). Then a = e + o with e even and o odd, likewise F_a = E + O, and for the Fourier
coefficients, Δ = 1/m2 - 1/m1,

    c² q² e = Σ (1 - cos q) E + Δ sin q O,      c² q² o = Δ sin q E + Σ (1 + cos q) O     (*)

(e, E: of cos qξ; o, O: of sin qξ). Integrated twice like this the problem is a fixed point of
smoothing operators, and Newton's method converges on it quadratically. Profiles are trigonometric
polynomials on |ξ| ≤ L, so that everything read off them is spectrally accurate.

**The tail.** At q → 0 the second line of (*) has a pole: forces that end leave o = ±T behind, with

    c² T = Δ ∫_0^∞ E dξ + 2Σ ∫_0^∞ ξ O dξ.

It is 0 for a wave that ends. `Problem` can hold it there with one more unknown: m2, or at given
masses the size of a kick in the middle of the pulse, in ξ e^{-2ξ²} to the odd force. That size
depends smoothly on m2/m1 and is 0 exactly where T is 0 without a kick: its changes of sign are the
special mass ratios.

**Under a load.** On a background strain p0 a and b are by how much a contact is compressed more, r
→ 0 far away, and F = (p0 + r)_+^k - p0^k; (*) stays.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import copy

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa.base.arrays import Array

MOST_STEPS = 25  # of Newton's method
FEWEST = 40  # points on which a wave is resolved
_FIRST, _FARTHEST = 0.01, 0.2  # steps along a branch, in k, c², and the forces' mean square
_STRAIGHT = 0.9  # cosine of the angle between two steps
_PLACES = 300  # along a branch


def widening(masses: tuple[float, float]) -> float:
    """√(12 I/D²), how much longer than in the uniform chain the canonical wave of `lwa` is."""
    m1, m2 = masses
    return 2 * math.sqrt(m1 * m1 - m1 * m2 + m2 * m2) / (m1 + m2)


def ample_half_period(masses: tuple[float, float], k: float) -> float:
    """L such that a uniform chain's pulse has ended at L, a dimer's at 0.6 L."""
    # Near k = 1, log r = -3 (k-1) ξ²; above, r falls like exp(-k^ξ). Twice 1e-8 makes 1e-16.
    length = 1 + 3.7 / math.sqrt(k - 1) if k < 2 else 1 + 3.7 / math.log2(k) ** 0.5
    return length if masses[0] == masses[1] else max(8.0, 1.15 * length * widening(masses))


def rise(strain: Array, k: float, p0: float) -> Array:
    """(p0 + r)_+^k - p0^k, without cancellation where r is small."""
    if not p0:
        return np.asarray(np.maximum(strain, 0) ** k)
    with np.errstate(divide="ignore"):  # an open contact
        return np.asarray(p0**k * np.expm1(k * np.log1p(np.maximum(strain / p0, -1))))


def respond(
    force: NDArray[np.complex128], inverse: tuple[float, float], half_period: float
) -> NDArray[np.complex128]:
    """c² a, but for its mean, for F_a, as coefficients of e^{iqξ}, q = 0 … πn/L; (1/m1, 1/m2)."""
    q = np.pi * np.arange(len(force)) / half_period
    mirrored = inverse[0] * np.expm1(-1j * q) + inverse[1] * np.expm1(1j * q)
    strain = 2j * sum(inverse) * force.imag - mirrored * force.conj()
    strain[0] = 0
    return np.asarray(strain / np.maximum(q, q[1]) ** 2)


def coefficients(force: Array) -> tuple[Array, Array]:
    """Of E in cos qξ and O in sin qξ, from F_a on a `circle`."""
    n = len(force) // 2
    found = scipy.fft.rfft(force) / n
    found[[0, n]] /= 2
    return found.real, -found.imag


def circle(half_period: float, n: int) -> Array:
    """ξ at 2n points of a period: 0 … L, and on from -L to 0."""
    return np.asarray(half_period / n * np.append(np.arange(n + 1), np.arange(1 - n, 0)))


class Problem:
    """F_a - rise(a) = 0 on a `circle`, with F_a(0) = 1 - p0^k for c²; F_b(ξ) = F_a(-ξ).

    Unknowns are the forces (of equal masses, where o = 0, at 0 … L only) and c². L is ample, and
    n points resolve the wave, unless they are given.
    """

    def __init__(
        self, masses: tuple[float, float], k: float, half_period: float | None = None,
        points: int | None = None, p0: float = 0.0,
    ) -> None:  # fmt: skip
        self.k, self.p0 = k, p0
        self.L = half_period or ample_half_period(masses, k)
        self.n = points or enough(masses, k, self.L)
        self.height = -math.expm1(k * math.log(p0)) if p0 else 1.0
        self.xi = circle(self.L, self.n)
        self.uniform = masses[0] == masses[1]
        self.count = self.n + 1 if self.uniform else 2 * self.n
        self.inverse = 1 / masses[0], 1 / masses[1]

    def forces(self, z: Array) -> Array:
        """F_a on the circle."""
        return np.append(z, z[self.n - 1 : 0 : -1]) if self.uniform else z

    def strains(self, z: Array, inverse: tuple[float, float]) -> Array:
        """c² a of these forces, where they are."""
        force = scipy.fft.rfft(self.forces(z))
        force = np.asarray(force.real if self.uniform else force, complex)  # no rounding over q²
        a = scipy.fft.irfft(respond(force, inverse, self.L), 2 * self.n)
        return np.asarray(a - a[self.n])[: self.count]

    def responses(self, at: NDArray[np.int_], inverse: tuple[float, float]) -> Array:
        """The matrix of `strains`, between some places of the grid."""
        n = self.n
        plus, minus = (respond(np.full(n + 1, f, complex), inverse, self.L) for f in (1, 1j))
        # to a force there, and to one at -ξ; twice as long, for the sum of two places
        minus = 1j * minus
        both = (plus, 0 * plus) if self.uniform else ((plus - minus) / 2, (plus + minus) / 2)
        near, mirrored = (np.tile(scipy.fft.irfft(row, 2 * n), 2) for row in both)

        def to(j: NDArray[np.int_]) -> Array:
            row = near[n - j] + mirrored[n + j]
            return np.asarray(near[at[:, None] - j] + mirrored[at[:, None] + j] - row)

        if not self.uniform:
            return to(at)
        return np.asarray((to(at) + to(-at)) * np.where(at % n == 0, 0.5, 1.0))

    def wave(
        self, z: Array, c2: float, unknown: str = "", along: Array | None = None
    ) -> tuple[Array, float, float]:
        """Forces, c², and where it is asked for the "mass" (as 1/m2) or the "kick" with T = 0, or
        "k", where forces, c² and k differ from these ones by what is normal to ``along``.

        Raises `numpy.linalg.LinAlgError` where Newton's method does not converge.
        """
        count, xi, first = self.count, self.xi[: self.count], self.inverse[0]
        kick = xi * np.exp(-2 * xi**2) if unknown == "kick" else 0 * xi
        by_first, by_last = (self.L / self.n * (xi * (xi < self.L) + s / 2) for s in (-1, 1))

        def change(x: Array) -> Array:
            """The equations' left-hand sides, solved with their derivatives."""
            z, c2 = x[:count], x[count]
            inverse = first, x[-1] if unknown == "mass" else self.inverse[1]
            k = x[-1] if unknown == "k" else self.k
            a = self.strains(z, inverse) / c2
            slope = k * np.maximum(self.p0 + a, 0) ** (k - 1)
            fault = z - rise(a, k, self.p0)
            columns, rows, rest = [slope * a / c2], [np.eye(1, count)[0]], [z[0] - self.height]
            corner = np.zeros((1 + bool(unknown),) * 2)
            if along is not None:
                columns.append(-scipy.special.xlogy(np.maximum(a, 0) ** k, np.maximum(a, 0)))
                rows, rest = [*rows, along[:count]], [*rest, along @ (x - start)]
                corner[1] = along[count:]
            elif unknown:
                T = inverse[0] * by_first + inverse[1] * by_last
                rows, rest = [*rows, T], [*rest, T @ z]
            if unknown == "mass":
                columns.append(-slope * self.strains(z, (0, 1)) / c2)
                corner[1, 1] = by_last @ z
            if unknown == "kick":
                fault -= x[-1] * kick
                columns.append(-kick)
            # Where a contact is open, and nothing else pushes, its force is known.
            on = (slope != 0) | (kick != 0)
            known = np.where(on, 0, fault)
            right = (fault + slope / c2 * self.strains(known, inverse))[on]
            at = np.flatnonzero(on)
            matrix = np.eye(len(at)) - (slope[at] / c2)[:, None] * self.responses(at, inverse)
            border = np.array(rows)
            found = np.linalg.solve(
                np.block([[matrix, np.array(columns).T[on]], [border[:, on], corner]]),
                np.append(right, rest - border @ known),
            )
            known[on] = found[: len(at)]
            return np.append(known, found[len(at) :])

        last = {"": (), "mass": (self.inverse[1],), "kick": (0.0,), "k": (self.k,)}[unknown]
        sizes = np.append(np.full(count, 2 * self.height), [other or 1.0 for other in (c2, *last)])
        start = np.append(z[:count] * (self.height / z[0]), (c2, *last))
        x = newton(change, start, sizes)
        return x[:count], float(x[count]), float(x[-1])

    def followed(self, z: Array, c2: float, k: float) -> tuple[Array, float]:
        """Forces and c², about, at another k on the branch of a wave, which may turn on the way.

        By pseudo-arclength: from two waves to the next one, in a plane normal to their difference.
        Raises `numpy.linalg.LinAlgError` where the branch is lost, or does not get there.
        """
        size = np.append(np.full(self.count, 1 / self.count), (1, 1))
        here = np.append(z, (c2, self.k))
        along, step = np.append(0 * here[:-1], math.copysign(1, k - self.k)), _FIRST
        for place in range(_PLACES):
            near, ahead = copy(self), here + step * along
            near.k = ahead[-1]
            try:
                there = np.hstack(near.wave(ahead[:-2], ahead[-2], "k", size * along))
                change = there - here
                turn = change / math.sqrt(change @ (size * change))
            except np.linalg.LinAlgError:
                turn = -along
            if place and turn @ (size * along) < _STRAIGHT:
                step /= 2
                if step < _FIRST / 1e4:
                    break
                continue
            if (there[-1] - k) * (here[-1] - k) <= 0:
                x = here + change * (k - here[-1]) / change[-1]
                return x[:-2], float(x[-2])
            here, along, step = there, turn, min(1.5 * step, _FARTHEST)
        raise np.linalg.LinAlgError("the branch is lost")


def enough(masses: tuple[float, float], k: float, half_period: float) -> int:
    """Points on 0 … L that resolve the wave."""
    # Per site: the pulse's own Fourier width, its steeper flanks at large k, the light beads.
    beads = math.sqrt(sum(masses) / min(masses) - 1)
    dense = 3 + 9 * math.sqrt(k - 1) + 7 * max(k - 2, 0) + 1.5 * beads
    return max(FEWEST, math.ceil(dense * half_period))


@np.errstate(all="ignore")  # what overflows, or has c² < 0, does not converge
def newton(change: Callable[[Array], Array], x: Array, sizes: Array) -> Array:
    """The root of equations near x, whose unknowns are of these sizes, by damped Newton steps.

    ``change`` is the full step, to be taken off. Raises `numpy.linalg.LinAlgError` where the
    iteration does not converge.
    """
    before = math.inf
    for _ in range(MOST_STEPS):
        step = change(x)
        size = float(np.max(np.abs(step) / sizes))
        if not math.isfinite(size):
            break
        x = x - step * (min(1.0, 0.3 / size) if size > 0 else 1.0)
        # What rounding leaves does not fall any further.
        if size < 1e-12 or (size < 1e-9 and size > before / 4):
            return x
        before = size
    raise np.linalg.LinAlgError("no convergence")
