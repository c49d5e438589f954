"""The equation of Korteweg and de Vries: the limit of small waves on a static strain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import read_exact, shorten, signed
from lwa.base.frozen import Value
from lwa.base.quantities import FALL, RISE, NoSolitaryWave


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

    @property
    def rise(self) -> sp.Symbol:
        """The symbol B: positive, or negative where α < 0, as waves have the sign of α."""
        return FALL if (self.nonlinearity * self.sound_speed).is_negative else RISE

    def _rise(self, B: Any) -> sp.Expr:
        """Read the rise of a wave, of the sign of α."""
        B = self.rise if B is None else read_exact(B, "B")
        if (B * self.nonlinearity).is_nonpositive:
            raise NoSolitaryWave(f"B is {shorten(B)}: a small wave has the sign of α")
        return B

    def speed(self, B: Any = None) -> sp.Expr:
        """Speed V = c0 + α B/3 of the wave v = B sech²(ξ/L); B is a symbol unless given."""
        return self.sound_speed + self.nonlinearity * self._rise(B) / 3

    def width(self, B: Any = None) -> sp.Expr:
        """Width L = √(12 γ / (α B)) of v = B sech²(ξ/L); the FWHM is 2 arcosh(√2) L."""
        return sp.sqrt(12 * sp.simplify(self.dispersion / self.nonlinearity) / self._rise(B))

    def profile(self, xi: Any, B: Any = None) -> sp.Expr:
        """Strain v = B sech²(ξ/L) above the background."""
        return self._rise(B) * sp.sech(signed(xi, "xi") / self.width(B)) ** 2
