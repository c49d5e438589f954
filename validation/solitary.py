"""Traveling waves of the lattice to machine precision: Newton's method on spectral profiles.

The equations are those of `spectral`: a chain of beads m1, m2, m1, … at distance 1 whose contacts
push with r_+^k, and a wave mirror symmetric about a bead, with strains e ± o at its two contacts.

A solitary wave leaves no strain T behind. That is one condition more than there are unknowns
(amplitude and speed are tied by scaling), so that a dimer has solitary waves at isolated ratios
m2/m1 only, those of Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606 (2011).
`resonances` finds them by Newton's method on T = 0, with m2/m1 among the unknowns.

At any other ratio the chain has periodic waves (Betti & Pelinovsky, J. Nonlinear Sci. 23, 689
(2013)): on both sides of the pulse the light beads rattle between the heavy ones, for ever and at
an amplitude that does not decay. Such a wave is a nanopteron, its tail the largest |o| on
0.6 L ≤ |ξ| ≤ L. The strains are 0 at ξ = ±L, half way between two pulses. The tail depends on L
through its phase and has a minimum; unless L is given, `exact_wave` returns the wave of that L, of
eight tried, which has the least.

A chain of one mass has always a solitary wave (Friesecke & Wattis 1994; English & Pego 2005).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from lwa.exact import InputError
from lwa.wave import strain_power
from validation import spectral
from validation.checked import SceneError, integer, items, positive, real
from validation.spectral import Array, Problem

TOLERANCE = 1e-9
"""A wave is called solitary when its tail, over the peak strain, is below this and the equations
of motion hold to it."""

SPECIAL_FROM = 1.2
"""The k below which Newton's method is not yet reliable at finding the special ratios in order."""


class NoWave(InputError):
    """Newton's method found no wave; the message names its parameters."""


@dataclass(frozen=True, eq=False)
class ExactWave:
    """One traveling wave, scaled to a contact force 1 (and strain 1) at its peak; A = D = 1.

    masses : (m1, m2); equal for a chain of one mass.
    c2 : c², the square of the speed dx/dt.
    half_period : L; profiles are periodic with 2L, a solitary wave's end before.
    even, odd : coefficients of E in cos(πjξ/L), j = 0 … n, and of O in sin(πjξ/L).
    tail : largest |o| outside the pulse, over the peak strain.
    residual : of the equations of motion, integrated twice, on a grid twice as fine as that on
        which they were solved; over the peak strain.
    """

    masses: tuple[float, float]
    k: float
    c2: float
    half_period: float
    even: Array
    odd: Array
    tail: float
    residual: float

    @property
    def c(self) -> float:
        """The speed dx/dt."""
        return math.sqrt(self.c2)

    @property
    def omega(self) -> float:
        """ω = m2/m1."""
        return self.masses[1] / self.masses[0]

    @property
    def solitary(self) -> bool:
        """Whether the wave has no tail, as far as its residual lets one say so."""
        return self.tail < TOLERANCE and self.residual < TOLERANCE

    @cached_property
    def _q(self) -> Array:
        return np.asarray(np.pi * np.arange(len(self.even)) / self.half_period, float)

    @cached_property
    def _strains(self) -> tuple[Array, Array]:
        e, o = spectral.respond(self.even, self.odd, spectral.rates(self.masses), self.half_period)
        e[0] = -spectral.at_end(e)
        return np.asarray(e / self.c2), np.asarray(o / self.c2)

    def _inside(self, xi: ArrayLike) -> Array:
        """A solitary wave is not repeated."""
        at = np.asarray(xi, float)
        return np.clip(at, -self.half_period, self.half_period) if self.solitary else at

    def strain(self, xi: ArrayLike, contact: int = 0) -> Array:
        """a(ξ) (contact 0, m1 to its left) or b(ξ) = a(-ξ) (contact 1); a gap is negative."""
        at = np.asarray(xi, float)
        value: Array = self._sum(-at if contact % 2 else at, *self._strains)
        return value

    def force(self, xi: ArrayLike, contact: int = 0) -> Array:
        """F_a(ξ) or F_b(ξ), positive."""
        value: Array = np.maximum(self.strain(xi, contact), 0.0) ** self.k
        return value

    def velocity(self, xi: ArrayLike, bead: int = 0) -> Array:
        """Of the beads m1 (bead 0) or m2 (bead 1); far from the pulse a cell has no momentum."""
        ends = [float(self._velocity(np.array(self.half_period), i)) for i in (0, 1)]
        mean = float(np.dot(self.masses, ends) / sum(self.masses))
        return self._velocity(xi, bead) - mean

    def _velocity(self, xi: ArrayLike, bead: int) -> Array:
        sign, q = (-1 if bead % 2 else 1), self._q[1:]
        push = -2 * np.sin(q / 2) * self.even[1:] + sign * 2 * np.cos(q / 2) * self.odd[1:]
        row = np.append(0.0, -push / q) / (self.masses[bead % 2] * self.c)
        return self._sum(xi, row, 0 * row)

    def _sum(self, xi: ArrayLike, even: Array, odd: Array) -> Array:
        phase = np.multiply.outer(self._inside(xi), self._q)
        value: Array = np.cos(phase) @ even + np.sin(phase) @ odd
        return value

    def quantity(self, name: str, xi: ArrayLike) -> Array:
        """ "strain", "force" (of contact 0) or "velocity" (of bead m1), as in `lwa`."""
        strain_power(name, self.k)  # refuses other names
        value: Array = getattr(self, name)(xi)
        return value

    def peak(self, name: str) -> tuple[float, float]:
        """Where a quantity is greatest, and its value there."""
        xi = np.linspace(-self.half_period, self.half_period, 4 * len(self.even) + 1)
        value = self.quantity(name, xi)
        return _summit(lambda x: float(self.quantity(name, x)), xi, value)

    def fwhm(self, name: str = "strain") -> float:
        """Full width at half maximum, in D: roots of the profile, not of a table of it."""
        top, peak = self.peak(name)
        xi = top + np.linspace(0, self.half_period, 4 * len(self.even))
        width = 0.0
        for side in (-1, 1):
            points = top + side * (xi - top)
            below = int(np.argmax(self.quantity(name, points) < peak / 2))
            ends = points[below - 1], points[below]
            root = brentq(
                lambda x: float(self.quantity(name, x)) - peak / 2, *ends, xtol=1e-14, rtol=1e-14
            )
            width += abs(float(root) - top)
        return width

    def rms_width(self, name: str = "strain") -> float:
        """√(∫ (ξ - mean)² f / ∫ f) over the period; positive values only (gaps do not count).

        Of a nanopteron it holds the tail and so grows with L.
        """
        n = 8 * len(self.even)
        xi = self.half_period * np.arange(-n, n) / n  # trapezia: exact for what has ended
        f = np.maximum(self.quantity(name, xi), 0.0)
        mean = (f @ xi) / f.sum()
        return math.sqrt(f @ (xi - mean) ** 2 / f.sum())


def exact_wave(
    masses: Sequence[Any],
    k: Any,
    *,
    half_period: float | None = None,
    points: int | None = None,
    start: ExactWave | None = None,
) -> ExactWave:
    """The traveling wave: solitary, or the nanopteron with the least tail.

    Parameters
    ----------
    masses : m1, or m1 and m2.
    k : exponent of F = δ^k, from 1.01 to 8.
    half_period : L, where it is to be this one and not chosen.
    points : n, of the grid on [0, L].
    start : a wave to begin Newton's method with, of near parameters; the theory's otherwise.

    Raises `SceneError` for parameters that cannot be meant, `NoWave` when Newton's method fails.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    pair, k = parameters(masses, k)
    if start is None and k > 3:  # the theory's wave is too wide there
        start = exact_wave(masses, max(3.0, k / 1.25), half_period=half_period)
    least = (
        spectral.ample_half_period(pair, k)
        if half_period is None
        else positive(half_period, "half_period")
    )
    if half_period is not None or pair[0] == pair[1]:
        return solve(pair, k, least, points, start)
    starts = [start]
    if k >= SPECIAL_FROM and (near := _near_solitary(pair, k)) is not None:
        starts.append(near)
    waves: list[ExactWave] = []
    for L in least * np.arange(1.0, 1.8, 0.1):
        for begin in starts:
            try:
                waves.append(solve(pair, k, L, points, begin))
            except NoWave:
                continue
            if waves[-1].solitary:
                return waves[-1]
    if not waves:
        raise NoWave(_named("no wave found", pair, k))
    return min(waves, key=lambda wave: wave.tail)


def continuation(
    parameters: Iterable[tuple[Sequence[Any], Any]], **options: Any
) -> Iterator[ExactWave]:
    """Waves along a path of (masses, k), each started from the one before; options as there."""
    wave: ExactWave | None = None
    for masses, k in parameters:
        wave = exact_wave(masses, k, start=wave, **options)
        yield wave


def free_wave(masses: tuple[float, float], k: float) -> ExactWave | None:
    """The solitary wave of a special ratio, near the theory's wave of these masses."""
    try:
        return solve(masses, k, free=True)
    except NoWave:
        return None


def _near_solitary(masses: tuple[float, float], k: float) -> ExactWave | None:
    """That of the special ratio next to m2/m1 (or of 1), scaled to m1, if one is found there."""
    m1, m2 = masses
    root = math.sqrt(max(m1, m2) / min(m1, m2))
    found = [
        wave
        for shift in (0.0, 0.15)
        if (wave := free_wave((1.0, (root + shift) ** -2), k)) is not None and wave.solitary
    ]
    if not found:
        return None
    best = min(found, key=lambda wave: abs(math.sqrt(1 / wave.masses[1]) - root))
    if m2 <= m1:
        return replace(best, masses=(m1, best.omega * m1), c2=best.c2 / m1)
    return replace(best, masses=(best.omega * m2, m2), c2=best.c2 / m2, odd=-best.odd)  # mirrored


def parameters(masses: Sequence[Any], k: Any) -> tuple[tuple[float, float], float]:
    """m1, m2 and k, checked."""
    given = [positive(m, f"mass {i}") for i, m in enumerate(items(masses, "masses"), start=1)]
    if len(given) not in (1, 2):
        raise SceneError(f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads")
    k = real(k, "k")
    if not 1.01 <= k <= 8:
        raise SceneError(f"k is {k:g}: exact waves are found for k from 1.01 to 8")
    ratio = given[-1] / given[0]
    if not 0.01 <= ratio <= 100:
        raise SceneError(f"m2/m1 is {ratio:g}: exact waves are found for 0.01 to 100")
    return (given[0], given[-1]), k


def _named(text: str, masses: tuple[float, float], k: float) -> str:
    return f"{text} at k = {k:g}, masses {masses[0]:g}, {masses[1]:g}"


def _guess(
    masses: tuple[float, float], k: float, xi: Array, start: ExactWave | None
) -> tuple[Array, float]:
    """E, O on the grid and c², from a near wave or from the theory at leading order.

    There the force is cos^{2k/(k-1)}(βξ), c² = 4 / ((k+1)(m1+m2)), and the contacts of a cell are
    (m2-m1)/(m1+m2) out of step, by which both beads of a cell move alike.
    """
    if start is not None:
        a, b = start.force(xi, 0), start.force(xi, 1)
        c2 = start.c2 * sum(start.masses) / sum(masses)
    else:
        m1, m2 = masses
        beta = (k - 1) * math.sqrt(6 / (k * (k + 1))) / spectral.widening(masses)
        shift = (m2 - m1) / (m1 + m2) / 2
        a, b = (
            np.cos(np.clip(beta * (xi + side * shift), -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
            for side in (-1, 1)
        )
        c2 = 4 / ((k + 1) * (m1 + m2))
    E, O = (a + b) / 2, (a - b)[1:-1] / 2
    return np.append(E, O), c2 * float(E[0]) ** ((1 - k) / k)


def solve(
    masses: tuple[float, float],
    k: float,
    half_period: float | None = None,
    points: int | None = None,
    start: ExactWave | None = None,
    free: bool = False,
) -> ExactWave:
    """One wave, solved on a grid and scaled to a force 1 at its peak; free: m2 is to be found.

    Raises `NoWave` when Newton's method fails.
    """
    L = spectral.ample_half_period(masses, k) if half_period is None else half_period
    # Per site: the pulse's own Fourier width, its steeper flanks at large k, the light beads.
    beads = math.sqrt(sum(masses) / min(masses) - 1)
    dense = 3 + 9 * math.sqrt(k - 1) + 7 * max(k - 2, 0) + 1.5 * beads
    n = max(40, math.ceil(dense * L)) if points is None else integer(points, "points", 8, 2000)
    problem = Problem(masses, k, L, n, free)
    try:
        found = problem.newton(*_guess(masses, k, problem.xi, start), 1 / masses[1])
    except np.linalg.LinAlgError:
        raise NoWave(_named("Newton's method finds no wave", masses, k)) from None
    z, c2, light = found
    z = np.append(z, np.zeros(2 * n - len(z)))
    even, odd = spectral.coefficients(z[: n + 1], z[n + 1 :])
    if free:
        masses = (masses[0], float(1 / light))
    wave = ExactWave(masses, k, c2, L, even, odd, 0.0, 0.0)
    scale = wave.peak("strain")[1]  # strains are divided by it, forces by its power k
    wave = replace(wave, c2=float(c2 * scale ** (1 - k)), even=even / scale**k, odd=odd / scale**k)
    outside = np.linspace(0.6 * L, L, 2 * n)
    odd_strain = (wave.strain(outside) - wave.strain(-outside)) / 2
    return replace(wave, tail=float(np.abs(odd_strain).max()), residual=_residual(wave))


def _residual(wave: ExactWave) -> float:
    """max |r - r[F(r)]| on the grid twice as fine, for both contacts."""
    n, L = 2 * (len(wave.even) - 1), wave.half_period
    xi = L * np.arange(n + 1) / n
    a, b = wave.strain(xi, 0), wave.strain(xi, 1)
    Fa, Fb = np.maximum(a, 0) ** wave.k, np.maximum(b, 0) ** wave.k
    even, odd = spectral.coefficients((Fa + Fb) / 2, (Fa - Fb)[1:n] / 2)
    again = replace(wave, even=even, odd=odd)
    return float(max(np.abs(again.strain(xi, i) - r).max() for i, r in enumerate((a, b))))


def _summit(f: Callable[[float], float], xi: Array, value: Array) -> tuple[float, float]:
    """The maximum of a smooth function near the largest of its samples; its place to 1e-8."""
    i = int(np.argmax(value))
    bounds = xi[max(i - 1, 0)], xi[min(i + 1, len(xi) - 1)]
    top = minimize_scalar(lambda x: -f(x), bounds=bounds, method="bounded", options={"xatol": 1e-9})
    return (float(top.x), -float(top.fun)) if -top.fun > value[i] else (float(xi[i]), value[i])
