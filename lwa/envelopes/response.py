"""Weakly nonlinear response of a Bloch mode, in floats or in exact numbers.

Units: the first bead's mass, the first contact's static compression δ0 and linear stiffness. Bead i
has the mass m_i, contact i the static compression c_i. A further compression δ adds the force
``K2 δ + K3 δ² + K4 δ³``::

    K2 = 1/c_i,    K3 = s/c_i²,    K4 = t/c_i³,    s = δ0 F″/(2F′),    t = δ0² F‴/(6F′) at δ0.

Vectors have one component per bead (displacements u, amplitudes φ) or per contact (c, d, e2, e0).
The matrix B(κ) takes displacements to compressions, ``δ_i = u_i - u_{i+1}``; B† is its adjoint,
``K(κ) = B(κ)† K2 B(κ)`` the stiffness matrix, ``M = diag(m_i)`` the mass matrix. The mode of
frequency ω and wavenumber κ per cell, ``u = A φ e^{i(κn - ωt)} + c.c.`` with ``Σ m_i |φ_i|² = 1``,
compresses the contacts by ``d = B(κ)φ`` and at second order drives (Remoissenet, *Waves Called
Solitons*, 1999)::

    the second harmonic   A² e2,    e2 = -G K3 d²,   G = B(2κ) [K(2κ) - 4ω²M]^{-1} B(2κ)†,
    a lasting strain    |Ψ|² e0,    K2 e0 + 2 K3 |d|² = f, the same in all contacts.

The lasting force f accelerates the cells, and their mean strain ``Σ e0`` travels at the group
velocity c_g, hence ``f = c_g² Σm Σe0``. With ``v = c_g/c_0``, ``c_0² = 1/(Σm Σc)`` the squared
speed of sound, this gives ``f = 2 Σ c K3|d|²/Σ c · v²/(v² - 1)``, zero at a band's edge, where the
load is held. At third order the frequency rises by ``χ|Ψ|²``, with the sum of all contacts i::

    2ω χ = Σ_i [3 K4_i |d_i|⁴ + 2 K3_i (d̄_i² e2_i + |d_i|² e0_i)].

The frequencies are the roots ``x = ω²`` of ``T(x) = 2 cos κ``, where
``det(K(κ) - xM) Π c_i = T(x) - 2 cos κ``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.exact import InputError

Matrix = NDArray[Any]

# Relative difference of squared frequencies that counts as none
_CLOSE = 1e-11
# Force on a mode, over the largest on a contact, that counts as none
_ROUNDING = 1e-7
# 1 - (c_g/c_0)² from which on floats give the mean flow to six digits (_CLOSE/_SLOWER)
_SLOWER = 1e-5

TOUCHING = "two branches touch at this wavenumber: an envelope has one mode"
SOUND = (
    "the frequency is zero at this wavenumber: sound, c_g = c_0, has no envelope; its mean flow "
    "runs along with it"
)
DRIVEN = (
    "the second harmonic is a mode too, or too near one: the envelope's equation fails"
)
"""Reasons why a mode has no envelope."""


@dataclass(frozen=True, eq=False)
class Mode:
    """A mode and its nonlinear response; letters as in the module.

    Parameters
    ----------
    square : number
        The squared frequency x.
    slope, curvature : number
        ``dω²/dκ``, and ``ω d²ω/dκ²``.
    cubic : number
        ``2ωχ``.
    mean, size : array
        e0 and ``|d|²`` of each contact.
    shape : array
        φ of each bead, positive for the bead with the largest displacement.
    """

    square: Any
    slope: Any
    curvature: Any
    cubic: Any
    mean: Any
    size: Any
    shape: Any


@dataclass(frozen=True, eq=False)
class Contacts:
    """A cell under load: masses m_i, static compressions c_i, contact nonlinearities s and t."""

    masses: Matrix
    c: Matrix
    s: Any
    t: Any

    def floats(self) -> Contacts:
        """The same cell in floats."""
        return Contacts(
            masses=self.masses.astype(float),
            c=self.c.astype(float),
            s=float(self.s),
            t=float(self.t),
        )

    @property
    def _close(self) -> float:
        """Difference of squared frequencies that counts as none."""
        return _CLOSE / float(self.c.min() * self.masses.min())

    def _strains(self, z: complex) -> Matrix:
        """The matrix B(κ) in floats, shape (contacts, beads), ``z = e^{iκ}``."""
        identity = np.eye(len(self.masses))
        after = np.roll(identity, 1, axis=1)
        return np.asarray(identity - np.vstack([after[:-1], z * after[-1:]]))

    def _modes(self, z: complex) -> tuple[Matrix, Matrix]:
        """Squared frequencies, and the modes φ as columns."""
        B = self._strains(z)
        roots = np.sqrt(self.masses)
        K = B.conj().T @ (B / self.c[:, None])
        squares, vectors = np.linalg.eigh(K / np.outer(roots, roots))
        return squares, vectors / roots[:, None]

    def mode(self, kappa: float, branch: int) -> Mode:
        """The mode of a branch at a wavenumber, in floats."""
        z = complex(np.exp(1j * kappa))
        if abs(z.imag) < _CLOSE:
            z = round(z.real)  # the edges of bands have real modes
        squares, modes = self._modes(z)
        x = float(squares[branch])
        gaps = np.delete(squares, branch) - x
        if np.any(np.abs(gaps) < self._close):
            raise InputError(TOUCHING)
        if kappa == 0 and branch == 0:
            raise InputError(SOUND)
        # T(x) - 2 cos κ = Π m Π c Π_j (x_j - x) over the modes j, differentiated at a root
        first = -np.prod(self.masses * self.c * np.append(gaps, 1))
        second = -2 * first * (1 / gaps).sum()
        slope = -2 * z.imag / first  # x′, as T′ x′ = -2 sin κ
        bend = (-2 * z.real - second * slope**2) / first  # T″ x′² + T′ x″ = -2 cos κ
        speed = self.masses.sum() * self.c.sum() * slope**2 / (4 * x)  # (c_g/c_0)²
        if x < self._close or 1 - speed < _SLOWER:
            exact = "; exact results stand" if len(self.masses) == 1 else ""
            raise InputError(
                "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: "
                f"its mean flow runs along with it{exact}"
            )
        phi = modes[:, branch]
        d = self._strains(z) @ phi
        size = np.abs(d) ** 2
        K3 = self.s / self.c**2
        K4 = self.t / self.c**3
        driven = (self.c * K3 * size).sum() / self.c.sum()
        force = 2 * driven * speed / (speed - 1)
        mean = self.c * (force - 2 * K3 * size)
        harmonic = np.real(d.conj() ** 2 * self._harmonic(z * z, 4 * x, K3 * d * d))
        bead = np.argmax(np.abs(phi))
        return Mode(
            square=x,
            slope=slope,
            curvature=bend / 2 - slope**2 / (4 * x),
            cubic=(3 * K4 * size**2 + 2 * K3 * (harmonic + size * mean)).sum(),
            mean=mean,
            size=size,
            shape=phi * abs(phi[bead]) / phi[bead],
        )

    def _harmonic(self, z: complex, square: float, pressed: Matrix) -> Matrix:
        """Compressions e2 under the forces ``K3 d²`` in the contacts; z is ``e^{2iκ}``."""
        squares, modes = self._modes(z)
        bent = self._strains(z) @ modes
        forces = bent.conj().T @ pressed
        gaps = squares - square
        # A mode of the frequency 2ω that no force drives is left out.
        near = np.abs(gaps) < self._close
        driven = np.abs(forces) > _ROUNDING * np.abs(pressed).max()
        if np.any(near & driven):
            raise InputError(DRIVEN)
        amplitudes = np.where(near, 0, forces / np.where(near, 1, gaps))
        return np.asarray(-bent @ amplitudes)
