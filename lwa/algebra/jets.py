"""Graded differential algebra of the strain: polynomials in its derivatives (jets), ∂_x, ∂_τ.

A field u enters the long-wave equations through a base p (the strain p = u_x; for the optical
branch p = u itself) and the normalised jets r_n = ∂_x^n p / p, to which the weight n is given. A
quantity of weight n is p^e times a polynomial in r_1 … r_n whose monomials all have that weight,
and ∂_x raises the weight by one:

    ∂_x (p^e f) = p^e (e r_1 f + Σ_n ∂f/∂r_n (r_{n+1} - r_1 r_n)).

The velocity has jets of its own, s_i = ∂_x^i u_τ / p^{(k+1)/2} of weight i (p = u_x). The wave
equation u_ττ = p^k Σ_j D^{j-1} E_j then gives the derivative in time (`JetAlgebra.dt`). Since every
factor D comes with one ∂_x, a series in the spacing D is a list of polynomials, the n-th of weight
n. Coefficients live in Q[parameters]; polynomials are python-flint's `fmpq_mpoly`.

For a law F(p) that is no power, p F'(p) replaces p^k, and k is the local exponent
d ln(p F')/d ln p = 1 + φ_2. The φ_n = p^{n-1} F^{(n)}(p)/F'(p), φ_1 = 1, are parameters that depend
on p: p dφ_n/dp = φ_{n+1} + (n-1) φ_n - φ_n φ_2. For δ^k they are (k-1) … (k-n+1).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from math import factorial
from typing import NamedTuple

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

Powers = tuple[tuple[int, int], ...]
"""((n, e), …) for the product of the jets r_n^e."""

Term = tuple[tuple[int, ...], fmpq]
"""One term of a coefficient: the exponents of the parameters, and its rational factor."""


class Monomial(NamedTuple):
    """A product of jets: r_n^e for (n, e) in ``x``, s_n^e for (n, e) in ``t``."""

    x: Powers
    t: Powers = ()


class JetAlgebra:
    """Polynomials in the normalised derivatives r_n = ∂_x^n p / p of a field p, with ∂_x and ∂_τ.

    The jets are r_1 … r_weight, the coefficients in Q[parameters]. Given ``exponent``, which gives
    k in the ring, there are ∂_τ and the jets s_1 … s_weight of the velocity; with ``rest`` also
    s_0 = u_τ / p^{(k+1)/2}. The first parameters are φ_2 … φ_smooth of a law that is no power.

    >>> jets = JetAlgebra((), weight=2)
    >>> jets.dx(jets.r[1], 0)
    -r1^2 + r2
    """

    def __init__(
        self,
        parameters: tuple[str, ...],
        weight: int,
        exponent: Callable[[fmpq_mpoly_ctx], fmpq_mpoly] | None = None,
        rest: bool = False,
        smooth: int = 0,
    ) -> None:
        self.parameters, self.weight = parameters, weight
        self._lowest = 0 if rest else 1
        velocities = range(self._lowest, weight + 1) if exponent else range(0)
        jets = (
            *(f"r{n}" for n in range(1, weight + 1)),
            *(f"s{n}" for n in velocities),
        )
        self.context = fmpq_mpoly_ctx.get([*parameters, *jets], Ordering.lex)
        self.one, self.zero = self.context.constant(1), self.context.constant(0)
        generators = self.context.gens()
        # Indices of the first strain jet and of the first velocity jet among the generators.
        self._offset = len(parameters)
        self._velocity = self._offset + weight
        self.r = [self.one, *generators[self._offset : self._velocity]]
        self.s = (
            [self.zero] * self._lowest + list(generators[self._velocity :])
            if exponent
            else []
        )
        self.half = (exponent(self.context) + 1) / 2 if exponent else self.zero
        self.phi = [self.zero, self.one, *generators[: smooth - 1]] if smooth else []
        self._moving = [
            *range(max(smooth - 1, 0)),
            *range(self._offset, self.context.nvars()),
        ]
        r, s, half = self.r, self.s, self.half
        self._dx = self._derivatives(r)
        self._dt: dict[int, fmpq_mpoly] = {}
        if exponent:
            moving = range(self._lowest, weight + 1)
            self._dx |= {
                self._index_of_s(n): s[n + 1] - half * r[1] * s[n] for n in moving[:-1]
            }
            # without u_ττ, which `dt` adds
            self._dt = self._derivatives(s)
            self._dt |= {self._index_of_s(n): -half * s[1] * s[n] for n in moving}

    def _derivatives(self, jets: list[fmpq_mpoly]) -> dict[int, fmpq_mpoly]:
        """Mapping from the index of a generator, r_n or φ_n, to its derivative.

        From r_n = ∂_x^n p/p and φ_n(p) follow, with θ_n = p dφ_n/dp,

            ∂_x r_n = r_{n+1} - r_1 r_n,    ∂_x φ_n = r_1 θ_n,

        and with s in place of the first r of each product ∂_τ, over p^{(k-1)/2}.

        jets : r for ∂_x, s for ∂_τ.
        """
        rate, r = jets[1], self.r  # rate: the derivative of p, over p
        strain = {
            self._offset + n - 1: jets[n + 1] - rate * r[n]
            for n in range(1, self.weight)
        }
        return strain | {
            n - 2: rate * self._theta(n) for n in range(2, len(self.phi) - 1)
        }

    def _index_of_s(self, n: int) -> int:
        """Index of the velocity jet s_n among the generators."""
        return self._velocity + n - self._lowest

    def _theta(self, n: int) -> fmpq_mpoly:
        """Logarithmic derivative p dφ_n/dp of the law's parameter φ_n."""
        phi = self.phi
        return phi[n + 1] + (n - 1) * phi[n] - phi[n] * phi[2]

    def dp(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative p^{1-e} ∂_p (p^e f) with respect to p at fixed jets, e the exponent."""
        slopes = (
            f.derivative(n - 2) * self._theta(n) for n in range(2, len(self.phi) - 1)
        )
        return sum(slopes, exponent * f)

    def dx(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """The derivative p^{-e} ∂_x (p^e f) in x, e the exponent."""
        if f.is_zero():
            return f
        return self._derivation(exponent * self.r[1] * f, f, self._dx)

    def dt(self, f: GradedSeries, E: GradedSeries, n: int) -> fmpq_mpoly:
        """Coefficient of D^{n-1} in ∂_τ (p^e Σ_m D^m f_m), divided by p^{e + (k-1)/2}.

        f : the series, whose terms f_m, m < n, are known.
        E : the series of u_ττ = p^k Σ_j D^{j-1} E_j, whose terms E_1 … E_{n-1} are known.
        """
        result = last = f[n - 1]
        if not last.is_zero():
            result = self._derivation(f.exponent * self.s[1] * last, last, self._dt)
        for m in range(1, n):  # ∂_τ s_i holds ∂_x^i u_ττ
            for i, slope in f.velocity_slopes(m):
                result = result + slope * E.dx(n - m, i)
        return result

    def velocity_slopes(self, f: fmpq_mpoly) -> list[tuple[int, fmpq_mpoly]]:
        """Derivatives by velocity jets: pairs (i, ∂f/∂s_i) for each s_i on which f depends."""
        start = self._velocity
        return [
            (i - start + self._lowest, f.derivative(i))
            for i in self._present(f)
            if i >= start
        ]

    def _present(self, f: fmpq_mpoly) -> list[int]:
        """Indices of the jets and the φ_n on which f depends."""
        degrees = f.degrees()
        return [i for i in self._moving if degrees[i] > 0]

    def _derivation(
        self, result: fmpq_mpoly, f: fmpq_mpoly, images: dict[int, fmpq_mpoly]
    ) -> fmpq_mpoly:
        """Add a derivative of f by the chain rule, Σ ∂f/∂g · image(g) over the jets g."""
        for index in self._present(f):
            if index not in images:
                name = self.context.name(index)
                raise ValueError(
                    f"the derivative of {name} needs an algebra of more weight"
                )
            result = result + f.derivative(index) * images[index]
        return result

    def slope(self, f: fmpq_mpoly, n: int) -> fmpq_mpoly:
        """The slope ∂f/∂r_n; the coefficient of the term r_n if f has weight n."""
        return f.derivative(self._offset + n - 1)

    def terms(self, f: fmpq_mpoly) -> dict[Monomial, list[Term]]:
        """Split a polynomial f of jets into a mapping {jet monomial: terms of its coefficient}."""
        split: dict[Monomial, list[Term]] = {}
        for exponents, coefficient in f.terms():
            jets_x = exponents[self._offset : self._velocity]
            jets_t = exponents[self._velocity :]
            monomial = Monomial(_powers(jets_x, 1), _powers(jets_t, self._lowest))
            parameters = tuple(map(int, exponents[: self._offset]))
            split.setdefault(monomial, []).append((parameters, coefficient))
        return split

    def antiderivative(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly | None:
        """Antiderivative g with ∂_x (p^e g) = p^e f, f of weight 2 or more; None if f has none."""
        # A total derivative is linear in its highest jet, with the coefficient ∂g/∂(the jet below).
        # Subtracting the derivative of this part of g lowers the highest jet, first among those of
        # the velocity, then among those of the strain.
        total = self.zero
        for index in reversed(range(self._offset, self.context.nvars())):
            slope = f.derivative(index)
            if slope.is_zero():
                continue
            below = index - 1 if index > self._offset else None
            if below not in self._dx or not slope.derivative(index).is_zero():
                return None
            part = slope.integral(index - 1)
            total, f = total + part, f - self.dx(part, exponent)
        return total if f.is_zero() else None

    def by_parts(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly:
        """Reduce f by a total derivative, p^{-e} ∂_x (p^e g), until no highest jet is linear.

        All terms of f have one weight. A highest jet is an s_n linear beside lower jets s_i, or,
        in terms without s_i, an r_n beside lower r_i; r_1 alone is the derivative of p^e / e.
        """
        names = self.context.names()
        indices = (
            *range(self._velocity + 1, len(names)),
            *range(self._offset + 1, self._velocity),
        )
        for index in sorted(indices, reverse=True):
            part = self._linear_part(f, index, names[index:]).integral(index - 1)
            f = f - self.dx(part, exponent)
        return f - self._linear_part(f, self._offset, names[self._offset :]) * self.r[1]

    def _linear_part(
        self, f: fmpq_mpoly, index: int, others: Sequence[str]
    ) -> fmpq_mpoly:
        """Coefficient of the jet ``index`` in the terms of f without the other jets."""
        return f.derivative(index).subs(dict.fromkeys(others, 0))

    def embed(self, f: fmpq_mpoly, smaller: JetAlgebra) -> fmpq_mpoly:
        """Convert f from a smaller algebra, of the same parameters and fewer jets."""
        context = self.context
        places = map(context.variable_to_index, smaller.context.names())
        return f.compose(*map(context.gen, places), ctx=context)


def _powers(exponents: Sequence[int], lowest: int) -> Powers:
    return tuple((n, int(e)) for n, e in enumerate(exponents, start=lowest) if e)


class GradedSeries:
    """A series p^e Σ_n D^n f_n, f_n polynomials of weight n, with derivatives computed once."""

    def __init__(
        self,
        algebra: JetAlgebra,
        exponent: fmpq_mpoly,
        terms: Sequence[fmpq_mpoly] = (),
    ) -> None:
        self.algebra, self.exponent = algebra, exponent
        self._derivatives = [[f_n] for f_n in terms]
        # Derivatives of each f_n by the velocity jets, as `JetAlgebra.velocity_slopes` has them
        self.velocity_slopes = cache(lambda n: algebra.velocity_slopes(self[n]))

    def __len__(self) -> int:
        return len(self._derivatives)

    def __getitem__(self, n: int) -> fmpq_mpoly:
        return self._derivatives[n][0]

    def __iter__(self) -> Iterator[fmpq_mpoly]:
        return (derivatives[0] for derivatives in self._derivatives)

    def append(self, f_n: fmpq_mpoly) -> None:
        """Append the next term of the series."""
        self._derivatives.append([f_n])

    def increment(self, h: fmpq_mpoly | int, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in f(x + hD) - f(x), which is Σ_{0<j≤n} h^j/j! ∂_x^j f_{n-j}."""
        derivatives = ((j, self.dx(n - j, j)) for j in range(1, n + 1))
        parts = (
            f * (h**j * fmpq(1, factorial(j)))
            for j, f in derivatives
            if not f.is_zero()
        )
        return sum(parts, self.algebra.zero)

    def dx(self, n: int, j: int) -> fmpq_mpoly:
        """The j-th derivative p^{-e} ∂_x^j (p^e f_n)."""
        derivatives = self._derivatives[n]
        while len(derivatives) <= j:
            derivatives.append(self.algebra.dx(derivatives[-1], self.exponent))
        return derivatives[j]
