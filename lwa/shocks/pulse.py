"""The solitary wave of equal beads with a given velocity of its beads.

A solitary wave of speed V whose slope ``u_x`` rises by B moves its beads at ``w = V B`` at most, so
that for the canonical wave, whose squared speed is Q(B) (`lwa.loaded.background`)::

    B² Q(B) = w².

A contact's strain is the mean of ``u_x`` over a site, ``u_x + D² u_xxx/24`` to the order of the
wave. With ``u_xxx`` at the peak from the wave's equation, ``I = D²/12``, it rises by::

    B - [F(p0+B) - F(p0) - V² B]/(2 F′(p0+B)).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.frozen import Value
from lwa.loaded.background import Background
from lwa.loaded.errors import steepness
from lwa.shocks.digits import WORKING
from lwa.shocks.simple import rising_root


@dataclass(frozen=True)
class Pulse(Value):
    """Solitary wave of equal beads with a given peak velocity of its beads.

    Without load under a power law results are in closed form, else numbers.

    Parameters
    ----------
    field : Background
        The chain on its static strain.
    velocity : Expr
        Largest ``du/dτ`` of a bead, a number or an expression.

    Raises
    ------
    InputError
        Unless the beads and contacts are equal.

    Examples
    --------
    >>> from lwa import Cell, Power
    >>> wave = Pulse(Background(Cell([1]), Power(2), 0), sp.Symbol("w", positive=True))
    >>> wave.rise, wave.contact_rise
    (3**(1/3)*w**(2/3), 11*3**(1/3)*w**(2/3)/12)
    """

    field: Background
    velocity: sp.Expr

    def __post_init__(self) -> None:
        if not self.field.cell.uniform:
            raise InputError(
                "the beads or contacts differ: the wave is known for equal beads only"
            )

    @cached_property
    def rise(self) -> sp.Expr:
        """Rise B of the slope ``u_x``."""
        w = self.velocity
        if self._bare:  # Q(B) = 2 B^{k-1}/(k (k+1))
            k = self.field.law.exponent
            parts = sp.expand_power_base(
                (k * (k + 1) * w**2 / 2) ** (1 / (k + 1)), force=True
            )
            return sp.powsimp(sp.powdenest(parts, force=True), force=True)
        x = sp.Dummy("x", positive=True)
        p0 = sp.N(self.field.p0, WORKING)
        # A power has no strain of its own: that of the load is the unit.
        unit = sp.sign(w) * (p0 if self.field.law.homogeneous else 1)
        square = self.field.on(p0).squared_speed(unit * x) * (unit * x) ** 2
        rising = square - sp.N(w, WORKING) ** 2
        spacing = self.field.cell.spacing
        if spacing in rising.free_symbols:
            raise InputError(
                f"{str(spacing)!r} has no value: this pulse is computed in numbers",
                spacing=1,
            )
        return unit * rising_root(rising, x, WORKING)

    @property
    def speed(self) -> sp.Expr:
        """Speed ``V = dx/dτ``."""
        return self.velocity / self.rise

    @property
    def steepness(self) -> float:
        """How much the law stiffens along the wave (`lwa.loaded.errors.steepness`)."""
        slope = self.field.force(self.field.p0 + self.rise, 1)
        return steepness(float(slope), float(self.speed**2))

    @cached_property
    def contact_rise(self) -> sp.Expr:
        """Rise of a contact's strain above the static strain at the peak of the wave."""
        field = self.field
        B = self.rise
        k = field.law.exponent
        if self._bare:  # F = B^k/k, V² = 2 B^{k-1}/(k (k+1))
            return B * (1 - (k - 1) / (2 * k * (k + 1)))
        bend = field.force(field.p0 + B) - field.force(field.p0) - self.velocity**2 / B
        return B - bend / (2 * field.force(field.p0 + B, 1))

    @property
    def _bare(self) -> bool:
        """True for a power law without load."""
        return self.field.law.homogeneous and bool(self.field.p0.is_zero)
