"""Bloch modes of a loaded cell, in floats or in exact numbers, in the units of the cell."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa.base.exact import InputError, demand_numbers
from lwa.cell import Cell
from lwa.envelopes.response import CLOSE, Contacts, Matrix, Mode
from lwa.law import ContactLaw

# A force on a mode, relative to the largest, that counts as none
ROUNDING = 1e-7
# 1 - (c_g/c_0)² from which on floats give the mean flow to six digits (1e-11/SOUND)
SOUND = 1e-5

K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force ``K2 δ + K3 δ² + K4 δ³`` on top of the load, under `lwa.general`."""


class LoadedLaw(NamedTuple):
    """A contact law about a static compression: the force F′ (δ + s δ²/δ0 + t δ³/δ0²) on top.

    Parameters
    ----------
    slope : Expr
        F′.
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


def cell_mode(
    cell: Cell,
    law: ContactLaw,
    compression: sp.Expr,
    wavenumber: sp.Expr,
    branch: int,
    floats: bool,
) -> Mode:
    """Return the mode of a branch of a loaded cell.

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
    """
    loaded = LoadedLaw.of(law, compression * cell.shares(law.exponent)[0])
    compliances = cell.compliances(law.exponent)
    mass = cell.masses[0]
    exact = Contacts(
        masses=np.array([m / mass for m in cell.masses]),
        c=np.array([sp.powsimp(part / compliances[0]) for part in compliances]),
        s=loaded.s,
        t=loaded.t,
    )
    if floats:
        numbers = (*exact.masses, *exact.c, exact.s, exact.t, wavenumber)
        free = set().union(*(x.free_symbols for x in numbers))
        demand_numbers(free, "floats need numbers")
    sample = _sample(cell, exact, wavenumber, branch)
    if floats:
        mode = sample.mode()
    elif cell.size == 1:
        mode = equal_beads(exact.s, exact.t, wavenumber)
    else:
        mode = edge_mode(cell, exact, sp.cos(wavenumber), branch, sample.bead)
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


def _sample(cell: Cell, exact: Contacts, wavenumber: sp.Expr, branch: int) -> Sampled:
    """The modes in floats, at sample values of symbols."""
    floats = Contacts(
        masses=np.array([_sampled(cell, m) for m in exact.masses]),
        c=np.array([_sampled(cell, c) for c in exact.c]),
        s=_sampled(cell, exact.s),
        t=_sampled(cell, exact.t),
    )
    return Sampled.of(floats, _sampled(cell, wavenumber), branch)


def _sampled(cell: Cell, value: sp.Expr) -> float:
    """Float of an expression at sample values of its symbols, to order the branches.

    Samples are π/3, π/6, … along the cell, so that the first mass is the heaviest and no sample is
    one of the numbers in the cell, and 1.5 for symbols of neither masses nor stiffnesses.
    """
    symbols = dict.fromkeys(value.free_symbols, 1.5)
    for values in (cell.stiffnesses, cell.masses):
        # A symbol that occurs twice has its first sample.
        for i, part in reversed([*enumerate(values)]):
            symbols |= dict.fromkeys(part.free_symbols, np.pi / (3 + 3 * i))
    return float(value.xreplace(symbols))


@dataclass(frozen=True, eq=False)
class Sampled:
    """Modes of a cell in floats.

    Parameters
    ----------
    contacts : Contacts
        The cell.
    z : complex or int
        e^{iκ}, real at the edges.
    squares, vectors : array
        Squared frequencies, and √m times the modes.
    branch : int
        Number of the branch.
    """

    contacts: Contacts
    z: complex | int
    squares: NDArray[Any]
    vectors: NDArray[Any]
    branch: int

    @classmethod
    def of(cls, contacts: Contacts, kappa: float, branch: int) -> Sampled:
        """Modes at a wavenumber; raises `lwa.InputError` where branches touch, and for sound."""
        z = complex(np.exp(1j * kappa))
        z = round(z.real) if abs(z.imag) < CLOSE else z
        squares, vectors = np.linalg.eigh(contacts.secular(z, 0) / contacts.units)
        found = cls(contacts, z, squares, vectors, branch)
        if np.min(np.abs(found.gaps), initial=np.inf) < contacts.close:
            raise InputError(
                "two branches touch at this wavenumber: an envelope has one mode"
            )
        if kappa == 0 == branch:
            raise InputError(
                "the frequency is zero at this wavenumber: sound, c_g = c_0, has no envelope; its "
                "mean flow runs along with it"
            )
        return found

    @property
    def gaps(self) -> NDArray[Any]:
        """Differences x_j - x of the squared frequencies of the other branches."""
        others = np.delete(self.squares, self.branch)
        return np.asarray(others - self.squares[self.branch])

    @property
    def shape(self) -> NDArray[Any]:
        """Mode φ of the branch."""
        return np.asarray(self.vectors[:, self.branch] / np.sqrt(self.contacts.masses))

    @property
    def bead(self) -> int:
        """Index of the bead with the largest displacement."""
        return int(np.argmax(np.abs(self.shape)))

    def mode(self) -> Mode:
        """The mode and its response; `lwa.InputError` where floats cannot resolve the response."""
        contacts = self.contacts
        z = self.z
        x = float(self.squares[self.branch])
        # T(x) - 2 cos κ = Π m Π c Π_j (x_j - x) over the modes j, differentiated at a root
        first = -np.prod(contacts.masses * contacts.c * np.append(self.gaps, 1))
        second = -2 * first * (1 / self.gaps).sum()
        sound = 1 / (contacts.masses.sum() * contacts.c.sum())  # c_0²
        if x < contacts.close or 1 - (z.imag / first) ** 2 / x / sound < SOUND:
            exact = "; exact results stand" if len(contacts.masses) == 1 else ""
            raise InputError(
                "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: "
                f"its mean flow runs along with it{exact}"
            )
        projector = np.outer(self.shape, self.shape.conj())
        found = contacts.mode(
            z, z.imag, x, (first, second), projector, self._resolvent(4 * x)
        )
        phase = abs(self.shape[self.bead]) / self.shape[self.bead]
        return Mode(
            square=x,
            slope=found.slope,
            curvature=np.real(found.curvature),
            cubic=np.real(found.cubic),
            mean=np.real(found.mean),
            size=np.real(found.size),
            shape=self.shape * phase,
        )

    def _resolvent(self, square: float) -> Matrix:
        """Inverse of K(2κ) - 4ω²M; a mode of the frequency 2ω that is not driven is left out."""
        contacts = self.contacts
        z = self.z
        squares, vectors = np.linalg.eigh(contacts.secular(z * z, 0) / contacts.units)
        vectors = vectors / np.sqrt(contacts.masses)[:, None]
        d = contacts.strains(z) @ self.shape
        drive = contacts.strains(1 / (z * z)).T @ (d * d / contacts.c**2)
        near = np.abs(squares - square) < contacts.close
        driven = np.abs(vectors.conj().T @ drive) > ROUNDING * np.abs(drive).max()
        if np.any(near & driven):
            raise InputError(
                "the second harmonic is a mode too, or too near one for floats: the envelope's "
                "equation fails"
            )
        rates = np.where(near, 0, 1 / np.where(near, 1, squares - square))
        return np.asarray((vectors * rates) @ vectors.conj().T)


# --- exact ---


def equal_beads(s: sp.Expr, t: sp.Expr, wavenumber: sp.Expr) -> Mode:
    """The mode of a cell of one bead in closed form, in the units of `lwa.envelopes.response`.

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


def edge_mode(
    cell: Cell, contacts: Contacts, edge: sp.Integer, branch: int, bead: int
) -> Mode:
    """The mode of two beads at the edge of a band, in exact numbers.

    Symbols stand for all numbers until the end: a pole at the frequency 2ω that no force drives
    cancels then.

    Parameters
    ----------
    cell : Cell
        The chain; its symbols have sample values by which the branches are ordered.
    contacts : Contacts
        The cell under load; at κ = π masses or contacts are alike.
    edge : {1, -1}
        e^{iκ}.
    branch : int
        Number of the branch.
    bead : int
        Index of the bead whose φ is positive.

    Raises
    ------
    InputError
        Where the second harmonic is a mode that the mode drives.
    """
    letters, values = _letters(contacts)
    squares = _edge_squares(letters, edge)
    squares.sort(key=lambda square: _sampled(cell, square.xreplace(values)))
    square = squares[branch]
    x = sp.Dummy("x")
    secular = sp.Matrix(letters.secular(edge, x))
    relation = secular.det() * np.prod(letters.c)  # T(x) - 2 cos κ
    first, second = (sp.factor(relation.diff(x, n).subs(x, square)) for n in (1, 2))
    adjugate = np.array(secular.subs(x, square).adjugate())
    projector = adjugate / (np.diagonal(adjugate) * letters.masses).sum()
    resolvent = np.array(sp.Matrix(letters.secular(sp.S.One, 4 * square)).inv())
    found = letters.mode(edge, 0, square, (first, second), projector, resolvent)

    def number(value: Any) -> sp.Expr:
        return sp.factor(value).xreplace(values)

    cubic = number(found.cubic)
    if cubic.has(sp.zoo, sp.nan):
        raise InputError(
            "the second harmonic is a mode too: the envelope's equation fails"
        )
    root = sp.sqrt(number(projector[bead, bead]))
    return Mode(
        square=number(square),
        slope=sp.S.Zero,
        curvature=number(found.curvature),
        cubic=cubic,
        mean=[number(e) for e in found.mean],
        size=[number(d) for d in found.size],
        shape=[number(phi) / root for phi in projector[:, bead]],
    )


def _letters(contacts: Contacts) -> tuple[Contacts, dict[sp.Symbol, sp.Expr]]:
    """A cell with symbols for its numbers, one for equal numbers, and the numbers by symbol."""
    values: dict[sp.Symbol, sp.Expr] = {}

    def named(numbers: Iterable[sp.Expr]) -> Matrix:
        symbols: dict[sp.Expr, sp.Symbol] = {}
        for number in numbers:
            if number not in symbols:
                symbols[number] = sp.Dummy(positive=True)
                values[symbols[number]] = number
        return np.array([symbols[number] for number in numbers])

    masses = named(contacts.masses)
    c = named(contacts.c)
    s, t = sp.Dummy("s"), sp.Dummy("t")
    values |= {s: contacts.s, t: contacts.t}
    return replace(contacts, masses=masses, c=c, s=s, t=t), values


def _edge_squares(contacts: Contacts, edge: sp.Integer) -> list[sp.Expr]:
    """Squared frequencies of two beads: at κ = 0, or at κ = π of like masses or like contacts."""
    m1, m2 = contacts.masses
    k1, k2 = 1 / contacts.c
    if edge == 1:
        return [sp.S.Zero, (k1 + k2) * (1 / m1 + 1 / m2)]
    if m1 == m2:
        return [2 * k1 / m1, 2 * k2 / m1]
    return [2 * k1 / m1, 2 * k1 / m2]
