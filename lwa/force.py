"""A contact force F(δ), as the theory meets it: derivatives, energy, and its place in a cell.

A law enters the theory through dimensionless functions of the compression δ,

    φ_n = δ^{n-1} F^{(n)}(δ) / F'(δ),    φ_1 = 1,

which for δ^k are the numbers (k-1) … (k-n+1). The force of a contact is A F(δ), A its stiffness in
the cell. The shares of unlike contacts in the strain are the same at every strain only for a power.
`lwa.law` has the laws.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar

import mpmath
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.calculus import growing_root, integral, ratio
from lwa.base.exact import InputError, demand_numbers, shorten
from lwa.base.frozen import Value
from lwa.cell import Cell, read_cell, substitution

_PHI = re.compile("phi[0-9]+")  # the name of a `phi_symbol`


class ContactLaw(Value):
    """A contact force F(δ): base of `Power` and `Law`; ``homogeneous`` if F(sδ) = s^k F(δ).

    name, parameters : those of `named`; "" and () for a law without a name.
    """

    F: sp.Expr
    delta: sp.Symbol
    name: str
    parameters: tuple[sp.Expr, ...]
    homogeneous: ClassVar[bool] = False

    @property
    def text(self) -> str:
        """Name and parameters as `read_law` reads them, such as "hertz2:1,2"; F without a name."""
        if not self.name:
            return str(self.F)
        return ":".join(filter(None, (self.name, ",".join(map(str, self.parameters)))))

    def latex_rows(self) -> list[str]:
        return latex.rows({f"F({sp.latex(self.delta)})": self.F})

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The law's own symbols, by name."""
        return tuple(sorted(self.F.free_symbols - {self.delta}, key=str))

    @property
    def exponent(self) -> sp.Expr:
        """The k of A_i^{-1/k} by which unlike contacts share the strain; 1 where all are alike."""
        return sp.S.One

    def slope(self, n: int = 1) -> sp.Expr:
        """The n-th derivative F^{(n)}(δ)."""
        return self.F.diff(self.delta, n)

    @cached_property
    def energy(self) -> sp.Expr:
        """The energy W(δ) of a contact, W′ = F."""
        if self.formless:
            s = sp.Dummy("s", positive=True)
            return sp.Integral(self.F.subs(self.delta, s), (s, 0, self.delta))
        return integral(self.F, self.delta)

    def phi(self, n: int) -> sp.Expr:
        """The parameter φ_n = δ^{n-1} F^{(n)}/F′ as an expression in δ."""
        return ratio(self.delta ** (n - 1) * self.slope(n), self.slope())

    def at(self, delta: sp.Expr, n: int = 0) -> sp.Expr:
        """The n-th derivative F^{(n)} at a compression."""
        return self.slope(n).subs(self.delta, delta)

    def evaluated(self, value: sp.Expr, delta: sp.Expr) -> sp.Expr:
        """The value of an expression in φ_2, φ_3, … at a compression."""
        slope = self.at(delta, 1)
        orders = {s: int(s.name[3:]) for s in value.free_symbols if _PHI.fullmatch(s.name)}
        return value.xreplace(
            {s: delta ** (n - 1) * self.at(delta, n) / slope for s, n in orders.items()}
        )

    @property
    def formless(self) -> bool:
        """True if F is a function without an expression, as that of `general`."""
        return bool(self.F.atoms(AppliedUndef))

    def of_strain(self, p: sp.Expr, D: sp.Expr, n: int = 0) -> sp.Expr:
        """The n-th derivative of F at the strain p, in the units of u_ττ = F′(u_x) u_xx.

        For n = 0 this is F(Dp)/D (p^k/k for a power), for n = -1 the energy W.
        """
        # Each derivative by p instead of δ = D p brings a factor D, each integral 1/D.
        if n < 0:
            return self.energy.subs(self.delta, D * p) / D**2
        return self.at(D * p, n) * D ** (n - 1)

    def weight(self, p: sp.Expr, D: sp.Expr, a: sp.Expr, b: sp.Expr) -> sp.Expr:
        """The factor p^a (p F′)^b of a jet at the strain p."""
        return self.at(D * p, 1) ** b * p ** (a + b)

    def check_contacts(self, cell: Cell) -> None:
        """Raise `lwa.InputError` unless the contacts of the cell can share the law."""
        if len(set(cell.stiffnesses)) > 1:
            raise InputError(
                "the contacts differ in stiffness, and their shares of the strain would then "
                "depend on the strain: only a power law allows that"
            )
        cell_names, names = (
            {s.name for s in symbols} for symbols in (cell.symbols, (self.delta, *self.symbols))
        )
        for name in sorted(cell_names & names):
            raise InputError(f"{name} names both the law's and a property of the cell")
        for name in sorted(filter(_PHI.fullmatch, cell_names | names)):
            raise InputError(f"{name!r} means φ_{name[3:]} of the law here: use another name")

    def check_strain(self, p: sp.Expr, cell: Cell, sound: bool = False) -> None:
        """Raise `lwa.InputError` unless F is real up to the strain p and grows there, F′ > 0.

        Nothing is refused while symbols are left, except a spacing, which is taken to be 1, nor at
        p = 0, where F′ may vanish unless there must be ``sound``.
        """
        D = cell.spacing
        delta = (D * p).xreplace({D: sp.S.One} if D.is_Symbol else {})
        if self.homogeneous or self.formless or (delta.is_zero and not sound):
            return
        for power_ in self.F.atoms(sp.Pow):
            start, end = (power_.base.subs(self.delta, x) for x in (0, delta))
            if power_.exp.is_negative and (start * end).is_nonpositive:
                raise InputError(f"the strain is {shorten(p)}: the law has a pole before it")
        slope = self.at(delta, 1)
        if not slope.free_symbols and not slope.is_positive:
            raise InputError(
                f"the strain is {shorten(p)}: F′ is {sp.N(slope, 4)} there, and sound needs F′ > 0"
            )

    def compressions(self, cell: Cell, force: sp.Expr) -> tuple[sp.Expr, ...]:
        """The compression of each contact of a cell that pushes with this force."""
        return (self.compression(cell, force),) * cell.size

    def compression(self, cell: Cell, force: sp.Expr) -> sp.Expr:
        """The mean compression of a cell's contacts that push with this force, to 35 digits.

        Raises `lwa.InputError` for a force beyond the law's reach, and for symbols.
        """
        if self.formless:
            raise InputError(f"law is {self.text}: the strain under a force needs an expression")
        share = force / cell.stiffnesses[0]
        free = share.free_symbols | self.F.free_symbols - {self.delta}
        demand_numbers(free, f"the load under the law {self.text} needs numbers")
        with mpmath.workdps(50):
            root = growing_root(self.F - share, self.delta)
            if root is None:
                raise InputError(f"force is {shorten(force)}: the law does not reach it")
            # 35 digits leave 15 of the rise of a wave that is 1e-20 of the load.
            return sp.Float(root, 35)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> ContactLaw:
        """The law with the values that `lwa.cell.substitution` gives for its symbols."""
        raise NotImplementedError


def phi_symbol(n: int) -> sp.Symbol:
    """The symbol of φ_n in results."""
    return sp.Symbol(f"phi{n}", real=True)


def for_cell(law: Any, cell: Cell) -> ContactLaw:
    """Return a law; raise `lwa.InputError` unless it is a law that fits the cell's contacts."""
    if not isinstance(law, ContactLaw):
        raise InputError(f"law is {shorten(law)}: Power(k), Law(F, delta) or general() is wanted")
    law.check_contacts(read_cell(cell))
    return law


def substituted(
    values: Mapping[str, Any], cell: Cell, law: ContactLaw, *expressions: sp.Expr
) -> tuple[Any, ...]:
    """Substitute values in a cell, a law and expressions, as `lwa.cell.substitution`."""
    others = set().union(*(x.free_symbols for x in expressions)) - {*cell.symbols, *law.symbols}
    new = substitution(values, cell, more=(*law.symbols, *sorted(others, key=str)))
    return cell.replaced(new), law.replaced(new), *(x.xreplace(new) for x in expressions)
