"""Weakly nonlinear response of a Bloch mode, over any field of numbers.

In units of the cell's first bead and contact bead i has the mass m_i, and contact i, its static
compression c_i, pushes under a further compression δ with K2 δ + K3 δ² + K4 δ³ more,

    K2 = 1/c_i,    K3 = s/c_i²,    K4 = t/c_i³.

A mode u = A φ e^{i(κn - ωt)} + c.c., κ per cell, Σ m|φ|² = 1, strains the contacts by d = B(κ)φ,
where δ_i = u_i - u_{i+1}. At second order it drives (Remoissenet, *Waves Called Solitons*, 1999)

    the second harmonic   A² e2,    e2 = -G K3 d²,   G = B(2κ) [K(2κ) - 4ω²M]^{-1} B(2κ)†,
    a lasting strain    |A|² e0,    K2 e0 + 2 K3 |d|² = f, the same in all contacts.

f is the lasting force. It accelerates the cells, so that their mean strain Σ e0 moves with c_g:
f = M c_g² Σ e0, M = Σ m. With v = c_g/c_0, c_0² = 1/(M Σ c), this is f = 2 Σ c K3|d|²/Σ c ·
v²/(v² - 1), zero at a band's edge, where the load is held. At third order the frequency rises by
χ|A|²,

    2ω χ = Σ 3 K4 |d|⁴ + 2 K3 (d̄² e2 + |d|² e0).

Only φφ† and e^{±iκ} enter: numbers may be floats, or elements of a field of rational functions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.exact import InputError

CLOSE = 1e-11
"""Relative difference of squared frequencies that counts as none."""

SOUND = 1e-5
"""1 - (c_g/c_0)² from which on floats give the mean flow to six digits (1e-11/SOUND)."""

Numbers = NDArray[Any]
Matrix = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Mode:
    """A mode and its response.

    square : x = ω².
    slope, curvature : dω²/dκ, and ω d²ω/dκ².
    cubic : 2ωχ.
    second, mean, size : e2, e0 and |d|² of each contact.
    shape : φ of each bead, positive for the bead with the largest displacement.
    """

    square: Any
    slope: Any
    curvature: Any
    cubic: Any
    second: Any
    mean: Any
    size: Any
    shape: Any


@dataclass(frozen=True, eq=False)
class Contacts:
    """Masses m and static compressions c of a cell, and the s and t of its contacts."""

    masses: Numbers
    c: Numbers
    s: Any
    t: Any

    def strains(self, z: Any) -> Matrix:
        """B(κ) at z = e^{iκ}, (contacts, beads); B(κ)† is its transpose at 1/z."""
        one = np.diag(self.masses * 0 * z + 1)
        after = np.roll(one, 1, axis=1)
        after[-1] = after[-1] * z
        return np.asarray(one - after)

    def stiffness(self, z: Any) -> Matrix:
        """K(κ) = B(κ)† K2 B(κ)."""
        return np.asarray(self.strains(1 / z).T @ (self.strains(z) / self.c[:, None]))

    def response(
        self, z: Any, x: Any, flow: Any, projector: Matrix, bead: int,
        inverse: Callable[[Matrix], Matrix],
    ) -> tuple[Any, Numbers, Numbers, Numbers]:  # fmt: skip
        """2ωχ, e2, e0 and |d|² by contact, for φφ† (beads, beads) of the mode with ω² = x.

        flow : v²/(v² - 1). bead : index of the bead in phase with A. inverse : that of a matrix.
        """
        c = self.c  # arrays stand first: elements of a field do not know arrays
        K3, K4 = 1 / c**2 * self.s, 1 / c**3 * self.t
        B = self.strains(z)
        products = B @ projector @ self.strains(1 / z).T  # d d†
        size = np.diagonal(products)
        rest = self.stiffness(z * z) - np.diag(self.masses) * (4 * x)
        G = self.strains(z * z) @ inverse(rest) @ self.strains(1 / (z * z)).T
        d = (B @ projector)[:, bead]
        second = -G @ (K3 * d * d / projector[bead, bead])
        force = (c * K3 * size).sum() * 2 / c.sum() * flow
        mean = c * (-2 * K3 * size + force)
        cubic = (3 * K4 * size**2 + 2 * K3 * size * mean).sum()
        return cubic - 2 * K3 @ (G * products.T**2) @ K3, second, mean, size


def numeric_mode(contacts: Contacts, kappa: float, branch: int, resolved: bool) -> tuple[Mode, int]:
    """The mode of a branch, counted from the lowest, in floats, and its bead that moves most.

    Raises `lwa.InputError` where the envelope's equation fails: where branches touch, at the
    resonance with the second harmonic, and for sound, of zero frequency; ``resolved``, also where
    the mode is too close to sound for floats.
    """
    z, root = complex(np.exp(1j * kappa)), np.sqrt(contacts.masses)
    if abs(z.imag) < CLOSE:  # real modes at the edges
        z = round(z.real)
    squares, vectors = np.linalg.eigh(contacts.stiffness(z) / np.outer(root, root))
    x, others = float(squares[branch]), np.delete(squares, branch)
    close = CLOSE / (contacts.c.min() * contacts.masses.min())
    if np.min(np.abs(others - x), initial=np.inf) < close:
        raise InputError("two branches touch at this wavenumber: an envelope has one mode")
    if x < close / 1000:
        raise InputError(
            "the frequency is zero at this wavenumber: sound, c_g = c_0, has no envelope; its mean "
            "flow runs along with it"
        )
    # T(x) - 2 cos κ = det(K - xM) Π c = Π m Π c Π (x_j - x), of modes j; cf. `lwa.envelopes.exact`
    gaps = others - x
    first = -np.prod(contacts.masses * contacts.c * np.append(gaps, 1))  # T′
    slope = -2 * z.imag / first
    bend = -2 * z.real / first + 2 * slope**2 * (1 / gaps).sum()
    speed = contacts.masses.sum() * contacts.c.sum() * slope**2 / (4 * x)  # (c_g/c_0)²
    if resolved and 1 - speed < SOUND:
        raise InputError(
            "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: its "
            "mean flow runs along with it; exact results stand"
        )
    doubled = np.linalg.eigvalsh(contacts.stiffness(z * z) / np.outer(root, root))
    if np.min(np.abs(doubled - 4 * x)) < close / 100:  # long waves come close, as κ⁴
        raise InputError("the second harmonic is a mode too: the envelope's equation fails")
    phi = vectors[:, branch] / root
    bead = int(np.argmax(np.abs(phi)))
    phi = phi * (phi[bead].conj() / abs(phi[bead]))
    cubic, second, mean, size = contacts.response(
        z, x, speed / (speed - 1), np.outer(phi, phi.conj()), bead, np.linalg.inv
    )
    curvature = bend / 2 - slope**2 / (4 * x)
    return Mode(x, slope, curvature, cubic.real, second, mean.real, size.real, phi), bead
