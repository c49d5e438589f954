"""Bloch modes of a loaded cell, in floats or in exact numbers, in the units of the cell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from sympy.polys.fields import sfield
from sympy.polys.matrices import DomainMatrix

from lwa.base.exact import InputError, demand_numbers
from lwa.base.progress import announced
from lwa.cell import Cell
from lwa.envelopes.response import CLOSE, Arithmetic, Contacts, Matrix, Mode
from lwa.law import ContactLaw

ROUNDING = 1e-7  # a force on a mode, relative to the largest, that counts as none
SOUND = 1e-5  # 1 - (c_g/c_0)² from which on floats give the mean flow to six digits (1e-11/SOUND)

MOST_SYMBOLS = 5  # beyond which exact coefficients take seconds

K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force K2 δ + K3 δ² + K4 δ³ on top of the load, under `lwa.general()`."""

X = sp.Symbol("x")
"""Squared frequency ω² of a mode; the numbers of a chain stand beside it as Dummies."""


def cell_mode(
    cell: Cell,
    law: ContactLaw,
    compression: sp.Expr,
    wavenumber: sp.Expr,
    branch: int,
    floats: bool,
) -> Mode:
    """Return the mode of a branch of a cell whose contacts are at a mean static compression."""
    delta = compression * cell.shares(law.exponent)[0]
    mass, unit = cell.masses[0], sp.S.One if law.formless or delta.is_zero else delta
    if law.formless:
        first, s, t = K2, K3 / K2, K4 / K2
    else:
        first = law.at(delta, 1)
        if delta.is_zero:
            s, t = (law.at(delta, n) / first / sp.factorial(n) for n in (2, 3))
        else:
            s, t = (law.phi(n).subs(law.delta, delta) / sp.factorial(n) for n in (2, 3))
    compliances = cell.compliances(law.exponent)
    masses = [m / mass for m in cell.masses]
    c = [sp.powsimp(part / compliances[0]) for part in compliances]
    numbers = (*masses, *c, s, t, wavenumber)
    if floats:
        demand_numbers(
            set().union(*(x.free_symbols for x in numbers)), "floats need numbers"
        )
    samples = [_sampled(cell, x) for x in numbers]
    m_float, c_float = np.array(samples[:-3]).reshape(2, -1)
    sample = Sampled.of(
        Contacts(m_float, c_float, *samples[-3:-1]), samples[-1], branch
    )
    if floats:
        mode = sample.mode()
    elif cell.size == 1:
        mode = equal_beads(s, t, wavenumber)
    else:
        if len(set().union(*(x.free_symbols for x in numbers))) > MOST_SYMBOLS:
            announced("the envelope's equation in these symbols")
        contacts, edge = (
            Contacts(np.array(masses), np.array(c), s, t),
            int(sp.cos(wavenumber)),
        )
        mode = edge_mode(
            contacts, edge, branch, sample.bead, lambda x: _sampled(cell, x)
        )
    rate = sp.powsimp(cell.stiffnesses[0] * first / mass)  # unit of ω²
    return Mode(
        sp.sympify(mode.square) * rate,
        mode.slope * rate,
        mode.curvature * rate,
        mode.cubic * rate / (mass * unit**2),
        [sp.sympify(x) / (mass * unit) for x in mode.mean],
        [sp.sympify(x) / mass for x in mode.size],
        [sp.sympify(x) / sp.sqrt(mass) for x in mode.shape],
    )


def _sampled(cell: Cell, value: sp.Expr) -> float:
    """Float of an expression at sample values of its symbols, to order the branches.

    Samples are π/3, π/6, … along the cell, so that the first mass is the heaviest and no sample is
    one of the numbers in the cell, and 1.5 for symbols of neither masses nor stiffnesses.
    """
    symbols = dict.fromkeys(value.free_symbols, 1.5)
    for values in (cell.stiffnesses, cell.masses):
        for i, part in reversed([*enumerate(values)]):
            symbols |= dict.fromkeys(part.free_symbols, np.pi / (3 + 3 * i))
    return float(value.xreplace(symbols))


@dataclass(frozen=True, eq=False)
class Sampled:
    """Modes of a cell in floats, the branch and the bead with the mode's largest displacement.

    z : e^{iκ}, real at the edges. squares, vectors : squared frequencies, and √m times the modes.
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
        return np.asarray(
            np.delete(self.squares, self.branch) - self.squares[self.branch]
        )

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
        contacts, z, x = self.contacts, self.z, float(self.squares[self.branch])
        # T(x) - 2 cos κ = Π m Π c Π_j (x_j - x) over the modes j, differentiated at a root
        first = -np.prod(contacts.masses * contacts.c * np.append(self.gaps, 1))
        slopes = first, -2 * first * (1 / self.gaps).sum()
        speed = (
            contacts.masses.sum() * contacts.c.sum() * (z.imag / first) ** 2 / x
        )  # (c_g/c_0)²
        if x < contacts.close or 1 - speed < SOUND:
            exact = "; exact results stand" if len(contacts.masses) == 1 else ""
            raise InputError(
                "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: "
                f"its mean flow runs along with it{exact}"
            )
        projector = np.outer(self.shape, self.shape.conj())
        resolvent = self._resolvent(4 * x)
        floats = Arithmetic(lambda _: resolvent, np.real, lambda e: e)
        return contacts.mode(z, x, slopes, projector, self.bead, z.imag, floats)

    def _resolvent(self, square: float) -> Matrix:
        """Inverse of K(2κ) - 4ω²M; a mode of the frequency 2ω that is not driven is left out."""
        contacts, z = self.contacts, self.z
        squares, vectors = np.linalg.eigh(contacts.secular(z * z, 0) / contacts.units)
        vectors = vectors / np.sqrt(contacts.masses)[:, None]
        d = contacts.strains(z) @ self.shape
        drive = contacts.strains(1 / (z * z)).T @ (d * d / contacts.c**2)
        near = np.abs(squares - square) < contacts.close
        if np.any(
            np.abs(vectors.conj().T @ drive)[near] > ROUNDING * np.abs(drive).max()
        ):
            raise InputError(
                "the second harmonic is a mode too, or too near one for floats: the envelope's "
                "equation fails"
            )
        rates = np.where(near, 0, 1 / np.where(near, 1, squares - square))
        return np.asarray((vectors * rates) @ vectors.conj().T)


# --- exact ---


def equal_beads(s: sp.Expr, t: sp.Expr, wavenumber: sp.Expr) -> Mode:
    """The mode of a cell of one bead in closed form, in the units of `lwa.envelopes.response`.

    With S, C = sin κ/2, cos κ/2: ω = |d| = 2S and c_g = C, hence e0 = -2s |d|²/(1 - C²) = -8s. The
    second harmonic has G = 4 sin²κ/(4 sin²κ - 16 S²) = -C²/S² and e2 = s d² C²/S².
    """
    S, C = sp.sin(wavenumber / 2), sp.cos(wavenumber / 2)
    cubic = 48 * t * S**4 - 32 * s**2 * S**2 * (1 + S**2)
    return Mode(4 * S**2, 4 * S * C, -(S**2), cubic, [-8 * s], [4 * S**2], [sp.S.One])


@dataclass(frozen=True, eq=False)
class Root:
    """Squared frequency x = ω² of a mode, a root of an irreducible polynomial.

    Powers of x in a result are reduced to the lowest ones by division with remainder.

    values : mapping from the field's generators to values.
    """

    value: sp.Expr
    polynomial: sp.Poly
    values: dict[sp.Symbol, sp.Expr]

    def number(self, element: Any) -> sp.Expr:
        """Value of an element of the field."""
        top, below = (
            sp.Poly(part.as_expr(), X, field=True).rem(self.polynomial)
            for part in (element.numer, element.denom)
        )
        quotient = (top * below.invert(self.polynomial)).rem(self.polynomial)
        reduced = sp.Add(
            *(sp.factor(c) * self.value**n for (n,), c in quotient.terms())
        )
        return reduced.xreplace(self.values)


def edge_mode(
    contacts: Contacts,
    edge: int,
    branch: int,
    bead: int,
    sampled: Callable[[sp.Expr], float],
    generic: bool = False,
) -> Mode:
    """The mode of two beads at the edge of a band, in exact numbers.

    edge : e^{iκ} at κ = 0 or π, 1 or -1. bead : index of the bead whose φ is positive.
    sampled : function that gives a float of an expression, its symbols replaced by sample numbers;
    the roots are ordered by these floats.
    generic : True to derive the mode with symbols for all numbers, which are put in at the end:
    a pole at the frequency 2ω that no force drives cancels then.

    Raises `lwa.InputError` where the second harmonic is a mode that the mode drives.
    """
    numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t)
    letters = {
        a: a if a.is_Rational and not generic else sp.Dummy(positive=True)
        for a in numbers
    }
    field, (x, *elements) = sfield([X, *(letters[a] for a in numbers)])
    inner = Contacts(*np.array(elements[:-2], object).reshape(2, 2), *elements[-2:])
    z = field.one * edge

    def matrix(entries: Matrix) -> DomainMatrix:
        rows = [[field.one * a for a in row] for row in entries]
        return DomainMatrix(rows, (2, 2), field.to_domain())

    def inverse(entries: Matrix) -> Matrix:
        return np.array(matrix(entries).inv().to_list(), object)

    secular = matrix(inner.secular(z, x))
    relation = secular.det() * np.prod(inner.c)  # T(x) - 2 cos κ
    values = {letter: a for a, letter in letters.items()}
    roots: list[tuple[sp.Expr, sp.Poly]] = []
    for factor, count in sp.factor_list(relation.numer.as_expr())[1]:
        if X in factor.free_symbols:
            polynomial = sp.Poly(factor, X, field=True)
            roots += count * [(root, polynomial) for root in sp.roots(polynomial)]
    roots.sort(key=lambda pair: sampled(pair[0].xreplace(values)))
    square = Root(*roots[branch], values)
    if not generic and square.number(matrix(inner.secular(z * z, 4 * x)).det()).is_zero:
        return edge_mode(contacts, edge, branch, bead, sampled, generic=True)
    slopes = relation.diff(x), relation.diff(x).diff(x)
    adjugate = np.array(secular.adjugate().to_list(), object)
    projector = adjugate / (np.diagonal(adjugate) * inner.masses).sum()
    exact = Arithmetic(inverse, square.number, square.number)
    mode = inner.mode(z, x, slopes, projector, bead, 0, exact)
    if mode.cubic.has(sp.zoo, sp.nan):
        raise InputError(
            "the second harmonic is a mode too: the envelope's equation fails"
        )
    return mode
