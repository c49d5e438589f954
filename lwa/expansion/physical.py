"""The lattice's wave of a given peak force in the cell's own units, summed with error estimates.

The contact law has no scale of its own: at a peak force F on the first contact the speed is
F^{(k-1)/(2k)} times that at force 1, and widths, in sites, are the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from lwa.base.exact import InputError, positive, shorten
from lwa.base.frozen import Value
from lwa.base.quantities import known_extent
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import Expansion


@dataclass(frozen=True)
class ExpandedWave(Value):
    """An expansion's wave whose force on the first contact peaks at F.

    Raises `lwa.InputError` unless k, the cell with its spacing, and F > 0 are numbers.

    >>> from lwa import Cell, expand
    >>> wave = ExpandedWave(expand(Cell([1], spacing=2), 8, k="3/2"), 64)
    >>> round(wave.speed.value, 6), round(wave.fwhm("force").value, 6)
    (3.622063, 2.823856)
    """

    expansion: Expansion
    F: sp.Expr

    def __post_init__(self) -> None:
        object.__setattr__(self, "F", positive(self.F, "force"))
        for name, value in (("force", self.F), ("spacing", self.expansion.cell.spacing)):
            if not value.is_number:
                raise InputError(f"{name} is {shorten(value)}: a number is wanted")

    @property
    def speed(self) -> Resummed:
        """dx/dt; raises `lwa.InputError` where the series has no sum."""
        k, spacing = self.expansion.k, self.expansion.cell.spacing
        return _times(self.expansion.c.at(), float(spacing * self.F ** ((k - 1) / (2 * k))))

    def fwhm(self, quantity: str = "strain", extent: str = "length") -> Resummed:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time"."""
        known_extent(extent)
        width = _times(self.expansion.fwhm(quantity).at(), float(self.expansion.cell.spacing))
        if extent == "length":
            return width
        speed = self.speed
        value = width.value / speed.value
        error = value * (width.error / width.value + speed.error / speed.value)
        return replace(width, value=value, error=error)


def _times(found: Resummed, factor: float) -> Resummed:
    return replace(found, value=factor * found.value, error=factor * found.error)
