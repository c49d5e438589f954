"""Closed forms for the wave of equal beads, joined from its limits k → 1 and k → ∞.

Units: mass of a bead, A, D and the peak contact force are 1; ε = k - 1.

**k → ∞.** Two beads collide at a time, and the wave of this two-body problem becomes exact: with
a = 1/(k+1) it has::

    c₂ = 2 Γ(½ + a)/(√(π (k+1)) Γ(1 + a)),    W₂ = 2 [1 - I_x(a, ½)],

the momentum 2/√(k+1), the energy 2/(k+1) and a velocity as wide as a site. (The velocity δ'
of the compression δ falls from v = 2/√(k+1), δ'² = v² (1 - δ^{k+1}); the next contact closes when
this one is pressed most, so that a site takes the time ∫_0^1 dδ/δ', half of a collision. W₂ is the
part of the two sites in which δ exceeds x^{1/(k+1)}: x = 2^{-(k+1)/k} for half of the force,
2^{-(k+1)} for half of the strain.) The error falls as 4^{-k}. Collisions of two beads at a time
describe pulses of spheres, too: Harbola, Rosas, Esposito & Lindenberg, arXiv:0905.4512. The limit
of high energies in other chains: arXiv:1511.00836.

**k → 1.** The series in ε of `lwa.expansion.expand`.

**Joined** by the logarithm of the part that two bodies leave out::

    c = c₂ [1 + (1/c₂(1) - 1) e^{-ε φ(ε)}],    Q² = Q₂² + q e^{-ε φ(ε)}/ε,

Q a width, the momentum or the energy, and √(q/ε) the first term of its series. φ is a Padé
approximant of its own series, which follows from that of the quantity. Its decimals are computed,
so that the closed forms hold nothing that was fitted.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache, partial

import mpmath
import sympy as sp

from lwa.cell import k
from lwa.expansion.observables import equal_beads

EPSILON = sp.Symbol("epsilon", positive=True)
"""ε = k - 1."""

DIGITS = 30
"""Digits in which coefficients are computed."""

SHOWN = 11
"""Digits of the coefficients in a closed form: they change no quantity by more than 1e-12."""


def _width(x: sp.Expr) -> sp.Expr:
    """The part of a collision, two sites, in which the strain exceeds x^{1/(k+1)}."""
    return 2 * (1 - sp.betainc_regularized(1 / (k + 1), sp.S.Half, 0, x))


_STRAIN = 2 ** (-(k + 1))
_FORCE = 2 ** (-(k + 1) / k)

TWO_BODIES: dict[str, sp.Expr] = {
    "c": 2
    * sp.gamma(sp.S.Half + 1 / (k + 1))
    / (sp.sqrt(sp.pi * (k + 1)) * sp.gamma(1 + 1 / (k + 1))),
    "strain": _width(_STRAIN),
    "force": _width(_FORCE),
    "velocity": sp.S.One,
    "momentum": 2 / sp.sqrt(k + 1),
    "energy": 2 / (k + 1),
}
"""Quantities of the wave in the limit k → ∞, functions of k."""

_SQUARED = {
    "strain": sp.log(2) * 4 / 3,
    "force": sp.log(2) * 4 / 3,
    "velocity": sp.log(2) * 4 / 3,
    "momentum": sp.pi / 3,
    "energy": sp.pi / 6,
}
"""The q of the quantities that grow as √(q/ε): 16 I ln 2, 4πI and 2πI with I = 1/12."""

_REGULARIZED = {"betainc_regularized": partial(mpmath.betainc, regularized=True)}
"""I_x(a, b) for `sympy.lambdify`, which takes the integral that is not divided by B(a, b)."""

ORDERS = {"strain": 1}
"""Highest power of ε from which φ is made, 2 unless it stands here: the strain's φ hardly changes,
and [0/1] is within 1e-3, [1/1] within 3e-3 (a pole at k = 10)."""


@lru_cache(maxsize=16)
def joined(quantity: str) -> sp.Expr:
    """The closed form of a quantity of `TWO_BODIES` as a function of the symbol k."""
    limit = TWO_BODIES[quantity]
    epsilon = k - 1
    rest = sp.exp(-epsilon * phi(quantity).subs(EPSILON, epsilon))
    if quantity == "c":
        return limit * (1 + (1 / limit.subs(k, 1) - 1) * rest)
    return sp.sqrt(limit**2 + _SQUARED[quantity] * rest / epsilon)


def phi(quantity: str) -> sp.Expr:
    """The Padé approximant of φ, a function of `EPSILON`."""
    return pade(phi_series(quantity, ORDERS.get(quantity, 2)), 1)


def phi_series(quantity: str, order: int) -> list[mpmath.mpf]:
    """Coefficients of φ up to ε^order, to `DIGITS` digits.

    >>> [round(float(term), 6) for term in phi_series("momentum", 1)]
    [1.259859, -0.0647]
    """
    limit = TWO_BODIES[quantity].subs(k, 1 + EPSILON)
    whole = polynomial(equal_beads(quantity, order + 1))
    if quantity == "c":
        rest = (whole / limit - 1) / (1 / limit.subs(EPSILON, 0) - 1)
    else:
        rest = whole**2 - EPSILON * limit**2 / _SQUARED[quantity]
    return taylor(-sp.log(rest), order + 1)[1:]  # the first one is ln 1


def polynomial(coefficients: Iterable[sp.Expr]) -> sp.Expr:
    """The polynomial in `EPSILON` with these coefficients."""
    return sp.Add(*(a * EPSILON**n for n, a in enumerate(coefficients)))


def taylor(function: sp.Expr, order: int) -> list[mpmath.mpf]:
    """Taylor coefficients at ε = 0 of a function of `EPSILON`, to `DIGITS` digits."""
    with mpmath.workdps(DIGITS):
        numeric = sp.lambdify(EPSILON, function, [_REGULARIZED, "mpmath"])
        return list(mpmath.taylor(numeric, 0, order))


def pade(terms: Sequence[mpmath.mpf], n: int) -> sp.Expr:
    """The Padé approximant of a series with n powers of `EPSILON` in its denominator."""
    with mpmath.workdps(DIGITS):
        parts = mpmath.pade(terms, len(terms) - 1 - n, n)
        top, bottom = (map(_decimal, part) for part in parts)
        return polynomial(top) / polynomial(bottom)


def _decimal(value: mpmath.mpf) -> sp.Expr:
    """A number rounded to `SHOWN` digits."""
    return sp.Float(mpmath.nstr(value, SHOWN))
