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

**Errors** are interpolated from the pulses of 864 struck chains at k from 1.1 to 60 and m2/m1 from
0.001 to 0.99, which stand in the file ``dimers.csv`` beside this module; at k of 1 deviations are
exact, from the dispersion of the linear chain. A pulse has the speed, and the widths of force and
strain, of `validation.pulses.steady` (``lwa-validate sweep``). Its momentum is ``∫ F dt`` and its
energy ``∫ F v dt`` at a contact, v the mean velocity of the two beads, up to 2.5 widths of the
strain behind the front. Its velocity is that of a heavy bead, and of both beads where these are
nearly alike.
"""

from __future__ import annotations

import math
from functools import cache
from importlib.resources import files

import mpmath
import numpy as np
import sympy as sp
from flint import fmpq_mpoly

from lwa.base.arrays import Array
from lwa.cell import Cell, k
from lwa.expansion.joined import EPSILON, FORMS, decimals, pade, power_series, taylor
from lwa.expansion.observables import Observables, equal_beads, shares_model
from lwa.expansion.recursion import Recursion

ORDER = 4
"""Order in ε of e, which gives its approximant [2/2]."""

LIGHT = sp.Rational(1, 10**14)
"""A mass ratio near 0: e, a derivative by the ratio at 0, is a quotient of differences, between the
chains of the ratios 0 and `LIGHT`, with an error of about `LIGHT`."""

# At k = 1, c² goes as 1/(1 + ω), and I as (1 + ω)^{-3}; widths and the energy go as √I, the
# momentum as mass · c √I.
_LEADING = {"speed": 0.5, "momentum": 1.0}
"""e in the limit of k to 1; a quantity that is not named has 3/2, that of ``√I``."""


class FollowingRecursion(Recursion):
    """The recursion of a dimer whose second bead is held midway between its neighbours.

    Both contacts of the bead have one strain, the mean of their forces is the fields' force, and
    half of the bead's inertia acts on each neighbour.
    """

    def _dispersion(self) -> fmpq_mpoly:
        """The coefficient I of a dimer whose light bead is held midway.

        In a free dimer the two contacts of the light bead are strained unequally, which adds m̂_2²
        to I. A bead that is held midway strains both alike.
        """
        # mu[1] is m̂_2, the mass fraction of the light bead, the second of the cell.
        return super()._dispersion() - self.mu[1] ** 2

    def _next_force(self, i: int, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force of contact i: both contacts have the mean force."""
        return self.force[0].series[n]

    def _last_force(self, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force on the next cell, with half of the inertia of bead 1."""
        return super()._last_force(n) + self._inertia(1, n) / 2


@cache
def _light() -> Observables:
    """The quantities of the reduced chain of masses 1 and `LIGHT`, for derivatives at ratio 0."""
    # k does not matter to the shares of equal contacts.
    model = shares_model(Cell((1, LIGHT)), sp.S.One)
    return Observables(FollowingRecursion(model, ORDER))


@cache
def exponent_of_light_beads(quantity: str) -> sp.Expr:
    """The exponent e of a quantity as a function of the symbol k."""
    # Series in ε of the quantity over its leading term, at the mass ratios 0 and `LIGHT`
    heavy = decimals(equal_beads(quantity, ORDER))
    light = decimals(_light().coefficients(quantity))
    leading = _LEADING.get(quantity, 1.5)

    def exponent(epsilon: mpmath.mpf) -> mpmath.mpf:
        """The exponent e: the leading term's exponent, less d ln Q/dω of the rest of the series."""
        change = power_series(light, epsilon) / power_series(heavy, epsilon) - 1
        return leading - change / LIGHT

    return pade(taylor(exponent, ORDER), 2).subs(EPSILON, k - 1)


# --- errors -------------------------------------------------------------------------------------

ALIKE = 0.75
"""Least m2/m1 from which on unlike beads have the pulse of equal beads of the mean mass."""

MARGIN = 1.5
"""Ratio of an error to the deviation that is interpolated."""

SPREAD = 3.0
"""Ratio of an error to the standard deviation of the deviations that are interpolated.

Deviations swing with the light bead from one point of the grid to the next. With these two factors
729 speeds and widths of struck chains between the points of the grid are all covered, half of them
by errors up to 2.4 and nine of ten by errors up to 6.9 times the deviation; so are 156 numbers at k
from 12 to 55, half of them by errors up to 1.6 times the deviation.
"""


@cache
def _deviations() -> Array:
    """The file ``dimers.csv``: the closed forms' relative deviations from struck lattices.

    A row holds k, ``ω = m2/m1`` and six deviations, in the order of `FORMS`: of the speed, the
    widths of strain, force and velocity, the momentum and the energy of the leading pulse. Each is
    ``Q_lattice/Q_form - 1``, where ``Q_form`` is the closed form of a
    `lwa.expansion.lattice_wave.LatticeWave`: that of light beads that follow for ω below `ALIKE`,
    else that of equal beads of the mean mass. It is NaN if no pulse is steady.
    """
    text = files("lwa.expansion").joinpath("dimers.csv").read_text("utf-8")
    return np.loadtxt(text.splitlines(), delimiter=",", skiprows=1)


def _mean(values: Array, k_value: sp.Expr, ratio: sp.Expr) -> float:
    """The bilinear interpolation in k and m2/m1 of values, one for each row of the file.

    The rows go through all m2/m1 at one k after another.
    """
    exponents, ratios = map(np.unique, _deviations().T[:2])
    rows = values.reshape(len(exponents), -1)
    at_ratio = [np.interp(float(ratio), ratios, row) for row in rows]
    return float(np.interp(float(k_value), exponents, at_ratio))


def dimer_error(quantity: str, k_value: sp.Expr, ratio: sp.Expr) -> float:
    """Relative error of a closed form of dimers; NaN for k beyond the measurement."""
    rows = _deviations()
    # The last row has the largest k of the measurement.
    if k_value > rows[-1, 0]:
        return math.nan
    # Points without a steady pulse have no deviation: the mean is that over the other points.
    # A row begins with k and ω, and its deviations stand in the order of `FORMS`.
    own = np.nan_to_num(rows[:, 2 + list(FORMS).index(quantity)])
    weight = steadiness(k_value, ratio)
    mean = _mean(own, k_value, ratio) / weight
    square = _mean(own**2, k_value, ratio) / weight
    # Rounding may leave a negative difference.
    spread = math.sqrt(max(square - mean**2, 0))
    return MARGIN * abs(mean) + SPREAD * spread


def steadiness(k_value: sp.Expr, ratio: sp.Expr) -> float:
    """Share of steady pulses of struck chains about a point.

    The points of the grid have the share 1, or 0 where the pulse decays, as light beads resonate;
    between these points the share is interpolated.
    """
    # The speed's deviation, the first one, is NaN where no pulse is steady.
    return _mean(np.isfinite(_deviations()[:, 2]), k_value, ratio)
