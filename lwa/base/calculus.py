"""Integrals of sums with large powers, and roots of growing functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import sympy as sp


def integral(F: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """The integral ``∫ F dx``; powers of linear functions by the power rule.

    SymPy multiplies these out: large powers take long, and the terms of a pole cancel next to it.
    """
    total = sp.S.Zero
    for term in sp.Add.make_args(F):
        # A term c (a + b x)^e has the integral c (a + b x)^{e+1}/(b (e + 1)).
        factor, rest = term.as_independent(x, as_Add=False)
        base, e = rest.as_base_exp()
        slope = base.diff(x)
        if (e + 1).is_nonzero and base.has(x) and not slope.has(x):
            total += factor * base ** (e + 1) / (slope * (e + 1))
        else:
            total += sp.integrate(term, x, conds="none")
    return total


_FIRST_STEP = mpmath.mpf(2) ** -20
"""The first step of a search; a root below it lies in the first interval that is searched."""

# Relative to the place: a root that is not found to 45 digits is none.
_LEAST_STEP = mpmath.mpf(2) ** -150
_FARTHEST = 2**1024  # no float is that large
# Ratio of a step to the one before: 2^-20 grows to 2^1024 in 4000 steps, a tenth of a second.
_LONGER = mpmath.mpf("1.2")


def growing_root(F: sp.Expr, x: sp.Symbol) -> Any:
    """The first root ``x > 0`` of a function that grows up to the root.

    Parameters
    ----------
    F : Expr
        The function, of one symbol.
    x : Symbol
        The symbol.

    Returns
    -------
    mpf or None
        The root to mpmath's precision; None without a root.

    Notes
    -----
    Steps that leave the interval on which F is real and grows (its pole, its maximum) are halved.
    """
    value = real_function(sp.lambdify(x, F, "mpmath"))
    slope = real_function(sp.lambdify(x, F.diff(x), "mpmath"))
    low = mpmath.mpf(0)
    if value(low) > 0:  # the root is at a negative x
        return None
    step = _FIRST_STEP
    while True:
        above = value(low + step)
        grows = slope(low + step) > 0
        if above >= 0 and grows:
            break  # the root is within this step
        # Beside a large constant of F growth is lost in rounding.
        if above >= value(low) and grows:
            low += step
            step *= _LONGER
        else:
            step /= 2
        if step < _LEAST_STEP * max(low, 1) or low > _FARTHEST:
            return None
    # F rises through 0 in this interval, and Anderson's method keeps a bracket. It took at most 35
    # values of F under named laws (forces from 1e-30 to 1e20): 200 steps are a bound. mpmath takes
    # the tolerance times x where x is above 1; its own check compares F² with the tolerance, which
    # here is a tolerance of x.
    high = low + step
    return mpmath.findroot(
        value,
        (low, high),
        tol=mpmath.eps * min(high, 1),
        maxsteps=200,
        solver="anderson",
        verify=False,
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
