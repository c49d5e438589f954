"""The two waves of a front: the simple wave behind it, and its leading pulse.

**Simple waves.** Behind a wall that moves, long waves run one way, and one of the Riemann
invariants of the equation ``u_ττ = ∂_x F(u_x)`` is the same everywhere: while the strain rises from
p0 to p the beads gain::

    ∫ c dp,    c = √F′(p),

in the units ``du/dτ`` of the wave equation.

**The leading pulse** is a solitary wave of equal beads, of which the velocity of the beads is
given. A wave of speed V whose slope ``u_x`` rises by B moves its beads at ``w = V B`` at most, so
that for the canonical wave, whose squared speed is Q(B) (`lwa.loaded.background`)::

    B² Q(B) = w².

A contact's strain is the mean of ``u_x`` over a site, ``u_x + D² u_xxx/24`` to the order of the
wave. With ``u_xxx`` at the peak from the wave's equation, ``I = D²/12``, it rises by::

    B - [F(p0+B) - F(p0) - V² B]/(2 F′(p0+B)).
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
"""Digits of floats in place of exact numbers that would be long."""

DIGITS = 30
"""Digits of results that are floats: a jump of 1e-15 of the strain loses 30 in a pulse's work."""

# Strains at which the sign of F″ is checked, in 128 equal steps; two inflections within one step
# are not seen
_PLACES = 129


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
        # Without the two ends, where F″ may be 0 or infinite
        for before, after in pairwise(mpmath.linspace(*ends, _PLACES)[1:-1]):
            if mpmath.sign(curve(before)) != mpmath.sign(curve(after)):
                raise InputError(
                    f"F″ changes its sign between the strains {mpmath.nstr(before, 4)} and "
                    f"{mpmath.nstr(after, 4)}, an inflection of F within the front: the wave is a "
                    "kink or a compound one"
                )


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
        B = sp.sign(w) * x
        if self.field.law.homogeneous:
            # A power has no strain of its own. The unit is the strain of the load, or that of a
            # wave without load, w^{2/(k+1)}, if it is larger. Then B is a power of x, in which the
            # squares below grow evenly; as functions of B they are flat near 0.
            exponent = 2 / (self.field.law.exponent + 1)
            bare = sp.N(abs(w) ** exponent, WORKING)
            B *= p0
            if bare > p0:
                B = sp.sign(w) * bare * x**exponent
        rising = self.field.on(p0).squared_speed(B) * B**2 - sp.N(w, WORKING) ** 2
        return B.subs(x, rising_root(self.field, rising, x, WORKING))

    @property
    def speed(self) -> sp.Expr:
        """Speed ``V = dx/dτ``."""
        return self.velocity / self.rise

    @property
    def rho(self) -> float:
        """The steepness Δ of the wave (`lwa.loaded.errors`) by its form ``ρ = 1 - e^{-Δ}``."""
        slope = self.field.force(self.field.p0 + self.rise, 1)
        return float(1 - self.speed**2 / slope)

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
