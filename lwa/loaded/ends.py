"""The static states ahead of a wave and at its peak, and the quadrature between the two.

A wave is given by the forces or by the strains of both states. Under a power law, and in links in
series whose laws are powers, compressions are closed forms. The compressions of another law under a
force are exact fractions of 35 digits, so that the difference of nearly equal ones keeps its
digits; results then are floats of 20 digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from lwa.base.arrays import Array, function_of
from lwa.base.exact import InputError, evaluated, number, read_exact
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.loaded.background import Background
from lwa.loaded.lattice import Lattice, Static
from lwa.loaded.quadrature import Quadrature

_DIGITS = 20  # of results that have no closed form: more than a double holds


@dataclass(frozen=True)
class Ends(Value):
    """The static states ahead of a wave and at its peak.

    chain, law : a cell and the law of its contacts, or a lattice and None.
    ahead, peak : static force and total peak force, or static strain and rise of the strain.
    by_force : True for forces.
    """

    chain: Cell | Lattice
    law: Any
    ahead: sp.Expr
    peak: sp.Expr
    by_force: bool = True

    @cached_property
    def lattice(self) -> Lattice:
        """The lattice, or the chain as one."""
        chain = self.chain
        return chain if isinstance(chain, Lattice) else Lattice.of_cell(chain, self.law)

    @cached_property
    def field(self) -> Background:
        """The long-wave field of the chain on the static strain; of a cell alone."""
        if isinstance(self.chain, Lattice):
            raise InputError("the field is that of a cell, and the chain is a lattice")
        p0 = self._ends[0] / self.chain.spacing if self.by_force else self.ahead
        return Background(self.chain, self.law, read_exact(p0, "background"))

    @property
    def _free(self) -> set[sp.Symbol]:
        free: set[sp.Symbol] = self.ahead.free_symbols | self.peak.free_symbols
        if not self.by_force:  # forces alone determine compressions, not strains
            free |= self.chain.spacing.free_symbols
        return (
            free.union(self.chain.symbols)
            if self.law is None
            else free | {*self.law.symbols}
        )

    @cached_property
    def _states(self) -> tuple[Static, Static]:
        """The static states of a lattice ahead of the wave and of its peak force."""
        return self.lattice.static(self.ahead), self.lattice.static(self.peak)

    @cached_property
    def _ends(self) -> tuple[sp.Expr, sp.Expr]:
        """The mean compression D p0 ahead of the wave, and its rise D B at the peak."""
        if not self.by_force:
            return self.chain.spacing * self.ahead, self.chain.spacing * self.peak
        if isinstance(self.chain, Cell):
            # exact, even those of 35 digits: their difference keeps its digits
            forces = (self.ahead, self.peak)
            found = (F and self.law.compression(self.chain, F) for F in forces)
            ahead, peak = (read_exact(x, "compression") for x in found)
            return ahead, peak - ahead
        ahead, peak = (state.strain * self.chain.spacing for state in self._states)
        if self.lattice.in_series:
            return ahead, peak - ahead
        rise = self.lattice.statics.rise(
            float(ahead), float(self.peak), number(self.peak - self.ahead)
        )
        return ahead, sp.Float(rise)

    def _written(self, value: sp.Expr) -> sp.Expr:
        """A result in closed form, else its float: the exact ends of other laws have 35 digits."""
        explicit = (
            isinstance(self.chain, Lattice) or self.law.homogeneous or not self.by_force
        )
        return value if explicit else evaluated(value, _DIGITS)

    @property
    def static_compression(self) -> sp.Expr:
        """The mean compression D p0 of the contacts under the load."""
        return self._written(self._ends[0])

    @property
    def compression(self) -> sp.Expr:
        """The mean compression D B that the wave adds at its peak."""
        return self._written(self._ends[1])

    @property
    def background(self) -> sp.Expr:
        """The static mean strain p0."""
        return (
            self.static_compression / self.chain.spacing
            if self.by_force
            else self.ahead
        )

    @property
    def strain(self) -> sp.Expr:
        """The rise B of the mean strain."""
        return self.compression / self.chain.spacing if self.by_force else self.peak

    @property
    def precompression(self) -> sp.Expr:
        """The static force."""
        return self.ahead if self.by_force else self._force(self.background)

    @property
    def force(self) -> sp.Expr:
        """The total force at the peak."""
        return (
            self.peak if self.by_force else self._force(self.background + self.strain)
        )

    def _force(self, p: sp.Expr) -> sp.Expr:
        """The force of the contacts of a cell at a mean strain."""
        return self.field.cell.stiffness(self.law.exponent) * self.law.at(
            self.chain.spacing * p
        )

    # --- in floats: mean compressions over a unit, lengths in spacings ---

    @cached_property
    def _quadrature(self) -> Quadrature:
        p0, B = self._ends
        if (
            self.law is not None and self.law.homogeneous
        ):  # of no length: the unit is the larger
            unit = p0 + B if (self.law.exponent - 1).is_positive else p0
            p0, B = p0 / unit, B / unit
        return Quadrature(self._samples, number(p0), number(B))

    def _samples(self, e: Array) -> tuple[Array, Array, Array]:
        """F′, F″ and J/F′ at mean compressions."""
        F1, F2, I = self._static(e)
        if not self.lattice.resonators:
            return F1, F2, I
        V2 = self._square / number(self.lattice.mass)
        return F1, F2, I + number(self.lattice.resonance_sum) * V2**2 / F1

    @cached_property
    def _static(self) -> Any:
        """The function of mean compressions that gives F′, F″ and I without resonators."""
        if self.law is None:
            return self.lattice.statics.samples
        x = sp.Symbol("delta", positive=True)
        F1, F2 = (function_of(x, self.law.at(x, n)) for n in (1, 2))
        I = number(self.field.I / self.field.cell.spacing**2)
        return lambda e: (F1(e), F2(e), np.full(e.shape, I))

    @cached_property
    def _square(self) -> float:
        """The square V̂² in the quadrature's units."""
        return Quadrature(
            self._static, self._quadrature.p0, self._quadrature.B
        ).square()

    def _slope(self, part: float) -> float:
        """F′ where the wave has risen by a part of B."""
        e = self._quadrature.p0 + part * self._quadrature.B
        return float(self._static(np.array([e]))[0][0])
