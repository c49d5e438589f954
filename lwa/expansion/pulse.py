"""Pulses ``e^{-Z²/4} Σ S_n(Z) t^n``: logarithm and exponential, width at half maximum, moments.

A series is the list of its coefficients, polynomials over a ring of python-flint whose first
generator is Z; t is its small parameter. The waves of `lwa.expansion.expand` are such pulses.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from flint import fmpq, fmpq_mpoly
from sympy import factorial2

Series = list[fmpq_mpoly]
"""The coefficients of 1, t, t², …"""


def log_term(
    S: Series,
    log: Series,
) -> fmpq_mpoly:
    """The next coefficient of ``log Σ S_n t^n``, where S_0 is 1.

    By ``n log_n = n S_n - Σ j log_j S_{n-j}``.
    """
    n = len(log)
    # At the order of the Gaussian S_0 is 1, and its logarithm S_0 - 1.
    if n == 0:
        return S[0] - 1
    return S[n] - _weighted(log, S, n - 1, n) / n


def exp_term(
    log: Series,
    S: Series,
) -> fmpq_mpoly:
    """The next coefficient of ``exp Σ log_n t^n``, where log_0 is 0.

    By ``n S_n = Σ j log_j S_{n-j}``.
    """
    n = len(S)
    if n == 0:
        return log[0] + 1
    return _weighted(log, S, n, n) / n


def _weighted(
    log: Series,
    S: Series,
    end: int,
    n: int,
) -> fmpq_mpoly:
    """The sum Σ j log_j S_{n-j}, j = 1 … end, of the coefficients of ln S and of S."""
    total = 0 * log[0]
    for j in range(1, end + 1):
        # Equal beads have no odd terms.
        if log[j]:
            total = total + j * log[j] * S[n - j]
    return total


def logarithm(S: Series) -> Series:
    """The series of ``log Σ S_n t^n``, where S_0 is 1."""
    log: Series = []
    for _ in S:
        log.append(log_term(S, log))
    return log


def product(
    a: Series,
    b: Series,
) -> Series:
    """The product of two series, to the length of the first one."""
    total = [0 * a[0] for _ in a]
    for n, term in enumerate(a):
        if not term:
            continue
        for m in range(len(a) - n):
            if b[m]:
                total[n + m] = total[n + m] + term * b[m]
    return total


def power(
    S: Series,
    a: fmpq,
) -> Series:
    """The power ``(Σ S_n t^n)^a``, where S_0 is 1, by the logarithm."""
    log = [a * term for term in logarithm(S)]
    R: Series = []
    for _ in S:
        R.append(exp_term(log, R))
    return R


def by_degree(polynomial: fmpq_mpoly) -> dict[int, fmpq_mpoly]:
    """Coefficients of the powers of Z, by the exponent."""
    parts: dict[int, dict[tuple[int, ...], Any]] = {}
    for exponents, coefficient in polynomial.terms():
        d, *rest = map(int, exponents)
        part = parts.setdefault(d, {})
        part[0, *rest] = coefficient
    context = polynomial.context()
    return {d: context.from_dict(part) for d, part in parts.items()}


def moments(
    series: Series,
    variance: int,
) -> Series:
    """The means of the coefficients of a series under the normal distribution of Z."""
    means = []
    for polynomial in series:
        total = 0 * polynomial
        for d, coefficient in by_degree(polynomial).items():
            # The mean of Z^{2m} is (2m - 1)!! v^m, and odd powers have none.
            if d % 2 == 0:
                mean = int(factorial2(d - 1)) * variance ** (d // 2)
                total = total + coefficient * mean
        means.append(total)
    return means


def half_width(log: Series) -> Series:
    """Coefficients h_n of the width of a pulse ``e^{-Z²/4 + Σ log_n t^n}``.

    The full width at ``e^{-y²}`` of the peak is ``4y Σ h_n t^n``; in the h_n, polynomials in y², Z
    stands for y. Counted from the peak the exponent is ``-Z²/4 + p(Z)``, p small with t, and the
    equation ``Z²/4 = y² + p(Z)`` is solved by Lagrange's series::

        Z/2 = y + Σ_{m≥1} 1/m! (d/dy²)^{m-1} p(2y)^m/(2y),

    whose odd part in y is a quarter of the width.
    """
    # p(2y): the coefficient of Z^d is multiplied by 2^d
    p = [_reweighted(term, lambda d: fmpq(2) ** d) for term in _from_peak(log)]
    y = p[0].context().gen(0)
    powers = [p]
    while any(powers[-1]):
        powers.append(product(powers[-1], p))
    # The sum over m by Horner's rule, times y, so that no odd powers of 1/y appear.
    total = powers[-1]
    for m in range(len(powers) - 1, 0, -1):
        following = []
        for term, own in zip(total, powers[m - 1], strict=True):
            # d/dy² of a/y is (y a' - a)/(2 y³)
            slope = _over_square(y * term.derivative(0) - term, y)
            following.append(own / 2 + slope / (2 * m + 2))
        total = following
    even = [_reweighted(term, lambda d: fmpq(1 - d % 2)) for term in total]
    width = [_over_square(term, y) for term in even]
    width[0] = width[0] + 1
    return width


def _from_peak(log: Series) -> Series:
    """Shift -Z²/4 + Σ log_n t^n to its maximum; without -Z²/4 and the value there.

    The place of the maximum is moved to 0 order by order, Z → Z + z_n t^n.
    """
    Z = log[0].context().gen(0)
    phi = [log[0] - Z**2 / 4, *log[1:]]
    for n in range(1, len(phi)):
        # -Z²/4 + a Z t^n has its maximum at Z = 2a t^n, to this order.
        place = 2 * by_degree(phi[n]).get(1, 0 * Z)
        if place:
            phi = _shifted(phi, place, n)
    if phi[0] != -(Z**2) / 4:
        raise ArithmeticError("the pulse has no quadratic maximum")
    # The constants of Z^0 are the logarithm of the peak.
    return [0 * Z, *(_reweighted(term, lambda d: fmpq(min(d, 1))) for term in phi[1:])]


def _shifted(
    phi: Series,
    place: fmpq_mpoly,
    n: int,
) -> Series:
    """The series of φ(Z + place · t^n), by Taylor's formula."""
    moved = list(phi)
    derivatives = phi
    for j in range(1, (len(phi) - 1) // n + 1):
        derivatives = [place * term.derivative(0) / j for term in derivatives]
        for m in range(j * n, len(phi)):
            moved[m] = moved[m] + derivatives[m - j * n]
    return moved


def _over_square(
    polynomial: fmpq_mpoly,
    y: fmpq_mpoly,
) -> fmpq_mpoly:
    """The quotient by y²; python-flint divides no zero polynomial."""
    if not polynomial:
        return polynomial
    return polynomial // y**2


def _reweighted(
    polynomial: fmpq_mpoly,
    weight: Callable[[int], fmpq],
) -> fmpq_mpoly:
    """Multiply each term c Z^d of a polynomial by weight(d)."""
    terms = {}
    for exponents, coefficient in polynomial.terms():
        factor = weight(int(exponents[0]))
        if factor:
            terms[exponents] = factor * coefficient
    return polynomial.context().from_dict(terms)
