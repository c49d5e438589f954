"""Bloch's bands in floats: all branches of a chain, the acoustic branch of any lattice.

Chain. With the displacements a_i and forces f_i of `lwa.linear.bloch`, the vectors of the
components a_i √(P m̂_i) and f_i √C_i are related by a matrix B(κ), whose singular values are the
frequencies Ω_j. Eigenvalues of BᴴB would lose half the digits of a small Ω.

Lattice. With the displacement u_n = a_i e^{s n} of the particle n, i = n mod P, and lengths in
spacings, a link (i, j) of the spring constant K and the range r = j - i has the compression
b·a e^{s i}, b = cosine (e_i - e^{s r} e_j). The particles obey

    λ² m_i a_i + Σ_n s^n (k_n a)_i = 0,    Σ s^n k_n = Σ_links K b(-s) b(s)ᵀ.

At the imaginary s = iq the frequency is Ω² = -λ². The powers of s, with a = 1 + s a_1 + s² a_2 + …,
give λ² = F′/m̄ (s² + I s⁴ + …) one after the other: F′ is the stiffness of the lattice, m̄ the mean
mass, and I the coefficient in Ω² = c² (q² - I q⁴ + …).
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite


class Bands(NamedTuple):
    """The bands of a chain of mass fractions m̂_i and strain shares C_i, shape (P,) each.

    rate, length : units of frequencies, and of the lengths in wavenumbers.
    """

    fractions: Array
    shares: Array
    rate: float = 1.0
    length: float = 1.0

    def branches(self, q: ArrayLike) -> Array:
        """Frequencies at wavenumbers of any shape, ascending along a new last axis of length P.

        Their errors are 1e-15 of the largest. Raises `lwa.InputError` for wavenumbers that are not
        finite.
        """
        kappa = finite(q, "wavenumber") * self.length
        # reduce κ to [-π, π]; e^{iκ} drops whole turns exactly
        kappa = np.where(np.abs(kappa) <= np.pi, kappa, np.angle(np.exp(1j * kappa)))
        P = len(self.fractions)
        mass, share = np.sqrt(P * self.fractions), np.sqrt(self.shares)
        B = np.zeros((*kappa.shape, P, P), complex)
        for i in range(P):
            B[..., i, i] = -1 / (share[i] * mass[i])
            if i < P - 1:
                B[..., i, i + 1] = 1 / (share[i] * mass[i + 1])
        B[..., -1, 0] += np.exp(1j * P * kappa) / (share[-1] * mass[0])
        return np.linalg.svd(B, compute_uv=False)[..., ::-1].astype(float) * self.rate

    def edges(self) -> Array:
        """Band edges (min, max) of each branch, shape (P, 2), at κ = 0 and π/P."""
        ends = self.branches([0.0, np.pi / len(self.fractions) / self.length])
        return np.asarray(np.sort(ends, axis=0).T)


class Acoustic(NamedTuple):
    """Stiffness F′, dispersion I, and strain dδ/d(Dp) of each link per mean compression."""

    stiffness: Array
    dispersion: Array
    shares: Array


class Network(NamedTuple):
    """Links (i, j, cosine) of a cell of ``size`` particles."""

    size: int
    links: tuple[tuple[int, int, float], ...]

    @property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        return sorted((i, j) for i, j, _ in self.links) == [
            (n, n + 1) for n in range(self.size)
        ]

    @property
    def order(self) -> list[int]:
        """Numbers of the links by their first particles."""
        return sorted(range(len(self.links)), key=lambda n: self.links[n][0])

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

    def acoustic(self, springs: Array, masses: Array) -> Acoustic:
        """Acoustic branch for springs of shape (…, links); NaN where no particle is held."""
        k = [np.tensordot(springs, self._powers(n), 1) for n in range(5)]
        total, one = masses.sum(), np.ones((*springs.shape[:-1], self.size))
        a: list[Array] = [one]  # a_0, a_1, …
        square: dict[int, Array] = {}  # coefficients of s² and s⁴ in λ²
        for m in range(1, 5):
            forces = np.zeros_like(one)
            for n in range(1, m + 1):
                forces += (k[n] @ a[m - n][..., None])[..., 0]
                if n in square:
                    forces += square[n][..., None] * masses * a[m - n]
            if m % 2 == 0:  # inner forces have the sum 0
                square[m] = -forces.sum(axis=-1) / total
                forces += square[m][..., None] * masses
            a.append(
                np.zeros_like(one)
            )  # the first particle moves by the 1 of a_0 alone
            if self.size > 1 and m < 4:
                a[m][..., 1:] = solved(k[0][..., 1:, 1:], -forces[..., 1:])
        shares = self.spans - a[1] @ self.incidence.T
        with np.errstate(all="ignore"):  # 0/0 is NaN, which is no error
            dispersion = square[4] / square[2]
        return Acoustic(square[2] * total / self.size, dispersion, shares)

    def _powers(self, n: int) -> Array:
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
    """Solve linear systems with axes in front; NaN for a matrix that is singular or not finite."""
    scale = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
    good = np.isfinite(scale) & (scale > 0)
    one, scale = np.eye(matrix.shape[-1]), np.where(good, scale, 1)
    matrix = np.where(good, matrix, one) / scale
    sign, _ = np.linalg.slogdet(
        matrix
    )  # 0 where a pivot is: one such matrix refuses them all
    good &= (sign != 0)[..., None, None]
    found = np.linalg.solve(np.where(good, matrix, one), right[..., None] / scale)
    return np.asarray(np.where(good, found, np.nan)[..., 0])
