"""The model of a derivation: a cell, its contact law, a branch and an order; and its ring.

Coefficients are polynomials with rational coefficients in the exponent k, the mass fractions
``m̂_i = m_i/M`` and the strain shares ``C_i`` of the P contacts. Under a law other than a power the
parameters ``φ_2, φ_3, …`` of `lwa.law` stand in the place of k. Polynomials are python-flint's
`fmpq_mpoly`; `Conversion` makes them expressions of SymPy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx
from sympy.polys.polyerrors import BasePolynomialError

from lwa.base.exact import factored
from lwa.base.frozen import Value
from lwa.base.words import BranchName
from lwa.cell import Cell, Parametric
from lwa.law import ContactLaw, phi_symbol

Term = tuple[tuple[int, ...], fmpq]
"""One term of a coefficient: the exponents of the ring's generators, and its rational factor."""


def to_flint(value: sp.Expr) -> fmpq:
    """Convert a rational of SymPy to python-flint."""
    return fmpq(int(value.p), int(value.q))


def to_sympy(value: fmpq) -> sp.Rational:
    """Convert a rational of python-flint to SymPy."""
    return sp.Rational(int(value.p), int(value.q))


def generator(context: fmpq_mpoly_ctx, name: str) -> fmpq_mpoly:
    """The generator of a ring that has this name."""
    return context.gen(context.variable_to_index(name))


@dataclass(frozen=True)
class Partition(Value):
    """Positive weights ``w_i`` and their fractions ``total · w_i / Σ_j w_j`` in a ring.

    The masses of a cell are such weights (total 1), and so are the compliances of its contacts
    (total P). Rational fractions are numbers of the ring. Of other fractions each distinct one but
    the last is a generator of the ring.

    Parameters
    ----------
    weights : tuple of expressions
    total : int
        The sum of the fractions.
    letter : str
        First letter of the generators' names.
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
        # Fractions may be rational where weights are not, such as m and 2m.
        sum_of_weights = sp.Add(*self.weights)
        fractions = {}
        for weight in self.distinct:
            fraction = factored(self.total * weight / sum_of_weights)
            if not fraction.is_Rational:
                return {}
            fractions[weight] = fraction
        return fractions

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring's generators: one per distinct weight but the last."""
        # Numbers need no generator.
        if self.rational:
            return ()
        return tuple(f"{self.letter}{i}" for i in range(len(self.distinct) - 1))

    def elements(self, context: fmpq_mpoly_ctx) -> list[fmpq_mpoly]:
        """The fractions ``f_0, f_1, …`` in a ring that has `names` among its generators."""
        rational = self.rational.items()
        fractions = {w: context.constant(to_flint(value)) for w, value in rational}
        if not fractions:
            # The last fraction is what the others leave of the total.
            rest = context.constant(self.total)
            for weight, name in zip(self.distinct, self.names, strict=False):
                fraction = generator(context, name)
                fractions[weight] = fraction
                rest = rest - self.weights.count(weight) * fraction
            last = self.distinct[-1]
            fractions[last] = rest / self.weights.count(last)
        return [fractions[weight] for weight in self.weights]


@dataclass(frozen=True)
class Model(Parametric):
    """A chain, one of its branches, and the order of a theory, with the ring of its coefficients.

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

    @property
    def highest(self) -> int:
        """Index n of the ring's last generator ``φ_n``; 0 for a power law."""
        if self.law.homogeneous:
            return 0
        # The equation to D^{k+order-1} holds φ_{order-1}, and k = 1 + φ_2 always φ_2.
        return max(self.order - 1, 2)

    @cached_property
    def masses(self) -> Partition:
        """The mass fractions ``m̂_i``, whose sum is 1."""
        return Partition(self.cell.masses, total=1, letter="mu")

    @cached_property
    def contacts(self) -> Partition:
        """The shares ``C_i`` of the contacts.

        On the acoustic branch all contacts carry one force at leading order, and the C_i are shares
        of the strain, proportional to the compliances; their sum is the number of contacts in a
        cell. On the optical branch all contacts are compressed by equal amounts, and the C_i are
        shares of the stiffness, proportional to A_i; their sum is 1.
        """
        if self.branch == "optical":
            # The forces of a bead's two contacts add up: so do their shares, to 1.
            return Partition(self.cell.stiffnesses, total=1, letter="c")
        # u_x is the mean of the strains C_i u_x of the contacts: the mean of the C_i is 1.
        compliances = self.cell.compliances(self.law.exponent)
        return Partition(compliances, total=self.cell.size, letter="c")

    @cached_property
    def parameters(self) -> dict[str, sp.Expr]:
        """Mapping from the names of the contact law's generators, k or phi2, …, to their values."""
        if self.highest:
            symbols = map(phi_symbol, range(2, self.highest + 1))
            return {symbol.name: symbol for symbol in symbols}
        # A rational k is a number of the ring.
        return {} if self.k.is_Rational else {"k": self.k}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring's generators."""
        return (*self.parameters, *self.masses.names, *self.contacts.names)

    def phi(self, context: fmpq_mpoly_ctx, most: int) -> list[fmpq_mpoly]:
        """The law's parameters ``φ_0 = 0, φ_1 = 1, φ_2, …`` as elements of a ring.

        Parameters
        ----------
        context : fmpq_mpoly_ctx
            The ring, which has `names` among its generators.
        most : int
            Index of the last parameter of a power; of another law all generators are given.

        Returns
        -------
        list of elements
        """
        # φ_0 has no meaning; it makes places of the list and indices agree.
        found = [context.constant(0), context.constant(1)]
        if self.highest:
            for name in self.parameters:
                found.append(generator(context, name))
            return found
        # The φ_n of a power are (k-1) … (k-n+1).
        if self.k.is_Rational:
            k = context.constant(to_flint(self.k))
        else:
            k = generator(context, "k")
        for n in range(1, most):
            found.append(found[n] * (k - n))
        return found

    @cached_property
    def expression(self) -> Conversion:
        """The conversion of polynomials to factored SymPy expressions in the caller's symbols.

        A polynomial is given by its terms, pairs of the generators' exponents and a factor.

        >>> from lwa import Power
        >>> model = Model(Cell(["m1", "m2"]), Power("k"))
        >>> model.expression([((1, 1), fmpq(1)), ((1, 2), fmpq(-1))])  # k m̂_0 - k m̂_0²
        k*m1*m2/(m1 + m2)**2
        """
        return Conversion(self)


class Conversion:
    """Conversion of a ring's polynomials to factored SymPy expressions in the caller's symbols.

    The fractions ``f_i = total · w_i / S`` of a partition have one denominator, the sum S of the
    weights. Let each term of a polynomial of degree d in them be multiplied by the power of S/S
    that it lacks of the degree. Then the polynomial is one in ``total · w_i`` and S, over ``S^d``.
    python-flint composes, divides and factors it; SymPy takes thirty times as long.

    Parameters
    ----------
    model : Model
    """

    def __init__(self, model: Model) -> None:
        partitions = [p for p in (model.masses, model.contacts) if p.names]
        # Values of the ring's generators, in the caller's symbols
        values = list(model.parameters.values())
        for partition in partitions:
            values += partition.distinct
        free = sp.Tuple(*values).free_symbols
        # Without a generator SymPy would take an irrational number for one.
        symbols = sorted(free, key=str) or [sp.Dummy()]
        # An expression that is no polynomial, such as A^{-1/k}, is a generator of its own.
        self._letters = {}
        for value in values:
            try:
                sp.Poly(value, *symbols, domain="QQ")
            except BasePolynomialError:
                self._letters[value] = sp.Dummy()
        self._generators = [*symbols, *self._letters.values()]
        # The expressions that stand for these generators in results
        self._printed = [*symbols, *self._letters]
        self._context = _context(len(self._printed))
        # What a generator of the model's ring becomes: the value of a law's parameter, or the
        # numerator total · w_i of a fraction f_i = total · w_i / S, S the sum of all weights w.
        self._images = list(map(self._element, model.parameters.values()))
        # For each partition the places of its generators among the images, and the denominator S of
        # its fractions. The last distinct weight has no generator: its fraction follows from the
        # others, as the sum of all is known (`Partition.elements`).
        self._blocks = []
        self._sums = []
        for partition in partitions:
            start = len(self._images)
            for weight in partition.distinct[:-1]:
                self._images.append(partition.total * self._element(weight))
            self._blocks.append(slice(start, len(self._images)))
            total = self._context.constant(0)
            for weight in partition.weights:
                total = total + self._element(weight)
            self._sums.append(total)
        # The ring of a polynomial before `compose` puts the images in: one generator for each image
        # and one for each S
        self._source = _context(len(self._images) + len(self._sums))

    def _element(self, value: sp.Expr) -> fmpq_mpoly:
        """The polynomial of an expression in the generators."""
        letter = self._letters.get(value, value)
        polynomial = sp.Poly(letter, *self._generators, domain="QQ")
        terms = {e: to_flint(c) for e, c in polynomial.terms()}
        return self._context.from_dict(terms)

    def __call__(self, terms: Sequence[Term]) -> sp.Expr:
        """Convert the polynomial that has these terms in the ring's generators.

        The fractions f of masses and contacts become quotients ``total · w/S`` of the caller's
        weights w and their sum S, all over one denominator, a power of S (see the class).
        """
        # The polynomial's degree in the fractions of each partition
        degrees = []
        for block in self._blocks:
            of_terms = [sum(exponents[block]) for exponents, _ in terms]
            degrees.append(max(of_terms, default=0))
        # A term of a lower degree gets the power of S that it lacks.
        homogeneous = {}
        for exponents, coefficient in terms:
            row = list(exponents)
            for block, degree in zip(self._blocks, degrees, strict=True):
                row.append(degree - sum(exponents[block]))
            homogeneous[tuple(row)] = coefficient
        numerator = self._source.from_dict(homogeneous)
        numerator = numerator.compose(*self._images, *self._sums, ctx=self._context)
        if numerator.is_zero():
            return sp.S.Zero
        denominator = self._context.constant(1)
        for total, degree in zip(self._sums, degrees, strict=True):
            denominator = denominator * total**degree
        # Lowest terms
        common = numerator.gcd(denominator)
        above, factors = (numerator / common).factor()
        below, divisors = (denominator / common).factor()
        powers = []
        for factor, e in factors:
            powers.append(self._expression(factor) ** int(e))
        for divisor, e in divisors:
            powers.append(self._expression(divisor) ** -int(e))
        # One `Mul` of all factors: SymPy multiplies out a number times a single sum.
        return sp.Mul(to_sympy(above / below), *powers)

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        """Convert a polynomial to a sum of products of the caller's expressions."""
        products = []
        for exponents, coefficient in polynomial.terms():
            powers = map(sp.Pow, self._printed, map(int, exponents))
            products.append(sp.Mul(to_sympy(coefficient), *powers))
        return sp.Add(*products)


def _context(count: int) -> fmpq_mpoly_ctx:
    """The polynomials over the rationals in ``count`` generators."""
    names = [f"x{i}" for i in range(count)]
    return fmpq_mpoly_ctx.get(names, Ordering.lex)
