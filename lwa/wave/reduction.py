"""The paper's reduction of the wave's equation to an oscillator, ``z'' = μ z^η - σ z``.

Let ``v = u_ξ`` be the strain of a traveling wave and ``r_n = ∂^n z / z``. The substitution
``v = z^p``, p a root of::

    (G + H + I) p² - (H + 3I) p + 2I = 0,

removes r_1³ from the third-order equation of v (`lwa.wave.compact`). There remains::

    V² z^p r_1 = z^{kp} (r_1 + I r_3 + I q r_1 r_2),    q = 3 (p - 1) + p H/I.

Since ``∂(z^e r_2) = z^e (r_3 + (e - 1) r_1 r_2)``, the integrating factor ``z^a`` with
``kp + a = q + 1`` makes the equation a total derivative, whose integral is the oscillator (Porter
et al. 2008).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import factored, power
from lwa.base.frozen import Value


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

    @classmethod
    def of(
        cls, p: sp.Expr, k: sp.Expr, I: sp.Expr, H_over_I: sp.Expr, V: sp.Expr
    ) -> Self:
        """Return the reduction of a wave of the speed ``V = dx/dτ`` by the root p."""
        a = factored(3 + H_over_I - k) * p - 2  # 1 - kp + 3 (p - 1) + p H/I
        eta = 1 + p - k * p
        return cls(
            p=p,
            a=a,
            mu=V**2 / (I * (p + a)),
            eta=eta,
            sigma=1 / (I * (k * p + a)),
            s=2 / (1 - eta),
        )

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


def roots(total: sp.Expr, H_over_I: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """The two roots p; ``total`` is (G + H + I)/I. The paper has the first root."""
    # A p² - B p + 2 = 0
    A = factored(total)
    B = factored(H_over_I + 3)
    root = square_root(factored(B**2 - 8 * A))
    # Any sign of the root will do, as both are returned.
    root = root.replace(sp.Abs, lambda x: x)
    first = (B - root) / (2 * A)
    second = (B + root) / (2 * A)
    return sp.together(first), sp.together(second)


def square_root(value: sp.Expr) -> sp.Expr:
    """Square root of a rational expression in positive quantities, squares taken out."""
    # SymPy takes squares of positive symbols out of a root.
    plain, back = sp.posify(value)
    numerator, denominator = sp.fraction(plain)
    root = power(numerator, sp.S.Half) / power(denominator, sp.S.Half)
    return root.xreplace(back)
