"""The force of a contact as a series in the spacing D, for a power and for any other law.

Let p be the strain of the field and p (1 + X), X = Σ_{n≥1} D^n X_n, the strain of a contact divided
by its share C_i. The force of the contact is

    F(p (1 + X)) = F(p) + p F'(p) Φ,    Φ = Σ_{m≥1} φ_m X^m/m! = Σ_{n≥1} D^n Φ_n,

φ_m = p^{m-1} F^{(m)}(p)/F'(p). For F = p^k the terms Φ_n obey a recurrence (`Binomial`); for any
other law they are sums over the powers of X (`Smooth`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.algebra.jets import JetAlgebra, Ladder


class Force(ABC):
    """The series X and Φ of a contact, to which terms are appended order by order."""

    def __init__(self, algebra: JetAlgebra, k: fmpq_mpoly) -> None:
        self.k = k
        self.X: list[fmpq_mpoly] = [algebra.zero]
        self.Phi = Ladder(algebra, k)
        self.Phi.append(algebra.zero)
        self._one = Ladder(algebra, k)
        self._one.append(algebra.r[1])
        self._known: fmpq_mpoly | None = None

    @property
    def known(self) -> fmpq_mpoly:
        """The nonlinear part Φ_n - X_n of the next order n, known from X_1 … X_{n-1}."""
        if self._known is None:
            self._known = self._nonlinear(len(self.X))
        return self._known

    @abstractmethod
    def _nonlinear(self, n: int) -> fmpq_mpoly:
        """Compute Φ_n - X_n for `known`."""

    def append(self, X_n: fmpq_mpoly) -> None:
        """Append the next term X_n to X, and Φ_n to Φ."""
        self.Phi.append(X_n + self.known)
        self.X.append(X_n)
        self._known = None

    def carried(self, h: int, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in [F(p) + p F' Φ](x + hD) - [F(p) + p F' Φ](x), divided by p F'.

        The part of F(p) in the increment is h^n/n! ∂_x^{n-1} r_1, r_1 = p_x/p.
        """
        return self.Phi.carried(h, n) + self._one.dx(0, n - 1) * fmpq(h**n, factorial(n))

    def work(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in ∫ Φ dX = [W(p (1 + X)) - W(p) - p F(p) X] / (p² F'), W' = F."""
        total = self.Phi[0]
        for j in range(1, n):
            total = total + j * self.X[j] * self.Phi[n - j]
        return total / n


class Binomial(Force):
    """The force series Φ of a power law, (1 + X)^k = 1 + k Φ.

    With Y = (1 + X)^k the recurrence n Y_n = Σ_{j=1..n} (k j - (n - j)) X_j Y_{n-j} gives

        Φ_n = X_n + ((k + 1)/n) Σ_{j<n} j X_j Φ_{n-j} - Σ_{j<n} X_j Φ_{n-j},

    a polynomial in k, free of divisions by k.
    """

    def _nonlinear(self, n: int) -> fmpq_mpoly:
        plain = weighted = self.Phi[0]
        for j in range(1, n):
            product = self.X[j] * self.Phi[n - j]
            plain = plain + product
            weighted = weighted + j * product
        return (self.k + 1) * weighted / n - plain


class Smooth(Force):
    """The force series Φ of a law whose φ_m are parameters of the algebra."""

    def __init__(self, algebra: JetAlgebra, k: fmpq_mpoly) -> None:
        super().__init__(algebra, k)
        self._phi = algebra.phi
        self._powers = SeriesPowers(self.X)

    def _nonlinear(self, n: int) -> fmpq_mpoly:
        return self._powers.sum(self._phi, n)


class SeriesPowers:
    """Powers X^m/m! of a graded series X = Σ_{n≥1} D^n X_n, to which terms may be appended."""

    def __init__(self, X: Sequence[fmpq_mpoly]) -> None:
        self._X = X
        self._known: dict[tuple[int, int], fmpq_mpoly] = {}

    def term(self, m: int, n: int) -> fmpq_mpoly:
        """The coefficient of D^n in X^m/m!, n ≥ m ≥ 1."""
        if m == 1:
            return self._X[n]
        if (m, n) not in self._known:
            total = self._X[0]
            for j in range(1, n - m + 2):
                total = total + self._X[j] * self.term(m - 1, n - j)
            self._known[m, n] = total / m
        return self._known[m, n]

    def sum(self, coefficients: Sequence[fmpq_mpoly], n: int) -> fmpq_mpoly:
        """The coefficient of D^n in Σ_{m≥2} c_m X^m/m!."""
        total = self._X[0]
        for m in range(2, n + 1):
            total = total + coefficients[m] * self.term(m, n)
        return total


def contact(algebra: JetAlgebra, k: fmpq_mpoly) -> Force:
    """Make the force of a contact: a `Smooth` law if the algebra has its φ_n, else δ^k."""
    return Smooth(algebra, k) if algebra.phi else Binomial(algebra, k)
