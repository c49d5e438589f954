"""The equation of Korteweg and de Vries, the limit B → 0 of waves on a background."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import exact, root, signed
from lwa.base.frozen import Value
from lwa.base.quantities import RISE


@dataclass(frozen=True)
class KdV(Value):
    """The limit of small waves, v_τ + c0 v_x + α v v_x + γ v_xxx = 0, and its sech² wave.

    v is the strain above p0, c0 the speed of sound, α the nonlinearity and γ the dispersion.
    For a power α = (k-1) c0/(2 p0), γ = I c0/2, c0 = p0^{(k-1)/2}.
    """

    sound_speed: sp.Expr
    nonlinearity: sp.Expr
    dispersion: sp.Expr

    def latex_rows(self) -> list[str]:
        names = {"c_{0}": self.sound_speed, r"\alpha": self.nonlinearity}
        names[r"\gamma"] = self.dispersion
        equation = r"v_{\tau} + c_{0} v_{x} + \alpha v v_{x} + \gamma v_{xxx} = 0"
        return [equation, *latex.rows(names)]

    def speed(self, B: Any = RISE) -> sp.Expr:
        """Speed V = c0 + α B/3 of the wave v = B sech²(ξ/L)."""
        return self.sound_speed + self.nonlinearity * exact(B, "B") / 3

    def width(self, B: Any = RISE) -> sp.Expr:
        """Width L = √(12 γ / (α B)) of v = B sech²(ξ/L); the FWHM is 2 arcosh(√2) L."""
        return root(12 * sp.simplify(self.dispersion / self.nonlinearity) / exact(B, "B"))

    def profile(self, xi: Any, B: Any = RISE) -> sp.Expr:
        """Strain v = B sech²(ξ/L) above the background."""
        return exact(B, "B") * sp.sech(signed(xi, "xi") / self.width(B)) ** 2
