"""Pulses e^{-Z²/4} Σ S_n(Z) t^n: logarithm and exponential, width at half maximum, moments.

A series is the list of its coefficients, polynomials over a ring of python-flint whose first
generator is Z; t is its small parameter. The waves of `lwa.expansion.expand` are such pulses.
`product`, `power` and `logarithm` also take coefficients that are SymPy expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from math import factorial, prod
from typing import Any

from flint import fmpq, fmpq_mpoly
from sympy import factorial2

Series = list[fmpq_mpoly]
"""The coefficients of t^0, t^1, …"""


def last(a: Series, b: Series) -> fmpq_mpoly:
    """Coefficient of t^n in the product of two series, n the last order of the first one."""
    total = 0 * b[0]
    for term, other in zip(a, b[len(a) - 1 :: -1], strict=True):
        if term:
            total = total + term * other
    return total


def log_term(S: Series, log: Series) -> fmpq_mpoly:
    """The next coefficient of log Σ S_n t^n (S_0 = 1), by n log_n = n S_n - Σ j log_j S_{n-j}."""
    n = len(log)
    if n == 0:
        return S[0] - 1
    return S[n] - _weighted(log, S, n - 1, n) / n


def exp_term(log: Series, S: Series) -> fmpq_mpoly:
    """The next coefficient of exp Σ log_n t^n (log_0 = 0), by n S_n = Σ j log_j S_{n-j}."""
    n = len(S)
    if n == 0:
        return log[0] + 1
    return _weighted(log, S, n, n) / n


def _weighted(log: Series, S: Series, end: int, n: int) -> fmpq_mpoly:
    """The sum Σ j log_j S_{n-j}, j = 1 … end, of the coefficients of ln S and of S."""
    total = 0 * log[0]
    for j in range(1, end + 1):
        if log[j]:
            total = total + j * log[j] * S[n - j]
    return total


def logarithm(S: Series) -> Series:
    """The series of log Σ S_n t^n, S_0 = 1."""
    log: Series = []
    for _ in S:
        log.append(log_term(S, log))
    return log


def product(a: Series, b: Series) -> Series:
    """The product of two series, to the length of the first one."""
    return _product(a, b, 1)


def even_product(a: Series, b: Series) -> Series:
    """The even powers of t in the product of two series; the coefficients of odd ones are 0."""
    return _product(a, b, 2)


def _product(a: Series, b: Series, step: int) -> Series:
    """The coefficients of t^0, t^step, … in the product of two series; 0 between them."""
    total = [0 * a[0] for _ in a]
    for n, term in enumerate(a):
        if not term:
            continue
        for m in range(-n % step, len(a) - n, step):
            if b[m]:
                total[n + m] = total[n + m] + term * b[m]
    return total


def power(S: Series, a: fmpq) -> Series:
    """The power (Σ S_n t^n)^a, S_0 = 1, by n R_n = Σ_{j≥1} (a j - (n - j)) S_j R_{n-j}."""
    R = [S[0]]
    for n in range(1, len(S)):  # from S R' = a S' R
        total = 0 * S[0]
        for j in range(1, n + 1):
            total = total + (a * j - (n - j)) * S[j] * R[n - j]
        R.append(total / n)
    return R


def by_degree(polynomial: fmpq_mpoly) -> dict[int, fmpq_mpoly]:
    """Coefficients of Z^d by d."""
    parts: dict[int, dict[tuple[int, ...], Any]] = {}
    for exponents, coefficient in polynomial.terms():
        d, *rest = map(int, exponents)
        parts.setdefault(d, {})[0, *rest] = coefficient
    context = polynomial.context()
    return {d: context.from_dict(part) for d, part in parts.items()}


def moment(polynomial: fmpq_mpoly, variance: int) -> fmpq_mpoly:
    """The mean of a polynomial in Z under the normal distribution: Z^{2m} → (2m-1)!! v^m."""
    total = 0 * polynomial
    for d, coefficient in by_degree(polynomial).items():
        if d % 2 == 0:
            mean = int(factorial2(d - 1)) * variance ** (d // 2)
            total = total + coefficient * mean
    return total


def moments(terms: Iterable[fmpq_mpoly], variance: int) -> Series:
    """The `moment` of each coefficient of a series."""
    return [moment(term, variance) for term in terms]


def half_width(log: Series) -> Series:
    """Coefficients h_n of the width of a pulse e^{-Z²/4 + Σ log_n t^n} at e^{-y²} times its peak.

    The full width is 4y Σ h_n t^n; in the h_n, polynomials in y², Z stands for y. Counted from the
    peak the exponent is -Z²/4 + p(Z), p = O(t), and Z²/4 = y² + p(Z) is solved by Lagrange's
    series::

        Z/2 = y + Σ_{m≥1} 1/m! (d/dy²)^{m-1} p(2y)^m/(2y),

    whose odd part in y is a quarter of the width. Below, the terms of the sum are multiplied by y.
    """
    p = [_reweighted(term, lambda d: fmpq(2) ** d) for term in _from_peak(log)]
    y = p[0].context().gen(0)
    powers = [p]
    while any(powers[-1]):
        powers.append(product(powers[-1], p))
    total = powers[-1]
    for m in range(len(powers) - 1, 0, -1):
        following = []
        for term, own in zip(total, powers[m - 1], strict=True):
            slope = _over_square(y * term.derivative(0) - term, y)  # d/dy² of a/y
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
    return [0 * Z, *(_reweighted(term, lambda d: fmpq(min(d, 1))) for term in phi[1:])]


def _shifted(phi: Series, place: fmpq_mpoly, n: int) -> Series:
    """The series of φ(Z + place · t^n), by Taylor's formula."""
    moved = list(phi)
    derivatives = phi
    for j in range(1, (len(phi) - 1) // n + 1):
        derivatives = [place * term.derivative(0) / j for term in derivatives]
        for m in range(j * n, len(phi)):
            moved[m] = moved[m] + derivatives[m - j * n]
    return moved


def width_of_power(width: Series, epsilon: fmpq_mpoly) -> Series:
    """Width series h_n of the pulse raised to the power 1/(1+ε), at the same height; ε = O(t²).

    Raising the pulse to this power replaces y² by (1+ε) y²: each y^d of 4y Σ h_n t^n becomes
    (1+ε)^{(d+1)/2} y^d.
    """
    new = list(width)
    for n, term in enumerate(width):
        for j in range(1, (len(width) - 1 - n) // 2 + 1):
            part = _reweighted(term, partial(_binomial_of_root, j=j))
            new[n + 2 * j] = new[n + 2 * j] + epsilon**j * part
    return new


def _binomial_of_root(d: int, j: int) -> fmpq:
    """The binomial coefficient "(d+1)/2 choose j"."""
    return fmpq(prod(range(d + 1, d + 1 - 2 * j, -2)), 2**j * factorial(j))


def _over_square(polynomial: fmpq_mpoly, y: fmpq_mpoly) -> fmpq_mpoly:
    """The quotient by y²; python-flint divides no zero polynomial."""
    if not polynomial:
        return polynomial
    return polynomial // y**2


def _reweighted(polynomial: fmpq_mpoly, weight: Callable[[int], fmpq]) -> fmpq_mpoly:
    """Multiply each term c Z^d of a polynomial by weight(d)."""
    terms = {}
    for exponents, coefficient in polynomial.terms():
        factor = weight(int(exponents[0]))
        if factor:
            terms[exponents] = factor * coefficient
    return polynomial.context().from_dict(terms)
