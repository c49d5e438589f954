"""Speeds of the two edges of a dispersive shock, from the acoustic branch of a chain.

Let r be the speed of sound behind the front divided by that ahead, κ the wavenumber, f(κ) the
frequency on the acoustic branch divided by the speed of sound, f ~ κ for small κ, and
f̃(q) = -i f(iq). El's conditions (Chaos 15, 037103 (2005)) are

    trailing edge   ∫₀^κ (1 - f′)/f dκ = ln r,      speed f′(κ) in units of sound behind,
    leading edge    ∫₀^q (f̃′ - 1)/f̃ dq = ln r,      speed f̃(q)/q in units of sound ahead.

For equal beads f = 2 sin κ/2 makes the integrals -2 ln cos κ/4 and 2 ln cosh q/4, so that the
speeds are 2/r - 1 and √(r(r-1))/arcosh √r. For other cells the dispersion relation 2 cos Pκ = T(f²)
gives dκ/df, and the integral of the leading edge is computed by quadrature. The trailing edge of
unequal beads is not that of the lattice.
"""

from __future__ import annotations

from typing import Any

import mpmath
import sympy as sp

from lwa.base.exact import InputError, demand_numbers, evaluated
from lwa.cell import Cell
from lwa.linear.dispersion import Dispersion

SHOCK_DIGITS = 20
"""Digits of speeds and strains that are not in closed form."""

# r up to which the trailing edge is given; against the lattice it is 3 % too slow for Hertz
# contacts at p₋/p₊ = 2, r = 1.19, and 9 % at p₋/p₊ = 3, r = 1.32
STEEPEST = sp.Rational(13, 10)


def trailing(cell: Cell, r: sp.Expr) -> sp.Expr:
    """Speed of the trailing edge divided by the speed of sound behind the front, for equal beads.

    Raises `lwa.InputError` for unequal beads, where the edge fails (by a quarter at m2/m1 = ½),
    without sound ahead, r = ∞, and for numbers beyond r = 1.3.
    """
    _demand_sound(r)
    if not cell.uniform:
        raise InputError("the beads or contacts differ: the trailing edge is known for equal beads")
    if r.is_number and r > STEEPEST:
        raise InputError(f"c₋/c₊ is {sp.N(r, 5)}: the trailing edge holds up to 1.3")
    return 2 / r - 1


def leading(chain: Dispersion, r: sp.Expr) -> sp.Expr:
    """Speed of the leading edge divided by the speed of sound ahead of the front.

    Raises `lwa.InputError` without sound ahead, r = ∞, and for symbols in unequal beads.
    """
    _demand_sound(r)
    if chain.cell.uniform:
        return sp.sqrt(r * (r - 1)) / sp.acosh(sp.sqrt(r))
    demand_numbers((r + chain.I).free_symbols, "the edge of unequal beads wants numbers")
    with mpmath.workdps(SHOCK_DIGITS + 10):
        f = _edge(chain, r)
        q = mpmath.acosh(mpmath.polyval(_trace(chain), -(f**2)) / 2) / chain.cell.size
        return sp.Float(f / q, SHOCK_DIGITS)


def _demand_sound(r: sp.Expr) -> None:
    if r.is_infinite:
        raise InputError("ahead is 0: no sound runs there, and dispersion gives no edge")


def _edge(chain: Dispersion, r: sp.Expr) -> Any:
    """Return the imaginary frequency f at the leading edge.

    El's condition ∫₀^f (1 - dκ/df)/f df = ln r is solved by Newton's method from the root for small
    r - 1, where dκ/df - 1 ≈ -(3/2) I f². The method runs in s, f = sinh s, as the integral grows
    like ln f: in f itself it fails where r ≫ 1.
    """
    trace, target = _trace(chain), mpmath.log(_number(r))

    def density(s: Any) -> Any:
        return (1 - _slowness(trace, -(mpmath.sinh(s) ** 2))) / mpmath.tanh(s)

    def excess(s: Any) -> Any:
        return mpmath.quad(density, mpmath.linspace(0, s, 2 + int(s / 8))) - target

    start = mpmath.asinh(mpmath.sqrt(4 * target / (3 * _number(chain.I))))
    close = mpmath.mpf(10) ** (-2 * SHOCK_DIGITS)
    return mpmath.sinh(mpmath.findroot(excess, start, solver="newton", df=density, tol=close))


def _trace(chain: Dispersion) -> list[Any]:
    """Coefficients of the polynomial T(y), y = f², the highest first."""
    return [_number(chain.trace[m]) for m in sorted(chain.trace, reverse=True)]


def _number(value: sp.Expr) -> Any:
    """An exact number in mpmath, with ten digits to spare."""
    return mpmath.mpf(evaluated(value, SHOCK_DIGITS + 10))


def _slowness(trace: list[Any], y: Any) -> Any:
    """Derivative dκ/df = -T′/(P √(R (1 - R y/4))), where T = 2 - R y."""
    _, slope = mpmath.polyval(trace, y, derivative=True)
    R = -mpmath.polyval(trace[:-1], y)
    return -slope / ((len(trace) - 1) * mpmath.sqrt(R * (1 - R * y / 4)))
