"""Exact Bloch modes and their response: rational functions of x = ω², reduced by its equation.

Letters as in `lwa.envelopes.modes`. The m_i, c_i, z = e^{iκ} and x generate a field of rational
functions, in which the formulas of that module are evaluated. Real results depend on
z + 1/z = 2 cos κ only. As x is a root of the dispersion relation T(x) = 2 cos κ, a polynomial
equation, a division with remainder reduces the powers of x in a result to the lowest ones. The
polynomial T follows from det(K(κ) - xM) Π c_i = T(x) - 2 cos κ; cf. `lwa.Dispersion.trace`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from sympy.polys.fields import sfield
from sympy.polys.matrices import DomainMatrix

from lwa.base.exact import InputError, root
from lwa.envelopes.modes import Contacts, Matrix, Mode

X, Z = sp.symbols("x z", cls=sp.Dummy)


@dataclass(frozen=True, eq=False)
class Root:
    """Squared frequency x = ω² of a mode at a wavenumber, a root of an irreducible polynomial.

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
        found = (top * below.invert(self.polynomial)).rem(self.polynomial)
        reduced = sp.Add(*(sp.factor(c) * self.value**n for (n,), c in found.terms()))
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


def _roots(relation: Any, *mode: Any) -> list[Root]:
    """The roots x of T(x) = 2 cos κ; ``mode`` is the rest of `Root`."""
    found: list[Root] = []
    for factor, count in sp.factor_list(_in_cosine(relation.numer.as_expr(), mode[0]))[1]:
        if X in factor.free_symbols:
            polynomial = sp.Poly(factor, X, field=True)
            try:
                roots = sp.roots(polynomial) if polynomial.degree() < 3 else polynomial.real_roots()
            except (NotImplementedError, sp.PolynomialError):
                raise InputError(
                    "the frequency has no exact form at this wavenumber: numeric() gives floats"
                ) from None
            found += count * [Root(x, polynomial, *mode) for x in roots]
    return found


def exact_mode(
    contacts: Contacts, wavenumber: sp.Expr, branch: int, bead: int,
    sampled: Callable[[sp.Expr], float],
) -> Mode:  # fmt: skip
    """The mode of a branch in exact numbers, in sin κ/2 and cos κ/2 unless cos κ is rational.

    bead : index of the bead whose φ is positive. sampled : function that gives a float of an
    expression, its symbols replaced by sample numbers; the roots are ordered by these floats.

    Raises `lwa.InputError` where the frequency has no exact form.
    """
    P, cosine, phase = len(contacts.masses), sp.cos(wavenumber), sp.exp(sp.I * wavenumber)
    sine = root(1 - cosine**2)
    if not cosine.is_Rational:
        half = wavenumber / 2
        sine, cosine = 2 * sp.sin(half) * sp.cos(half), 1 - 2 * sp.sin(half) ** 2
    numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t)
    letters = {a: a if a.is_Rational else sp.Dummy(positive=True) for a in numbers}
    field, (x, z, *elements) = sfield([X, Z, *(letters[a] for a in numbers)])
    own = Contacts(*np.array(elements[:-2], object).reshape(2, P), *elements[-2:])
    z = field.one * int(phase) if phase.is_Integer else z

    def matrix(entries: Matrix) -> DomainMatrix:
        rows = [[field.one * a for a in row] for row in entries]
        return DomainMatrix(rows, (P, P), field.to_domain())

    def inverse(entries: Matrix) -> Matrix:
        return np.array(matrix(entries).inv().to_list(), object)

    secular = matrix(own.stiffness(z) - np.diag(own.masses) * x)
    relation = secular.det() * np.prod(own.c)  # T(x) - 2 cos κ
    values = {letter: a for a, letter in letters.items()}
    roots = _roots(relation, cosine, phase, values)
    found = sorted(roots, key=lambda one: sampled(one.value.xreplace(values)))[branch]
    first, following = relation.diff(x), relation.diff(x).diff(x)  # T′ and T″
    square = -((z - 1 / z) ** 2) / first**2  # x′², x′ = -2 sin κ/T′
    bend = (-(z + 1 / z) - following * square) / first  # x″
    adjugate = np.array(secular.adjugate().to_list(), object)
    projector = adjugate / (np.diagonal(adjugate) * own.masses).sum()
    if P == 1:  # a rational function of z
        x = (2 - z - 1 / z) / (own.masses[0] * own.c[0])
    speed = own.masses.sum() * own.c.sum() * square / (4 * x)
    cubic, second, mean, size = own.response(z, x, speed / (speed - 1), projector, bead, inverse)
    unit = root(found.real(projector[bead, bead]))
    return Mode(
        found.value.xreplace(values),
        -2 * sine * found.real(1 / first),
        found.real(bend / 2 - square / (4 * x)),
        found.real(cubic),
        [found.complex(e) for e in second],
        [found.real(e) for e in mean],
        [found.real(e) for e in size],
        [found.complex(e) / unit for e in projector[:, bead]],
    )
