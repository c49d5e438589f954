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

It is 0 for a wave that ends; `Problem` can hold it there and find the masses at which it is.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct, dst

Array = NDArray[np.float64]


def widening(masses: tuple[float, float]) -> float:
    """√(12 I/D²), how much longer than in the uniform chain the canonical wave of `lwa` is."""
    m1, m2 = masses
    return 2 * math.sqrt(m1 * m1 - m1 * m2 + m2 * m2) / (m1 + m2)


def ample_half_period(masses: tuple[float, float], k: float) -> float:
    """L such that a uniform chain's pulse has ended at L, a dimer's at 0.6 L."""
    # Near k = 1, log r = -3 (k-1) ξ²; above, r falls like exp(-k^ξ). Twice 1e-8 makes 1e-16.
    length = 1 + 3.7 / math.sqrt(k - 1) if k < 2 else 1 + 3.7 / math.log2(k) ** 0.5
    return length if masses[0] == masses[1] else max(8.0, 1.15 * length * widening(masses))


def rates(masses: tuple[float, float]) -> tuple[float, float]:
    """Σ and Δ."""
    return 1 / masses[0] + 1 / masses[1], 1 / masses[1] - 1 / masses[0]


def respond(
    even: Array, odd: Array, pair: tuple[float, float], half_period: float
) -> tuple[Array, Array]:
    """c² e and c² o of (*), coefficients for coefficients along the first axis; e_0 is left 0."""
    total, difference = pair
    n = len(even) - 1
    q = np.pi * np.arange(n + 1) / half_period
    square = np.maximum(q, q[1]) ** 2
    mass, cross, light = (
        (row / square).reshape(-1, *[1] * (even.ndim - 1))
        for row in (
            total * 2 * np.sin(q / 2) ** 2,
            difference * np.sin(q),
            total * 2 * np.cos(q / 2) ** 2,
        )
    )
    e, o = mass * even + cross * odd, cross * even + light * odd
    e[0] = 0
    o[[0, n]] = 0
    return e, o


def at_end(even: Array) -> Array:
    """The value at L of a cosine series, but for its constant."""
    result: Array = even[1::2].sum(axis=0) * -1 + even[2::2].sum(axis=0)
    return result


def coefficients(even: Array, odd: Array) -> tuple[Array, Array]:
    """Of cos and sin, from values at ξ = 0 … L (0 … n; odd 1 … n-1), along the first axis."""
    n = len(even) - 1
    c = dct(even, 1, axis=0) / n
    c[[0, n]] /= 2
    s = np.zeros_like(odd, shape=(n + 1, *odd.shape[1:]))
    s[1:n] = dst(odd, 1, axis=0) / n
    return c, s


def values(even: Array, odd: Array) -> tuple[Array, Array]:
    """The inverse of `coefficients`, odd values with their zeros at 0 and L."""
    n = len(even) - 1
    c = even / 2
    c[[0, n]] *= 2
    s = np.zeros_like(odd)
    s[1:n] = dst(odd[1:n], 1, axis=0) / 2
    return np.asarray(dct(c, 1, axis=0)), s


class Problem:
    """E - (a_+^k + b_+^k)/2 = 0 and O - (a_+^k - b_+^k)/2 = 0 on a grid, with E(0) = 1 for c².

    With ``free`` masses T = 0 too, for the unknown 1/m2, on which the response depends linearly.
    """

    def __init__(
        self, masses: tuple[float, float], k: float, half_period: float, n: int, free: bool
    ) -> None:
        self.k, self.n, self.free = k, n, free
        self.xi = half_period * np.arange(n + 1) / n
        self.count = n + 1 if masses[0] == masses[1] else 2 * n  # o = 0 for equal masses
        self.first = 1 / masses[0]
        self.parts = [self._response((1.0, sign)) for sign in (-1.0, 1.0)]

    def _response(self, pair: tuple[float, float]) -> tuple[Array, Array, Array]:
        """e, o and T, times c², of the forces on the grid; for Σ and Δ."""
        n, L = self.n, self.xi[-1]
        unit = np.eye(2 * n)[:, : self.count]
        e, o = values(*respond(*coefficients(unit[: n + 1], unit[n + 1 :]), pair, L))
        weights = np.full(n + 1, pair[1] * L / n)
        weights[[0, n]] /= 2
        T = np.append(weights, 2 * pair[0] * self.xi[1:n] * L / n)[: self.count]
        return e - e[n], o, T

    def newton(self, z: Array, c2: float, light: float) -> tuple[Array, float, float]:
        """Forces, c² and 1/m2, from a first guess."""
        n, k, count, free = self.n, self.k, self.count, self.free
        z = z[:count] / z[0]
        matrix = np.zeros((count + 1 + free, count + 1 + free))
        for _ in range(40):
            even, odd, T = (self.first * a + light * b for a, b in zip(*self.parts, strict=True))
            e, o = even @ z / c2, odd @ z / c2
            a, b = np.maximum(e + o, 0), np.maximum(e - o, 0)
            Fa, Fb, da, db = a**k, b**k, k * a ** (k - 1), k * b ** (k - 1)

            def joined(mean: Array, half: Array) -> Array:
                return np.concatenate((mean, half[1:n]))[:count]

            def slope(e: Array, o: Array, da: Array = da, db: Array = db) -> Array:
                """The change of the law's two rows with the strains."""
                p, m = ((da + s * db).reshape(-1, *[1] * (e.ndim - 1)) / 2 for s in (1, -1))
                return joined(p * e + m * o, m * e + p * o)

            law = joined((Fa + Fb) / 2, (Fa - Fb) / 2)
            matrix[:count, :count] = np.eye(count) - slope(even, odd) / c2
            matrix[:count, count] = slope(e, o) / c2
            matrix[count, 0] = 1
            fault = np.append(z - law, z[0] - 1)
            if free:
                matrix[:count, -1] = -slope(*(part @ z / c2 for part in self.parts[1][:2]))
                matrix[-1, :count], matrix[-1, -1] = T, self.parts[1][2] @ z
                fault = np.append(fault, T @ z)
            change = np.linalg.solve(matrix, fault)
            relative = np.abs(change) / ([1.0] * count + [c2] + [light] * free)
            size = float(relative.max())
            step = min(1.0, 0.3 / size) if size > 0 else 1.0
            z, c2 = z - step * change[:count], c2 - step * change[count]
            light -= step * change[-1] * free
            if size < 1e-12:
                return z, c2, light
        raise np.linalg.LinAlgError("no convergence")
