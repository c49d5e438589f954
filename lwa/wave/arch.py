"""The arch: a wave whose strain is a power of a cosine, in closed form.

On ``|ξ| ≤ π/(2β)``, with ``ξ = x - V τ``, the strain is ``v = B cos^m(βξ)``, and 0 outside. Two
numbers of a chain determine all arches for an exponent k, here S and f::

    S = (G + H + I)/D²,    f = V²/B^{k-1},    m = 2/(k-1),    β = (k-1) / (2 D √S).

There are such waves for ``k > 1``, ``S > 0`` and ``f > 0``.

**The paper's reduction** (Porter et al. 2008) of the wave's equation (`lwa.wave.compact`) to an
oscillator, ``z'' = μ z^η - σ z``. Let ``r_n = ∂^n z / z``. The substitution ``v = z^p``, p a root
of::

    (G + H + I) p² - (H + 3I) p + 2I = 0,

removes r_1³ from the third-order equation of v. There remains::

    V² z^p r_1 = z^{kp} (r_1 + I r_3 + I q r_1 r_2),    q = 3 (p - 1) + p H/I.

Since ``∂(z^e r_2) = z^e (r_3 + (e - 1) r_1 r_2)``, the integrating factor ``z^a`` with
``kp + a = q + 1`` makes the equation a total derivative, whose integral is the oscillator.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import factored, integer, positive, power, signed
from lwa.base.frozen import RISE, SPEED, NoSolitaryWave, Value, strain_power
from lwa.base.words import QuantityName
from lwa.cell import Cell, Parametric, exponent


@dataclass(frozen=True)
class Arch(Parametric):
    """Closed forms of the compact wave of a wave equation, the arch.

    Results are exact SymPy expressions; the speed ``V = dx/dτ`` becomes dx/dt by `time_scale`.

    Parameters
    ----------
    cell : Cell
        The chain.
    k : Expr
        Exponent of its contact law.
    G, H, I : Expr
        Coefficients of the wave equation, D² included.

    Raises
    ------
    NoSolitaryWave
        For numbers without a wave: ``k ≤ 1``, ``G + H + I ≤ 0``, or ``V² ≤ 0``.
    """

    cell: Cell
    k: sp.Expr
    G: sp.Expr
    H: sp.Expr
    I: sp.Expr

    def __post_init__(self) -> None:
        self._set(k=exponent(self.k))
        conditions = (
            ("k", self.k, 1, "k > 1"),
            ("(G+H+I)/D²", self.coefficient_sum, 0, "G+H+I > 0"),
            ("V²/B^(k-1)", self.speed_factor, 0, "V² > 0"),
        )
        # With symbols every condition is taken to hold.
        for name, value, least, wanted in conditions:
            if value.is_number and not value > least:
                raise NoSolitaryWave(
                    f"{name} is {value}: a compact wave needs {wanted}"
                )

    @cached_property
    def _ratios(self) -> tuple[sp.Expr, sp.Expr]:
        """The ratios G/I and H/I, which in the canonical field depend on k alone."""
        # Expressions in these two stay short where G, H and I have long factors in common.
        g = factored(self.G / self.I)
        h = factored(self.H / self.I)
        return g, h

    @cached_property
    def coefficient_sum(self) -> sp.Expr:
        """The sum (G + H + I) / D²."""
        g, h = self._ratios
        if (g + h).free_symbols <= self.k.free_symbols:  # I stays a factor
            return self.I / self.D**2 * factored(1 + g + h)
        return factored((self.G + self.H + self.I) / self.D**2)

    @cached_property
    def speed_factor(self) -> sp.Expr:
        """The ratio ``V²/B^{k-1} = 1 - β² [(H + 3I) m - 2I]``."""
        # With β² = (k-1)²/(4 I (1+g+h)) and m = 2/(k-1) written out k - 1 cancels.
        k = self.k
        g, h = self._ratios
        less = (k - 1) * (h + 4 - k) / (2 * (1 + g + h))
        return factored(1 - less)

    @cached_property
    def roots(self) -> tuple[sp.Expr, sp.Expr]:
        """The two p for which ``v = z^p`` removes ``z_ξ³``.

        If k and the cell are numbers, the first root is the paper's. With symbols the order of the
        roots may differ, as ``√x²`` is written x, whatever the sign of x.
        """
        # The equation of p, divided by I, is A p² - B p + 2 = 0, with B = h + 3 and h = H/I.
        _, h = self._ratios
        A = factored(self.coefficient_sum * self.D**2 / self.I)
        B = factored(h + 3)
        root = square_root(factored(B**2 - 8 * A))
        root = root.replace(sp.Abs, lambda x: x)
        first = (B - root) / (2 * A)
        second = (B + root) / (2 * A)
        return sp.together(first), sp.together(second)

    def reduction(self, root: int = 0, V: Any = SPEED) -> Reduction:
        """Reduction to ``z'' = μ z^η - σ z`` for one of the `roots` p.

        Parameters
        ----------
        root : {0, 1}
            Index of the root; if k and the cell are numbers, the paper's root is the first.
        V : number or str
            Speed dx/dτ of the wave.
        """
        k = self.k
        p = self.roots[integer(root, "root", 0, 1)]
        _, h = self._ratios
        a = factored(3 + h - k) * p - 2  # 1 - kp + 3 (p - 1) + p H/I
        eta = 1 + p - k * p
        # The integral is V² z^{p+a}/(p+a) = z^{kp+a}/(kp+a) + I z^{kp+a-1} z″. Divided by
        # I z^{kp+a-1} it is the oscillator, which a cosine to the power s solves.
        return Reduction(
            p,
            a,
            mu=positive(V, "V") ** 2 / (self.I * (p + a)),
            eta=eta,
            sigma=1 / (self.I * (k * p + a)),
            s=2 / (1 - eta),
        )

    @property
    def D(self) -> sp.Expr:
        """The spacing D of neighbouring particles."""
        return self.cell.spacing

    @property
    def m(self) -> sp.Expr:
        """The power ``m = 2/(k-1)`` of the cosine in the strain."""
        return 2 / (self.k - 1)

    @cached_property
    def beta(self) -> sp.Expr:
        """The wavenumber ``β = (k-1) / (2 √(G+H+I))`` of the cosine."""
        return (self.k - 1) / (2 * self.D * square_root(self.coefficient_sum))

    @cached_property
    def width(self) -> sp.Expr:
        """The length π/β of the wave's support."""
        return sp.pi / self.beta

    @property
    def sites(self) -> sp.Expr:
        """The number π/(βD) of particles under the wave."""
        return self.width / self.D

    def fwhm(self, quantity: QuantityName = "strain") -> sp.Expr:
        """Full width at half maximum, a length in x.

        Parameters
        ----------
        quantity : {"strain", "force", "velocity"}
            The strain u_x, the force ``A (D u_x)^k`` of a contact, or the velocity
            ``u_τ = -V u_x``.

        Raises
        ------
        InputError
            For another quantity.
        """
        # The quantity scales as strain^q: cos^{mq}(βξ) = 1/2.
        cosines = strain_power(quantity, self.k) * self.m
        return 2 * sp.acos(2 ** (-1 / cosines)) / self.beta

    def speed(self, B: Any = RISE) -> sp.Expr:
        """Speed ``V = dx/dτ`` of the wave whose strain peaks at B."""
        # Two roots: SymPy would not take B out of one root of a product.
        factor = square_root(self.speed_factor)
        growth = power(positive(B, "B"), (self.k - 1) / 2)
        return factor * growth

    def amplitude(self, V: Any = SPEED) -> sp.Expr:
        """Peak strain ``B = (V² / speed_factor)^{1/(k-1)}`` of the wave of speed ``V = dx/dτ``."""
        scaled = positive(V, "V") ** 2 / self.speed_factor  # B^{k-1}
        return power(scaled, 1 / (self.k - 1))

    @property
    def force_exponent(self) -> sp.Expr:
        """The power 2k/(k-1) of V to which the peak force F_m is proportional."""
        return 2 * self.k / (self.k - 1)

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t, by which ``dx/dt = V τ/t``."""
        return self.cell.time_scale(self.k)

    def profile(self, xi: Any, B: Any = RISE) -> sp.Expr:
        """Strain ``v(ξ) = B cos^m(βξ)`` on ``|ξ| ≤ π/(2β)`` and 0 outside, as a SymPy Piecewise.

        >>> from lwa import canonical_wave
        >>> canonical_wave(Cell([1]), 3).profile("xi", B=1)
        Piecewise((cos(sqrt(2)*xi/D), Abs(xi) <= sqrt(2)*pi*D/4), (0, True))
        """
        xi = signed(xi, "xi")
        arch = positive(B, "B") * sp.cos(self.beta * xi) ** self.m
        return sp.Piecewise((arch, sp.Abs(xi) <= self.width / 2), (0, True))


@dataclass(frozen=True)
class Reduction(Value):
    """The oscillator ``z'' = μ z^η - σ z`` of the substitution ``v = z^p``.

    With either root p the compact wave has ``β = √σ (1 - η) / 2`` and
    ``B^{k-1} = μ / (β² s (s - 1))``.

    Parameters
    ----------
    p : Expr
        Power of the substitution.
    a : Expr
        Power of the integrating factor ``z^a``.
    mu : Expr
        Coefficient ``μ = V² / (I (p + a))``.
    eta : Expr
        Power ``η = 1 + p - kp``.
    sigma : Expr
        Coefficient ``σ = 1 / (I (kp + a))``.
    s : Expr
        Power 2 / (1 - η) of the cosine in z.
    """

    p: sp.Expr
    a: sp.Expr
    mu: sp.Expr
    eta: sp.Expr
    sigma: sp.Expr
    s: sp.Expr

    def latex_rows(self) -> list[str]:
        equation = r"z'' = \mu z^{\eta} - \sigma z, \quad v = z^{p}"
        values = {
            "p": self.p,
            "a": self.a,
            r"\mu": self.mu,
            r"\eta": self.eta,
            r"\sigma": self.sigma,
        }
        return [equation, *latex.rows(values)]


def square_root(value: sp.Expr) -> sp.Expr:
    """Square root of a rational expression in positive quantities, squares taken out."""
    # SymPy takes squares of positive symbols out of a root.
    plain, back = sp.posify(value)
    numerator, denominator = sp.fraction(plain)
    root = power(numerator, sp.S.Half) / power(denominator, sp.S.Half)
    return root.xreplace(back)
