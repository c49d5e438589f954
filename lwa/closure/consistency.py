"""The consistency condition, solved by the paper's closure or by that of all equations of motion.

Both closures, `lwa.closure.ansatz` ("linear") and `lwa.closure.slaving` ("full"), solve the
equations of `lwa.closure.slaving` in one algebra, `lwa.algebra.jets`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.algebra.jets import Monomial
from lwa.algebra.model import Model
from lwa.base import latex
from lwa.base.exact import InputError
from lwa.base.frozen import Shown, Value
from lwa.base.progress import Progress
from lwa.cell import Cell
from lwa.closure.ansatz import linear
from lwa.closure.slaving import Solution, full
from lwa.law import ContactLaw

BRANCHES = ("acoustic", "optical")
CLOSURES = ("linear", "full")
FIELDS = ("first", "center")


@dataclass(frozen=True, repr=False, kw_only=True)
class Closure(Shown, Solution):
    """The solved consistency condition of a model, as polynomials.

    Equality, hash and pickle go by model, order, closure and field; a copy is derived again.
    """

    model: Model
    order: int
    name: str
    field: str

    @property
    def ratio(self) -> sp.Expr:
        """λ = w/u at order D^0: 1 on the acoustic branch, -m1/m2 on the optical one."""
        # With s the force that w = λu puts on a contact, the equations of motion are m1 ü = 2s and
        # m2 λ ü = -2s. They agree where s = 0, that is w = u, or where m2 λ + m1 = 0.
        if self.model.branch == "acoustic":
            return sp.S.One
        m1, m2 = self.model.cell.masses
        return -sp.cancel(m1 / m2)

    def __reduce__(self) -> tuple[Callable[..., Closure], tuple[Any, ...]]:
        return solve, (self.model, self.order, self.name, self.field)

    def __repr__(self) -> str:
        return (
            f"Closure({self.model.cell!r}, order={self.order}, k={self.model.k}, "
            f"closure={self.name!r}, branch={self.model.branch!r}, field={self.field!r})"
        )

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of the ansatz w = λ (u + b_1 D u_x + …), λ and the b_n, to D^most (None: all)."""
        if not self.ansatz:
            return []
        last = min(len(self.ansatz) - 1, most or len(self.ansatz))
        D = self.model.cell.spacing
        parts = [
            f"b_{{{n}}} {latex.power(D, n)} {latex.derivative(n)}"
            for n in range(1, last + 1)
        ]
        if self.name == "full" or last < len(self.ansatz) - 1:
            parts.append(r"\cdots")
        first = rf"w = \lambda \left(u + {' + '.join(parts)}\right)"
        values = [latex.row(f"b_{{{n}}}", self.b[n]) for n in range(1, last + 1)]
        return [first, latex.row(r"\lambda", self.ratio), *values]

    def _repr_latex_(self) -> str:
        return latex.display(self.latex_rows(4) or [latex.row(r"\lambda", self.ratio)])

    @cached_property
    def b(self) -> dict[int, sp.Expr]:
        """Mapping from n ≥ 1 to b_n of the ansatz."""
        return {
            n: self.model.ring.expression(self.algebra.terms(b).get(Monomial(()), []))
            for n, b in enumerate(self.ansatz)
            if n > 0
        }

    def at(self, **values: Any) -> Closure:
        """The closure for these values of the named symbols; see `lwa.cell.substitution`."""
        return self.anew(self.model.substitution(values))

    def anew(
        self, new: Mapping[sp.Symbol, sp.Expr] | None = None, order: int | None = None
    ) -> Closure:
        """Derive the closure again, with values of its symbols or to another order."""
        new, order = new or {}, order or self.order
        return solve(self.model.replaced(new, order), order, self.name, self.field)


@dataclass(frozen=True)
class OfClosure(Value):
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


def solve(
    model: Model,
    order: int,
    closure: str,
    field: str,
    progress: Progress[int] = iter,
) -> Closure:
    """Solve the consistency condition by the named closure, for the named field.

    Raises `lwa.InputError` for the combinations that have no solution.
    """
    if closure == "linear" and field != "first":
        raise InputError(
            f"field is {field!r}: with the linear closure it is 'first', as in the paper"
        )
    if closure == "full" and model.branch == "acoustic":
        solution = full(model, order, field, progress)
    elif closure == "linear" or (model.k == 1 and field == "first"):
        solution = linear(model, order, progress)  # at k = 1 it leaves no defect
    else:
        raise InputError(
            "the optical branch oscillates at order D^0 and slaves no field algebraically unless "
            "k = 1: use the linear closure, or k = 1 with the field 'first'"
        )
    return Closure(
        **vars(solution), model=model, order=order, name=closure, field=field
    )
