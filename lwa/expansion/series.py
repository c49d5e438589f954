"""A quantity of a chain's wave as a series in ``ε = k - 1``, exact, and its sum at a number k.

As functions of k the quantities of a wave are singular at 0, so that the coefficients of the
powers of ε alternate and the series in ε is of no use beyond 1. Euler's transformation ``ε = x/(1 -
x)`` moves this point to infinity (Hardy, *Divergent Series*, 1949, chapter 8)::

    Σ a_n ε^n = Σ b_n x^n,    b_0 = a_0,    b_n = Σ_{m=1}^n C(n-1, m-1) a_m,

and ``x = 1 - 1/k`` lies between 0 and 1 for every k > 1. The b_n of equal beads are at most 1 up to
the order `LAST`, from where on they grow: the series is asymptotic. A sum that ends with ``x^n``
misses ``b_{n+1} x^{n+1} + …``; its error is estimated as::

    max(`SAFETY`, `REST` k) b x^{n+1},    b the largest of the last `WINDOW` coefficients,

since one coefficient may be small by chance, next to a change of sign, and ``x^{n+1} + x^{n+2} + …
= k x^{n+1}``.

The difference that unlike beads make is summed apart: its terms soon grow, where masses are nearly
equal from the first on. This sum ends before the first term that is smaller than the next, and its
error is `LEFT_OUT` times that term. The error by radiation (`radiated`) is added.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import comb
from typing import Any

import mpmath
import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, shorten
from lwa.base.frozen import Estimate, Value
from lwa.cell import Cell, exponent
from lwa.expansion.joined import decimals, power_series
from lwa.expansion.observables import equal_beads, shares_model
from lwa.linear.dispersion import Dispersion

SHOWN = 3
"""Terms of a series in LaTeX and in its repr."""

LOWEST = 6
"""Lowest order that is summed.

At order 4 three errors in ten are over 30 times the deviation (equal beads, k from 1.05 to 3.45),
from order 6 on one in twenty.
"""

UNLIKE = 0.1
"""Largest relative error of a sum of unlike beads.

At the mass ratio of the long-wave paper's experiment the width 2.34 ± 2.2 tells nothing of the
lattice's 2.50.
"""

LAST = 16
"""Last power of x in a sum: later terms of equal beads make it worse (k from 2 to 3.5)."""

WINDOW = 4
"""Number of coefficients that tell the size of the next: signs change every seven (book, late
coefficients), and next to a change one or two are small."""

SAFETY = 9
"""Least ratio of the error estimate to the ``b x^{n+1}`` of the module.

Measured on 13,403 sums of equal beads (nine quantities, 140 values of k from 1.05 to 14, orders 6
to 16) against the lattice's waves: no estimate is below the deviation, the closest is 1.06 of it
(the width at k of 3.5, and c² of spheres at sixteen orders); 92.7 % are at most 30 times as large.
"""

REST = 2.6
"""Ratio of the error estimate to ``b k x^{n+1}`` at k > `SAFETY`/`REST`; measured likewise."""

LEFT_OUT = 3.2
"""Ratio of the error estimate to the first term that is left out where terms grow.

Measured with the error by radiation on 645 sums of dimers to order 10, speeds and widths at k from
1.1 to 2 and m2/m1 from 0.01 to 0.995, against the pulses of struck chains: no deviation of a sum
that is not refused is larger than its estimate. To order 8 one is known that is, by 3 %: the width
at k of 1.15 and m2/m1 of 1/2.
"""

TERM_DIGITS = 60
"""Decimal digits of the terms of a sum: the binomial coefficients cancel some."""

_LETTERS = {
    "c2": "c^2",
    "momentum": r"\sum m v",
    "energy": "E",
    "effective_mass": r"m_\mathrm{eff}",
}
"""Names of quantities in LaTeX; any other quantity is a width."""


@dataclass(frozen=True, repr=False)
class EpsilonSeries(Value):
    """The series ``prefactor · ε^power · Σ coefficients[n] ε^n`` of a quantity.

    Attributes
    ----------
    prefactor, power, coefficients : sympy.Expr, sympy.Expr, tuple of sympy.Expr
        The series.
    k : sympy.Expr
        The exponent. A symbol may stand in the prefactor and in the shares of unlike contacts, too.
    cell : Cell
        The chain.
    quantity : str
        Name of the quantity.
    """

    prefactor: sp.Expr
    power: sp.Expr
    coefficients: tuple[sp.Expr, ...]
    k: sp.Expr
    cell: Cell
    quantity: str

    @property
    def order(self) -> int:
        """The highest power of ε in the sum."""
        return len(self.coefficients) - 1

    def at(self, k: Any = None) -> Estimate:
        """Sum the series at a number k > 1, with an estimate of the error.

        Parameters
        ----------
        k : number, optional
            The exponent, for a series in a symbol k.

        Returns
        -------
        Estimate

        Raises
        ------
        lwa.InputError
            If k or the cell holds symbols, for k up to 1, for a k besides that of the series, for
            orders below `LOWEST`, and where the error is as large as the sum of these positive
            quantities, or `UNLIKE` of it for unlike beads.
        """
        if k is not None:
            return self._for(exponent(k)).at()
        if self.order < LOWEST:
            raise InputError(
                f"order is {self.order}: sums are stated from order {LOWEST} on"
            )
        values = sp.Tuple(self.k, self.prefactor, *self.coefficients)
        demand_numbers(values.free_symbols, "a sum needs numbers")
        # x = 1 - 1/k is positive for k > 1 only.
        if not self.k > 1:
            raise InputError(
                f"k is {self.k}: the expansion in k - 1 is summed for k > 1"
            )
        total = self._summed()
        # A sum with a larger error tells nothing.
        largest = UNLIKE
        if self.cell.uniform:
            largest = 1
        if not total.error < largest * total.value:
            raise InputError(
                f"no sum at k = {shorten(self.k)}: to ε^{self.order} its error is more than "
                f"{largest:.0%} of it"
            )
        return total

    def _summed(self) -> Estimate:
        """The sum of a series of numbers, whatever its error."""
        epsilon = self.k - 1
        unit = self.prefactor * epsilon**self.power
        relative = 2**-52  # the sum leaves as a float, whose last digit is rounded
        # Terms of both signs cancel: they are summed with more digits than a float has.
        with mpmath.workdps(TERM_DIGITS):
            x, scale = decimals([epsilon / self.k, unit], TERM_DIGITS)
            whole = _transformed(self.coefficients)
            if self.cell.uniform:
                parts = [_sum(whole, x)]
            else:
                # Large terms of both cancel in the difference to equal beads.
                equal = _transformed(equal_beads(self.quantity, self.order))
                rest = [a - b for a, b in zip(whole, equal, strict=True)]
                parts = [_sum(equal, x), _truncated(rest, x)]
                relative += radiated(self.cell, self.k)
            value = scale * mpmath.fsum(part.value for part in parts)
            error = abs(scale) * mpmath.fsum(part.error for part in parts)
            return Estimate(float(value), float(error)).widened(relative)

    def _for(self, k: sp.Expr) -> EpsilonSeries:
        """The series with a number or symbol in place of its symbol k."""
        if not self.k.is_Symbol:
            raise InputError(
                f"k is {k}, but the series is that of k = {self.k}: leave k out"
            )
        at = {self.k: k}
        return replace(
            self,
            prefactor=self.prefactor.xreplace(at),
            coefficients=tuple(a.xreplace(at) for a in self.coefficients),
            k=k,
        )

    def __repr__(self) -> str:
        name = f"{self.quantity} to ε^{self.order}"
        return f"EpsilonSeries({name}, k={self.k}, {self.cell!r}, {self.answer})"

    @property
    def answer(self) -> str:
        """The sum in text; the first `SHOWN` coefficients if the series is not summed."""
        try:
            return f"sum {self.at()}"
        except InputError:
            first = [shorten(value) for value in self.coefficients[:SHOWN]]
            return f"coefficients {', '.join(first)}, …"

    def latex_rows(self) -> list[str]:
        """The series as a paper prints it: its name, its first `SHOWN` terms and dots."""
        epsilon = sp.Symbol(r"\varepsilon")
        terms = []
        for n, coefficient in enumerate(self.coefficients[:SHOWN]):
            if coefficient:
                terms.append((coefficient, latex.power(epsilon, n)))
        value = latex.total(terms) + r" + \dots"
        unit = self.prefactor * epsilon**self.power
        if unit != 1:
            value = rf"{sp.latex(unit)} \Bigl({value}\Bigr)"
        name = _LETTERS.get(self.quantity) or latex.fwhm(self.quantity)
        return [f"{name} = {value}"]


def _transformed(coefficients: Sequence[sp.Expr]) -> list[mpmath.mpf]:
    """Coefficients ``b_n`` of ``x^n`` from the coefficients of ``ε^n``."""
    a = decimals(coefficients, TERM_DIGITS)
    b = a[:1]
    for n in range(1, len(a)):
        terms = (comb(n - 1, m - 1) * a[m] for m in range(1, n + 1))
        b.append(mpmath.fsum(terms))
    return b


def _sum(b: Sequence[mpmath.mpf], x: mpmath.mpf) -> Estimate:
    """Sum ``Σ b_n x^n`` over all n, at most to n = `LAST`; the error is that of the module."""
    b = b[: LAST + 1]
    # The exponent, as x = 1 - 1/k: the terms left out are at most as large as a geometric series,
    # whose sum is k times its first term.
    k = 1 / (1 - x)
    largest = max(abs(term) for term in b[-WINDOW:])
    error = max(SAFETY, REST * k) * largest * x ** len(b)
    return Estimate(power_series(b, x), error)


def _truncated(b: Sequence[mpmath.mpf], x: mpmath.mpf) -> Estimate:
    """Sum the terms b_n x^n before the first one that is smaller than the next, or all of them."""
    # A later term may be small by chance, next to a change of sign: the first growth decides.
    terms = [term * x**n for n, term in enumerate(b)]
    for n, (term, following) in enumerate(pairwise(terms)):
        # The first term of a difference to equal beads is 0, and its growth tells nothing.
        if 0 < abs(term) < abs(following):
            return Estimate(mpmath.fsum(terms[:n]), LEFT_OUT * abs(term))
    return _sum(b, x)


@lru_cache(maxsize=64)
def radiated(cell: Cell, k: sp.Expr) -> float:
    """Relative error of the sums of unlike beads by radiation, which no order in ε removes.

    Light beads rattle under the pulse and leave an oscillating tail. An oscillation that stands in
    the frame of the pulse has ``Ω = K`` on the optical branch, as the pulse runs nearly with sound,
    which has ``Ω = κ``. This K is near ``K² = Ω_o² - 1`` for light beads, Ω_o the lowest optical
    frequency of long waves, and is taken from there for all. The pulse, a Gaussian of width
    ``√(I/ε)``, excites the oscillation the less the larger ``s = I K²/ε`` is. The bound, times the
    contrast 4I - 1/3 to equal beads ((m1 - m2)²/(m1 + m2)² of a dimer), was fitted to the widths of
    215 struck chains at k from 1.1 to 2 and m2/m1 from 0.01 to 0.995. It is measured, not proved.
    """
    epsilon = float(k - 1)
    chain = Dispersion(cell, shares_model(cell, k).k)
    I = float(chain.I / cell.spacing**2)
    optical = float(chain.bands.branches(0.0)[1]) ** 2
    s = I * max(optical - 1, 0.0) / epsilon
    # The four numbers are those of the fit. Contacts soften at the pulse's ends, the more the
    # larger ε: K, and the decay with √s, become less.
    height = 0.3 + 0.35 / epsilon
    decay = 0.7 + 0.2 / epsilon
    contrast = max(4 * I - 1 / 3, 0.0)
    return contrast * math.exp(height - decay * math.sqrt(s))
