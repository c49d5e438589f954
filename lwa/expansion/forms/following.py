"""Light beads that follow: a dimer whose light bead stands midway between its heavy neighbours.

Rayleigh's reduction holds the light bead midway and keeps its kinetic energy. What is left is a
chain of heavy beads at the distance 2D with contacts of stiffness A/2^k, whose inertia depends on
the wavenumber q per heavy bead, m1 + m2 cos²(q/2): c² r = S r^k with::

    S = (sin(q/2)/(q/2))² / (1 + ω cos²(q/2)),    ω = m2/m1.

Small spheres between large ones as a chain of two-body collisions with other masses and contacts:
Harbola, Rosas, Romero & Lindenberg, arXiv:1005.0852.

The recursion of `lwa.expansion.recursion` runs on this chain. Its series in ε diverges early for
ω > 0 (S has poles at cos²(q/2) = -1/ω), but its first order in ω sums well: quantities of the chain
of heavy beads are multiplied by::

    (1 + ω)^{-e(ε)},    e = -d ln Q/dω at ω = 0,

with the Padé approximant [2/2] of e's exact series, within 0.02 of e up to k = 3. For k ≤ 3/2 this
is as near to the lattice as the reduced chain itself. Spheres: ``c² = 1.63992 (1 + ω)^{-0.9213}``,
and the width of the force is ``2.82386 (1 + ω)^{-0.6759}`` sites.
"""

from __future__ import annotations

from functools import lru_cache

import sympy as sp
from flint import fmpq_mpoly

from lwa.cell import Cell, k
from lwa.expansion.forms.joined import EPSILON, pade, polynomial, taylor
from lwa.expansion.observables import Observables, shares_model
from lwa.expansion.recursion import Fields, Recursion

ORDER = 4
"""Order in ε of e, which gives its approximant [2/2]."""

_OMEGA = sp.Symbol("omega", positive=True)

_LEADING = {"c": sp.S.Half, "momentum": sp.S.One}
"""e at k = 1: c² goes as 1/(1 + ω); a quantity that is not named goes as √I, I ∝ (1 + ω)^{-3}."""


class FollowingRecursion(Recursion):
    """The recursion of a dimer whose second bead is held midway between its neighbours.

    Both contacts of the bead have one strain, the mean of their forces is the fields' force, and
    half of the bead's inertia acts on each neighbour. The stiff tie takes m̂_2² from I, the elastic
    energy of unlike strains.
    """

    def _dispersion(self) -> fmpq_mpoly:
        return super()._dispersion() - self.mu[1] ** 2

    def _next_force(self, fields: Fields, i: int, n: int) -> fmpq_mpoly:
        return fields.force[0].series[n]

    def _last_force(self, fields: Fields, n: int) -> fmpq_mpoly:
        return super()._last_force(fields, n) + self._inertia(fields, 1, n) / 2


@lru_cache(maxsize=1)
def following(order: int) -> Observables:
    """The quantities of the reduced chain of masses 1 and ω, to this order in ε."""
    model = shares_model(Cell((1, _OMEGA)), sp.S.One)
    return Observables(FollowingRecursion(model, order))


@lru_cache(maxsize=16)
def exponent_of_light_beads(quantity: str) -> sp.Expr:
    """The exponent e of a quantity as a function of the symbol k."""
    coefficients = following(ORDER).coefficients(quantity)
    series = polynomial(coefficients)
    log_change = series.diff(_OMEGA) / series
    e = _LEADING.get(quantity, sp.Rational(3, 2)) - log_change.subs(_OMEGA, 0)
    return pade(taylor(e, ORDER), 2).subs(EPSILON, k - 1)
