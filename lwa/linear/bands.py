"""The bands of a chain in floats: frequencies of all Bloch waves.

Let a and f be the vectors of displacements ``a_i √(P m̂_i)`` and forces ``f_i √C_i`` (letters as in
`lwa.linear.bloch`). They are related by a matrix B(κ)::

    f = B a,    Ω² a = Bᴴ f.

The frequencies are therefore the singular values of B. Its eigenvalue problem, that of ``BᴴB`` for
``Ω²``, would lose half the digits of a small Ω.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

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
        # f_i = (a_{i+1} - a_i)/C_i: contact i pulls on particle i and on the next one.
        B = np.zeros((*phase.shape, P, P), complex)
        for i in range(P):
            B[..., i, i] = -1 / (share[i] * mass[i])
        for i in range(P - 1):
            B[..., i, i + 1] = 1 / (share[i] * mass[i + 1])
        # The last contact joins the next cell's first particle, a_P = e^{iPκ} a_0. In a cell of one
        # particle this is the entry that is set above, hence the sum.
        B[..., -1, 0] += phase / (share[-1] * mass[0])
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
