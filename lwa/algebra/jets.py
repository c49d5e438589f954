"""Graded differential algebra of the strain: polynomials in its derivatives (jets), ∂_x, ∂_τ.

A field u enters the long-wave equations through a base p (the strain p = u_x; for the optical
branch p = u itself) and the normalised jets r_n = ∂_x^n p / p, to which the weight n is given. A
quantity of weight n is p^e times a polynomial in r_1 … r_n whose monomials all have that weight,
and ∂_x raises the weight by one:

    ∂_x (p^e f) = p^e (e r_1 f + Σ_n ∂f/∂r_n (r_{n+1} - r_1 r_n)).

The velocity has jets of its own, s_i = ∂_x^i u_τ / p^{(k+1)/2} of weight i (p = u_x). The wave
equation u_ττ = p^k Σ_j D^{j-1} E_j then gives the derivative in time (`GradedSeries.dt`). Since
every factor D comes with one ∂_x, a series in the spacing D is a list of polynomials, the n-th of
weight n. Coefficients are elements of `lwa.algebra.ring`.

For a law F(p) that is no power, p F'(p) replaces p^k, and k is the local exponent
d ln(p F')/d ln p = 1 + φ_2. The φ_n = p^{n-1} F^{(n)}(p)/F'(p), φ_1 = 1, are generators that depend
on p: p dφ_n/dp = φ_{n+1} + (n-1) φ_n - φ_n φ_2. For δ^k they are (k-1) … (k-n+1).
"""

from __future__ import annotations

from collections.abc import (
    Iterator,
    Mapping,
    Sequence,
)
from functools import cache
from math import factorial
from typing import NamedTuple

from flint import (
    Ordering,
    fmpq,
    fmpq_mpoly,
    fmpq_mpoly_ctx,
)

from lwa.algebra.ring import CoefficientRing, Term

Powers = tuple[tuple[int, int], ...]
"""((i, e), …) for a product of e-th powers of i-th derivatives."""


class Jet(NamedTuple):
    """A product of powers (∂_x^i u / p)^e and (∂_x^i u_τ / p^{(k+1)/2})^e, p the base.

    ``x`` and ``t`` are the tuples of (i, e) of the two kinds.
    """

    x: Powers
    t: Powers = ()


class JetAlgebra:
    """Polynomials in the jets r_1 … r_weight and s_0 … s_weight, with ∂_x and ∂_τ.

    Parameters
    ----------
    ring : CoefficientRing
        The ring of the coefficients.
    weight : int
        Highest order of a jet.

    Attributes
    ----------
    k, mu, c : element, lists of elements
        Exponent of the law, mass fractions m̂_i and strain shares C_i.
    phi : list of elements
        The law's parameters φ_0 = 0, φ_1 = 1, φ_2, ….
    r, s : lists of elements
        The jets r_0 = 1, r_1, … and s_0, s_1, ….
    zero, one : element
        The numbers 0 and 1.

    Examples
    --------
    >>> from lwa import Cell, Power
    >>> from lwa.algebra.model import Model
    >>> jets = JetAlgebra(Model(Cell([1]), Power(2)).ring, weight=2)
    >>> jets.dx(jets.r[1], 0)
    -r1^2 + r2
    """

    def __init__(self, ring: CoefficientRing, weight: int) -> None:
        strain = [f"r{n}" for n in range(1, weight + 1)]
        velocity = [f"s{n}" for n in range(weight + 1)]
        names = [*ring.names, *strain, *velocity]
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)
        self.weight = weight
        self.zero = self.context.constant(0)
        self.one = self.context.constant(1)
        self.k = ring.exponent(self.context)
        self.mu = ring.masses.elements(self.context)
        self.c = ring.contacts.elements(self.context)
        self.phi = ring.phi(self.context, weight)
        generators = self.context.gens()
        # Indices of r_1 and s_0 among the generators
        self._r1 = len(ring.names)
        self._s0 = self._r1 + weight
        self.r = [self.one, *generators[self._r1 : self._s0]]
        self.s = list(generators[self._s0 :])
        # The φ_n come first among the generators; those between them and r_1 are constants.
        self._constants = range(len(ring.law) if ring.highest else 0, self._r1)
        # The jets that hold a derivative of the one before, highest first: not r_1 and s_0
        derived = (*range(self._r1 + 1, self._s0), *range(self._s0 + 1, len(names)))
        self._derived = sorted(derived, reverse=True)
        self._set_derivatives(ring.highest)

    def _set_derivatives(self, highest: int) -> None:
        """Set the mappings from the index of a generator to its derivatives.

        From r_n = ∂_x^n p/p, s_n = ∂_x^n u_τ/p^{(k+1)/2} and φ_n(p) follow, with
        θ_n = p dφ_n/dp,

            ∂_x r_n = r_{n+1} - r_1 r_n,    ∂_x s_n = s_{n+1} - (k+1)/2 r_1 s_n,
            ∂_x φ_n = r_1 θ_n,

        and with s in place of the first r of each product ∂_τ, over p^{(k-1)/2}; but ∂_τ s_n lacks
        the jet of u_ττ, which `GradedSeries.dt` adds.
        """
        r, s, phi = self.r, self.s, self.phi
        self.half = (self.k + 1) / 2
        self._dx = {}
        self._dt = {}
        # Derivatives that raise the weight are missing at the highest one.
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
        # φ_highest has no derivative either: it holds the next φ_n.
        for n in range(2, highest):
            theta = phi[n + 1] + (n - 1) * phi[n] - phi[n] * phi[2]
            index = n - 2
            self._dx[index] = r[1] * theta
            self._dt[index] = s[1] * theta

    def dx(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative p^{-e} ∂_x (p^e f) in x, e the exponent."""
        if f.is_zero():
            return f
        return self._derivative(f, exponent * self.r[1], self._dx)

    def dt(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative ∂_τ (p^e f) without u_ττ, divided by p^{e + (k-1)/2}."""
        if f.is_zero():
            return f
        return self._derivative(f, exponent * self.s[1], self._dt)

    def _derivative(
        self,
        f: fmpq_mpoly,
        rate: fmpq_mpoly,
        images: Mapping[int, fmpq_mpoly],
    ) -> fmpq_mpoly:
        """The derivative of p^e f by the chain rule; ``rate`` is that of p^e, over p^e."""
        result = rate * f
        for index in self._variables(f):
            if index not in images:
                name = self.context.name(index)
                raise ValueError(
                    f"the derivative of {name} needs an algebra of more weight"
                )
            result = result + f.derivative(index) * images[index]
        return result

    def _variables(self, f: fmpq_mpoly) -> list[int]:
        """Indices of the jets and the φ_n on which f depends."""
        degrees = enumerate(f.degrees())
        return [i for i, degree in degrees if degree > 0 and i not in self._constants]

    def velocity_slopes(self, f: fmpq_mpoly) -> list[tuple[int, fmpq_mpoly]]:
        """Derivatives by velocity jets: pairs (i, ∂f/∂s_i) for each s_i on which f depends."""
        indices = (i for i in self._variables(f) if i >= self._s0)
        return [(i - self._s0, f.derivative(i)) for i in indices]

    def slope(self, f: fmpq_mpoly, n: int) -> fmpq_mpoly:
        """The slope ∂f/∂r_n; the coefficient of the term r_n if f has weight n."""
        return f.derivative(self._r1 + n - 1)

    def shift(self, h: fmpq_mpoly | int, n: int) -> fmpq_mpoly:
        """Coefficient of D^{n+1} in (u(x + hD) - u(x)) / u_x, on the acoustic branch."""
        return self.r[n] * taylor(h, n + 1)

    def terms(self, f: fmpq_mpoly, base: int) -> dict[Jet, list[Term]]:
        """Split a polynomial into a mapping from jets to the terms of their coefficients.

        base : order of the derivative of u in the base p: r_n is ∂_x^{n + base} u / p.
        """
        # The exponents of a term: parameters first, then strain jets, then velocity jets.
        split: dict[Jet, list[Term]] = {}
        for exponents, coefficient in f.terms():
            x = _powers(exponents[self._r1 : self._s0], 1 + base)
            t = _powers(exponents[self._s0 :], 0)
            parameters = tuple(map(int, exponents[: self._r1]))
            split.setdefault(Jet(x, t), []).append((parameters, coefficient))
        return split

    def antiderivative(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly | None:
        """Antiderivative g with ∂_x (p^e g) = p^e f, f of weight 2 or more; None if f has none."""
        # A total derivative is linear in its highest jet, with the coefficient ∂g/∂(the jet below).
        # Subtracting the derivative of this part of g lowers the highest jet, first among those of
        # the velocity, then among those of the strain.
        total = self.zero
        for index in self._derived:
            slope = f.derivative(index)
            if not slope.derivative(index).is_zero():
                return None
            part = slope.integral(index - 1)
            total = total + part
            f = f - self.dx(part, exponent)
        return total if f.is_zero() else None

    def by_parts(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly:
        """Reduce f by a total derivative, p^{-e} ∂_x (p^e g), until no highest jet is linear.

        All terms of f have one weight. A highest jet is an s_n linear beside lower jets s_i, or,
        in terms without s_i, an r_n beside lower r_i; r_1 alone is the derivative of p^e / e.
        """
        for index in self._derived:
            part = self._linear_part(f, index).integral(index - 1)
            f = f - self.dx(part, exponent)
        return f - self._linear_part(f, self._r1) * self.r[1]

    def _linear_part(self, f: fmpq_mpoly, index: int) -> fmpq_mpoly:
        """Coefficient of a jet, linear, in the terms of f without this and higher jets beside."""
        others = self.context.names()[index:]
        return f.derivative(index).subs(dict.fromkeys(others, 0))


def taylor(h: fmpq_mpoly | int, n: int) -> fmpq_mpoly | fmpq:
    """The factor h^n/n! of ∂_x^n f in f(x + h)."""
    return h**n * fmpq(1, factorial(n))


def _powers(exponents: Sequence[int], lowest: int) -> Powers:
    return tuple((i, int(e)) for i, e in enumerate(exponents, start=lowest) if e)


class GradedSeries:
    """A series p^e Σ_n D^n f_n, f_n polynomials of weight n, with derivatives computed once."""

    def __init__(
        self,
        algebra: JetAlgebra,
        exponent: fmpq_mpoly,
        terms: Sequence[fmpq_mpoly] = (),
    ) -> None:
        self.algebra = algebra
        self.exponent = exponent
        self._derivatives = [[f_n] for f_n in terms]
        # Computed once for each term
        self._velocity_slopes = cache(lambda n: algebra.velocity_slopes(self[n]))

    def __getitem__(self, n: int) -> fmpq_mpoly:
        return self._derivatives[n][0]

    def __iter__(self) -> Iterator[fmpq_mpoly]:
        return (derivatives[0] for derivatives in self._derivatives)

    def append(self, f_n: fmpq_mpoly) -> None:
        """Append the next term of the series."""
        self._derivatives.append([f_n])

    def dx(self, n: int, j: int) -> fmpq_mpoly:
        """The j-th derivative p^{-e} ∂_x^j (p^e f_n)."""
        derivatives = self._derivatives[n]
        while len(derivatives) <= j:
            derivatives.append(self.algebra.dx(derivatives[-1], self.exponent))
        return derivatives[j]

    def increment(self, h: fmpq_mpoly | int, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in f(x + hD) - f(x), which is Σ_{0<j≤n} h^j/j! ∂_x^j f_{n-j}."""
        total = self.algebra.zero
        for j in range(1, n + 1):
            derivative = self.dx(n - j, j)
            # In a symmetric cell every second term vanishes.
            if not derivative.is_zero():
                total = total + derivative * taylor(h, j)
        return total

    def dt(self, E: GradedSeries, n: int) -> fmpq_mpoly:
        """Coefficient of D^{n-1} in ∂_τ (p^e Σ_m D^m f_m), divided by p^{e + (k-1)/2}.

        The terms f_m, m < n, are known, and E_1 … E_{n-1} of u_ττ = p^k Σ_j D^{j-1} E_j.
        """
        total = self.algebra.dt(self[n - 1], self.exponent)
        for m in range(1, n):
            for i, slope in self._velocity_slopes(m):
                total = total + slope * E.dx(n - m, i)  # ∂_τ s_i holds ∂_x^i u_ττ
        return total
