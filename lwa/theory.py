"""The long-wave theory of a cell, by `homogenize`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp
from sympy.functions.combinatorial.numbers import partition

from lwa.algebra.model import Model
from lwa.base import latex
from lwa.base.exact import InputError, integer
from lwa.base.words import (
    BRANCHES,
    CLOSURES,
    FIELDS,
    BranchName,
    ClosureName,
    FieldName,
    one_of,
)
from lwa.cell import Cell, k as symbol_k, read_cell
from lwa.closure.consistency import Closure, OfClosure
from lwa.equation.pde import PDE
from lwa.equation.terms import STRAIN, Terms, latex_by_order, terms
from lwa.law import ContactLaw, for_cell

MOST_TERMS = 600_000
"""Estimated terms beyond which a derivation is refused.

Measured: 0.6 GB and 7 s at 420,000 terms (full closure, three masses at order 12 or four at order
10), 0.9 GB and 13 s at 840,000 (four at order 11), but 2 GB and 42 s at 510,000 (linear closure,
two masses, order 24).
"""


@dataclass(frozen=True, repr=False)
class Theory(OfClosure):
    """The long-wave theory of a chain (see `homogenize`); it is derived on first use."""

    @property
    def order(self) -> int:
        """The highest power of D in the ansatz."""
        return self.closure.model.order

    @property
    def amplitude_ratio(self) -> sp.Expr:
        """The amplitude ratio λ of the branch: 1 acoustic, -m1/m2 optical."""
        return self.closure.ratio

    @property
    def ansatz(self) -> dict[int, sp.Expr]:
        """Mapping from n to ``b_n`` in ``w = λ (u + Σ b_n D^n ∂_x^n u)``; {} for one particle.

        Here w is the field of the second particle. In the full closure w has nonlinear terms too;
        `slaved` holds all terms.
        """
        return self.closure.b

    @cached_property
    def slaved(self) -> dict[int, dict[int, Terms]]:
        """Fields of the particles in the full closure: mapping from i to {n: terms ``J_n``}.

        The field of particle i (from 0) is ``w_i = u + u_x Σ D^n J_n``; u itself is left out.
        """
        found: dict[int, dict[int, Terms]] = {}
        for i, series in enumerate(self.closure.solution.fields):
            if any(not S.is_zero() for S in series):
                orders = enumerate(series, start=1)
                found[i] = {n: terms(self.closure, S, STRAIN) for n, S in orders}
        return found

    @cached_property
    def pde(self) -> PDE:
        """The wave equation."""
        return PDE(self.closure)

    @cached_property
    def defect(self) -> dict[int, Terms]:
        """Mapping from n to the terms of ``D^{k+n}`` (optical: ``D^n``) in the defect.

        The defect is u_ττ from the first equation of motion minus u_ττ from the second. Orders at
        which the equations agree are left out: {} says that the ansatz satisfies both
        equations of motion to the order derived.
        """
        # On the optical branch u_ττ = -u^k E.
        sign = 1 if self.pde.acoustic else -1
        found = {}
        for n, defect in enumerate(self.closure.solution.defect):
            if not defect.is_zero():
                found[n] = terms(self.closure, sign * defect)
        return found

    @property
    def phi(self) -> dict[int, sp.Expr]:
        """Mapping from n to φ_n in the compression; {} for powers and laws without expression."""
        if self.law.formless:
            return {}
        last = self.closure.model.highest
        return {n: self.law.phi(n) for n in range(2, last + 1)}

    def __repr__(self) -> str:
        return f"Theory({self.closure!r}: {self.pde.line()})"

    def __str__(self) -> str:
        return str(self.pde)

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of a law that is no power, of all fields, and of the equation to ``D^{k+most}``.

        Fields are written to ``D^{most + 1}``, the order of the ansatz that the equation to
        ``D^{k+most}`` needs; None stands for all orders.
        """
        return [
            *self._law_rows(),
            *self._field_rows(most and most + 1),
            *self.pde.latex_rows(most),
        ]

    def _law_rows(self) -> list[str]:
        """LaTeX of a law that is no power and of its φ_n."""
        law = self.law
        if law.homogeneous:
            return []
        # The definition of φ_n, then its values for this law
        delta = sp.latex(law.delta)
        definition = rf"\frac{{{delta}^{{n-1}} F^{{(n)}}({delta})}}{{F'({delta})}}"
        place = rf"{delta} = {sp.latex(self.cell.spacing)} u_{{x}}"
        phi = rf"\phi_{{n}} = {definition} \quad \text{{and}}\ F'({delta})\ \text{{at}}\ {place}"
        rows = [phi, *latex.rows({rf"\phi_{{{n}}}": x for n, x in self.phi.items()})]
        return rows if law.formless else [*law.latex_rows(), *rows]

    def _field_rows(self, most: int | None) -> list[str]:
        """LaTeX of the particles' fields to D^most."""
        if not self.ansatz:  # one particle
            return []
        if self.closure.name == "linear":
            return self.closure.latex_rows(most)
        rows = []
        # Particles are numbered from 1, as in the text.
        for i, orders in self.slaved.items():
            field = latex_by_order(["u"], orders, self.cell.spacing, most=most)
            rows.append(f"w_{{{i + 1}}} = {field}")
        return rows

    def _repr_latex_(self) -> str:
        # The paper's wave equation goes to D^{k+3}.
        return latex.display(self.latex_rows(3))


def homogenize(
    cell: Cell,
    order: int = 4,
    *,
    k: Any = symbol_k,
    law: ContactLaw | None = None,
    closure: ClosureName | None = None,
    branch: BranchName = "acoustic",
    field: FieldName | None = None,
) -> Theory:
    """Derive the long-wave theory of a chain.

    Parameters
    ----------
    cell : Cell
        The periodic cell.
    order : int
        Highest power N of D in the ansatz; the wave equation then reaches ``D^{k+N-1}``.
    k : number or symbol
        Exponent of the contact law.
    law : ContactLaw, optional
        The contact law, by default ``Power(k)``; see `lwa.law`. Under a law that is no power
        the contacts of a cell must be alike, and results hold its φ_n as phi2, phi3, ….
    closure : {"linear", "full"}, optional
        "linear" is the paper's, "full" satisfies every equation of motion. By default "linear" for
        cells of one or two particles, and "full" for others, which the paper's does not cover.
    branch : {"acoustic", "optical"}
        Neighbours move together, or against each other.
    field : {"first", "center"}, optional
        Unknown of the wave equation: the first particle's displacement, or the canonical field, the
        mass-weighted mean ``Σ m̂_i w_i(x - x_i D)`` of the particles' fields at one point, ``x_i``
        the places of the particles (full closure). By default "center" with the full closure of
        the acoustic branch, else "first".

    Returns
    -------
    Theory
        Its ``repr`` names the closure and the field.

    Raises
    ------
    InputError
        For values that make no sense or that the closure does not cover.

    Examples
    --------
    >>> m1, m2 = sp.symbols("m1 m2", positive=True)
    >>> from lwa import Dimer
    >>> theory = homogenize(Dimer(m1, m2), order=4)
    >>> theory.ansatz[4]
    m1*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**3)
    >>> theory.pde.H
    D**2*(k - 1)*(2*m1 - m2)/(3*(m1 + m2))
    """
    # `read_cell` and `one_of` are called for their refusals: valid values stay as they are.
    read_cell(cell)
    law = for_cell(law, cell, k)
    one_of(branch, BRANCHES, "branch")
    # The paper's ansatz covers one or two particles, and is the only one of optical modes.
    if closure is None:
        closure = "linear" if cell.size <= 2 or branch == "optical" else "full"
    one_of(closure, CLOSURES, "closure")
    # Waves of the canonical field do not depend on which particle is called the first.
    if field is None:
        field = "center" if (closure, branch) == ("full", "acoustic") else "first"
    one_of(field, FIELDS, "field")
    if not law.homogeneous and branch != "acoustic":
        raise InputError(
            f"branch is {branch!r}: its contacts also pull, and its unit of time is that of a "
            "power law; a law given for compression has the acoustic branch"
        )
    # The derivation itself waits until a result is asked for.
    model = Model(cell, law, branch, integer(order, "order", 1))
    _check_length(model, closure)
    return Theory(Closure(model, closure, field))


def _check_length(model: Model, closure: ClosureName) -> None:
    """Raise `lwa.InputError` for a derivation of more than `MOST_TERMS` terms, by an estimate."""
    # The φ_n of a law that is no power grow as powers of one parameter, k.
    parameters = min(len(model.parameters), 1)
    parameters += len(model.masses.names) + len(model.contacts.names)
    # The order D^{k+n} has at most one monomial per partition of n; its coefficient, of degree n in
    # P free parameters, has at most C(n + P, P) terms. The jets of the velocity multiply the total
    # by about n.
    n = min(model.order, 100)  # every larger order is refused
    count = int(partition(n)) * math.comb(n + parameters, parameters)
    if closure == "full":
        # Jets of the velocity stand beside those of the strain.
        count *= model.order
    if count > MOST_TERMS:
        raise InputError(
            f"order is {model.order}: about {count:.0e} terms, which may take more than 2 GB; give "
            "numbers for the exponent and the cell, or a lower order"
        )
