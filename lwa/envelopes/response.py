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

The lasting force f accelerates the cells, and their mean strain Σ e0 travels at the group velocity
c_g, hence ``f = c_g² Σm Σe0``. With ``v = c_g/c_0``, ``c_0² = 1/(Σm Σc)`` the squared speed of
sound, this gives ``f = 2 Σ c K3|d|²/Σ c · v²/(v² - 1)``, zero at a band's edge, where the load is
held. At third order the frequency rises by ``χ|Ψ|²``, with the sum of all contacts i::

    2ω χ = Σ_i [3 K4_i |d_i|⁴ + 2 K3_i (d̄_i² e2_i + |d_i|² e0_i)].

The frequencies are the roots ``x = ω²`` of ``T(x) = 2 cos κ``, where
``det(K(κ) - xM) Π c_i = T(x) - 2 cos κ``, and φφ† is the adjugate of ``K(κ) - xM`` over its trace
with M. So all results are rational functions of x and ``z = e^{iκ}``, which one formula evaluates
in floats and, where z is 1 or -1, in symbols.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[Any]

CLOSE = 1e-11
"""Relative difference of squared frequencies that counts as none."""


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

    @property
    def units(self) -> Matrix:
        """Matrix √(m_i m_j), by which K divided is the matrix of the squared frequencies."""
        return np.asarray(np.sqrt(np.outer(self.masses, self.masses)))

    @property
    def close(self) -> float:
        """Difference of squared frequencies that counts as none in floats."""
        return CLOSE / float(self.c.min() * self.masses.min())

    def strains(self, z: Any) -> Matrix:
        """The matrix B(κ), shape (contacts, beads), z = e^{iκ}; B(κ)† is the transpose for 1/z."""
        identity = np.diag(self.masses * 0 + 1)
        after = np.roll(identity, 1, axis=1)
        after = np.vstack([after[:-1], after[-1:] * z])
        return np.asarray(identity - after)

    def secular(self, z: Any, x: Any) -> Matrix:
        """The matrix K(κ) - xM, shape (beads, beads), z = e^{iκ}."""
        K = self.strains(1 / z).T @ (self.strains(z) / self.c[:, None])
        return np.asarray(K - np.diag(self.masses) * x)

    def mode(
        self,
        z: Any,
        sine: Any,
        x: Any,
        slopes: tuple[Any, Any],
        projector: Matrix,
        resolvent: Matrix,
    ) -> Mode:
        """Response of the mode with the squared frequency x.

        The shape of the mode is left as the matrix φφ†.

        Parameters
        ----------
        z, sine : number
            e^{iκ}, and sin κ.
        x : number
            The squared frequency.
        slopes : tuple of two numbers
            T′ and T″ at x.
        projector : array, shape (beads, beads)
            The matrix φφ†.
        resolvent : array, shape (beads, beads)
            The inverse of K(2κ) - 4xM.
        """
        first, second = slopes
        slope = -2 * sine / first  # x′, as T′ x′ = -2 sin κ
        square = slope**2
        # x″, as T″ x′² + T′ x″ = -2 cos κ
        bend = (-(z + 1 / z) - second * square) / first
        speed = self.masses.sum() * self.c.sum() * square / (4 * x)  # (c_g/c_0)²
        K3 = self.s / self.c**2
        K4 = self.t / self.c**3
        products = self.strains(z) @ projector @ self.strains(1 / z).T  # d d†
        size = np.diagonal(products)
        G = self.strains(z * z) @ resolvent @ self.strains(1 / (z * z)).T
        driven = (self.c * K3 * size).sum() / self.c.sum()
        force = 2 * driven * speed / (speed - 1)
        mean = self.c * (force - 2 * K3 * size)
        cubic = (3 * K4 * size**2 + 2 * K3 * size * mean).sum()
        cubic -= 2 * K3 @ (G * products.T**2) @ K3
        return Mode(
            square=x,
            slope=slope,
            curvature=bend / 2 - square / (4 * x),
            cubic=cubic,
            mean=mean,
            size=size,
            shape=projector,
        )
