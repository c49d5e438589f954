"""The ring of a derivation's coefficients, and its conversion to SymPy.

Coefficients are polynomials in the exponent k, the mass fractions m̂_i = m_i/M and the strain
shares C_i of the P contacts: the ring Q[k, m̂, C]. Under a law other than a power the parameters
φ_2, φ_3, … of `lwa.law` stand in the place of k. Polynomials are python-flint's `fmpq_mpoly`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp
from flint import (
    Ordering,
    fmpq,
    fmpq_mpoly,
    fmpq_mpoly_ctx,
)
from sympy.polys.polyerrors import BasePolynomialError

from lwa.base.exact import factored
from lwa.base.frozen import Value
from lwa.law import phi_symbol

Term = tuple[tuple[int, ...], fmpq]
"""One term of a coefficient: the exponents of the ring's generators, and its rational factor."""


def to_flint(value: sp.Expr) -> fmpq:
    """Convert a rational of SymPy to python-flint."""
    return fmpq(int(value.p), int(value.q))


def to_sympy(value: fmpq) -> sp.Rational:
    """Convert a rational of python-flint to SymPy."""
    return sp.Rational(int(value.p), int(value.q))


@dataclass(frozen=True)
class Partition(Value):
    """Positive weights w_i, and their fractions f_i = total · w_i / Σ_j w_j in a coefficient ring.

    The masses of a cell are such weights (total 1), and so are the compliances of its contacts
    (total P). Rational fractions are numbers of the ring. Of other fractions each distinct one but
    the last is a generator of the ring.
    """

    weights: tuple[sp.Expr, ...]
    total: int
    letter: str

    @cached_property
    def distinct(self) -> tuple[sp.Expr, ...]:
        """The weights without repetition, in the order of their first appearance."""
        return tuple(dict.fromkeys(self.weights))

    @cached_property
    def rational(self) -> dict[sp.Expr, sp.Rational]:
        """Mapping from each weight to its fraction; {} unless all fractions are rational."""
        # Ratios may be rational where weights are not, such as m and 2m.
        first = self.distinct[0]
        ratios = {}
        for weight in self.distinct:
            ratios[weight] = factored(weight / first)
            if not ratios[weight].is_Rational:
                return {}
        unit = self.total / sp.Add(*(ratios[w] for w in self.weights))
        return {weight: unit * ratio for weight, ratio in ratios.items()}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring's generators: one per distinct weight but the last."""
        # Numbers need no generator.
        if self.rational:
            return ()
        return tuple(f"{self.letter}{i}" for i in range(len(self.distinct) - 1))

    def elements(self, context: fmpq_mpoly_ctx) -> list[fmpq_mpoly]:
        """The fractions f_0, f_1, … in a ring that has `names` among its generators."""
        if self.rational:
            constants = map(to_flint, map(self.rational.get, self.weights))
            return list(map(context.constant, constants))
        # The last fraction is what the others leave of the total.
        fractions = {}
        rest = context.constant(self.total)
        for weight, name in zip(self.distinct, self.names, strict=False):
            fractions[weight] = context.gen(context.variable_to_index(name))
            rest = rest - self.weights.count(weight) * fractions[weight]
        last = self.distinct[-1]
        fractions[last] = rest / self.weights.count(last)
        return [fractions[weight] for weight in self.weights]


@dataclass(frozen=True)
class CoefficientRing(Value):
    """The ring Q[law, m̂, C] of a derivation's coefficients.

    k : exponent of a power law, a number or an expression; 1 + φ_2 of another law.
    highest : index n of the last generator φ_n; 0 for a power law.
    masses, contacts : the mass fractions m̂_i and the shares C_i of the contacts.
    """

    k: sp.Expr
    highest: int
    masses: Partition
    contacts: Partition

    @cached_property
    def law(self) -> dict[str, sp.Expr]:
        """Mapping from the generators of the contact law, k or φ_2, φ_3, …, to their values."""
        # A rational k is a number of the ring.
        if self.highest:
            symbols = map(phi_symbol, range(2, self.highest + 1))
            return {symbol.name: symbol for symbol in symbols}
        return {} if self.k.is_Rational else {"k": self.k}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring's generators."""
        return (*self.law, *self.masses.names, *self.contacts.names)

    def exponent(self, context: fmpq_mpoly_ctx) -> fmpq_mpoly:
        """The exponent k as an element of a ring that has `names` among its generators."""
        if self.highest:
            # d ln(δ F′)/d ln δ
            return 1 + context.gen(context.variable_to_index("phi2"))
        if self.k.is_Rational:
            return context.constant(to_flint(self.k))
        return context.gen(context.variable_to_index("k"))

    def phi(self, context: fmpq_mpoly_ctx, most: int) -> list[fmpq_mpoly]:
        """The law's parameters φ_0 = 0, φ_1 = 1, φ_2, … as elements of such a ring.

        Those of a power are (k-1) … (k-n+1), given to φ_most.
        """
        # φ_0 has no meaning; it makes places of the list and indices agree.
        found = [context.constant(0), context.constant(1)]
        if self.highest:
            return found + [context.gen(context.variable_to_index(n)) for n in self.law]
        k = self.exponent(context)
        for n in range(1, most):
            found.append(found[n] * (k - n))
        return found

    @cached_property
    def expression(self) -> Conversion:
        """The conversion of polynomials to factored SymPy expressions in the caller's symbols.

        >>> m1, m2, k = sp.symbols("m1 m2 k")
        >>> masses, contacts = Partition((m1, m2), 1, "mu"), Partition((sp.S.One,), 1, "c")
        >>> ring = CoefficientRing(k, 0, masses, contacts)
        >>> ring.expression([((1, 1), fmpq(1)), ((1, 2), fmpq(-1))])  # k m̂_0 - k m̂_0²
        k*m1*m2/(m1 + m2)**2
        """
        return Conversion(self)


class Conversion:
    """Conversion of a ring's polynomials to factored SymPy expressions in the caller's symbols.

    The fractions f_i = total · w_i/Σw of a partition have one denominator. A polynomial of degree d
    in them, made homogeneous by powers of Σf/total = 1, is therefore the polynomial of the same
    form in total · w_i and Σw, divided by (Σw)^d. The polynomials are composed, divided and
    factored by python-flint; SymPy takes thirty times as long.
    """

    def __init__(self, ring: CoefficientRing) -> None:
        self._partitions = [p for p in (ring.masses, ring.contacts) if p.names]
        # Values of the generators
        values = list(ring.law.values())
        for partition in self._partitions:
            values += partition.distinct
        symbols = sorted(set().union(*(v.free_symbols for v in values)), key=str)
        # Without a generator SymPy would take an irrational number for one.
        symbols = symbols or [sp.Dummy()]
        # An expression that is no polynomial over Q, such as A^{-1/k}, is a generator of its own.
        letters = {}
        for value in values:
            try:
                sp.Poly(value, *symbols, domain="QQ")
            except BasePolynomialError:
                letters[value] = sp.Dummy()
        self._printed = [*symbols, *letters]
        self._context = _context(len(self._printed))

        def element(value: sp.Expr) -> fmpq_mpoly:
            generators = (*symbols, *letters.values())
            polynomial = sp.Poly(letters.get(value, value), *generators, domain="QQ")
            terms = {e: to_flint(c) for e, c in polynomial.terms()}
            return self._context.from_dict(terms)

        # Values of the polynomials' generators: those of the law, then total · w_i.
        self._images = list(map(element, ring.law.values()))
        # For each partition the places of its generators, and Σw
        self._blocks = []
        self._sums = []
        for partition in self._partitions:
            start = len(self._images)
            for weight in partition.distinct[:-1]:
                self._images.append(partition.total * element(weight))
            self._blocks.append(slice(start, len(self._images)))
            zero = self._context.constant(0)
            self._sums.append(sum(map(element, partition.weights), zero))
        self._source = _context(len(self._images) + len(self._sums))

    def __call__(self, terms: Sequence[Term]) -> sp.Expr:
        """Convert a polynomial, given by its terms: exponents by the ring's names, coefficient."""
        # Degrees in the fractions of each partition
        degrees = []
        for block in self._blocks:
            degrees.append(max((sum(e[block]) for e, _ in terms), default=0))
        homogeneous = {}
        for e, coefficient in terms:
            lacking = [
                d - sum(e[b]) for d, b in zip(degrees, self._blocks, strict=True)
            ]
            homogeneous[(*e, *lacking)] = coefficient
        numerator = self._source.from_dict(homogeneous)
        numerator = numerator.compose(*self._images, *self._sums, ctx=self._context)
        if numerator.is_zero():
            return sp.S.Zero
        # Lowest terms
        denominator = self._context.constant(1)
        for total, degree in zip(self._sums, degrees, strict=True):
            denominator = denominator * total**degree
        common = numerator.gcd(denominator)
        above, factors = (numerator / common).factor()
        below, divisors = (denominator / common).factor()
        powers = [self._sum(factor) ** int(e) for factor, e in factors]
        powers += [self._sum(factor) ** -int(e) for factor, e in divisors]
        # One product: a number times a lone sum would be multiplied out.
        return sp.Mul(to_sympy(above / below), *powers)

    def _sum(self, polynomial: fmpq_mpoly) -> sp.Expr:
        """Convert a polynomial to a sum of products of the caller's expressions."""
        products = []
        for exponents, coefficient in polynomial.terms():
            powers = map(sp.Pow, self._printed, map(int, exponents))
            products.append(sp.Mul(to_sympy(coefficient), *powers))
        return sp.Add(*products)


def _context(count: int) -> fmpq_mpoly_ctx:
    """The ring Q[x_0, …] with ``count`` generators."""
    return fmpq_mpoly_ctx.get([f"x{i}" for i in range(count)], Ordering.lex)
