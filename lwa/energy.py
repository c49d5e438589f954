"""The chain's own energy in the slaved fields, conserved to the order of the closure.

With w_i the field of particle i and p (1 + X_i) the strain of contact i over its share c_i, the
energy of a cell per length, in the units of the wave equation, is

    e = ½ Σ μ_i (∂_τ w_i)² + Σ c_i (p (1 + X_i))^{k+1} / (P k (k+1))
      = u_τ²/2 + u_x^{k+1}/(k (k+1)) + …,

and the equations of motion give ∂_τ e = (e^{PD∂} - 1) (F_{-1} ∂_τ w_0) / (PkD), the derivative of
the flux of energy. That holds for any wave equation that the slaved fields satisfy, in every field,
whether or not the equation derives from a potential.

The density is given up to derivatives, so that no highest jet stands in it linearly.
"""

from __future__ import annotations

from itertools import pairwise
from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.closure.consistency import Closure
from lwa.exact import InputError
from lwa.jets import JetAlgebra, Ladder, Power, exact_quotient


def energy(closure: Closure) -> tuple[JetAlgebra, list[fmpq_mpoly]]:
    """k (k+1) e / u_x^{k+1} as a series in D up to D^{order-2}, in an algebra that has s_0.

    Raises `lwa.InputError` on the optical branch, and where the closure leaves a defect.
    """
    if closure.ring.branch != "acoustic":
        raise InputError("the energy in the slaved fields is that of the acoustic branch")
    if any(not d.is_zero() for d in closure.defect):
        raise InputError(
            "the linear closure does not satisfy both equations of motion (see the defect), so "
            'that no energy is conserved: closure="full" has one'
        )
    fields = _Fields(closure)
    orders = range(max(closure.order - 1, 0))
    return fields.algebra, [
        fields.algebra.by_parts(
            fields.k * (fields.k + 1) * fields.kinetic(n) + fields.elastic(n), fields.k + 1
        )
        for n in orders
    ]


class _Fields:
    """Velocities and strains of a closure, in an algebra that has s_0."""

    def __init__(self, closure: Closure) -> None:
        ring, old = closure.ring, closure.algebra
        self.algebra = algebra = JetAlgebra(ring.names, old.weight, ring.exponent, rest=True)
        self.k = ring.exponent(algebra.context)
        self.mu = ring.masses.elements(algebra.context)
        self.c = ring.contacts.elements(algebra.context)
        E = self._series(closure.acceleration, old, self.k)
        S = [self._series(row, old, algebra.one) for row in closure.fields]
        size = max(closure.order - 1, 0)
        self.velocities = [
            [algebra.s[0], *(algebra.dt(row, E, n) for n in range(1, size))] for row in S
        ]
        self.forces = [Power(algebra, self.k + 1) for _ in S]
        for n in range(1, size):
            for force, share, strain in zip(self.forces, self.c, _strains(S, n), strict=True):
                force.append(exact_quotient(strain, share))

    def _series(
        self, terms: tuple[fmpq_mpoly, ...], old: JetAlgebra, exponent: fmpq_mpoly
    ) -> Ladder:
        ladder = Ladder(self.algebra, exponent)
        for term in terms:
            ladder.append(self.algebra.taken(term, old))
        return ladder

    def kinetic(self, n: int) -> fmpq_mpoly:
        """½ Σ μ_i (∂_τ w_i)² at D^n, over p^{k+1}."""
        total = self.algebra.zero
        for mu, row in zip(self.mu, self.velocities, strict=True):
            for j in range(n + 1):
                total = total + mu * row[j] * row[n - j] / 2
        return total

    def elastic(self, n: int) -> fmpq_mpoly:
        """Σ c_i (1 + X_i)^{k+1} / P at D^n."""
        if n == 0:
            return self.algebra.one
        total = self.algebra.zero
        for c, force in zip(self.c, self.forces, strict=True):
            total = total + c * force.Phi[n]
        return (self.k + 1) * total / len(self.c)


def _strains(S: list[Ladder], n: int) -> list[fmpq_mpoly]:
    """c_i X_i at D^n: w_{i+1} - w_i over D p, the last one's neighbour in the next cell."""
    P = len(S)
    inner = [after[n] - before[n] for before, after in pairwise(S)]
    jet = S[0].algebra.r[n] * fmpq(P ** (n + 1), factorial(n + 1))
    return [*inner, jet + S[0].carried(P, n) + S[0][n] - S[-1][n]]
