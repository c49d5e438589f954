"""Conversion between SymPy and python-flint, and rational expressions in lowest terms.

Parts that are not rational, such as A^{1/k}, are taken as symbols.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

Fraction = tuple[fmpq_mpoly, fmpq_mpoly]


def to_flint(value: sp.Expr) -> fmpq:
    """Convert a rational of SymPy to python-flint."""
    return fmpq(int(value.p), int(value.q))


def to_sympy(value: fmpq) -> sp.Rational:
    """Convert a rational of python-flint to SymPy."""
    return sp.Rational(int(value.p), int(value.q))


def context(count: int) -> fmpq_mpoly_ctx:
    """The ring Q[x_0, …] with ``count`` generators."""
    return fmpq_mpoly_ctx.get([f"x{i}" for i in range(count)], Ordering.lex)


def factored(value: sp.Expr) -> sp.Expr:
    """The expression as a fraction in lowest terms with factored numerator and denominator.

    The result is that of SymPy's `cancel` and `factor`, in a tenth of their time for the
    expressions of a wave.

    >>> x, y = sp.symbols("x y")
    >>> factored(x / (x**2 - y**2) + y / (y**2 - x**2))
    1/(x + y)
    """
    generators = sorted(_atoms(value), key=sp.default_sort_key)
    ring = context(len(generators))
    images = dict(zip(generators, ring.gens(), strict=True))
    top, bottom = _fraction(value, images, ring)
    if top.is_zero():
        return sp.S.Zero
    common = top.gcd(bottom)
    numerator, above = (top / common).factor()
    denominator, below = (bottom / common).factor()
    powers = [to_sum(factor, generators) ** int(e) for factor, e in above]
    powers += [to_sum(factor, generators) ** -int(e) for factor, e in below]
    return sp.Mul(to_sympy(numerator / denominator), *powers)


def _fraction(
    value: sp.Expr, images: dict[sp.Expr, fmpq_mpoly], ring: fmpq_mpoly_ctx
) -> Fraction:
    """Numerator and denominator of an expression in the generators of a ring."""
    one = ring.constant(1)
    if value.is_Rational:
        return ring.constant(to_flint(value)), one
    if value.is_Add or value.is_Mul:
        numerator, denominator = ring.constant(0 if value.is_Add else 1), one
        for part in value.args:
            n, d = _fraction(part, images, ring)
            numerator = (
                numerator * d + n * denominator if value.is_Add else numerator * n
            )
            denominator = denominator * d
        return numerator, denominator
    if value.is_Pow and value.exp.is_Integer:
        n, d = _fraction(value.base, images, ring)
        e = int(value.exp)
        return (n**e, d**e) if e > 0 else (d**-e, n**-e)
    if _is_reciprocal(value):
        n, d = _fraction(1 / value, images, ring)
        return d, n
    return images[value], one


def to_sum(polynomial: fmpq_mpoly, generators: Sequence[sp.Expr]) -> sp.Expr:
    """Convert a polynomial to a sum of products of these expressions."""
    return sp.Add(
        *(
            sp.Mul(to_sympy(c), *map(sp.Pow, generators, map(int, e)))
            for e, c in polynomial.terms()
        )
    )


def _atoms(value: sp.Expr) -> set[sp.Expr]:
    """The symbols of an expression and its other parts that are not rational in symbols."""
    if value.is_Rational:
        return set()
    if value.is_Add or value.is_Mul:
        return set().union(*map(_atoms, value.args))
    if value.is_Pow and value.exp.is_Integer:
        return _atoms(value.base)
    return _atoms(1 / value) if _is_reciprocal(value) else {value}


def _is_reciprocal(value: sp.Expr) -> bool:
    """True for a power with a negative exponent, such as x^{-y}, the reciprocal of x^y."""
    return bool(value.is_Pow and value.exp.could_extract_minus_sign())
