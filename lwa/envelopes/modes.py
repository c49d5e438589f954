"""Weakly nonlinear response of a Bloch mode, over any field of numbers.

Units: the first bead's mass, the first contact's static compression δ0 and linear stiffness. Bead i
has the mass m_i, contact i the static compression c_i. A further compression δ adds the force
K2 δ + K3 δ² + K4 δ³,

    K2 = 1/c_i,    K3 = s/c_i²,    K4 = t/c_i³,    s = δ0 F″/(2F′),    t = δ0² F‴/(6F′) at δ0.

Vectors have one component per bead (displacements u, amplitudes φ) or per contact (c, d, e2, e0).
The matrix B(κ) takes displacements to compressions, δ_i = u_i - u_{i+1}; B† is its adjoint,
K(κ) = B(κ)† K2 B(κ) the stiffness matrix, M = diag(m_i) the mass matrix. The mode of frequency ω
and wavenumber κ per cell, u = A φ e^{i(κn - ωt)} + c.c., Σ m_i |φ_i|² = 1, compresses the contacts
by d = B(κ)φ and at second order drives (Remoissenet, *Waves Called Solitons*, 1999)

    the second harmonic   A² e2,    e2 = -G K3 d²,   G = B(2κ) [K(2κ) - 4ω²M]^{-1} B(2κ)†,
    a lasting strain    |Ψ|² e0,    K2 e0 + 2 K3 |d|² = f, the same in all contacts.

The lasting force f accelerates the cells, and their mean strain Σ e0 travels at the group velocity
c_g, hence f = c_g² Σm Σe0. With v = c_g/c_0, c_0² = 1/(Σm Σc) the speed of sound, this gives
f = 2 Σ c K3|d|²/Σ c · v²/(v² - 1), zero at a band's edge, where the load is held. At third order
the frequency rises by χ|Ψ|², with the sum of all contacts i

    2ω χ = Σ_i [3 K4_i |d_i|⁴ + 2 K3_i (d̄_i² e2_i + |d_i|² e0_i)].

The results depend on the mode through φφ† and e^{±iκ} only, both of which are rational functions
of ω² and e^{iκ}: numbers may be floats, or elements of a field of rational functions.
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
    """A mode and its nonlinear response; letters as in the module.

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
    """Masses m_i, static compressions c_i, and the nonlinear coefficients s and t of a cell."""

    masses: Numbers
    c: Numbers
    s: Any
    t: Any

    def strains(self, z: Any) -> Matrix:
        """The matrix B(κ), shape (contacts, beads), z = e^{iκ}; B(κ)† is the transpose for 1/z."""
        one = np.diag(self.masses * 0 * z + 1)
        after = np.roll(one, 1, axis=1)
        after[-1] = after[-1] * z
        return np.asarray(one - after)

    def stiffness(self, z: Any) -> Matrix:
        """The stiffness matrix K(κ) = B(κ)† K2 B(κ), shape (beads, beads)."""
        return np.asarray(self.strains(1 / z).T @ (self.strains(z) / self.c[:, None]))

    def response(
        self, z: Any, x: Any, flow: Any, projector: Matrix, bead: int,
        inverse: Callable[[Matrix], Matrix],
    ) -> tuple[Any, Numbers, Numbers, Numbers]:  # fmt: skip
        """Return 2ωχ and, with one entry per contact, e2, e0 and |d|² of the mode with ω² = x.

        z : e^{iκ}. flow : v²/(v² - 1). projector : φφ†, shape (beads, beads).
        bead : index of a bead whose φ is positive. inverse : function that inverts a matrix.
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
    """Return the mode of a branch (0 the lowest) in floats, and the index of its largest φ_i.

    Raises `lwa.InputError` where the envelope's equation fails: where branches touch, at the
    resonance with the second harmonic, and for sound, of zero frequency; with ``resolved`` also
    where c_g is too close to the speed of sound for floats.
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
