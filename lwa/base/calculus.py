"""Integrals and ratios of sums with large powers, and roots of growing functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import sympy as sp

from lwa.base.exact import rearranged


def integral(F: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """The integral ∫ F dx; rational powers of linear functions by the power rule.

    SymPy multiplies these out: large powers take long, and the terms of a pole cancel next to it.
    """
    total = sp.S.Zero
    for term in sp.Add.make_args(F):
        factor, rest = term.as_independent(x, as_Add=False)
        base, e = rest.as_base_exp()
        slope = base.diff(x)
        if e.is_Rational and e != -1 and base.has(x) and not slope.has(x):
            total += factor * base ** (e + 1) / (slope * (e + 1))
        else:
            total += sp.integrate(term, x, conds="none")
    return total


def ratio(top: sp.Expr, bottom: sp.Expr) -> sp.Expr:
    """The ratio top/bottom in lowest terms."""
    return rearranged(sp.cancel, sp.powsimp(top / bottom))


def growing_root(F: sp.Expr, x: sp.Symbol) -> Any:
    """The first root x > 0 of a function that grows up to the root, by mpmath; None without a root.

    Steps that leave the interval on which F is real and grows (its pole, its maximum) are halved.
    """
    value, slope = (real_function(sp.lambdify(x, f, "mpmath")) for f in (F, F.diff(x)))
    # Steps from 2^-20 on, each a fifth longer; a root below the first is found by the bisection.
    low, step, least = mpmath.mpf(0), mpmath.mpf(2) ** -20, mpmath.mpf(2) ** -150
    while (above := value(low + step)) < 0 or not slope(low + step) > 0:
        if above > value(low) and slope(low + step) > 0:
            low, step = low + step, step * mpmath.mpf("1.2")
        else:
            step /= 2
        if step < least * max(low, 1) or low > 2**40:
            return None
    # F rises through 0 in this interval, and Anderson's method keeps a bracket
    ends, close = (low, low + step), mpmath.eps * (low + step)
    return mpmath.findroot(
        value, ends, tol=close, maxsteps=200, solver="anderson", verify=False
    )


def real_function(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """The function with the value -∞ at its poles and where it is not real."""

    def value(x: Any) -> Any:
        try:
            y = function(x)
        except ZeroDivisionError:
            return -mpmath.inf
        return mpmath.re(y) if mpmath.im(y) == 0 else -mpmath.inf

    return value
