"""Source text of programs for the lattice's own wave, in elementary functions.

Γ and the incomplete beta function, which some languages lack, are written out to 1e-8, for a in
(0, ½] and x ≤ ½. With R(a) = Γ(a + ½)/Γ(a + 1), one step up takes R(a) to R(a) (a + ½)/(a + 1), and
R(z) = w^{-1/2} (1 - 1/(64 w²) + 21/(8192 w⁴) - …), w = z + ¼, far up;

    I_x(a, ½) = a R(a) x^a/√π Σ_j C(2j, j) (x/4)^j / (a + j).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from lwa.base.words import LanguageName
from lwa.wave.source import Functions, module

TITLE = (
    "The lattice's own solitary wave, written by lwa: exact to 1e-5 (speed) and",
    "1e-3 for equal beads at every k > 1. Peak contact force F, lengths in units of D.",
)

STEPS = 8
"""Steps up to R(z): the next term of the expansion is 2e-9 there."""

TERMS = 24
"""Terms of the sum of the incomplete beta function: 2^-24 is 6e-8, over √(24 π) · 24."""


DOCS = {
    "speed": "dx/dt",
    "fwhm_strain": "Full width at half maximum of the strain",
    "fwhm_force": "Full width at half maximum of the force",
    "fwhm_velocity": "Full width at half maximum of the velocity",
    "momentum": "Momentum of the chain",
    "energy": "Kinetic and elastic energy of the chain",
}
"""Functions of a program, and their comments."""


def source(
    values: Mapping[str, sp.Expr], arguments: Sequence[sp.Expr], language: LanguageName
) -> str:
    """Write functions in a language.

    Parameters
    ----------
    values : mapping of str to sympy.Expr
        Values of the functions of `DOCS`.
    arguments : sequence of sympy.Expr
        Expressions whose symbols are arguments, in their order.
    language : {"numpy", "c", "javascript"}
        The language.
    """
    functions = Functions(*arguments)
    for name, doc in DOCS.items():
        functions.define(name, doc, _elementary(values[name]))
    return module([*functions.values()], language, TITLE)


def _elementary(value: sp.Expr) -> sp.Expr:
    """An expression without Γ and the incomplete beta function."""
    for gamma in value.atoms(sp.gamma):
        a = gamma.args[0] - 1
        if value.has(sp.gamma(a + sp.S.Half)):
            ratio = _ratio(a)
            value = value.subs(sp.gamma(a + sp.S.Half), ratio).subs(gamma, 1)
    return value.replace(sp.betainc_regularized, _beta)


def _ratio(a: sp.Expr) -> sp.Expr:
    """R(a)."""
    w = a + STEPS + sp.Rational(1, 4)
    ratio = (1 - 1 / (64 * w**2) + 21 / (8192 * w**4)) / sp.sqrt(w)
    for j in range(STEPS):
        ratio *= (a + j + 1) / (a + j + sp.S.Half)
    return ratio


def _beta(a: sp.Expr, b: sp.Expr, low: sp.Expr, x: sp.Expr) -> sp.Expr:
    """I_x(a, ½)."""
    total = sp.S.Zero
    for j in range(TERMS):
        total += sp.binomial(2 * j, j) * (x / 4) ** j / (a + j)
    return a * _ratio(a) * x**a / sp.sqrt(sp.pi) * total
