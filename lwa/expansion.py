"""The expansion of a chain's traveling waves in ε = k - 1, exact at every order.

Near k = 1 a wave is long, of width 1/√ε, and the long-wave theory is its leading order. What is
expanded are the lattice's own equations (`lwa.recursion`), not the theory's: for the chain of equal
beads the first order is the wave of Chatterjee, Phys. Rev. E 59, 5912 (1999). Here its fields are
read: speed, profile, widths, momentum and energy as series in ε, to be summed by
`lwa.approximants`, and the closed formulas for the chain of equal beads that follow from them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import methodcaller
from typing import Any

import sympy as sp
from flint import fmpq_mpoly

from lwa.approximants import EpsilonSeries
from lwa.bloch import Bloch
from lwa.cell import Cell, exponent
from lwa.cell import k as symbol_k
from lwa.coefficients import Coefficients
from lwa.exact import InputError, exact, shorten
from lwa.pulse import Series, by_degree, half_width, log_term, moment, root
from lwa.radiation import Radiation
from lwa.recursion import Recursion

QUANTITIES = ("strain", "force", "velocity")

MOST_ORDER = {0: 40, 1: 12, 2: 5, 3: 3, 4: 2, 5: 2, 6: 1, 7: 1}
"""Of ε, by the number of symbolic ratios in the cell: some twenty seconds at most."""


@dataclass(frozen=True)
class Expansion:
    """The traveling wave of a chain as a series in ε = k - 1 (see `expand`).

    Its first contact has the peak force 1; at a peak force F, c² is F^{(k-1)/k} times what stands
    here, the widths are the same. Lengths are in D (sites), A and the masses in the cell's units.
    """

    cell: Cell
    order: int
    k: sp.Expr = symbol_k

    @cached_property
    def _ring(self) -> Coefficients:
        return Coefficients(self.cell, self.k)

    @cached_property
    def _fields(self) -> Recursion:
        return Recursion(self._ring, 2 * self.order)

    @cached_property
    def numeric(self) -> bool:
        """Whether k > 1 and the cell are numbers, so that the series can be summed."""
        symbols = [m for m in (*self.cell.masses, *self.cell.stiffnesses) if m.free_symbols]
        return not symbols and not self.k.free_symbols and self.k > 1

    @cached_property
    def I(self) -> sp.Expr:
        """I of the linear chain's Ω² = κ² - I κ⁴ + …, over D²."""
        return self._over(self._fields.I, 0)

    @cached_property
    def compliance(self) -> sp.Expr:
        """ā, the mean of A_i^{-1/k}."""
        return sp.Add(*self.cell.compliances(self.k)) / self.cell.size

    @cached_property
    def c2(self) -> EpsilonSeries:
        """c², the square of the speed in sites per unit of time.

        >>> from lwa import Cell
        >>> expand(Cell([1]), 2).c2.coefficients
        (1, -1/2, 2/5)
        """
        sound = self.cell.size / (self.cell.mass * self.compliance)
        return self._series(sound, sp.S.Zero, self._fields.gamma, lambda wave: wave.c2)

    @cached_property
    def c(self) -> EpsilonSeries:
        """The speed in sites per unit of time.

        >>> from lwa import Cell
        >>> expand(Cell([1]), 2).c.pade("k", 1, 1)
        (17*k + 23)/(27*k + 13)
        """
        sound = sp.sqrt(self.cell.size / (self.cell.mass * self.compliance))
        speed = root(self._fields.gamma[: 2 * self.order + 1])
        return self._series(sound, sp.S.Zero, speed, lambda wave: wave.c)

    def log_force(self, contact: int = 0) -> dict[sp.Rational, sp.Expr]:
        """n → φ_n(X) of log F = Σ ε^n φ_n(X), X = √ε ξ, n = 0, 1/2, 1, …; zero ones are left out.

        ξ is counted from the peak of the first contact, of force 1, and is that of the contact's
        own cell: contact i stands i sites behind it.

        >>> from lwa import Cell
        >>> expand(Cell([1]), 1).log_force()
        {0: -3*X**2, 1: -3*X**4/10 + 3*X**2/5}
        """
        X = sp.Symbol("X")
        if type(contact) is not int or contact not in range(self.cell.size):
            last = self.cell.size - 1
            raise InputError(
                f"contact is {shorten(contact)}: an integer from 0 to {last} is wanted"
            )
        found: dict[sp.Rational, sp.Expr] = {sp.S.Zero: -(X**2) / (4 * self.I)}
        for n, q in enumerate(self._fields.log_force[contact]):
            if q:
                found[sp.Rational(n, 2)] = sp.Add(
                    *(self._over(c, (3 * n + d) // 2) * X**d for d, c in by_degree(q).items())
                )
        return found

    def profile(self, xi: Any, contact: int = 0) -> sp.Expr:
        """The force of a contact at ξ, exp Σ ε^n φ_n(√ε ξ) to the order ε^order, in D = 1.

        >>> from lwa import Cell
        >>> expand(Cell([1]), 1, k=2).profile("xi")
        exp(-3*xi**4/10 - 12*xi**2/5)
        """
        xi, epsilon = exact(xi, "xi"), self.k - 1
        X = sp.Symbol("X")
        terms = [
            epsilon**n * phi.subs(X, sp.sqrt(epsilon) * xi)
            for n, phi in self.log_force(contact).items()
        ]
        return sp.exp(sp.expand(sp.Add(*terms)))

    def fwhm(self, quantity: str = "strain") -> EpsilonSeries:
        """Full width at half maximum of a contact's strain or force, or the first bead's velocity.

        >>> from lwa import Cell
        >>> expand(Cell([1]), 1).fwhm("force").coefficients
        (1, 1/10 - log(2)/60)
        """
        return self._fwhm[quantity if quantity in QUANTITIES else _refuse(quantity)]

    @cached_property
    def _fwhm(self) -> dict[str, EpsilonSeries]:
        fields = self._fields
        log_slope: Series = []
        for _ in fields.slope[0]:
            log_slope.append(log_term(fields.slope[0], log_slope))
        logs = {
            "strain": fields.log_strain[0], "force": fields.log_first, "velocity": log_slope,
        }  # fmt: skip
        unit = 4 * sp.sqrt(self.I * sp.log(2))
        return {
            name: self._series(unit, -sp.S.Half, half_width(log), methodcaller("fwhm", name))
            for name, log in logs.items()
        }

    @cached_property
    def momentum(self) -> EpsilonSeries:
        """Σ m v over the chain, which is (M/P) c times the displacement that the wave leaves."""
        fields = self._fields
        displacement = [moment(row[0], 2) for row in fields.mean_strain]
        sound = root(fields.gamma[: len(displacement)])
        unit = 2 * sp.sqrt(sp.pi * self.I * self.cell.mass * self.compliance / self.cell.size)
        return self._series(
            unit, -sp.S.Half, _product(sound, displacement), lambda wave: wave.momentum
        )

    @cached_property
    def kinetic(self) -> EpsilonSeries:
        """The kinetic energy, by the virial theorem (k + 1)/(k + 3) of the energy."""
        return self._energy_series(self._energies[0], lambda wave: wave.kinetic)

    @cached_property
    def energy(self) -> EpsilonSeries:
        """Kinetic and elastic energy of the chain."""
        total = [a + b for a, b in zip(*self._energies, strict=True)]
        return self._energy_series(total, lambda wave: wave.energy)

    @cached_property
    def _energies(self) -> tuple[Series, Series]:
        """Kinetic and elastic, integrated, over ā √(2πI/ε)."""
        fields = self._fields
        size = len(fields.force[0])
        kinetic = [
            sum((mu * term for mu, term in zip(fields.mu, terms, strict=True)), fields.zero)
            for terms in zip(*(_product(s, s) for s in fields.slope), strict=True)
        ]
        elastic = [
            sum((c * term for c, term in zip(fields.c, terms, strict=True)), fields.zero)
            for terms in zip(*map(_product, fields.force, fields.strain), strict=True)
        ]
        share = [fields.zero] * size  # 1/(k + 1), per contact
        for n in range(0, size, 2):
            share[n] = (-fields.epsilon / 2) ** (n // 2) / (2 * fields.P)
        motion = [term / 2 for term in _product(fields.gamma[:size], kinetic)]
        return [moment(a, 1) for a in motion], [moment(b, 1) for b in _product(share, elastic)]

    def _energy_series(
        self, terms: Series, same: Callable[[Expansion], EpsilonSeries]
    ) -> EpsilonSeries:
        unit = self.compliance * sp.sqrt(2 * sp.pi * self.I)
        return self._series(unit, -sp.S.Half, terms, same)

    def _series(
        self,
        unit: sp.Expr,
        power: sp.Expr,
        terms: Series,
        same: Callable[[Expansion], EpsilonSeries],
    ) -> EpsilonSeries:
        """The even terms of a series in t, polynomials in Z² = log 2, as one in ε.

        ``same`` takes it from the chain of equal beads.
        """
        coefficients = []
        for n in range(self.order + 1):
            by_log = by_degree(terms[2 * n])
            coefficients.append(
                sp.Add(*(self._over(c, 3 * n) * sp.log(2) ** (d // 2) for d, c in by_log.items()))
            )
        if self._uniform is None:
            return EpsilonSeries(unit, power, tuple(coefficients))
        uniform = same(self._uniform).coefficients
        return EpsilonSeries(unit, power, tuple(coefficients), uniform, self._radiation)

    @cached_property
    def _uniform(self) -> Expansion | None:
        """The chain of equal beads; None for itself."""
        cell = self.cell
        if len({*cell.masses}) == len({*cell.stiffnesses}) == 1:
            return None
        return Expansion(Cell((1,)), self.order)

    @cached_property
    def _radiation(self) -> Radiation | None:
        """What the estimates of a chain of unlike beads add; None where the cell has symbols."""
        fields, ring = self._fields, self._ring
        if self.I.free_symbols:
            return None
        import numpy as np

        trace = [float(t.leading_coefficient()) for t in Bloch(ring).trace(fields.P)]
        trace[0] = 0.0  # 2 cos(Pκ) = 2 at κ = 0, where one root is 0
        optical = np.roots(trace[:0:-1])
        X = sp.Symbol("X")
        first = sp.Poly(self.log_force().get(sp.S.One, sp.S.Zero), X)
        I = float(self.I)
        return Radiation(
            contrast=(12 * I - 1) / 3,
            I=I,
            optical=float(np.min(optical.real)),
            lightest=fields.P * min(float(mu.leading_coefficient()) for mu in fields.mu),
            quadratic=float(first.coeff_monomial(X**2)),
            quartic=float(first.coeff_monomial(X**4)),
        )

    def _over(self, numerator: fmpq_mpoly, power: int) -> sp.Expr:
        """numerator / I^power, in the caller's symbols."""
        I = self._fields.I
        while power:
            quotient, remainder = divmod(numerator, I)
            if remainder:
                break
            numerator, power = quotient, power - 1
        below = self._expression(I) ** power if power else sp.S.One
        return self._expression(numerator) / below

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        terms: list[tuple[tuple[int, ...], Any]] = [
            (tuple(map(int, e[1:])), c) for e, c in polynomial.terms()
        ]
        return self._ring.expression(terms)


def expand(cell: Cell, order: int = 4, *, k: Any = symbol_k) -> Expansion:
    """The traveling wave of a chain to the order ε^order, ε = k - 1, from the lattice's equations.

    Parameters
    ----------
    cell : the periodic cell; numbers give rational coefficients, symbols rational functions.
    order : highest power of ε (relative to the leading one).
    k : exponent, by which unequal contacts share the strain; for others only sums want its value.

    Raises `lwa.InputError` for anything else, and for orders beyond what the algebra can do in
    some ten seconds.

    >>> from lwa import Cell
    >>> wave = expand(Cell([1]), 10)
    >>> wave.fwhm("force").at(1.5).value.__round__(6)  # the uniform Hertz chain, in D
    1.411928
    """
    if not isinstance(cell, Cell):
        raise InputError(f"cell is {shorten(cell)}: a Cell such as Cell([1, 2]) is wanted")
    if isinstance(order, bool) or not isinstance(order, int) or order < 1:
        raise InputError(f"order is {shorten(order)}: an integer from 1 on is wanted")
    k = exponent(k)
    if not k.free_symbols and k <= 1:
        raise InputError(f"k is {k}: the expansion in k - 1 wants k > 1")
    symbols = len(Coefficients(cell, k).names) - (0 if k.is_Rational else 1)
    if order > (most := MOST_ORDER.get(symbols, 0)):
        bound = f"at most {most} is affordable" if most else "no order is affordable"
        raise InputError(
            f"order is {order}: with {symbols} symbolic ratios in the cell {bound}; give numbers "
            "for the cell, or a lower order"
        )
    return Expansion(cell, order, k)


def _product(a: Sequence[fmpq_mpoly], b: Sequence[fmpq_mpoly]) -> Series:
    zero = 0 * b[0]
    return [sum((a[j] * b[n - j] for j in range(n + 1)), zero) for n in range(len(b))]


def _refuse(quantity: Any) -> str:
    raise InputError(f"quantity is {shorten(quantity)}: one of {', '.join(QUANTITIES)} is wanted")
