"""Coefficients of the nonlinear Schrödinger equation from a Bloch mode, over any field of numbers.

About the static load contact i pushes with K2 δ + K3 δ² + K4 δ³ more, δ its further compression. A
mode u = A(X,T) φ e^{i(κn - ωt)} + c.c. of the linear chain, Σ m|φ|² = 1, κ per cell, strains the
contacts by d = B(κ)φ. At second order in A it drives (Remoissenet, *Waves Called Solitons*, 1999)

    the second harmonic, e2 = -G K3 d²,   G = B(2κ) [K(2κ) - 4ω²M]^{-1} B(2κ)†,   per A²,
    the mean inside a cell, K2 e0 + 2 K3 |d|² the same in all contacts, Σ e0 = 0,  per |A|²,
    and the mean flow, the strain e of whole cells.

The frequency changes with e by ω_s = Σ K3 σ |d|²/ω, σ the share of a contact, and the mode's action
2ω|A|² per cell pushes with ω_s; e, of sound speed c_0, moves with the group velocity c_g:
e = 2ω ω_s |A|²/(M_c (c_g² - c_0²)). At third order remains i A_T + ½ω″ A_XX = χ |A|²A with

    χ = Γ/(2ω) + 2ω ω_s²/(M_c (c_g² - c_0²)),    Γ = Σ 3 K4 |d|⁴ + 2 K3 (d̄² e2 + |d|² e0).

Only the projector φφ† of the mode and e^{±iκ} enter, so that numbers may be floats or elements of a
field of rational functions, as objects in NumPy's arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.exact import InputError

CLOSE = 1e-11
"""Relative difference of squared frequencies, or of squared speeds, that counts as none."""

Numbers = NDArray[Any]
Matrix = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Springs:
    """Masses and the coefficients K2, K3, K4 of a cell's contacts, numbers of one field."""

    masses: Numbers
    K2: Numbers
    K3: Numbers
    K4: Numbers

    def stiffness(self, z: Any) -> Matrix:
        """K(κ) = B(κ)† K2 B(κ) at z = e^{iκ}."""
        return np.asarray(self.strains(1 / z).T @ np.diag(self.K2) @ self.strains(z))

    def strains(self, z: Any) -> Matrix:
        """B(κ) of δ_i = φ_i - φ_{i+1}; B(κ)† is its transpose at 1/z."""
        P = len(self.masses)
        B = np.asarray(np.outer(self.K2, self.K2) * (0 * z))
        for i in range(P):
            B[i, i] += 1
            B[i, (i + 1) % P] -= z if i == P - 1 else 1
        return B

    def trace(self, x: Any) -> list[Any]:
        """T(x) and its first two derivatives, where x = ω² has 2 cos κ = T(x).

        T is the trace of the matrix that carries displacement and force through a cell.
        """
        zero = np.array([0, 0, 0]) * x
        total = zero
        for column in range(2):
            u, f = (zero + np.array([int(i == column), 0, 0]) for i in range(2))
            for m, K in zip(self.masses, self.K2, strict=True):
                f = f + np.array([x * u[0], u[0] + x * u[1], 2 * u[1] + x * u[2]]) * m
                u = u - f / K
            total = total + (u, f)[column]
        return list(total)


@dataclass(frozen=True, eq=False)
class Coefficients:
    """Parts of the envelope's coefficients, at x = ω².

    slope, bend : 1/T′ and d²x/dκ²; dx/dκ = -2 sin κ · slope.
    excess : c_g² - c_0², zero at the resonance of the mode with sound.
    cubic : 2ω χ.
    second, mean : contact → compression per A² at 2ω, and at zero frequency per |A|².
    size : contact → |d|².
    mode : bead → φ times the conjugate of φ of the bead of reference.
    """

    slope: Any
    bend: Any
    excess: Any
    cubic: Any
    second: Numbers
    mean: Numbers
    size: Numbers
    mode: Numbers


def coefficients(
    springs: Springs, z: Any, x: Any, projector: Matrix, reference: int,
    inverse: Callable[[Matrix], Matrix],
) -> Coefficients:  # fmt: skip
    """Evaluate the module's formulas for the mode with ω² = x at z = e^{iκ}.

    projector : φφ†, of a φ with Σ m|φ|² = 1.
    reference : the bead whose displacement is in phase with A.
    inverse : of a matrix of these numbers.
    """
    m, K2, K3 = springs.masses, springs.K2, springs.K3
    B = springs.strains(z)
    D = B @ projector @ springs.strains(1 / z).T
    size = np.diagonal(D)
    rest = springs.stiffness(z * z) - np.diag(m) * (4 * x)
    G = springs.strains(z * z) @ inverse(rest) @ springs.strains(1 / (z * z)).T
    d = (B @ projector)[:, reference]
    second = -G @ (K3 * d * d / projector[reference, reference])

    compliance = (1 / K2).sum()
    share = 1 / (K2 * compliance)
    e0 = (-2 * K3 * size + (2 * K3 * size / K2).sum() / compliance) / K2
    gamma = (3 * springs.K4 * size**2 + 2 * K3 * size * e0).sum() - 2 * K3 @ (G * D.T**2) @ K3

    _, first, following = springs.trace(x)
    sine = -((z - 1 / z) ** 2)  # 4 sin²κ
    bend = (-(z + 1 / z) - following * sine / first**2) / first
    excess = sine / (4 * x * first**2) - 1 / (compliance * m.sum())
    g = (K3 * share * size).sum()  # ω ω_s
    flow = 2 * g / (m.sum() * excess)
    return Coefficients(
        1 / first, bend, excess, gamma + 2 * g * flow, second, e0 + share * flow,
        size, projector[:, reference],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class NumericMode:
    """A mode in floats: x = ω², the bead with the largest displacement, and the coefficients."""

    square: float
    reference: int
    coefficients: Coefficients


def numeric_mode(rows: Sequence[Sequence[float]], kappa: float, branch: int) -> NumericMode:
    """The mode of a branch, counted from the lowest, for rows of masses, K2, K3 and K4.

    Raises `lwa.InputError` where the envelope's equation fails: where branches touch, at zero
    frequency, and at the resonances with the second harmonic and with sound.
    """
    springs = Springs(*np.array(rows, float))
    z, root = complex(np.exp(1j * kappa)), np.sqrt(springs.masses)
    squares, vectors = np.linalg.eigh(springs.stiffness(z) / np.outer(root, root))
    x, close = float(squares[branch]), CLOSE * springs.K2.max() / springs.masses.min()
    if np.min(np.abs(np.delete(squares, branch) - x), initial=np.inf) < close:
        raise InputError("two branches touch at this wavenumber: an envelope has one mode")
    if x < close / 1000:
        raise InputError("the frequency is zero at this wavenumber: sound has no envelope")
    sound = 1 / ((1 / springs.K2).sum() * springs.masses.sum())
    if sound - (np.sin(kappa) / springs.trace(x)[1]) ** 2 / x < CLOSE * sound:
        raise InputError(
            "the mode's group velocity is the speed of sound, c_g = c_0: the mean flow is in "
            "resonance with so long waves"
        )
    doubled = np.linalg.eigvalsh(springs.stiffness(z * z) / np.outer(root, root))
    if np.min(np.abs(doubled - 4 * x)) < close:
        raise InputError("the second harmonic is a mode too: the envelope's equation fails")
    phi = vectors[:, branch] / root
    reference = int(np.argmax(np.abs(phi)))
    found = coefficients(springs, z, x, np.outer(phi, phi.conj()), reference, np.linalg.inv)
    real = {part.name: np.real(getattr(found, part.name)) for part in fields(found)}
    real |= {"second": found.second, "mode": found.mode}
    return NumericMode(x, reference, Coefficients(**real))
