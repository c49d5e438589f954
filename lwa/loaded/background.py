"""The long-wave field of a chain on a static strain, in closed form.

Let F be the force in the units of `lwa.equation.pde` (``p^k/k`` for a power), W its energy, so that
``W′ = F``, and I the coefficient of dispersion, D² included. The canonical field obeys::

    u_ττ = ∂_x [F(u_x) + I (F′ u_xxx + ½ F″ u_xx²)].

A wave v on a strain p0, ``u_x = p0 + v(ξ)`` with ``ξ = x - V τ``, obeys (Nesterenko, *Dynamics of
Heterogeneous Materials*, 2001, ch. 1, for equal spheres)::

    I F′(p0 + v) v′² = v² (Q(B) - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v] / v²,

so that ``V² = Q(B)`` for the wave that rises by B. It exists where ``F′ > 0`` and
``Q(v) < Q(B)`` for all v between 0 and B, and ``B Q′(B) > 0``: at ``Q′(B) = 0``, the limiting
amplitude of a law that softens, the wave is infinitely long. Its limit B → 0 is the wave of
Korteweg and de Vries.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, brief, power, read_exact, real, shorten
from lwa.base.frozen import FALL, RISE, NoSolitaryWave, Value
from lwa.cell import Cell
from lwa.law import ContactLaw, for_cell
from lwa.linear.dispersion import Dispersion


def squared_speed(work: sp.Expr, force: sp.Expr, rise: sp.Expr) -> sp.Expr:
    """The relation ``Q = 2 [W(p0+B) - W(p0) - F(p0) B] / B²`` of a wave that rises by B.

    Parameters
    ----------
    work : Expr
        The difference W(p0+B) - W(p0) of the energies.
    force : Expr
        The static force F(p0).
    rise : Expr
        The rise B.
    """
    return 2 * (work - force * rise) / rise**2


@dataclass(frozen=True)
class Background(Value):
    """The canonical field of a chain on a static strain.

    Speeds are dx/dτ in the wave equation's units; times `time_scale` they are dx/dt.

    Parameters
    ----------
    cell : Cell
        The chain.
    law : ContactLaw
        The law of its contacts.
    p0 : number or str
        The static strain.

    Raises
    ------
    InputError
        For a negative strain under a power law, whose contacts only push, for unlike contacts
        under a law that is no power, and unless ``F′ > 0`` at a strain other than 0.
    """

    cell: Cell
    law: ContactLaw
    p0: Any

    def __post_init__(self) -> None:
        # Called for its refusal of unlike contacts under a law that is no power
        for_cell(self.law, self.cell)
        # The floats of an expression, such as the strains of a shock, stay floats: `read_exact`
        # makes fractions of them, whose powers have thousands of digits.
        read = real if isinstance(self.p0, sp.Expr) else read_exact
        self._set(p0=read(self.p0, "background"))
        if self.law.homogeneous and self.p0.is_negative:
            raise InputError(
                f"background is {shorten(self.p0)}: under a power law it must not be negative"
            )
        if not self.p0.is_zero:
            self.law.check_strain(self.p0, self.cell)

    def latex_rows(self) -> list[str]:
        energy = "V_{s}^{2} v^{2} - 2 [W(p_{0} + v) - W(p_{0}) - F(p_{0}) v]"
        return [
            rf"I F'(p_{{0}} + v) v_{{\xi}}^{{2}} = {energy}, \quad W' = F",
            *self.law.latex_rows(),
            latex.row("p_{0}", self.p0),
            latex.row("I", self.I),
            latex.row("V_{s}", self.speed(self.rise)),
        ]

    @cached_property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's ``Ω² = κ² (1 - (I/D²) κ² + …)``, at any strain."""
        return Dispersion(self.cell, self.law.exponent).I

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t, by which ``dx/dt = V τ/t``."""
        return self.cell.time_scale(self.law.exponent)

    def force(self, p: sp.Expr, n: int = 0) -> sp.Expr:
        """Force in the wave equation's units, its n-th derivative, or for n of -1 the energy W."""
        return self.law.of_strain(p, self.cell.spacing, n)

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed ``c0 = √F′(p0)`` of long small waves."""
        return power(self.force(self.p0, 1), sp.S.Half)

    @property
    def rise(self) -> sp.Symbol:
        """The symbol B: positive, negative under a power with k < 1, real under other laws."""
        if not self.law.homogeneous:
            return sp.Symbol("B", real=True)
        # For k < 1 speeds fall with the strain: the fastest part of a wave is its lowest strain. A
        # symbol k, of which is not known whether it is below 1, counts as above 1.
        return FALL if (self.law.exponent - 1).is_negative else RISE

    def squared_speed(self, B: sp.Expr) -> sp.Expr:
        """Squared speed Q(B) of the wave that rises by B, whether it exists or not."""
        at_rest = self.force(self.p0, -1)
        at_peak = self.force(sp.expand(self.p0 + B), -1)
        return squared_speed(at_peak - at_rest, self.force(self.p0), B)

    def speed(self, B: sp.Expr) -> sp.Expr:
        """Speed ``V = √Q(B)`` of the wave that rises by B, whether it exists or not."""
        square = sp.powsimp(self.squared_speed(B))
        if self.law.homogeneous and self.law.exponent.is_Integer:
            square = sp.expand(sp.cancel(square))  # a polynomial in p0 and B
        return power(square, sp.S.Half)

    @cached_property
    def kdv(self) -> KdV:
        """The limit B → 0, in the time τ.

        Raises
        ------
        NoSolitaryWave
            Where no sound runs (``p0 = 0`` under most laws), and at ``F″ = 0`` as for ``k = 1``,
            where small waves of any amplitude run at one speed.
        """
        return KdV.of_slopes(
            self.sound_speed, self.force(self.p0, 1), self.force(self.p0, 2), self.I
        )

    def on(self, p0: Any) -> Self:
        """The field of the same chain on another static strain p0."""
        return replace(self, p0=p0)


@dataclass(frozen=True, repr=False)
class KdV(Value):
    """The limit of small waves, ``v_t + c0 v_x + α v v_x + γ v_xxx = 0``, and its sech² wave.

    Here v is the strain above p0. For a power, in the time τ, ``c0 = p0^{(k-1)/2}``,
    ``α = (k-1) c0/(2 p0)`` and ``γ = I c0/2``.

    Parameters
    ----------
    sound_speed : Expr
        The speed of sound c0.
    nonlinearity : Expr
        The coefficient α.
    dispersion : Expr
        The coefficient γ.
    """

    sound_speed: sp.Expr
    nonlinearity: sp.Expr
    dispersion: sp.Expr

    def __repr__(self) -> str:
        return (
            f"KdV(c0={brief(self.sound_speed)}, α={brief(self.nonlinearity)}, "
            f"γ={brief(self.dispersion)})"
        )

    @classmethod
    def of_slopes(cls, c0: sp.Expr, F1: sp.Expr, F2: sp.Expr, I: sp.Expr) -> Self:
        """Return the equation of a lattice with the slopes ``F′`` and ``F″`` at its static strain.

        Raises `lwa.NoSolitaryWave` where no sound runs, and where small waves disperse.
        """
        if c0.is_zero or c0.is_finite is False:
            raise NoSolitaryWave(
                "no sound runs at the static strain, so that no wave is small"
            )
        if F2.has(sp.nan, sp.oo, sp.zoo):
            raise NoSolitaryWave(
                "F″ is not finite at the static strain, so that no wave is small"
            )
        if F2.is_zero:
            raise NoSolitaryWave(
                "F″ is 0 at the static strain: waves of small amplitude disperse"
            )
        # V² = Q(B) = c0² (1 + F″ B/(3F′) + …), hence V = c0 + α B/3; Ω² = c0² (q² - I q⁴) gives
        # γ = I c0/2.
        return cls(c0, sp.powsimp(c0 * F2 / F1) / 2, I * c0 / 2)

    def latex_rows(self) -> list[str]:
        names = {
            "c_{0}": self.sound_speed,
            r"\alpha": self.nonlinearity,
            r"\gamma": self.dispersion,
        }
        equation = r"v_{\tau} + c_{0} v_{x} + \alpha v v_{x} + \gamma v_{xxx} = 0"
        wave = r"v = B \operatorname{sech}^{2}(\xi / L)"
        return [equation, *latex.rows(names), wave, latex.row("L", self.width())]

    @property
    def rise(self) -> sp.Symbol:
        """The symbol B: positive, or negative where α < 0, as waves have the sign of α."""
        return FALL if self.nonlinearity.is_negative else RISE

    def _read_rise(self, B: Any) -> sp.Expr:
        """Read the rise of a wave, of the sign of α; the symbol B where none is given."""
        if B is None:
            return self.rise
        B = read_exact(B, "B")
        if (B * self.nonlinearity).is_nonpositive:
            raise NoSolitaryWave(f"B is {shorten(B)}: a small wave has the sign of α")
        return B

    def speed(self, B: Any = None) -> sp.Expr:
        """Speed ``V = c0 + α B/3`` of the wave ``v = B sech²(ξ/L)``; B is a symbol unless given."""
        return self.sound_speed + self.nonlinearity * self._read_rise(B) / 3

    def width(self, B: Any = None) -> sp.Expr:
        """Width ``L = √(12 γ / (α B))`` of ``v = B sech²(ξ/L)``; the FWHM is ``2 arcosh(√2) L``."""
        ratio = sp.simplify(self.dispersion / self.nonlinearity)
        return sp.sqrt(12 * ratio / self._read_rise(B))
