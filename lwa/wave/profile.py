"""The profile of a wave on a background to many digits: one quadrature, by mpmath.

With v = B / cosh²θ the equation of `lwa.wave.background`, which defines the letters, is

    dξ/dθ = 2 √(I F′(p0+v) tanh²θ / (Q(B) - Q(v))),

for a power law regular as far as π/2 from the real axis at any load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath
import sympy as sp

from lwa.base.exact import InputError, evaluated, shorten

Function = Callable[[Any], Any]

_MOST_DIGITS = 20_000  # working digits beyond which a difference is not followed
_HALVINGS = (0, 8, 20, 40, 80)  # of the piece next to θ = 0, until its integral converges


def mpmath_number(value: sp.Expr) -> Any:
    """Evaluate an exact number in mpmath's working precision."""
    return mpmath.mpf(evaluated(value, mpmath.mp.dps + 5))


def compiled(v: sp.Symbol, value: sp.Expr) -> Function:
    """Compile an expression in v to a function in mpmath's working precision, NaN at a pole."""
    function = sp.lambdify(v, value, "mpmath")  # fractions are divided when the function is called

    def at(v: Any) -> Any:
        try:
            return function(v)
        except ZeroDivisionError:
            return mpmath.nan

    return at


@dataclass(frozen=True)
class Flank:
    """The half of a symmetric wave from its peak, v = B, to the background, v = 0, to many digits.

    F, F1, Q : force, slope F′ and Q as functions of v, the strain above p0. digits : of results.
    """

    F: Function
    F1: Function
    Q: Function
    B: sp.Expr
    I: sp.Expr
    digits: int

    @cached_property
    def working_digits(self) -> int:
        """Working digits with which Q(B) - Q(v) has twice the digits of the result.

        Twice as many, because the difference falls as θ² towards the peak. The number of digits
        that the terms of Q cancel is measured: doubling the working digits must not change the
        difference. Raises `lwa.InputError` where too many cancel.
        """
        working, before = 2 * self.digits + 15, mpmath.inf
        while working < _MOST_DIGITS:
            with mpmath.workdps(working):
                B = mpmath_number(self.B)
                difference = self.Q(B) - self.Q(B / 2)
                bound = abs(difference) * mpmath.mpf(10) ** (-2 * self.digits)
                if 0 != bound >= abs(difference - before):
                    return working // 2
            working, before = 2 * working, difference
        raise InputError(f"B is {shorten(self.B)}: too small beside p0, use `kdv`")

    @cached_property
    def _numbers(self) -> tuple[Any, Any, Any]:
        """The numbers B, I and Q(B), evaluated to the working digits."""
        with mpmath.workdps(self.working_digits):
            B = mpmath_number(self.B)
            return B, mpmath_number(self.I), self.Q(B)

    def rate(self, theta: Any) -> Any:
        """Derivative dξ/dθ of the distance ξ from the peak, θ > 0."""
        B, I, top = self._numbers
        with mpmath.workdps(self.working_digits):
            v = B / mpmath.cosh(theta) ** 2
            return 2 * mpmath.tanh(theta) * mpmath.sqrt(I * self.F1(v) / (top - self.Q(v)))

    def fwhm(self, quantity: str) -> Any:
        """Full width at half maximum of the rise of the strain, or of the force."""
        with mpmath.workdps(self.digits + 10):
            half = mpmath.mpf(0.5) if quantity != "force" else self._half_force()
            return 2 * self._integral(mpmath.mpf(0), mpmath.acosh(1 / mpmath.sqrt(half)))

    def _half_force(self) -> Any:
        """The ratio v/B at the place where the force has half of its rise."""
        B, zero, one = self._numbers[0], mpmath.mpf(0), mpmath.mpf(1)
        with mpmath.workdps(self.working_digits):
            start, end = self.F(zero), self.F(B)
            tol = mpmath.mpf(10) ** (-self.digits - 5)

            def above_half(share: Any) -> Any:
                return (self.F(share * B) - start) / (end - start) - one / 2

            return mpmath.findroot(
                above_half, (zero, one), solver="anderson", tol=tol, verify=False
            )

    def strain(self, place: Any) -> Any:
        """The strain v at the distance ξ ≥ 0 from the peak, by Newton's method in θ."""
        with mpmath.workdps(self.digits + 10):
            if not place:
                return self._numbers[0]
            theta = step = mpmath.mpf(1)
            here = self._integral(mpmath.mpf(0), theta)
            while abs(step) > mpmath.mpf(10) ** (-self.digits - 5) and theta < 3 * mpmath.mp.dps:
                step = (place - here) / self.rate(theta)
                step = min(max(step, -theta / 2), mpmath.mpf(1))
                here += self._integral(theta, theta + step)
                theta += step
            return self._numbers[0] / mpmath.cosh(theta) ** 2

    def _integral(self, start: Any, end: Any) -> Any:
        """The length ∫ (dξ/dθ) dθ by Gauss's rule on pieces of length 1 or less.

        Steep laws, and waves next to their limiting amplitude, vary fast at θ = 0.
        """
        count = max(1, int(mpmath.ceil(abs(end - start))))
        points = mpmath.linspace(start, end, count + 1)
        scale = self.rate((start + end) / 2)  # the error of mpmath.quad is an absolute one

        def integrand(theta: Any) -> Any:
            return self.rate(theta) / scale

        for halvings in _HALVINGS:
            graded = [points[1] / 2**i for i in range(halvings, 0, -1)] if not start else []
            pieces = [start, *graded, *points[1:]]
            total, error = mpmath.quad(integrand, pieces, method="gauss-legendre", error=True)
            if error <= abs(total) * mpmath.mpf(10) ** (-self.digits - 3):
                break
        return scale * total
