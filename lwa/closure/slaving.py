"""The equations of motion of a cell in its fields, and the full closure, which satisfies them all.

All displacement fields w_0 … w_{P-1} of a cell are taken at the position x of its first particle
and expressed by one field φ: w_i = φ + D φ_x S_i, S_i a series in D of polynomials in the jets of
φ (`lwa.algebra.jets`). Let m̂_i be the mass fractions, τ the time of `Cell.time_scale`, and F_i the
force of contact i divided by A_eff D^k. The equations of motion of the P particles are

    P k D m̂_i ∂_ττ w_i = F_i(x) - F_{i-1}(x),    F_{-1}(x) = F_{P-1}(x - P D).

In the full closure S_n is a polynomial in the jets of φ and of φ_τ. All P equations of motion can
then be satisfied, order by order and without a system to solve:

1. The sum of all equations, the balance of momentum, gives the next term E_n of the wave equation.
2. The sum of the first i equations gives Φ_i - Φ_0, the difference of two contact forces.
3. The force Φ_i of each contact gives the term X_n of its strain C_i φ_x (1 + Σ D^n X_n).
4. The strains give the terms S_n of all fields, up to a shift that the definition of φ fixes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from itertools import accumulate
from math import factorial
from operator import mul

from flint import fmpq, fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra
from lwa.algebra.model import Model
from lwa.base.progress import Progress


class Force:
    """The force of a contact as a series in D, to which terms are appended order by order.

    Let p be the strain of the field and p (1 + X), X = Σ_{n≥1} D^n X_n, the strain of a contact
    divided by its share C_i. The force of the contact is

        F(p (1 + X)) = F(p) + p F'(p) Φ,    Φ = Σ_{m≥1} φ_m X^m/m! = Σ_{n≥1} D^n Φ_n,

    φ_m = p^{m-1} F^{(m)}(p)/F'(p).

    The law is that of the algebra, with its parameters φ_m, or else the power p^k, whose φ_m are
    (k-1) … (k-m+1).
    """

    def __init__(self, algebra: JetAlgebra, k: fmpq_mpoly) -> None:
        factors = (k - j for j in range(1, algebra.weight + 1))
        self.phi = algebra.phi or [
            algebra.zero,
            *accumulate(factors, mul, initial=algebra.one),
        ]
        self.X: list[fmpq_mpoly] = [algebra.zero]
        self.Phi = GradedSeries(algebra, k, [algebra.zero])
        self._slope = GradedSeries(algebra, k, [algebra.r[1]])
        self._power_term = cache(self._term_of_power)
        self._nonlinear: fmpq_mpoly | None = None

    @property
    def nonlinear(self) -> fmpq_mpoly:
        """The nonlinear part Φ_n - X_n of the next order n, known from X_1 … X_{n-1}."""
        if self._nonlinear is None:
            n = len(self.X)
            terms = (self.phi[m] * self._power_term(m, n) for m in range(2, n + 1))
            self._nonlinear = sum(terms, self.X[0])
        return self._nonlinear

    def _term_of_power(self, m: int, n: int) -> fmpq_mpoly:
        """The coefficient of D^n in X^m/m! = (1/m) X · X^{m-1}/(m-1)!, n ≥ m ≥ 1."""
        if m == 1:
            return self.X[n]
        parts = (
            self.X[j] * self._power_term(m - 1, n - j) for j in range(1, n - m + 2)
        )
        return sum(parts, self.X[0]) / m  # X_0 = 0

    def append(self, X_n: fmpq_mpoly) -> None:
        """Append the next term X_n to X, and Φ_n to Φ."""
        self.Phi.append(X_n + self.nonlinear)
        self.X.append(X_n)
        self._nonlinear = None

    def increment(self, h: int, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in [F(p) + p F' Φ](x + hD) - [F(p) + p F' Φ](x), divided by p F'."""
        # F(p) adds h^n/n! ∂_x^n F(p) = h^n/n! ∂_x^{n-1} (p F' r_1), r_1 = p_x/p.
        return self.Phi.increment(h, n) + self._slope.dx(0, n - 1) * fmpq(
            h**n, factorial(n)
        )

    def work(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in ∫ Φ dX = [W(p (1 + X)) - W(p) - p F(p) X] / (p² F'), W' = F."""
        total = self.Phi[0]
        for j in range(1, n):
            total = total + j * self.X[j] * self.Phi[n - j]
        return total / n


@dataclass(frozen=True, repr=False, kw_only=True)
class Solution:
    """Result of a closure: wave equation and displacement fields, as polynomials by order in D.

    acceleration : E_n. Acoustic: φ_ττ = φ_x^k Σ_{n≥1} D^{n-1} E_n, E_1 = r_1 = φ_xx/φ_x.
        Optical: u_ττ = -u^k Σ_{n≥0} D^n E_n, E_0 = 1, in its own time unit.
    ansatz : b_n, n = 0 … order: the second particle's field is λ Σ b_n D^n ∂_x^n φ in the linear
        closure, and has this linear part in the full one (polynomials in the parameters).
    slaved : `fields`, from the full closure; else ().
    defect : E_n from the first equation of motion minus E_n from the second, for the same ansatz.
    """

    algebra: JetAlgebra = field(compare=False)
    acceleration: tuple[fmpq_mpoly, ...] = field(compare=False)
    ansatz: tuple[fmpq_mpoly, ...] = field(compare=False, default=())
    slaved: tuple[tuple[fmpq_mpoly, ...], ...] = field(compare=False, default=())
    defect: tuple[fmpq_mpoly, ...] = field(compare=False, default=())

    @property
    def fields(self) -> tuple[tuple[fmpq_mpoly, ...], ...]:
        """Polynomials S_0, S_1, … of each field w_i = φ + D φ_x Σ D^n S_n (acoustic branch)."""
        if self.slaved:
            return self.slaved
        first = tuple(self.algebra.zero for _ in self.acceleration)
        second = tuple(
            b * r for b, r in zip(self.ansatz[1:], self.algebra.r, strict=False)
        )
        return (first, second) if self.ansatz else (first,)


def full(
    model: Model, order: int, field: str = "first", progress: Progress[int] = iter
) -> Solution:
    """Find the closure that satisfies all equations of motion, to D^order in all fields.

    field : the φ of the theory, "first", the displacement of the first particle, or "center", the
        mean Σ m̂_i w_i(x - x_i D) of all fields at one point, x_i = C_0 + … + C_{i-1}.
    """
    chain = _Slaving(model, order, field)
    for n in progress(range(1, order)):
        chain.extend(n)
    algebra, fields = chain.algebra, tuple(tuple(S)[:order] for S in chain.S)
    ansatz: tuple[fmpq_mpoly, ...] = ()
    if len(fields) > 1:
        slopes = (algebra.slope(S_n, n) for n, S_n in enumerate(fields[1]) if n)
        ansatz = (algebra.one, fields[1][0], *slopes)
    return Solution(
        algebra=algebra,
        acceleration=tuple(chain.E)[:order],
        ansatz=ansatz,
        slaved=fields,
    )


class _Slaving:
    """Solver of the full closure, one order of D at a time.

    mu, c : mass fractions m̂_i of the particles, strain shares C_i of the contacts behind them.
    x : places x_i = C_0 + … + C_{i-1} of the particles at rest.
    weights : the g_i of the mean φ(x) = Σ g_i w_i(x - x_i D).
    E : the terms of the wave equation.
    S, rates : the series S and ∂_τ (D φ_x S) of each field w = φ + D φ_x S.
    forces : the forces of the contacts.
    """

    def __init__(self, model: Model, order: int, field: str) -> None:
        self.algebra = algebra = model.algebra(max(order - 1, 1), velocity=True)
        self.order = order
        k, self.mu, self.c = model.elements(algebra)
        self.x = list(accumulate(self.c[:-1], initial=algebra.zero))
        self.weights = self.mu if field == "center" else [algebra.one]
        self.E = GradedSeries(algebra, k, [algebra.zero])
        self.S = [GradedSeries(algebra, algebra.one, [x]) for x in self.x]
        self.rates = [
            GradedSeries(algebra, algebra.half, [algebra.zero]) for _ in self.x
        ]
        self.forces = [Force(algebra, k) for _ in self.x]

    def extend(self, n: int) -> None:
        """Append the terms in D^n of wave equation E, strains X, forces Φ and fields S."""
        accelerations = [self.algebra.dt(rate, self.E, n) for rate in self.rates]
        if n + 1 < self.order:
            for rate, S in zip(self.rates, self.S, strict=True):
                rate.append(self.algebra.dt(S, self.E, n))
        # Momentum: in the sum of the equations of motion only the end forces remain.
        P = len(self.x)
        inertia = (mu * a for mu, a in zip(self.mu, accelerations, strict=True))
        self.E.append(
            -self.forces[-1].increment(-P, n) / P - sum(inertia, self.algebra.zero)
        )
        self._strains(n, accelerations)
        self._origin(n)

    def _strains(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """Append the term X_n of each contact's strain.

        Φ_i - Φ_0 gives the differences of the strains, and the cell their sum.
        """
        P, first = len(self.x), self.forces[0]
        total = self._shift(n) * P ** (n + 1) + self.S[0].increment(P, n)
        push, differences = (
            self.algebra.zero,
            [],
        )  # Φ_i - Φ_0, and X_i - X_0 of the strains
        for i, force in enumerate(self.forces):
            if i:
                push = push + P * self.mu[i] * (self.E[n] + accelerations[i])
            difference = push + first.nonlinear - force.nonlinear
            differences.append(difference)
            total = total - self.c[i] * difference
        for force, difference in zip(self.forces, differences, strict=True):
            force.append(total / P + difference)

    def _origin(self, n: int) -> None:
        """Append S_n of each particle, by the definition φ(x) = Σ g_i w_i(x - x_i D)."""
        strains = (
            c * force.X[n] for c, force in zip(self.c[:-1], self.forces, strict=False)
        )
        relative = list(accumulate(strains, initial=self.algebra.zero))
        origin = self.algebra.zero
        for g, x, S, d in zip(self.weights, self.x, self.S, relative, strict=False):
            moved = (-x) ** (n + 1) * self._shift(n) + S.increment(-x, n)
            origin = origin - g * (d + moved)
        for S, d in zip(self.S, relative, strict=True):
            S.append(origin + d)

    def _shift(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^{n+1} in (φ(x + D) - φ(x)) / φ_x."""
        return self.algebra.r[n] * fmpq(1, factorial(n + 1))
