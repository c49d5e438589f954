"""Pulses ``e^{-Z²/4} Σ S_n(Z) t^n``: logarithm and exponential, width at half maximum, moments.

A series is the list of its coefficients, polynomials over a ring of python-flint whose first
generator is Z; t is its small parameter. The waves of `lwa.expansion.expand` are such pulses.
"""

from __future__ import annotations

from typing import Any

from flint import fmpq, fmpq_mpoly
from sympy import factorial2

Series = list[fmpq_mpoly]
"""The coefficients of 1, t, t², …"""


def log_term(S: Series, log: Series) -> fmpq_mpoly:
    """The next coefficient of ``log Σ S_n t^n``, where S_0 is 1."""
    n = len(log)
    return S[n] - _products(log, S, n)


def exp_term(log: Series, S: Series) -> fmpq_mpoly:
    """The next coefficient of ``exp Σ log_n t^n``, where log_0 is 0."""
    # S_n is log_n and products of earlier coefficients.
    n = len(S)
    return log[n] + _products(log, S, n)


def _products(log: Series, S: Series, n: int) -> fmpq_mpoly | int:
    """The sum ``Σ j log_j S_{n-j} / n``, 0 < j < n, which is the difference ``S_n - log_n``.

    The coefficients of a series and of its logarithm are related by ``S′ = S (log S)′``.
    """
    # At the order of the Gaussian S_0 is 1, and its logarithm S_0 - 1.
    if n == 0:
        return 1
    total = 0 * S[0]
    for j in range(1, n):
        # Equal beads have no odd terms.
        if log[j]:
            total = total + j * log[j] * S[n - j]
    return total / n


def logarithm(S: Series) -> Series:
    """The series of ``log Σ S_n t^n``, where S_0 is 1."""
    log: Series = []
    for _ in S:
        log.append(log_term(S, log))
    return log


def product(a: Series, b: Series) -> Series:
    """The product of two series, to the length of the first one."""
    total = [0 * a[0] for _ in a]
    for n, term in enumerate(a):
        if not term:
            continue
        for m in range(len(a) - n):
            if b[m]:
                total[n + m] = total[n + m] + term * b[m]
    return total


def power(S: Series, a: fmpq) -> Series:
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


def moments(series: Series, variance: int) -> Series:
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


def full_width(log: Series) -> Series:
    """Coefficients h_n of the full width of a pulse ``e^{-Z²/4 + Σ log_n t^n}``, where log_0 is 0.

    The full width at ``e^{-y²}`` of the peak is ``4y Σ h_n t^n``, so that h_0 is 1; the h_n are
    polynomials in y², in which Z stands for y. Order by order the place becomes a function of a
    coordinate z in which the exponent, counted from the peak, is ``-z²/4``. The pulse falls to
    ``e^{-y²}`` at ``z = ±2y``, and the width is the difference of these two places.
    """
    Z = log[0].context().gen(0)
    exponent = [-(Z**2) / 4, *log[1:]]
    place = [Z, *(0 * Z for _ in log[1:])]
    for n in range(1, len(log)):
        # python-flint divides no zero polynomial.
        if not exponent[n]:
            continue
        # z → z + a t^n adds -z a/2 at t^n; what does not vanish at z = 0 is the height of the peak.
        a = 2 * (exponent[n] // Z)
        exponent = _moved(exponent, a, n)
        place = _moved(place, a, n)
    width = []
    for term in place:
        total = 0 * Z
        for d, coefficient in by_degree(term).items():
            # (2y)^d - (-2y)^d over 4y
            if d % 2:
                total = total + coefficient * (2 * Z) ** (d - 1)
        width.append(total)
    return width


def _moved(S: Series, a: fmpq_mpoly, n: int) -> Series:
    """The series at Z + a t^n in place of Z, a a polynomial in Z, by Taylor's formula."""
    moved = list(S)
    derivatives = S
    # The j-th derivative stands at t^{jn}; powers beyond the series are left out.
    for j in range(1, (len(S) - 1) // n + 1):
        derivatives = [term.derivative(0) / j for term in derivatives]
        for m in range(j * n, len(S)):
            moved[m] = moved[m] + a**j * derivatives[m - j * n]
    return moved
