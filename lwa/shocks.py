"""The Riemann problem of a chain: the shock or the rarefaction between two strains.

A wall that moves at v_p into a chain of strain p₊ presses it to p₋, v_p = ∫ c dp, c = √F′(p). The
acoustic branch is ω = c(p) f(κ), f ~ κ. Where sound is faster behind the front, r = c₋/c₊ > 1, the
front is a dispersive shock, a wave train between two edges (El, Chaos 15, 037103 (2005)):

    trailing   ∫₀^κ (1 - f′)/f dκ = ln r,       s₋ = c₋ f′(κ),
    leading    ∫₀^q (f̃′ - 1)/f̃ dq = ln r,       s₊ = c₊ f̃(q)/q,     f̃(q) = -i f(iq).

For equal beads s₋ = 2c₊ - c₋ and s₊ = c₊ √(r(r-1))/arcosh √r. The doubling rule takes the leading
pulse for the solitary wave whose beads move at 2 v_p at most: exact for Toda's law, for KdV and for
hard spheres, else a rule that was measured. For r < 1 a rarefaction c(p) = x/t joins c₋ and c₊.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath
import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, exact, one_of, positive, root, shorten
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.expansion.expand import expand
from lwa.expansion.physical import ExpandedWave
from lwa.expansion.strike import ORDER
from lwa.law import ContactLaw, for_cell, substituted
from lwa.linear.dispersion import Dispersion

RULES = ("dispersion", "doubling")
"""El's edge on the chain's own dispersion; the solitary wave of beads at 2 v_p."""

STEEPEST = sp.Rational(13, 10)
"""r up to which the trailing edge holds: 9 % off for Hertz contacts at p₋/p₊ = 3, r = 1.32."""

DIGITS = 20
"""Digits of roots and quadratures."""


@dataclass(frozen=True)
class Shock(Value):
    """The front between the strains ``behind`` and ``ahead``; speeds are dx/dt (see `shock`)."""

    cell: Cell
    law: ContactLaw
    behind: sp.Expr
    ahead: sp.Expr

    def _repr_latex_(self) -> str:
        rows = {"v_{p}": self.plateau, "c_{-}/c_{+}": self.ratio}
        return latex.display([latex.row(name, value) for name, value in rows.items()])

    @property
    def kind(self) -> str:
        """ "shock" where sound is faster behind the front, else "rarefaction"."""
        faster = self._gain.is_positive
        if faster is None:
            raise InputError("kind depends on symbols: give numbers")
        return "shock" if faster else "rarefaction"

    def sound(self, p: Any) -> sp.Expr:
        """Speed of sound dx/dt on the strain p; 0 without load under a power law."""
        p = exact(p, "p")
        if self.law.homogeneous and p.is_zero:
            return sp.S.Zero
        return root(self._force(p, 1)) * self._scale

    @cached_property
    def ratio(self) -> sp.Expr:
        """r = c₋/c₊, infinite without load."""
        if self.sound(self.ahead).is_zero:
            return sp.oo
        return sp.powsimp(root(self._force(self.behind, 1)) / root(self._force(self.ahead, 1)))

    @cached_property
    def plateau(self) -> sp.Expr:
        """v_p, the velocity of the beads behind the front.

        >>> from lwa import Cell, Power
        >>> shock(Cell([1], spacing=1), Power("3/2"), "p", 0).plateau
        2*sqrt(6)*p**(5/4)/5
        """
        return sp.powsimp(self._area * self._scale)

    @cached_property
    def trailing_speed(self) -> sp.Expr:
        """s₋ of El's edge, or c₋ of a rarefaction.

        Raises `lwa.InputError` for numbers beyond r = 1.3, where the edge fails.

        >>> from lwa import Cell, Power
        >>> shock(Cell([1], spacing=1), Power(3), 2, "9/5").trailing_speed
        8*sqrt(3)/5
        """
        if self._rarefies:
            return self.sound(self.behind)
        if self.ratio.is_number and self.ratio > STEEPEST:
            raise InputError(f"c₋/c₊ is {sp.N(self.ratio, 5)}: the trailing edge holds up to 1.3")
        if self.cell.size == 1:
            return 2 * self.sound(self.ahead) - self.sound(self.behind)
        f = self._edge(1)
        return self.sound(self.behind) / sp.Float(self._slowness(f**2), DIGITS)

    def leading_speed(self, rule: str = "doubling") -> sp.Expr:
        """s₊ by "doubling" or by El's "dispersion", or c₊ of a rarefaction.

        Doubling is for equal beads only: exact for Toda's law, within 0.5 % of the lattice for
        Hertz contacts up to p₋/p₊ = 14, 2.5 % off for k = 3 at r = 3. Dispersion holds for Hertz
        contacts within 1 % up to p₋/p₊ = 3, and within 2 % for two unequal beads.

        Raises `lwa.InputError` for the dispersion ahead of which no sound runs, and for the
        doubling of unequal beads, whose peaks were measured between 1.55 and 1.94 v_p.
        """
        one_of(rule, RULES, "rule")
        c = self.sound(self.ahead)
        if self._rarefies:
            return c
        if rule == "doubling":
            return self._equal_edge if self._toda else 2 * self.plateau / self.rise
        if c.is_zero:
            raise InputError("ahead is 0: no sound runs there, and dispersion gives no edge")
        if self.cell.size == 1:
            return self._equal_edge
        f = self._edge(-1)
        q = mpmath.acosh(mpmath.polyval(self._trace, -(f**2)) / 2) / self.cell.size
        return c * sp.Float(f / q, DIGITS)

    @cached_property
    def rise(self) -> sp.Expr:
        """B of the leading pulse by doubling.

        For Toda's law that of its soliton, 2 ln(2r - 1)/(a D), else that of the canonical wave,
        W(p₊+B) - W(p₊) - F(p₊) B = 2 v_p², which for Hertz contacts under load is 3 to 5 % too high
        (without load `wave` is better).
        """
        self._demand_equal()
        if self._toda:
            return 2 * sp.log(2 * self.ratio - 1) / (self._toda * self.cell.spacing)
        p, square = self.ahead, 2 * self._area**2
        if self.law.homogeneous and p.is_zero:
            k = self.law.exponent
            return sp.powdenest((k * (k + 1) * square) ** (1 / (k + 1)), force=True)
        v = sp.Dummy("v", positive=True)
        work = self._force(p + v, -1) - self._force(p, -1) - self._force(p, 0) * v - square
        return sp.Float(_root(_number(work, v), self.behind - p), DIGITS)

    @property
    def peak(self) -> sp.Expr:
        """Strain of the leading pulse by doubling, p₊ + B."""
        return self.ahead + self.rise

    @property
    def peak_force(self) -> sp.Expr:
        """Contact force A F at `peak`, in the units of the cell."""
        stiffness = self.cell.stiffness(self.law.exponent)
        return stiffness * self.law.at(self.cell.spacing * self.peak)

    @cached_property
    def wave(self) -> ExpandedWave:
        """The leading pulse by doubling as the lattice's own wave, from the series in k - 1.

        Raises `lwa.InputError` unless the chain ahead is without load and the law is a power.
        """
        if not (self.law.homogeneous and self.ahead.is_zero):
            raise InputError("the series in k - 1 are of a power law without load: ahead = 0")
        self._demand_equal()
        k = self.law.exponent
        expansion = expand(self.cell, ORDER, k=k)
        ratio = 2 * float(_mp(self.plateau)) / expansion.peak_velocity.at().value
        return ExpandedWave(expansion, ratio ** float(2 * k / (k + 1)))

    def fan(self, speed: Any) -> sp.Expr:
        """The strain at x/t = speed in a rarefaction under a power law, c(p) = x/t."""
        if self.kind == "shock" or not self.law.homogeneous:
            raise InputError(
                "a fan c(p) = x/t in closed form is that of a rarefaction of a power law"
            )
        return (positive(speed, "speed") / self._scale) ** (2 / (self.law.exponent - 1))

    def at(self, **values: Any) -> Shock:
        """The front for these values of the named symbols."""
        return Shock(*substituted(values, self.cell, self.law, self.behind, self.ahead))

    @cached_property
    def _gain(self) -> sp.Expr:
        """c₋ - c₊, simplified: only then is its sign known beside symbols such as D."""
        return sp.simplify(self.sound(self.behind) - self.sound(self.ahead))

    @property
    def _rarefies(self) -> bool:
        """Whether numbers say so; symbols stand for a shock."""
        return self._gain.is_negative is True

    @cached_property
    def _toda(self) -> sp.Expr:
        """a of the law (e^{aδ} - 1)/a, whose F″/F′ is constant; 0 for other laws."""
        a = sp.simplify(self.law.slope(2) / self.law.slope(1))
        return sp.S.Zero if a.has(self.law.delta) else a

    @property
    def _equal_edge(self) -> sp.Expr:
        """El's leading edge for equal beads, the speed of Toda's soliton of doubled velocity."""
        self._demand_equal()
        r = self.ratio
        return self.sound(self.ahead) * root(r * (r - 1)) / sp.acosh(root(r))

    @cached_property
    def _area(self) -> sp.Expr:
        """v_p in the units of the wave equation, ∫ √F′ dp."""
        return _impulse(self.law, self.cell, self.ahead, self.behind)

    @property
    def _scale(self) -> sp.Expr:
        return self.cell.time_scale(self.law.exponent)

    def _force(self, p: sp.Expr, n: int) -> sp.Expr:
        return self.law.of_strain(p, self.cell.spacing, n)

    def _demand_equal(self) -> None:
        if len({*self.cell.masses}) + len({*self.cell.stiffnesses}) > 2:
            raise InputError("the beads or contacts differ: doubling holds for equal beads only")

    def _edge(self, sign: int) -> Any:
        """f at an edge: ∫₀^f sign (dκ/df - 1)/f df = ln r, real (1) or imaginary (-1) f and κ."""
        target = mpmath.log(_mp(self.ratio))
        top = (
            Dispersion(self.cell, self.law.exponent).band_edges()[0, 1] if sign > 0 else mpmath.inf
        )

        def density(f: Any) -> Any:
            return sign * (self._slowness(sign * f * f) - 1) / f

        def excess(f: Any) -> Any:
            inside = f < top * (1 - 1e-9)
            return mpmath.quad(density, [0, f], method="gauss-legendre") - target if inside else 1

        found = _root(excess, 1)
        if not excess(found) < 1e-9:
            raise InputError(f"c₋/c₊ is {sp.N(self.ratio, 5)}: the trailing edge leaves the branch")
        return found

    @cached_property
    def _trace(self) -> list[Any]:
        """Coefficients of T(y), y = f², 2 cos Pκ = T, the highest first."""
        row = Dispersion(self.cell, self.law.exponent).trace
        return [_mp(row[m]) for m in sorted(row, reverse=True)]

    def _slowness(self, y: Any) -> Any:
        """dκ/df = -T′/(P √(R (1 - R y/4))), T = 2 - R y."""
        _, slope = mpmath.polyval(self._trace, y, derivative=True)
        R = -mpmath.polyval(self._trace[:-1], y)
        return -slope / (self.cell.size * mpmath.sqrt(R * (1 - R * y / 4)))


def shock(cell: Cell, law: ContactLaw, behind: Any, ahead: Any) -> Shock:
    """The front of a chain whose strain is ``behind`` on its left and ``ahead`` on its right.

    Parameters
    ----------
    cell, law : the chain.
    behind, ahead : strains, numbers or symbols; not negative under a power law.

    Results are exact for equal beads under a power law or Toda's, but for the doubling rule under
    load, and else numbers of 20 digits.

    Raises `lwa.InputError` for other strains, and where they are the same.

    >>> from lwa import Cell, Power
    >>> found = shock(Cell([1], spacing=1), Power("3/2"), 1, 0)
    >>> round(found.leading_speed() / found.sound(1), 4), round(found.rise.n(), 4)
    (0.8543, 1.8728)
    """
    law = for_cell(law, cell)
    strains = [exact(p, name) for p, name in ((behind, "behind"), (ahead, "ahead"))]
    for p, name in zip(strains, ("behind", "ahead"), strict=True):
        if law.homogeneous and p.is_negative:
            raise InputError(f"{name} is {shorten(p)}: contacts of a power law only push")
        if law.homogeneous and p.is_zero and (law.exponent - 1).is_nonpositive:
            raise InputError(f"{name} is 0 and k {law.exponent}: a front without load wants k > 1")
    if strains[0] == strains[1]:
        raise InputError(f"behind and ahead are both {shorten(strains[0])}: there is no front")
    return Shock(cell, law, strains[0], strains[1])


def piston(cell: Cell, law: ContactLaw, velocity: Any, ahead: Any = 0) -> Shock:
    """The front that a wall moving at this velocity drives into a chain of strain ``ahead``.

    In SI units where the cell is (`lwa.Cell.of_spheres`): velocity in m/s, forces in N.

    >>> from lwa import Cell, Power
    >>> piston(Cell([1], spacing=1), Power(3), "v").behind
    sqrt(2)*3**(3/4)*sqrt(v)/3
    """
    law, v = for_cell(law, cell), positive(velocity, "velocity")
    p, v = exact(ahead, "ahead"), v / cell.time_scale(law.exponent)
    if law.homogeneous:
        power = (law.exponent + 1) / 2
        return shock(cell, law, sp.powdenest((p**power + power * v) ** (1 / power), force=True), p)
    speed = _mp(v)
    end = sp.Dummy("p", positive=True)
    reached = _number(_impulse(law, cell, p, p + end), end)
    return Shock(cell, law, p + sp.Float(_root(lambda x: reached(x) - speed, v), DIGITS), p)


def _impulse(law: ContactLaw, cell: Cell, first: sp.Expr, last: sp.Expr) -> sp.Expr:
    """∫ √F′(p) dp, in closed form for powers and where √F′ is an exponential, else an integral."""
    k, p = law.exponent, sp.Dummy("p", positive=True)
    if law.homogeneous:
        return 2 * (last ** ((k + 1) / 2) - first ** ((k + 1) / 2)) / (k + 1)
    c = sp.powdenest(sp.sqrt(law.of_strain(p, cell.spacing, 1)), force=True)
    found = sp.Integral(c, (p, first, last))
    if isinstance(c, sp.exp) or not c.has(p):
        return found.doit()
    return found if found.free_symbols else found.evalf(DIGITS)


def _number(value: sp.Expr, symbol: sp.Symbol) -> Callable[[Any], Any]:
    """The value as a function of mpmath's numbers."""
    demand_numbers(value.free_symbols - {symbol}, "numbers are wanted")
    function: Callable[[Any], Any] = sp.lambdify(symbol, value, "mpmath")
    return function


def _mp(value: sp.Expr) -> Any:
    """The value in mpmath's numbers."""
    demand_numbers(value.free_symbols, "numbers are wanted")
    return mpmath.mpf(sp.N(value, DIGITS + 5))


def _root(rising: Callable[[Any], Any], guess: Any) -> Any:
    """The root of a function that rises from a negative value at 0."""
    with mpmath.workdps(DIGITS + 5):
        low, high = mpmath.mpf(0), _mp(sp.sympify(guess))
        while not rising(high) > 0:
            low, high = high, 2 * high
        for _ in range(4 * DIGITS):
            middle = (low + high) / 2
            low, high = (low, middle) if rising(middle) > 0 else (middle, high)
        return high
