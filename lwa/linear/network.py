"""The acoustic branch of a lattice of springs along one axis, for long waves, in floats.

With the displacement u_n = a_i e^{s n} of the particle n, i = n mod P, and lengths in spacings, a
link from i to j with the spring constant K and the range r = j - i has the compression b·a e^{s i},
b = cosine (e_i - e^{s r} e_j). The particles obey

    λ² m_i a_i + Σ_n s^n (k_n a)_i = 0,    Σ s^n k_n = Σ_links K b(-s) b(s)ᵀ.

At the imaginary s = iq the frequency is Ω² = -λ². The powers of s, with a = 1 + s a_1 + s² a_2 + …,
give λ² = F′/m̄ (s² + I s⁴ + …) one after the other: F′ is the stiffness of the lattice, m̄ the mean
mass, and I, here with D = 1, the coefficient in Ω² = c² (q² - I q⁴ + …).
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np

from lwa.base.arrays import Array


class Acoustic(NamedTuple):
    """Stiffness F′, dispersion I, and strain dδ/d(Dp) of each link per mean compression."""

    stiffness: Array
    dispersion: Array
    shares: Array


class Bond(NamedTuple):
    """A spring from particle i to particle j > i; ``cosine`` is that of its angle to the axis."""

    i: int
    j: int
    cosine: float = 1.0


class Network(NamedTuple):
    """The links of a cell of ``size`` particles; j ≥ size is a particle of a cell ahead."""

    size: int
    links: tuple[Bond, ...]

    @property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        pairs = sorted((bond.i, bond.j) for bond in self.links)
        return pairs == [(n, n + 1) for n in range(self.size)]

    @property
    def order(self) -> list[int]:
        """Numbers of the links by their first particles."""
        return sorted(range(len(self.links)), key=lambda n: self.links[n].i)

    @property
    def spans(self) -> Array:
        """Compression of each link per mean compression of a spacing: cosine · (j - i)."""
        return np.array([bond.cosine * (bond.j - bond.i) for bond in self.links])

    @property
    def incidence(self) -> Array:
        """Matrix from displacements inside the cell to compressions, shape (links, size)."""
        rows = np.zeros((len(self.links), self.size))
        for row, bond in zip(rows, self.links, strict=True):
            row[bond.i] += bond.cosine
            row[bond.j % self.size] -= bond.cosine
        return rows

    def acoustic(self, springs: Array, masses: Array) -> Acoustic:
        """The acoustic branch; NaN where no particle is held.

        Parameters
        ----------
        springs : ndarray, shape (…, links)
            Spring constants.
        masses : ndarray, shape (size,)

        Returns
        -------
        Acoustic
            Arrays of the shape of the leading axes, and of ``springs``.
        """
        total = masses.sum()
        k = [np.tensordot(springs, self._powers(n), 1) for n in range(5)]
        rest = np.zeros((*springs.shape[:-1], self.size))
        a: list[Array] = [rest + 1]  # a_0, a_1, …
        square: dict[int, Array] = {}  # coefficients of s² and s⁴ in λ²
        for m in range(1, 5):
            # At s^m the unknown a_m stands in k_0 a_m alone; all other terms are known forces.
            forces = rest.copy()
            for n in range(1, m + 1):
                forces += (k[n] @ a[m - n][..., None])[..., 0]
                if n in square:
                    forces += square[n][..., None] * masses * a[m - n]
            if m % 2 == 0:
                # The forces k_0 a_m inside the cell have the sum 0.
                square[m] = -forces.sum(axis=-1) / total
                forces += square[m][..., None] * masses
            a_m = rest.copy()  # the first particle moves by the 1 of a_0 alone
            if self.size > 1 and m < 4:
                a_m[..., 1:] = solved(k[0][..., 1:, 1:], -forces[..., 1:])
            a.append(a_m)
        with np.errstate(all="ignore"):  # 0/0 is NaN, which is no error
            dispersion = square[4] / square[2]
        stiffness = square[2] * total / self.size
        return Acoustic(stiffness, dispersion, self.spans - a[1] @ self.incidence.T)

    def _powers(self, n: int) -> Array:
        """Coefficients of s^n in b(-s) b(s)ᵀ, shape (links, size, size)."""
        parts = np.zeros((len(self.links), self.size, self.size))
        for part, (i, j, cosine) in zip(parts, self.links, strict=True):
            # The particle of a cell ahead moves as its image in this cell, times e^{s (j - last)}.
            last = j % self.size
            coefficient = cosine**2 * (j - i) ** n / factorial(n)  # of e^{s r}
            part[i, last] -= coefficient
            part[last, i] -= (-1) ** n * coefficient
            # The terms without e^{±s r}
            if n == 0:
                part[i, i] += cosine**2
                part[last, last] += cosine**2
        return parts


def solved(matrix: Array, right: Array) -> Array:
    """Solve linear systems; NaN for a matrix that is singular or not finite.

    Parameters
    ----------
    matrix : ndarray, shape (…, n, n)
    right : ndarray, shape (…, n)

    Returns
    -------
    ndarray, shape (…, n)
    """
    scale = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
    usable = np.isfinite(scale) & (scale > 0)
    scale = np.where(usable, scale, 1)
    # NumPy refuses all systems if one is singular: the identity stands in for those.
    identity = np.eye(matrix.shape[-1])
    matrix = np.where(usable, matrix, identity) / scale
    sign, _ = np.linalg.slogdet(matrix)
    usable &= (sign != 0)[..., None, None]
    matrix = np.where(usable, matrix, identity)
    found = np.linalg.solve(matrix, right[..., None] / scale)
    return np.asarray(np.where(usable, found, np.nan)[..., 0])
