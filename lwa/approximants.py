"""Series in ε = k - 1 summed at a given k: Padé approximants, with an estimate of their error.

Of a series known to ε^N the approximants [n-m/m], m about n/2, of every n ≤ N are formed; one with
a pole on or near 0 … 3ε/2 is spurious and left out (Baker & Graves-Morris, *Padé Approximants*,
1996, section 2.2). Neighbours agree by chance now and then, so the error is not their difference
but the largest difference within `WINDOW` orders; the order before which it is least is taken.

The chain of equal beads has a series that sums well. What unlike beads add to it is summed apart:
close to equal masses its terms grow from the first on. Where no approximant is free of poles, the
sum ends before its least term and the error is that term: the series is only asymptotic there, as
it is where later windows spread more. What radiation costs (`lwa.radiation`) comes on top.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import sympy as sp

from lwa.cell import exponent
from lwa.exact import InputError
from lwa.radiation import Radiation

WINDOW = 3
"""Orders of ε that a window holds before its last one."""

SAFETY = 2
"""Error estimate over the spread of a window."""

DIGITS = 60
"""With which approximants are computed; their linear systems lose some."""


@dataclass(frozen=True)
class Resummed:
    """A series summed at one k.

    value, error : the sum, and the estimate of its absolute error.
    order : of ε, up to which the series was of use.
    asymptotic : whether higher orders cannot make it better: they grow, or radiation is larger.
    """

    value: float
    error: float
    order: int
    asymptotic: bool


@dataclass(frozen=True)
class EpsilonSeries:
    """prefactor · ε^power · Σ coefficients[n] ε^n, exact.

    uniform : the coefficients of the chain of equal beads, which `at` sums apart.
    radiation : what `at` adds to the error; None for symbolic cells and equal beads.
    """

    prefactor: sp.Expr
    power: sp.Expr
    coefficients: tuple[sp.Expr, ...]
    uniform: tuple[sp.Expr, ...] = ()
    radiation: Radiation | None = None

    def partial_sum(self, k: Any, order: int | None = None) -> sp.Expr:
        """The series to ε^order at k (a number or a symbol)."""
        epsilon = exponent(k) - 1
        terms = self.coefficients if order is None else self.coefficients[: order + 1]
        total = sp.Add(*(a * epsilon**n for n, a in enumerate(terms)))
        return self.prefactor * epsilon**self.power * total

    def pade(self, k: Any, numerator: int, denominator: int) -> sp.Expr:
        """The approximant [numerator/denominator] in ε, exact, for k a number or a symbol.

        Raises `lwa.InputError` where the series is too short, or has none.

        >>> a = EpsilonSeries(sp.S.One, sp.S.Zero, (sp.S.One, -sp.S.Half, sp.Rational(2, 5)))
        >>> a.pade("k", 1, 1)
        (3*k + 7)/(2*(4*k + 1))
        """
        L, M = numerator, denominator
        a = self.coefficients
        if min(L, M) < 0 or len(a) <= L + M:
            raise InputError(f"[{L}/{M}] is wanted of a series to order {len(a) - 1}")
        system = sp.Matrix(M, M, lambda i, j: a[L + i - j] if L + i >= j else sp.S.Zero)
        right = sp.Matrix(M, 1, lambda i, _: -a[L + i + 1])
        if M and sp.simplify(system.det()) == 0:
            raise InputError(f"[{L}/{M}] does not exist for this series")
        q = [sp.S.One, *(system.LUsolve(right) if M else [])]
        p = [sp.Add(*(q[j] * a[i - j] for j in range(min(i, M) + 1))) for i in range(L + 1)]
        epsilon = exponent(k) - 1
        above, below = (sp.Add(*(x * epsilon**n for n, x in enumerate(row))) for row in (p, q))
        return self.prefactor * epsilon**self.power * sp.factor(above / below)

    def at(self, k: Any) -> Resummed:
        """The sum at a number k > 1, with an estimate of its error.

        Raises `lwa.InputError` when k or the cell holds symbols, or k ≤ 1.
        """
        k = exponent(k)
        symbols = k.free_symbols.union(
            self.prefactor.free_symbols, *(a.free_symbols for a in self.coefficients)
        )
        if symbols:
            raise InputError(f"{min(map(str, symbols))!r} has no value: a sum needs numbers")
        if k <= 1:
            raise InputError(f"k is {k}: the expansion in k - 1 is summed for k > 1")
        with mpmath.workdps(DIGITS):
            epsilon = _mp(k) - 1
            unit = _mp(self.prefactor) * epsilon ** _mp(self.power)
            whole = [_mp(a) for a in self.coefficients]
            base = [_mp(a) for a in self.uniform] if self.uniform else whole
            rest = [a - b for a, b in zip(whole, base, strict=True)]
            sums = [_sum(base, epsilon)]
            if any(rest):
                sums.append(_sum(rest[1:], epsilon).times(epsilon))
            value = unit * mpmath.fsum(s.value for s in sums)
            error = abs(unit) * mpmath.fsum(s.error for s in sums)
            radiated = self.radiation.relative(float(k)) if self.radiation else 0.0
            least = abs(value) * mpmath.mpf(2) ** -52
            return Resummed(
                float(value),
                float(error + abs(value) * radiated + least),
                min(s.order for s in sums),
                any(s.asymptotic for s in sums) or bool(abs(value) * radiated > error),
            )


@dataclass(frozen=True)
class _Sum:
    """As `Resummed`, in mpmath's numbers."""

    value: mpmath.mpf
    error: mpmath.mpf
    order: int
    asymptotic: bool

    def times(self, epsilon: mpmath.mpf) -> _Sum:
        """Of a series over ε."""
        return _Sum(epsilon * self.value, epsilon * self.error, self.order + 1, self.asymptotic)


def _mp(value: sp.Expr) -> mpmath.mpf:
    if value.is_Rational:
        return mpmath.mpf(int(value.p)) / int(value.q)
    return mpmath.mpf(value.evalf(DIGITS)._mpf_)


def _sum(a: Sequence[mpmath.mpf], epsilon: mpmath.mpf) -> _Sum:
    """The approximants of the window that agree best."""
    line = {n: found for n in range(len(a)) if (found := _approximants(a[: n + 1], epsilon))}
    spreads: dict[int, mpmath.mpf] = {}
    for n in line:
        window = [value for m in range(n - WINDOW, n + 1) for value in line.get(m, [])]
        if n >= min(WINDOW, len(a) - 1) and len(window) > min(WINDOW, n):
            spreads[n] = max(window) - min(window)
    if not spreads:
        return _truncated(a, epsilon)
    best = min(spreads, key=lambda n: (spreads[n], n))
    last = max(spreads)
    grows = last < len(a) - 1 or spreads[last] > 10 * spreads[best]
    return _Sum(line[best][0], SAFETY * spreads[best], best, bool(grows))


def _truncated(a: Sequence[mpmath.mpf], epsilon: mpmath.mpf) -> _Sum:
    """The sum before the least term; all of it where the terms fall to the last."""
    terms = [x * epsilon**n for n, x in enumerate(a)]
    least = min((n for n, term in enumerate(terms) if term), key=lambda n: abs(terms[n]))
    grows = least < len(terms) - 1
    end = least if grows else least + 1
    return _Sum(mpmath.fsum(terms[:end]), abs(terms[least]), end - 1, grows)


def _approximants(a: Sequence[mpmath.mpf], epsilon: mpmath.mpf) -> list[mpmath.mpf]:
    """The diagonal approximant of these terms first, then its neighbours; the low partial sums."""
    n = len(a) - 1
    half = n // 2
    found = [
        value
        for M in dict.fromkeys((half, n - half, half + (n % 2 == 0 and n > 2)))
        if M and (value := _pade(a, n - M, M, epsilon)) is not None
    ]
    return ([mpmath.polyval(a[::-1], epsilon)] if n < 2 else []) + found


def _pade(a: Sequence[mpmath.mpf], L: int, M: int, epsilon: mpmath.mpf) -> mpmath.mpf | None:
    """[L/M] at ε; None where it does not exist or has a pole near 0 … 3ε/2."""
    import numpy as np

    try:
        p, q = mpmath.pade(list(a), L, M)
    except ZeroDivisionError:
        return None
    scaled = [float(x * epsilon**n) for n, x in enumerate(q)]
    if not np.all(np.isfinite(scaled)):
        return None
    poles = np.roots(np.trim_zeros(scaled[::-1], "f"))  # in units of ε
    near = np.abs(poles - np.clip(poles.real, 0.0, 1.5))
    if np.any(near < 0.25):
        return None
    return mpmath.polyval(p[::-1], epsilon) / mpmath.polyval(q[::-1], epsilon)
