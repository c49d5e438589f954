"""The force of a contact as a series in the spacing D.

Let p be the strain of the field and p (1 + X), X = Σ_{n≥1} D^n X_n, the strain of a contact divided
by its share C_i. The force of the contact is

    F(p (1 + X)) = F(p) + p F'(p) Φ,    Φ = Σ_{m≥1} φ_m X^m/m! = Σ_{n≥1} D^n Φ_n,

φ_m = p^{m-1} F^{(m)}(p)/F'(p).
"""

from __future__ import annotations

from functools import cache
from itertools import accumulate
from math import factorial
from operator import mul

from flint import fmpq, fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra


class Force:
    """The series X and Φ of a contact, to which terms are appended order by order.

    The law is that of the algebra, with its parameters φ_m, or else the power p^k, whose φ_m are
    (k-1) … (k-m+1).
    """

    def __init__(self, algebra: JetAlgebra, k: fmpq_mpoly) -> None:
        factors = (k - j for j in range(1, algebra.weight + 1))
        self.phi = algebra.phi or [algebra.zero, *accumulate(factors, mul, initial=algebra.one)]
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
        """The coefficient of D^n in X^m/m!, n ≥ m ≥ 1."""
        if m == 1:
            return self.X[n]
        parts = (self.X[j] * self._power_term(m - 1, n - j) for j in range(1, n - m + 2))
        return sum(parts, self.X[0]) / m

    def append(self, X_n: fmpq_mpoly) -> None:
        """Append the next term X_n to X, and Φ_n to Φ."""
        self.Phi.append(X_n + self.nonlinear)
        self.X.append(X_n)
        self._nonlinear = None

    def increment(self, h: int, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in [F(p) + p F' Φ](x + hD) - [F(p) + p F' Φ](x), divided by p F'."""
        # F(p) adds h^n/n! ∂_x^n F(p) = h^n/n! ∂_x^{n-1} (p F' r_1), r_1 = p_x/p.
        return self.Phi.increment(h, n) + self._slope.dx(0, n - 1) * fmpq(h**n, factorial(n))

    def work(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in ∫ Φ dX = [W(p (1 + X)) - W(p) - p F(p) X] / (p² F'), W' = F."""
        total = self.Phi[0]
        for j in range(1, n):
            total = total + j * self.X[j] * self.Phi[n - j]
        return total / n
