"""Estimates of the time and memory of an expansion, before it starts.

The estimates were fitted to chains of 1 to 100 beads, with numbers of 1 to 100 digits and up to 5
symbolic ratios. They are right to a factor of about 4, which tells minutes from hours.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb, lcm

import sympy as sp

from lwa.algebra.model import Model
from lwa.algebra.partition import Partition
from lwa.base.exact import InputError
from lwa.base.progress import Progress, announce, shown, words

LONGEST = 3600.0
"""Estimated seconds beyond which an expansion is refused."""
MOST_TERMS = 5_000_000
"""Terms of all polynomials in memory: about a gigabyte."""
MOST_DIGITS = 100
"""Digits of the ratios of masses and of stiffnesses; SymPy takes roots of at most 300."""


@dataclass(frozen=True)
class Effort:
    """Estimated ``seconds`` on an average core, and ``terms`` in memory."""

    seconds: float
    terms: float

    @classmethod
    def of(cls, model: Model, order: int) -> Effort:
        """Estimate an expansion to ε^order.

        A polynomial at t^n has about 3n/2 powers of Z, and as many monomials as there are of
        degree 3n in the symbolic ratios; its numbers have about n times the digits of the ratios.
        """
        P, ratios = model.cell.size, len(model.ring.masses.names) + len(model.ring.contacts.names)
        order = min(order, 10**6)
        monomials = comb(6 * order + 4 + ratios, ratios)
        symbols = 1 + (monomials / 6) ** 0.9 if ratios else 1.0
        bits = sum(_integer(part).bit_length() for part in (model.ring.masses, model.ring.contacts))
        fields = 3e-5 * order**3.3 * (P + 2) / 4 + 2e-5 * P**2 * order
        return cls(
            seconds=(0.015 * order + fields) * (1 + order * bits / 400) * symbols,
            terms=8.0 * P * order**2 * monomials / (ratios + 2),
        )

    def progress(self, what: str) -> Progress[int]:
        """An iterator that announces a long expansion and shows its progress."""
        return shown if announce(what, self.seconds) else iter


def affordable(model: Model, order: int) -> Effort:
    """The effort of an expansion.

    Raises `lwa.InputError` beyond `LONGEST`, `MOST_TERMS` or `MOST_DIGITS`.
    """
    for part, name in ((model.ring.masses, "masses"), (model.ring.contacts, "stiffnesses")):
        if _integer(part) >= 10**MOST_DIGITS:
            raise InputError(
                f"{name} have ratios of more than {MOST_DIGITS} digits: give numbers of fewer"
            )
    effort = Effort.of(model, order)
    if effort.seconds > LONGEST or effort.terms > MOST_TERMS:
        ratios = len(model.ring.masses.names) + len(model.ring.contacts.names)
        other = "give numbers for the cell, or a lower order" if ratios else "a lower order"
        raise InputError(
            f"order is {order}: with {ratios} symbolic ratios in a cell of {model.cell.size} this "
            f"takes {words(effort.seconds)} and {effort.terms:.0e} terms; {other}"
        )
    return effort


def short(value: sp.Expr, name: str) -> sp.Expr:
    """Return the value; refuse numbers of more than `MOST_DIGITS` in it."""
    numbers = (abs(int(part)) for x in value.atoms(sp.Rational) for part in (x.p, x.q))
    if max(numbers, default=0) >= 10**MOST_DIGITS:
        raise InputError(f"{name} has a number of more than {MOST_DIGITS} digits: give fewer")
    return value


def _integer(part: Partition) -> int:
    """Common denominator of rational fractions; 1 where the fractions are generators."""
    return lcm(*(int(value.q) for value in part.values or ()))
