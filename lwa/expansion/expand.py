"""The expansion of a chain's traveling waves in ``ε = k - 1``, exact at every order.

Near k of 1 a wave is long, and the long-wave theory is the leading order of its width,
``1/√ε``. The lattice's own equations are expanded (`lwa.expansion.recursion`); for equal beads the
first order is the wave of Chatterjee, Phys. Rev. E 59, 5912 (1999). Speed, widths, momentum and
energy (`lwa.expansion.observables`) become series in ε (`lwa.expansion.series`) in the cell's
units.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import comb
from typing import Any

import sympy as sp

from lwa.algebra.model import Model
from lwa.base.exact import InputError, integer
from lwa.base.frozen import known_quantity
from lwa.base.words import QUANTITIES, QuantityName
from lwa.cell import Cell, Parametric, exponent, k as symbol_k, read_cell
from lwa.expansion.observables import Observables, shares_model
from lwa.expansion.recursion import Recursion
from lwa.expansion.series import EpsilonSeries
from lwa.law import ContactLaw, power_exponent

EPSILON_NAMES = ("ε", "varepsilon")
"""Names that no symbol of a cell may have: ``k - 1`` is printed as ε, in LaTeX as varepsilon."""

LARGEST = 3_000_000
"""Most terms of the polynomials of an expansion: half a minute for equal beads (order 114)."""


@dataclass(frozen=True, repr=False)
class Expansion(Parametric):
    """The traveling wave of a chain as a series in ``ε = k - 1`` (see `expand`).

    The first contact has the peak force 1; lengths are in D (sites), masses and A in the cell's
    units. Behind a striker the two contacts of a dimer differ (their peaks by 0.5 % at
    m2/m1 of 0.99, by 5 % at 0.9): widths and their errors hold for the mean of the two.

    Attributes
    ----------
    cell, order, k : Cell, int, sympy.Expr
        The chain, the highest power of ε, and the exponent.
    """

    cell: Cell
    order: int
    k: sp.Expr = symbol_k

    def __post_init__(self) -> None:
        read_cell(self.cell)  # for its refusal of anything else
        self._set(order=integer(self.order, "order", 1), k=exponent(self.k))
        # The series' own parameter k - 1 has these names in text and in LaTeX.
        for symbol in {*self.cell.symbols, *self.k.free_symbols}:
            if symbol.name in EPSILON_NAMES:
                raise InputError(
                    f"{symbol} is the series' parameter k - 1: another name is wanted"
                )
        if not self.k.free_symbols and self.k <= 1:
            raise InputError(f"k is {self.k}: the expansion in k - 1 wants k > 1")
        terms = _terms(shares_model(self.cell, self.k), self.order)
        if terms > LARGEST:
            raise InputError(
                f"order is {self.order}: polynomials of some {terms:.0e} terms take hours; a lower "
                "order, or numbers for symbols, takes fewer"
            )

    def __repr__(self) -> str:
        # The speed is the quantity that takes least time.
        shown = f"order={self.order}, k={self.k}, c²: {self.c2.answer}"
        return f"Expansion({self.cell!r}, {shown})"

    @cached_property
    def _observables(self) -> Observables:
        """The quantities of the wave as polynomials."""
        return Observables(Recursion(shares_model(self.cell, self.k), self.order))

    @cached_property
    def numeric(self) -> bool:
        """True if the series can be summed: k, the masses and the stiffnesses are numbers."""
        # Lengths are in D: a spacing does not enter.
        values = sp.Tuple(*self.cell.masses, *self.cell.stiffnesses, self.k)
        return not values.free_symbols

    @cached_property
    def compliance(self) -> sp.Expr:
        """The mean ā of ``A_i^{-1/k}``."""
        return sp.Add(*self.cell.compliances(self.k)) / self.cell.size

    @cached_property
    def c2(self) -> EpsilonSeries:
        """The square c² of the speed in sites per unit of time."""
        return self._series("c2", self._sound, power=sp.S.Zero)

    def fwhm(
        self, quantity: QuantityName = "strain", contact: Any = 0
    ) -> EpsilonSeries:
        """Full width at half maximum.

        Parameters
        ----------
        quantity : {"strain", "force", "velocity"}
            The strain or force of a contact, or the velocity of the bead with the contact's number.
        contact : int
            Number of the contact in the cell. Contacts of unlike stiffness have unlike widths.

        Returns
        -------
        EpsilonSeries
            A length in D.
        """
        i = integer(contact, "contact", 0, self.cell.size - 1)
        known_quantity(quantity)  # refuses any other word
        # The Gaussian F = e^{-Z²/4}, Z = √(ε/I) ξ, is 1/2 at Z = 2√log 2.
        unit = 4 * sp.sqrt(self._observables.I * sp.log(2))
        return self._series(quantity, unit, power=-sp.S.Half, contact=i)

    @cached_property
    def momentum(self) -> EpsilonSeries:
        """Momentum ``Σ m v``, mean mass times c times the displacement behind the wave."""
        # ∫ e^{-Z²/4} dξ = 2√(πI/ε), times ā (M/P) c = 1/c.
        unit = 2 * sp.sqrt(sp.pi * self._observables.I / self._sound)
        return self._series("momentum", unit, power=-sp.S.Half)

    @cached_property
    def energy(self) -> EpsilonSeries:
        """Kinetic and elastic energy of the chain."""
        # Kinetic and elastic energy are equal at leading order: together ā ∫ F² dξ, with the
        # Gaussian F = e^{-Z²/4}, is ā √(2πI/ε).
        unit = self.compliance * sp.sqrt(2 * sp.pi * self._observables.I)
        return self._series("energy", unit, power=-sp.S.Half)

    @cached_property
    def effective_mass(self) -> EpsilonSeries:
        """The mass P²/(2E) of a particle with the wave's momentum P and energy E, at any force."""
        # The square of the unit of momentum over twice that of energy, 4πI/(c² ε) over
        # 2 ā √(2πI/ε), where c² ā is the number of beads in a cell over the mass of the cell
        unit = sp.sqrt(2 * sp.pi * self._observables.I)
        unit *= self.cell.mass / self.cell.size
        return self._series("effective_mass", unit, power=-sp.S.Half)

    @cached_property
    def _sound(self) -> sp.Expr:
        """The value of c², in sites, in the limit of k to 1."""
        # The stiffness of a site is 1/ā, its mean mass M/P.
        return self.cell.size / (self.cell.mass * self.compliance)

    def _series(
        self, quantity: str, unit: sp.Expr, power: sp.Expr, contact: int = 0
    ) -> EpsilonSeries:
        """The series ``unit · ε^power · Σ a_n ε^n`` of a quantity; only widths need a contact."""
        coefficients = self._observables.coefficients(quantity, contact)
        return EpsilonSeries(unit, power, coefficients, self.k, self.cell, quantity)

    def latex_rows(self) -> list[str]:
        """LaTeX of the series of c², the widths, momentum and energy."""
        widths = [self.fwhm(quantity) for quantity in QUANTITIES]
        rows = []
        for series in (self.c2, *widths, self.momentum, self.energy):
            rows += series.latex_rows()
        return rows


def expand(
    cell: Cell, order: Any = 4, *, k: Any = symbol_k, law: ContactLaw | None = None
) -> Expansion:
    """Expand the traveling wave of a chain in ``ε = k - 1``, from the lattice's equations.

    Parameters
    ----------
    cell : Cell
        The periodic cell; numbers give rational coefficients, symbols rational functions.
    order : int
        Highest power of ε relative to the leading term.
    k : number or symbol
        The exponent. Shares of strain of unlike contacts depend on it.
    law : Power, optional
        A power law in place of k; other laws have no ε.

    Returns
    -------
    Expansion

    Raises
    ------
    lwa.InputError
        For anything else, and for orders that take hours.

    Examples
    --------
    >>> from lwa import Cell
    >>> wave = expand(Cell([1]), 16)
    >>> wave.c2.coefficients[:3]
    (1, -1/2, 2/5)
    >>> wave.fwhm("force").at(1.5).value.__round__(6)  # the uniform Hertz chain, in D
    1.411928
    """
    why = "the expansion is one in k - 1 about the linear chain, and only a power law has a k"
    return Expansion(cell, order, power_exponent(law, cell, k, why))


def _terms(model: Model, order: int) -> int:
    """Estimate the number of terms of all polynomials of an expansion.

    Most are those of the derivatives of strain and force: the coefficient of t^n
    (`lwa.expansion.recursion`) has n of them, each with about 3n/4 powers of Z, and n runs to
    2·order: the sum of 3n²/4 is 2·order³. Each power has a polynomial of degree 3n in each of the
    R symbolic ratios of the cell. C(9·order + R, R) terms are reckoned for each, those of a total
    degree of 9·order, with which the estimate is near the counts. Counted: 1.06 million terms for
    equal beads to order 80 (estimated: 1.02), 1.4 million for unlike contacts to 16 (1.2). Only the
    fields themselves are kept: 11 MB at order 80.
    """
    ratios = len(model.masses.names) + len(model.contacts.names)
    # The order: any larger one is refused, and binomials of it take long.
    n = min(order, 10**6)
    return 2 * n**3 * comb(9 * n + ratios, ratios)
