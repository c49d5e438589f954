"""Dimers without a series of their own: light beads that follow, and beads that are nearly alike.

**Light beads that follow.** Rayleigh's reduction holds the light bead midway between its heavy
neighbours and keeps its kinetic energy. What is left is a chain of heavy beads at the distance 2D
with contacts of stiffness ``A/2^k``, whose inertia depends on the wavenumber q per heavy bead,
``m1 + m2 cos²(q/2)``, so that ``c² r = S r^k`` with::

    S = (sin(q/2)/(q/2))² / (1 + ω cos²(q/2)),    ω = m2/m1.

Small spheres between large ones as a chain of two-body collisions with other masses and contacts:
Harbola, Rosas, Romero & Lindenberg, arXiv:1005.0852.

The recursion of `lwa.expansion.recursion` runs on this chain. Its series in ε diverges early for
ω > 0 (S has poles where ``cos²(q/2) = -1/ω``), but its first order in ω sums well: quantities of
the chain of heavy beads are multiplied by ``(1 + ω)^{-e(ε)}``, where e is ``-d ln Q/dω`` at ω of 0,
with the Padé approximant [2/2] of e's exact series, within 0.02 of e up to k of 3. Up to 3/2 this
is as near to the lattice as the reduced chain itself. Spheres: ``c² = 1.63992 (1 + ω)^{-0.9213}``,
and the width of the force is ``2.82386 (1 + ω)^{-0.6759}`` sites.

**Errors** were measured on the pulses of 400 struck chains at k from 1.1 to 4 and m2/m1 from 0.01
to 1, whose speeds and widths are known to 1e-6.
"""

from __future__ import annotations

import math
from functools import lru_cache

import mpmath
import numpy as np
import sympy as sp
from flint import fmpq_mpoly

from lwa.cell import Cell, k
from lwa.expansion.joined import EPSILON, decimals, pade, power_series, taylor
from lwa.expansion.observables import Observables, equal_beads, shares_model
from lwa.expansion.recursion import Recursion

ORDER = 4
"""Order in ε of e, which gives its approximant [2/2]."""

ALIKE = 0.75
"""Least m2/m1 from which on unlike beads have the pulse of equal beads of the mean mass."""

LIGHT = sp.Rational(1, 10**14)
"""A mass ratio near 0, at which e is a quotient of differences with an error as small."""

# At k = 1, c² goes as 1/(1 + ω), and I as (1 + ω)^{-3}.
_LEADING = {"c": 0.5, "momentum": 1.0}
"""e in the limit of k to 1; a quantity that is not named goes as ``√I``."""


class FollowingRecursion(Recursion):
    """The recursion of a dimer whose second bead is held midway between its neighbours.

    Both contacts of the bead have one strain, the mean of their forces is the fields' force, and
    half of the bead's inertia acts on each neighbour.
    """

    def _dispersion(self) -> fmpq_mpoly:
        # The stiff tie takes m̂_2² from I, the elastic energy of unlike strains.
        return super()._dispersion() - self.mu[1] ** 2

    def _next_force(self, i: int, n: int) -> fmpq_mpoly:
        # in the equations both contacts have the mean force
        return self.force[0].series[n]

    def _last_force(self, n: int) -> fmpq_mpoly:
        return super()._last_force(n) + self._inertia(1, n) / 2


@lru_cache(maxsize=1)
def _light() -> Observables:
    """The quantities of the reduced chain of masses 1 and `LIGHT`."""
    # k does not matter to the shares of equal contacts.
    model = shares_model(Cell((1, LIGHT)), sp.S.One)
    return Observables(FollowingRecursion(model, ORDER))


@lru_cache(maxsize=16)
def exponent_of_light_beads(quantity: str) -> sp.Expr:
    """The exponent e of a quantity as a function of the symbol k."""
    heavy = decimals(equal_beads(quantity, ORDER))
    light = decimals(_light().coefficients(quantity))
    leading = _LEADING.get(quantity, 1.5)

    def exponent(epsilon: mpmath.mpf) -> mpmath.mpf:
        """e, the leading term's, less d ln Q/dω of the series behind that term."""
        change = power_series(light, epsilon) / power_series(heavy, epsilon) - 1
        return leading - change / LIGHT

    return pade(taylor(exponent, ORDER), 2).subs(EPSILON, k - 1)


# --- errors -------------------------------------------------------------------------------------

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


def following_error(quantity: str, k_value: sp.Expr, ratio: sp.Expr) -> float:
    """Relative error by light beads that follow; NaN beyond the range of the measurement."""
    exponent = float(k_value)
    # Momentum and energy of struck dimers were not measured.
    if quantity not in _SIZES or exponent > _EXPONENTS[-1]:
        return math.nan
    power = np.interp(exponent, _EXPONENTS, _POWERS[quantity])
    # Sizes change by factors from one exponent to the next.
    log = np.interp(exponent, _EXPONENTS, np.log(_SIZES[quantity]))
    return float(np.exp(log) * float(ratio) ** power)


def alike_error(quantity: str, k_value: sp.Expr, ratio: sp.Expr) -> float:
    """Relative error by equal beads of the mean mass in place of nearly equal ones.

    Speed and widths of the contacts: in proportion to the contrast ``(1 - ω)²/(1 + ω)²``, from 1.05
    to 2 times the largest deviation at each k. A velocity's width differs from bead to bead by up
    to 0.32 (1 - ω) either way. NaN beyond the range of the measurement.
    """
    epsilon = float(k_value) - 1
    omega = float(ratio)
    # Curves over the largest deviations at each of `_EXPONENTS`
    sizes = {
        "c": 0.45 * epsilon / (epsilon + 0.25),
        "force": 5.5 * math.exp(-3.7 * epsilon) + 0.15,
        "strain": 5.2 * math.exp(-2.7 * epsilon) + 0.1,
    }
    if float(k_value) > _EXPONENTS[-1]:
        return math.nan
    # Each bead of the lattice has a width of its own, the closed form one for both.
    if quantity == "velocity":
        return 0.35 * (1 - omega)
    return sizes.get(quantity, math.nan) * ((1 - omega) / (1 + omega)) ** 2


def resonates(k_value: sp.Expr, ratio: sp.Expr) -> bool:
    """True if light beads resonate with the pulse of a struck chain, which then decays.

    As measured: the pulses of struck chains are not steady there.
    """
    return bool(k_value > 1.2 and 0.5 < ratio < ALIKE)
