"""Sums of series in ε = k - 1, in powers of x = 1 - 1/k, with an estimate of the error.

As functions of k the quantities of a wave are singular at k = 0, so that the coefficients of ε^n
alternate and the series in ε is of no use beyond ε = 1. Euler's transformation ε = x/(1 - x) moves
this point to infinity (Hardy, *Divergent Series*, 1949, chapter 8):

    Σ a_n ε^n = Σ b_n x^n,    b_0 = a_0,    b_n = Σ_{m=1}^n C(n-1, m-1) a_m,

and 0 < x < 1 for every k > 1. The b_n of equal beads are below 1 up to n = `LAST`, from where on
they grow: the series is asymptotic. A sum that ends with x^n misses b_{n+1} x^{n+1} + …; its error
is estimated as

    max(`SAFETY`, 2k) b x^{n+1},    b the largest of the last `WINDOW` coefficients,

since one coefficient may be small by chance, next to a change of sign, and x^{n+1} + x^{n+2} + …
= k x^{n+1}.

The difference that unlike beads make is summed apart: its terms soon grow, where masses are nearly
equal from the first on. This sum ends before the first term that is smaller than the next, and its
error is `LEFT_OUT` times that term. The error by radiation (`lwa.expansion.radiation`) is added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import comb

import mpmath
import sympy as sp

from lwa.base.frozen import Estimate

LAST = 16
"""Last power of x in a sum: later terms of equal beads make it worse (k = 2 … 3.5)."""

WINDOW = 4
"""Number of coefficients that tell the size of the next."""

SAFETY = 7
"""Least ratio of the error estimate to b x^{n+1}.

Measured on 9,400 sums of equal beads (nine quantities, 99 values of k = 1.05 … 3.5, orders 6 … 16)
against the lattice's waves: 95.0 % of the estimates are 1 to 30 times the deviation, and 0.8 % are
below the deviation, at worst 0.82 of it.
"""

LEFT_OUT = 1.5
"""Ratio of the error estimate to the first term that is left out where terms grow.

Measured on 692 sums of dimers, c² and widths at k = 1.1 … 2, m2/m1 = 0.05 … 0.99 and orders 6 … 12,
against exact waves and the pulses of struck chains: no deviation is larger than its estimate.
"""

TERM_DIGITS = 60
"""Decimal digits of the terms of a sum: the binomial coefficients cancel some."""


@dataclass(frozen=True, repr=False)
class Resummed(Estimate):
    """A series summed at one k, with an estimate of the absolute error.

    asymptotic : True if higher orders do not help: the larger part of the error is radiation, or
        that of a sum that ends before terms that grow.
    """

    asymptotic: bool


def resum(
    coefficients: Sequence[sp.Expr],
    epsilon: sp.Expr,
    base: Sequence[sp.Expr] = (),
    unit: sp.Expr = sp.S.One,
    relative: float = 0.0,
) -> Resummed:
    """Sum unit · Σ coefficients[n] ε^n, all numbers, with an estimate of the error.

    base : the series of equal beads, by default these coefficients. The difference of the two
        series is summed apart.
    relative : a further error, relative to the sum.
    """
    with mpmath.workdps(TERM_DIGITS):
        x, scale = _mp(epsilon / (1 + epsilon)), _mp(unit)
        whole = _transformed(coefficients)
        first = _transformed(base) if base else whole
        sums = [_sum(first, x)]
        rest = [a - b for a, b in zip(whole, first, strict=True)]
        if any(rest):
            sums.append(_truncated(rest, x))
        value = scale * mpmath.fsum(s.value for s in sums)
        error = abs(scale) * mpmath.fsum(s.error for s in sums)
        ulp = abs(value) * mpmath.mpf(2) ** -52  # the sum leaves as a float
        radiated = abs(value) * relative
        largest = max(sums, key=lambda s: s.error)
        asymptotic = largest.asymptotic or bool(radiated > error)
        return Resummed(float(value), float(error + radiated + ulp), asymptotic)


def _mp(value: sp.Expr) -> mpmath.mpf:
    if value.is_Rational:
        return mpmath.mpf(int(value.p)) / int(value.q)
    return mpmath.mpf(value.evalf(TERM_DIGITS)._mpf_)


def _transformed(coefficients: Sequence[sp.Expr]) -> list[mpmath.mpf]:
    """Coefficients b_n of x^n from those of ε^n."""
    a = [_mp(value) for value in coefficients]
    return a[:1] + [
        mpmath.fsum(comb(n - 1, m - 1) * a[m] for m in range(1, n + 1))
        for n in range(1, len(a))
    ]


def _sum(b: Sequence[mpmath.mpf], x: mpmath.mpf) -> Resummed:
    """Sum Σ b_n x^n to the last term, or to that of x^LAST."""
    b = b[: LAST + 1]
    largest = max(map(abs, b[-WINDOW:]))
    error = max(SAFETY, 2 / (1 - x)) * largest * x ** len(b)  # k = 1/(1 - x)
    value = mpmath.fsum(term * x**n for n, term in enumerate(b))
    return Resummed(value, error, asymptotic=len(b) > LAST)


def _truncated(b: Sequence[mpmath.mpf], x: mpmath.mpf) -> Resummed:
    """Sum Σ b_n x^n up to the first term that is smaller than the next, if there is one."""
    # A later term may be small by chance, next to a change of sign: the first growth decides.
    terms = [term * x**n for n, term in enumerate(b)]
    for n, (term, following) in enumerate(pairwise(map(abs, terms))):
        if 0 < term < following:
            return Resummed(mpmath.fsum(terms[:n]), LEFT_OUT * term, asymptotic=True)
    return _sum(b, x)
