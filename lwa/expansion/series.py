"""A quantity of a chain's wave as a series in ε = k - 1, exact, and its sum at a number k."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, shorten
from lwa.base.frozen import Value
from lwa.cell import Cell, exponent
from lwa.expansion.observables import equal_beads, shares_model
from lwa.expansion.sums import Resummed, resum
from lwa.linear.dispersion import Dispersion

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
    "energy": "E",
    "effective_mass": r"m_\mathrm{eff}",
}


@lru_cache(maxsize=64)
def radiated(cell: Cell, k: sp.Expr) -> float:
    """Relative error of the sums of unlike beads by radiation, which no order in ε removes.

    Light beads rattle under the pulse and leave an oscillating tail. An oscillation that stands in
    the frame of the pulse has the wavenumber K, ``K² = Ω_o² - 1``, Ω_o the lowest optical frequency
    at κ = 0, and the pulse, a Gaussian of width √(I/ε), excites it the less the larger
    ``s = I K²/ε`` is. The bound, times the contrast 4I - 1/3 to equal beads ((m1 - m2)²/(m1 + m2)²
    of a dimer), was fitted to the widths of 215 struck chains at k = 1.1 … 2 and m2/m1 = 0.01 …
    0.995. It is measured, not proved.
    """
    epsilon = float(k - 1)
    chain = Dispersion(cell, shares_model(cell, k).k)
    I = float(chain.I / cell.spacing**2)
    optical = float(chain.bands.branches(0.0)[1]) ** 2
    s = I * max(optical - 1, 0.0) / epsilon
    # Contacts soften at the pulse's ends, the more the larger ε: K and the decay with √s are less.
    height = 0.3 + 0.35 / epsilon
    decay = 0.7 + 0.2 / epsilon
    return max(4 * I - 1 / 3, 0.0) * math.exp(height - decay * math.sqrt(s))


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
        epsilon = self.k - 1
        unit = self.prefactor * epsilon**self.power
        if self.cell.uniform:
            return resum(self.coefficients, epsilon, unit=unit)
        base = equal_beads(self.quantity, self.order)
        return resum(
            self.coefficients, epsilon, base, unit, radiated(self.cell, self.k)
        )

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
