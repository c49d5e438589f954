"""Simple waves: velocities that beads gain where long waves run one way.

Behind a wall that moves, long waves run one way, and one of the Riemann invariants of the equation
``u_ττ = ∂_x F(u_x)`` is the same everywhere: while the strain rises from p0 to p the beads gain::

    ∫ c dp,    c = √F′(p),

in the units ``du/dτ`` of the wave equation.
"""

from __future__ import annotations

from itertools import pairwise

import mpmath
import sympy as sp

from lwa.base.calculus import growing_root, real_function
from lwa.base.exact import InputError, demand_numbers
from lwa.loaded.background import Background

WORKING = 60
"""Digits of floats in place of exact numbers that would be long."""

DIGITS = 30
"""Digits of results that are floats: a jump of 1e-15 of the strain loses 30 in a pulse's work."""

_PLACES = 129  # strains at which the sign of F″ is checked


def velocity(field: Background, p: sp.Expr) -> sp.Expr:
    """Velocity ``du/dτ`` that the beads gain while the strain rises from p0 to p.

    The velocity is in closed form for powers and where the speed of sound is an exponential, else
    an integral or its value.

    Parameters
    ----------
    field : Background
        The chain on the strain p0.
    p : Expr
        The strain behind.

    Examples
    --------
    >>> from lwa import Cell, Power
    >>> velocity(Background(Cell([1]), Power(3), 0), sp.Symbol("p"))
    p**2/2
    """
    if field.law.homogeneous:
        power = (field.law.exponent + 1) / 2  # c = p^{(k-1)/2}
        return (p**power - field.p0**power) / power
    x = sp.Dummy("p", positive=True)
    c = sp.powdenest(sp.sqrt(field.force(x, 1)), force=True)
    # SymPy is asked for no other antiderivative: the search may have no end.
    if isinstance(c, sp.exp) or not c.has(x):
        return sp.integrate(c, (x, field.p0, p))
    # from 0 to p - p0, where no digits cancel
    risen = c.subs(x, field.p0 + x)
    gained = sp.Integral(risen, (x, 0, p - field.p0))
    if gained.free_symbols:
        return gained
    return gained.evalf(DIGITS)


def strain(field: Background, gained: sp.Expr) -> sp.Expr:
    """The strain p at which the beads have gained a velocity ``du/dτ``.

    Parameters
    ----------
    field : Background
        The chain on the strain p0.
    gained : Expr
        The velocity, positive.

    Raises
    ------
    InputError
        For a law that does not reach the velocity, and for symbols unless in a power law.
    """
    if field.law.homogeneous:
        power = (field.law.exponent + 1) / 2
        raised = field.p0**power + power * gained
        return sp.powdenest(raised ** (1 / power), force=True)
    x = sp.Dummy("x", positive=True)
    rest = velocity(field, field.p0 + x) - gained
    return field.p0 + rising_root(field, rest, x, DIGITS)


def rising_root(
    field: Background, rising: sp.Expr, x: sp.Symbol, digits: int
) -> sp.Expr:
    """The root of an expression that rises with x from a negative value at 0.

    Raises
    ------
    InputError
        Without a root, and for other symbols, such as the spacing of the field.
    """
    spacing = field.cell.spacing
    if spacing in rising.free_symbols:
        raise InputError(
            f"spacing is {spacing}: here results are computed in numbers", spacing=1
        )
    demand_numbers(rising.free_symbols - {x}, "numbers are wanted under this law")
    with mpmath.workdps(digits):
        root = growing_root(rising, x)
    if root is None:
        raise InputError(
            "the law does not reach the strain that belongs to this velocity"
        )
    return sp.Float(root, digits)


def demand_one_sign(field: Background, start: sp.Expr, end: sp.Expr) -> None:
    """Raise `lwa.InputError` unless ``F″`` keeps its sign between two strains.

    If it does, the front between the strains is one shock or one rarefaction. With an inflection of
    F between them it is a kink or a compound wave (LeFloch, *Hyperbolic Systems of Conservation
    Laws*, 2002, ch. 2), which this theory does not have. Powers pass, and so do laws and strains
    with symbols.
    """
    x = sp.Dummy("x", real=True)
    bend = field.force(x, 2)
    if field.law.homogeneous or (bend + start + end).free_symbols - {x}:
        return
    curve = real_function(sp.lambdify(x, bend, "mpmath"))
    with mpmath.workdps(DIGITS):
        ends = [mpmath.mpf(sp.N(p, DIGITS)) for p in (start, end)]
        for before, after in pairwise(mpmath.linspace(*ends, _PLACES)[1:-1]):
            if mpmath.sign(curve(before)) != mpmath.sign(curve(after)):
                raise InputError(
                    f"F″ changes its sign between the strains {mpmath.nstr(before, 4)} and "
                    f"{mpmath.nstr(after, 4)}, an inflection of F within the front: the wave is a "
                    "kink or a compound one"
                )
