"""Waves on a background: a chain under load, of any cell and power, or any law in equal contacts.

The canonical field obeys u_ττ = ∂_x [F(u_x) + I (F′ u_xxx + ½ F″ u_xx²)]: F is the force in the
units of `lwa.equation.pde` (p^k/k for a power), W its energy, W′ = F, and I the coefficient of
dispersion, D² included. A wave v on a strain p0, u_x = p0 + v(ξ), ξ = x - V τ, obeys (Nesterenko,
*Dynamics of Heterogeneous Materials*, 2001, ch. 1, for equal spheres)

    I F′(p0 + v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,

so that V² = Q(B) for the wave that rises by B. It exists where F′ > 0 and Q(v) < Q(B) for all v
between 0 and B, and B Q′(B) > 0: at Q′(B) = 0, the limiting amplitude of a law that softens, the
wave is infinitely long. Speeds are exact; widths, profiles and the existence of a wave under a law
that is no power are computed in float64 (`lwa.wave.quadrature`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, number, power, read_exact, shorten, signed
from lwa.base.frozen import Value
from lwa.base.quantities import (
    FALL,
    RISE,
    NoSolitaryWave,
    refusal_under_power,
)
from lwa.cell import RESERVED, Cell, check_names
from lwa.law import ContactLaw, Power, for_cell, substituted
from lwa.linear.dispersion import Dispersion
from lwa.wave.closed import CompactWave
from lwa.wave.kdv import KdV

if TYPE_CHECKING:
    from lwa.wave.loaded import NumericBackground

WIDTH_DIGITS = 12
"""Digits of a width that are right, but for a law from a table, whose widths are right to 1e-5."""


def taken_names(cell: Cell, law: ContactLaw) -> dict[str, str]:
    """Names of chain, law and wave that the symbol of a load may not have, with their meanings."""
    chain = dict.fromkeys((s.name for s in cell.symbols), "a property of the cell")
    return chain | dict.fromkeys((s.name for s in law.symbols), "a symbol of the law") | RESERVED


@dataclass(frozen=True, repr=False)
class BackgroundWave(Value):
    """The waves of a chain's canonical field on the strain p0.

    p0 : static strain, a number or symbol; not negative under a power law: its contacts only push.

    Raises `lwa.InputError` for anything else, for unlike contacts under a law that is no power, and
    unless F′ > 0 at a strain other than 0.
    """

    cell: Cell
    law: ContactLaw
    p0: sp.Expr

    def __post_init__(self) -> None:
        for_cell(self.law, self.cell)
        p0 = read_exact(self.p0, "p0")
        if self.law.homogeneous and p0.is_negative:
            raise InputError(f"p0 is {p0}: under a power law it must not be negative")
        chain = {*self.cell.symbols, *self.law.symbols}  # the p0 of a load holds these
        free = p0 if p0.is_Symbol else sp.Add(*(p0.free_symbols - chain))
        check_names(free, "p0", taken=taken_names(self.cell, self.law))
        object.__setattr__(self, "p0", p0)
        self.law.check_strain(p0, self.cell)

    def __repr__(self) -> str:
        return f"BackgroundWave({self.cell!r}, {self.law!r}, p0={self.p0})"

    def latex_rows(self) -> list[str]:
        energy = "V_{s}^{2} v^{2} - 2 [W(p_{0} + v) - W(p_{0}) - F(p_{0}) v]"
        return [
            rf"I F'(p_{{0}} + v) v_{{\xi}}^{{2}} = {energy}, \quad W' = F",
            *self.law.latex_rows(),
            latex.row("p_{0}", self.p0),
            latex.row("I", self.I),
            latex.row("V_{s}", self.speed()),
        ]

    @cached_property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's Ω² = κ² - I κ⁴ + …, D² included."""
        return self.linear.I * self.cell.spacing**2

    @property
    def linear(self) -> Dispersion:
        """The dispersion of small waves in the units of the wave equation, at any strain."""
        return Dispersion(self.cell, self.law.exponent)

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t, by which dx/dt = V τ/t."""
        return self.cell.time_scale(self.law.exponent)

    def force(self, p: sp.Expr, n: int = 0) -> sp.Expr:
        """Force F(p) in the wave equation's units, its n-th derivative, or energy W(p): n = -1."""
        return self.law.of_strain(p, self.cell.spacing, n)

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed c0 = √F′(p0) of long small waves."""
        return power(self.force(self.p0, 1), sp.S.Half)

    def stiffness(self, v: sp.Expr) -> sp.Expr:
        """The square Q(v) of the speed of the wave that rises by v."""
        linear_part = self.force(self.p0, -1) + self.force(self.p0) * v
        rise = self.force(sp.expand(self.p0 + v), -1) - linear_part
        return sp.powsimp(2 * rise / v**2)

    def speed(self, B: Any = None) -> sp.Expr:
        """Speed V = dx/dτ of the wave whose strain rises from p0 to p0 + B (default: a symbol B).

        Raises `lwa.NoSolitaryWave` for numbers without a wave.
        """
        square = self.stiffness(self._read_rise(B))
        if self.law.homogeneous and self.law.exponent.is_Integer:  # a polynomial in p0 and B
            square = sp.expand(sp.cancel(square))
        return power(square, sp.S.Half)

    @property
    def _rise(self) -> sp.Symbol:
        """The symbol B: positive, negative under a power with k < 1, real under other laws."""
        if not self.law.homogeneous:
            return sp.Symbol("B", real=True)
        return FALL if (self.law.exponent - 1).is_negative else RISE

    def _read_rise(self, B: Any) -> sp.Expr:
        """Read the rise of a wave that exists."""
        if B is None:
            return self._rise
        B = read_exact(B, "B")
        if B.is_zero:
            raise InputError("B is 0: a wave rises or falls by B; `kdv` is the limit of small ones")
        if self.law.homogeneous:
            if reason := refusal_under_power(self.law.exponent - 1, self.p0, B):
                raise NoSolitaryWave(f"p0 = {self.p0}, B = {shorten(B)}: {reason}")
        elif not (self.p0 + B).free_symbols.union(self.cell.symbols, self.law.symbols):
            self.numeric().scaled(float(self.p0), float(B))  # refuses a rise without a wave
        return B

    @property
    def kdv(self) -> KdV:
        """The equation of Korteweg and de Vries of the limit B → 0.

        Raises `lwa.NoSolitaryWave` where no sound runs (p0 = 0 under most laws), and at k = 1,
        where waves of any amplitude run at one speed.
        """
        if self.sound_speed.is_zero or self.sound_speed.is_finite is False:
            raise NoSolitaryWave(f"p0 is {self.p0}: no sound runs there, so that no wave is small")
        c0 = self.sound_speed
        # V² = Q(B) = c0² + F″ B/3 + …, hence V = c0 + α B/3; Ω² = κ² - I κ⁴ gives γ = I c0/2.
        bend = self.force(self.p0, 2)
        if bend.is_zero:
            raise NoSolitaryWave(f"F″ is 0 at p0 = {self.p0}: waves of small amplitude disperse")
        return KdV(c0, sp.powsimp(bend / (2 * c0)), self.I * c0 / 2)

    def fwhm(self, B: Any, quantity: str = "strain") -> sp.Expr:
        """Full width at half maximum of the rise of strain, force or velocity, a length in x.

        Without load under a power law the width is the compact wave's closed form, else a float,
        times D for a spacing that is a symbol.

        Raises `lwa.InputError` for other symbols, `lwa.NoSolitaryWave` without a wave.

        >>> BackgroundWave(Cell([1]), Power("3/2"), 1).fwhm(1).n(12)
        3.15563100805*D
        """
        B = self._read_rise(B)
        if self._unloaded:
            return CompactWave.canonical(self.cell, self.law.exponent).fwhm(quantity)
        p0, rise = self._floats(self.p0, B)
        return sp.Float(float(self.numeric().fwhm(p0, rise, quantity))) * self.unit

    @property
    def _unloaded(self) -> bool:
        return self.law.homogeneous and bool(self.p0.is_zero)

    def profile(self, xi: Any, B: Any) -> sp.Expr:
        """Strain v(ξ) above p0: a closed form without load under a power, else a float.

        Raises the errors of `fwhm`, and `lwa.InputError` for a ξ that is no number in D.
        """
        B, xi = self._read_rise(B), signed(xi, "xi")
        if self._unloaded:
            return CompactWave.canonical(self.cell, self.law.exponent).profile(xi, B)
        return sp.Float(float(self.numeric().profile(*self._floats(xi, self.p0, B))))

    def _floats(self, *values: sp.Expr) -> list[float]:
        """Floats of lengths and strains, in the `unit`."""
        return [number(self.in_unit(value)) for value in values]

    def numeric(self) -> NumericBackground:
        """Vectorised float64 functions of (p0, B) for this cell and law; p0 is an argument there.

        Raises `lwa.InputError` unless masses, stiffnesses and the law's parameters are numbers.
        """
        from lwa.wave.loaded import NumericBackground  # start-up: it loads NumPy

        return NumericBackground(self.cell, self.law)

    def on(self, p0: Any) -> Self:
        """The waves of the same chain on another static strain p0."""
        return replace(self, p0=p0)

    def at(self, **values: Any) -> BackgroundWave:
        """Substitute numbers (or other symbols) for the named symbols, and for ω = m2/m1.

        Raises `lwa.InputError` for a name that does not occur or a value that is no quantity.
        """
        return BackgroundWave(*substituted(values, self.cell, self.law, self.p0))

    @property
    def unit(self) -> sp.Expr:
        """Unit of length: D if the spacing is a symbol and the law a power, else 1."""
        D = self.cell.spacing
        return D if D.is_Symbol and self.law.homogeneous else sp.S.One

    def in_unit(self, value: sp.Expr) -> sp.Expr:
        """A length or a speed divided by the `unit`."""
        return value.subs(self.unit, 1) if self.unit.is_Symbol else value


def background_wave(cell: Cell, p0: Any = "p0", *, law: ContactLaw | None = None) -> BackgroundWave:
    """The waves of a cell's canonical field on the strain p0, under δ^k unless a law is given.

    >>> background_wave(Cell([1]), law=Power("3/2")).sound_speed
    p0**(1/4)
    """
    return BackgroundWave(cell, Power("k") if law is None else law, p0)
