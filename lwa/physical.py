"""The wave of a given peak contact force, in space and time.

All contacts of a cell carry the same force at leading order, F = A_eff (D u_x)^k, so that the wave
whose contact force peaks at F has the peak strain B = (F/A_eff)^{1/k} / D and, with V² = f B^{k-1}
(`lwa.TravelingWave.speed_factor`) and dx/dt = V √(P k A_eff D^{k+1} / M), the speed

    dx/dt = D √(f P k / M) A_eff^{1/(2k)} F^{(k-1)/(2k)}.

Everything is in the units of the cell: in SI where the cell is (`lwa.Cell.of_spheres`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.cell import RESERVED, unmistakable
from lwa.compact import CompactWave
from lwa.exact import InputError, positive, shorten
from lwa.value import Value

EXTENTS = ("length", "time")
"""What a width is: the extent in space, or the time that it takes to pass."""


@dataclass(frozen=True)
class PhysicalWave(Value):
    """The compact wave whose contact force peaks at ``force``, a number or a symbol.

    Raises `lwa.InputError` unless the force is positive, and for a name that has a meaning in the
    wave already.

    >>> from lwa import Cell, canonical_wave
    >>> wave = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F")
    >>> wave.compression, wave.speed
    (F**(2/3)/A**(2/3), 2*sqrt(5)*A**(1/3)*D*F**(1/6)/(5*sqrt(m)))
    """

    wave: CompactWave
    force: sp.Expr

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", positive(self.force, "force"))
        unmistakable(list(self.force.free_symbols))
        taken = {s.name for s in (*self.wave.cell.symbols, *self.wave.k.free_symbols)}
        for name in sorted(s.name for s in self.force.free_symbols):
            if name in RESERVED or name in taken:
                meaning = RESERVED.get(name, "a property of the chain")
                raise InputError(f"force {name!r}: the name means {meaning} here")

    @cached_property
    def strain(self) -> sp.Expr:
        """B, the peak strain."""
        return self.compression / self.wave.cell.spacing

    @cached_property
    def compression(self) -> sp.Expr:
        """D B, the peak compression of a contact; of unequal ones, their mean (`compressions`)."""
        k = self.wave.k
        return (self.force / self.wave.cell.stiffness(k)) ** (1 / k)

    @cached_property
    def compressions(self) -> tuple[sp.Expr, ...]:
        """(F/A_i)^{1/k}, the peak compression of each contact of the cell."""
        return tuple((self.force / A) ** (1 / self.wave.k) for A in self.wave.cell.stiffnesses)

    @cached_property
    def speed(self) -> sp.Expr:
        """dx/dt = V τ/t."""
        wave, k = self.wave, self.wave.k
        factor = wave.speed_factor * wave.cell.size * k / wave.cell.mass
        powers = wave.cell.stiffness(k) ** (1 / (2 * k)) * self.force ** ((k - 1) / (2 * k))
        return wave.cell.spacing * sp.sqrt(factor) * powers

    @cached_property
    def bead_velocity(self) -> sp.Expr:
        """B dx/dt, the peak velocity u_t of the beads; in this theory all of a cell move alike."""
        return self.strain * self.speed

    def fwhm(self, quantity: str = "force", extent: str = "length") -> sp.Expr:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time".

        Raises `lwa.InputError` for any other.
        """
        if extent not in EXTENTS:
            raise InputError(f"extent is {shorten(extent)}: {' or '.join(EXTENTS)} is wanted")
        length = self.wave.fwhm(quantity)
        return length if extent == "length" else length / self.speed

    def at(self, **values: Any) -> PhysicalWave:
        """The same with numbers (or other symbols) for the named symbols, the force's among them.

        Raises what `lwa.TravelingWave.at` raises.
        """
        known = {s.name: s for s in self.force.free_symbols}
        new = {known[n]: positive(value, n) for n, value in values.items() if n in known}
        rest = {name: value for name, value in values.items() if name not in known}
        return PhysicalWave(self.wave.at(**rest), self.force.xreplace(new))
