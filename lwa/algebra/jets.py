"""Graded differential algebra of the strain: jets, and their derivatives in space and time.

A field u enters the long-wave equations through a base p (the strain ``u_x``; on the optical branch
u itself) and the normalised jets ``r_n = ∂_x^n p / p``, which have the weight n. A quantity of
weight n is ``p^e`` times a polynomial in ``r_1 … r_n`` whose monomials all have that weight, and a
derivative in space raises the weight by one::

    ∂_x (p^e f) = p^e (e r_1 f + Σ_n ∂f/∂r_n (r_{n+1} - r_1 r_n)).

The velocity has jets of its own, ``s_i = ∂_x^i u_τ / p^{(k+1)/2}`` of weight i, where p is the
strain. The wave equation ``u_ττ = p^k Σ_j D^{j-1} E_j`` then gives the derivative in time
(`GradedSeries.dt`). Since every factor D comes with one derivative in space, a series in the
spacing D is a list of polynomials, the n-th of weight n. Coefficients are elements of
`lwa.algebra.model`.

For a law F(p) that is no power, ``p F'(p)`` replaces ``p^k``, and k is the local exponent
``d ln(p F')/d ln p = 1 + φ_2``. The parameters of the law are generators that depend on p::

    φ_n = p^{n-1} F^{(n)}(p)/F'(p),    φ_1 = 1,    p dφ_n/dp = φ_{n+1} + (n-1) φ_n - φ_n φ_2.

For ``δ^k`` they are the numbers ``(k-1) … (k-n+1)``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from math import factorial
from typing import NamedTuple

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.model import Model, Term

Powers = tuple[tuple[int, int], ...]
"""A product of powers of derivatives: pairs (i, e) of the order of each and its exponent."""


class Jet(NamedTuple):
    """A product of powers of normalised derivatives of the field and of its velocity.

    Attributes
    ----------
    x, t : tuples of pairs (i, e)
        The factors ``(∂_x^i u / p)^e`` and ``(∂_x^i u_τ / p^{(k+1)/2})^e``, p the base.
    """

    x: Powers
    t: Powers = ()


class JetAlgebra:
    """Polynomials in the jets of a field and of its velocity, with their derivatives.

    Parameters
    ----------
    model : Model
        The model, with the ring of the coefficients.
    weight : int
        Highest order of a jet, at least 1.

    Attributes
    ----------
    k, half : elements
        Exponent of the law, and ``(k + 1)/2``, that of the base in the jets of the velocity.
    mu, c : lists of elements
        Mass fractions ``m̂_i`` and strain shares ``C_i``.
    phi : list of elements
        The law's parameters ``φ_0 = 0, φ_1 = 1, φ_2, …``.
    r, s : lists of elements
        The jets ``r_0 = 1, r_1, …`` and ``s_0, s_1, …``, both to the highest weight.
    zero, one : element
        The numbers 0 and 1.

    Examples
    --------
    >>> from lwa import Cell, Power
    >>> jets = JetAlgebra(Model(Cell([1]), Power(2)), weight=2)
    >>> jets.dx(jets.r[1], 0)
    -r1^2 + r2
    """

    def __init__(self, model: Model, weight: int) -> None:
        strain = [f"r{n}" for n in range(1, weight + 1)]
        velocity = [f"s{n}" for n in range(weight + 1)]
        names = [*model.names, *strain, *velocity]
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)
        self.weight = weight
        self.zero = self.context.constant(0)
        self.one = self.context.constant(1)
        self.mu = model.masses.elements(self.context)
        self.c = model.contacts.elements(self.context)
        self.phi = model.phi(self.context, max(weight, 2))
        # φ_2 of a power is k - 1; of another law 1 + φ_2 is the local exponent.
        self.k = 1 + self.phi[2]
        self.half = (self.k + 1) / 2
        # The generators in their order: parameters of law and cell, r_1 …, s_0 ….
        generators = self.context.gens()
        self._r1 = len(model.names)
        self._s0 = self._r1 + weight
        self.r = [self.one, *generators[self._r1 : self._s0]]
        self.s = list(generators[self._s0 :])
        # The φ_n of a law that is no power (`highest` above 0) are the first generators and depend
        # on x. All other parameters, k of a power among them, are constants.
        first_constant = len(model.parameters) if model.highest else 0
        self._constants = range(first_constant, self._r1)
        # The jets that stand in the derivative of the jet below them, highest first: r_1 and s_0
        # are the lowest ones.
        self._derived = [
            *range(len(names) - 1, self._s0, -1),
            *range(self._s0 - 1, self._r1, -1),
        ]
        self._set_derivatives(model.highest)

    def _set_derivatives(self, highest: int) -> None:
        """Set the mappings from the index of a generator to its derivatives.

        From the definitions of jets and parameters (`lwa.algebra.jets`) follow::

            ∂_x r_n = r_{n+1} - r_1 r_n,              ∂_τ r_n = s_{n+1} - s_1 r_n,
            ∂_x s_n = s_{n+1} - (k+1)/2 r_1 s_n,      ∂_τ s_n = -(k+1)/2 s_1 s_n + …,
            ∂_x φ_n = r_1 p dφ_n/dp,                  ∂_τ φ_n = s_1 p dφ_n/dp,

        all derivatives in time over ``p^{(k-1)/2}``. The dots are a jet of ``u_ττ``, which
        `GradedSeries.dt` adds.
        """
        # Three lists with names as in the formulas
        r, s, phi = self.r, self.s, self.phi
        self._dx = {}
        self._dt = {}
        # A derivative that raises the weight leaves the algebra at the highest one.
        for n in range(1, self.weight):
            index = self._r1 + n - 1
            self._dx[index] = r[n + 1] - r[1] * r[n]
            self._dt[index] = s[n + 1] - s[1] * r[n]
        for n in range(self.weight + 1):
            index = self._s0 + n
            scaled = self.half * s[n]
            self._dt[index] = -s[1] * scaled
            if n < self.weight:
                self._dx[index] = s[n + 1] - r[1] * scaled
        # The highest φ_n has no derivative either: φ_{n+1} stands in it. Generators begin with φ_2.
        for n in range(2, highest):
            slope = phi[n + 1] + (n - 1) * phi[n]  # p dφ_n/dp
            slope = slope - phi[n] * phi[2]
            self._dx[n - 2] = r[1] * slope
            self._dt[n - 2] = s[1] * slope

    def dx(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative ``p^{-e} ∂_x (p^e f)`` in space, e the exponent."""
        return self._derivative(f, exponent * self.r[1], self._dx)

    def dt(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative ``∂_τ (p^e f)`` without ``u_ττ``, divided by ``p^{e + (k-1)/2}``."""
        return self._derivative(f, exponent * self.s[1], self._dt)

    def _derivative(
        self, f: fmpq_mpoly, rate: fmpq_mpoly, images: Mapping[int, fmpq_mpoly]
    ) -> fmpq_mpoly:
        """The derivative of ``p^e f`` over ``p^e`` by the chain rule.

        Parameters
        ----------
        f : element
        rate : element
            The derivative of ``p^e`` over ``p^e``.
        images : mapping
            Derivatives of the generators by their indices.
        """
        result = rate * f
        for index in self._variables(f):
            # A KeyError: the derivative is of more weight than the algebra.
            result = result + f.derivative(index) * images[index]
        return result

    def _variables(self, f: fmpq_mpoly) -> list[int]:
        """Indices of the jets and the φ_n on which f depends."""
        degrees = enumerate(f.degrees())
        return [i for i, degree in degrees if degree > 0 and i not in self._constants]

    def velocity_slopes(self, f: fmpq_mpoly) -> list[tuple[int, fmpq_mpoly]]:
        """Derivatives by velocity jets: ``(i, ∂f/∂s_i)`` for each ``s_i`` on which f depends."""
        slopes = []
        for index in self._variables(f):
            if index >= self._s0:
                slopes.append((index - self._s0, f.derivative(index)))
        return slopes

    def slope(self, f: fmpq_mpoly, n: int) -> fmpq_mpoly:
        """The slope ``∂f/∂r_n``; the coefficient of the term ``r_n`` if f has weight n."""
        return f.derivative(self._r1 + n - 1)

    def shift(self, h: fmpq_mpoly | int, n: int) -> fmpq_mpoly:
        """Coefficient of ``D^{n+1}`` in ``(u(x + hD) - u(x)) / u_x``, on the acoustic branch."""
        return self.r[n] * taylor(h, n + 1)

    def terms(self, f: fmpq_mpoly, base: int) -> dict[Jet, list[Term]]:
        """Split a polynomial into a mapping from jets to the terms of their coefficients.

        Parameters
        ----------
        f : element
        base : int
            Order of the derivative of u in the base p: ``r_n`` is ``∂_x^{n + base} u / p``.

        Returns
        -------
        dict
        """
        split: dict[Jet, list[Term]] = {}
        for exponents, coefficient in f.terms():
            # Exponents of the generators: parameters, then r_1 …, then s_0 ….
            parameters = tuple(map(int, exponents[: self._r1]))
            jet = Jet(
                x=_powers(exponents[self._r1 : self._s0], 1 + base),
                t=_powers(exponents[self._s0 :], 0),
            )
            term = parameters, coefficient
            split.setdefault(jet, []).append(term)
        return split

    def by_parts(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly:
        """Reduce f by a total derivative ``p^{-e} ∂_x (p^e g)`` until no highest jet is linear.

        All terms of f have one weight. The highest jet of a term is its ``s_n`` of the largest n,
        in a term without jets of the velocity its ``r_n`` of the largest n. A total derivative is
        linear in the highest of all its jets: nothing is left of it.
        """
        for index in self._derived:
            # The generator at index - 1 is the jet j below this jet J: J = ∂_x j + …. So a linear
            # part c J is ∂_x ∫ c dj but for terms whose highest jet is j or a lower one.
            part = self._linear_part(f, index).integral(index - 1)
            f = f - self.dx(part, exponent)
        # r_1 times a constant is a total derivative, too: p^e r_1 = ∂_x (p^e / e).
        return f - self._linear_part(f, self._r1) * self.r[1]

    def _linear_part(self, f: fmpq_mpoly, index: int) -> fmpq_mpoly:
        """Coefficient of a jet in the terms of f that hold the jet once and no later generator."""
        others = self.context.names()[index:]
        return f.derivative(index).subs(dict.fromkeys(others, 0))


def taylor(h: fmpq_mpoly | int, n: int) -> fmpq_mpoly | fmpq:
    """The factor ``h^n/n!`` of the n-th derivative of f in f(x + h)."""
    return h**n * fmpq(1, factorial(n))


def _powers(exponents: Sequence[int], lowest: int) -> Powers:
    """Pairs of the order and the exponent of each jet, from the exponents of jets in a row."""
    orders = enumerate(exponents, start=lowest)
    return tuple((i, int(e)) for i, e in orders if e)


class GradedSeries:
    """A series ``p^e Σ_n D^n f_n`` of polynomials of weight n, with derivatives computed once.

    Parameters
    ----------
    algebra : JetAlgebra
    exponent : element
        The exponent e of the base p.
    terms : sequence of elements
        The first terms ``f_0, f_1, …``; more follow by `append`.
    """

    def __init__(
        self,
        algebra: JetAlgebra,
        exponent: fmpq_mpoly,
        terms: Sequence[fmpq_mpoly] = (),
    ) -> None:
        self.algebra = algebra
        self.exponent = exponent
        # A list for each term: the term itself, and its derivatives in x as far as computed
        self._derivatives = [[f_n] for f_n in terms]
        # The derivatives ∂f_n/∂s_i of each term by the jets of the velocity, for `dt`
        self._velocity_slopes = cache(lambda n: algebra.velocity_slopes(self[n]))

    def __getitem__(self, n: int) -> fmpq_mpoly:
        return self._derivatives[n][0]

    def __iter__(self) -> Iterator[fmpq_mpoly]:
        # The first of a term's derivatives is the term itself.
        return (derivatives[0] for derivatives in self._derivatives)

    def append(self, f_n: fmpq_mpoly) -> None:
        """Append the next term of the series."""
        self._derivatives.append([f_n])

    def dx(self, n: int, j: int) -> fmpq_mpoly:
        """The j-th derivative ``p^{-e} ∂_x^j (p^e f_n)``."""
        derivatives = self._derivatives[n]
        while len(derivatives) <= j:
            derivatives.append(self.algebra.dx(derivatives[-1], self.exponent))
        return derivatives[j]

    def increment(self, h: fmpq_mpoly | int, n: int) -> fmpq_mpoly:
        """Coefficient of ``D^n`` in f(x + hD) - f(x): ``Σ_{0<j≤n} h^j/j! ∂_x^j f_{n-j}``."""
        total = self.algebra.zero
        for j in range(1, n + 1):
            total = total + self.dx(n - j, j) * taylor(h, j)
        return total

    def dt(self, E: GradedSeries, n: int) -> fmpq_mpoly:
        """Coefficient of ``D^{n-1}`` in the derivative in time, divided by ``p^{e + (k-1)/2}``.

        Parameters
        ----------
        E : GradedSeries
            The wave equation ``u_ττ = p^k Σ_j D^{j-1} E_j``, of which ``E_1 … E_{n-1}`` are used.
        n : int
            The terms of this series below n are used.

        Returns
        -------
        element
        """
        total = self.algebra.dt(self[n - 1], self.exponent)
        for m in range(1, n):
            for i, slope in self._velocity_slopes(m):
                # The part of ∂_τ s_i that `JetAlgebra.dt` leaves out is ∂_x^i u_ττ.
                total = total + slope * E.dx(n - m, i)
        return total
