"""Speed, widths, momentum, energy and profile of a wave of `lwa.expansion.recursion`.

Letters as in that module. Each quantity, divided by its leading term or in the unit stated, is a
series in t. The even terms, polynomials in √log 2 over the recursion's ring, become the
coefficients of a series in ε, in the caller's symbols.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property, lru_cache
from math import factorial
from typing import Any

import sympy as sp
from flint import fmpq, fmpq_mpoly

from lwa.algebra.model import Model
from lwa.algebra.ring import to_flint, to_sympy
from lwa.base.progress import Progress
from lwa.cell import Cell
from lwa.expansion.pulse import (
    Series,
    by_degree,
    half_width,
    logarithm,
    moment,
    power,
    product,
    width_of_power,
)
from lwa.expansion.recursion import Recursion
from lwa.law import Power


class Observables:
    """Speed, widths, momentum, energy and profile of a wave: series in t ∝ √ε, computed on demand.

    model : the cell at its exponent.
    order : highest power of ε.
    """

    def __init__(
        self, model: Model, order: int, progress: Progress[int] = iter
    ) -> None:
        self.model, self.order = model, order
        self.wave = Recursion(model, 2 * order, progress)

    @property
    def c2(self) -> Series:
        """The square c² of the speed, divided by its leading term."""
        return self.wave.gamma[: 2 * self.order + 1]

    @cached_property
    def c(self) -> Series:
        """The speed c, divided by its leading term."""
        return power(self.c2, fmpq(1, 2))

    @cached_property
    def force(self) -> Series:
        """Full width at half maximum of the force, in units of 4 √(I log 2/ε)."""
        return half_width(self.wave.fields.log_force[0])

    @cached_property
    def strain(self) -> Series:
        """Full width at half maximum of the strain F^{1/k}, in units of 4 √(I log 2/ε)."""
        return width_of_power(self.force, self.wave.epsilon)

    @cached_property
    def velocity(self) -> Series:
        """Full width at half maximum of the first bead's velocity, in units of 4 √(I log 2/ε)."""
        return half_width(logarithm(self._slope))

    @cached_property
    def _slope(self) -> Series:
        """Slope s_0 of the first bead, shifted by half a cell to be even in ξ for equal beads.

        This slope is the operator (P∂/2)/sinh(P∂/2) applied to the mean strain.
        """
        wave = self.wave
        # x/sinh x = Σ_m (2^{1-m} - 1) B_m (2x)^m/m!, m even
        weights = [
            (fmpq(2) ** (1 - m) - 1)
            * fmpq(wave.P**m, factorial(m))
            * to_flint(sp.bernoulli(m))
            for m in range(0, 2 * self.order + 1, 2)
        ]
        return [
            sum(
                (w * term for w, term in zip(weights, terms[::2], strict=False)),
                wave.zero,
            )
            for terms in wave.fields.means
        ]

    @cached_property
    def momentum(self) -> Series:
        """Momentum, mean mass · c · displacement behind the wave, divided by its leading term."""
        return product(
            self.c, [moment(terms[0], 2) for terms in self.wave.fields.means]
        )

    @cached_property
    def kinetic(self) -> Series:
        """Kinetic energy in units of ā √(2πI/ε)."""
        slopes = self.wave.fields.slope
        return [
            a / 2
            for a in product(
                self.c2, self._mean_square(self.wave.mu, slopes, slopes), 2
            )
        ]

    @cached_property
    def energy(self) -> Series:
        """Kinetic and elastic energy in units of ā √(2πI/ε), (k + 3)/2 times the elastic energy.

        This virial theorem follows from dE = c dP along the waves of all amplitudes, where
        P = 2 T/c is the momentum and T the kinetic energy: E ∝ F^{(k+1)/k} and c ∝ F^{(k-1)/2k}.
        """
        wave = self.wave
        share = [wave.zero for _ in self.c2]  # (k + 3)/2 of 1/(k + 1), per contact
        for n in range(0, len(share), 2):
            share[n] = (-wave.epsilon / 2) ** (n // 2) / (2 * wave.P)
        share[0] = share[0] + fmpq(1, 2 * wave.P)
        works = self._mean_square(wave.c, wave.fields.force, wave.fields.strain)
        return product(share, works, 2)

    @cached_property
    def effective_mass(self) -> Series:
        """Effective mass P²/(2E), P the momentum and E the energy, divided by its leading term."""
        return product(
            product(self.momentum, self.momentum), power(self.energy, fmpq(-1))
        )

    def _mean_square(
        self, weights: Series, first: Iterable[Series], second: Iterable[Series]
    ) -> Series:
        """The integral Σ weight ∫ first · second dξ of fields e^{-Z²/4} S, over ∫ e^{-Z²/2} dξ."""
        rows = [
            [weight * term for term in product(a, b, 2)]
            for weight, a, b in zip(weights, first, second, strict=True)
        ]
        return [
            moment(sum(terms, self.wave.zero), 1) for terms in zip(*rows, strict=True)
        ]

    def coefficients(self, quantity: str) -> tuple[sp.Expr, ...]:
        """Coefficients of ε^0, ε^1, … of the named quantity, at Z² = log 2."""
        terms: Series = getattr(self, quantity)
        return tuple(
            sp.Add(
                *(
                    self._over_I(c, 3 * n) * sp.log(2) ** (d // 2)
                    for d, c in by_degree(terms[2 * n]).items()
                )
            )
            for n in range(self.order + 1)
        )

    def log_force(self, contact: int) -> dict[sp.Rational, dict[int, sp.Expr]]:
        """Mapping n → d → coefficient of X^d in φ_n (`lwa.Expansion.log_force`)."""
        # t = ε^{1/2} I^{-3/2} and Z = X I^{-1/2}: a term c Z^d t^n is c I^{-(3n+d)/2} X^d ε^{n/2}.
        phi = {sp.S.Zero: {2: -1 / (4 * self.I)}}
        for n, q in enumerate(self.wave.fields.log_force[contact]):
            if q:
                parts = by_degree(q).items()
                phi[sp.Rational(n, 2)] = {
                    d: self._over_I(c, (3 * n + d) // 2) for d, c in parts
                }
        return phi

    @cached_property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's dispersion Ω² = κ² - I κ⁴ + …, in units of D²."""
        return self._over_I(self.wave.I, 0)

    def _over_I(self, numerator: fmpq_mpoly, e: int) -> sp.Expr:
        """The quotient numerator / I^e, in the caller's symbols."""
        I = self.wave.I
        if not self.model.ring.names:
            top, bottom = (
                p.leading_coefficient() if p else fmpq(0) for p in (numerator, I)
            )
            return to_sympy(top / bottom**e)
        while e:
            quotient, remainder = divmod(numerator, I)
            if remainder:
                break
            numerator, e = quotient, e - 1
        return self._expression(numerator) / self._I**e

    @cached_property
    def _I(self) -> sp.Expr:
        return self._expression(self.wave.I)

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        terms: list[tuple[tuple[int, ...], Any]] = [
            (tuple(map(int, e[1:])), c) for e, c in polynomial.terms()
        ]
        return self.model.ring.expression(terms)


def shares_model(cell: Cell, k: sp.Expr) -> Model:
    """The model of a cell; with k = 1 for equal contacts, whose shares do not depend on k."""
    equal = len({*cell.stiffnesses}) == 1
    return Model(cell, Power(sp.S.One if equal else k))


@lru_cache(maxsize=4)
def _equal_beads(order: int) -> Observables:
    return Observables(Model(Cell((1,)), Power(sp.S.One)), order)


@lru_cache(maxsize=32)
def equal_beads(quantity: str, order: int) -> tuple[sp.Expr, ...]:
    """Coefficients of the chain of equal beads; cached, as the sums of other chains need them."""
    return _equal_beads(order).coefficients(quantity)
