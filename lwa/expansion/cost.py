"""Limits on the size of an expansion, checked before the expansion starts."""

from __future__ import annotations

from math import comb, lcm

import sympy as sp

from lwa.algebra.model import Model
from lwa.algebra.partition import Partition
from lwa.base.exact import InputError

MOST_TERMS = 3_000_000
"""Terms of all polynomials in memory: some 600 MB."""

LONG_TERMS = 30_000
"""Terms from which an expansion takes half a minute or more."""

ROOT_DIGITS = 100
"""Digits of the ratios of masses and of stiffnesses; SymPy takes roots of at most 300."""


def affordable(model: Model, order: int) -> int:
    """Check that an expansion to ε^order fits in memory; return the estimated number of terms.

    The coefficient of t^n (`lwa.expansion.recursion`) has about 3n/2 powers of Z, each times a
    polynomial of degree 3n in the symbolic ratios of the cell.

    Raises `lwa.InputError` for more than `MOST_TERMS` terms, and for ratios of masses or of
    stiffnesses with more than `ROOT_DIGITS` digits.
    """
    for part, name in ((model.ring.masses, "masses"), (model.ring.contacts, "stiffnesses")):
        if _integer(part) >= 10**ROOT_DIGITS:
            raise InputError(
                f"{name} have ratios of more than {ROOT_DIGITS} digits: give numbers of fewer"
            )
    P, ratios = model.cell.size, len(model.ring.masses.names) + len(model.ring.contacts.names)
    n = min(order, 10**6)
    terms = 8 * P * n**2 * comb(6 * n + 4 + ratios, ratios) // (ratios + 2)
    if terms > MOST_TERMS:
        other = "give numbers for the cell, or a lower order" if ratios else "a lower order"
        raise InputError(
            f"order is {order}: with {ratios} symbolic ratios in a cell of {P} this takes more "
            f"than {MOST_TERMS:.0e} terms, beyond memory; {other}"
        )
    return terms


def short(value: sp.Expr, name: str) -> sp.Expr:
    """Return the value; raise `lwa.InputError` if a number in it exceeds `ROOT_DIGITS` digits."""
    numbers = (abs(int(part)) for x in value.atoms(sp.Rational) for part in (x.p, x.q))
    if max(numbers, default=0) >= 10**ROOT_DIGITS:
        raise InputError(f"{name} has a number of more than {ROOT_DIGITS} digits: give fewer")
    return value


def _integer(part: Partition) -> int:
    """Common denominator of rational fractions; 1 where the fractions are generators."""
    return lcm(*(int(value.q) for value in part.values or ()))
