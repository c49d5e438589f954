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

    Attributes
    ----------
    prefactor, power, coefficients : sympy.Expr, sympy.Expr, tuple of sympy.Expr
        The series.
    k : sympy.Expr
        The exponent. The series is summed at a number; a symbol may be replaced by a number or
        another symbol, also in the prefactor and the shares of unlike contacts.
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

    def at(self, k: Any = None) -> Resummed:
        """Sum the series at a number k > 1, with an estimate of the error.

        Parameters
        ----------
        k : number, optional
            The exponent, for a series in a symbol k.

        Returns
        -------
        Resummed
            The series of equal beads and the difference to it are summed apart; the error by
            radiation is added.

        Raises
        ------
        lwa.InputError
            If k or the cell holds symbols, for k ≤ 1, for a k besides that of the series, for
            orders below `LOWEST`, and where the error is as large as the sum of these positive
            quantities, or `UNLIKE` of it for unlike beads.
        """
        if self.order < LOWEST:
            raise InputError(
                f"order is {self.order}: sums are stated from order {LOWEST} on"
            )
        if k is not None:
            return self._for(exponent(k)).at()
        symbols: set[sp.Symbol] = set()
        for value in (self.k, self.prefactor, *self.coefficients):
            symbols |= value.free_symbols
        demand_numbers(symbols, "a sum needs numbers")
        if not self.k > 1:
            raise InputError(
                f"k is {self.k}: the expansion in k - 1 is summed for k > 1"
            )
        total = self._summed()
        largest = UNLIKE
        size = f"over {UNLIKE:.0%} of it (unlike beads)"
        if self.cell.uniform:
            largest = 1
            size = "as large as itself"
        if not total.error < largest * total.value:
            more = "a higher order may help"
            if total.asymptotic:
                more = "higher orders do not help"
            raise InputError(
                f"no sum at k = {shorten(self.k)}: to ε^{self.order} its error is {size}; {more}"
            )
        return total

    def _summed(self) -> Resummed:
        """The sum of a series of numbers, whatever its error."""
        from lwa.expansion.radiation import radiated  # start-up: it loads NumPy

        epsilon = self.k - 1
        unit = self.prefactor * epsilon**self.power
        if self.cell.uniform:
            return resum(self.coefficients, epsilon, unit=unit)
        base = equal_beads(self.quantity, self.order)
        lost = radiated(self.cell, self.k)
        return resum(self.coefficients, epsilon, base, unit, lost)

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
        return f"EpsilonSeries({self.quantity} to ε^{self.order}, k={self.k}, {self.cell!r})"

    def latex_rows(self) -> list[str]:
        """The series as a paper prints it: its name, its first `SHOWN` terms and dots."""
        epsilon = sp.Symbol(r"\varepsilon")
        terms = []
        for n, a in enumerate(self.coefficients[:SHOWN]):
            if a:
                terms.append((a, latex.power(epsilon, n) if n else ""))
        value = latex.total(terms) + r" + \dots"
        unit = self.prefactor * epsilon**self.power
        if unit != 1:
            value = rf"{sp.latex(unit)} \Bigl({value}\Bigr)"
        return [f"{_LETTERS[self.quantity]} = {value}"]
