"""The compact traveling wave of the wave equation at D^{k+3}, in closed form.

    u_ττ = u_x^{k-1} u_xx + G u_x^{k-3} u_xx³ + H u_x^{k-2} u_xx u_xxx + I u_x^{k-1} u_4x.

With ξ = x - V τ the strain v = u_ξ obeys a third-order equation. The substitution v = z^p with

    (G + H + I) p² - (H + 3I) p + 2I = 0

removes z_ξ³, the integrating factor z^a makes the rest a total derivative, and there remains
z'' = μ z^η - σ z (Porter et al. 2008). Its compact wave is v = B cos^m(βξ) on |ξ| ≤ π/(2β),
m = 2/(k-1). Both roots p lead to the same

    β = (k-1) / (2 √(G+H+I)),    V² = B^{k-1} (1 - β² [(H + 3I) m - 2I]),

because I (kp + a) = p² (G + H + I). The wave needs G + H + I > 0 and V² > 0; p may be complex.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import sympy as sp

from lwa.algebra.rational import factored
from lwa.base import latex
from lwa.base.exact import integer, positive, power, shorten, signed
from lwa.base.frozen import RISE, SPEED, NoSolitaryWave, Value, strain_power
from lwa.cell import Cell, exponent, read_cell, substitution
from lwa.linear.dispersion import Dispersion


@dataclass(frozen=True)
class Reduction(Value):
    """The reduction of the strain's equation to z'' = μ z^η - σ z, v = z^p, for one root p.

    p, a : powers of the substitution and of the integrating factor z^a.
    mu, eta, sigma : μ = V² / (I (p + a)), η = 1 + p - kp, σ = 1 / (I (kp + a)).
    s : power 2 / (1 - η) of the cosine in z. With either root β = √σ (1 - η) / 2 and
        B^{k-1} = μ / (β² s (s - 1)).
    """

    p: sp.Expr
    a: sp.Expr
    mu: sp.Expr
    eta: sp.Expr
    sigma: sp.Expr
    s: sp.Expr

    def latex_rows(self) -> list[str]:
        values = {"p": self.p, "a": self.a, r"\mu": self.mu, r"\eta": self.eta}
        equation = r"z'' = \mu z^{\eta} - \sigma z, \quad v = z^{p}"
        return [equation, *latex.rows({**values, r"\sigma": self.sigma})]


@dataclass(frozen=True, repr=False)
class CompactWave(Value):
    """Closed forms of the compact wave v = u_x = B cos^m(βξ), ξ = x - V τ.

    cell, k : the chain and the exponent of its contact law.
    G, H, I : coefficients of the wave equation, D² included.

    Results are exact SymPy expressions; the speed V = dx/dτ becomes dx/dt by `time_scale`.

    Raises `NoSolitaryWave` when the parameters are numbers without a wave (k ≤ 1, G + H + I ≤ 0,
    or V² ≤ 0).
    """

    cell: Cell
    k: sp.Expr
    G: sp.Expr
    H: sp.Expr
    I: sp.Expr

    def __post_init__(self) -> None:
        if self.k.is_number and not self.k > 1:
            raise NoSolitaryWave(f"k is {self.k}: a compact wave needs k > 1")
        if self.coefficient_sum.is_number and not self.coefficient_sum > 0:
            raise NoSolitaryWave(
                f"(G+H+I)/D² is {self.coefficient_sum}: a compact wave needs G+H+I > 0"
            )
        if self.speed_factor.is_number and not self.speed_factor > 0:
            raise NoSolitaryWave(
                f"V²/B^(k-1) is {self.speed_factor}: a compact wave needs V² > 0"
            )

    @classmethod
    def canonical(cls, cell: Cell, k: Any) -> Self:
        """The wave of the canonical field of a cell; see `lwa.canonical_wave`."""
        read_cell(cell)
        k = exponent(k)
        I = Dispersion(cell, k).I
        # G and H follow from I for every cell (theorem, see `lwa.equation.energy`).
        return cls(cell=cell, k=k, G=I * (k - 1) * (k - 2) / 2, H=2 * I * (k - 1), I=I)

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({self.cell!r}, k={self.k}, β={shorten(self.beta)})"
        )

    def latex_rows(self) -> list[str]:
        return [
            r"v = u_{x} = B \cos^{2/(k-1)}(\beta \xi), \quad |\xi| \leq \frac{\pi}{2\beta}",
            latex.row(r"\beta", self.beta),
            latex.row("V_{s}", self.speed()),
        ]

    @property
    def D(self) -> sp.Expr:
        """The spacing D of neighbouring particles."""
        return self.cell.spacing

    @cached_property
    def _ratios(self) -> tuple[sp.Expr, sp.Expr]:
        """The ratios G/I and H/I, which in the canonical field depend on k alone."""
        return factored(self.G / self.I), factored(self.H / self.I)

    @cached_property
    def coefficient_sum(self) -> sp.Expr:
        """The sum (G + H + I) / D²."""
        g, h = self._ratios
        if (g + h).free_symbols <= self.k.free_symbols:  # I stays a factor
            return self.I / self.D**2 * factored(1 + g + h)
        return factored((self.G + self.H + self.I) / self.D**2)

    @property
    def m(self) -> sp.Expr:
        """The power m = 2/(k-1) of the cosine in the strain."""
        return 2 / (self.k - 1)

    @cached_property
    def beta(self) -> sp.Expr:
        """The wavenumber β = (k-1) / (2 √(G+H+I)) of the cosine."""
        return (self.k - 1) / (2 * self.D * _root(self.coefficient_sum))

    @cached_property
    def width(self) -> sp.Expr:
        """The length π/β of the wave's support."""
        return sp.pi / self.beta

    @property
    def sites(self) -> sp.Expr:
        """The number π/(βD) of particles under the wave."""
        return self.width / self.D

    def fwhm(self, quantity: str = "strain") -> sp.Expr:
        """Full width at half maximum, a length in x.

        quantity : "strain" (u_x), "force" (of a contact, A (D u_x)^k) or "velocity" (u_τ = -V u_x);
            raises `lwa.InputError` for others.
        """
        # cos^{mq}(βξ) = 1/2, where the quantity scales as strain^q
        return (
            2
            * sp.acos(2 ** (-1 / (strain_power(quantity, self.k) * self.m)))
            / self.beta
        )

    @cached_property
    def speed_factor(self) -> sp.Expr:
        """The ratio V²/B^{k-1} = 1 - β² [(H + 3I) m - 2I]."""
        # With β² = (k-1)²/(4 I (1+g+h)) and m = 2/(k-1) written out (k - 1) cancels.
        k, (g, h) = self.k, self._ratios
        return factored(1 - (k - 1) * (h + 4 - k) / (2 * (1 + g + h)))

    def speed(self, B: Any = RISE) -> sp.Expr:
        """Speed V = dx/dτ of the wave whose strain peaks at B."""
        return _root(self.speed_factor) * power(positive(B, "B"), (self.k - 1) / 2)

    def amplitude(self, V: Any = SPEED) -> sp.Expr:
        """Peak strain B = (V² / speed_factor)^{1/(k-1)} of the wave of speed V = dx/dτ."""
        return power(positive(V, "V") ** 2 / self.speed_factor, 1 / (self.k - 1))

    @property
    def force_exponent(self) -> sp.Expr:
        """The power 2k/(k-1) of V to which the peak force F_m is proportional."""
        return 2 * self.k / (self.k - 1)

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t, by which dx/dt = V τ/t."""
        return self.cell.time_scale(self.k)

    def profile(self, xi: Any, B: Any = RISE) -> sp.Expr:
        """Strain v(ξ) = B cos^m(βξ) on |ξ| ≤ π/(2β) and 0 outside, as a SymPy Piecewise.

        >>> CompactWave.canonical(Cell([1]), 3).profile("xi", B=1)
        Piecewise((cos(sqrt(2)*xi/D), Abs(xi) <= sqrt(2)*pi*D/4), (0, True))
        """
        xi = signed(xi, "xi")
        arch = positive(B, "B") * sp.cos(self.beta * xi) ** self.m
        return sp.Piecewise((arch, sp.Abs(xi) <= self.width / 2), (0, True))

    @cached_property
    def roots(self) -> tuple[sp.Expr, sp.Expr]:
        """The two p for which v = z^p removes z_ξ³; the paper's is the first."""
        _, h = self._ratios
        total = self.coefficient_sum * self.D**2 / self.I  # 1 + G/I + H/I
        A, B = factored(total), factored(h + 3)
        root = _root(factored(B**2 - 8 * A)).replace(sp.Abs, lambda x: x)
        return (sp.together((B - root) / (2 * A)), sp.together((B + root) / (2 * A)))

    def reduction(self, root: int = 0, V: Any = SPEED) -> Reduction:
        """Reduction to z'' = μ z^η - σ z for one of the `roots` p (0: the paper's, 1: the other).

        With r_n = ∂^n z / z and such a p the strain's equation is

            V² z^p r_1 = z^{kp} (r_1 + I r_3 + I q r_1 r_2),    q = 3 (p - 1) + p H/I.

        Since ∂(z^e r_2) = z^e (r_3 + (e - 1) r_1 r_2), the factor z^a, kp + a = e = q + 1, makes
        it a total derivative; integrated once it is the equation of z.
        """
        p = self.roots[integer(root, "root", 0, 1)]
        a = factored(3 + self._ratios[1] - self.k) * p - 2  # 1 - kp + 3 (p - 1) + p H/I
        mu, eta = positive(V, "V") ** 2 / (self.I * (p + a)), 1 + p - self.k * p
        sigma = 1 / (self.I * (self.k * p + a))
        return Reduction(p, a, mu, eta, sigma, 2 / (1 - eta))

    def at(self, **values: Any) -> Self:
        """Substitute numbers (or other symbols) for the named symbols, and for ω = m2/m1.

        Raises `lwa.InputError` for a name that the wave does not contain or a value that is not
        positive, and `NoSolitaryWave` for values without a wave.

        >>> CompactWave.canonical(Cell(["m1", "m2"]), "k").at(k="3/2", omega=1).beta
        sqrt(10)/(5*D)
        """
        new = substitution(values, self.cell, self.k)
        G, H, I = (c.xreplace(new) for c in (self.G, self.H, self.I))
        k = exponent(self.k.xreplace(new))
        return replace(self, cell=self.cell.replaced(new), k=k, G=G, H=H, I=I)


def _root(value: sp.Expr) -> sp.Expr:
    """Square root of a rational expression in positive quantities, squares taken out."""
    plain, back = sp.posify(value)
    numerator, denominator = sp.fraction(plain)
    return (power(numerator, sp.S.Half) / power(denominator, sp.S.Half)).xreplace(back)
