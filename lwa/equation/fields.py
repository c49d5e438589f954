"""The wave equation in another field, φ = u + Σ_n α_n D^n ∂_x^n u with constants α_n.

Inverted, u = φ + Σ ℓ_n D^n ∂_x^n φ, so that with X = Σ ℓ_n D^n r_n the strain of u is p (1 + X),
its jets are (r_m + Σ ℓ_n D^n r_{m+n}) / (1 + X), those of its velocity likewise divided by
(1 + X)^{(k+1)/2}, and φ_ττ = (1 + Σ α_n D^n ∂_x^n) u_ττ. Under a law that is no power, functions
of p, the φ_n in the coefficients among them, are expanded about φ_x.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.contact import Force, SeriesPowers
from lwa.algebra.jets import Ladder, Monomial
from lwa.base.exact import InputError
from lwa.closure.consistency import Closure

Series = list[fmpq_mpoly]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ChangedClosure(Closure):
    """A closure written for φ = u + Σ α_n D^n ∂_x^n u, without ansatz and defect.

    alphas : the (n, α_n), n ≥ 1; ``origin`` is the closure of u.
    """

    origin: Closure
    alphas: tuple[tuple[int, sp.Expr], ...]

    @property
    def key(self) -> tuple[Any, ...]:
        """The arguments of `change_field`, by which closures are compared."""
        return (self.origin, self.alphas)

    def __reduce__(self) -> tuple[Callable[..., Closure], tuple[Any, ...]]:
        return change_field, (self.origin, dict(self.alphas))

    def __repr__(self) -> str:
        shifts = ", ".join(f"{n}: {alpha}" for n, alpha in self.alphas)
        return f"{self.origin!r} in the field {{{shifts}}}"

    @cached_property
    def fields(self) -> tuple[tuple[fmpq_mpoly, ...], ...]:
        """The S_i of w_i = φ + D φ_x S_i in the new jets."""
        change = _Change(self.origin, dict(self.alphas))
        return tuple(map(change.slaved, self.origin.fields))

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """Symbols of the original closure and of the α_n."""
        own = set().union(*(alpha.free_symbols for _, alpha in self.alphas))
        own -= {*self.model.cell.symbols, *self.model.law.symbols, *self.origin.symbols}
        return (*self.origin.symbols, *sorted(own, key=str))

    def anew(
        self, new: Mapping[sp.Symbol, sp.Expr] | None = None, order: int | None = None
    ) -> Closure:
        """Derive again with these values of the symbols, or to this order."""
        alphas = {n: alpha.xreplace(new or {}) for n, alpha in self.alphas}
        return change_field(self.origin.anew(new, order), alphas)


def change_field(closure: Closure, alphas: Mapping[int, sp.Expr]) -> ChangedClosure:
    """The closure for φ = u + Σ α_n D^n ∂_x^n u, n ≥ 1.

    Raises `lwa.InputError` on the optical branch and for n < 1.
    """
    if closure.model.branch != "acoustic":
        raise InputError("the change of field is for the acoustic branch")
    if any(n < 1 for n in alphas):
        raise InputError(f"n is {min(alphas)}: α_n D^n ∂_x^n changes the field for n from 1 on")
    return _Change(closure, alphas).result()


class _Change:
    """The change from the field u of a closure to φ.

    alpha, inverse : the α_n and the ℓ_n of u = φ + Σ ℓ_n D^n ∂_x^n φ; both start with 1.
    """

    def __init__(self, closure: Closure, alphas: Mapping[int, sp.Expr]) -> None:
        self.closure, self.alphas, self.size = closure, alphas, closure.order
        old, constants = closure.algebra, closure.model.constants
        self.model = replace(closure.model, constants=(*constants, *alphas.values()))
        self.algebra = self.model.algebra(old.weight, velocity=bool(old.s))
        self.k = self.model.ring.exponent(self.algebra.context)
        zero, one = self.algebra.zero, self.algebra.one
        self.alpha = [one] + [zero] * self.size
        for i, n in enumerate(alphas, start=len(constants)):
            if n <= self.size:
                self.alpha[n] = self.model.ring.constant(i, self.algebra.context)
        self.inverse = [one]
        for n in range(1, self.size + 1):  # (Σ α_n D^n ∂_x^n)(Σ ℓ_n D^n ∂_x^n) = 1
            terms = (self.alpha[j] * self.inverse[n - j] for j in range(1, n + 1))
            self.inverse.append(-sum(terms, zero))

    def result(self) -> ChangedClosure:
        closure = self.closure
        return ChangedClosure(
            algebra=self.algebra,
            acceleration=self._acceleration(),
            model=self.model,
            order=closure.order,
            name=closure.name,
            field="changed",
            origin=closure,
            alphas=tuple(self.alphas.items()),
        )

    def _acceleration(self) -> tuple[fmpq_mpoly, ...]:
        """The terms of φ_ττ = (1 + Σ α_n D^n ∂_x^n) u_ττ."""
        E = Ladder(self.algebra, self.k, self._replaced(self.closure.acceleration, self.k))
        return tuple(
            sum((self.alpha[j] * E.dx(n - j, j) for j in range(n + 1)), self.algebra.zero)
            for n in range(self.size)
        )

    def slaved(self, S: Sequence[fmpq_mpoly]) -> tuple[fmpq_mpoly, ...]:
        """The terms of [(u - φ) + D u_x S] / (D φ_x) in the jets of φ; the numerator is w - φ."""
        moved = self._replaced(S, self.algebra.one)
        return tuple(self.inverse[n + 1] * self.algebra.r[n] + moved[n] for n in range(self.size))

    def _replaced(self, terms: Sequence[fmpq_mpoly], exponent: fmpq_mpoly) -> Series:
        """The series u_x^e Σ D^m f_m in the jets of φ."""
        old, context = self.closure.algebra, self.algebra.context
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
        if not self.algebra.phi:  # (1 + X)^e = 1 + e Φ
            strain = Force(self.algebra, degree)
            for X_n in X:
                strain.append(X_n)
            return [coefficient, *(coefficient * degree * Phi_n for Phi_n in tuple(strain.Phi)[1:])]
        # The coefficient depends on p too: Taylor's series in p X, with p^m ∂_p^m coefficient.
        slopes = [coefficient]
        for m in range(size - 1):
            slopes.append(self.algebra.dp(slopes[-1], degree - m))
        powers = SeriesPowers([self.algebra.zero, *X])
        rest = (slopes[1] * X[n - 1] + powers.sum(slopes, n) for n in range(1, size))
        return [coefficient, *rest]

    def _product(self, a: Series, b: Series) -> Series:
        zero = self.algebra.zero
        return [sum((a[j] * b[n - j] for j in range(n + 1)), zero) for n in range(len(a))]
