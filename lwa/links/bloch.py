"""The acoustic branch of a lattice of springs, in series: its stiffness F′ and dispersion I.

With the displacement u_n = a_i e^{s n} of the particle n, i = n mod P, and lengths in spacings, a
link (i, j) of the spring constant K and the range r = j - i has the compression b·a e^{s i},
b = cosine (e_i - e^{s r} e_j). The particles obey

    λ² m_i a_i + Σ_n s^n (k_n a)_i = 0,    Σ s^n k_n = Σ_links K b(-s) b(s)ᵀ.

At the imaginary s = iq the frequency is Ω² = -λ². The powers of s, with a = 1 + s a_1 + s² a_2 + …,
give λ² = F′/m̄ (s² + I s⁴ + …) one after the other: F′ is the stiffness of the lattice, m̄ the mean
mass, and I the coefficient in Ω² = c² (q² - I q⁴ + …). Arrays of springs may have axes in front.
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np

from lwa.base.arrays import Array


class Branch(NamedTuple):
    """Stiffness F′, dispersion I, and strain dδ/d(Dp) of each link per mean compression."""

    stiffness: Array
    dispersion: Array
    shares: Array


class Graph(NamedTuple):
    """Links of a cell of ``size`` particles: (i, j, cosine) each."""

    size: int
    links: tuple[tuple[int, int, float], ...]

    @property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        ends = sorted((i, j) for i, j, _ in self.links)
        return ends == [(n, n + 1) for n in range(self.size)]

    @property
    def spans(self) -> Array:
        """Compression of each link per mean compression of a spacing: cosine · (j - i)."""
        return np.array([c * (j - i) for i, j, c in self.links])

    @property
    def incidence(self) -> Array:
        """Matrix from displacements inside the cell to compressions, shape (links, size)."""
        rows = np.zeros((len(self.links), self.size))
        for row, (i, j, c) in zip(rows, self.links, strict=True):
            row[i] += c
            row[j % self.size] -= c
        return rows

    def matrix(self, n: int) -> Array:
        """Coefficients of s^n in b(-s) b(s)ᵀ, shape (links, size, size)."""
        parts = np.zeros((len(self.links), self.size, self.size))
        for part, (i, j, c) in zip(parts, self.links, strict=True):
            j, power = j % self.size, c * c * (j - i) ** n / factorial(n)
            part[i, j] -= power
            part[j, i] -= (-1) ** n * power
            if not n:
                part[i, i] += c * c
                part[j, j] += c * c
        return parts


def solved(matrix: Array, right: Array) -> Array:
    """Solve a linear system with axes in front; NaN for a singular system."""
    scale = np.abs(matrix).max(axis=(-2, -1), keepdims=True)  # 0/0 is NaN, which is no error
    with np.errstate(all="ignore"):
        return np.linalg.solve(matrix / scale, right[..., None] / scale)[..., 0]


def acoustic(graph: Graph, springs: Array, masses: Array) -> Branch:
    """The acoustic branch for springs of shape (…, links)."""
    k = [np.tensordot(springs, graph.matrix(n), 1) for n in range(5)]
    total = masses.sum()

    def times(n: int, a: Array) -> Array:
        return np.asarray((k[n] @ a[..., None])[..., 0])

    def inner(right: Array) -> Array:  # the first particle's displacement is 0 at each power of s
        found = np.zeros_like(right)
        if graph.size > 1:
            found[..., 1:] = solved(k[0][..., 1:, 1:], -right[..., 1:])
        return found

    one = np.ones_like(masses)
    a1 = inner(times(1, one))
    second = -(times(1, a1) + times(2, one)).sum(axis=-1) / total
    column = np.asarray(second)[..., None]
    a2 = inner(times(1, a1) + times(2, one) + column * masses)
    a3 = inner(times(1, a2) + times(2, a1) + times(3, one) + column * masses * a1)
    rest = times(1, a3) + times(2, a2) + times(3, a1) + times(4, one)
    fourth = -(rest + column * masses * a2).sum(axis=-1) / total
    return Branch(
        second * total / graph.size, fourth / second, graph.spans - a1 @ graph.incidence.T
    )
