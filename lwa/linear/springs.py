"""Chains and lattices of springs in floats: the bands of a chain, and long waves in a lattice.

**Bands.** Let a and f be the vectors of displacements ``a_i √(P m̂_i)`` and forces ``f_i √C_i``
(letters as in `lwa.linear.bloch`). They are related by a matrix B(κ)::

    f = B a,    Ω² a = Bᴴ f.

The frequencies are therefore the singular values of B. Its eigenvalue problem, that of ``BᴴB`` for
``Ω²``, would lose half the digits of a small Ω.

**Long waves.** Let the particle n have the displacement ``u_n = a_i e^{s n + λt}``, i the remainder
of n by P; lengths are in spacings. A link from i to j with the spring constant K and the range
``r = j - i`` then has the compression ``b·a e^{s i}``, ``b = cosine (e_i - e^{s r} e_j)``. The
particles obey::

    λ² m_i a_i + Σ_n s^n (k_n a)_i = 0,    Σ s^n k_n = Σ_links K b(-s) b(s)ᵀ.

At the imaginary ``s = iq`` the frequency is ``Ω² = -λ²``. The powers of s, with the series
``a = 1 + s a_1 + s² a_2 + …``, give ``λ² = F′/m̄ (s² + (I/D²) s⁴ + …)`` one after the other, where
``F′`` is the stiffness of the lattice, m̄ the mean mass, and I the coefficient in
``Ω² = c² (q² - (I/D²) q⁴ + …)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array, finite
from lwa.base.frozen import Value


@dataclass(frozen=True, eq=False)
class Bands(Value):
    """The bands of a chain.

    Attributes
    ----------
    fractions, shares : ndarray, shape (P,)
        Mass fractions ``m̂_i`` of the particles, strain shares ``C_i`` of the contacts.
    rate, length : float
        Units of the frequencies, and of the lengths in wavenumbers.
    """

    fractions: Array
    shares: Array
    rate: float = 1.0
    length: float = 1.0

    def branches(self, q: ArrayLike) -> Array:
        """Frequencies of all branches; their errors are 1e-15 of the largest.

        Parameters
        ----------
        q : array_like
            Wavenumbers, of any shape.

        Returns
        -------
        ndarray
            Frequencies, ascending along a new last axis of length P.

        Raises
        ------
        InputError
            For wavenumbers that are not finite, in units of the length too.
        """
        P = len(self.fractions)
        # A product beyond the range of a float is infinite.
        with np.errstate(over="ignore"):
            turn = finite(q, "wavenumber") * (P * self.length)
        phase = np.exp(1j * finite(turn, "wavenumber times length"))
        mass = np.sqrt(P * self.fractions)
        share = np.sqrt(self.shares)
        B = compressions(phase, P) / (share[:, None] * mass)
        # NumPy's singular values descend.
        descending = np.linalg.svd(B, compute_uv=False)
        return descending[..., ::-1].astype(float) * self.rate

    def edges(self) -> Array:
        """Least and largest frequency of each branch, shape (P, 2), at the ends of the zone."""
        # In a chain of neighbours Ω of a branch is monotonic in κ from 0 to π/P.
        edge = np.pi / len(self.fractions) / self.length
        ends = self.branches([0.0, edge])
        ends[0, 0] = 0.0  # a shift of all particles, but for rounding
        return np.asarray(np.sort(ends, axis=0).T)

    def __repr__(self) -> str:
        return f"Bands(edges={np.round(self.edges(), 6).tolist()})"


def compressions(phase: NDArray[Any], size: int) -> NDArray[Any]:
    """The matrix from displacements in a cell to the compressions of its contacts.

    Parameters
    ----------
    phase : ndarray, shape (…)
        The factor ``e^{iPκ}`` of the displacements from a cell to the next one.
    size : int
        The number P of particles and contacts in a cell.

    Returns
    -------
    ndarray, shape (…, P, P)
        Contact i is compressed by ``a_i - a_{i+1}``, the last one by ``a_{P-1} - e^{iPκ} a_0``.
    """
    here = np.eye(size)
    following = np.roll(here, 1, axis=1)
    factors = np.ones((*phase.shape, size, 1), phase.dtype)
    factors[..., -1, 0] = phase
    return np.asarray(here - factors * following)


class Acoustic(NamedTuple):
    """The acoustic branch of a lattice for long waves.

    Attributes
    ----------
    stiffness : ndarray
        Stiffness of the lattice: force per mean compression of a spacing.
    dispersion : ndarray
        Coefficient ``I/D²`` of the fourth power of the wavenumber.
    shares : ndarray
        Compression of each link per mean compression of a spacing.
    """

    stiffness: Array
    dispersion: Array
    shares: Array


class Bond(NamedTuple):
    """A spring from particle i to particle j > i; ``cosine`` is that of its angle to the axis."""

    i: int
    j: int
    cosine: float = 1.0


class Network(NamedTuple):
    """The links of one cell.

    Attributes
    ----------
    size : int
        Number P of the particles in a cell.
    links : tuple of Bond
        Springs from particles of the cell; an end j of P or more lies in a cell ahead.
    """

    size: int
    links: tuple[Bond, ...]

    @property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        pairs = sorted((bond.i, bond.j) for bond in self.links)
        neighbours = [(n, n + 1) for n in range(self.size)]
        return pairs == neighbours

    @property
    def spans(self) -> Array:
        """Compression of each link per mean compression of a spacing: cosine · (j - i)."""
        spans = []
        for bond in self.links:
            spans.append(bond.cosine * (bond.j - bond.i))
        return np.array(spans)

    @property
    def incidence(self) -> Array:
        """Matrix from displacements inside the cell to compressions, shape (links, size)."""
        rows = np.zeros((len(self.links), self.size))
        for row, bond in zip(rows, self.links, strict=True):
            row[bond.i] += bond.cosine
            row[bond.j % self.size] -= bond.cosine
        return rows

    def acoustic(
        self,
        springs: Array,
        masses: Array,
    ) -> Acoustic:
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
        # k_0 … k_4: the fourth power of s has the dispersion.
        k = []
        for n in range(5):
            k.append(np.tensordot(springs, self._powers(n), 1))
        zero = np.zeros((*springs.shape[:-1], self.size))
        a: list[Array] = [zero + 1]  # a_0, a_1, …
        square: dict[int, Array] = {}  # coefficients of s² and s⁴ in λ²
        for m in range(1, 5):
            # At s^m the unknown a_m stands in k_0 a_m alone; all other terms are known forces.
            known = zero.copy()
            for n in range(1, m + 1):
                column = a[m - n][..., None]
                known += (k[n] @ column)[..., 0]
                if n in square:
                    known += square[n][..., None] * masses * a[m - n]
            if m % 2 == 0:
                # The forces k_0 a_m inside the cell have the sum 0.
                square[m] = -known.sum(axis=-1) / total
                known += square[m][..., None] * masses
            # The first particle moves by the 1 of a_0 alone; a_4 is not needed.
            a_m = zero.copy()
            if self.size > 1 and m < 4:
                held = k[0][..., 1:, 1:]
                a_m[..., 1:] = solved(held, -known[..., 1:])
            a.append(a_m)
        # 0/0 is NaN, the answer where no particle is held.
        with np.errstate(all="ignore"):
            dispersion = square[4] / square[2]
        return Acoustic(
            stiffness=square[2] * total / self.size,
            dispersion=dispersion,
            shares=self.spans - a[1] @ self.incidence.T,
        )

    def _powers(self, n: int) -> Array:
        """Coefficients of ``s^n`` in ``b(-s) b(s)ᵀ``, shape (links, size, size)."""
        parts = np.zeros((len(self.links), self.size, self.size))
        for part, (i, j, cosine) in zip(parts, self.links, strict=True):
            # The particle of a cell ahead moves as its image in this cell, times e^{s (j - last)}.
            last = j % self.size
            # The coefficient of s^n in cosine² e^{s r}
            coefficient = cosine**2 * (j - i) ** n / factorial(n)
            part[i, last] -= coefficient
            part[last, i] -= (-1) ** n * coefficient
            # The terms without e^{±s r}
            if n == 0:
                part[i, i] += cosine**2
                part[last, last] += cosine**2
        return parts


def solved(
    matrix: Array,
    right: Array,
) -> Array:
    """Solve linear systems; NaN for a matrix that is singular or not finite.

    Parameters
    ----------
    matrix : ndarray, shape (…, n, n)
    right : ndarray, shape (…, n)

    Returns
    -------
    ndarray, shape (…, n)
    """
    # The determinant of entries of order 1 neither over- nor underflows.
    largest = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
    usable = np.isfinite(largest) & (largest > 0)
    scale = np.where(usable, largest, 1)
    # NumPy refuses all systems if one is singular: the identity stands in for those.
    identity = np.eye(matrix.shape[-1])
    scaled = np.where(usable, matrix, identity) / scale
    sign, _ = np.linalg.slogdet(scaled)
    usable &= (sign != 0)[..., None, None]
    scaled = np.where(usable, scaled, identity)
    column = right[..., None] / scale
    found = np.linalg.solve(scaled, column)
    found = np.where(usable, found, np.nan)
    return np.asarray(found[..., 0])
