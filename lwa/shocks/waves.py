"""Waves on a background by the velocity of their beads: simple waves and the solitary wave.

Behind a wall that moves, long waves run one way, and of the Riemann invariants of
u_ττ = ∂_x F(u_x) one is the same everywhere: while the strain rises from p0 to p the beads gain
∫ c dp, c = √F′(p), in the units du/dτ of the wave equation.

A solitary wave of speed V whose slope u_x rises by B moves its beads at w = V B at most, so that
for the canonical wave (`lwa.loaded.background`)

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

import mpmath
import sympy as sp

from lwa.base.calculus import growing_root
from lwa.base.exact import InputError, demand_numbers, evaluated
from lwa.base.frozen import Value
from lwa.loaded.background import Background
from lwa.shocks.edges import SHOCK_DIGITS

_LONGEST = 600  # bits of exact powers; SymPy fails from 1024 on


def velocity(field: Background, p: sp.Expr) -> sp.Expr:
    """Velocity du/dτ that the beads gain while the strain rises from p0 to p, ∫ √F′ dp.

    In closed form for powers and where √F′ is an exponential, else an integral or its value.

    >>> from lwa import Cell, Power
    >>> velocity(Background(Cell([1]), Power(3), 0), sp.Symbol("p"))
    p**2/2
    """
    law, x = field.law, sp.Dummy("p", positive=True)
    if law.homogeneous:
        power = (law.exponent + 1) / 2
        return 2 * (p**power - field.p0**power) / (law.exponent + 1)
    c = sp.powdenest(sp.sqrt(field.force(x, 1)), force=True)
    if isinstance(c, sp.exp) or not c.has(x):
        return sp.integrate(c, (x, field.p0, p))
    # from 0 to p - p0, where no digits cancel
    gained = sp.Integral(c.subs(x, field.p0 + x), (x, 0, p - field.p0))
    return gained if gained.free_symbols else gained.evalf(SHOCK_DIGITS)


def strain(field: Background, gained: sp.Expr) -> sp.Expr:
    """The strain p at which the beads have gained the velocity ``gained`` > 0, du/dτ.

    Raises `lwa.InputError` for a law that does not reach it, and for symbols unless in a power law.
    """
    if field.law.homogeneous:
        power = (field.law.exponent + 1) / 2
        return sp.powdenest((field.p0**power + power * gained) ** (1 / power), force=True)
    x = sp.Dummy("x", positive=True)
    return field.p0 + _rising_root(velocity(field, field.p0 + x) - gained, x)


def _rising_root(rising: sp.Expr, x: sp.Symbol, lost: int = 0) -> sp.Expr:
    """The root of an expression that rises with x from a negative value at 0.

    lost : digits that cancel in the expression near the root; the root has as many to spare.
    """
    demand_numbers(rising.free_symbols - {x}, "numbers are wanted")
    with mpmath.workdps(SHOCK_DIGITS + 2 * lost + 5):
        root = growing_root(rising, x)
    if root is None:
        raise InputError("the law does not reach the strain that belongs to this velocity")
    return sp.Float(root, SHOCK_DIGITS + lost)


def tidy(value: sp.Expr) -> sp.Expr:
    """Combine powers, and evaluate the numeric factor of a result that is not in closed form."""
    if not value.has(sp.Float):
        return sp.powsimp(value)
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    return factor.n(SHOCK_DIGITS) * rest


def written(value: sp.Expr, k: sp.Expr, *strains: sp.Expr) -> sp.Expr:
    """Evaluate a number whose exact powers run to hundreds of digits, as those of k = 2.77."""
    numbers = [x for x in (k, *strains) if x.is_Rational]
    bits = sum(int(part).bit_length() for x in numbers for part in (x.p, x.q))
    terms = int(k.p) + int(k.q) if k.is_Rational else 1
    if value.free_symbols or k == 1 or bits * terms < _LONGEST:  # k is 1 unless the law is a power
        return value
    return evaluated(value, 3 * SHOCK_DIGITS)


@dataclass(frozen=True)
class Pulse(Value):
    """Solitary wave with a given peak velocity of its beads.

    field : the background. velocity : largest du/dτ of a bead, a number or an expression.

    Without load under a power law, and for Toda's law, results are in closed form, else numbers.

    Raises `lwa.InputError` unless the beads and contacts are equal.

    >>> from lwa import Cell, Power
    >>> wave = Pulse(Background(Cell([1]), Power(2), 0), sp.Symbol("w", positive=True))
    >>> wave.rise, wave.contact_rise
    (3**(1/3)*w**(2/3), 11*3**(1/3)*w**(2/3)/12)
    """

    field: Background
    velocity: sp.Expr

    def __post_init__(self) -> None:
        if not self.field.cell.uniform:
            raise InputError("the beads or contacts differ: the wave is known for equal beads only")

    @cached_property
    def rise(self) -> sp.Expr:
        """Rise B = w/V of the slope u_x."""
        field, w = self.field, self.velocity
        if self.toda:
            C = self._cosh
            return w * sp.acosh(C) / (field.sound_speed * sp.sqrt(C**2 - 1))
        if self._bare:  # W = B^{k+1}/(k(k+1))
            k = field.law.exponent
            parts = sp.expand_power_base((k * (k + 1) * w**2 / 2) ** (1 / (k + 1)), force=True)
            return sp.powsimp(sp.powdenest(parts, force=True), force=True)
        x, side, p0 = sp.Dummy("x", positive=True), sp.sign(w), field.p0
        demand_numbers(w.free_symbols | field.force(p0).free_symbols, "numbers are wanted")
        # The work W(p0+B) - W(p0) - F(p0) B = w²/2 of a small jump is a small difference.
        ratio = sp.N(1 + 2 * abs(field.force(p0, -1)) / sp.N(w, SHOCK_DIGITS) ** 2, 5)
        lost = int(sp.log(ratio, 10).n(5)) + 1
        w = evaluated(w, SHOCK_DIGITS + 2 * lost)
        work = field.force(p0 + side * x, -1) - field.force(p0, -1) - field.force(p0) * side * x
        return side * _rising_root(work - w**2 / 2, x, lost)

    @property
    def speed(self) -> sp.Expr:
        """Speed V = dx/dτ of the wave."""
        return self.velocity / self.rise

    @property
    def stiffening(self) -> float:
        """The measure ρ = 1 - V²/F′(p0+B) of how much the law stiffens along the wave; for numbers.

        It is 0 for Toda's law, for which the wave is exact.
        """
        stiffness = self.field.force(self.field.p0 + self.rise, 1)
        return 0.0 if self.toda else float(1 - self.speed**2 / stiffness)

    @cached_property
    def contact_rise(self) -> sp.Expr:
        """Rise of a contact's strain above the background p0 at the peak of the wave."""
        if self.toda:
            return 2 * sp.log(self._cosh) / self.toda
        field, B, k = self.field, self.rise, self.field.law.exponent
        if self._bare:  # F = B^k/k, V² = 2 B^{k-1}/(k(k+1))
            return B * (1 - (k - 1) / (2 * k * (k + 1)))
        bend = field.force(field.p0 + B) - field.force(field.p0) - self.velocity**2 / B
        return B - bend / (2 * field.force(field.p0 + B, 1))

    @property
    def _bare(self) -> bool:
        """True for a power law without load."""
        return self.field.law.homogeneous and bool(self.field.p0.is_zero)

    @cached_property
    def toda(self) -> sp.Expr:
        """Number a D of Toda's law (e^{aδ} - 1)/a, for which F″/F′ = a; 0 for other laws."""
        law = self.field.law
        a = sp.simplify(law.slope(2) / law.slope(1))
        return sp.S.Zero if a.has(law.delta) else a * self.field.cell.spacing

    @property
    def _cosh(self) -> sp.Expr:
        return 1 + self.toda * self.velocity / (2 * self.field.sound_speed)
