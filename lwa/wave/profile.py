"""The profile of a wave on a background to many digits: one quadrature, by mpmath.

With v = B / cosh²θ the equation of `lwa.wave.background` is

    dξ/dθ = 2 √(I F′(p0+v) tanh²θ / (Q(B) - Q(v))),

for a power law regular as far as π/2 from the real axis at any load.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath
import sympy as sp
from mpmath.calculus.quadrature import GaussLegendre

from lwa.base.exact import InputError, evaluated, shorten

Function = Callable[[Any], Any]

_GAUSS = GaussLegendre(mpmath.mp)

_MOST_PRECISION = 20_000
"""Working digits beyond which a difference is not followed."""

_RULES = ((-1, 0), (0, 0), (0, 4), (1, 8), (1, 20), (2, 40), (2, 80))
"""Degrees of Gauss's rule beyond the usual one, and halvings of the piece next to θ = 0."""


def mpmath_number(value: sp.Expr) -> Any:
    """An exact number in mpmath's working precision."""
    return mpmath.mpf(evaluated(value, mpmath.mp.dps + 5))


@dataclass(frozen=True)
class Strains:
    """F, F′ and Q as expressions in v, the strain above a background, for any number of digits."""

    v: sp.Symbol
    force: sp.Expr
    slope: sp.Expr
    stiffness: sp.Expr

    @cached_property
    def _compiled(self) -> list[tuple[Function, list[sp.Rational]]]:
        """Compile F, F′ and Q to functions f(v, *fractions); return each with its fractions.

        The fractions in F, F′ and Q are arguments, so that any working precision gets them exact.
        """
        found = []
        for value in (self.force, self.slope, self.stiffness):
            numbers = {a: sp.Dummy() for a in value.atoms(sp.Rational) if not a.is_Integer}
            function = sp.lambdify((self.v, *numbers.values()), value.xreplace(numbers), "mpmath")
            found.append((function, list(numbers)))
        return found

    def functions(self) -> list[Function]:
        """F, F′ and Q as functions of v in mpmath's working precision, NaN at a pole."""
        return [
            _at_poles_too(function, [mpmath.mpf(int(a.p)) / int(a.q) for a in numbers])
            for function, numbers in self._compiled
        ]

    def precision(self, B: sp.Expr, digits: int) -> int:
        """Working digits with which Q(B) - Q(v) keeps twice the digits of the result.

        Twice as many, because the difference falls as θ² towards the peak. The number of digits
        that the terms of Q cancel is measured: doubling the working digits must not change the
        difference.
        """
        working, before = 2 * digits + 15, mpmath.inf
        while working < _MOST_PRECISION:
            with mpmath.workdps(working):
                Q, number = self.functions()[2], mpmath_number(B)
                found = Q(number) - Q(number / 2)
                if 0 != abs(found) * mpmath.mpf(10) ** (-2 * digits) >= abs(found - before):
                    return working // 2
            working, before = 2 * working, found
        raise InputError(f"B is {shorten(B)}: too small beside p0, use `kdv`")


def _at_poles_too(function: Callable[..., Any], numbers: list[Any]) -> Function:
    def value(v: Any) -> Any:
        try:
            return function(v, *numbers)
        except ZeroDivisionError:
            return mpmath.nan

    return value


@dataclass(frozen=True)
class Profile:
    """A wave of the rise B to the given digits, in mpmath's larger working precision.

    force, slope and stiffness are F, F′ and Q at the strain v above the background.
    """

    B: Any
    I: Any
    digits: int
    force: Function
    slope: Function
    stiffness: Function

    @cached_property
    def _top(self) -> Any:
        return self.stiffness(self.B)

    def rate(self, theta: Any) -> Any:
        """The rate dξ/dθ, θ > 0."""
        v = self.strain(theta)
        gap = self._top - self.stiffness(v)
        return 2 * mpmath.tanh(theta) * mpmath.sqrt(self.I * self.slope(v) / gap)

    def strain(self, theta: Any) -> Any:
        """The strain v(θ) above the background."""
        return self.B / mpmath.cosh(theta) ** 2

    def place(self, theta: Any) -> Any:
        """The place ξ(θ)."""
        pieces = max(1, int(mpmath.ceil(theta)))
        return self._integral(mpmath.linspace(0, theta, pieces + 1))

    def half(self, quantity: str) -> Any:
        """The θ at which the quantity has half of its rise."""
        if quantity != "force":
            return mpmath.acosh(mpmath.sqrt(2))
        rise = self.force(self.B) - self.force(mpmath.mpf(0))

        def above_half(share: Any) -> Any:
            return (self.force(share * self.B) - self.force(mpmath.mpf(0))) / rise - mpmath.mpf(0.5)

        return mpmath.acosh(1 / mpmath.sqrt(self._root(above_half, 0, 1)))

    def theta(self, place: Any) -> Any:
        """The θ at a place ξ > 0."""
        start, here = mpmath.mpf(0), mpmath.mpf(0)
        while here + (step := self._integral([start, start + 1])) < place:
            start, here = start + 1, here + step
            if start > 3 * mpmath.mp.dps:  # v is zero to all digits there
                return start

        def passed(theta: Any) -> Any:
            more = self._integral([start, theta]) if theta > start else 0
            return (here + more - place) / step

        return self._root(passed, start, start + 1)

    def _root(self, function: Function, low: Any, high: Any) -> Any:
        """The root of a growing function, of order 1 in size, between two places."""
        accuracy = mpmath.mpf(10) ** (-self.digits - 5)
        bracket = (mpmath.mpf(low), mpmath.mpf(high))
        return mpmath.findroot(function, bracket, solver="anderson", tol=accuracy, verify=False)

    def _integral(self, points: list[Any]) -> Any:
        """The integral ∫ dξ by Gauss's rule on each piece, refined until the digits converge.

        Under a power with small k, n points err by 6^{-2n} on a piece of length 1, and degree d has
        n = 3·2^{d-1}. Steep laws, and waves next to their limiting amplitude, vary fast at θ = 0.
        Nodes and weights need the digits only; the working digits are for the integrand.
        """
        precision = int(3.33 * self.digits) + 40  # bits: log2(10) = 3.32…, and 40 more
        usual = 4 + max(0, math.ceil(math.log2((self.digits + 5) / 36)))
        found = mpmath.mpf(0)
        for more, halvings in _RULES:
            first = points[0] + (points[1] - points[0]) * mpmath.mpf(2) ** -halvings
            graded = [first * 2**i for i in range(halvings)] if not points[0] else []
            pieces = pairwise([points[0], *graded, *points[1:]])
            nodes = (_GAUSS.get_nodes(a, b, usual + more, precision) for a, b in pieces)
            before = found
            found = mpmath.fdot((w, self.rate(theta)) for piece in nodes for theta, w in piece)
            if abs(found - before) <= abs(found) * mpmath.mpf(10) ** (-self.digits - 3):
                break
        return found
