"""The leading pulse of a shock, and the errors of both rules for it, as measured.

The pulse is a solitary wave of equal beads, of which the velocity of the beads is given. A wave of
speed V whose slope ``u_x`` rises by B moves its beads at ``w = V B`` at most, so
that for the canonical wave, whose squared speed is Q(B) (`lwa.loaded.background`)::

    B² Q(B) = w².

A contact's strain is the mean of ``u_x`` over a site, ``u_x + D² u_xxx/24`` to the order of the
wave. With ``u_xxx`` at the peak from the wave's equation, ``I = D²/12``, it rises by::

    B - [F(p0+B) - F(p0) - V² B]/(2 F′(p0+B)).

Errors were measured on driven chains of equal beads, until their pulses were steady: powers with a
load, k from 0.3 to 7, and without, k from 1.05 to 10, and the laws hertz2, magnetic, polynomial and
lennard-jones, c₋/c₊ up to 200. `tests/test_errors.py` drives some of them again, random ones among
them. The measure is the pulse's steepness Δ, by its saturating form::

    ρ = 1 - e^{-Δ} = 1 - V²/F′(p₊+B),

which vanishes for small jumps, where every rule is exact, and tends to 1 for hard spheres.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import expm1

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.frozen import Value
from lwa.loaded.background import Background
from lwa.loaded.errors import steepness
from lwa.shocks.simple import WORKING, rising_root


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
            rise = (k * (k + 1) * w**2 / 2) ** (1 / (k + 1))
            # All quantities are positive, so that powers of products may be taken apart.
            parts = sp.expand_power_base(rise, force=True)
            return sp.powsimp(sp.powdenest(parts, force=True), force=True)
        x = sp.Dummy("x", positive=True)
        p0 = sp.N(self.field.p0, WORKING)
        # A power has no strain of its own: that of the load is the unit.
        unit = sp.sign(w) * (p0 if self.field.law.homogeneous else 1)
        B = unit * x
        rising = self.field.on(p0).squared_speed(B) * B**2 - sp.N(w, WORKING) ** 2
        return unit * rising_root(self.field, rising, x, WORKING)

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
        added = field.force(field.p0 + B) - field.force(field.p0)
        bend = added - self.velocity**2 / B  # V² B = w²/B
        return B - bend / (2 * field.force(field.p0 + B, 1))

    @property
    def _bare(self) -> bool:
        """True for a power law without load."""
        return self.field.law.homogeneous and bool(self.field.p0.is_zero)


def speed_error(delta: float) -> float:
    """Relative error of the doubling rule's speed on the canonical wave of a steepness."""
    rho = -expm1(-delta)
    # The second term is the canonical wave's: 5 % too fast for cubic contacts without load.
    return 0.01 * rho + 0.08 * rho**3


def rise_error(delta: float) -> float:
    """Error of the doubling rule's peak strain on the canonical wave, over the rise."""
    rho = -expm1(-delta)
    # The first term is the canonical wave's, the second the rule's own: the lattice's peak is 1.3 %
    # higher for powers without load, k from 1.02 to 1.1. For small jumps it is less.
    return 0.065 * rho**2 + 0.015


def leading_error(off: float, delta: float) -> float:
    """Relative error of El's leading edge, from which the doubling rule differs by ``off``."""
    # The doubling rule stands between: its own error is known.
    return off + (1 + off) * speed_error(delta)


def trailing_error(off: float) -> float:
    """Error of El's trailing edge over c₋, by the same ``off``."""
    # measured 5 to 7 times the difference at the leading edge; 2 % is what the runs resolve
    return 0.02 + 8 * off
