"""The chain's own energy in the slaved fields, conserved to the order of the closure.

With w_i the field of particle i and p (1 + X_i) the strain of contact i over its share c_i, the
energy of a cell per length, in the units of the wave equation, is

    e = ½ Σ μ_i (∂_τ w_i)² + Σ c_i W(p (1 + X_i)) / P = u_τ²/2 + W(u_x) + …,

W′ = F the force, p^k/k for a power. The work of F(p) on the strains, Σ c_i p X_i, is by parts that
of its derivative on a displacement. The equations of motion give

    ∂_τ e = (e^{PD∂} - 1) (F_{-1} ∂_τ w_0) / (PD),

the derivative of the flux of energy. That holds for any wave equation that the slaved fields
satisfy, in every field, whether or not the equation derives from a potential.

The density is given up to derivatives, so that no highest jet stands in it linearly.
"""

from __future__ import annotations

from itertools import pairwise
from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.algebra.contact import contact
from lwa.algebra.jets import JetAlgebra, Ladder, exact_quotient
from lwa.base.exact import InputError
from lwa.closure.consistency import Closure


def energy(closure: Closure) -> tuple[JetAlgebra, list[fmpq_mpoly]]:
    """(e - W(u_x)) / (u_x² F′(u_x)), a series in D up to D^{order-2}, in an algebra that has s_0.

    Raises `lwa.InputError` on the optical branch, and where the closure leaves a defect.
    """
    if closure.model.branch != "acoustic":
        raise InputError("the energy in the slaved fields is that of the acoustic branch")
    if any(not d.is_zero() for d in closure.defect):
        raise InputError(
            "the linear closure does not satisfy both equations of motion (see the defect), so "
            'that no energy is conserved: closure="full" has one'
        )
    fields = _Fields(closure)
    orders = range(max(closure.order - 1, 0))
    found = (fields.kinetic(n) + fields.elastic(n) for n in orders)
    return fields.algebra, [fields.algebra.by_parts(e, fields.k + 1) for e in found]


class _Fields:
    """Velocities and strains of a closure, in an algebra that has s_0."""

    def __init__(self, closure: Closure) -> None:
        model, old = closure.model, closure.algebra
        self.algebra = algebra = model.algebra(old.weight, velocity=True, rest=True)
        self.k = model.ring.exponent(algebra.context)
        self.mu = model.ring.masses.elements(algebra.context)
        self.c = model.ring.contacts.elements(algebra.context)
        E = self._series(closure.acceleration, old, self.k)
        self.S = S = [self._series(row, old, algebra.one) for row in closure.fields]
        size = max(closure.order - 1, 0)
        self.velocities = [
            [algebra.s[0], *(algebra.dt(row, E, n) for n in range(1, size))] for row in S
        ]
        self.forces = [contact(algebra, self.k) for _ in S]
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
        """½ Σ μ_i (∂_τ w_i)² at D^n, over p² F′."""
        total = self.algebra.zero
        for mu, row in zip(self.mu, self.velocities, strict=True):
            for j in range(n + 1):
                total = total + mu * row[j] * row[n - j] / 2
        return total

    def elastic(self, n: int) -> fmpq_mpoly:
        """Σ c_i W(p (1 + X_i)) / P at D^n, n ≥ 1, over p² F′; nothing at D^0.

        Σ c_i p X_i / P = ∂_x Y with Y = Σ_j (PD∂_x)^j/(j+1)! w_0 - φ.
        """
        if n == 0:
            return self.algebra.zero
        total = self.algebra.zero
        for c, force in zip(self.c, self.forces, strict=True):
            total = total + c * force.work(n)
        P, r = len(self.c), self.algebra.r
        Y = r[n - 1] * fmpq(P**n, factorial(n + 1))
        for j in range(n):
            Y = Y + self.S[0].dx(n - 1 - j, j) * fmpq(P**j, factorial(j + 1))
        return total / P - r[1] * Y


def _strains(S: list[Ladder], n: int) -> list[fmpq_mpoly]:
    """c_i X_i at D^n: w_{i+1} - w_i over D p, the last one's neighbour in the next cell."""
    P = len(S)
    inner = [after[n] - before[n] for before, after in pairwise(S)]
    jet = S[0].algebra.r[n] * fmpq(P ** (n + 1), factorial(n + 1))
    return [*inner, jet + S[0].carried(P, n) + S[0][n] - S[-1][n]]
