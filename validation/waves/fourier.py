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
from functools import cached_property

import numpy as np
import scipy

from lwa.numeric import Array
from validation.scenes.checks import integer

MOST_STEPS = 40  # of Newton's method


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
    even: Array, odd: Array, pair: tuple[float, float], half_period: float
) -> tuple[Array, Array]:
    """c² e and c² o of (*) for Σ, Δ, coefficients along the first axis; e_0 is left 0."""
    total, difference = pair
    n = len(even) - 1
    q = np.pi * np.arange(n + 1) / half_period
    square = np.maximum(q, q[1]) ** 2
    heavy, light = (total * 2 * f(q / 2) ** 2 for f in (np.sin, np.cos))
    mass, cross, light = (
        (row / square).reshape(-1, *[1] * (even.ndim - 1))
        for row in (heavy, difference * np.sin(q), light)
    )
    e, o = mass * even + cross * odd, cross * even + light * odd
    e[0] = 0
    o[[0, n]] = 0
    return e, o


def coefficients(even: Array, odd: Array) -> tuple[Array, Array]:
    """Of cos and sin, from values at ξ = 0 … L (0 … n; odd 1 … n-1), along the first axis."""
    n = len(even) - 1
    c = scipy.fft.dct(even, 1, axis=0) / n
    c[[0, n]] /= 2
    s = np.zeros_like(odd, shape=(n + 1, *odd.shape[1:]))
    s[1:n] = scipy.fft.dst(odd, 1, axis=0) / n
    return c, s


def values(even: Array, odd: Array) -> tuple[Array, Array]:
    """The inverse of `coefficients`, odd values with their zeros at 0 and L."""
    n = len(even) - 1
    c = even / 2
    c[[0, n]] *= 2
    s = np.zeros_like(odd)
    s[1:n] = scipy.fft.dst(odd[1:n], 1, axis=0) / 2
    return np.asarray(scipy.fft.dct(c, 1, axis=0)), s


class Problem:
    """E - (F_a + F_b)/2 = 0 and O - (F_a - F_b)/2 = 0 on a grid, with E(0) = 1 - p0^k for c².

    Unknowns are the forces z (E at ξ = 0 … L, then O between) and c²; strains are linear in 1/m2.
    """

    def __init__(
        self, masses: tuple[float, float], k: float, half_period: float, n: int, p0: float = 0.0
    ) -> None:
        self.k, self.n, self.p0 = k, n, p0
        self.height = -math.expm1(k * math.log(p0)) if p0 else 1.0
        self.xi = half_period * np.arange(n + 1) / n
        self.uniform = masses[0] == masses[1]
        self.count = n + 1 if self.uniform else 2 * n  # o = 0 for equal masses
        self.inverse = 1 / masses[0], 1 / masses[1]

    @cached_property
    def parts(self) -> list[tuple[Array, Array, Array]]:
        """The response of every force on the grid, in e, o and T, times c²; by 1/m1 and by 1/m2."""
        n, L, found = self.n, self.xi[-1], []
        for pair in ((1.0, -1.0), (1.0, 1.0)):
            e, o = self._strains(np.eye(2 * n)[:, : self.count], pair)
            weights = np.full(n + 1, pair[1] * L / n)
            weights[[0, n]] /= 2
            T = np.append(weights, 2 * pair[0] * self.xi[1:n] * L / n)[: self.count]
            found.append((e, o, T))
        return found

    def _strains(self, z: Array, pair: tuple[float, float]) -> tuple[Array, Array]:
        """c² e and c² o of forces on the grid, all 2n of them, for Σ and Δ."""
        n = self.n
        e, o = values(*respond(*coefficients(z[: n + 1], z[n + 1 :]), pair, float(self.xi[-1])))
        return e - e[n], o

    def fault(self, z: Array, c2: float, light: float) -> Array:
        """What is left of the equations."""
        first, padded = self.inverse[0], np.append(z, np.zeros(2 * self.n - self.count))
        e, o = self._strains(padded, (first + light, light - first))
        Fa, Fb = (rise(r / c2, self.k, self.p0) for r in (e + o, e - o))
        law = self._rows((Fa + Fb) / 2, (Fa - Fb) / 2)
        return np.append(z - law, z[0] - self.height)

    def _rows(self, mean: Array, half: Array) -> Array:
        return np.concatenate((mean, half[1 : self.n]))[: self.count]

    def equations(self, z: Array, c2: float, light: float) -> tuple[Array, Array]:
        """`fault`, and its derivatives by z, c² and 1/m2."""
        k, count = self.k, self.count
        even, odd, _ = self._at(light)
        e, o = even @ z / c2, odd @ z / c2
        da, db = (k * np.maximum(self.p0 + r, 0) ** (k - 1) for r in (e + o, e - o))

        def slope(e: Array, o: Array) -> Array:  # of the law's two rows with the strains
            p, m = ((da + s * db).reshape(-1, *[1] * (e.ndim - 1)) / 2 for s in (1, -1))
            return self._rows(p * e + m * o, m * e + p * o)

        matrix = np.zeros((count + 1, count + 2))
        matrix[:-1, :count] = np.eye(count) - slope(even, odd) / c2
        matrix[:-1, count] = slope(e, o) / c2
        matrix[:-1, -1] = -slope(*(part @ z / c2 for part in self.parts[1][:2]))
        matrix[count, 0] = 1
        return self.fault(z, c2, light), matrix

    def _at(self, light: float) -> tuple[Array, Array, Array]:
        """What `parts` come to at these masses."""
        even, odd, T = (self.inverse[0] * a + light * b for a, b in zip(*self.parts, strict=True))
        return even, odd, T

    def wave(self, z: Array, c2: float, unknown: str = "") -> tuple[Array, float, float]:
        """Forces, c², and where it is asked for the "mass" (as 1/m2) or the "kick" with T = 0.

        Raises `numpy.linalg.LinAlgError` where Newton's method does not converge.
        """
        count, inner = self.count, self.xi[1 : self.n]
        kick = np.append(np.zeros(self.n + 1), inner * np.exp(-2 * inner**2))

        def step(x: Array) -> tuple[Array, Array]:
            light = x[-1] if unknown == "mass" else self.inverse[1]
            fault, matrix = self.equations(x[:count], x[count], light)
            if not unknown:
                return fault, matrix[:, :-1]
            T, last = self._at(light)[2], float(self.parts[1][2] @ x[:count])
            if unknown == "kick":
                fault[:-1] -= x[-1] * kick
                matrix[:-1, -1], last = -kick, 0.0
            row = np.append(T, [0.0, last])
            return np.append(fault, T @ x[:count]), np.vstack((matrix, row))

        others = [c2, *{"": (), "mass": (self.inverse[1],), "kick": (0.0,)}[unknown]]
        sizes = np.append(np.full(count, self.height), [other or 1.0 for other in others])
        x = newton(step, np.append(z[:count] * (self.height / z[0]), others), sizes)
        return x[:count], float(x[count]), float(x[-1])


def problem(
    masses: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> Problem:
    """On an ample period, and on points that resolve the wave, unless they are given."""
    L = ample_half_period(masses, k) if half_period is None else half_period
    # Per site: the pulse's own Fourier width, its steeper flanks at large k, the light beads.
    beads = math.sqrt(sum(masses) / min(masses) - 1)
    dense = 3 + 9 * math.sqrt(k - 1) + 7 * max(k - 2, 0) + 1.5 * beads
    n = max(40, math.ceil(dense * L)) if points is None else integer(points, "points", 8, 2000)
    return Problem(masses, k, L, n)


@np.errstate(all="ignore")  # what overflows, or has c² < 0, does not converge
def newton(step: Callable[[Array], tuple[Array, Array]], x: Array, sizes: Array) -> Array:
    """The root of equations near x, whose unknowns are of these sizes, by damped Newton steps.

    ``step`` gives what is left of the equations and its Jacobian. Raises
    `numpy.linalg.LinAlgError` where the iteration does not converge.
    """
    before = math.inf
    for _ in range(MOST_STEPS):
        fault, matrix = step(x)
        change = np.linalg.solve(matrix, fault)
        size = float(np.max(np.abs(change) / sizes))
        if not math.isfinite(size):
            break
        x = x - change * (min(1.0, 0.3 / size) if size > 0 else 1.0)
        # What rounding leaves does not fall any further.
        if size < 1e-12 or (size < 1e-9 and size > before / 4):
            return x
        before = size
    raise np.linalg.LinAlgError("no convergence")
