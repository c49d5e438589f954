"""The consistency condition of a model, solved by the linear or by the full closure.

Both closures, `lwa.closure.ansatz` ("linear") and `lwa.closure.slaving` ("full"), solve the
equations of `lwa.closure.slaving` in one algebra, `lwa.algebra.jets`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from lwa.algebra.jets import Jet
from lwa.algebra.model import Model
from lwa.base import latex
from lwa.base.exact import InputError
from lwa.base.progress import shown
from lwa.base.words import ClosureName, FieldName
from lwa.cell import Cell, Parametric
from lwa.closure.ansatz import acoustic, optical
from lwa.closure.slaving import Solution, full
from lwa.law import ContactLaw

SLOW_ORDER = 12
"""The order from which a derivation shows its progress: such derivations may take seconds."""


@dataclass(frozen=True, repr=False)
class Closure(Parametric):
    """The consistency condition of a model, solved on first use.

    Parameters
    ----------
    model : Model
        Cell, contact law, branch and order.
    name : {"linear", "full"}
        The closure.
    field : {"first", "center"}
        The unknown of the wave equation.

    Raises
    ------
    InputError
        For the combinations that have no solution.
    """

    model: Model
    name: ClosureName
    field: FieldName

    def __post_init__(self) -> None:
        size = self.model.cell.size
        branch = self.model.branch
        if self.name == "full" and branch == "acoustic":
            return  # covers any cell in either field
        # At k = 1 the equations of motion are linear, and so is a slaved field.
        if self.name == "full" and (self.model.k != 1 or self.field != "first"):
            raise InputError(
                "the optical branch oscillates at order D^0 and slaves no field algebraically "
                "unless k is 1 and the field 'first'",
                closure="linear",
                field="first",
            )
        if self.field != "first":
            raise InputError(
                f"field is {self.field!r}: the linear closure has the field 'first', as in the "
                "paper",
                closure="full",
                branch="acoustic",
            )
        one_equation = size == 1 and branch == "acoustic"
        if size != 2 and not one_equation:
            raise InputError(
                f"masses: {size} in a cell, and the linear closure's {branch} branch wants two; "
                "the full closure covers the acoustic branch of any cell",
                closure="full",
                branch="acoustic",
            )

    @cached_property
    def solution(self) -> Solution:
        """Wave equation and fields as polynomials."""
        progress = iter if self.model.order < SLOW_ORDER else shown
        # The optical branch has one closure: the full one is admitted at k = 1 alone, where the
        # equations are linear and both are the same.
        if self.model.branch == "optical":
            return optical(self.model, progress)
        # The equation of motion of a single particle is its wave equation.
        if self.name == "full" or self.model.cell.size == 1:
            return full(self.model, self.field, progress)
        return acoustic(self.model, progress)

    @property
    def ratio(self) -> sp.Expr:
        """The ratio ``λ = w/u`` of the fields at the leading order: 1, optical -m1/m2."""
        # With s the force that w = λu puts on a contact, the equations of motion are m1 ü = 2s and
        # m2 λ ü = -2s. They agree where s = 0, that is w = u, or where m2 λ + m1 = 0.
        if self.model.branch == "acoustic":
            return sp.S.One
        m1, m2 = self.model.cell.masses
        return -sp.cancel(m1 / m2)

    @cached_property
    def b(self) -> dict[int, sp.Expr]:
        """Mapping from n, from 1 on, to ``b_n`` of the ansatz ``w = λ (u + Σ b_n D^n ∂_x^n u)``."""
        algebra = self.solution.algebra
        found = {}
        for n, b in enumerate(self.solution.ansatz[1:], start=1):
            # b_n depends on the parameters alone: all its terms belong to the empty product of
            # jets. A b_n of 0 has no terms.
            terms = algebra.terms(b, self.model.base)
            without_jets = terms.get(Jet(()), [])
            found[n] = self.model.expression(without_jets)
        return found

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of the ansatz ``w = λ (u + b_1 D u_x + …)``, of λ and the ``b_n``.

        Orders above ``most`` (None: no order) are dots.
        """
        rows = [latex.row(r"\lambda", self.ratio)]
        if not self.b:
            return rows
        parts = ["u"]
        for n, b in self.b.items():
            if most is not None and n > most:
                break
            D = latex.power(self.model.cell.spacing, n)
            parts.append(f"b_{{{n}}} {D} {latex.derivative(n)}")
            rows.append(latex.row(f"b_{{{n}}}", b))
        # Dots: the full closure has nonlinear terms besides, and b_n above ``most`` are left out.
        # The rows are that of λ and those of the b_n written: if none is left out, they are more
        # than the b_n.
        if self.name == "full" or len(rows) <= len(self.b):
            parts.append(r"\cdots")
        ansatz = latex.total((sp.S.One, part) for part in parts)
        return [rf"w = \lambda \left({ansatz}\right)", *rows]

    def _repr_latex_(self) -> str:
        # The ansatz of the paper's wave equation, to D^{k+3}, goes to D^4.
        return latex.display(self.latex_rows(4))

    def __repr__(self) -> str:
        model = self.model
        return (
            f"Closure({model.cell!r}, order={model.order}, k={model.k}, closure={self.name!r}, "
            f"branch={model.branch!r}, field={self.field!r})"
        )


@dataclass(frozen=True)
class OfClosure(Parametric):
    """Base of results that are computed from a closure."""

    closure: Closure

    @property
    def cell(self) -> Cell:
        """The periodic cell of the chain."""
        return self.closure.model.cell

    @property
    def k(self) -> sp.Expr:
        """The exponent of a power law; the local exponent 1 + φ_2 of another law."""
        return self.closure.model.k

    @property
    def law(self) -> ContactLaw:
        """The contact law."""
        return self.closure.model.law
