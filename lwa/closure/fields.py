"""The wave equation in another field, φ = u + Σ_n α_n D^n ∂_x^n u with constants α_n.

Inverted, u = φ + Σ ℓ_n D^n ∂_x^n φ, so that with X = Σ ℓ_n D^n r_n the strain of u is p (1 + X),
its jets are (r_m + Σ ℓ_n D^n r_{m+n}) / (1 + X), those of its velocity likewise divided by
(1 + X)^{(k+1)/2}, and φ_ττ = (1 + Σ α_n D^n ∂_x^n) u_ττ. Under a law that is no power, functions
of p, the φ_n in the coefficients among them, are expanded about φ_x.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.contact import SeriesPowers
from lwa.algebra.jets import GradedSeries, Monomial
from lwa.algebra.model import Model
from lwa.base.exact import InputError
from lwa.closure.solution import Solution

Series = list[fmpq_mpoly]


def in_field(
    solution: Solution, model: Model, order: int, alphas: Mapping[int, sp.Expr]
) -> tuple[Model, Solution]:
    """A solution written for φ = u + Σ α_n D^n ∂_x^n u, n ≥ 1, and its model with the α_n.

    Raises `lwa.InputError` on the optical branch and for n < 1.
    """
    if model.branch != "acoustic":
        raise InputError("the change of field is for the acoustic branch")
    if any(n < 1 for n in alphas):
        raise InputError(f"n is {min(alphas)}: α_n D^n ∂_x^n changes the field for n from 1 on")
    change = _Change(solution, model, order, alphas)
    return change.model, change.result()


class _Change:
    """The change from the field u of a solution to φ.

    alpha, inverse : the α_n and the ℓ_n of u = φ + Σ ℓ_n D^n ∂_x^n φ; both start with 1.
    """

    def __init__(
        self, solution: Solution, model: Model, order: int, alphas: Mapping[int, sp.Expr]
    ) -> None:
        self.solution, self.size = solution, order
        self.model = replace(model, constants=(*model.constants, *alphas.values()))
        old = solution.algebra
        self.algebra = self.model.algebra(old.weight, velocity=bool(old.s))
        self.k = self.model.ring.exponent(self.algebra.context)
        zero, one = self.algebra.zero, self.algebra.one
        self.alpha = [one] + [zero] * order
        for i, n in enumerate(alphas, start=len(model.constants)):
            if n <= order:
                self.alpha[n] = self.model.ring.constant(i, self.algebra.context)
        self.inverse = [one]
        for n in range(1, order + 1):  # (Σ α_n D^n ∂_x^n)(Σ ℓ_n D^n ∂_x^n) = 1
            terms = (self.alpha[j] * self.inverse[n - j] for j in range(1, n + 1))
            self.inverse.append(-sum(terms, zero))

    def result(self) -> Solution:
        old = self.solution
        return Solution(
            algebra=self.algebra,
            acceleration=self._applied(old.acceleration),
            slaved=tuple(map(self._slaved, old.fields)),
            defect=self._applied(old.defect),
        )

    def _applied(self, terms: Sequence[fmpq_mpoly]) -> tuple[fmpq_mpoly, ...]:
        """The terms of (1 + Σ α_n D^n ∂_x^n) (u_x^k Σ D^n E_n) in the jets of φ."""
        E = GradedSeries(self.algebra, self.k, self._replaced(terms, self.k)[: len(terms)])
        return tuple(
            sum((self.alpha[j] * E.dx(n - j, j) for j in range(n + 1)), self.algebra.zero)
            for n in range(len(terms))
        )

    def _slaved(self, S: Sequence[fmpq_mpoly]) -> tuple[fmpq_mpoly, ...]:
        """Convert S of a field w = u + D u_x S to the S of w = φ + D φ_x S, in the jets of φ."""
        moved = self._replaced(S, self.algebra.one)  # w - φ = (u - φ) + D u_x S
        return tuple(self.inverse[n + 1] * self.algebra.r[n] + moved[n] for n in range(self.size))

    def _replaced(self, terms: Sequence[fmpq_mpoly], exponent: fmpq_mpoly) -> Series:
        """The series u_x^e Σ D^m f_m in the jets of φ."""
        old, context = self.solution.algebra, self.algebra.context
        padding = (0,) * (context.nvars() - len(old.parameters))
        total = [self.algebra.zero] * self.size
        for m, f in enumerate(terms):
            for monomial, parameters in old.terms(f).items():
                coefficient = context.from_dict({(*e, *padding): c for e, c in parameters})
                parts = self._monomial(monomial, coefficient, exponent, self.size - m)
                for j, part in enumerate(parts):
                    total[m + j] = total[m + j] + part
        return total

    def _monomial(
        self, monomial: Monomial, coefficient: fmpq_mpoly, exponent: fmpq_mpoly, size: int
    ) -> Series:
        """The term coefficient · Π jets of u · u_x^e in the jets of φ, to ``size`` terms."""
        powers_t = sum(e for _, e in monomial.t)
        degree = exponent - sum(e for _, e in monomial.x) - powers_t * (self.k + 1) / 2
        series = self._of_strain(coefficient, degree, size)
        for jets, powers in ((self.algebra.r, monomial.x), (self.algebra.s, monomial.t)):
            for m, e in powers:
                jet = [self.inverse[n] * jets[m + n] for n in range(size)]
                for _ in range(e):
                    series = self._product(series, jet)
        return series

    def _of_strain(self, coefficient: fmpq_mpoly, degree: fmpq_mpoly, size: int) -> Series:
        """The series of coefficient · (1 + X)^degree, where 1 + X = u_x/φ_x."""
        X = [self.inverse[n] * self.algebra.r[n] for n in range(1, size)]
        # Taylor's series in p X, with p^m ∂_p^m coefficient: the φ_n depend on p too.
        slopes = [coefficient]
        for m in range(size - 1):
            slopes.append(self.algebra.dp(slopes[-1], degree - m))
        powers = SeriesPowers([self.algebra.zero, *X])
        rest = (slopes[1] * X[n - 1] + powers.sum(slopes, n) for n in range(1, size))
        return [coefficient, *rest]

    def _product(self, a: Series, b: Series) -> Series:
        zero = self.algebra.zero
        return [sum((a[j] * b[n - j] for j in range(n + 1)), zero) for n in range(len(a))]
