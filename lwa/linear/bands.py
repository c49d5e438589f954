"""Bloch's bands in floats: frequencies and group velocities of the linear chain.

With the displacements a_i and forces f_i of `lwa.linear.bloch`, the vectors of the components
a_i √(P m̂_i) and f_i √C_i are related by a matrix B(κ), whose singular values are the frequencies
Ω_j. Eigenvalues of BᴴB would lose half the digits of a small Ω.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array, finite

Complex = NDArray[np.complex128]


class Bands(NamedTuple):
    """The bands of a chain of mass fractions m̂_i and strain shares C_i, shape (P,) each.

    rate, length : units of frequencies, and of the lengths in wavenumbers and group velocities.
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
        B, _ = self._strains(q)
        return np.linalg.svd(B, compute_uv=False)[..., ::-1].astype(float) * self.rate

    def group_velocity(self, q: ArrayLike) -> Array:
        """Slopes of the `branches`; where branches touch each other or zero, towards larger q."""
        B, dB = self._strains(q)
        left, omega, right = np.linalg.svd(B)
        # dΩ = Re (left vector)ᴴ dB (right vector), where dB has one entry, from the first particle
        # to the last contact.
        S = left[..., -1, :, None].conj() * dB[..., None, None] * right[..., None, :, 0].conj()
        slopes = np.diagonal(S, axis1=-2, axis2=-1)
        equal = 64 * np.finfo(float).eps * omega[..., :1]
        velocity = np.where(omega <= equal, np.abs(slopes), slopes.real).astype(float)
        # No more than two branches meet in a point: the slopes are eigenvalues of a 2 × 2 matrix.
        for i in range(len(self.fractions) - 1):
            j = i + 1
            mean = (slopes[..., i] + slopes[..., j]).real / 2
            half = (slopes[..., i] - slopes[..., j]).real / 2
            split = np.hypot(half, np.abs(S[..., i, j] + S[..., j, i].conj()) / 2)
            touch = omega[..., i] - omega[..., j] <= equal[..., 0]
            velocity[..., i] = np.where(touch, mean + split, velocity[..., i])
            velocity[..., j] = np.where(touch, mean - split, velocity[..., j])
        return velocity[..., ::-1] * (self.rate * self.length)

    def edges(self) -> Array:
        """Band edges (min, max) of each branch, shape (P, 2), at κ = 0 and π/P."""
        ends = self.branches([0.0, np.pi / len(self.fractions) / self.length])
        return np.asarray(np.sort(ends, axis=0).T)

    def gaps(self) -> Array:
        """Edges (from, to) of the P - 1 gaps between the bands; closed gaps have length 0."""
        edges = self.edges()
        return np.stack([edges[:-1, 1], edges[1:, 0]], axis=-1)

    def _strains(self, q: ArrayLike) -> tuple[Complex, Complex]:
        """Return the module's matrix B(κ), and the only nonzero entry of dB/dκ, in its last row."""
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
        end = np.exp(1j * P * kappa) / (share[-1] * mass[0])
        B[..., -1, 0] += end
        return B, 1j * P * end
