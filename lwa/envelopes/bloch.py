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

MOST_SYMBOLS = 5  # beyond which exact coefficients take seconds; unlike contacts count as three

K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force K2 δ + K3 δ² + K4 δ³ on top of the load, under `lwa.general()`."""

X, Z = sp.symbols("x z", cls=sp.Dummy)


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
        demand_numbers(set().union(*(x.free_symbols for x in numbers)), "floats need numbers")
    samples = [_sampled(cell, x) for x in numbers]
    m_float, c_float = np.array(samples[:-3]).reshape(2, -1)
    sample = Sampled.of(Contacts(m_float, c_float, *samples[-3:-1]), samples[-1], branch)
    if floats:
        mode = sample.mode()
    else:
        unlike = len(set(c)) > 1 and not sp.cos(wavenumber).is_Rational
        if len(set().union(*(x.free_symbols for x in numbers))) + 3 * unlike > MOST_SYMBOLS:
            announced("the envelope's equation in these symbols")
        contacts = Contacts(np.array(masses), np.array(c), s, t)
        mode = exact_mode(contacts, wavenumber, branch, sample.bead, lambda x: _sampled(cell, x))
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
            raise InputError("two branches touch at this wavenumber: an envelope has one mode")
        if kappa == 0 == branch:
            raise InputError(
                "the frequency is zero at this wavenumber: sound, c_g = c_0, has no envelope; its "
                "mean flow runs along with it"
            )
        return found

    @property
    def gaps(self) -> NDArray[Any]:
        """Differences x_j - x of the squared frequencies of the other branches."""
        return np.asarray(np.delete(self.squares, self.branch) - self.squares[self.branch])

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
        speed = contacts.masses.sum() * contacts.c.sum() * (z.imag / first) ** 2 / x  # (c_g/c_0)²
        if x < contacts.close or 1 - speed < SOUND:
            raise InputError(
                "the mode's group velocity is too close to that of sound, c_g = c_0, for floats: "
                "its mean flow runs along with it"
                + "; exact results stand"
                * (len(contacts.masses) < 3)
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
        if np.any(np.abs(vectors.conj().T @ drive)[near] > ROUNDING * np.abs(drive).max()):
            raise InputError(
                "the second harmonic is a mode too, or too near one for floats: the envelope's "
                "equation fails"
            )
        rates = np.where(near, 0, 1 / np.where(near, 1, squares - square))
        return np.asarray((vectors * rates) @ vectors.conj().T)


# --- exact ---


@dataclass(frozen=True, eq=False)
class Root:
    """Squared frequency x = ω² of a mode at a wavenumber, a root of an irreducible polynomial.

    Powers of x in a result are reduced to the lowest ones by division with remainder.

    cosine, phase : cos κ and e^{iκ}. values : mapping from the field's generators to values.
    """

    value: sp.Expr
    polynomial: sp.Poly
    cosine: sp.Expr
    phase: sp.Expr
    values: dict[sp.Symbol, sp.Expr]

    def real(self, element: Any) -> sp.Expr:
        """Value of an element of the field that does not change with the sign of κ."""
        top, below = (
            sp.Poly(_in_cosine(part.as_expr(), self.cosine), X, field=True).rem(self.polynomial)
            for part in (element.numer, element.denom)
        )
        quotient = (top * below.invert(self.polynomial)).rem(self.polynomial)
        reduced = sp.Add(*(sp.factor(c) * self.value**n for (n,), c in quotient.terms()))
        return reduced.xreplace(self.values)

    def complex(self, element: Any) -> sp.Expr:
        """Value of any element of the field."""
        if self.phase.is_Integer:
            return self.real(element)
        return element.as_expr().xreplace({X: self.value, Z: self.phase}).xreplace(self.values)


def _in_cosine(polynomial: sp.Expr, cosine: sp.Expr) -> sp.Expr:
    """Write z^{-h} Σ_{n≤2h} a_n z^n, a_n = a_{2h-n}, in cos κ by Chebyshev's T_n(cos κ)."""
    a = sp.Poly(polynomial, Z).all_coeffs()
    while len(a) > 1 and not a[-1]:
        a.pop()
    h = len(a) // 2
    return a[h] + sp.Add(*(2 * a[h - n] * sp.chebyshevt(n, cosine) for n in range(1, h + 1)))


def _roots(relation: Any, cosine: sp.Expr) -> list[tuple[sp.Expr, sp.Poly]]:
    """Roots x of T(x) = 2 cos κ, of degree 1 or 2, with their irreducible polynomials."""
    pairs: list[tuple[sp.Expr, sp.Poly]] = []
    for factor, count in sp.factor_list(_in_cosine(relation.numer.as_expr(), cosine))[1]:
        if X in factor.free_symbols:
            polynomial = sp.Poly(factor, X, field=True)
            pairs += count * [(x, polynomial) for x in sp.roots(polynomial)]
    return pairs


def exact_mode(
    contacts: Contacts,
    wavenumber: sp.Expr,
    branch: int,
    bead: int,
    sampled: Callable[[sp.Expr], float],
    generic: bool = False,
) -> Mode:
    """The mode of a branch of one or two beads, in sin κ/2 and cos κ/2 unless cos κ is rational.

    bead : index of the bead whose φ is positive. sampled : function that gives a float of an
    expression, its symbols replaced by sample numbers; the roots are ordered by these floats.
    generic : True to derive the mode with symbols for all numbers, which are put in at the end:
    a pole at the frequency 2ω that no force drives cancels then.

    Raises `lwa.InputError` where the second harmonic is a mode that the mode drives.
    """
    P, cosine, phase = len(contacts.masses), sp.cos(wavenumber), sp.exp(sp.I * wavenumber)
    sine = sp.sqrt(1 - cosine**2)
    if not cosine.is_Rational:
        half = wavenumber / 2
        sine, cosine = 2 * sp.sin(half) * sp.cos(half), 1 - 2 * sp.sin(half) ** 2
    numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t)
    letters = {a: a if a.is_Rational and not generic else sp.Dummy(positive=True) for a in numbers}
    field, (x, z, *elements) = sfield([X, Z, *(letters[a] for a in numbers)])
    inner = Contacts(*np.array(elements[:-2], object).reshape(2, P), *elements[-2:])
    z = field.one * int(phase) if phase.is_Integer else z

    def matrix(entries: Matrix) -> DomainMatrix:
        rows = [[field.one * a for a in row] for row in entries]
        return DomainMatrix(rows, (P, P), field.to_domain())

    def inverse(entries: Matrix) -> Matrix:
        return np.array(matrix(entries).inv().to_list(), object)

    secular = matrix(inner.secular(z, x))
    relation = secular.det() * np.prod(inner.c)  # T(x) - 2 cos κ
    values = {letter: a for a, letter in letters.items()}
    roots = sorted(_roots(relation, cosine), key=lambda pair: sampled(pair[0].xreplace(values)))
    square = Root(*roots[branch], cosine, phase, values)
    if not generic and P > 1 and square.real(matrix(inner.secular(z * z, 4 * x)).det()).is_zero:
        return exact_mode(contacts, wavenumber, branch, bead, sampled, generic=True)
    slopes = relation.diff(x), relation.diff(x).diff(x)
    adjugate = np.array(secular.adjugate().to_list(), object)
    projector = adjugate / (np.diagonal(adjugate) * inner.masses).sum()
    if P == 1:  # a rational function of z
        x = (2 - z - 1 / z) / (inner.masses[0] * inner.c[0])
    exact = Arithmetic(inverse, square.real, square.complex)
    mode = inner.mode(z, x, slopes, projector, bead, sine, exact)
    if mode.cubic.has(sp.zoo, sp.nan):
        raise InputError("the second harmonic is a mode too: the envelope's equation fails")
    return mode
