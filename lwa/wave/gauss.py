"""Gauss's rule and Legendre polynomials between two strains, and a law as functions of arrays.

What `quadrature` integrates and expands with: the rule on [0, 1], the coefficients of what has
given values at its points, and SymPy's expressions compiled without rounding their numbers twice.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import sympy as sp
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lwa.base.arrays import Array

Function = Callable[[Any], Any]

POINTS = 20
"""Of Gauss's rule between p0 and p0 + B, and of the expansions at its upper part."""

SMOOTH = 1e-13
"""Of the last coefficients of F′ over the first, where a law's singularities are not known."""

THETA = 0.9
"""Beyond the θ of any half maximum: arcosh √2 = 0.881 for the strain, less for the force."""

DEEPEST = 0.55
"""y² at that θ is 0.513: how far below p0 + B the expansions reach, over B."""


class Rule(NamedTuple):
    """Gauss's rule on [0, 1], and the last coefficients of a function given at its points."""

    s: Array
    w: Array
    tail: Array


@cache
def gauss(n: int = POINTS) -> Rule:
    """The rule of n points."""
    x, w = legendre.leggauss(n)
    tail = (legendre.legvander(x, n - 1) * (w[:, None] * (2 * np.arange(n) + 1) / 2))[:, -2:]
    return Rule((x + 1) / 2, w / 2, tail)


@cache
def fitted(n: int = POINTS) -> Array:
    """The matrix from values at Gauss's points to coefficients in Legendre polynomials."""
    rule = gauss(n)
    vander = legendre.legvander(2 * rule.s - 1, n - 1)
    return (vander * (rule.w[:, None] * (2 * np.arange(n) + 1))).T


@cache
def expansion(n: int = POINTS) -> tuple[Array, Array, Array]:
    """θ at Gauss's points below `THETA`; the two matrices of the module's last lines.

    From F″ at p1 - `DEEPEST` s_i B to ∫(1-s)² F″(p1 - s y_j² B) ds, and from values at the θ_j to
    the coefficients of their integral from 0, in Legendre polynomials of 2θ/`THETA` - 1.
    """
    rule = gauss(n)
    theta = THETA * rule.s
    coefficients = fitted(n)
    places = np.tanh(theta)[:, None] ** 2 * rule.s / DEEPEST
    values = legendre.legvander(2 * places - 1, n - 1)  # (j, s, coefficient)
    tails = np.einsum("s,jsc->jc", rule.w * (1 - rule.s) ** 2, values) @ coefficients
    integrals = legendre.legint(np.eye(n), lbnd=-1, axis=0) * THETA / 2
    return theta, tails, integrals @ coefficients


STRAIN = sp.Symbol("p", positive=True)
BLOCK = 1024


def root(slopes: Array, target: Array) -> Array:
    """θ at which what has these slopes at the θ_j, and grows from 0, reaches the target."""
    theta, _, integral = expansion()
    rises = slopes @ integral.T
    grid = legendre.legvander(2 * theta / THETA - 1, len(theta))
    values = np.pad(rises @ grid.T, ((0, 0), (1, 1)), mode="constant")
    places = np.concatenate([[0.0], theta, [THETA]])
    values[:, -1] = rises.sum(axis=1)  # P_n(1) = 1
    row, at = np.arange(len(values)), np.sum(values[:, 1:-1] < target[:, None], axis=1)
    low, high = values[row, at], values[row, at + 1]
    found = places[at] + (target - low) / (high - low) * (places[at + 1] - places[at])
    local = slopes @ fitted().T
    slope = np.ones_like(target)
    for i in range(3):  # Newton, the last slope kept
        x = 2 * found / THETA - 1
        slope = legendre.legval(x, local.T, tensor=False) if i < 2 else slope
        found = found - (legendre.legval(x, rises.T, tensor=False) - target) / slope
    return np.asarray(found)


def blocks(values: Array) -> list[Array]:
    """Pieces that stay in the processor's cache."""
    return [values[i : i + BLOCK] for i in range(0, len(values), BLOCK)]


def is_smooth(samples: Array, most: float = SMOOTH) -> NDArray[np.bool_]:
    """Whether the last coefficients of what has these values at Gauss's points are small."""
    tail = np.abs(samples @ gauss().tail).max(axis=-1)
    found: NDArray[np.bool_] = tail <= most * np.abs(samples).max(axis=-1)
    return found


def compiled(value: sp.Expr, extended: bool = False) -> Function:
    """A function of p in float64, or in NumPy's extended precision, that numbers enter exactly.

    Powers with an exponent that no float holds are corrected to first order.
    """
    number = np.longdouble if extended else np.float64
    given: dict[sp.Expr, Any] = {}

    def constant(x: sp.Expr) -> sp.Expr:
        symbol = sp.Dummy()
        given[symbol] = number(str(sp.N(x, 25)))
        return symbol

    def power(base: sp.Expr, e: sp.Expr) -> sp.Expr:
        rest = sp.N(e - sp.Rational(float(e)), 25)
        if extended or rest:
            parts = (e, sp.S.Zero) if extended else (sp.Rational(float(e)), rest)
            return sp.Function("_power")(base, *map(constant, parts))
        return base**e

    value = value.replace(
        lambda x: x.is_Pow and x.exp.is_number and x.base.free_symbols and not x.exp.is_Integer,
        lambda x: power(*x.as_base_exp()),
    )
    numbers = {x for x in value.atoms(sp.Number, sp.NumberSymbol) if not x.is_Integer}
    value = value.xreplace({x: constant(x) for x in numbers})
    modules = [{"_power": _extended_power if extended else _power}, "numpy"]
    function = sp.lambdify((STRAIN, *given), value, modules)

    def evaluated(p: Any) -> Any:
        result = function(p, *given.values())
        return result if isinstance(result, np.ndarray) else np.full_like(p, result)

    return evaluated


def _power(base: Array, high: float, low: float) -> Array:
    result: Array = base**high * (1 + low * np.log(np.where(base > 0, base, 1.0)))
    return result


def _extended_power(base: Any, e: Any, _: Any) -> Any:
    """A tenth of the time of NumPy's own."""
    return np.where(base > 0, np.exp(e * np.log(np.where(base > 0, base, 1.0))), base**0 * (e == 0))
