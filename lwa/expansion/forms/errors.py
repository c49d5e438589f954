"""Errors of the closed forms of `lwa.expansion.lattice_wave`, measured against the lattice.

Equal beads: against exact waves at 66 values of k = 1.01 … 60. Light beads that follow, and nearly
equal beads: against the pulses of 400 struck chains at k = 1.1 … 4 and m2/m1 = 0.01 … 1, whose
speeds and widths are known to 1e-6.
"""

from __future__ import annotations

import math

import numpy as np
import sympy as sp

from lwa.cell import k as symbol_k
from lwa.expansion.forms.joined import ORDERS, TWO_BODIES, joined

DEFECTS = {
    "c": 0.0046,
    "strain": 0.0135,
    "force": 0.072,
    "velocity": 0.003,
    "momentum": 0.0115,
    "energy": 0.008,
}
"""Size of the first term that εφ leaves out, over its power of ε: 1.1 times the least to cover."""

MOST = {"c": 1e-5}
"""Largest relative error at any k > 1; 1e-3 unless it stands here."""

SLOW = ("strain", "velocity")
"""Quantities whose error falls as 2^{-k}, not as 4^{-k}."""

_EXPONENTS = (1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0)
"""Values of k at which light beads that follow were measured."""

_POWERS = {
    "c": (2, 2.5, 2, 0.75, 0.5, 0.15, 0.15, 0.15),
    "force": (2, 2.5, 1.75, 1.5, 1.25, 0.25, 0.15, 0.15),
    "strain": (2, 2, 2, 1.5, 1, 0.5, 0.15, 0.5),
    "velocity": (2, 2, 2, 1.5, 1.5, 1, 1, 1),
}
"""Powers of m2/m1 in the error of light beads that follow, at `_EXPONENTS`."""

_SIZES = {
    "c": (0.006, 0.06, 0.23, 0.051, 0.072, 0.095, 0.16, 0.26),
    "force": (0.35, 2.4, 1.4, 2.3, 3.6, 2.1, 2.75, 7.0),
    "strain": (0.35, 1.2, 2.0, 1.15, 0.6, 0.38, 0.27, 1.5),
    "velocity": (0.35, 1.0, 1.7, 1.25, 1.4, 0.83, 0.87, 1.1),
}
"""Factors of these powers."""

ALIKE = 0.75
"""Least m2/m1 from which on unlike beads have the pulse of equal beads of the mean mass."""


def resonates(k: sp.Expr, ratio: sp.Expr) -> bool:
    """True if light beads resonate with the pulse of a struck chain, which then decays."""
    return bool(k > 1.2 and 0.5 < ratio < ALIKE)


def joined_error(quantity: str, k: sp.Expr) -> float:
    """Relative error of a quantity of equal beads, for every k > 1.

    The first term that the exponent εφ leaves out, divided by (1 + ε)² as the approximant goes on
    (1 + ε for those that fall slower), times the share of the exponential in the quantity.
    """
    epsilon = float(k - 1)
    whole = float(joined(quantity).subs(symbol_k, k))
    limit = float(TWO_BODIES[quantity].subs(symbol_k, k))
    power = 1 if quantity == "c" else 2
    share = abs(1 - (limit / whole) ** power) / power
    order = ORDERS.get(quantity, 2) + 2
    damping = 1 if quantity in SLOW else 2
    left_out = DEFECTS[quantity] * epsilon**order / (1 + epsilon) ** damping
    return min(share * left_out, MOST.get(quantity, 1e-3)) + 2**-52


def following_error(quantity: str, k: sp.Expr, ratio: sp.Expr) -> float:
    """Relative error by light beads that follow; NaN beyond the range of the measurement."""
    exponent = float(k)
    omega = float(ratio)
    if quantity not in _SIZES or exponent > _EXPONENTS[-1]:
        return math.nan
    power = np.interp(exponent, _EXPONENTS, _POWERS[quantity])
    log = np.interp(exponent, _EXPONENTS, np.log(_SIZES[quantity]))
    return float(np.exp(log) * omega**power)


def alike_error(quantity: str, k: sp.Expr, ratio: sp.Expr) -> float:
    """Relative error by equal beads of the mean mass in place of nearly equal ones.

    Speed and widths of the contacts: in proportion to the contrast (1 - ω)²/(1 + ω)², ω = m2/m1,
    from 1.05 to 2 times the largest deviation at each k. A velocity's width differs from bead to
    bead by up to ±0.32 (1 - ω). NaN beyond the range of the measurement.
    """
    epsilon = float(k) - 1
    omega = float(ratio)
    sizes = {
        "c": 0.45 * epsilon / (epsilon + 0.25),
        "force": 5.5 * math.exp(-3.7 * epsilon) + 0.15,
        "strain": 5.2 * math.exp(-2.7 * epsilon) + 0.1,
    }
    if float(k) > _EXPONENTS[-1]:
        return math.nan
    if quantity == "velocity":
        return 0.35 * (1 - omega)
    return sizes.get(quantity, math.nan) * ((1 - omega) / (1 + omega)) ** 2
