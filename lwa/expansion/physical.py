"""The lattice's wave of a given peak force in the cell's units, summed with error estimates.

A power law has no scale of its own: the speed scales as F^{(k-1)/(2k)} with the peak force F of the
first contact, and widths in sites do not depend on F.
"""

from __future__ import annotations

from collections.abc import Callable
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
        """Speed dx/dt; raises `lwa.InputError` where the series has no sum."""
        k, spacing = self.expansion.k, self.expansion.cell.spacing
        return self.expansion.c.at() * float(spacing * self.F ** ((k - 1) / (2 * k)))

    def fwhm(self, quantity: str = "strain", extent: str = "length") -> Resummed:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time"."""
        known_extent(extent)
        width = self.expansion.fwhm(quantity).at() * float(self.expansion.cell.spacing)
        return width if extent == "length" else width / self.speed

    @property
    def momentum(self) -> Resummed:
        """Momentum Σ m v of the chain, proportional to F^{(k+1)/(2k)}."""
        return self._at_force(self.expansion.momentum, (self.expansion.k + 1) / 2)

    @property
    def energy(self) -> Resummed:
        """Kinetic and elastic energy, proportional to F^{(k+1)/k}."""
        return self._at_force(self.expansion.energy, self.expansion.k + 1)

    @property
    def effective_mass(self) -> Resummed:
        """Effective mass P²/(2E) of momentum P and energy E, independent of the force."""
        return self.expansion.effective_mass.at()

    def dissipation(self, kind: str) -> Resummed:
        """Energy lost per contact, divided by the damping constant; see `Expansion.dissipation`."""
        k = self.expansion.k
        power = (k + 3 if kind == "linear" else 3 * k + 1) / 2
        return self._at_force(self.expansion.dissipation(kind), power)

    def slowdown(self, kind: str) -> Resummed:
        """Slowing of the pulse by a weak damping γ: rate per site divided by γ, to first order.

        With V = dx/dt after n sites the rate is -dV/dn for "linear" damping and d(1/V)/dn for
        "kuwabara_kono". Both stay the same along the chain while the force falls: with the energy
        E ∝ F^{(k+1)/k} and the dissipation D, V ∝ F^{(k-1)/(2k)} gives
        dV/dn = -(k-1)/(2(k+1)) γ D V/E.

        Raises `lwa.InputError` as `Expansion.dissipation` does.

        >>> from lwa import Cell, expand
        >>> wave = ExpandedWave(expand(Cell([1], spacing=1), 8, k="3/2"), 64)
        >>> round(wave.slowdown("linear").value, 5), round(wave.slowdown("kuwabara_kono").value, 5)
        (0.09607, 0.0835)
        """
        k, loss, E, V = self.expansion.k, self.dissipation(kind), self.energy, self.speed
        rate = loss / (E / V) if kind == "linear" else loss / E / V
        return rate * float((k - 1) / (2 * (k + 1)))

    def latex_rows(self) -> list[str]:
        """LaTeX of peak force, speed and the width of the force, without units."""
        rows = [latex.row("F", self.F)]
        sums: dict[str, Callable[[], Resummed]] = {
            r"\mathrm{d}x/\mathrm{d}t": lambda: self.speed,
            r"\mathrm{FWHM}_{\mathrm{force}}": lambda: self.fwhm("force"),
        }
        for name, sum_up in sums.items():
            try:
                rows.append(f"{name} = {sum_up().latex()}")
            except InputError:
                rows.append(rf"{name} = \text{{no sum}}")
        return rows

    def _at_force(self, series: EpsilonSeries, power: sp.Expr) -> Resummed:
        """Sum a quantity that scales as the compression to this power, at the peak force F."""
        return series.at() * float(self.F ** (power / self.expansion.k))


def wave_of_velocity(expansion: Expansion, velocity: sp.Expr) -> ExpandedWave:
    """The wave of equal beads that move at this velocity at most, proportional to F^{(k+1)/(2k)}.

    Raises `lwa.InputError` unless the chain and the velocity are numbers.

    >>> from lwa import Cell, expand
    >>> wave = wave_of_velocity(expand(Cell([1], spacing=1), 8, k="3/2"), sp.Integer(1))
    >>> round(wave.expansion.peak_velocity.at().value * float(wave.F) ** (5 / 6), 9)
    1.0
    """
    k = expansion.k
    demand_numbers({*velocity.free_symbols, *k.free_symbols}, "sums of series are numbers")
    ratio = float(velocity) / expansion.peak_velocity.at().value
    return ExpandedWave(expansion, ratio ** float(2 * k / (k + 1)))
