"""Pulses e^{-Z²/4} Σ S_n(Z) t^n: logarithm and exponential, width at half maximum, moments.

A series is the list of its coefficients, polynomials over a ring of python-flint whose first
generator is Z; t is its small parameter. The waves of `lwa.expansion.expand` are such pulses.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import factorial, prod
from typing import Any

from flint import fmpq, fmpq_mpoly
from sympy import factorial2

Series = list[fmpq_mpoly]
"""The coefficients of t^0, t^1, …"""


def log_term(S: Series, log: Series) -> fmpq_mpoly:
    """The next coefficient of log Σ S_n t^n (S_0 = 1), by n log_n = n S_n - Σ j log_j S_{n-j}."""
    n = len(log)
    if n == 0:
        return S[0] - 1
    return S[n] - _weighted(log, S, n - 1, n) / n


def exp_term(log: Series, S: Series) -> fmpq_mpoly:
    """The next coefficient of exp Σ log_n t^n (log_0 = 0), by n S_n = Σ j log_j S_{n-j}."""
    n = len(S)
    return _weighted(log, S, n, n) / n if n else log[0] + 1


def _weighted(log: Series, S: Series, last: int, n: int) -> fmpq_mpoly:
    """The sum Σ j log_j S_{n-j}, j = 1 … last, of the coefficients of ln S and of S."""
    return sum(
        (j * log[j] * S[n - j] for j in range(1, last + 1) if log[j]), 0 * log[0]
    )


def logarithm(S: Series) -> Series:
    """The series of log Σ S_n t^n, S_0 = 1."""
    log: Series = []
    for _ in S:
        log.append(log_term(S, log))
    return log


def by_degree(polynomial: fmpq_mpoly) -> dict[int, fmpq_mpoly]:
    """Coefficients of Z^d by d."""
    parts: dict[int, dict[tuple[int, ...], Any]] = {}
    for exponents, coefficient in polynomial.terms():
        d, *rest = map(int, exponents)
        parts.setdefault(d, {})[0, *rest] = coefficient
    return {d: polynomial.context().from_dict(part) for d, part in parts.items()}


def moment(polynomial: fmpq_mpoly, variance: int) -> fmpq_mpoly:
    """The mean of a polynomial in Z under the normal distribution: Z^{2m} → (2m-1)!! v^m."""
    even = ((d, c) for d, c in by_degree(polynomial).items() if d % 2 == 0)
    means = (c * int(factorial2(d - 1)) * variance ** (d // 2) for d, c in even)
    return sum(means, 0 * polynomial)


def half_width(log: Series) -> Series:
    """Coefficients h_n of the width of a pulse e^{-Z²/4 + Σ log_n t^n} at e^{-y²} times its peak.

    The full width is 4y Σ h_n t^n; in the h_n, polynomials in y², Z stands for y. Counted from the
    peak the exponent is -Z²/4 + p(Z), p = O(t), and Z²/4 = y² + p(Z) is solved by Lagrange's series

        Z/2 = y + Σ_{m≥1} 1/m! (d/dy²)^{m-1} p(2y)^m/(2y),

    whose odd part in y is a quarter of the width. Below, the terms of the sum are multiplied by y.
    """
    p = [_reweighted(term, lambda d: fmpq(2) ** d) for term in _from_peak(log)]
    y = p[0].context().gen(0)
    powers = [p]
    while any(powers[-1]):
        powers.append(product(powers[-1], p))
    total = powers[-1]
    for m in range(len(powers) - 1, 0, -1):  # d/dy² of a/y is (y a' - a)/(2y³)
        slopes = [_over_square(y * a.derivative(0) - a, y) / (2 * m + 2) for a in total]
        total = [b / 2 + slope for b, slope in zip(powers[m - 1], slopes, strict=True)]
    even = [_over_square(_reweighted(a, lambda d: fmpq(1 - d % 2)), y) for a in total]
    return [even[0] + 1, *even[1:]]


def _from_peak(log: Series) -> Series:
    """Shift -Z²/4 + Σ log_n t^n to its maximum; without -Z²/4 and the value there.

    The place of the maximum is moved to 0 order by order, Z → Z + z_n t^n.
    """
    Z = log[0].context().gen(0)
    phi = [log[0] - Z**2 / 4, *log[1:]]
    for n in range(1, len(phi)):
        # -Z²/4 + a Z t^n has its maximum at Z = 2a t^n, to this order.
        if place := 2 * by_degree(phi[n]).get(1, 0 * Z):
            moved, derivatives = list(phi), phi
            for j in range(
                1, (len(phi) - 1) // n + 1
            ):  # Taylor's series in place · t^n
                derivatives = [place * term.derivative(0) / j for term in derivatives]
                for m in range(j * n, len(phi)):
                    moved[m] = moved[m] + derivatives[m - j * n]
            phi = moved
    if phi[0] != -(Z**2) / 4:
        raise ArithmeticError("the pulse has no quadratic maximum")
    return [0 * Z, *(_reweighted(term, lambda d: fmpq(min(d, 1))) for term in phi[1:])]


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
    return polynomial // y**2 if polynomial else polynomial


def _reweighted(polynomial: fmpq_mpoly, weight: Callable[[int], fmpq]) -> fmpq_mpoly:
    """Multiply each term c Z^d of a polynomial by weight(d)."""
    terms = {
        exponents: factor * coefficient
        for exponents, coefficient in polynomial.terms()
        if (factor := weight(int(exponents[0])))
    }
    return polynomial.context().from_dict(terms)


def product(a: Series, b: Series, step: int = 1) -> Series:
    """The product a · b to the same length; only terms t^n with n a multiple of ``step``."""
    total = [0 * a[0] for _ in a]
    for n, x in enumerate(a):
        if x:
            for m in range(-n % step, len(a) - n, step):
                if b[m]:
                    total[n + m] = total[n + m] + x * b[m]
    return total


def power(S: Series, a: fmpq) -> Series:
    """The power (Σ S_n t^n)^a, S_0 = 1, by n R_n = Σ_{j≥1} (a j - (n - j)) S_j R_{n-j}."""
    R = [S[0]]
    for n in range(1, len(S)):  # from S R' = a S' R
        terms = ((a * j - (n - j)) * S[j] * R[n - j] for j in range(1, n + 1))
        R.append(sum(terms, 0 * S[0]) / n)
    return R
