"""Bloch modes of a loaded cell and their weakly nonlinear response, in floats or in closed form.

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

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa.base.exact import InputError, demand_numbers
from lwa.cell import Cell
from lwa.law import ContactLaw

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


K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force ``K2 δ + K3 δ² + K4 δ³`` on top of the load, under `lwa.general`."""


class LoadedLaw(NamedTuple):
    """A contact law about a static compression: the force ``F′ (δ + s δ²/δ0 + t δ³/δ0²)`` on top.

    Parameters
    ----------
    slope : Expr
        ``F′``.
    s, t : Expr
        The nonlinearities.
    length : Expr
        The unit δ0 of the compression: the static one, or 1 without load and under `lwa.general`.
    """

    slope: sp.Expr
    s: sp.Expr
    t: sp.Expr
    length: sp.Expr

    @classmethod
    def of(cls, law: ContactLaw, delta: sp.Expr) -> LoadedLaw:
        """Return a law about a compression."""
        if law.formless:
            return cls(K2, K3 / K2, K4 / K2, sp.S.One)
        slope = law.at(delta, 1)
        if delta.is_zero:
            s = law.at(delta, 2) / slope / 2
            t = law.at(delta, 3) / slope / 6
            return cls(slope, s, t, sp.S.One)
        s = law.phi(2).subs(law.delta, delta) / 2
        t = law.phi(3).subs(law.delta, delta) / 6
        return cls(slope, s, t, delta)


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


# --- in closed form ---


def equal_beads(s: sp.Expr, t: sp.Expr, wavenumber: sp.Expr) -> Mode:
    """The mode of a cell of one bead in closed form, in the units of this module.

    With S and C for ``sin κ/2`` and ``cos κ/2``: ``ω = |d| = 2S`` and ``c_g = C``, hence
    ``e0 = -2s |d|²/(1 - C²) = -8s``. The second harmonic has
    ``G = 4 sin²κ/(4 sin²κ - 16 S²) = -C²/S²`` and ``e2 = s d² C²/S²``.
    """
    S = sp.sin(wavenumber / 2)
    C = sp.cos(wavenumber / 2)
    return Mode(
        square=4 * S**2,
        slope=4 * S * C,
        curvature=-(S**2),
        cubic=48 * t * S**4 - 32 * s**2 * S**2 * (1 + S**2),
        mean=[-8 * s],
        size=[4 * S**2],
        shape=[sp.S.One],
    )


def pair_at_edge(contacts: Contacts, edge: sp.Integer, branch: int) -> Mode:
    """The mode of two beads at the edge of a band in closed form.

    At ``κ = 0`` the beads swing against each other. At ``κ = π`` one of two unlike beads between
    equal contacts swings alone, and one of two unlike contacts between equal beads works alone.

    The second harmonic has the wavenumber 0. It shifts the first bead by y against the second, and
    so compresses the contacts by y and -y::

        (K2_1 + K2_2 - 4x μ) y = K3_2 d_2² - K3_1 d_1²,    μ = m_1 m_2/(m_1 + m_2).

    Parameters
    ----------
    contacts : Contacts
        The cell under load; at ``κ = π`` masses or contacts are alike. Of symbols the first mass is
        taken to be the heavier one, and the first contact the stiffer one.
    edge : {1, -1}
        ``cos κ``.
    branch : int
        0 for the acoustic branch, 1 for the optical one.

    Raises
    ------
    InputError
        Where the branches touch, and where the second harmonic is a mode that the mode drives.
    """
    m1, m2 = contacts.masses
    c1, c2 = contacts.c
    total = m1 + m2
    reduced = m1 * m2 / total
    stiffness = 1 / c1 + 1 / c2
    light = 0 if (m1 - m2).is_negative else 1
    if edge == 1:
        x = stiffness / reduced
        phi = np.array([m2, -m1]) / sp.sqrt(m1 * m2 * total)
        if light == 1:
            phi = -phi
    elif m1 != m2:
        bead = light if branch == 1 else 1 - light
        mass = contacts.masses[bead]
        x = 2 / (c1 * mass)
        phi = np.array([sp.S.Zero, sp.S.Zero])
        phi[bead] = 1 / sp.sqrt(mass)
    elif c1 != c2:
        stiff = 1 if (c1 - c2).is_positive else 0
        contact = stiff if branch == 1 else 1 - stiff
        x = 2 / (contacts.c[contact] * m1)
        # The beads on both sides of the contact move against each other.
        phi = np.array([1, -1 if contact == 0 else 1]) / sp.sqrt(2 * m1)
    else:
        raise InputError(TOUCHING)
    size = np.array([phi[0] - phi[1], phi[1] - edge * phi[0]]) ** 2
    K3 = contacts.s / contacts.c**2
    K4 = contacts.t / contacts.c**3
    drive = K3[1] * size[1] - K3[0] * size[0]
    y = sp.S.Zero
    if drive != 0:
        rate = stiffness - 4 * x * reduced
        if rate.is_zero:
            raise InputError(DRIVEN)
        y = drive / rate
    # c_g is 0 at the edge, and so is the lasting force.
    mean = -2 * contacts.c * K3 * size
    return Mode(
        square=x,
        slope=sp.S.Zero,
        # m_1 m_2 x² - (K2_1 + K2_2)(m_1 + m_2) x + 2 K2_1 K2_2 (1 - cos κ) = 0 twice by κ
        curvature=edge / (c1 * c2 * (stiffness * total - 2 * m1 * m2 * x)),
        cubic=(3 * K4 * size**2 + 2 * K3 * size * mean).sum() - 2 * drive * y,
        mean=mean,
        size=size,
        shape=phi,
    )


# --- in the units of the cell ---


def cell_mode(
    cell: Cell,
    law: ContactLaw,
    compression: sp.Expr,
    wavenumber: sp.Expr,
    branch: int,
    floats: bool,
) -> Mode:
    """Return the mode of a branch of a loaded cell, in the units of the cell.

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
        Number of the branch, from 0.
    floats : bool
        True for floats, False for exact numbers.

    Raises
    ------
    InputError
        Where branches touch, for sound, and where the mode drives a mode of twice its frequency.
    """
    loaded = LoadedLaw.of(law, compression * cell.shares(law.exponent)[0])
    compliances = cell.compliances(law.exponent)
    mass = cell.masses[0]
    contacts = Contacts(
        masses=np.array([m / mass for m in cell.masses]),
        c=np.array([sp.powsimp(part / compliances[0]) for part in compliances]),
        s=loaded.s,
        t=loaded.t,
    )
    if floats:
        numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t, wavenumber)
        free = set().union(*(x.free_symbols for x in numbers))
        demand_numbers(free, "floats need numbers")
        mode = contacts.floats().mode(float(wavenumber), branch)
    elif wavenumber.is_zero and branch == 0:
        raise InputError(SOUND)
    elif cell.size == 1:
        mode = equal_beads(contacts.s, contacts.t, wavenumber)
    else:
        mode = pair_at_edge(contacts, sp.cos(wavenumber), branch)
    rate = sp.powsimp(cell.stiffnesses[0] * loaded.slope / mass)  # unit of ω²
    length = loaded.length
    return Mode(
        square=sp.sympify(mode.square) * rate,
        slope=mode.slope * rate,
        curvature=mode.curvature * rate,
        cubic=mode.cubic * rate / (mass * length**2),
        mean=_scaled(mode.mean, 1 / (mass * length)),
        size=_scaled(mode.size, 1 / mass),
        shape=_scaled(mode.shape, 1 / sp.sqrt(mass)),
    )


def _scaled(values: Iterable[Any], unit: sp.Expr) -> list[sp.Expr]:
    """Values in a unit."""
    return [sp.sympify(value) * unit for value in values]
