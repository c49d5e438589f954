"""The lattice's wave of a given peak force in the cell's units, summed with error estimates.

A power law has no scale of its own: the speed scales as F^{(k-1)/(2k)} with the peak force F of the
first contact, and widths in sites do not depend on F.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, positive, shorten
from lwa.base.frozen import Value
from lwa.base.quantities import known_extent
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import Expansion
from lwa.expansion.series import EpsilonSeries


@dataclass(frozen=True)
class ExpandedWave(Value):
    """The wave of an expansion whose force on the first contact peaks at F.

    Raises `lwa.InputError` unless k, the cell with its spacing, and F > 0 are numbers, and where a
    series has no sum.

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
        """Speed dx/dt."""
        speed = self._at_force(self.expansion.c, (self.expansion.k - 1) / 2)
        return speed * float(self.expansion.cell.spacing)

    def fwhm(self, quantity: str = "strain", extent: str = "length") -> Resummed:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time"."""
        known_extent(extent)
        width = self.expansion.fwhm(quantity).at() * float(self.expansion.cell.spacing)
        return width if extent == "length" else width / self.speed

    @property
    def momentum(self) -> Resummed:
        """Momentum Σ m v of the chain."""
        return self._at_force(self.expansion.momentum, (self.expansion.k + 1) / 2)

    @property
    def energy(self) -> Resummed:
        """Kinetic and elastic energy."""
        return self._at_force(self.expansion.energy, self.expansion.k + 1)

    def dissipation(self, kind: str) -> Resummed:
        """Energy lost per contact, divided by the damping constant; see `Expansion.dissipation`."""
        k = self.expansion.k
        power = (k + 3 if kind == "linear" else 3 * k + 1) / 2
        return self._at_force(self.expansion.dissipation(kind), power)

    def slowdown(self, kind: str) -> Resummed:
        """Slowing of the pulse by a weak damping γ: rate per site divided by γ, to first order.

        With V = dx/dt after n sites the rate is -dV/dn for "linear" damping and d(1/V)/dn for
        "kuwabara_kono". Both stay the same along the chain while the force falls.

        >>> from lwa import Cell, expand
        >>> wave = ExpandedWave(expand(Cell([1], spacing=1), 8, k="3/2"), 64)
        >>> round(wave.slowdown("linear").value, 5), round(wave.slowdown("kuwabara_kono").value, 5)
        (0.09607, 0.0835)
        """
        # E ∝ F^{(k+1)/k}, V ∝ F^{(k-1)/(2k)} and dE/dn = -γ D give
        # dV/dn = -(k-1)/(2(k+1)) γ D V/E.
        k, loss, E, V = self.expansion.k, self.dissipation(kind), self.energy, self.speed
        rate = loss / (E / V) if kind == "linear" else loss / E / V
        return rate * float((k - 1) / (2 * (k + 1)))

    def latex_rows(self) -> list[str]:
        """LaTeX of peak force, speed and the width of the force, without units."""
        width = r"\mathrm{FWHM}_{\mathrm{force}}"
        rows = [latex.row("F", self.F)]
        try:
            rows.append(rf"\mathrm{{d}}x/\mathrm{{d}}t = {self.speed.latex()}")
            rows.append(f"{width} = {self.fwhm('force').latex()}")
        except InputError as error:
            rows.append(rf"\text{{{error}}}")
        return rows

    def _at_force(self, series: EpsilonSeries, power: sp.Expr) -> Resummed:
        """Sum a quantity that scales as the compression to this power, at the peak force F."""
        return series.at() * float(self.F ** (power / self.expansion.k))


def wave_of_velocity(expansion: Expansion, velocity: sp.Expr) -> ExpandedWave:
    """The wave of equal beads that move at this velocity at most, proportional to F^{(k+1)/(2k)}.

    Raises `lwa.InputError` unless the chain and the velocity are numbers.
    """
    k = expansion.k
    demand_numbers({*velocity.free_symbols, *k.free_symbols}, "sums of series are numbers")
    ratio = float(velocity) / expansion.peak_velocity.at().value
    return ExpandedWave(expansion, ratio ** float(2 * k / (k + 1)))
