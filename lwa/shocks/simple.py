"""Simple waves: how the strain rises with the velocity of the beads in a long wave.

Behind a wall that moves, long waves run one way, and of the Riemann invariants of
u_ττ = ∂_x F(u_x) one is the same everywhere: while the strain rises from p0 to p the beads gain
∫ c dp, c = √F′(p), in the units du/dτ of the wave equation.
"""

from __future__ import annotations

import mpmath
import sympy as sp

from lwa.base.calculus import growing_root
from lwa.base.exact import InputError, demand_numbers
from lwa.shocks.edges import DIGITS
from lwa.wave.background import BackgroundWave


def velocity(field: BackgroundWave, p: sp.Expr) -> sp.Expr:
    """Velocity that the beads gain while the strain rises from p0 to p, ∫ √F′ dp.

    In closed form for powers and where √F′ is an exponential, else an integral or its value.

    >>> from lwa import background_wave, Cell, Power
    >>> velocity(background_wave(Cell([1]), 0, law=Power(3)), sp.Symbol("p"))
    p**2/2
    """
    law, x = field.law, sp.Dummy("p", positive=True)
    if law.homogeneous:
        power = (law.exponent + 1) / 2
        return (p**power - field.p0**power) / power
    c = sp.powdenest(sp.sqrt(field.force(x, 1)), force=True)
    found = sp.Integral(c, (x, field.p0, p))
    if isinstance(c, sp.exp) or not c.has(x):
        return found.doit()
    return found if found.free_symbols else found.evalf(DIGITS)


def strain(field: BackgroundWave, gained: sp.Expr) -> sp.Expr:
    """The strain p at which the beads have gained a positive velocity.

    Raises `lwa.InputError` for a law that does not reach it, and for symbols unless in a power law.
    """
    if field.law.homogeneous:
        power = (field.law.exponent + 1) / 2
        return sp.powdenest((field.p0**power + power * gained) ** (1 / power), force=True)
    x = sp.Dummy("x", positive=True)
    return field.p0 + rising_root(velocity(field, field.p0 + x) - gained, x)


def rising_root(rising: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """The root of an expression that rises with x from a negative value at 0."""
    demand_numbers(rising.free_symbols - {x}, "numbers are wanted")
    with mpmath.workdps(DIGITS + 5):
        found = growing_root(rising, x)
    if found is None:
        raise InputError("the law does not reach the strain that belongs to this velocity")
    return sp.Float(found, DIGITS)
