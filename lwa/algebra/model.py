"""The model of a derivation: a cell, its contact law, a branch and the order of the ansatz."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.algebra.jets import JetAlgebra
from lwa.algebra.ring import CoefficientRing, Partition
from lwa.base.frozen import Value
from lwa.base.words import BranchName
from lwa.cell import Cell
from lwa.law import (
    ContactLaw,
    phi_symbol,
    substituted,
)


@dataclass(frozen=True)
class Model(Value):
    """A chain, one of its branches, and the order of a theory.

    Parameters
    ----------
    cell : Cell
    law : ContactLaw
    branch : {"acoustic", "optical"}
    order : int
        Highest power of D in the ansatz; 0 if nothing but the ring is wanted.
    """

    cell: Cell
    law: ContactLaw
    branch: BranchName = "acoustic"
    order: int = 0

    @property
    def k(self) -> sp.Expr:
        """Exponent of a power law; ``1 + φ_2 = d ln(δ F′)/d ln δ`` of another law."""
        return self.law.exponent if self.law.homogeneous else 1 + phi_symbol(2)

    @property
    def base(self) -> int:
        """Order of the derivative in the jets' denominators: 1 for u_x, 0 for u (optical)."""
        return 1 if self.branch == "acoustic" else 0

    @cached_property
    def ring(self) -> CoefficientRing:
        """The ring of the coefficients.

        On the optical branch all contacts are compressed by equal amounts. There the C_i are shares
        of the stiffness, proportional to A_i, instead of shares of the strain.
        """
        if self.branch == "optical":
            contacts = Partition(self.cell.stiffnesses, 1, "c")
        else:
            compliances = self.cell.compliances(self.law.exponent)
            contacts = Partition(compliances, self.cell.size, "c")
        highest = 0
        if not self.law.homogeneous:
            # The equation to D^{k+order-1} holds φ_{order-1}, and k = 1 + φ_2 always φ_2.
            highest = max(self.order - 1, 2)
        masses = Partition(self.cell.masses, 1, "mu")
        return CoefficientRing(self.k, highest, masses, contacts)

    def algebra(self, weight: int) -> JetAlgebra:
        """The algebra of the jets over the ring, up to a weight, at least 1."""
        return JetAlgebra(self.ring, max(weight, 1))

    def at(self, **values: Any) -> Model:
        """The model for these values of the named symbols; see `lwa.cell.substitution`."""
        cell, law = substituted(values, self.cell, self.law)
        return replace(self, cell=cell, law=law)
