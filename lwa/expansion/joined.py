"""Closed forms for the wave of equal beads, joined from its limits for small and large exponents.

Units: the mass of a bead, A, D and the peak contact force are 1; ``ε = k - 1``.

**Large k.** Two beads collide at a time, and the wave of this two-body problem becomes exact: with
``a = 1/(k+1)`` it has::

    c₂ = 2 Γ(½ + a)/(√(π (k+1)) Γ(1 + a)),    W₂ = 2 [1 - I_x(a, ½)],

the momentum ``2/√(k+1)``, the energy 2/(k+1) and a velocity as wide as a site. (The velocity of the
compression δ falls from ``v = 2/√(k+1)`` as ``v √(1 - δ^{k+1})``; the next contact closes when this
one is pressed most, so that a site takes half of a collision. W₂ is the part of the two sites in
which δ exceeds ``x^{1/(k+1)}``: ``x = 2^{-(k+1)/k}`` for half of the force, ``2^{-(k+1)}`` for half
of the strain.) The error falls as ``4^{-k}``. Collisions of two beads at a time describe pulses of
spheres, too: Harbola, Rosas, Esposito & Lindenberg, arXiv:0905.4512. The limit of high energies in
other chains: arXiv:1511.00836.

**k near 1.** The series in ε of `lwa.expansion.expand`.

**Joined** by the logarithm of the part that two bodies leave out::

    c = c₂ [1 + (1/c₂(1) - 1) e^{-ε φ(ε)}],    Q² = Q₂² + q e^{-ε φ(ε)}/ε,

Q a width, the momentum or the energy, and ``√(q/ε)`` the first term of its series. φ is a Padé
approximant of its own series, which follows from that of the quantity. Its decimals are computed,
so that the closed forms hold nothing that was fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
from typing import NamedTuple

import mpmath
import sympy as sp

from lwa.cell import k
from lwa.expansion.observables import equal_beads

EPSILON = sp.Symbol("epsilon", positive=True)
"""ε, the exponent less 1."""

DIGITS = 30
"""Digits in which coefficients are computed, from numbers that are exact."""

SHOWN = 11
"""Digits of the coefficients in a closed form, whose error is 1e-12 at k of 1.01."""


def _width(x: sp.Expr) -> sp.Expr:
    """The sites that a wave passes while a contact's strain exceeds ``x^{1/(k+1)}`` of its peak.

    For large k a wave is one collision of two beads after another, each of which takes two sites:
    ``(dδ/dt)² ~ 1 - δ^{k+1}``. With ``y = δ^{k+1}`` the time is an incomplete beta function of y.
    """
    return 2 * (1 - sp.betainc_regularized(1 / (k + 1), sp.S.Half, 0, x))


# √π over the time ∫_0^1 dδ/√(1 - δ^{k+1}), a beta function of 1/(k+1) and ½
_SPEED = sp.gamma(sp.S.Half + 1 / (k + 1)) / sp.gamma(1 + 1 / (k + 1))
# δ^{k+1} where the strain, or the force δ^k, is half of its peak
_STRAIN = 2 ** (-(k + 1))
_FORCE = 2 ** (-(k + 1) / k)


class Form(NamedTuple):
    """How the two limits of a quantity are joined, and the error that is left.

    Attributes
    ----------
    two_bodies : sympy.Expr
        The quantity in the limit of large k, a function of k.
    growth : sympy.Expr or None
        The q of a quantity that grows as ``√(q/ε)`` near k of 1; None for the speed, which is
        finite in both limits.
    defect : float
        Size of the first term that εφ leaves out, over its power of ε: 1.1 times the least that
        covers the difference to exact waves at 66 values of k from 1.01 to 60.
    order : int
        Highest power of ε from which φ is made.
    damping : int
        The power of 1/(1 + ε) by which that term is less at large k.
    most : float
        Largest relative error at any k > 1.
    """

    two_bodies: sp.Expr
    growth: sp.Expr | None
    defect: float
    order: int = 2
    damping: int = 2
    most: float = 1e-3


# Widths of the Gaussian e^{-Z²/4} are 4 √(I ln 2/ε), its momentum 2 √(πI/ε), its energy √(2πI/ε);
# I = 1/12.
_GAUSSIAN = sp.log(2) * 4 / 3

FORMS = {
    "speed": Form(
        2 * _SPEED / sp.sqrt(sp.pi * (k + 1)),
        growth=None,
        defect=0.0046,
        most=1e-5,
    ),
    # The strain's φ hardly changes: [0/1] is within 1e-3, [1/1] within 3e-3 (a pole at k of 10).
    # The errors of strain and velocity fall as 2^{-k}, all others as 4^{-k}.
    "strain": Form(
        _width(_STRAIN),
        _GAUSSIAN,
        defect=0.0135,
        order=1,
        damping=1,
    ),
    "force": Form(
        _width(_FORCE),
        _GAUSSIAN,
        defect=0.072,
    ),
    "velocity": Form(
        sp.S.One,
        _GAUSSIAN,
        defect=0.003,
        damping=1,
    ),
    "momentum": Form(
        2 / sp.sqrt(k + 1),
        sp.pi / 3,
        defect=0.0115,
    ),
    "energy": Form(
        2 / (k + 1),
        sp.pi / 6,
        defect=0.008,
    ),
}
"""The quantities of the wave, each with its closed form and the error of this form."""

_REGULARIZED = {"betainc_regularized": partial(mpmath.betainc, regularized=True)}
"""I_x(a, b) for `sympy.lambdify`, which takes the integral that is not divided by B(a, b)."""


@cache
def joined(quantity: str) -> sp.Expr:
    """The closed form of a quantity of `FORMS` as a function of the symbol k."""
    form = FORMS[quantity]
    limit = form.two_bodies
    epsilon = k - 1
    phi = pade(phi_series(quantity, form.order), 1)
    rest = sp.exp(-epsilon * phi.subs(EPSILON, epsilon))
    if form.growth is None:
        return limit * (1 + (1 / limit.subs(k, 1) - 1) * rest)
    return sp.sqrt(limit**2 + form.growth * rest / epsilon)


def phi_series(quantity: str, order: int) -> list[mpmath.mpf]:
    """Coefficients of the powers of ε in φ, up to this order, to `DIGITS` digits.

    >>> [round(float(term), 6) for term in phi_series("momentum", 1)]
    [1.259859, -0.0647]
    """
    form = FORMS[quantity]
    limit = form.two_bodies
    # The quantity over its leading term, √(q/ε) or 1
    whole = sp.Symbol("whole")
    # The closed form of the quantity (see the module), solved for the exponential e^{-εφ}
    if form.growth is None:
        rest = (whole / limit - 1) / (1 / limit.subs(k, 1) - 1)
    else:
        rest = whole**2 - (k - 1) * limit**2 / form.growth
    numeric = sp.lambdify((k, whole), rest, [_REGULARIZED, "mpmath"])
    # The series in ε of the quantity over its leading term
    series = decimals(equal_beads(quantity, order + 1))

    def exponent(epsilon: mpmath.mpf) -> mpmath.mpf:
        """The exponent εφ."""
        # At k = 1 + ε the sum of the series is `whole`, and of it `numeric` makes the rest e^{-εφ}.
        return -mpmath.log(numeric(1 + epsilon, power_series(series, epsilon)))

    # εφ has no constant, as the rest is 1 at k = 1.
    return taylor(exponent, order + 1)[1:]


def decimals(values: Iterable[sp.Expr], digits: int = DIGITS) -> list[mpmath.mpf]:
    """Exact numbers to this many digits."""
    return [mpmath.mpmathify(sp.N(value, digits)) for value in values]


def power_series(coefficients: Sequence[mpmath.mpf], x: mpmath.mpf) -> mpmath.mpf:
    """The polynomial in x with these coefficients, that of ``x⁰`` first."""
    # mpmath's polynomials begin with the highest power.
    return mpmath.polyval(coefficients[::-1], x)


def taylor(
    function: Callable[[mpmath.mpf], mpmath.mpf], order: int
) -> list[mpmath.mpf]:
    """Taylor coefficients of a function at 0, to `DIGITS` digits."""
    # SymPy's derivatives of these functions take a hundred times as long.
    with mpmath.workdps(DIGITS):
        return list(mpmath.taylor(function, 0, order))


def pade(terms: Sequence[mpmath.mpf], n: int) -> sp.Expr:
    """The Padé approximant of a series with n powers of `EPSILON` in its denominator."""
    with mpmath.workdps(DIGITS):
        # numerator and denominator
        parts = []
        for coefficients in mpmath.pade(terms, len(terms) - 1 - n, n):
            part = sp.S.Zero
            for degree, value in enumerate(coefficients):
                part += sp.Float(mpmath.nstr(value, SHOWN)) * EPSILON**degree
            parts.append(part)
    return parts[0] / parts[1]


# --- errors -------------------------------------------------------------------------------------


def joined_error(quantity: str, k_value: sp.Expr) -> float:
    """Relative error of a quantity of equal beads, for every k > 1.

    The exponent εφ errs by at most ``defect ε^{order+2} / (1 + ε)^damping`` (measured, see
    `Form`). With Q₂ the limit of two bodies, an error x of the exponent changes the speed by the
    share ``|1 - Q₂/Q|`` of x, and a quantity whose square is joined by ``|1 - Q₂²/Q²|/2``.
    """
    form = FORMS[quantity]
    epsilon = float(k_value - 1)
    # ``Q = Q₂ + … e^{…}``: what Q₂ leaves is made by the exponential.
    whole = float(joined(quantity).subs(k, k_value))
    limit = float(form.two_bodies.subs(k, k_value))
    power = 2
    if form.growth is None:
        power = 1
    share = abs(1 - (limit / whole) ** power) / power
    left_out = form.defect * epsilon ** (form.order + 2)
    left_out /= (1 + epsilon) ** form.damping
    # The last digit of a float is rounded.
    return min(share * left_out, form.most) + 2**-52
