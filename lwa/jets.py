"""The graded differential algebra of the strain: jets, derivatives, shifts and powers.

A field u enters the long-wave equations through a base p (the strain p = u_x; for the optical
branch p = u itself) and the normalised jets r_n = ∂_x^n p / p, to which the weight n is given. A
quantity of weight n is p^e times a polynomial in r_1 … r_n whose monomials all have that weight,
and ∂_x raises the weight by one:

    ∂_x (p^e f) = p^e (e r_1 f + Σ_n ∂f/∂r_n (r_{n+1} - r_1 r_n)).

Since every factor D comes with one ∂_x, a series in the spacing D is a list of polynomials, the
n-th of weight n. Coefficients live in Q[parameters]; polynomials are python-flint's `fmpq_mpoly`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import factorial

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

Monomial = tuple[tuple[int, int], ...]
"""((n, e), …): the product of r_n^e."""


class JetAlgebra:
    """Polynomials in r_1 … r_weight over Q[parameters], with ∂_x.

    >>> jets = JetAlgebra((), weight=2)
    >>> jets.dx(jets.r[1], 0)
    -r1^2 + r2
    """

    def __init__(self, parameters: tuple[str, ...], weight: int) -> None:
        self.parameters = parameters
        self.weight = weight
        names = [*parameters, *(f"r{n}" for n in range(1, weight + 1))]
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)
        self.one = self.context.constant(1)
        self.zero = self.context.constant(0)
        self.r = [self.one, *self.context.gens()[len(parameters) :]]

    def dx(self, f: fmpq_mpoly, exponent: fmpq_mpoly | int) -> fmpq_mpoly:
        """p^{-e} ∂_x (p^e f), e the exponent."""
        result = exponent * self.r[1] * f
        offset = len(self.parameters) - 1
        for n in range(1, self.weight + 1):
            slope = f.derivative(offset + n)
            if not slope.is_zero():
                if n == self.weight:
                    raise ValueError(f"∂_x r_{n} needs an algebra of weight {n + 1} or more")
                result = result + slope * (self.r[n + 1] - self.r[1] * self.r[n])
        return result

    def linear(self, f: fmpq_mpoly, n: int) -> fmpq_mpoly:
        """The coefficient of the monomial r_n, a polynomial in the parameters."""
        return sum(
            (coefficient for jet, coefficient in self.split(f) if jet == ((n, 1),)), self.zero
        )

    def split(self, f: fmpq_mpoly) -> Iterator[tuple[Monomial, fmpq_mpoly]]:
        """The jet monomials of f, each with its coefficient (a polynomial in the parameters)."""
        for jet, terms in self.terms(f).items():
            padding = (0,) * self.weight
            yield jet, self.context.from_dict({(*e, *padding): c for e, c in terms})

    def terms(self, f: fmpq_mpoly) -> dict[Monomial, list[tuple[tuple[int, ...], fmpq]]]:
        """Jet monomial → the terms (exponents of the parameters, rational) of its coefficient."""
        count = len(self.parameters)
        found: dict[Monomial, list[tuple[tuple[int, ...], fmpq]]] = {}
        for exponents, coefficient in f.terms():
            jet = tuple((n, int(e)) for n, e in enumerate(exponents[count:], start=1) if e)
            found.setdefault(jet, []).append((tuple(map(int, exponents[:count])), coefficient))
        return found

    def antiderivative(self, f: fmpq_mpoly, exponent: fmpq_mpoly) -> fmpq_mpoly | None:
        """g with ∂_x (p^e g) = p^e f, for f of weight 2 or more; None where there is none.

        The highest jet r_n of a total derivative stands in it linearly, and its coefficient is the
        slope of g in r_{n-1}; taking that off lowers the highest jet, down to r_1.
        """
        offset = len(self.parameters) - 1
        total = self.zero
        for n in range(self.weight, 1, -1):
            slope = f.derivative(offset + n)
            if slope.is_zero():
                continue
            if not slope.derivative(offset + n).is_zero():
                return None
            part = slope.integral(offset + n - 1)
            total, f = total + part, f - self.dx(part, exponent)
        return total if f.is_zero() else None


class Ladder:
    """A graded series p^e Σ_n D^n f_n and its derivatives, computed once and kept."""

    def __init__(self, algebra: JetAlgebra, exponent: fmpq_mpoly) -> None:
        self.algebra = algebra
        self.exponent = exponent
        self._rungs: list[list[fmpq_mpoly]] = []

    def __len__(self) -> int:
        return len(self._rungs)

    def __getitem__(self, n: int) -> fmpq_mpoly:
        return self._rungs[n][0]

    def append(self, f_n: fmpq_mpoly) -> None:
        """Give the next term of the series."""
        self._rungs.append([f_n])

    def dx(self, n: int, j: int) -> fmpq_mpoly:
        """p^{-e} ∂_x^j (p^e f_n)."""
        rungs = self._rungs[n]
        while len(rungs) <= j:
            rungs.append(self.algebra.dx(rungs[-1], self.exponent))
        return rungs[j]


class Power:
    """The series (1 + X)^k = 1 + k Φ of a graded series X = Σ_{n≥1} D^n X_n, term by term.

    With Y = (1 + X)^k the recurrence n Y_n = Σ_{j=1..n} (k j - (n - j)) X_j Y_{n-j} gives

        Φ_n = X_n + (1/n) Σ_{j<n} (k j - (n - j)) X_j Φ_{n-j},

    polynomial in k and without a division by it. p^k (1 + X)^k is the force of a contact whose
    strain is p (1 + X).
    """

    def __init__(self, algebra: JetAlgebra, k: fmpq_mpoly) -> None:
        self.k = k
        self.X: list[fmpq_mpoly] = [algebra.zero]
        self.Phi = Ladder(algebra, k)
        self.Phi.append(algebra.zero)
        self._one = Ladder(algebra, k)
        self._one.append(algebra.r[1])

    def known(self, n: int) -> fmpq_mpoly:
        """Φ_n - X_n, which depends on X_1 … X_{n-1} only."""
        total = self.Phi[0]
        for j in range(1, n):
            total = total + (self.k * j - (n - j)) * self.X[j] * self.Phi[n - j]
        return total / n

    def append(self, X_n: fmpq_mpoly) -> None:
        """Give the next term of X."""
        self.Phi.append(X_n + self.known(len(self.X)))
        self.X.append(X_n)

    def carried(self, h: int, n: int) -> fmpq_mpoly:
        """The difference that the shift by hD makes to p^k (1 + kΦ) at D^n, over k p^k.

        Beside Φ_n itself, e^{hD∂_x} p^k (1 + kΦ) has there k p^k times
        Σ_{0<j<n} h^j/j! ∂^j Φ_{n-j} and, from the leading 1, h^n/n! ∂^{n-1} r_1.
        """
        total = self._one.dx(0, n - 1) * fmpq(h**n, factorial(n))
        for j in range(1, n):
            total = total + self.Phi.dx(n - j, j) * fmpq(h**j, factorial(j))
        return total
