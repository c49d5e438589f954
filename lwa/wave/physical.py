"""The compact wave in space and time: a wave of a given peak force, in the units of the cell.

All contacts of a cell carry the same force at leading order. Without load ``F = A_eff (D u_x)^k``,
so that the wave whose contact force peaks at F has the peak strain ``B = (F/A_eff)^{1/k} / D``. A
contact has the force ``F cos^{mk}(βξ)``. A bead bears the mean force of its two contacts, half a
spacing before and behind the bead, which peaks at ``F cos^{mk}(βD/2)``. Results are in SI for
`lwa.Cell.of_spheres`. Waves under a load are those of `lwa.loaded.wave`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, get_args

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, brief, number, positive, power, shorten
from lwa.base.frozen import known_extent, known_quantity, strain_power
from lwa.base.words import ExtentName, QuantityName, one_of
from lwa.cell import Parametric
from lwa.law import Power
from lwa.wave.arch import Arch

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array

BearerName = Literal["contact", "bead"]
"""A bearer of a peak force."""

BEARERS: tuple[BearerName, ...] = get_args(BearerName)


@dataclass(frozen=True, repr=False)
class PhysicalWave(Parametric):
    """The compact wave of a given peak force in a chain without load, in the units of the cell.

    Parameters
    ----------
    wave : Arch
        Closed forms of the wave.
    force : number or str
        Peak force.
    of : {"contact", "bead"}
        The bearer of this force.

    Raises
    ------
    InputError
        Unless the force is positive, and for the force of a bead whose two contacts peak one after
        the other.

    Examples
    --------
    >>> from lwa import Cell, canonical_wave
    >>> wave = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F")
    >>> wave.compression, wave.speed
    (F**(2/3)/A**(2/3), 2*sqrt(5)*A**(1/3)*D*F**(1/6)/(5*sqrt(m)))
    >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(64)
    PhysicalWave(F=64, dx/dt=1.78885, FWHM of the force 1.49094)
    """

    wave: Arch
    force: sp.Expr
    of: BearerName = "contact"

    def __post_init__(self) -> None:
        self._set(force=positive(self.force, "force"))
        if one_of(self.of, BEARERS, "of") == "bead":
            self._bead_share  # noqa: B018 - a share that does not exist is refused here

    def __repr__(self) -> str:
        return (
            f"PhysicalWave(F={brief(self.force)}, dx/dt={brief(self.speed)}, "
            f"FWHM of the force {brief(self.fwhm())})"
        )

    def latex_rows(self) -> list[str]:
        rows = {
            "F": self.contact_force,
            "B": self.strain,
            latex.SPEED: self.speed,
            latex.fwhm("force"): self.fwhm("force"),
        }
        return latex.rows(rows)

    @cached_property
    def _bead_share(self) -> sp.Expr:
        """Ratio cos^{mk}(βD/2) of a bead's peak force to its contacts'.

        Here ``m = 2/(k-1)`` and ``β = (k-1)/(2 D √S)``, ``S = (G + H + I)/D²`` (`lwa.wave.arch`).
        """
        k = self.wave.k
        # βD/2. `Arch.beta` is the same number, but takes the roots of the numerator and of the
        # denominator of S apart: with symbols √S in one root is shorter.
        angle = (k - 1) / (4 * sp.sqrt(self.wave.coefficient_sum))
        exponent = k * self.wave.m
        # At ξ = 0 the mean of cos^{mk}(βξ ± angle) over both contacts has its maximum only where it
        # is concave: its second derivative has the sign of mk sin² angle - 1.
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
        return self.compression / self.wave.D

    @cached_property
    def compression(self) -> sp.Expr:
        """The peak compression D B of a contact; the mean over unlike contacts."""
        return Power(self.wave.k).compression(self.wave.cell, self.contact_force)

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed ``dx/dt = D √(f P k / M) A_eff^{1/(2k)} F^{(k-1)/(2k)}``, ``f = V²/B^{k-1}``.

        The cell has P beads, the mass M and the mean stiffness A_eff; F is the peak contact force.
        """
        # V² = f B^{k-1} times (τ/t)² = P k A_eff D^{k+1} / M, powers of each quantity collected
        cell = self.wave.cell
        k = self.wave.k
        square = self.wave.speed_factor * cell.size * k / cell.mass
        rate = power(square, sp.S.Half)
        hardness = power(cell.stiffness(k), 1 / (2 * k))
        growth = power(self.contact_force, (k - 1) / (2 * k))
        return cell.spacing * rate * hardness * growth

    @cached_property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity ``u_t = B dx/dt`` of the beads, the same for all beads of a cell."""
        return self.strain * self.speed

    @cached_property
    def momentum(self) -> sp.Expr:
        """The momentum ``Σ m u_t = M/(P D) · B dx/dt · ∫ cos^m(βξ) dξ`` of the chain.

        In the sum m is the mass of a bead, in the power 2/(k-1).
        """
        cell = self.wave.cell
        m = self.wave.m
        # P beads of the mass M fill the length P D.
        density = cell.mass / (cell.size * cell.spacing)
        # ∫ cos^m y dy over |y| < π/2 = √π Γ((m+1)/2) / Γ(m/2 + 1)
        ratio = sp.gamma((m + 1) / 2) / sp.gamma(m / 2 + 1)
        arch = sp.sqrt(sp.pi) * ratio
        return density * arch / self.wave.beta * self.bead_velocity

    def fwhm(
        self, quantity: QuantityName = "force", extent: ExtentName = "length"
    ) -> sp.Expr:
        """Full width at half maximum.

        Parameters
        ----------
        quantity : {"strain", "force", "velocity"}
            The quantity, "force" that of a contact.
        extent : {"length", "time"}
            A length, or the time of passage.

        Raises
        ------
        InputError
            For other words.
        """
        # A wave of constant shape passes a place in the time that it needs for its own length.
        length = self.wave.fwhm(quantity)
        if known_extent(extent) == "length":
            return length
        return length / self.speed

    def curve(
        self,
        t: ArrayLike,
        quantity: QuantityName = "force",
        of: BearerName | None = None,
    ) -> Array:
        """Course in time: values at the times t, with the peak at ``t = 0``.

        Parameters
        ----------
        t : array_like
            Times.
        quantity : {"force", "strain", "velocity"}
            The quantity; a velocity is always a bead's.
        of : {"contact", "bead"}, optional
            The bearer of force or strain, by default that of the given force. A bead's are the
            means over its two contacts.

        Raises
        ------
        InputError
            For other words, and where the wave or its force holds symbols.

        Examples
        --------
        >>> from lwa import Cell, canonical_wave
        >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(8).curve([-99, 0, 99])
        array([0., 8., 0.])
        """
        from lwa.base.arrays import finite  # start-up: it loads NumPy

        # At the time t the peak has come to x = t dx/dt: seen from there x = 0 lies at -t dx/dt.
        return self.along(-number(self.speed) * finite(t, "t"), quantity, of)

    def along(
        self,
        x: ArrayLike,
        quantity: QuantityName = "force",
        of: BearerName | None = None,
    ) -> Array:
        """Profile in space: values at the positions x when the peak is at 0; see `curve`."""
        import numpy as np  # start-up: `lwa wave` does without

        from lwa.base.arrays import finite

        peaks = {
            "strain": self.strain,
            "force": self.contact_force,
            "velocity": self.bead_velocity,
        }
        peak = number(peaks[known_quantity(quantity)])
        bearer = one_of(self.of if of is None else of, BEARERS, "of")
        xi = finite(x, "x")
        # The strain is B cos^m(βξ), m = 2/(k-1); the force scales as strain^k.
        k = number(self.wave.k)
        beta = number(self.wave.beta)
        exponent = 2 * strain_power(quantity, k) / (k - 1)

        def arch(x: Array) -> Array:
            # cos(βx) on the support, and 0 outside of it
            inside = np.maximum(np.pi / 2 - np.abs(beta * x), 0.0)
            return np.asarray(np.sin(inside) ** exponent)

        # Strain and force are those of contacts; a bead has a velocity of its own.
        if bearer == "bead" and quantity != "velocity":
            half = number(self.wave.D) / 2
            both = arch(xi - half) + arch(xi + half)
            return peak * both / 2
        return peak * arch(xi)
