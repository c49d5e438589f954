"""A form of the wave equation that can be integrated: (1 - I ∂_x²) u_ττ = ∂_x F(u_x).

Let φ be the canonical field, F the contact force and I the coefficient of dispersion in the units
of `lwa.wave.background`. In the field u = φ + (I/2) φ_xx the terms of order D^{k+3} of the wave
equation are I ∂_x³ F(u_x), for every cell of a power law or of equal contacts, and equal I ∂_x²
u_ττ to this order (Rosenau, Phys. Lett. A 118, 222 (1986), for equal beads). The canonical equation
cut at D^{k+3} amplifies short waves without bound; this one is well posed, and its energy ∫ [½ u_τ²
+ ½ I u_xτ² + W(u_x)] dx, W′ = F, is positive. Its waves on a strain p0, u_x = p0 + v(ξ), ξ = x - V
τ, with the rise B obey

    I V² v′² = v² (V² - Q(v)),    Q(v) = 2 [W(p0+v) - W(p0) - F(p0) v]/v²,    V² = Q(B).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, power, read_exact, signed
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.force import ContactLaw, for_cell
from lwa.linear.dispersion import Dispersion


@dataclass(frozen=True)
class Evolution(Value):
    """The equation (1 - I ∂_x²) u_ττ = ∂_x F(u_x) of a cell and a law.

    Pulses of Hertz contacts are too narrow by 19 % in this equation (FWHM of the strain), which is
    meant for the evolution of long waves, not for the widths of short ones.

    >>> from lwa import Power
    >>> Evolution(Cell([1], spacing=1), Power("3/2")).speed("B")
    2*sqrt(30)*B**(1/4)/15
    """

    cell: Cell
    law: ContactLaw

    def __post_init__(self) -> None:
        for_cell(self.law, self.cell)

    @property
    def I(self) -> sp.Expr:
        """Coefficient I in the linear chain's dispersion Ω² = κ² - I κ⁴ + …, D² included."""
        return Dispersion(self.cell, self.law.exponent).I * self.cell.spacing**2

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t of the equation's time to the chain's."""
        return self.cell.time_scale(self.law.exponent)

    def force(self, p: Any, n: int = 0) -> sp.Expr:
        """The n-th derivative F^{(n)}(p) in the units of the equation; the energy W for n = -1."""
        return self.law.of_strain(signed(p, "p"), self.cell.spacing, n)

    def speed(self, B: Any, p0: Any = 0) -> sp.Expr:
        """Speed V = dx/dτ of the wave whose strain rises from p0 to p0 + B."""
        B, p0 = read_exact(B, "B"), read_exact(p0, "p0")
        W, W0 = (self.force(p, -1) for p in (p0 + B, p0))
        return sp.sqrt(sp.powsimp(sp.factor(2 * (W - W0 - self.force(p0) * B) / B**2)))

    def profile(self, xi: Any, B: Any) -> sp.Expr:
        """Strain v = B sech^{2/(k-1)}((k-1) ξ/(2√I)) of the wave without load, for a power law.

        Raises `lwa.InputError` for other laws.
        """
        if not self.law.homogeneous:
            raise InputError("the profile has a closed form under a power law only")
        k = self.law.exponent
        shape = sp.sech((k - 1) * signed(xi, "xi") / (2 * sp.sqrt(self.I)))
        return read_exact(B, "B") * power(shape, 2 / (k - 1))

    def latex_rows(self) -> list[str]:
        equation = r"(1 - I \partial_x^2) u_{\tau\tau} = \partial_x F(u_{x})"
        return [equation, latex.row("F(p)", self.force("p")), latex.row("I", self.I)]
