"""Waves on a background: a chain under load, of any cell and any law.

In the canonical field u_ττ = ∂_x [F(u_x) + I (F′ u_xxx + ½ F″ u_xx²)], F the force in the units of
`lwa.equation.pde` (p^k/k for a power) and W′ = F. Its wave v on a strain p0,
u_x = p0 + v(ξ), ξ = x - V τ, obeys (Nesterenko, *Dynamics of Heterogeneous
Materials*, 2001, ch. 1, for equal spheres)

    I F′(p0 + v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,

so that V² = Q(B) for the wave that rises by B. It exists where Q(v) < Q(B) for all v between 0 and
B and F′ > 0 there; with v = B / cosh²θ its profile is the quadrature of a function without
singularities, dξ/dθ = 2 √(I F′ (B - v) / (B (Q(B) - Q(v)))).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import mpmath
import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, exact, integer, real, root, shorten
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, known
from lwa.cell import RESERVED, Cell, meant, substitution
from lwa.law import Law, Power, for_cell
from lwa.linear.dispersion import Dispersion
from lwa.wave.kdv import RISE, KdV
from lwa.wave.profile import Function, Profile

if TYPE_CHECKING:
    from lwa.wave.quadrature import NumericBackground

DIGITS = 15
"""Of a width or a profile, where no number of digits is given."""

MOST_DIGITS = 200

_LOOKS = 64
"""Places between 0 and B at which existence is decided for a law that is no power."""


def taken_names(cell: Cell, law: Power | Law) -> dict[str, str]:
    """Names that no load may have, and what each means: those of chain, law and wave."""
    chain = dict.fromkeys((s.name for s in cell.symbols), "a property of the cell")
    return chain | dict.fromkeys((s.name for s in law.symbols), "a symbol of the law") | RESERVED


@dataclass(frozen=True, repr=False)
class BackgroundWave(Value):
    """The waves of a chain's canonical field on the strain p0 (see the module).

    p0 : a number or a symbol; not negative under a power law, whose contacts only push.

    Raises `lwa.InputError` for what cannot be meant, a cell of unlike contacts under a law that is
    no power among it.

    >>> BackgroundWave(Cell([1]), Power("3/2"), "p0").kdv.nonlinearity
    1/(4*p0**(3/4))
    """

    cell: Cell
    law: Power | Law
    p0: sp.Expr

    def __post_init__(self) -> None:
        for_cell(self.law, self.cell)
        p0 = exact(self.p0, "p0")
        if isinstance(self.law, Power) and p0.is_negative:
            raise InputError(f"p0 is {p0}: under a power law it must not be negative")
        chain = {*self.cell.symbols, *self.law.symbols}  # p0 of a load holds these
        free = p0 if p0.is_Symbol else sp.Add(*(p0.free_symbols - chain))
        meant(free, "p0", taken=taken_names(self.cell, self.law))
        object.__setattr__(self, "p0", p0)

    def __repr__(self) -> str:
        return f"BackgroundWave({self.cell!r}, {self.law!r}, p0={self.p0})"

    def _repr_latex_(self) -> str:
        return latex.display([latex.row("V_{s}", self.speed())])

    @cached_property
    def I(self) -> sp.Expr:
        """The coefficient of u_4x, D² included."""
        return Dispersion(self.cell, self._exponent).I * self.cell.spacing**2

    @property
    def time_scale(self) -> sp.Expr:
        """τ/t: the speed in space and time is dx/dt = V τ/t."""
        return self.cell.time_scale(self._exponent)

    @property
    def _exponent(self) -> sp.Expr:
        """By which unlike contacts share the strain; under a law that is no power all are alike."""
        return self.law.k if isinstance(self.law, Power) else sp.S.One

    # --- the law in units of the strain -----------------------------------------------------

    def force(self, p: sp.Expr, n: int = 0) -> sp.Expr:
        """F^{(n)} at a strain; W for n = -1."""
        law, D = self.law, self.cell.spacing
        if isinstance(law, Power):
            up, down = (sp.Mul(*(law.k - j for j in r)) for r in (range(1, n), range(n, 1)))
            return up / down * p ** (law.k - n)
        if n < 0:
            return law.energy.subs(law.delta, D * p) / D**2
        return law.at(D * p, n) * D ** (n - 1)

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """c0 = √F′(p0), the speed of long small waves."""
        return root(self.force(self.p0, 1))

    def stiffness(self, v: sp.Expr) -> sp.Expr:
        """Q(v), the V² of the wave that rises by v."""
        return sp.powsimp(self._stiffness(v))

    def _stiffness(self, v: sp.Expr) -> sp.Expr:
        rest = self.force(self.p0, -1) + self.force(self.p0) * v
        return 2 * (self.force(sp.expand(self.p0 + v), -1) - rest) / v**2

    # --- the wave ---------------------------------------------------------------------------

    def speed(self, B: Any = None) -> sp.Expr:
        """V = dx/dτ of the wave whose strain rises from p0 to p0 + B (a symbol B when not given).

        Raises `lwa.NoSolitaryWave` where numbers show that there is none.

        >>> BackgroundWave(Cell([1]), Power(2), "p0").speed()
        sqrt(B/3 + p0)
        """
        B = self._amplitude(B)
        square = self.stiffness(B)
        if isinstance(self.law, Power) and self.law.k.is_Integer:
            square = sp.expand(sp.cancel(square))
        return root(square)

    @property
    def _rise(self) -> sp.Symbol:
        """The symbol B: positive, under a power with k < 1 negative, under other laws of either."""
        if not isinstance(self.law, Power):
            return sp.Symbol("B", real=True)
        return sp.Symbol("B", negative=True) if (self.law.k - 1).is_negative else RISE

    def _amplitude(self, B: Any) -> sp.Expr:
        if B is None:
            return self._rise
        B = exact(B, "B")
        if B.is_zero:
            raise InputError("B is 0: a wave rises or falls by B; `kdv` is the limit of small ones")
        if reason := self._missing(B):
            raise NoSolitaryWave(f"p0 = {self.p0}, B = {shorten(B)}: {reason}")
        return B

    def _missing(self, B: sp.Expr) -> str:
        """Why there is no wave; empty where there is one, or where symbols leave it open."""
        if not isinstance(self.law, Power):
            return self._missing_numerically(B)
        excess = self.law.k - 1
        if excess.is_zero:
            return "at k = 1 the chain is linear, and its waves disperse"
        if excess.is_negative and self.p0.is_zero:
            return "k < 1 and there is no load: the speed falls with the strain"
        if excess.is_negative and (self.p0 + B).is_nonpositive:
            return "the contacts would open"
        if excess.is_positive and B.is_negative:
            return "k > 1 stiffens, so that speeds grow with the strain and only B > 0 has a wave"
        if excess.is_negative and B.is_positive:
            return "k < 1 softens, so that speeds fall with the strain and only B < 0 has a wave"
        return ""

    def _missing_numerically(self, B: sp.Expr) -> str:
        if self._free(B):
            return ""
        with mpmath.workdps(30 + self._lost(B)):
            number = self._number(B)
            _, slope, Q = self._functions()
            top = Q(number)
            for i in range(1, _LOOKS):
                v = number * i / _LOOKS
                if mpmath.im(slope(v)) != 0 or not slope(v) > 0:
                    return f"F′ is not positive at the strain p0 + {mpmath.nstr(v, 5)}"
                if not Q(v) < top:
                    return (
                        "the law does not stiffen towards it: a wave of the height "
                        f"{mpmath.nstr(v, 5)} would be as fast"
                    )
        return ""

    def _slope(self, v: sp.Expr) -> sp.Expr:
        return self.force(self.p0 + v, 1)

    @property
    def kdv(self) -> KdV:
        """The limit B → 0.

        Raises `lwa.NoSolitaryWave` where no sound runs, at p0 = 0 under most laws.
        """
        if self.sound_speed.is_zero or self.sound_speed.is_finite is False:
            raise NoSolitaryWave(f"p0 is {self.p0}: no sound runs there, so that no wave is small")
        c0 = self.sound_speed
        bend = self.force(self.p0, 2)
        return KdV(c0, sp.powsimp(bend / (2 * c0)), self.I * c0 / 2)

    def fwhm(self, B: Any, quantity: str = "strain", digits: int = DIGITS) -> sp.Expr:
        """Full width at half maximum, a length in x: of the rise of the strain, or of the force.

        The velocity's is the strain's. Without load under a power law it is the compact wave's
        closed form, else a number of so many digits, times D where D is a symbol.

        Raises `lwa.InputError` where other things are symbols, `lwa.NoSolitaryWave` without a wave.

        >>> BackgroundWave(Cell([1]), Power("3/2"), 1).fwhm(1)
        3.15563100804513*D
        """
        B = self._amplitude(B)
        if self._compact is not None:
            k, beta = self._compact
            power = k if known(quantity) == "force" else 1
            return 2 * sp.acos(2 ** (-(k - 1) / (2 * power))) / beta
        digits = self._digits(digits)
        with mpmath.workdps(2 * digits + 15 + self._lost(B)):
            found = self._profile(B)
            length = 2 * found.place(found.half(known(quantity)))
        return sp.Float(length, digits) * self._unit

    @property
    def _compact(self) -> tuple[sp.Expr, sp.Expr] | None:
        """k and β of the wave without load under a power law."""
        if not (isinstance(self.law, Power) and self.p0.is_zero):
            return None
        k = self.law.k
        return k, (k - 1) / root(2 * self.I * k * (k + 1))

    def profile(self, xi: Any, B: Any, digits: int = DIGITS) -> sp.Expr:
        """v(ξ), the strain above p0: the compact wave without load, else a number.

        Raises what `fwhm` raises, and `lwa.InputError` for a ξ that is no number in D.
        """
        B, xi = self._amplitude(B), real(xi, "xi")
        if self._compact is not None:
            k, beta = self._compact
            arch = B * sp.cos(beta * xi) ** (2 / (k - 1))
            return sp.Piecewise((arch, sp.Abs(xi) <= sp.pi / (2 * beta)), (0, True))
        place = xi.subs(self._unit, 1) if self._unit.is_Symbol else xi
        if place.free_symbols:
            raise InputError(f"xi is {shorten(xi)}: a number, in D, is wanted")
        digits = self._digits(digits)
        with mpmath.workdps(2 * digits + 15 + self._lost(B)):
            target = abs(mpmath.mpf(sp.N(place, mpmath.mp.dps)))
            if not target:
                return sp.Float(self._number(B), digits)
            found = self._profile(B)
            value = found.strain(found.theta(target, mpmath.mpf(10) ** (-digits - 5)))
        return sp.Float(value, digits)

    def numeric(self) -> NumericBackground:
        """Vectorised float64 functions of (p0, B) for this cell and law; p0 is an argument there.

        Raises `lwa.InputError` unless masses, stiffnesses and the law's parameters are numbers.
        """
        from lwa.wave.quadrature import (
            NumericBackground,  # here, so that `import lwa` loads no NumPy
        )

        return NumericBackground(self)

    def code(self, language: str) -> str:
        """Speeds, small waves and τ/t as functions in a program's source text.

        ``language`` as in `lwa.TravelingWave.code`; arguments are told in `lwa.wave.functions`.
        """
        from lwa.wave.functions import loaded_code  # here: it is for these waves too

        return loaded_code(self, language)

    def on(self, p0: Any) -> Self:
        """The same on another strain."""
        return replace(self, p0=p0)

    def at(self, **values: Any) -> BackgroundWave:
        """With numbers (or other symbols) for the named symbols, and for ω = m2/m1.

        Raises `lwa.InputError` for a name that does not occur or a value that cannot be meant.
        """
        more = (*self.law.symbols, *sorted(self.p0.free_symbols, key=str))
        new = substitution(values, self.cell, more=more)
        return BackgroundWave(
            self.cell.replaced(new), self.law.replaced(new), self.p0.xreplace(new)
        )

    # --- numbers of many digits -------------------------------------------------------------

    @property
    def _unit(self) -> sp.Expr:
        """The spacing where it is a symbol and the law has no scale; lengths are numbers in it."""
        D = self.cell.spacing
        return D if D.is_Symbol and isinstance(self.law, Power) else sp.S.One

    def _free(self, *values: sp.Expr) -> set[sp.Symbol]:
        all_values = (*values, self.p0, self.I, self._slope(sp.S.One))
        return set().union(*(v.free_symbols for v in all_values)) - {self._unit}

    def _digits(self, digits: int) -> int:
        if integer(digits, "digits", 1) > MOST_DIGITS:
            raise InputError(f"digits is {digits}: at most {MOST_DIGITS} are given")
        return digits

    def _lost(self, B: sp.Expr) -> int:
        """Digits that the differences cancel where the wave is small."""
        if free := self._free(B):
            raise InputError(
                f"{min(map(str, free))!r} has no value: a width or a profile on a background is a "
                "number and wants numbers"
            )
        ratio = abs(sp.N(self.p0 / B, 5))
        return 3 * max(0, int(sp.ceiling(sp.log(ratio + 1, 10)))) + 10

    def _number(self, value: sp.Expr) -> Any:
        one = value.subs(self._unit, 1) if self._unit.is_Symbol else value
        return mpmath.mpf(sp.N(one, mpmath.mp.dps + 5))

    @cached_property
    def _compiled(self) -> list[tuple[Function, list[sp.Rational]]]:
        """F, F′ and Q at p0 + v: functions of v and of their own fractions."""
        v, found = sp.Dummy("v", real=True), []
        for value in (self.force(self.p0 + v), self._slope(v), self._stiffness(v)):
            value = value.subs(self._unit, 1) if self._unit.is_Symbol else value
            numbers = {a: sp.Dummy() for a in value.atoms(sp.Rational) if not a.is_Integer}
            function = sp.lambdify((v, *numbers.values()), value.xreplace(numbers), "mpmath")
            found.append((function, list(numbers)))
        return found

    def _functions(self) -> list[Function]:
        """F, F′ and Q at p0 + v in mpmath's working precision: fractions are no floats there."""
        return [
            _given(function, [mpmath.mpf(int(a.p)) / int(a.q) for a in numbers])
            for function, numbers in self._compiled
        ]

    def _profile(self, B: sp.Expr) -> Profile:
        """In mpmath's working precision."""
        return Profile(self._number(B), self._number(self.I), *self._functions())


def background_wave(
    cell: Cell, p0: Any = "p0", *, law: Power | Law | None = None
) -> BackgroundWave:
    """The waves of a cell's canonical field on the strain p0, under δ^k where no law is given.

    >>> background_wave(Cell([1]), law=Power("3/2")).sound_speed
    p0**(1/4)
    """
    return BackgroundWave(cell, Power("k") if law is None else law, p0)


def _given(function: Function, numbers: list[Any]) -> Function:
    return lambda v: function(v, *numbers)
