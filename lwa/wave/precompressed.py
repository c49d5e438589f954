"""The wave of a given peak contact force in a chain under load, in space and time.

At leading order the static load F0 and the peak force F of a wave are the same in all contacts of a
cell, which under A F(δ) are at the mean compressions δ0 and δ1 with A F(δ) = F0 and F. The strain
rises from p0 = δ0/D by B = (δ1 - δ0)/D in the wave (`lwa.wave.background`). For equal spheres with
the speed of sound c0 the speed V of the wave is Nesterenko's,

    V²/c0² = (4/15) (3 + 2 ζ^{5/2} - 5 ζ) / (ζ - 1)²,    ζ = (F/F0)^{2/3}.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import evaluated, positive
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, known_extent
from lwa.cell import Cell, meant
from lwa.law import ContactLaw, for_cell, substituted
from lwa.wave.background import WIDTH_DIGITS, BackgroundWave, taken_names


@dataclass(frozen=True)
class PrecompressedWave(Value):
    """The wave whose contact force peaks at ``force`` in a chain with the load ``precompression``.

    Both forces are total ones, numbers or symbols in the units of the cell; the dynamic force is
    the difference of the two. A ``force`` below the load is that of a rarefaction wave. Under a law
    that is no power forces and chain must be numbers.

    Raises `lwa.InputError` unless both are positive, and `lwa.NoSolitaryWave` without a wave.

    >>> from lwa import Power
    >>> wave = PrecompressedWave(Cell(["m"]), Power(2), "F", "F0")
    >>> wave.sound_speed
    sqrt(2)*D*F0**(1/4)/sqrt(m)
    """

    cell: Cell
    law: ContactLaw
    force: sp.Expr
    precompression: sp.Expr

    def __post_init__(self) -> None:
        for_cell(self.law, self.cell)
        own = taken_names(self.cell, self.law)
        for name in ("force", "precompression"):
            value = positive(getattr(self, name), name)
            object.__setattr__(self, name, value)
            meant(value, name, taken=own)
        if self.force == self.precompression:
            raise NoSolitaryWave(
                f"force and precompression are both {self.force}: there is no wave"
            )

    def latex_rows(self) -> list[str]:
        rows = {"F_{0}": self.precompression, "F": self.force, "B": self.strain}
        return [*self.law.latex_rows(), *latex.rows(rows | {latex.SPEED: self.speed})]

    @cached_property
    def static_compression(self) -> sp.Expr:
        """The compression δ0 of a contact under the load; the mean of unequal contacts."""
        return self.law.compression(self.cell, self.precompression)

    @cached_property
    def compression(self) -> sp.Expr:
        """The peak compression δ1 - δ0 that the wave adds."""
        return self.law.compression(self.cell, self.force) - self.static_compression

    @cached_property
    def compressions(self) -> tuple[sp.Expr, ...]:
        """The peak compression that the wave adds, for each contact of the cell."""
        shares = self.cell.shares(self.law.exponent)
        return tuple(share * self.compression for share in shares)

    @cached_property
    def background(self) -> BackgroundWave:
        """The waves on the strain of this load."""
        return BackgroundWave(self.cell, self.law, self.static_compression / self.cell.spacing)

    @property
    def strain(self) -> sp.Expr:
        """The rise B of the strain."""
        return self.compression / self.cell.spacing

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed dx/dt."""
        return self.background.speed(self.strain) * self.background.time_scale

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed dx/dt of long small waves."""
        return sp.powdenest(self.background.sound_speed * self.background.time_scale)

    @property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity B dx/dt of the beads."""
        return self.strain * self.speed

    def fwhm(
        self, quantity: str = "force", extent: str = "length", digits: int = WIDTH_DIGITS
    ) -> sp.Expr:
        """Full width at half maximum of the rise of "strain", "force" or "velocity".

        ``extent`` is "length" or "time" (of passage). All of the chain must be numbers.
        """
        known_extent(extent)
        length = self.background.fwhm(self.strain, quantity, digits)
        if extent == "length":
            return length
        # In units of D, where D is a symbol: SymPy does not follow terms with symbols that cancel.
        speed = evaluated(self.background.in_unit(self.speed), digits)
        return length / (speed * self.background.unit)

    def at(self, **values: Any) -> PrecompressedWave:
        """The wave with numbers (or other symbols) for the named symbols.

        Raises `lwa.InputError` for a name that does not occur or a value that is no quantity.
        """
        own = (self.cell, self.law, self.force, self.precompression)
        return PrecompressedWave(*substituted(values, *own))
