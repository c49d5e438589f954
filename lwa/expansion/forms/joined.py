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
approximant of its own series, exact in ln 2, π, ζ(3) and ψ₁(1/3).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache, reduce
from typing import Any

import sympy as sp

from lwa.cell import k
from lwa.expansion.observables import equal_beads
from lwa.expansion.pulse import logarithm, power, product

EPSILON = sp.Symbol("epsilon", positive=True)
"""ε = k - 1."""

_T = sp.Symbol("t", positive=True)


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

ORDERS = {"strain": 1}
"""Highest power of ε from which φ is made, 2 unless it stands here: the strain's φ hardly changes,
and [0/1] is within 1e-3, [1/1] within 3e-3 (a pole at k = 10)."""

DIGITS = 60
"""Digits to which constants are evaluated."""


class Constant(sp.NumberSymbol):  # type: ignore[misc]  # untyped in SymPy
    """An exact number, evaluated once and to no more than `DIGITS`; printed by seven digits."""

    __slots__ = ("exact",)
    is_real = True

    def __new__(cls, exact: sp.Expr) -> Constant:
        self: Constant = sp.AtomicExpr.__new__(cls)
        self.exact = exact
        return self

    def __getnewargs__(self) -> tuple[sp.Expr]:
        return (self.exact,)

    def _hashable_content(self) -> tuple[sp.Expr]:
        return (self.exact,)

    __eq__ = sp.Basic.__eq__
    __hash__ = sp.Basic.__hash__

    def _eval_is_positive(self) -> bool:
        return bool(_digits(self.exact) > 0)

    def _as_mpf_val(self, precision: int) -> Any:
        return _digits(self.exact)._to_mpmath(precision)._mpf_

    def _sympystr(self, printer: Any) -> str:
        return str(_digits(self.exact).evalf(7))

    _latex = _sympystr


@lru_cache(maxsize=256)
def _digits(exact: sp.Expr) -> sp.Float:
    return exact.evalf(DIGITS)


@lru_cache(maxsize=16)
def joined(quantity: str) -> sp.Expr:
    """The closed form of a quantity of `TWO_BODIES` as a function of the symbol k."""
    limit = TWO_BODIES[quantity]
    epsilon = k - 1
    rest = sp.exp(-epsilon * phi(quantity).subs(EPSILON, epsilon))
    if quantity == "c":
        return limit * (1 + (1 / limit.subs(k, 1) - 1) * rest)
    return sp.sqrt(limit**2 + _SQUARED[quantity] * rest / epsilon)


@lru_cache(maxsize=16)
def phi(quantity: str) -> sp.Expr:
    """The Padé approximant of φ, a function of `EPSILON`."""
    return pade(phi_series(quantity, ORDERS.get(quantity, 2)), 1)


@lru_cache(maxsize=32)
def phi_series(quantity: str, order: int) -> tuple[sp.Expr, ...]:
    """Exact coefficients of φ up to ε^order, order ≤ 2.

    >>> phi_series("momentum", 0)
    (1.259859,)
    """
    series = list(equal_beads(quantity, order + 1))
    function = TWO_BODIES[quantity].subs(k, 1 + EPSILON)
    function = function.replace(sp.betainc_regularized, _arcs)
    taylor = _taylor(function, order + (quantity == "c"))
    limit = [_constant(sp.expand(term)) for term in taylor]
    if quantity == "c":
        rest = product(series, reciprocal(limit))
        rest[0] -= 1
        rest = [term / rest[0] for term in rest]
    else:
        rest = product(series, series)
        for n, term in enumerate(product(limit, limit)):
            rest[n + 1] -= term / _SQUARED[quantity]
    return tuple(_constant(-term) for term in logarithm(rest)[1:])


def reciprocal(series: Sequence[sp.Expr]) -> list[sp.Expr]:
    """The reciprocal of a series."""
    first = series[0]
    scaled = [term / first for term in series]
    return [term / first for term in power(scaled, sp.Integer(-1))]


def pade(series: Sequence[sp.Expr], n: int) -> sp.Expr:
    """The Padé approximant in `EPSILON` with n powers in its denominator, to all terms given.

    The product of the series and the denominator has no terms of the n highest orders.
    """
    a = list(map(_constant, series))
    top = len(a) - n
    rows = sp.Matrix(n, n, lambda i, j: a[top + i - j - 1])
    denominator = [sp.S.One, *rows.LUsolve(-sp.Matrix(a[top:]))]
    numerator = []
    for i in range(top):
        terms = [denominator[j] * a[i - j] for j in range(min(i, n) + 1)]
        numerator.append(sp.Add(*terms))
    return _polynomial(numerator) / _polynomial(denominator)


def _polynomial(coefficients: Sequence[sp.Expr]) -> sp.Expr:
    """The polynomial in `EPSILON` with these coefficients, each a constant."""
    return sp.Add(*(_constant(a) * EPSILON**n for n, a in enumerate(coefficients)))


def _constant(value: sp.Expr) -> sp.Expr:
    """A number that is evaluated once, unless it is rational."""
    if value.is_Rational:
        return value
    return Constant(value)


def _taylor(function: sp.Expr, order: int) -> list[sp.Expr]:
    """Taylor coefficients in ε of a function at ε = 0; of sums and products, from their parts."""
    constant = [sp.S.One] + [sp.S.Zero] * order
    if not function.has(EPSILON):
        return [function * term for term in constant]
    if function.is_Add:
        parts = [_taylor(part, order) for part in function.args]
        return [sp.Add(*terms) for terms in zip(*parts, strict=True)]
    if function.is_Mul:
        parts = [_taylor(part, order) for part in function.args]
        return reduce(product, parts, constant)
    terms = []
    for n in range(order + 1):
        slope = function.subs(EPSILON, 0).replace(sp.Integral, _moment)
        terms.append(slope / sp.factorial(n))
        function = function.diff(EPSILON)
    return terms


def _arcs(a: sp.Expr, b: sp.Expr, low: sp.Expr, x: sp.Expr) -> sp.Expr:
    """I_x(a, ½) as a ratio of integrals of sin^{2a-1}, by t = sin²."""
    arc = sp.sin(_T) ** sp.cancel(2 * a - 1)
    part = sp.Integral(arc, (_T, 0, sp.asin(sp.sqrt(x))))
    return part / sp.Integral(arc, (_T, 0, sp.pi / 2))


def _moment(integrand: sp.Expr, limits: sp.Tuple) -> sp.Expr:
    """The integral of a polynomial in ln sin t of degree ≤ 2 from 0 to π/6 or π/2.

    With ℓ = ln(2 sin t): ∫ ℓ = -Cl₂(π/3)/2 and ∫ ℓ² = 7π³/216 up to π/6, 0 and π³/24 up to π/2;
    Clausen's Cl₂(π/3) = (ψ₁(1/3) - 2π²/3)/(2√3). A test holds them against exact waves.
    """
    end = limits[2]
    clausen = (sp.polygamma(1, sp.Rational(1, 3)) - 2 * sp.pi**2 / 3) / (2 * sp.sqrt(3))
    moments = {
        sp.pi / 6: (-clausen / 2, 7 * sp.pi**3 / 216),
        sp.pi / 2: (0, sp.pi**3 / 24),
    }
    first, second = moments[end]
    shifted = integrand.subs(sp.log(sp.sin(_T)), _T - sp.log(2))
    values = {0: end, 1: first, 2: second}
    return sp.Add(*(c * values[n] for (n,), c in sp.Poly(shifted, _T).terms()))
