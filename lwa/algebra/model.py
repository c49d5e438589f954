"""The model of a derivation: a cell, its contact law and a branch of its motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.coefficients import CoefficientRing, Partition
from lwa.algebra.jets import JetAlgebra
from lwa.base.frozen import Value
from lwa.cell import Cell, substitution
from lwa.law import ContactLaw, for_cell, phi_symbol


@dataclass(frozen=True)
class Model(Value):
    """A cell, a contact law and a branch.

    highest : index n of the highest φ_n that a derivation needs, for a law other than a power.
    """

    cell: Cell
    law: ContactLaw
    branch: str = "acoustic"
    highest: int = 0

    @property
    def k(self) -> sp.Expr:
        """Exponent of a power law; local exponent 1 + φ_2 = d ln(δ F′)/d ln δ of another law."""
        return self.law.exponent if self.law.homogeneous else 1 + phi_symbol(2)

    @cached_property
    def ring(self) -> CoefficientRing:
        """The ring of the coefficients.

        On the optical branch all contacts are compressed by equal amounts. There the C_i are shares
        of the stiffness, proportional to A_i, instead of shares of the strain.
        """
        stiffnesses = self.cell.stiffnesses
        if self.branch == "optical":
            contacts = Partition(stiffnesses, 1, "c")
        else:
            equal = len(set(stiffnesses)) == 1
            weights = stiffnesses if equal else self.cell.compliances(self.k)
            contacts = Partition(weights, self.cell.size, "c")
        variables: tuple[sp.Expr, ...] = () if self.k.is_Rational else (self.k,)
        if not self.law.homogeneous:
            variables = tuple(map(phi_symbol, range(2, self.highest + 1)))
        masses = Partition(self.cell.masses, 1, "mu")
        return CoefficientRing(self.k, variables, masses, contacts)

    def algebra(self, weight: int, velocity: bool = False, rest: bool = False) -> JetAlgebra:
        """The algebra of the jets over the ring; with ``velocity`` also the jets of u_τ."""
        exponent = self.ring.exponent if velocity else None
        return JetAlgebra(self.ring.names, weight, exponent, rest, smooth=self.highest)

    def elements(
        self, algebra: JetAlgebra
    ) -> tuple[fmpq_mpoly, list[fmpq_mpoly], list[fmpq_mpoly]]:
        """The exponent k, the mass fractions m̂_i and the shares C_i in an algebra of the model."""
        masses, contacts = self.ring.masses, self.ring.contacts
        context = algebra.context
        return self.ring.exponent(context), masses.elements(context), contacts.elements(context)

    def substitution(self, values: Mapping[str, Any]) -> dict[sp.Symbol, sp.Expr]:
        """Map symbols of cell and law to values; see `lwa.cell.substitution`."""
        if self.law.homogeneous:
            return substitution(values, self.cell, self.k)
        return substitution(values, self.cell, more=self.law.symbols)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr], order: int) -> Model:
        """The model with values in place of its symbols, for a derivation to this order."""
        cell = self.cell.replaced(new)
        law = for_cell(self.law.replaced(new), cell)
        # D^{order-1} needs φ_{order-1}, and k = 1 + φ_2 needs φ_2.
        highest = 0 if law.homogeneous else max(order - 1, 2)
        return replace(self, cell=cell, law=law, highest=highest)
