"""Pulses e^{-Z²/4} Σ S_n(Z) t^n: logarithm and exponential, width at half maximum, moments.

A series is the list of its coefficients, polynomials over a ring of python-flint whose first
generator is Z; t is its small parameter. The waves of `lwa.expansion` are such pulses.
"""

from __future__ import annotations

from typing import Any

from flint import fmpq_mpoly
from sympy import factorial2

Series = list[fmpq_mpoly]
"""The coefficients of t^0, t^1, …"""


def log_term(S: Series, log: Series) -> fmpq_mpoly:
    """The next coefficient of log Σ S_n t^n (S_0 = 1), by n log_n = n S_n - Σ j log_j S_{n-j}."""
    n = len(log)
    if n == 0:
        return S[0] - 1
    total = n * S[n]
    for j in range(1, n):
        total = total - j * log[j] * S[n - j]
    return total / n


def exp_term(log: Series, S: Series) -> fmpq_mpoly:
    """The next coefficient of exp Σ log_n t^n (log_0 = 0), by n S_n = Σ j log_j S_{n-j}."""
    n = len(S)
    if n == 0:
        return log[0] + 1
    total = 0 * log[0]
    for j in range(1, n + 1):
        total = total + j * log[j] * S[n - j]
    return total / n


def by_degree(polynomial: fmpq_mpoly) -> dict[int, fmpq_mpoly]:
    """d → the coefficient of Z^d."""
    parts: dict[int, dict[tuple[int, ...], Any]] = {}
    for exponents, coefficient in polynomial.terms():
        d, *rest = map(int, exponents)
        parts.setdefault(d, {})[0, *rest] = coefficient
    return {d: polynomial.context().from_dict(part) for d, part in parts.items()}


def moment(polynomial: fmpq_mpoly, variance: int) -> fmpq_mpoly:
    """The mean of a polynomial in Z under the normal distribution: Z^{2m} → (2m-1)!! v^m."""
    return sum(
        (
            c * int(factorial2(d - 1)) * variance ** (d // 2)
            for d, c in by_degree(polynomial).items()
            if d % 2 == 0
        ),
        0 * polynomial,
    )


def half_width(log: Series) -> Series:
    """The h_n of the full width 4y Σ h_n t^n at half maximum of e^{-Z²/4 + Σ log_n t^n}.

    y² = log 2, and in the result, polynomials in y², Z stands for y. With φ the exponent and ζ the
    place of its maximum, φ(Z) = φ(ζ) - y² has the solutions Z(±y), Z a series in t and y that
    starts with 2y; the width is twice its odd part in y.
    """
    y = log[0].context().gen(0)
    zero = 0 * y
    slopes = [by_degree(2 * term.derivative(0)) for term in log]
    terms = [by_degree(term) for term in log]
    peak, place = _Point([zero]), _Point([2 * y])
    for n in range(1, len(log)):
        peak.append(peak.value(slopes, n))  # ζ = 2 Σ log_n'(ζ) t^n
    for n in range(1, len(log)):
        top = peak.value(terms, n) - peak.power(2, n) / 4
        place.append(zero)
        rest = place.value(terms, n) - place.power(2, n) / 4 - top
        quotient, remainder = divmod(rest, y)
        if remainder:
            raise ArithmeticError("the pulse has no quadratic maximum")
        place.pop()
        place.append(quotient)
    odd = [{d - 1: c for d, c in by_degree(z).items() if d % 2} for z in place.z]
    return [sum((c * y**d for d, c in part.items()), zero) / 2 for part in odd]


class _Point:
    """A place Z = Σ z_n t^n, with the powers of it that polynomials in Z want."""

    def __init__(self, z: Series) -> None:
        self.z = z
        self._powers: dict[tuple[int, int], fmpq_mpoly] = {}

    def append(self, z: fmpq_mpoly) -> None:
        self.z.append(z)

    def pop(self) -> None:
        self.z.pop()
        last = len(self.z)
        self._powers = {key: p for key, p in self._powers.items() if key[1] < last}

    def power(self, d: int, n: int) -> fmpq_mpoly:
        """The coefficient of t^n in Z^d."""
        if d == 0:
            return self.z[0] ** 0 if n == 0 else 0 * self.z[0]
        if d == 1:
            return self.z[n]
        if (d, n) not in self._powers:
            total = 0 * self.z[0]
            for j in range(n + 1):
                if self.z[j]:
                    total = total + self.z[j] * self.power(d - 1, n - j)
            self._powers[d, n] = total
        return self._powers[d, n]

    def value(self, terms: list[dict[int, fmpq_mpoly]], n: int) -> fmpq_mpoly:
        """The coefficient of t^n in Σ_{m≥1} t^m p_m(Z), p_m as `by_degree` gives it."""
        total = 0 * self.z[0]
        for m in range(1, n + 1):
            for d, c in terms[m].items():
                total = total + c * self.power(d, n - m)
        return total


def root(S: Series) -> Series:
    """√(Σ S_n t^n), S_0 = 1, by 2 n R_n = Σ_{j≥1} (3j - 2n) S_j R_{n-j}."""
    R = [S[0]]
    for n in range(1, len(S)):
        total = 0 * S[0]
        for j in range(1, n + 1):
            total = total + (3 * j - 2 * n) * S[j] * R[n - j]
        R.append(total / (2 * n))
    return R
