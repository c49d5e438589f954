"""What an expansion takes, known before it starts.

The estimates are a fit to chains of 1 to 100 beads, of numbers of 1 to 100 digits and of up to 5
symbolic ratios, to within a factor of about 4: they say minutes from hours.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import comb, lcm

import sympy as sp

from lwa.coefficients import Coefficients, Partition
from lwa.exact import InputError

LONG = 60.0
"""Seconds from which it is said that something takes long, with a progress bar on a terminal."""
LONGEST = 3600.0
"""Seconds of what is not refused."""
MOST_TERMS = 5_000_000
"""Of all the polynomials that are kept at once: about a gigabyte."""
MOST_DIGITS = 100
"""Of the ratios of masses, and of stiffnesses, as integers; SymPy's roots want 300 at most."""

Progress = Callable[[Iterable[int]], Iterable[int]]
"""Wraps the orders that a computation goes through."""

_UNITS = (("years", 3.156e7), ("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0))


@dataclass(frozen=True)
class Effort:
    """What an expansion takes: ``seconds`` of an average core, ``terms`` in memory."""

    seconds: float
    terms: float

    @classmethod
    def of(cls, ring: Coefficients, order: int) -> Effort:
        """Of an expansion to ε^order.

        A polynomial at t^n has about 3n/2 powers of Z, and as many monomials as there are of
        degree 3n in the symbolic ratios; its numbers have about n times the digits of the ratios.
        """
        P, ratios = ring.cell.size, len(ring.masses.names) + len(ring.contacts.names)
        order = min(order, 10**6)
        monomials = comb(6 * order + 4 + ratios, ratios)
        symbols = 1 + (monomials / 6) ** 0.9 if ratios else 1.0
        bits = sum(_integer(part).bit_length() for part in (ring.masses, ring.contacts))
        fields = 3e-5 * order**3.3 * (P + 2) / 4 + 2e-5 * P**2 * order
        return cls(
            seconds=(0.015 * order + fields) * (1 + order * bits / 400) * symbols,
            terms=8.0 * P * order**2 * monomials / (ratios + 2),
        )

    @property
    def time(self) -> str:
        """The seconds, in round words.

        >>> Effort(7.2e3, 0).time
        'about 2 hours'
        """
        if self.seconds > 1000 * _UNITS[0][1]:
            return "over 1000 years"
        for name, unit in _UNITS:
            if self.seconds >= 1.95 * unit:
                return f"about {self.seconds / unit:.2g} {name}"
        return f"about {self.seconds:.2g} s"

    def progress(self, name: str) -> Progress:
        """Say on the standard error that it takes long, where it does, and show how far it is."""
        if self.seconds < LONG:
            return iter
        print(f"{name} {self.time}", file=sys.stderr, flush=True)
        from tqdm import tqdm  # here, so that `import lwa` does not load it

        return lambda orders: tqdm(orders, desc="orders", leave=False, disable=None)


def affordable(ring: Coefficients, order: int) -> Effort:
    """The effort of an expansion.

    Raises `lwa.InputError` where it is beyond `LONGEST`, `MOST_TERMS` or `MOST_DIGITS`.
    """
    for part, name in ((ring.masses, "masses"), (ring.contacts, "stiffnesses")):
        if _integer(part) >= 10**MOST_DIGITS:
            raise InputError(
                f"{name} have ratios of more than {MOST_DIGITS} digits: give numbers of fewer"
            )
    effort = Effort.of(ring, order)
    if effort.seconds > LONGEST or effort.terms > MOST_TERMS:
        ratios = len(ring.masses.names) + len(ring.contacts.names)
        other = "give numbers for the cell, or a lower order" if ratios else "a lower order"
        raise InputError(
            f"order is {order}: with {ratios} symbolic ratios in a cell of {ring.cell.size} this "
            f"takes {effort.time} and {effort.terms:.0e} terms; {other}"
        )
    return effort


def short(value: sp.Expr, name: str) -> sp.Expr:
    """The value, refused where a number in it has more than `MOST_DIGITS`."""
    numbers = (abs(int(part)) for x in value.atoms(sp.Rational) for part in (x.p, x.q))
    if max(numbers, default=0) >= 10**MOST_DIGITS:
        raise InputError(f"{name} has a number of more than {MOST_DIGITS} digits: give fewer")
    return value


def _integer(part: Partition) -> int:
    """The common denominator of the fractions of their sum; 1 where they are generators."""
    return lcm(*(int(value.q) for value in part.values or ()))
