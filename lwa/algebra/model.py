"""The model of a derivation, a cell, its contact law and a branch, and its coefficients' ring.

Everything the theory derives is a polynomial in the jets of the field whose coefficients are
polynomials in the exponent k, the mass fractions m̂_i = m_i/M and the strain shares C_i of the
P contacts: the ring Q[k, m̂, C]. Under a law other than a power the parameters φ_2, φ_3, … of
`lwa.law` stand in the place of k.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp
from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.jets import JetAlgebra
from lwa.algebra.rational import context, factored, to_flint, to_sum, to_sympy
from lwa.base.frozen import Value
from lwa.cell import Cell, substitution
from lwa.law import ContactLaw, for_cell, phi_symbol


@dataclass(frozen=True)
class Partition(Value):
    """Positive weights w_i, and their fractions f_i = total · w_i / Σ_j w_j in a coefficient ring.

    The masses of a cell are such weights (total 1), and so are the compliances of its contacts
    (total P). Rational fractions are numbers; else each distinct fraction but the last is a
    generator of a python-flint ring.
    """

    weights: tuple[sp.Expr, ...]
    total: int
    letter: str

    @cached_property
    def distinct(self) -> tuple[sp.Expr, ...]:
        """The weights without repetition, in the order of their first appearance."""
        return tuple(dict.fromkeys(self.weights))

    @cached_property
    def values(self) -> tuple[sp.Expr, ...] | None:
        """The fraction f_i of each distinct weight if all are rational, else None."""
        first = self.distinct[0]
        ratios = [
            w / first if w.is_number else factored(w / first) for w in self.weights
        ]
        if not all(ratio.is_Rational for ratio in ratios):
            return None
        return tuple(self.total * w / first / sp.Add(*ratios) for w in self.distinct)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring generators: one per distinct weight but the last."""
        count = 0 if self.values else len(self.distinct) - 1
        return tuple(f"{self.letter}{i}" for i in range(count))

    def elements(self, context: fmpq_mpoly_ctx) -> list[fmpq_mpoly]:
        """The fractions f_0, f_1, … in a ring that has `names` among its generators."""
        if self.values:
            fractions = [context.constant(to_flint(f)) for f in self.values]
        else:
            fractions = [
                context.gen(context.variable_to_index(name)) for name in self.names
            ]
            rest = context.constant(self.total)
            for weight, f in zip(self.distinct, fractions, strict=False):
                rest = rest - self.weights.count(weight) * f
            fractions.append(rest / self.weights.count(self.distinct[-1]))
        by_weight = dict(zip(self.distinct, fractions, strict=True))
        return [by_weight[w] for w in self.weights]


@dataclass(frozen=True)
class CoefficientRing(Value):
    """The ring Q[variables, m̂, C, constants] of a derivation's coefficients.

    k : the exponent, a number, a variable, or 1 + φ_2.
    variables : k unless it is rational, or the symbols of φ_2, φ_3, ….
    masses, contacts : the mass fractions m̂_i and the shares C_i of the contacts.
    """

    k: sp.Expr
    variables: tuple[sp.Expr, ...]
    masses: Partition
    contacts: Partition

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring's generators."""
        return (*self._parameters, *self.masses.names, *self.contacts.names)

    @property
    def _parameters(self) -> tuple[str, ...]:
        return (
            ("k",) if self.variables == (self.k,) else tuple(map(str, self.variables))
        )

    def exponent(self, context: fmpq_mpoly_ctx) -> fmpq_mpoly:
        """The exponent k as an element of a ring that has `names` among its generators."""
        if self.k.is_Rational:
            return context.constant(to_flint(self.k))
        generator = context.gen(context.variable_to_index(self._parameters[0]))
        return generator if self.variables == (self.k,) else 1 + generator

    @cached_property
    def expression(self) -> Callable[[Sequence[tuple[tuple[int, ...], fmpq]]], sp.Expr]:
        """The conversion of polynomials to factored SymPy expressions in the caller's symbols.

        A polynomial is given by its terms (exponents in the order of `names`, coefficient).

        >>> m1, m2, k = sp.symbols("m1 m2 k")
        >>> contacts = Partition((sp.S.One,), 1, "c")
        >>> ring = CoefficientRing(k, (k,), Partition((m1, m2), 1, "mu"), contacts)
        >>> ring.expression([((1, 1), fmpq(1)), ((1, 2), fmpq(-1))])
        k*m1*m2/(m1 + m2)**2
        """
        partitions = [part for part in (self.masses, self.contacts) if part.names]
        values = [w for part in partitions for w in part.distinct] + list(
            self.variables
        )
        symbols = sorted(set().union(*(v.free_symbols for v in values)), key=str)
        polynomials = {v: _as_polynomial(v, symbols) for v in values}
        opaque = [
            v for v, found in polynomials.items() if found is None and not v.is_Rational
        ]
        generators = [*symbols, *opaque]
        ring = context(len(generators))

        def element(value: sp.Expr) -> fmpq_mpoly:
            if value.is_Rational:
                return ring.constant(to_flint(value))
            if (found := polynomials[value]) is None:
                return ring.gen(generators.index(value))
            padding = (0,) * len(opaque)
            return ring.from_dict(
                {(*e, *padding): to_flint(c) for e, c in found.terms()}
            )

        # The fractions total · w_i/Σw of a partition have the denominator Σw: each polynomial is
        # made homogeneous in the total · w_i and one more generator, whose image is Σw.
        images, blocks, sums = [element(value) for value in self.variables], [], []
        for part in partitions:
            start = len(images)
            images += [part.total * element(w) for w in part.distinct[:-1]]
            blocks.append(slice(start, len(images)))
            sums.append(sum((element(w) for w in part.weights), ring.constant(0)))
        source = context(len(images) + len(sums))

        def convert(terms: Sequence[tuple[tuple[int, ...], fmpq]]) -> sp.Expr:
            degrees = [
                max((sum(e[block]) for e, _ in terms), default=0) for block in blocks
            ]
            homogeneous = {
                (
                    *e,
                    *(
                        d - sum(e[block])
                        for d, block in zip(degrees, blocks, strict=True)
                    ),
                ): c
                for e, c in terms
            }
            numerator = source.from_dict(homogeneous).compose(*images, *sums, ctx=ring)
            if numerator.is_zero():
                return sp.S.Zero
            powers = []
            for total, degree in zip(sums, degrees, strict=True):
                while degree and (parts := divmod(numerator, total))[1].is_zero():
                    numerator, degree = parts[0], degree - 1
                powers.append(to_sum(total, generators) ** -degree)
            constant, factors = numerator.factor()
            powers += [to_sum(factor, generators) ** int(e) for factor, e in factors]
            # One product: a number times a lone sum would be multiplied out.
            return sp.Mul(to_sympy(constant), *powers)

        return convert


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

    def algebra(
        self, weight: int, velocity: bool = False, rest: bool = False
    ) -> JetAlgebra:
        """The algebra of the jets over the ring; with ``velocity`` also the jets of u_τ."""
        exponent = self.ring.exponent if velocity else None
        return JetAlgebra(self.ring.names, weight, exponent, rest, smooth=self.highest)

    def elements(
        self, algebra: JetAlgebra
    ) -> tuple[fmpq_mpoly, list[fmpq_mpoly], list[fmpq_mpoly]]:
        """The exponent k, the mass fractions m̂_i and the shares C_i in an algebra of the model."""
        masses, contacts = self.ring.masses, self.ring.contacts
        context = algebra.context
        return (
            self.ring.exponent(context),
            masses.elements(context),
            contacts.elements(context),
        )

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


def _as_polynomial(value: sp.Expr, symbols: list[sp.Symbol]) -> sp.Poly | None:
    """The polynomial over Q in these symbols; None for another expression."""
    if not symbols:  # SymPy would take an irrational number for the generator
        return None
    try:
        return sp.Poly(value, *symbols, domain="QQ")
    except sp.polys.polyerrors.BasePolynomialError:
        return None
