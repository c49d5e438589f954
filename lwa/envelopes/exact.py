"""Exact coefficients of an envelope: rational functions of x = ω², reduced by its own equation.

Ratios of masses and springs, z = e^{iκ} and x are generators of a field of rational functions, in
which `lwa.envelopes.modes` is evaluated. Real results depend on z + 1/z = 2 cos κ only; and of x, a
root of T(x) = 2 cos κ, a division with remainder leaves the lowest powers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from sympy.polys.fields import sfield
from sympy.polys.matrices import DomainMatrix

from lwa.base.exact import InputError
from lwa.envelopes.modes import Coefficients, Matrix, Springs, coefficients

X, Z = sp.symbols("x z", cls=sp.Dummy)


@dataclass(frozen=True, eq=False)
class Root:
    """x = ω² of a mode, a root of an irreducible polynomial, at a wavenumber.

    cosine, phase : cos κ and e^{iκ}.
    """

    value: sp.Expr
    polynomial: sp.Poly
    cosine: sp.Expr
    phase: sp.Expr

    def real(self, element: Any) -> sp.Expr:
        """An element of the field that does not change with the sign of κ."""
        parts = (in_cosine(part.as_expr(), self.cosine) for part in (element.numer, element.denom))
        if self.polynomial.degree() == 1:
            top, below = (part.xreplace({X: self.value}) for part in parts)
            return sp.factor(top / below)
        top, below = (sp.Poly(part, X, field=True) for part in parts)
        found = (top * below.invert(self.polynomial)).rem(self.polynomial)
        return sp.Add(*(sp.factor(c) * self.value**n for (n,), c in found.terms()))

    def complex(self, element: Any) -> sp.Expr:
        """Any element of the field."""
        if self.phase.is_Integer:
            return self.real(element)
        return element.as_expr().xreplace({X: self.value, Z: self.phase})


def in_cosine(polynomial: sp.Expr, cosine: sp.Expr) -> sp.Expr:
    """z^{-h} Σ a_n z^n, n ≤ 2h, a_n = a_{2h-n}, by z^n + z^{-n} = 2 T_n(cos κ)."""
    a = sp.Poly(polynomial, Z).all_coeffs()
    while len(a) > 1 and not a[-1]:
        a.pop()
    h = len(a) // 2
    return a[h] + sp.Add(*(2 * a[h - n] * sp.chebyshevt(n, cosine) for n in range(1, h + 1)))


def root(
    relation: Any, guess: float, sample: Mapping[sp.Symbol, Any], cosine: sp.Expr, phase: sp.Expr
) -> Root:
    """The root of T(x) - 2 cos κ nearest to ``guess`` where symbols have the values of ``sample``.

    Raises `lwa.InputError` where it has no exact form.
    """
    found = []
    for factor, _ in sp.factor_list(in_cosine(relation.numer.as_expr(), cosine))[1]:
        if X in factor.free_symbols:
            polynomial = sp.Poly(factor, X, field=True)
            for value in _roots(polynomial):
                distance = abs(complex(value.xreplace(dict(sample))) - guess)
                found.append((distance, value, polynomial))
    _, value, polynomial = min(found, key=lambda row: row[0])
    return Root(value, polynomial, cosine, phase)


def _roots(polynomial: sp.Poly) -> list[sp.Expr]:
    if polynomial.degree() > 2:
        try:
            return list(polynomial.real_roots())
        except (NotImplementedError, sp.PolynomialError):
            raise InputError(
                "the frequency has no exact form at this wavenumber: numeric() gives floats"
            ) from None
    *a, b, c = (sp.factor(value) for value in polynomial.all_coeffs())
    if not a:
        return [sp.factor(-c / b)]
    half = sp.sqrt(sp.factor(b**2 - 4 * a[0] * c)) / (2 * a[0])
    return [-b / (2 * a[0]) + half, -b / (2 * a[0]) - half]


def exact_mode(
    ratios: Sequence[Sequence[sp.Expr]], cosine: sp.Expr, phase: sp.Expr, guess: float,
    sample: Mapping[sp.Symbol, Any], reference: int,
) -> tuple[sp.Expr, Coefficients]:  # fmt: skip
    """x = ω² and the coefficients for rows of masses, K2, K3, K4.

    cosine, phase : cos κ and e^{iκ}, integers at the ends of a band.
    guess : x in floats where the symbols have the values of ``sample``.
    """
    P = len(ratios[0])
    field, elements = sfield([X, Z, *(value for row in ratios for value in row)])
    x, z, *numbers = elements
    if phase.is_Integer:
        z = field.one * int(phase)
    springs = Springs(*np.array(numbers, object).reshape(4, P))
    found = root(springs.trace(x)[0] - z - 1 / z, guess, sample, cosine, phase)
    if P == 1:
        x = springs.stiffness(z)[0, 0] / springs.masses[0]
    elif found.polynomial.degree() == 1:
        x = field.from_expr(found.value)
    domain = field.to_domain()

    def matrix(entries: Matrix) -> DomainMatrix:
        return DomainMatrix([[field.one * a for a in row] for row in entries], (P, P), domain)

    def inverse(entries: Matrix) -> Matrix:
        return np.array(matrix(entries).inv().to_list(), object)

    adjugate = matrix(springs.stiffness(z) - np.diag(springs.masses) * x).adjugate()
    projector = np.array(adjugate.to_list(), object)
    projector = projector / (np.diagonal(projector) * springs.masses).sum()
    c = coefficients(springs, z, x, projector, reference, inverse)
    scalars = map(found.real, (c.slope, c.bend, c.excess, c.cubic))
    rows = (
        (found.complex, c.second),
        (found.real, c.mean),
        (found.real, c.size),
        (found.complex, c.mode),
    )
    return found.value, Coefficients(
        *scalars, *(np.array(list(map(f, row)), object) for f, row in rows)
    )
