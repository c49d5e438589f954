"""Bloch modes of a loaded cell and their weakly nonlinear response, in floats or in closed form.

Bead i has the mass m_i. A compression δ of a contact beyond the static one adds the force
``K2 δ + K3 δ² + K4 δ³``, with ``K2 = F′``, ``K3 = F″/2`` and ``K4 = F‴/6``. Vectors
have one component per bead (displacements u, amplitudes φ) or per contact (K2, d, e2, e0).
The matrix B(κ) takes displacements to compressions, ``δ_i = u_i - u_{i+1}``; B† is its adjoint,
``K(κ) = B(κ)† K2 B(κ)`` the stiffness matrix, ``M = diag(m_i)`` the mass matrix. The mode of
frequency ω and wavenumber κ per cell, ``u = A φ e^{i(κn - ωt)} + c.c.`` with ``Σ m_i |φ_i|² = 1``,
compresses the contacts by ``d = B(κ)φ`` and at second order drives (Remoissenet, *Waves Called
Solitons*, 1999)::

    the second harmonic   A² e2,    e2 = -G K3 d²,   G = B(2κ) [K(2κ) - 4ω²M]^{-1} B(2κ)†,
    a lasting strain    |Ψ|² e0,    K2 e0 + 2 K3 |d|² = f, the same in all contacts.

The lasting force f accelerates the cells, and their mean strain ``Σ e0`` travels at the group
velocity c_g, hence ``f = c_g² Σm Σe0``. With ``c = 1/K2``, ``v = c_g/c_0`` and the squared
speed of sound ``c_0² = 1/(Σm Σc)`` this gives
``f = 2 Σ c K3|d|²/Σ c · v²/(v² - 1)``, zero at a band's edge, where the load is held. At third
order the frequency rises by ``χ|Ψ|²``, with the sum of all contacts i::

    2ω χ = Σ_i [3 K4_i |d_i|⁴ + 2 K3_i (d̄_i² e2_i + |d_i|² e0_i)].

The frequencies are the roots ``x = ω²`` of ``T(x) = 2 cos κ``, where
``det(K(κ) - xM) Π c_i = T(x) - 2 cos κ``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa.base.exact import InputError, demand_numbers
from lwa.cell import Cell, Parametric
from lwa.law import ContactLaw
from lwa.linear.springs import compressions

Matrix = NDArray[Any]

# Difference of squared frequencies, over the largest K2 by the least mass, that counts as none;
# rounding leaves up to 4e-15 of it (random cells of 2 to 100 beads, against singular values)
_CLOSE = 1e-11
# Force on a mode, over the largest on a contact, that counts as none; rounding leaves 2e-16 where
# no force drives the second harmonic (two unlike beads at κ = π)
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
    """Masses m_i of a cell, and K2, K3 and K4 of its contacts under load."""

    masses: Matrix
    K2: Matrix
    K3: Matrix
    K4: Matrix

    @property
    def _close(self) -> float:
        """Difference of squared frequencies that counts as none."""
        return _CLOSE * float(self.K2.max() / self.masses.min())

    def _strains(self, z: complex) -> Matrix:
        """The matrix B(κ) in floats, shape (contacts, beads), ``z = e^{iκ}``."""
        return compressions(np.array(z), len(self.masses))

    def _modes(self, z: complex) -> tuple[Matrix, Matrix]:
        """Squared frequencies, and the modes φ as columns."""
        B = self._strains(z)
        roots = np.sqrt(self.masses)
        K = B.conj().T @ (B * self.K2[:, None])
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
        c = 1 / self.K2
        # Derivatives of x by κ follow from those of T by x.
        # T(x) - 2 cos κ = Π m Π c Π_j (x_j - x) over the modes j, differentiated at a root: the
        # root's own factor leaves a 1.
        T1 = -np.prod(self.masses * c * np.append(gaps, 1))
        T2 = -2 * T1 * (1 / gaps).sum()
        slope = -2 * z.imag / T1  # x′, as T′ x′ = -2 sin κ
        bend = (-2 * z.real - T2 * slope**2) / T1  # T″ x′² + T′ x″ = -2 cos κ
        # v² = (c_g/c_0)², with c_g² = x′²/(4x) and 1/c_0² = Σm Σc
        v2 = self.masses.sum() * c.sum() * slope**2 / (4 * x)
        if x < self._close or 1 - v2 < _SLOWER:
            raise InputError(
                "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: "
                "its mean flow runs along with it"
            )
        # From here on letters are those of the module.
        phi = modes[:, branch]
        d = self._strains(z) @ phi
        size = np.abs(d) ** 2
        K3 = self.K3
        # The mean of K3 |d|², weighted by c, and the lasting force f
        driven = (c * K3 * size).sum() / c.sum()
        force = 2 * driven * v2 / (v2 - 1)
        mean = c * (force - 2 * K3 * size)
        e2 = self._harmonic(z * z, 4 * x, K3 * d**2)
        harmonic = np.real(d.conj() ** 2 * e2)
        cubic = 3 * self.K4 * size**2
        cubic += 2 * K3 * (harmonic + size * mean)
        bead = np.argmax(np.abs(phi))  # the one whose φ becomes positive
        return Mode(
            square=x,
            slope=slope,
            # ω ω″ = x″/2 - x′²/(4x), from x = ω²
            curvature=bend / 2 - slope**2 / (4 * x),
            cubic=cubic.sum(),
            mean=mean,
            size=size,
            shape=phi * abs(phi[bead]) / phi[bead],
        )

    def _harmonic(self, z: complex, square: float, pressed: Matrix) -> Matrix:
        """Compressions e2 under the forces ``K3 d²`` in the contacts; z is ``e^{2iκ}``.

        With the modes ``φ_j`` at 2κ, their compressions ``b_j = B(2κ) φ_j`` and squared frequencies
        ``x_j`` it is ``e2 = -Σ_j b_j (b_j† K3 d²)/(x_j - 4ω²)``.
        """
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
        return -bent @ amplitudes


# --- in closed form ---


def equal_beads(contacts: Contacts, wavenumber: sp.Expr) -> Mode:
    """The mode of a cell of one bead in closed form.

    With S and C for ``sin κ/2`` and ``cos κ/2``: ``ω² = 4S² K2/m``, ``|d|² = 4S²/m`` and
    ``c_g = C √(K2/m)``, hence ``K2 e0 = -2 K3 |d|²/(1 - C²)``. The second harmonic has
    ``K2 G = 4 sin²κ/(4 sin²κ - 16 S²) = -C²/S²``.
    """
    m = contacts.masses[0]
    K2 = contacts.K2[0]
    K3 = contacts.K3[0]
    K4 = contacts.K4[0]
    S = sp.sin(wavenumber / 2)
    C = sp.cos(wavenumber / 2)
    size = 4 * S**2 / m  # |d|²
    mean = -8 * K3 / (K2 * m)  # e0
    harmonic = K3 * size / K2 * C**2 / S**2  # |e2|
    return Mode(
        square=K2 * size,  # ω²
        slope=4 * S * C * K2 / m,  # dω²/dκ
        curvature=-(S**2) * K2 / m,  # ω d²ω/dκ²
        # 2ωχ
        cubic=3 * K4 * size**2 + 2 * K3 * size * (harmonic + mean),
        mean=[mean],
        size=[size],
        shape=[1 / sp.sqrt(m)],
    )


def lone_bead(contacts: Contacts, branch: int) -> Mode:
    """The mode of two unlike beads between equal contacts at ``κ = π``, in closed form.

    Every second bead, of the mass m, swings alone: on the optical branch the light one, on the
    acoustic one the heavy one. Both its contacts are always compressed by opposite amounts, so that
    no force drives the second harmonic, and ``c_g = 0`` leaves no lasting force, ``f = 0``. With M
    for the mass of the beads at rest the relation of the branches::

        m M x² - 2 K2 (m + M) x + 2 K2² (1 - cos κ) = 0

    at ``x = 2 K2/m``, differentiated twice by κ, gives the curvature ``ω ω″ = K2/(2 (M - m))``.

    Parameters
    ----------
    contacts : Contacts
        The cell under load. Of symbols the first mass is taken to be the heavier one.
    branch : int
        0 for the acoustic branch, 1 for the optical one.

    Raises
    ------
    InputError
        For equal masses, where the branches touch.
    """
    m1, m2 = contacts.masses
    if m1 == m2:
        raise InputError(TOUCHING)
    light = 0 if (m1 - m2).is_negative else 1
    bead = light if branch == 1 else 1 - light
    m = contacts.masses[bead]
    at_rest = contacts.masses[1 - bead]
    K2 = contacts.K2[0]
    K3 = contacts.K3[0]
    K4 = contacts.K4[0]
    size = 1 / m  # |d|² of both contacts, as m |φ|² = 1
    mean = -2 * K3 * size / K2  # e0
    # a contact's part of 2ω χ, with e2 = 0
    of_contact = 3 * K4 * size**2 + 2 * K3 * size * mean
    phi = [sp.S.Zero] * 2
    phi[bead] = 1 / sp.sqrt(m)
    return Mode(
        square=2 * K2 / m,
        slope=sp.S.Zero,
        curvature=K2 / (2 * (at_rest - m)),
        cubic=2 * of_contact,
        mean=[mean, mean],
        size=[size, size],
        shape=phi,
    )


# --- of a cell ---


K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force ``K2 δ + K3 δ² + K4 δ³`` on top of the load, under `lwa.general`."""


@dataclass(frozen=True, repr=False)
class LoadedMode(Parametric):
    """A mode of a loaded chain, exact or in floats.

    Parameters
    ----------
    cell : Cell
        The chain.
    law : ContactLaw
        The law of its contacts.
    compression : Expr
        Mean static compression of the contacts.
    wavenumber : Expr
        κ per cell.
    branch : int
        Number of the branch, from 0, the acoustic one.
    floats : bool
        True for results in floats.
    """

    cell: Cell
    law: ContactLaw
    compression: sp.Expr
    wavenumber: sp.Expr
    branch: int
    floats: bool = False

    @property
    def static_compressions(self) -> tuple[sp.Expr, ...]:
        """Static compression of each contact."""
        # Contacts that differ have a power law; the shares of equal ones are 1 for every exponent.
        return tuple(c * self.compression for c in self.cell.shares(self.law.exponent))

    @cached_property
    def _mode(self) -> Mode:
        """The Bloch mode and its nonlinear response, in the units of the cell.

        Raises
        ------
        InputError
            Where branches touch, for sound, and where the mode drives a mode of twice its
            frequency.
        """
        # The force on top of the load is F′ (δ + s δ²/δ0 + t δ³/δ0²). The units are F′ of the first
        # contact, and its static compression δ0 where there is one: a spacing D cancels in s and t.
        law = self.law
        static = self.static_compressions[0]
        unit = sp.S.One if static.is_zero or law.formless else static
        if law.formless:
            slope = K2
            s = K3 / K2
            t = K4 / K2
        else:
            slope = law.at(static, 1)
            s = law.at(static, 2) * unit / slope / 2
            t = law.at(static, 3) * unit**2 / slope / 6
        # Unlike contacts have a power law, under which δ0, K2, K3 and K4 are powers of c.
        compliances = np.array(self.cell.compliances(law.exponent))
        c = compliances / compliances[0]
        masses = np.array(self.cell.masses)
        contacts = Contacts(masses, K2=1 / c, K3=s / c**2, K4=t / c**3)
        mode = self._scaled(contacts)
        # The spring constant A F′ of the first contact, in the units of the cell
        rate = sp.powsimp(self.cell.stiffnesses[0] * slope)
        return replace(
            mode,
            square=mode.square * rate,
            slope=mode.slope * rate,
            curvature=mode.curvature * rate,
            cubic=mode.cubic * rate / unit**2,
            mean=[strain / unit for strain in mode.mean],
        )

    def _scaled(self, contacts: Contacts) -> Mode:
        """The mode and its response in the units of these contacts, in floats or closed form."""
        if self.floats:
            rows = (contacts.masses, contacts.K2, contacts.K3, contacts.K4)
            for value in (*np.concatenate(rows), self.wavenumber):
                demand_numbers(value.free_symbols, "floats need numbers")
            numbers = Contacts(*(row.astype(float) for row in rows))
            return numbers.mode(float(self.wavenumber), self.branch)
        # `lwa.envelope` leaves two exact cases: two unlike beads at κ = π, and one bead at any κ.
        if self.cell.size > 1:
            return lone_bead(contacts, self.branch)
        if self.wavenumber.is_zero:
            raise InputError(SOUND)
        return equal_beads(contacts, self.wavenumber)
