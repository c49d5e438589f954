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
from lwa.base.exact import InputError, integer, one_of
from lwa.base.progress import shown
from lwa.cell import Cell, exponent, read_cell
from lwa.cell import k as symbol_k
from lwa.closure.consistency import BRANCHES, CLOSURES, FIELDS, OfClosure, solve
from lwa.equation.pde import PDE
from lwa.equation.terms import STRAIN, Terms, terms
from lwa.law import ContactLaw, for_cell

SLOW_ORDER = 12
"""The order from which a derivation shows its progress."""

MOST_TERMS = 600_000
"""Estimated terms beyond which a derivation is refused.

Measured: 0.6 GB and 7 s at 420,000 terms (full closure, three masses at order 12 or four at order
10), 0.9 GB and 13 s at 840,000 (four at order 11), but 2 GB and 42 s at 510,000 (linear closure,
two masses, order 24).
"""


@dataclass(frozen=True)
class Theory(OfClosure):
    """The long-wave theory of a chain (see `homogenize`)."""

    @property
    def order(self) -> int:
        """The highest power of D in the ansatz."""
        return self.closure.order

    @property
    def amplitude_ratio(self) -> sp.Expr:
        """The amplitude ratio λ of the branch: 1 acoustic, -m1/m2 optical."""
        return self.closure.ratio

    @property
    def ansatz(self) -> dict[int, sp.Expr]:
        """Mapping n → b_n in w = λ (u + Σ b_n D^n ∂_x^n u); empty for a cell of one particle.

        Here w is the field of the second particle. In the full closure w has nonlinear terms too;
        `slaved` holds all terms.
        """
        return self.closure.b

    @cached_property
    def slaved(self) -> dict[int, dict[int, Terms]]:
        """Terms J_n of the particles' fields w_i = u + u_x Σ D^n J_n, by i and n (full closure)."""
        return {
            i: {
                n: terms(self.closure, S, STRAIN) for n, S in enumerate(series, start=1)
            }
            for i, series in enumerate(self.closure.slaved)
            if any(not S.is_zero() for S in series)
        }

    @cached_property
    def pde(self) -> PDE:
        """The wave equation."""
        return PDE(self.closure)

    @cached_property
    def defect(self) -> dict[int, Terms]:
        """Mapping from n to the terms of D^{k+n} (optical: D^n) in the defect.

        The defect is u_ττ from the first equation of motion minus u_ττ from the second. Orders at
        which the equations agree are left out: {} says that the ansatz satisfies both
        equations of motion to the order derived.
        """
        sign = 1 if self.pde.acoustic else -1  # u_ττ = -u^k E there
        defect = enumerate(self.closure.defect)
        return {n: terms(self.closure, sign * d) for n, d in defect if not d.is_zero()}

    def __str__(self) -> str:
        return str(self.pde)

    @property
    def phi(self) -> dict[int, sp.Expr]:
        """Mapping from n to φ_n in the compression; {} for powers and laws without expression."""
        law = self.law
        known = not (law.homogeneous or law.formless)
        return {n: law.phi(n) for n in range(2, max(self.order, 3))} if known else {}

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of ansatz and equation to D^{k+most} (None: all), and of a law that is no power."""
        rows = [*self.closure.latex_rows(most and most + 1), *self.pde.latex_rows(most)]
        if self.law.homogeneous:
            return rows
        delta = sp.latex(self.law.delta)
        definition = rf"\frac{{{delta}^{{n-1}} F^{{(n)}}({delta})}}{{F'({delta})}}"
        place = rf"{delta} = {sp.latex(self.cell.spacing)} u_{{x}}"
        law = [] if self.law.formless else self.law.latex_rows()
        law.append(
            rf"\phi_{{n}} = {definition} \quad \text{{and}}\ F'({delta})\ \text{{at}}\ {place}"
        )
        return [
            *law,
            *latex.rows({rf"\phi_{{{n}}}": x for n, x in self.phi.items()}),
            *rows,
        ]

    def _repr_latex_(self) -> str:
        return latex.display(self.latex_rows(3))

    def at(self, **values: Any) -> Theory:
        """The theory for these values of the named symbols, and of ω = m2/m1 by ``omega``.

        Raises `lwa.InputError` for a name that does not occur or a value that is not positive.

        >>> from lwa import Dimer
        >>> homogenize(Dimer("m1", "m2")).at(k="3/2", omega=1).pde.I
        D**2/12
        """
        return Theory(self.closure.at(**values))


def homogenize(
    cell: Cell,
    order: int = 4,
    *,
    k: Any = symbol_k,
    law: ContactLaw | None = None,
    closure: str = "linear",
    branch: str = "acoustic",
    field: str = "first",
) -> Theory:
    """Derive the long-wave theory of a chain.

    Parameters
    ----------
    cell : the periodic cell.
    order : highest power N of D in the ansatz; the wave equation then reaches D^{k+N-1}.
    k : exponent of the contact law, a number or a symbol.
    law : the contact law, by default `lwa.Power(k)`; see `lwa.law`. Under a law that is no power
        the contacts of a cell must be alike, and results hold its φ_n as phi2, phi3, ….
    closure : "linear", the paper's, or "full", which satisfies every equation of motion.
    branch : "acoustic" (neighbours move together) or "optical" (against each other).
    field : unknown of the wave equation: "first", the first particle's displacement, or
        "center", the canonical field, the mass-weighted mean of the sublattice fields at one point
        (full closure).

    Raises `lwa.InputError` for values that make no sense or that the closure does not cover.

    >>> m1, m2 = sp.symbols("m1 m2", positive=True)
    >>> from lwa import Dimer
    >>> theory = homogenize(Dimer(m1, m2), order=4)
    >>> theory.ansatz[4]
    m1*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**3)
    >>> theory.pde.H
    D**2*(k - 1)*(2*m1 - m2)/(3*(m1 + m2))
    """
    read_cell(cell)
    order = integer(order, "order", 1)
    one_of(closure, CLOSURES, "closure")
    one_of(branch, BRANCHES, "branch")
    one_of(field, FIELDS, "field")
    law = for_cell(law, cell, exponent(k) if law is None else k)
    if not law.homogeneous and branch != "acoustic":
        raise InputError(
            f"branch is {branch!r}: its contacts also pull, and its unit of time is that of a "
            "power law; a law given for compression has the acoustic branch"
        )
    model = Model(cell, law, branch).replaced({}, order)
    ring = model.ring
    parameters = len(ring.names) - max(
        len(ring.variables) - 1, 0
    )  # the φ_n grow as powers of k
    # The order D^{k+n} has at most one monomial per partition of n; its coefficient, of degree n in
    # P free parameters, has at most C(n + P, P) terms. The jets of the velocity multiply the total
    # by about n.
    n = min(order, 100)
    terms = int(partition(n)) * math.comb(n + parameters, parameters)
    terms *= order if closure == "full" else 1
    if terms > MOST_TERMS:
        raise InputError(
            f"order is {order}: about {terms:.0e} terms, which may take more than 2 GB; give "
            "numbers for the exponent and the cell, or a lower order"
        )
    return Theory(
        solve(
            model, order, closure, field, progress=iter if order < SLOW_ORDER else shown
        )
    )
