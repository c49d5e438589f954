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

Errors of a shock's theory were measured on 330 chains of equal beads, driven until their pulses
were steady: powers k = 0.3 … 7 with load, k = 1.05 … 10 without, hertz2, magnetic, polynomial,
lennard-jones, c₋/c₊ up to 200. With V the speed and B the rise of the leading pulse,

    ρ = 1 - V²/F′(p₊+B)

says how much the law stiffens (or softens, for falling strains) along the pulse: ρ → 0 for small
jumps, where every rule is exact, and ρ → 1 for hard spheres. Toda's law has no error up to
c₋ = 2 c₊ (Venakides, Deift & Oba, Comm. Pure Appl. Math. 44, 1171 (1991)).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import mpmath
import sympy as sp

from lwa.base.calculus import growing_root, real_function
from lwa.base.exact import InputError, demand_numbers
from lwa.base.frozen import Value
from lwa.loaded.background import Background

WORKING = 60
"""Digits of floats; a jump of 1e-15 loses 30 of them in the work of a pulse."""

DIGITS = 30
"""Digits of results that are floats."""

SHORT = 64
"""Largest numerator and denominator of numbers whose powers are kept exact."""

_PLACES = 128  # intervals on which F″ that is no polynomial is checked


def floats(*values: sp.Expr, constants: set[sp.Rational]) -> tuple[sp.Expr, ...]:
    """Floats of numbers, unless all numbers and the constants of their law are short fractions.

    Exact powers such as 0.392^2.091 pass through integers of thousands of digits, and so do those
    of symbols: `lwa.InputError` refuses symbols beside long fractions.
    """
    numbers = {x for x in values if x.is_Rational} | constants
    if all(max(abs(int(x.p)), int(x.q)) <= SHORT for x in numbers):
        return values
    free = set().union(*(x.free_symbols for x in values))
    demand_numbers(free, f"beside fractions above {SHORT} a front needs numbers")
    return tuple(sp.N(x, WORKING) if not x.is_zero else x for x in values)


def tidy(value: sp.Expr) -> sp.Expr:
    """Combine powers; a result with floats has `DIGITS` digits."""
    if not value.has(sp.Float):
        return sp.powsimp(value)
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    return factor.n(DIGITS) * rest


def demand_one_sign(field: Background, start: sp.Expr, end: sp.Expr) -> None:
    """Raise `lwa.InputError` unless F″ keeps its sign between two strains.

    If it does, the front between the strains is one shock or one rarefaction. With an inflection of
    F between them it is a kink or a compound wave (LeFloch, *Hyperbolic Systems of Conservation
    Laws*, 2002, ch. 2), which this theory does not have. F″ is checked exactly where it is a
    polynomial, else at 127 places. Powers pass, and so do laws and strains with symbols.
    """
    x = sp.Dummy("x", real=True)
    bend = field.force(x, 2)
    if field.law.homogeneous or (bend + start + end).free_symbols - {x}:
        return
    low, high = sorted((start, end))
    if bend.is_polynomial(x):
        roots = sp.Poly(bend, x).real_roots(multiple=False) if bend.has(x) else []
        found = [root for root, times in roots if times % 2 and low < root < high]
    else:
        curve = real_function(sp.lambdify(x, bend, "mpmath"))
        with mpmath.workdps(DIGITS):
            ends = (mpmath.mpf(sp.N(p, DIGITS)) for p in (low, high))
            places = mpmath.linspace(*ends, _PLACES + 1)[1:-1]
            signs = [mpmath.sign(curve(place)) for place in places]
        found = [
            b
            for b, (one, other) in zip(places[1:], pairwise(signs), strict=True)
            if one != other
        ]
    if found:
        raise InputError(
            f"F″ changes its sign at the strain {sp.N(found[0], 5)}, an inflection between "
            f"{sp.N(low, 5)} and {sp.N(high, 5)}: the wave is a kink or a compound one"
        )


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
    return gained if gained.free_symbols else gained.evalf(DIGITS)


def strain(field: Background, gained: sp.Expr) -> sp.Expr:
    """The strain p at which the beads have gained the velocity ``gained`` > 0, du/dτ.

    Raises `lwa.InputError` for a law that does not reach it, and for symbols unless in a power law.
    """
    if field.law.homogeneous:
        power = (field.law.exponent + 1) / 2
        return sp.powdenest(
            (field.p0**power + power * gained) ** (1 / power), force=True
        )
    x = sp.Dummy("x", positive=True)
    return field.p0 + _rising_root(velocity(field, field.p0 + x) - gained, x, DIGITS)


def _rising_root(rising: sp.Expr, x: sp.Symbol, digits: int) -> sp.Expr:
    """The root of an expression that rises with x from a negative value at 0."""
    demand_numbers(rising.free_symbols - {x}, "numbers are wanted")
    with mpmath.workdps(digits):
        root = growing_root(rising, x)
    if root is None:
        raise InputError(
            "the law does not reach the strain that belongs to this velocity"
        )
    return sp.Float(root, digits)


@dataclass(frozen=True)
class Pulse(Value):
    """Solitary wave of equal beads with a given peak velocity of its beads.

    field : the background. velocity : largest du/dτ of a bead, a number or an expression.

    Without load under a power law results are in closed form, else numbers.

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
            raise InputError(
                "the beads or contacts differ: the wave is known for equal beads only"
            )

    @cached_property
    def rise(self) -> sp.Expr:
        """Rise B = w/V of the slope u_x."""
        field, w = self.field, self.velocity
        if self._bare:  # W = B^{k+1}/(k(k+1))
            k = field.law.exponent
            parts = sp.expand_power_base(
                (k * (k + 1) * w**2 / 2) ** (1 / (k + 1)), force=True
            )
            return sp.powsimp(sp.powdenest(parts, force=True), force=True)
        x, side, p0 = sp.Dummy("x", positive=True), sp.sign(w), field.p0
        demand_numbers(
            w.free_symbols | field.force(p0).free_symbols, "numbers are wanted"
        )
        p0, w = sp.N(p0, WORKING), sp.N(w, WORKING)
        work = (
            field.force(p0 + side * x, -1)
            - field.force(p0, -1)
            - field.force(p0) * side * x
        )
        return side * _rising_root(work - w**2 / 2, x, WORKING)

    @property
    def speed(self) -> sp.Expr:
        """Speed V = dx/dτ of the wave."""
        return self.velocity / self.rise

    @property
    def stiffening(self) -> float:
        """The measure ρ = 1 - V²/F′(p0+B) of how much the law stiffens along the wave; a number."""
        return float(1 - self.speed**2 / self.field.force(self.field.p0 + self.rise, 1))

    @cached_property
    def contact_rise(self) -> sp.Expr:
        """Rise of a contact's strain above the background p0 at the peak of the wave."""
        field, B, k = self.field, self.rise, self.field.law.exponent
        if self._bare:  # F = B^k/k, V² = 2 B^{k-1}/(k(k+1))
            return B * (1 - (k - 1) / (2 * k * (k + 1)))
        bend = field.force(field.p0 + B) - field.force(field.p0) - self.velocity**2 / B
        return B - bend / (2 * field.force(field.p0 + B, 1))

    @property
    def _bare(self) -> bool:
        """True for a power law without load."""
        return self.field.law.homogeneous and bool(self.field.p0.is_zero)


# --- errors of a shock's theory ---

RESTING = 2.0
"""c₋/c₊ up to which the beads at the wall come to rest beside it (a theorem for Toda's law)."""


def speed_error(rho: float) -> float:
    """Relative error of the doubling rule's speed on the canonical wave."""
    return 0.01 * rho + 0.08 * rho**3


def rise_error(rho: float) -> float:
    """Error of the doubling rule's peak strain on the canonical wave, over the rise."""
    # the first term is the canonical wave's, the second the rule's own, 1.4 % for k → 1
    return 0.065 * rho**2 + min(0.015, rho / 4)


def leading_error(off: float, rho: float) -> float:
    """Relative error of El's leading edge, from which the doubling rule differs by ``off``."""
    return off + (1 + off) * speed_error(rho)


def trailing_error(off: float) -> float:
    """Error of El's trailing edge over c₋, by the same ``off``."""
    # measured 5 to 7 times the difference at the leading edge; 2 % is what the runs resolve
    return 0.02 + 8 * off
