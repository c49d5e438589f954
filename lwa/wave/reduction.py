"""The reduction of the strain's equation by v = z^p to z'' = μ z^η - σ z (Porter et al. 2008)."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from lwa.algebra.jets import JetAlgebra, Monomial
from lwa.algebra.partition import number
from lwa.base import latex
from lwa.base.frozen import Value


def strain_equation(p: sp.Expr, G: sp.Expr, H: sp.Expr, I: sp.Expr) -> dict[str, sp.Expr]:
    """The equation of z, v = z^p, as the coefficients of its monomials in r_n = ∂^n z / z.

    V² z^p p r_1 = z^{kp} (linear · r_1 + cubic · r_1³ + product · r_1 r_2 + third · r_3),
    derived in the algebra of the jets of z.
    """
    given = (p, G, H, I)
    jets = JetAlgebra(("p", "G", "H", "I"), weight=3)
    p_, G_, H_, I_ = jets.context.gens()[:4]
    v = [jets.one]
    for _ in range(3):
        v.append(jets.dx(v[-1], p_))  # v_n = ∂^n (z^p) / z^p
    found = jets.terms(v[1] + G_ * v[1] ** 3 + H_ * v[1] * v[2] + I_ * v[3])
    monomials = {
        "linear": ((1, 1),),
        "cubic": ((1, 3),),
        "product": ((1, 1), (2, 1)),
        "third": ((3, 1),),
    }
    return {
        name: sp.Add(
            *(number(c) * sp.Mul(*map(sp.Pow, given, e)) for e, c in found[Monomial(monomial)])
        )
        for name, monomial in monomials.items()
    }


@dataclass(frozen=True)
class Reduction(Value):
    """The reduction of the strain's equation to z'' = μ z^η - σ z for one root p (speed V)."""

    k: sp.Expr
    I: sp.Expr
    p: sp.Expr
    a: sp.Expr
    V: sp.Expr

    def latex_rows(self) -> list[str]:
        names = {"p": self.p, "a": self.a, r"\mu": self.mu, r"\eta": self.eta}
        names[r"\sigma"] = self.sigma
        return [r"z'' = \mu z^{\eta} - \sigma z, \quad v = z^{p}", *latex.rows(names)]

    @property
    def mu(self) -> sp.Expr:
        """μ = V² / (I (p + a))."""
        return self.V**2 / (self.I * (self.p + self.a))

    @property
    def eta(self) -> sp.Expr:
        """η = 1 + p - kp."""
        return 1 + self.p - self.k * self.p

    @property
    def sigma(self) -> sp.Expr:
        """σ = 1 / (I (kp + a))."""
        return 1 / (self.I * (self.k * self.p + self.a))

    @property
    def s(self) -> sp.Expr:
        """s = 2 / (1 - η), the power of the cosine in z."""
        return 2 / (1 - self.eta)

    @property
    def beta(self) -> sp.Expr:
        """β = √σ (1 - η) / 2, the paper's form; equal to `TravelingWave.beta` for either root."""
        return sp.sqrt(self.sigma) * (1 - self.eta) / 2

    @property
    def B(self) -> sp.Expr:
        """B = (μ / (β² s (s-1)))^{1/(k-1)}, the paper's form of `TravelingWave.amplitude`."""
        ratio = self.mu / (self.beta**2 * self.s * (self.s - 1))
        return ratio ** (1 / (self.k - 1))
