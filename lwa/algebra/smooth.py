"""The coefficient ring of a law that is no power, Q[φ_2, φ_3, …, μ, c].

Where a power has its exponent k, any other law has the local one, 1 + φ_2, and its φ_n as
generators; `lwa.algebra.jets` knows how these change with the strain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import sympy as sp
from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.coefficients import Coefficients
from lwa.algebra.jets import JetAlgebra
from lwa.cell import Cell, substitution
from lwa.law import ContactLaw, for_cell, phi_symbol


@dataclass(frozen=True, kw_only=True)
class SmoothCoefficients(Coefficients):
    """The ring for one cell and one law, with φ_2 … φ_highest; k is 1 + φ_2, d ln(δ F′)/d ln δ."""

    given: ContactLaw
    highest: int

    @property
    def law(self) -> ContactLaw:
        return self.given

    @property
    def variables(self) -> tuple[sp.Expr, ...]:
        return tuple(map(phi_symbol, range(2, self.highest + 1)))

    @property
    def _own(self) -> tuple[str, ...]:
        return tuple(map(str, self.variables))

    @property
    def time_scale(self) -> sp.Expr:
        return self.cell.time_scale(1)  # F' is the law's own

    def exponent(self, context: fmpq_mpoly_ctx) -> fmpq_mpoly:
        return 1 + context.gen(context.variable_to_index("phi2"))

    def algebra(self, weight: int, velocity: bool = False, rest: bool = False) -> JetAlgebra:
        exponent = self.exponent if velocity else None
        return JetAlgebra(self.names, weight, exponent, rest, smooth=self.highest)

    def substitution(
        self, values: Mapping[str, Any], more: Sequence[sp.Symbol]
    ) -> dict[sp.Symbol, sp.Expr]:
        return substitution(values, self.cell, more=(*self.given.symbols, *more))

    def anew(self, new: Mapping[sp.Symbol, sp.Expr], order: int) -> Self:
        cell, law = self.cell.replaced(new), self.given.replaced(new)
        for_cell(law, cell)
        return replace(self, cell=cell, given=law, highest=_highest(order))


def smooth(cell: Cell, law: ContactLaw, order: int) -> SmoothCoefficients:
    """The ring for a derivation to this order."""
    return SmoothCoefficients(cell, 1 + phi_symbol(2), given=law, highest=_highest(order))


def _highest(order: int) -> int:
    """The n of the highest φ_n at D^{order-1}; the exponent holds φ_2 in any case."""
    return max(order - 1, 2)
