"""Chains and lattices of springs in floats: the bands of a chain, and long waves in a lattice.

**Bands.** Let a and f be the vectors of displacements ``a_i √(P m̂_i)`` and forces ``f_i √C_i``
(letters as in `lwa.linear.bloch`). They are related by a matrix B(κ)::

    f = B a,    Ω² a = Bᴴ f.

The frequencies are therefore the singular values of B. Its eigenvalue problem, that of ``BᴴB`` for
``Ω²``, would lose half the digits of a small Ω.

**Long waves.** Let the particle n have the displacement ``u_n = a_i e^{s n + λt}``, i the remainder
of n by P; lengths are in spacings. A link from i to j with the spring constant K and the range
``r = j - i`` then has the compression ``b·a e^{s i}``, ``b = cosine (e_i - e^{s r} e_j)``. The
particles obey, M the diagonal matrix of the masses::

    λ² M a + K(s) a = 0,    K(s) = Σ_links K b(-s) b(s)ᵀ = Σ_n s^n k_n.

At the imaginary ``s = iq`` the frequency is ``Ω² = -λ²``. Series in s solve the equation::

    a = Σ_m s^m a_m,    a_0 = (1, …, 1),    λ² = Σ_n Λ_n s^n = F′/m̄ (s² + (I/D²) s⁴ + …),

where ``F′`` is the stiffness of the lattice, m̄ the mean mass, and I the coefficient in
``Ω² = c² (q² - (I/D²) q⁴ + …)``. λ² is even in s, and ``Λ_0 = 0``: a shift needs no force.
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
        return descending[..., ::-1] * self.rate

    def edges(self) -> Array:
        """Least and largest frequency of each branch, shape (P, 2), at the ends of the zone."""
        # In a chain of neighbours Ω of a branch is monotonic in κ from 0 to π/P.
        edge = np.pi / len(self.fractions) / self.length
        ends = self.branches([0.0, edge])
        ends[0, 0] = 0.0  # a shift of all particles, but for rounding
        return np.sort(ends, axis=0).T

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
    return here - factors * following


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
        """Compute the acoustic branch of long waves; NaN where springs of 0 hold no particle.

        The equation ``λ² M a + K(s) a = 0`` (`lwa.linear.springs`) holds at each power of s. At
        ``s^m`` it is::

            k_0 a_m + Σ_{n=1}^m (k_n + Λ_n M) a_{m-n} = 0.

        where ``λ² = Σ_n Λ_n s^n``. The terms ``k_0 a_m`` are forces inside the cell, whose sum over
        the particles is 0. The sum of the equation therefore gives ``Λ_m``, and then the equation
        itself ``a_m``. ``Λ_n`` of odd n are 0: a wave to the right, s, and one to the left, -s,
        have one frequency, so that λ² is even in s.

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
        # k_0 … k_4: the dispersion stands in Λ_4.
        k = [np.tensordot(springs, self._stiffnesses(n), 1) for n in range(5)]
        zero = np.zeros((*springs.shape[:-1], self.size))
        a: list[Array] = [zero + 1]  # a_0, a_1, …
        Lambda: dict[int, Array] = {}  # Λ_2 and Λ_4
        for m in range(1, 5):
            # The sum over n, whose term Λ_m M a_0 is still to come
            known = zero.copy()
            for n in range(1, m + 1):
                column = a[m - n][..., None]
                known += (k[n] @ column)[..., 0]
                if n in Lambda:
                    known += Lambda[n][..., None] * masses * a[m - n]
            if m % 2 == 0:
                Lambda[m] = -known.sum(axis=-1) / total
                known += Lambda[m][..., None] * masses
            # k_0 a_m = -known without the first particle, whose entry of a_m is 0: a factor of a is
            # free. No result needs a_4.
            a_m = zero.copy()
            if self.size > 1 and m < 4:
                held = k[0][..., 1:, 1:]
                a_m[..., 1:] = solved(held, -known[..., 1:])
            a.append(a_m)
        # 0/0 is NaN, the answer where no particle is held.
        with np.errstate(all="ignore"):
            dispersion = Lambda[4] / Lambda[2]
        # At first order in s the mean compression of a spacing is -s. A link from i to j is
        # compressed by s (incidence a_1 - spans): by the displacements a_1 inside the cell, less
        # the mean motion over its span. The shares are the quotient of both.
        return Acoustic(
            stiffness=Lambda[2] * total / self.size,
            dispersion=dispersion,
            shares=self.spans - a[1] @ self.incidence.T,
        )

    def _stiffnesses(self, n: int) -> Array:
        """Parts of ``k_n`` by links of K = 1: ``s^n`` in ``b(-s) b(s)ᵀ``, shape (links, P, P)."""
        parts = np.zeros((len(self.links), self.size, self.size))
        for part, (i, j, cosine) in zip(parts, self.links, strict=True):
            # The particle j of a cell ahead has the amplitude of its image ``last`` in this cell.
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
    # Elimination adds products of entries: near the largest float they overflow, and below the
    # least normal one they lose digits. With entries up to 1 they do neither.
    largest = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
    with np.errstate(all="ignore"):  # 0/0 and ∞/∞ are NaN
        scaled = matrix / largest
        column = right[..., None] / largest
        # The sign is 0 for a singular matrix alone; the determinant itself may underflow to 0.
        sign, _ = np.linalg.slogdet(scaled)
    # NumPy refuses all systems if one is singular, but none for a NaN.
    singular = (sign == 0)[..., None, None]
    found = np.linalg.solve(np.where(singular, np.nan, scaled), column)
    return found[..., 0]
