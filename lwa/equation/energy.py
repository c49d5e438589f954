"""Conserved quantities of the wave equation: momentum and energy.

Letters: D is the spacing, P the number of particles of a cell, m̂_i a mass fraction, C_i the strain
share of a contact; p = u_x is the strain, r_n = ∂_x^n p / p (`lwa.algebra.jets`); E_n, a polynomial
in the r_n, is the term of the wave equation u_ττ = u_x^k Σ_{n≥1} D^{n-1} E_n.

**Momentum.** The momentum ∫ u_τ dx is conserved if every order has a flux, a polynomial F_n with
u_x^k E_n = ∂_x (u_x^k F_n).

**Energy of the chain.** Let w_i be the field of particle i, C_i p (1 + X_i) the strain of contact
i, F the force in the units of the wave equation (p^k/k for a power) and W its energy, W′ = F. The
energy of a cell per length is

    e = ½ Σ m̂_i (∂_τ w_i)² + Σ C_i W(p (1 + X_i)) / P = u_τ²/2 + W(u_x) + ….

With F_{-1} the force on particle 0 from the cell before, the equations of motion give

    ∂_τ e = (e^{PD∂} - 1) (F_{-1} ∂_τ w_0) / (PD),    ∂ = ∂_x,

the derivative of the flux of energy. This holds for any wave equation that the slaved fields
satisfy, in every field, whether or not the equation derives from a potential. The density is given
up to derivatives, so that no highest jet stands in it linearly.

**Theorem** (proof: the book on cells). At D^{k+3} the equation of the canonical field φ,
the mean Σ m̂_i w_i of the fields shifted to one point, derives from a potential for every cell:
G = I(k-1)(k-2)/2, H = 2I(k-1), and I is the coefficient in the linear chain's dispersion
Ω² = κ² (1 - Iκ² + …). With W(φ_x) in place of the power it holds for every law with equal contacts.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra
from lwa.base.exact import InputError
from lwa.closure.consistency import Closure
from lwa.closure.slaving import Force


def conservative(closure: Closure) -> bool:
    """True if every order n ≥ 2 has a flux F_n, u_x^k E_n = ∂_x (u_x^k F_n)."""
    algebra = closure.algebra
    k = closure.model.ring.exponent(algebra.context)
    return all(
        algebra.antiderivative(E, k) is not None for E in closure.acceleration[2:]
    )


def energy(closure: Closure) -> tuple[JetAlgebra, list[fmpq_mpoly]]:
    """The terms of (e - W(u_x)) / (u_x² F′(u_x)) to D^{order-2}, and their algebra (with s_0).

    Raises `lwa.InputError` on the optical branch, and for a closure that leaves a defect.
    """
    if closure.model.branch != "acoustic":
        raise InputError(
            "the energy in the slaved fields is that of the acoustic branch"
        )
    if any(not d.is_zero() for d in closure.defect):
        raise InputError(
            "the linear closure does not satisfy both equations of motion (see the defect), so "
            'that no energy is conserved: closure="full" has one'
        )
    fields = _Fields(closure)
    sums = (fields.kinetic(n) + fields.elastic(n) for n in range(closure.order - 1))
    return fields.algebra, [fields.algebra.by_parts(e, fields.k + 1) for e in sums]


class _Fields:
    """Velocities and strains of a closure as series, in an algebra with s_0 = u_τ/p^{(k+1)/2}."""

    def __init__(self, closure: Closure) -> None:
        model, old = closure.model, closure.algebra
        self.algebra = algebra = model.algebra(old.weight, velocity=True, rest=True)
        self.k, self.mu, self.c = model.elements(algebra)

        def series(terms: Iterable[fmpq_mpoly], exponent: fmpq_mpoly) -> GradedSeries:
            return GradedSeries(
                algebra, exponent, [algebra.embed(term, old) for term in terms]
            )

        E = series(closure.acceleration, self.k)
        self.S = [series(row, algebra.one) for row in closure.fields]
        orders = range(1, closure.order - 1)
        # ∂_τ w_i = φ_τ + D ∂_τ (φ_x S_i)
        self.velocities = [
            [algebra.s[0], *(algebra.dt(row, E, n) for n in orders)] for row in self.S
        ]
        self.forces = [Force(algebra, self.k) for _ in self.S]
        for n in orders:
            for force, share, strain in zip(
                self.forces, self.c, self._strains(n), strict=True
            ):
                force.append(strain / share)  # without a remainder

    def _strains(self, n: int) -> list[fmpq_mpoly]:
        """Coefficients of D^n in (w_{i+1} - w_i)/(D p), i < P; w_P is w_0 of the next cell."""
        S, P = self.S, len(self.S)
        jet = self.algebra.r[n] * fmpq(P ** (n + 1), factorial(n + 1))
        last = jet + S[0].increment(P, n) + S[0][n] - S[-1][n]
        return [*(after[n] - before[n] for before, after in pairwise(S)), last]

    def kinetic(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in the kinetic energy ½ Σ m̂_i (∂_τ w_i)², divided by p² F′."""
        total = self.algebra.zero
        for mu, row in zip(self.mu, self.velocities, strict=True):
            for j in range(n + 1):
                total = total + mu * row[j] * row[n - j] / 2
        return total

    def elastic(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^n in Σ C_i W(p (1 + X_i)) / P, divided by p² F′; 0 for n = 0."""
        if n == 0:
            return self.algebra.zero
        total = self.algebra.zero
        for c, force in zip(self.c, self.forces, strict=True):
            total = total + c * force.work(n)
        # The rest of `work` is F(p) Σ C_i p X_i / P = F(p) ∂_x Y, by parts -p F′ r_1 Y, with
        # Y = Σ_j (PD∂_x)^j/(j+1)! w_0 - φ.
        P, r = len(self.c), self.algebra.r
        Y = r[n - 1] * fmpq(P**n, factorial(n + 1))
        for j in range(n):
            Y = Y + self.S[0].dx(n - 1 - j, j) * fmpq(P**j, factorial(j + 1))
        return total / P - r[1] * Y
