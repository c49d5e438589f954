"""A quantity of a chain's wave as a series in ε = k - 1, exact, and its sum at a number k."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, shorten
from lwa.base.frozen import Value
from lwa.cell import Cell, exponent
from lwa.expansion.observables import equal_beads
from lwa.expansion.sums import Resummed, resum

SHOWN = 3
"""Terms of a series in LaTeX."""

LOWEST = 6
"""Lowest order that is summed: at order 4 three errors in ten are over 30 times the deviation
(equal beads, k = 1.05 … 3.45), from order 6 on one in twenty."""

UNLIKE = 0.1
"""Largest relative error of a sum of unlike beads: at the mass ratio of the long-wave paper's
experiment the width 2.34 ± 2.2 tells nothing of the lattice's 2.50."""

_LETTERS = {
    "c2": "c^2",
    "c": "c",
    "strain": r"\mathrm{FWHM}_\mathrm{strain}",
    "force": r"\mathrm{FWHM}_\mathrm{force}",
    "velocity": r"\mathrm{FWHM}_\mathrm{velocity}",
    "momentum": r"\sum m v",
    "kinetic": "T",
    "energy": "E",
    "effective_mass": r"m_\mathrm{eff}",
}


@dataclass(frozen=True, repr=False)
class EpsilonSeries(Value):
    """The series prefactor · ε^power · Σ coefficients[n] ε^n, ε = k - 1.

    k : the exponent. The series is summed at a number; a symbol may be replaced by a number or
        another symbol, also in the prefactor and the shares of unlike contacts.
    cell, quantity : the chain and the name of the quantity.
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

    def at(self, k: Any = None) -> Resummed:
        """The sum and an estimate of its error, at a number k > 1 for a series in a symbol k.

        The series of equal beads and the difference to it are summed apart; the error by radiation
        is added.

        Raises `lwa.InputError` when k or the cell holds symbols, for k ≤ 1, for a k besides that of
        the series, for orders below `LOWEST`, and where the error is as large as the sum of these
        positive quantities, or `UNLIKE` of it for unlike beads.
        """
        if self.order < LOWEST:
            raise InputError(
                f"order is {self.order}: sums are stated from order {LOWEST} on"
            )
        series = self if k is None else self._for(exponent(k))
        values = (series.k, series.prefactor, *series.coefficients)
        symbols = set().union(*(value.free_symbols for value in values))
        demand_numbers(symbols, "a sum needs numbers")
        if not series.k > 1:
            raise InputError(
                f"k is {series.k}: the expansion in k - 1 is summed for k > 1"
            )
        from lwa.expansion.radiation import radiated  # start-up: it loads NumPy

        uniform, epsilon = self.cell.uniform, series.k - 1
        base = () if uniform else equal_beads(self.quantity, self.order)
        unit, lost = (
            series.prefactor * epsilon**series.power,
            radiated(self.cell, series.k),
        )
        total = resum(series.coefficients, epsilon, base, unit, lost)
        most = 1 if uniform else UNLIKE
        if not total.error < most * total.value:
            size = (
                "as large as itself"
                if uniform
                else f"over {UNLIKE:.0%} of it (unlike beads)"
            )
            more = (
                "higher orders do not help"
                if total.asymptotic
                else "a higher order may help"
            )
            raise InputError(
                f"no sum at k = {shorten(series.k)}: to ε^{self.order} its error is {size}; {more}"
            )
        return total

    def _for(self, k: sp.Expr) -> EpsilonSeries:
        """The series with a number or symbol in place of its symbol k."""
        if not self.k.is_Symbol:
            raise InputError(
                f"k is {k}, but the series is that of k = {self.k}: leave k out"
            )
        at = {self.k: k}
        coefficients = tuple(a.xreplace(at) for a in self.coefficients)
        return replace(
            self, prefactor=self.prefactor.xreplace(at), coefficients=coefficients, k=k
        )

    def __repr__(self) -> str:
        return f"EpsilonSeries({self.quantity} to ε^{self.order}, k={self.k}, {self.cell!r})"

    def latex_rows(self) -> list[str]:
        """The series as a paper prints it: its name, its first `SHOWN` terms and dots."""
        epsilon = sp.Symbol(r"\varepsilon")
        powers = ["", *(latex.power(epsilon, n) for n in range(1, SHOWN))]
        shown = zip(self.coefficients, powers, strict=False)
        body = latex.total((a, power) for a, power in shown if a) + r" + \dots"
        unit = self.prefactor * epsilon**self.power
        value = body if unit == 1 else rf"{sp.latex(unit)} \Bigl({body}\Bigr)"
        return [f"{_LETTERS[self.quantity]} = {value}"]
