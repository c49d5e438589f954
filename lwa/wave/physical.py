"""The compact wave of a given peak contact force in space and time.

All contacts of a cell carry the same force at leading order. Results are in the units of the cell:
in SI for `lwa.Cell.of_spheres`. Letters as in `lwa.wave.closed` and `lwa.cell`.

Without load F = A_eff (D u_x)^k, so that the wave whose contact force peaks at F has the peak
strain B = (F/A_eff)^{1/k} / D. A contact has the force F cos^{mk}(βξ), m = 2/(k-1),
ξ = x - (dx/dt) t. A bead bears the mean force of its two contacts, half a spacing before and behind
the bead, which peaks at F cos^{mk}(βD/2). Waves under a load are those of `lwa.loaded.wave`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, number, one_of, positive, power, shorten
from lwa.base.frozen import Value, known_extent, known_quantity, strain_power
from lwa.law import Power
from lwa.wave.closed import CompactWave

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array

BEARERS = ("contact", "bead")
"""Bearers of a peak force."""


@dataclass(frozen=True)
class PhysicalWave(Value):
    """The compact wave of a given peak force in a chain without load, in the units of the cell.

    wave : closed forms of the wave.
    force : peak force, a number or a symbol.
    of : "contact" or "bead", whose force peaks at ``force``.

    Raises `lwa.InputError` unless the force is positive, and for the force of a bead whose two
    contacts peak one after the other.

    >>> from lwa import Cell, canonical_wave
    >>> wave = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F")
    >>> wave.compression, wave.speed
    (F**(2/3)/A**(2/3), 2*sqrt(5)*A**(1/3)*D*F**(1/6)/(5*sqrt(m)))
    """

    wave: CompactWave
    force: sp.Expr
    of: str = "contact"

    def __post_init__(self) -> None:
        force = positive(self.force, "force")
        object.__setattr__(self, "force", force)
        if one_of(self.of, BEARERS, "of") == "bead":
            self._bead_share  # noqa: B018 - a share that does not exist is refused here

    def latex_rows(self) -> list[str]:
        return latex.rows(
            {"F": self.contact_force, "B": self.strain, latex.SPEED: self.speed}
        )

    @property
    def _law(self) -> Power:
        return Power(self.wave.k)

    @cached_property
    def _bead_share(self) -> sp.Expr:
        """Ratio cos^{mk}(βD/2) of a bead's peak force to its contacts'."""
        wave, k = self.wave, self.wave.k
        angle = (k - 1) / (4 * sp.sqrt(wave.coefficient_sum))  # βD/2
        exponent = 2 * k / (k - 1)
        # At ξ = 0 the mean of cos^e(βξ ± angle) has its maximum only where it is concave.
        if angle.is_number and not (
            angle < sp.pi / 2 and exponent * sp.sin(angle) ** 2 < 1
        ):
            raise InputError(
                f"k is {shorten(k)}: the two contacts of a bead peak one after the other, so that "
                "its force has no single peak; give that of a contact"
            )
        return sp.cos(angle) ** exponent

    @cached_property
    def contact_force(self) -> sp.Expr:
        """The peak force of the contacts."""
        return self.force if self.of == "contact" else self.force / self._bead_share

    @cached_property
    def bead_force(self) -> sp.Expr:
        """The peak force of a bead, the mean force of its two contacts."""
        return self.force if self.of == "bead" else self.force * self._bead_share

    @cached_property
    def strain(self) -> sp.Expr:
        """The peak strain B."""
        return self.compression / self.wave.cell.spacing

    @cached_property
    def compression(self) -> sp.Expr:
        """The peak compression D B of a contact; the mean over unlike contacts."""
        return self._law.compression(self.wave.cell, self.contact_force)

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed dx/dt = D √(f P k / M) A_eff^{1/(2k)} F^{(k-1)/(2k)}, f = V²/B^{k-1}.

        The cell has P beads, the mass M and the mean stiffness A_eff; F is the peak contact force.
        """
        # V² = f B^{k-1} times (τ/t)² = P k A_eff D^{k+1} / M, powers of each quantity collected.
        wave, k = self.wave, self.wave.k
        factor = wave.speed_factor * self.wave.cell.size * k / self.wave.cell.mass
        unit = (
            wave.D
            * power(factor, sp.S.Half)
            * power(self.wave.cell.stiffness(k), 1 / (2 * k))
        )
        return unit * power(self.contact_force, (k - 1) / (2 * k))

    @cached_property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity u_t = B dx/dt of the beads, the same for all beads of a cell."""
        return self.strain * self.speed

    @cached_property
    def momentum(self) -> sp.Expr:
        """The momentum Σ m u_t = M/(P D) · B dx/dt · ∫ cos^m(βξ) dξ of the chain."""
        wave, m = self.wave, self.wave.m
        density = self.wave.cell.mass / (self.wave.cell.size * wave.D)
        # ∫ cos^m y dy over |y| < π/2 = √π Γ((m+1)/2) / Γ(m/2 + 1)
        arch = (
            sp.sqrt(sp.pi) * sp.gamma((m + 1) / 2) / (wave.beta * sp.gamma(m / 2 + 1))
        )
        return density * arch * self.bead_velocity

    def fwhm(self, quantity: str = "force", extent: str = "length") -> sp.Expr:
        """Full width at half maximum of "strain", contact "force" or "velocity".

        extent : "length" or "time" (of passage). Raises `lwa.InputError` for other words.
        """
        length = self.wave.fwhm(quantity)
        return length if known_extent(extent) == "length" else length / self.speed

    def curve(self, t: ArrayLike, quantity: str = "force", of: str = "") -> Array:
        """Course in time: values of "force", "strain" or "velocity" at the times t, peak at t = 0.

        of : "contact" or "bead", by default the bearer of the prescribed force. A bead's force and
            strain are the means over its two contacts; a velocity is always a bead's.

        Raises `lwa.InputError` for other words, and where the wave or its force holds symbols.

        >>> from lwa import Cell, canonical_wave
        >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(8).curve([-99, 0, 99])
        array([0., 8., 0.])
        """
        from lwa.base.arrays import finite  # start-up: it loads NumPy

        return self.along(-number(self.speed) * finite(t, "t"), quantity, of)

    def along(self, x: ArrayLike, quantity: str = "force", of: str = "") -> Array:
        """Profile in space: values at the positions x when the peak is at x = 0; see `curve`."""
        import numpy as np  # start-up: `lwa wave` does without

        from lwa.base.arrays import finite

        wave, k, xi = self.wave, number(self.wave.k), finite(x, "x")
        peaks = {
            "strain": self.strain,
            "force": self.contact_force,
            "velocity": self.bead_velocity,
        }
        peak = number(peaks[known_quantity(quantity)])
        # The strain is B cos^m(βξ), m = 2/(k-1); the force scales as strain^k.
        beta, exponent = number(wave.beta), 2 * strain_power(quantity, k) / (k - 1)

        def arch(x: Array) -> Array:
            y = beta * x
            return np.asarray(
                np.where(np.abs(y) < np.pi / 2, np.cos(y), 0.0) ** exponent
            )

        if one_of(of or self.of, BEARERS, "of") == "bead" and quantity != "velocity":
            half = number(wave.D) / 2
            return np.asarray(peak * (arch(xi - half) + arch(xi + half)) / 2)
        return np.asarray(peak * arch(xi))

    def at(self, **values: Any) -> PhysicalWave:
        """Substitute values for symbols of the wave and the force, as `lwa.TravelingWave.at`."""
        symbols = {s.name: s for s in self.force.free_symbols}
        new = {
            symbols[n]: positive(value, n)
            for n, value in values.items()
            if n in symbols
        }
        rest = {name: value for name, value in values.items() if name not in symbols}
        return PhysicalWave(self.wave.at(**rest), self.force.xreplace(new), self.of)
