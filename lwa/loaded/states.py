"""The static states ahead of a wave and at its peak.

Under a power law, and in links in series whose laws are powers, compressions under a force are
closed forms. Under another law those of a cell are exact fractions of 35 digits, so that the
difference of nearly equal ones keeps its digits, and results are floats of 20 digits. Those of a
lattice are floats then: of 35 digits for links in series, else doubles.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import sympy as sp

from lwa.base.exact import InputError, evaluated, number, read_exact, real
from lwa.base.frozen import NoSolitaryWave
from lwa.cell import Cell, Parametric
from lwa.law import ContactLaw
from lwa.loaded.background import Background
from lwa.loaded.lattice import Lattice

_DIGITS = 20  # digits of results without a closed form: more than a double holds


@dataclass(frozen=True)
class States(Parametric):
    """The static states ahead of a wave and at its peak.

    Parameters
    ----------
    chain : Cell or Lattice
        The chain of a cell, or a lattice.
    law : ContactLaw or None
        The law of a cell's contacts; None for a lattice, whose links have their own.
    precompression, force : Expr
        Static force, and total force at the peak.
    exact_static_compression : Expr
        Mean compression D p0 ahead of the wave.
    exact_compression : Expr
        Rise D B of the mean compression at the peak.
    closed_form : bool
        False for compressions of a cell that are fractions of 35 digits: results become floats.
    """

    chain: Cell | Lattice
    law: Any
    precompression: sp.Expr
    force: sp.Expr
    exact_static_compression: sp.Expr
    exact_compression: sp.Expr
    closed_form: bool = True

    def __post_init__(self) -> None:
        # Called for its refusal of text, NaN and infinities
        real(self.precompression, "precompression")
        real(self.force, "force")
        real(self.exact_static_compression, "static compression")
        real(self.exact_compression, "compression")

    @classmethod
    def of_forces(
        cls, chain: Cell | Lattice, law: Any, load: sp.Expr, force: sp.Expr
    ) -> Self:
        """Return the states of a static force and of a total peak force."""
        if isinstance(chain, Cell):
            ahead = _compression(chain, law, load)
            rise = _compression(chain, law, force) - ahead
            # The last argument is `closed_form`: compressions under a power are closed forms.
            return cls(chain, law, load, force, ahead, rise, law.homogeneous)
        ahead = chain.equilibrium(load).strain * chain.spacing
        if chain.in_series:  # exact: no digits are lost in the difference
            rise = chain.equilibrium(force).strain * chain.spacing - ahead
        else:
            # As floats two nearly equal compressions, or forces, lose digits in their difference.
            # `Statics.rise` divides the difference of the exact forces by the mean slope F′.
            gap = number(force - load)
            rise = sp.Float(chain.statics.rise(float(ahead), float(force), gap))
        return cls(chain, law, load, force, ahead, rise)

    @classmethod
    def of_strains(cls, field: Background, B: sp.Expr) -> Self:
        """Return the states of a field's static strain and of a strain that is larger by B.

        Raises `lwa.NoSolitaryWave` for a peak at which no sound runs, as beyond a pole of the law.
        """
        law = field.law
        peak = field.p0 + B
        try:
            law.check_strain(peak, field.cell)
        except InputError as fault:
            raise NoSolitaryWave(str(fault)) from None
        A = field.cell.stiffness(law.exponent)
        D = field.cell.spacing
        return cls(
            chain=field.cell,
            law=law,
            precompression=A * law.at(D * field.p0),
            force=A * law.at(D * peak),
            exact_static_compression=D * field.p0,
            exact_compression=D * B,
        )

    @cached_property
    def lattice(self) -> Lattice:
        """The lattice, or the chain as a lattice."""
        if isinstance(self.chain, Lattice):
            return self.chain
        return Lattice.of_cell(self.chain, self.law)

    @cached_property
    def field(self) -> Background:
        """The long-wave field of the chain on the static strain; of a cell alone."""
        if isinstance(self.chain, Lattice):
            raise InputError("the field is that of a cell, and the chain is a lattice")
        p0 = self.exact_static_compression / self.chain.spacing
        return Background(self.chain, self.law, p0)

    @property
    def symbols(self) -> set[sp.Symbol]:
        """The symbols of the compressions, and of the law or the lattice."""
        found = self.chain.symbols if self.law is None else self.law.symbols
        compressions = self.exact_static_compression, self.exact_compression
        return {*found}.union(*(x.free_symbols for x in compressions))

    def written(self, value: sp.Expr) -> sp.Expr:
        """A result in closed form, or as a float of 20 digits."""
        return value if self.closed_form else evaluated(value, _DIGITS)

    @property
    def static_compression(self) -> sp.Expr:
        """The mean compression D p0 of the contacts under the load."""
        return self.written(self.exact_static_compression)

    @property
    def compression(self) -> sp.Expr:
        """The mean compression D B that the wave adds at its peak."""
        return self.written(self.exact_compression)

    @property
    def background(self) -> sp.Expr:
        """The static mean strain p0."""
        return self.static_compression / self.chain.spacing

    @property
    def strain(self) -> sp.Expr:
        """The rise B of the mean strain."""
        return self.compression / self.chain.spacing

    @cached_property
    def work(self) -> sp.Expr | None:
        """The elastic energy per particle that the peak adds; None without a closed form."""
        if isinstance(self.chain, Cell):
            energy = self.law.energy
            delta = self.law.delta
            ahead = self.exact_static_compression
            peak = ahead + self.exact_compression
            A = self.chain.stiffness(self.law.exponent)
            return A * (energy.subs(delta, peak) - energy.subs(delta, ahead))
        # The energy of another law by the force may be no closed form.
        powers = all(link.law.homogeneous for link in self.chain.links)
        if not (powers and self.chain.in_series):
            return None
        at_peak = self.chain.equilibrium(self.force)
        at_rest = self.chain.equilibrium(self.precompression)
        return self.chain.energy(at_peak) - self.chain.energy(at_rest)

    @cached_property
    def stiffness(self) -> sp.Expr | None:
        """The slope ``F′`` by the mean compression at rest; None without a closed form."""
        if isinstance(self.chain, Cell):
            A = self.chain.stiffness(self.law.exponent)
            return A * self.law.at(self.exact_static_compression, 1)
        if self.chain.in_series:
            return self.chain.stiffness(self.chain.equilibrium(self.precompression))
        return None


def _compression(cell: Cell, law: ContactLaw, force: sp.Expr) -> sp.Expr:
    """The mean compression of a cell's contacts, exact, or as a fraction of 35 digits."""
    if force.is_zero:
        return sp.S.Zero
    return read_exact(law.compression(cell, force), "compression")
