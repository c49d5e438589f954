"""Numbers of a shock: exact short fractions, or floats of many digits.

Exact powers such as ``0.392**2.091`` pass through integers of thousands of digits, and so do those
of symbols. Floats of 60 digits take their place, of which results keep 30: a jump of 1e-15 of the
strain loses 30 of them in the work of a pulse.
"""

from __future__ import annotations

import sympy as sp

from lwa.base.exact import InputError, demand_numbers
from lwa.law import ContactLaw

WORKING = 60
"""Digits of floats."""

DIGITS = 30
"""Digits of results that are floats."""

SHORT = 64
"""Largest numerator and denominator of numbers whose powers are kept exact."""


def floats(law: ContactLaw, *values: sp.Expr) -> tuple[sp.Expr, ...]:
    """Floats of numbers, unless all numbers and the constants of their law are short fractions.

    Parameters
    ----------
    law : ContactLaw
        The law.
    *values : Expr
        Strains and velocities.

    Raises
    ------
    InputError
        For symbols of a value or of the law beside long fractions.
    """
    constants = {x for x in values if x.is_Rational} | law.F.atoms(sp.Rational)
    largest = max(max(abs(int(x.p)), int(x.q)) for x in constants | {sp.S.One})
    if largest <= SHORT:
        return values
    why = f"beside fractions above {SHORT} a front needs numbers"
    demand_numbers(law.symbols, why)
    found = []
    for value in values:
        demand_numbers(value.free_symbols, why)
        # 0 stays exact: without load a power law has closed forms.
        found.append(value if value.is_zero else sp.N(value, WORKING))
    return tuple(found)


def evaluated(value: sp.Expr) -> sp.Expr:
    """The value; a number that holds floats as one float.

    SymPy may multiply floats of many digits with roots for ever.
    """
    if value.has(sp.Float) and not value.free_symbols:
        return sp.N(value, WORKING)
    return value


def tidy(value: sp.Expr) -> sp.Expr:
    """Combine powers; a result with floats has `DIGITS` digits.

    Raises
    ------
    InputError
        For a result that floats do not hold.
    """
    if value.has(sp.zoo, sp.nan, sp.oo):
        raise InputError("the strains are too near, or too far apart, for a number")
    if not value.has(sp.Float):
        return sp.powsimp(value)
    # The factors without symbols are one float.
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    return factor.n(DIGITS) * rest
