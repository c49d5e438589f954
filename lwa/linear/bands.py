"""The bands of a chain in floats: frequencies and group velocities of all Bloch waves.

With the displacements a_i and forces f_i of `lwa.linear.bloch`, the vectors of the components
a_i √(P m̂_i) and f_i √C_i are related by a matrix B(κ): f = B a, -Ω² a = -Bᴴ f. The frequencies Ω_j
are therefore the singular values of B. The eigenvalues Ω² of BᴴB would lose half the digits of a
small Ω.
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
        Mass fractions m̂_i of the particles, strain shares C_i of the contacts.
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
            For wavenumbers that are not finite.
        """
        # Whole turns are dropped: P κ would lose the digits that they take up.
        kappa = np.angle(np.exp(1j * finite(q, "wavenumber") * self.length))
        P = len(self.fractions)
        mass = np.sqrt(P * self.fractions)
        share = np.sqrt(self.shares)
        B = np.zeros((*kappa.shape, P, P), complex)
        for i in range(P):
            B[..., i, i] = -1 / (share[i] * mass[i])
        for i in range(P - 1):
            B[..., i, i + 1] = 1 / (share[i] * mass[i + 1])
        # The last contact joins the next cell's first particle: for P = 1 the entry above.
        B[..., -1, 0] += np.exp(1j * P * kappa) / (share[-1] * mass[0])
        ascending = np.linalg.svd(B, compute_uv=False)[..., ::-1]
        return ascending.astype(float) * self.rate

    def edges(self) -> Array:
        """Least and largest frequency of each branch, shape (P, 2), at κ = 0 and π/P."""
        # Branches of a chain have their least and largest frequency at the ends of the zone.
        edge = np.pi / len(self.fractions) / self.length
        ends = self.branches([0.0, edge])
        return np.asarray(np.sort(ends, axis=0).T)

    def __repr__(self) -> str:
        return f"Bands(edges={np.round(self.edges(), 6).tolist()})"
