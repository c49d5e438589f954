"""Bloch's bands in floats: frequencies and group velocities of the linear chain.

With the displacements a_i and forces f_i of `lwa.linear.bloch`, the vectors of the components
a_i √(P m̂_i) and f_i √C_i are related by a matrix B(κ), whose singular values are the frequencies
Ω_j. Eigenvalues of BᴴB would lose half the digits of a small Ω.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array, finite

Complex = NDArray[np.complex128]


def branches(fractions: Array, shares: Array, kappa: ArrayLike) -> Array:
    """Frequencies Ω_j(κ), ascending along a last axis of length P, to 1e-15 of the largest.

    fractions, shares : mass fractions m̂_i and strain shares C_i.

    Raises `lwa.InputError` for a κ that is no finite number.
    """
    B, _ = _strains(fractions, shares, kappa)
    return np.linalg.svd(B, compute_uv=False)[..., ::-1].astype(float)


def group_velocity(fractions: Array, shares: Array, kappa: ArrayLike) -> Array:
    """Slopes dΩ_j/dκ in the order of `branches`, by dΩ = Re (left vector)ᴴ dB (right vector).

    A branch has a kink where it touches another branch or zero; the slope there is the one towards
    larger κ.
    """
    B, dB = _strains(fractions, shares, kappa)
    left, omega, right = np.linalg.svd(B)
    # dB has one entry, from the first particle to the last contact
    S = left[..., -1, :, None].conj() * dB[..., None, None] * right[..., None, :, 0].conj()
    slopes = np.diagonal(S, axis1=-2, axis2=-1)
    equal = 64 * np.finfo(float).eps * omega[..., :1]
    velocity = np.where(omega <= equal, np.abs(slopes), slopes.real).astype(float)
    for i in range(len(fractions) - 1):  # no more than two branches meet in a point
        j = i + 1
        mean = (slopes[..., i] + slopes[..., j]).real / 2
        half = (slopes[..., i] - slopes[..., j]).real / 2
        split = np.hypot(half, np.abs(S[..., i, j] + S[..., j, i].conj()) / 2)
        touch = omega[..., i] - omega[..., j] <= equal[..., 0]
        velocity[..., i] = np.where(touch, mean + split, velocity[..., i])
        velocity[..., j] = np.where(touch, mean - split, velocity[..., j])
    return velocity[..., ::-1]


def edges(fractions: Array, shares: Array) -> Array:
    """Band edges (min, max) of each branch Ω_j, shape (P, 2), at κ = 0 and π/P."""
    ends = branches(fractions, shares, [0.0, np.pi / len(fractions)])
    result: Array = np.sort(ends, axis=0).T
    return result


def _strains(fractions: Array, shares: Array, kappa: ArrayLike) -> tuple[Complex, Complex]:
    """Return the matrix B(κ) and the only nonzero entry of dB/dκ, which is in its last row."""
    wave = finite(kappa, "kappa")
    # reduce κ to [-π, π]; e^{iκ} drops whole turns exactly
    wave = np.where(np.abs(wave) <= np.pi, wave, np.angle(np.exp(1j * wave)))
    P = len(fractions)
    mass, share = np.sqrt(P * fractions), np.sqrt(shares)
    B = np.zeros((*wave.shape, P, P), complex)
    for i in range(P):
        B[..., i, i] = -1 / (share[i] * mass[i])
        if i < P - 1:
            B[..., i, i + 1] = 1 / (share[i] * mass[i + 1])
    end = np.exp(1j * P * wave) / (share[-1] * mass[0])
    B[..., -1, 0] += end
    return B, 1j * P * end
