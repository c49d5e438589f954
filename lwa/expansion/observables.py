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
from lwa.algebra.rational import to_flint, to_sympy
from lwa.base.progress import Progress
from lwa.cell import Cell
from lwa.expansion.pulse import (
    Series,
    by_degree,
    half_width,
    log_term,
    moment,
    product,
    quotient,
    root,
    wider,
)
from lwa.expansion.recursion import Recursion
from lwa.law import Power


class Observables:
    """The quantities of one wave as series in t, each computed on first use.

    model : the cell at its exponent.
    order : highest power of ε.
    """

    def __init__(self, model: Model, order: int, progress: Progress[int] = iter) -> None:
        self.model, self.order = model, order
        self.wave = Recursion(model, 2 * order, progress)

    @property
    def c2(self) -> Series:
        """The square c² of the speed, divided by its leading term."""
        return self.wave.gamma[: 2 * self.order + 1]

    @cached_property
    def c(self) -> Series:
        """The speed c, divided by its leading term."""
        return root(self.c2)

    @cached_property
    def force(self) -> Series:
        """Full width at half maximum of the force, in units of 4 √(I log 2/ε)."""
        return half_width(self.wave.fields.log_force[0])

    @cached_property
    def strain(self) -> Series:
        """Full width at half maximum of the strain F^{1/k}, in units of 4 √(I log 2/ε)."""
        return wider(self.force, self.wave.epsilon)

    @cached_property
    def velocity(self) -> Series:
        """Full width at half maximum of the first bead's velocity, in units of 4 √(I log 2/ε)."""
        log: Series = []
        for _ in self._slope:
            log.append(log_term(self._slope, log))
        return half_width(log)

    @cached_property
    def peak_velocity(self) -> Series:
        """Peak velocity of equal beads, c times the slope at Z = 0, divided by its leading term."""
        zero = self.wave.zero
        return product(self.c, [by_degree(term).get(0, zero) for term in self._slope])

    @cached_property
    def _slope(self) -> Series:
        """Slope s_0 of the first bead, shifted by half a cell to be even in ξ for equal beads.

        This slope is the operator (P∂/2)/sinh(P∂/2) applied to the mean strain.
        """
        wave = self.wave
        weights = [
            (fmpq(2) ** (1 - m) - 1) * fmpq(wave.P**m, factorial(m)) * to_flint(sp.bernoulli(m))
            for m in range(0, 2 * self.order + 1, 2)
        ]
        return [
            sum((w * term for w, term in zip(weights, terms[::2], strict=False)), wave.zero)
            for terms in wave.fields.means
        ]

    @cached_property
    def momentum(self) -> Series:
        """Momentum, M/P · c · the displacement behind the wave, divided by its leading term."""
        return product(self.c, [moment(terms[0], 2) for terms in self.wave.fields.means])

    @cached_property
    def kinetic(self) -> Series:
        """Kinetic energy in units of ā √(2πI/ε)."""
        wave = self.wave
        squares = (product(s, s, 2) for s in wave.fields.slope)
        kinetic = _sum(wave.mu, squares, wave.zero)
        return [moment(a, 1) / 2 for a in product(self.c2, kinetic, 2)]

    @cached_property
    def energy(self) -> Series:
        """Kinetic and elastic energy in units of ā √(2πI/ε), (k + 3)/2 times the elastic energy.

        This virial theorem follows from dE = c dP along the waves of all amplitudes, where
        P = 2 T/c is the momentum and T the kinetic energy.
        """
        wave = self.wave
        pairs = zip(wave.fields.force, wave.fields.strain, strict=True)
        works = _sum(wave.c, (product(f, r, 2) for f, r in pairs), wave.zero)
        share = [wave.zero for _ in works]  # (k + 3)/2 of 1/(k + 1), per contact
        for n in range(0, len(share), 2):
            share[n] = (-wave.epsilon / 2) ** (n // 2) / (2 * wave.P)
        share[0] = share[0] + fmpq(1, 2 * wave.P)
        return [moment(a, 1) for a in product(share, works, 2)]

    @cached_property
    def effective_mass(self) -> Series:
        """Effective mass P²/(2E), P the momentum and E the energy, divided by its leading term."""
        return quotient(product(self.momentum, self.momentum), self.energy)

    @cached_property
    def linear_loss(self) -> Series:
        """Contacts' mean of ∫ (dδ/dt)² dt, δ the compression, divided by its leading term.

        In the wave dδ/dt = -c dδ/dξ and dt = dξ/c, so that this is c ∫ (dδ/dξ)² dξ.
        """
        strain, c = self.wave.fields.strain, self.wave.c
        return self._loss([share * share for share in c], strain, strain)

    @cached_property
    def kuwabara_kono_loss(self) -> Series:
        """Equal contacts' mean of ∫ δ^{k-1} (dδ/dt)² dt, divided by its leading term.

        With F = A δ^k the integrand is (dF/dt) (dδ/dt) / (k A).
        """
        fields = self.wave.fields
        return self._loss(self.wave.c, fields.force, fields.strain)

    def _loss(self, weights: Series, first: list[Series], second: list[Series]) -> Series:
        """The loss c Σ weight ∫ (d first/dξ) (d second/dξ) dξ, divided by its leading term."""
        slopes = ([list(map(_slope, row)) for row in rows] for rows in (first, second))
        products = (product(a, b, 2) for a, b in zip(*slopes, strict=True))
        total = _sum(weights, products, self.wave.zero)
        return product(self.c, [4 * moment(a, 1) / self.wave.P for a in total])

    def coefficients(self, quantity: str) -> tuple[sp.Expr, ...]:
        """Coefficients of ε^0, ε^1, … of the named quantity, at Z² = log 2."""
        terms: Series = getattr(self, quantity)
        found = []
        logs = [sp.log(2) ** m for m in range(self.order + 1)]
        for n in range(self.order + 1):
            by_log = by_degree(terms[2 * n])
            parts = (self.over(c, 3 * n) * logs[d // 2] for d, c in by_log.items())
            found.append(sp.Add(*parts))
        return tuple(found)

    def log_force(self, contact: int) -> dict[sp.Rational, dict[int, sp.Expr]]:
        """Mapping n → d → coefficient of X^d in φ_n (`lwa.Expansion.log_force`)."""
        found = {sp.S.Zero: {2: -1 / (4 * self.I)}}
        for n, q in enumerate(self.wave.fields.log_force[contact]):
            if q:
                parts = by_degree(q).items()
                found[sp.Rational(n, 2)] = {d: self.over(c, (3 * n + d) // 2) for d, c in parts}
        return found

    @cached_property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's dispersion Ω² = κ² - I κ⁴ + …, in units of D²."""
        return self.over(self.wave.I, 0)

    def over(self, numerator: fmpq_mpoly, power: int) -> sp.Expr:
        """The quotient numerator / I^power, in the caller's symbols."""
        I = self.wave.I
        if not self.model.ring.names:
            return to_sympy(_constant(numerator) / _constant(I) ** power)
        while power:
            quotient, remainder = divmod(numerator, I)
            if remainder:
                break
            numerator, power = quotient, power - 1
        return self._expression(numerator) * self._below(power)

    @cached_property
    def _powers(self) -> list[sp.Expr]:
        return [sp.S.One, 1 / self._expression(self.wave.I)]

    def _below(self, power: int) -> sp.Expr:
        while len(self._powers) <= power:
            self._powers.append(self._powers[1] ** len(self._powers))
        return self._powers[power]

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        terms: list[tuple[tuple[int, ...], Any]] = [
            (tuple(map(int, e[1:])), c) for e, c in polynomial.terms()
        ]
        return self.model.ring.expression(terms)


def _constant(polynomial: fmpq_mpoly) -> fmpq:
    return polynomial.leading_coefficient() if polynomial else fmpq(0)


def _slope(term: fmpq_mpoly) -> fmpq_mpoly:
    """The derivative e^{Z²/4} d/dZ [e^{-Z²/4} S(Z)]."""
    return term.derivative(0) - term.context().gen(0) * term / 2


def _sum(weights: Series, rows: Iterable[Series], zero: fmpq_mpoly) -> Series:
    """The weighted sum Σ weight · row."""
    weighted = ([w * term for term in row] for w, row in zip(weights, rows, strict=True))
    return [sum(terms, zero) for terms in zip(*weighted, strict=True)]


def shares_model(cell: Cell, k: sp.Expr) -> Model:
    """The model of a cell; with k = 1 for equal contacts, whose shares do not depend on k."""
    equal = len({*cell.stiffnesses}) == 1
    return Model(cell, Power(sp.S.One if equal else k))


@lru_cache(maxsize=4)
def _equal_beads(order: int) -> Observables:
    return Observables(Model(Cell((1,)), Power(sp.S.One)), order)


@lru_cache(maxsize=32)
def equal_beads(quantity: str, order: int) -> tuple[sp.Expr, ...]:
    """Coefficients of the chain of equal beads; cached, as the sums of other chains need them.

    >>> equal_beads("c2", 2)
    (1, -1/2, 2/5)
    """
    return _equal_beads(order).coefficients(quantity)
