"""The wave equation in another field, φ = u + Σ_n α_n D^n ∂_x^n u with constants α_n.

Inverted, u = φ + Σ ℓ_n D^n ∂_x^n φ, so that with X = Σ ℓ_n D^n r_n the strain of u is p (1 + X),
its jets are (r_m + Σ ℓ_n D^n r_{m+n}) / (1 + X), those of its velocity likewise over
(1 + X)^{(k+1)/2}, and φ_ττ = (1 + Σ α_n D^n ∂_x^n) u_ττ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp
from flint import fmpq_mpoly

from lwa.closure import Closure
from lwa.exact import InputError
from lwa.jets import JetAlgebra, Ladder, Monomial, Power

Series = list[fmpq_mpoly]


def change_field(closure: Closure, alphas: Mapping[int, sp.Expr]) -> Closure:
    """The closure's wave equation for φ = u + Σ α_n D^n ∂_x^n u, n ≥ 1; the ansatz is left out.

    Raises `lwa.InputError` on the optical branch and for n < 1.
    """
    if closure.ring.branch != "acoustic":
        raise InputError("the change of field is for the acoustic branch")
    if any(n < 1 for n in alphas):
        raise InputError(f"n is {min(alphas)}: α_n D^n ∂_x^n changes the field for n from 1 on")
    return _Change(closure, alphas).result()


class _Change:
    def __init__(self, closure: Closure, alphas: Mapping[int, sp.Expr]) -> None:
        self.closure = closure
        old = closure.algebra
        self.ring = replace(closure.ring, constants=(*closure.ring.constants, *alphas.values()))
        self.algebra = JetAlgebra(
            self.ring.names, old.weight, self.ring.exponent if old.s else None
        )
        self.k = self.ring.exponent(self.algebra.context)
        first = len(closure.ring.constants)
        self.size = closure.order
        zero, one = self.algebra.zero, self.algebra.one
        self.alpha = [one] + [zero] * self.size
        for i, n in enumerate(alphas):
            if n <= self.size:
                self.alpha[n] = self.ring.constant(first + i, self.algebra.context)
        self.inverse = [one]
        for n in range(1, self.size):
            terms = (self.alpha[j] * self.inverse[n - j] for j in range(1, n + 1))
            self.inverse.append(-sum(terms, zero))

    def result(self) -> Closure:
        acceleration = Ladder(self.algebra, self.k)
        for n in range(self.size):
            total = self.algebra.zero
            for m in range(1, n + 1):
                total = total + self._replaced(m)[n - m]
            acceleration.append(total)
        found = []
        for n in range(self.size):
            parts = (self.alpha[j] * acceleration.dx(n - j, j) for j in range(n + 1))
            found.append(sum(parts, self.algebra.zero))
        return replace(
            self.closure,
            ring=self.ring,
            algebra=self.algebra,
            field="changed",
            acceleration=tuple(found),
            ansatz=(),
            slaved=(),
            defect=(),
        )

    def _replaced(self, m: int) -> Series:
        """E_m in the jets of φ: a series that starts at weight m."""
        total = [self.algebra.zero] * self.size
        old = self.closure.algebra
        for monomial, terms in old.terms(self.closure.acceleration[m]).items():
            padding = (0,) * (self.algebra.context.nvars() - len(old.parameters))
            coefficient = self.algebra.context.from_dict({(*e, *padding): c for e, c in terms})
            for j, part in enumerate(self._monomial(monomial, self.size - m)):
                total[j] = total[j] + coefficient * part
        return total

    def _monomial(self, monomial: Monomial, size: int) -> Series:
        """Π jets of u times (1 + X)^k, in the jets of φ, to ``size`` terms."""
        powers_t = sum(e for _, e in monomial.t)
        exponent = self.k - sum(e for _, e in monomial.x) - powers_t * (self.k + 1) / 2
        strain = Power(self.algebra, exponent)
        for n in range(1, size):
            strain.append(self.inverse[n] * self.algebra.r[n])
        series = [self.algebra.one, *(exponent * strain.Phi[n] for n in range(1, size))]
        for jets, powers in ((self.algebra.r, monomial.x), (self.algebra.s, monomial.t)):
            for m, e in powers:
                jet = [self.inverse[n] * jets[m + n] for n in range(size)]
                for _ in range(e):
                    series = self._product(series, jet)
        return series

    def _product(self, a: Series, b: Series) -> Series:
        zero = self.algebra.zero
        return [sum((a[j] * b[n - j] for j in range(n + 1)), zero) for n in range(len(a))]
