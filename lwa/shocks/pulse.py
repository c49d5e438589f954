"""Solitary waves on a background by the velocity of their beads, between equal beads.

A wave of speed V whose slope u_x rises by B moves its beads at w = V B at most, so that for the
canonical wave (`lwa.wave.background`)

    W(p0+B) - W(p0) - F(p0) B = w²/2.

A contact's strain is the mean of u_x over a site, u_x + D² u_xxx/24 to the order of the wave. With
u_xxx at the peak from the wave's equation, I = D²/12, it rises by

    B - [F(p0+B) - F(p0) - V² B]/(2 F′(p0+B)).

Toda's law F = (e^{aδ} - 1)/a has its soliton (Phys. Rep. 18, 1 (1975)): with c0 the speed of sound,

    cosh κ = 1 + a D w/(2 c0),     V = c0 sinh κ/κ,     strain of a contact 2 ln(cosh κ)/(a D).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from lwa.base.exact import InputError, root
from lwa.base.frozen import Value
from lwa.shocks.edges import DIGITS
from lwa.shocks.simple import rising_root
from lwa.wave.background import BackgroundWave


@dataclass(frozen=True)
class Pulse(Value):
    """Solitary wave whose beads move at most with a given velocity.

    field : the background. velocity : largest du/dτ of a bead, a number or an expression.

    Without load under a power law, and for Toda's law, results are in closed form, else numbers.

    Raises `lwa.InputError` unless the beads and contacts are equal.

    >>> from lwa import background_wave, Cell, Power
    >>> wave = Pulse(background_wave(Cell([1]), 0, law=Power(2)), sp.Symbol("w", positive=True))
    >>> wave.rise, wave.contact_rise
    (3**(1/3)*w**(2/3), 11*3**(1/3)*w**(2/3)/12)
    """

    field: BackgroundWave
    velocity: sp.Expr

    def __post_init__(self) -> None:
        cell = self.field.cell
        if len({*cell.masses}) + len({*cell.stiffnesses}) > 2:
            raise InputError("the beads or contacts differ: the wave is known for equal beads only")

    @cached_property
    def rise(self) -> sp.Expr:
        """Rise B = w/V of the slope u_x."""
        field, w = self.field, self.velocity
        if self._toda:
            C = self._cosh
            return w * sp.acosh(C) / (field.sound_speed * root(C**2 - 1))
        if field.law.homogeneous and field.p0.is_zero:
            k = field.law.exponent
            return sp.powdenest((k * (k + 1) * w**2 / 2) ** (1 / (k + 1)), force=True)
        x, side, p0 = sp.Dummy("x", positive=True), sp.sign(w), field.p0
        work = field.force(p0 + side * x, -1) - field.force(p0, -1) - field.force(p0) * side * x
        return side * rising_root(work - w**2 / 2, x)

    @property
    def speed(self) -> sp.Expr:
        """Speed V = dx/dτ of the wave."""
        return _digits(self.velocity / self.rise)

    @cached_property
    def contact_rise(self) -> sp.Expr:
        """Strain of a contact at the peak of the wave, less p0."""
        if self._toda:
            return 2 * sp.log(self._cosh) / self._toda
        field, B, k = self.field, self.rise, self.field.law.exponent
        if field.law.homogeneous and field.p0.is_zero:  # F = B^k/k, V² = 2 B^{k-1}/(k(k+1))
            return B * (1 - (k - 1) / (2 * k * (k + 1)))
        bend = field.force(field.p0 + B) - field.force(field.p0) - self.velocity**2 / B
        return _digits(B - bend / (2 * field.force(field.p0 + B, 1)))

    @cached_property
    def _toda(self) -> sp.Expr:
        """Number a D of Toda's law (e^{aδ} - 1)/a, for which F″/F′ = a; 0 for other laws."""
        law = self.field.law
        a = sp.simplify(law.slope(2) / law.slope(1))
        return sp.S.Zero if a.has(law.delta) else a * self.field.cell.spacing

    @property
    def _cosh(self) -> sp.Expr:
        return 1 + self._toda * self.velocity / (2 * self.field.sound_speed)


def _digits(value: sp.Expr) -> sp.Expr:
    """Evaluate an expression of numbers that holds a root found by `rising_root`."""
    return value.n(DIGITS) if value.has(sp.Float) and value.is_number else value
