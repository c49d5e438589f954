"""The terms of one order in the spacing: jets with their coefficients, and their notation.

A jet is a product of (∂_x^i u / base)^e and (∂_x^i u_τ / base^{(k+1)/2})^e, the base u_x (on the
optical branch u). A term is coefficient · base^{a + bk} · jet, a + bk the same for all of them; the
powers of the base are collected in print, as in u_x^{k-3} u_xx^3.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.jets import JetAlgebra, Powers, Term
from lwa.algebra.model import Model
from lwa.base import latex
from lwa.base.frozen import Shown
from lwa.closure.consistency import Closure

FORCE, STRAIN, ENERGY = (0, 1), (1, 0), (1, 1)
"""Powers (a, b) of the base, base^{a + bk}, of a force, a strain and an energy."""

_SHOWN = 3  # terms that `Terms.__repr__` prints in full


class Jet(NamedTuple):
    """A product of powers (∂_x^i u / base)^e and (∂_x^i u_τ / base^{(k+1)/2})^e.

    ``x`` and ``t`` are the tuples of (i, e) of the two kinds. The base is u_x, or u on the
    optical branch.
    """

    x: Powers
    t: Powers = ()

    def base_power(self, power: tuple[int, int]) -> tuple[Fraction, Fraction]:
        """Power (a, b) of the base, base^{a + bk}, that is left beside the bare derivatives."""
        halves = Fraction(sum(e for _, e in self.t), 2)
        return power[0] - sum(e for _, e in self.x) - halves, power[1] - halves


class Terms(Shown, Mapping[Jet, sp.Expr]):
    """Mapping from jets to coefficients at one order; a coefficient becomes SymPy on lookup.

    A jet without u_τ may also be given by its plain tuple, as in ``terms[(2, 1), (3, 1)]``.
    ``divisor`` divides all coefficients.
    """

    def __init__(
        self,
        model: Model,
        raw: dict[Jet, list[Term]],
        power: tuple[int, int] = FORCE,
        divisor: sp.Expr = sp.S.One,
    ) -> None:
        self.power = power
        self._model, self._raw, self._divisor = model, raw, divisor
        self._converted: dict[Jet, sp.Expr] = {}

    def __getitem__(self, jet: Jet | Powers) -> sp.Expr:
        jet = jet if isinstance(jet, Jet) else Jet(jet)
        if jet not in self._converted:
            self._converted[jet] = (
                self._model.ring.expression(self._raw[jet]) / self._divisor
            )
        return self._converted[jet]

    def __iter__(self) -> Iterator[Jet]:
        return iter(self._raw)

    def __len__(self) -> int:
        return len(self._raw)

    def _fields(self) -> tuple[Any, ...]:
        return (self._model, self._raw, self.power, self._divisor)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Terms) and self._fields() == other._fields():
            return True
        return Mapping.__eq__(self, other)

    def __hash__(self) -> int:
        return hash(frozenset(self._raw))

    def __reduce__(self) -> tuple[type[Terms], tuple[Any, ...]]:
        return Terms, self._fields()

    def __repr__(self) -> str:
        """The first terms as text; a long coefficient is represented by its number of terms."""
        first = [jet for jet in self if len(self._raw[jet]) <= _SHOWN][:_SHOWN]
        rows = [f"{jet}: {self[jet]}" for jet in first]
        more = len(self) - len(rows)
        rows += [f"{more} more" if rows else f"{more} terms"] if more else []
        return f"{{{', '.join(rows)}}}"

    def text(self, jet: Jet) -> str:
        """The jet as text with its power of the base, such as u_x^(k-3) u_2x^3."""

        def derivative(i: int, tau: bool) -> str:
            place = "" if i == 0 else "x" if i == 1 else f"{i}x"
            return f"u_{place}{'τ' if tau else ''}"

        return self._product(jet, derivative, ("({})", "{}"))

    def latex(self, jet: Jet) -> str:
        """The jet in the paper's notation, such as u_x^{k-3} u_{xx}^{3}."""

        def derivative(i: int, tau: bool) -> str:
            return latex.derivative(i, r"\tau" if tau else "")

        return self._product(jet, derivative, ("{{{}}}", "{{{}}}"))

    def _product(
        self, jet: Jet, derivative: Callable[[int, bool], str], styles: tuple[str, str]
    ) -> str:
        """The product of the powers of the base (of F′ too if the law is no power) and the jet.

        styles : formats of the exponents of the base and of the derivatives.
        """
        a, b = jet.base_power(self.power)
        base = derivative(1, False) if self._model.base else "u"
        powers = [(base, _exponent(a, b), styles[0])]
        if not self._model.law.homogeneous:
            powers = [("F'", str(b), styles[0]), (base, str(a + b), styles[0])]
        for row, tau in ((jet.x, False), (jet.t, True)):
            powers += [(derivative(i, tau), str(e), styles[1]) for i, e in row]
        factors = (
            name if e == "1" else f"{name}^{style.format(e)}"
            for name, e, style in powers
            if e != "0"
        )
        return " ".join(factors) or "1"

    def latex_rows(self) -> list[str]:
        """LaTeX of the sum of the terms, in one row."""
        return [latex.total((self[jet], self.latex(jet)) for jet in self)]


def _exponent(a: Fraction, b: Fraction) -> str:
    """The exponent a + bk as text, such as k-3."""
    if not b:
        return str(a)
    slope = {"1": "k", "-1": "-k"}.get(str(b), f"{b}k")
    return slope + (f"{'+' if a > 0 else '-'}{abs(a)}" if a else "")


def terms(
    closure: Closure,
    polynomial: fmpq_mpoly,
    power: tuple[int, int] = FORCE,
    divisor: sp.Expr = sp.S.One,
    algebra: JetAlgebra | None = None,
) -> Terms:
    """Convert a polynomial of the closure's algebra (or another one) into jets of the field."""
    base = closure.model.base
    raw = {
        Jet(tuple((n + base, e) for n, e in monomial.x), monomial.t): coefficient
        for monomial, coefficient in (algebra or closure.algebra)
        .terms(polynomial)
        .items()
    }
    # The paper's order: u_xx³, u_xx u_xxx, u_xxxx; jets with u_τ last.
    ordered = sorted(raw, key=lambda jet: (bool(jet.t), -sum(e for _, e in jet.x), jet))
    return Terms(closure.model, {jet: raw[jet] for jet in ordered}, power, divisor)


def by_order(
    coefficients: Mapping[int, Terms], form: str, linear: bool = True
) -> list[str]:
    """Lines of text with the terms of each order n, under the heading ``form.format(n)``.

    linear : False leaves out the terms that are linear in one jet.
    """
    lines = []
    for n, found in coefficients.items():
        jets = [jet for jet in found if linear or jet.t or sum(e for _, e in jet.x) > 1]
        rows = [f"    {found.text(jet)}: {found[jet]}" for jet in jets]
        lines += [f"  {form.format(n)}:", *rows] if rows else []
    return lines
