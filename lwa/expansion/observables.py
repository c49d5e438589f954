"""Speed, widths, momentum and energy of a wave of `lwa.expansion.recursion`.

Letters as in that module. Each quantity, divided by its leading term or in the unit stated, is a
series in t. The even terms, polynomials in ``√log 2`` over the recursion's ring, become the
coefficients of a series in ε, in the caller's symbols.
"""

from __future__ import annotations

from functools import cache, cached_property, lru_cache

import sympy as sp
from flint import fmpq, fmpq_mpoly

from lwa.algebra.model import Model
from lwa.cell import Cell
from lwa.expansion.pulse import (
    Series,
    by_degree,
    full_width,
    logarithm,
    moments,
    power,
    product,
)
from lwa.expansion.recursion import Recursion
from lwa.law import Power


class Observables:
    """Speed, widths, momentum and energy of a wave: series in t, computed on demand.

    Parameters
    ----------
    wave : Recursion
        The solved recursion.

    Notes
    -----
    Full widths at half maximum are in units of ``4 √(I log 2/ε)``, the width of the Gaussian.
    """

    def __init__(self, wave: Recursion) -> None:
        self.wave = wave
        self.order = wave.order

    @cached_property
    def c2(self) -> Series:
        """The square c² of the speed, divided by its leading term."""
        return self.wave.gamma[: 2 * self.order + 1]

    @cached_property
    def speed(self) -> Series:
        """The speed c, divided by its leading term."""
        return power(self.c2, fmpq(1, 2))

    # Quantities have the names by which `coefficients` is asked for them; a force, a strain and a
    # velocity stand for their widths.

    def force(self, contact: int = 0) -> Series:
        """Full width at half maximum of a contact's force."""
        return full_width(self.wave.force[contact].log)

    def strain(self, contact: int = 0) -> Series:
        """Full width at half maximum of a contact's strain."""
        return full_width(self.wave.strain[contact].log)

    def velocity(self, contact: int = 0) -> Series:
        """Full width at half maximum of the velocity of bead i, the bead behind contact i."""
        return full_width(logarithm(self.wave.slope[contact]))

    @cached_property
    def momentum(self) -> Series:
        """Momentum, mean mass · c · displacement behind the wave, divided by its leading term."""
        # e^{-Z²/4} is a normal distribution of variance 2.
        return product(self.speed, moments(self.wave.mean, variance=2))

    @cached_property
    def energy(self) -> Series:
        """Kinetic and elastic energy in units of ``ā √(2πI/ε)``.

        The energy is (k + 3)/2 times its elastic part. This virial theorem follows from ``dE = c
        dP`` along the waves of all amplitudes, with the momentum ``P = 2 T/c``, T the kinetic
        energy: E goes as ``F^{(k+1)/k}`` and c as ``F^{(k-1)/2k}``.
        """
        wave = self.wave
        # (k + 3)/2 of the elastic 1/(k + 1) is (1 + 1/(1 + ε/2))/2; here per contact
        share = [wave.zero for _ in self.c2]
        for n in range(0, len(share), 2):
            share[n] = (-wave.epsilon / 2) ** (n // 2) / (2 * wave.P)
        share[0] = share[0] + fmpq(1, 2 * wave.P)
        # ∫ Σ C_i f_i r_i dξ over ∫ e^{-Z²/2} dξ, whose variance is 1
        work = [wave.zero for _ in self.c2]
        for c, force, strain in zip(wave.c, wave.force, wave.strain, strict=True):
            for n, term in enumerate(product(force.series, strain.series)):
                work[n] = work[n] + c * term
        return product(share, moments(work, variance=1))

    @cached_property
    def effective_mass(self) -> Series:
        """Effective mass P²/(2E), P the momentum and E the energy, divided by its leading term."""
        square = product(self.momentum, self.momentum)
        return product(square, power(self.energy, fmpq(-1)))

    def coefficients(self, quantity: str, contact: int = 0) -> tuple[sp.Expr, ...]:
        """Coefficients of the powers of ε in the named quantity, from the power 0 on."""
        found = getattr(self, quantity)
        terms: Series = found(contact) if callable(found) else found
        result = []
        for n in range(self.order + 1):
            parts = []
            # Widths are polynomials in y², which is log 2 at half of the peak.
            for d, coefficient in by_degree(terms[2 * n]).items():
                # t² = ε/I³; SymPy cancels the factors I of the numerator.
                part = self._expression(coefficient) / self.I ** (3 * n)
                parts.append(part * sp.log(2) ** (d // 2))
            # SymPy sorts a sum anew for each term that is added.
            result.append(sp.Add(*parts))
        return tuple(result)

    @cached_property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's dispersion ``Ω² = κ² - I κ⁴ + …``, in units of D²."""
        return self._expression(self.wave.I)

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        """A polynomial without Z in the caller's symbols."""
        # Z is the first generator.
        terms = [(tuple(map(int, e[1:])), c) for e, c in polynomial.terms()]
        return self.wave.model.expression(terms)


def shares_model(cell: Cell, k: sp.Expr) -> Model:
    """The model of a cell; with 1 for k if contacts are equal, whose shares do not depend on k."""
    # With symbols for k the ring of the recursion would have one generator more.
    if cell.equal_contacts:
        k = sp.S.One
    return Model(cell, Power(k))


# An order of 80 holds 11 MB.
@lru_cache(maxsize=4)
def _equal_beads(order: int) -> Observables:
    """The quantities of the chain of equal beads, to this order."""
    # The shares of equal contacts do not depend on k: any exponent makes the same model.
    return Observables(Recursion(shares_model(Cell((1,)), sp.S.One), order))


@cache
def equal_beads(quantity: str, order: int) -> tuple[sp.Expr, ...]:
    """Coefficients of a quantity of `Observables` for equal beads, of the powers of ε from 0 on.

    They are cached, as the sums of other chains need them.
    """
    return _equal_beads(order).coefficients(quantity)
