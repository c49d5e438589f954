"""The terms of one order in the spacing: jets with their coefficients, and their notation.

A jet is a product of ``(∂_x^i u / base)^e`` and ``(∂_x^i u_τ / base^{(k+1)/2})^e``, where the base
is ``u_x`` (on the optical branch u). A term is ``coefficient · base^{a + bk} · jet``, with the same
``a + bk`` for all terms; the powers of the base are collected in print, as in ``u_x^{k-3} u_xx^3``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import NamedTuple

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.jets import Jet, Powers
from lwa.algebra.model import Model, Term
from lwa.base import latex
from lwa.base.frozen import Value
from lwa.closure.consistency import Closure

_SHOWN = 3  # terms that `Terms.__repr__` prints in full


class BasePower(NamedTuple):
    """The power ``base^{a + bk}``; under a law that is no power ``base^{a + b} F′^b``."""

    a: Fraction | int
    b: Fraction | int

    def beside(self, jet: Jet) -> BasePower:
        """The power of the base beside a jet that is written with bare derivatives.

        As in ``u_x^k · (u_xx/u_x)² = u_x^{k-2} u_xx²``.
        """
        # A factor ∂_x^i u is divided by the base, a factor ∂_x^i u_τ by base^{(k+1)/2}.
        strains = sum(e for _, e in jet.x)
        halves = Fraction(sum(e for _, e in jet.t), 2)
        return BasePower(self.a - strains - halves, self.b - halves)


# The powers p^k, p and p^{k+1} of the base p, by which forces, strains and energies are written
FORCE = BasePower(a=0, b=1)
STRAIN = BasePower(a=1, b=0)
ENERGY = BasePower(a=1, b=1)


@dataclass(frozen=True, eq=False, repr=False)
class Terms(Value, Mapping[Jet, sp.Expr]):
    """Mapping from jets to coefficients at one order; a coefficient becomes SymPy on lookup.

    A jet without u_τ may also be given by its plain tuple, as in ``terms[(2, 1), (3, 1)]``.

    Parameters
    ----------
    model : Model
    raw : dict
        Mapping from jets to the terms of their coefficients in the model's ring.
    power : BasePower
        The power of the base that multiplies all terms.
    """

    model: Model
    raw: dict[Jet, list[Term]]
    power: BasePower = FORCE

    def __getitem__(self, jet: Jet | Powers) -> sp.Expr:
        jet = jet if isinstance(jet, Jet) else Jet(jet)
        return self._coefficient(jet)

    @cached_property
    def _coefficient(self) -> Callable[[Jet], sp.Expr]:
        """The coefficient of a jet, converted once."""
        return cache(lambda jet: self.model.expression(self.raw[jet]))

    def __iter__(self) -> Iterator[Jet]:
        return iter(self.raw)

    def __len__(self) -> int:
        return len(self.raw)

    def __eq__(self, other: object) -> bool:
        # Equal polynomials of one model need no conversion.
        if isinstance(other, Terms) and self.__getstate__() == other.__getstate__():
            return True
        return Mapping.__eq__(self, other)

    def __hash__(self) -> int:
        # The jets alone: to convert all coefficients takes long.
        return hash(frozenset(self.raw))

    def __repr__(self) -> str:
        """The first terms as text; a long coefficient is represented by its number of terms."""
        rows: list[str] = []
        # Short coefficients only: a repr is one line at any order.
        for jet, coefficient in self.raw.items():
            if len(rows) < _SHOWN and len(coefficient) <= _SHOWN:
                rows.append(f"{self.text(jet)}: {self[jet]}")
        more = len(self) - len(rows)
        if more:
            rows.append(f"{more} more" if rows else f"{more} terms")
        return f"{{{', '.join(rows)}}}"

    def text(self, jet: Jet) -> str:
        """The jet as text with its power of the base, such as ``u_x^(k-3) u_xx^3``."""
        factors = []
        for name, exponent in self._factors(jet):
            name = re.sub("[{}]", "", name).replace(r"\tau", "τ")
            # A negative or composed exponent needs parentheses: u_x^(-1).
            power = str(exponent).replace(" ", "")
            if not power.isalnum():
                power = f"({power})"
            factors.append(name if power == "1" else f"{name}^{power}")
        return " ".join(factors) or "1"

    def latex(self, jet: Jet) -> str:
        """The jet in the paper's notation, such as ``u_x^{k-3} u_{xx}^{3}``."""
        factors = []
        for name, exponent in self._factors(jet):
            power = sp.latex(exponent, fold_short_frac=True)
            # SymPy's spaces around signs would widen an exponent.
            power = re.sub(r" ?([-+/]) ", r"\1", power)
            factors.append(name if power == "1" else f"{name}^{{{power}}}")
        return " ".join(factors) or "1"

    def _factors(self, jet: Jet) -> list[tuple[str, sp.Expr]]:
        """Names, in LaTeX, and exponents of the factors: F′, the base, the derivatives."""
        # A jet is a quotient by powers of the base. Printed with bare derivatives it leaves them to
        # the base, whose power here is base^{a + bk}.
        a, b = map(sp.Rational, self.power.beside(jet))
        # u_x on the acoustic branch
        base = latex.derivative(1) if self.model.base else "u"
        law = self.model.law
        # F′ belongs to a law that is no power; of a power it is joined to the base.
        if law.homogeneous:
            factors = [(base, a + b * law.exponent)]
        else:
            factors = [("F'", b), (base, a + b)]
        factors += [(latex.derivative(i), e) for i, e in jet.x]
        factors += [(latex.derivative(i, r"\tau"), e) for i, e in jet.t]
        return [(name, exponent) for name, exponent in factors if exponent != 0]

    @property
    def nonlinear(self) -> Terms:
        """The terms that are nonlinear in the field: those of more than one derivative."""
        raw = {}
        for jet, coefficient in self.raw.items():
            if sum(e for _, e in (*jet.x, *jet.t)) > 1:
                raw[jet] = coefficient
        return Terms(self.model, raw, self.power)

    def latex_rows(self) -> list[str]:
        """LaTeX of the sum of the terms, in one row."""
        return [latex.total((self[jet], self.latex(jet)) for jet in self)]


def terms(closure: Closure, polynomial: fmpq_mpoly, power: BasePower = FORCE) -> Terms:
    """Convert a polynomial of the closure's algebra into jets of the field.

    Parameters
    ----------
    closure : Closure
    polynomial : element
    power : BasePower
        The power of the base that multiplies the polynomial.

    Returns
    -------
    Terms
    """
    raw = closure.solution.algebra.terms(polynomial, closure.model.base)
    ordered = {jet: raw[jet] for jet in sorted(raw, key=_papers_order)}
    return Terms(closure.model, ordered, power)


def _papers_order(jet: Jet) -> tuple[bool, int, Jet]:
    """Sort key of jets: u_xx³, u_xx u_xxx, u_xxxx; those with u_τ last."""
    derivatives = sum(e for _, e in jet.x)
    return bool(jet.t), -derivatives, jet


def by_order(orders: Mapping[int, Terms], heading: str) -> list[str]:
    """Lines of text with the terms of each order n, under the heading ``heading.format(n)``."""
    lines = []
    for n, of_order in orders.items():
        if of_order:
            lines.append(f"  {heading.format(n)}:")
        for jet, coefficient in of_order.items():
            lines.append(f"    {of_order.text(jet)}: {coefficient}")
    return lines


def latex_by_order(
    leading: Sequence[str],
    orders: Mapping[int, Terms],
    spacing: sp.Expr,
    base: int = 0,
    most: int | None = None,
) -> str:
    """LaTeX of a sum: leading summands, then ``D^{n - base}`` times the terms of each order n.

    Parameters
    ----------
    leading : sequence of str
        The leading summands.
    orders : mapping
        The terms by their orders.
    spacing : expression
        The spacing D.
    base : int
        The order at ``D^0``.
    most : int, optional
        Orders above this one are dots; all are written when not given.

    Returns
    -------
    str
    """
    summands = [(sp.S.One, summand) for summand in leading]
    for n, of_order in orders.items():
        # An order that vanishes is left out.
        if not of_order:
            continue
        if most is not None and n > most:
            summands.append((sp.S.One, r"\cdots"))
            break
        D = latex.power(spacing, n - base)
        # A single term needs no parentheses.
        if len(of_order) == 1:
            ((jet, coefficient),) = of_order.items()
            summands.append((coefficient, f"{D} {of_order.latex(jet)}"))
        else:
            (row,) = of_order.latex_rows()
            summands.append((sp.S.One, rf"{D} \Bigl({row}\Bigr)"))
    return latex.total(summands)
