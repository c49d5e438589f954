"""The full closure: slaved fields that satisfy every equation of motion, at every order.

Letters and equations of motion as in `lwa.closure.solution`: w_i = φ + D φ_x Σ_n D^n S_n is the
field of particle i, each S_n a polynomial in the jets of φ and of φ_τ. All P equations of motion
can then be satisfied, order by order and without a system to solve:

1. The sum of all equations, the balance of momentum, gives the next term E_n of the wave equation.
2. The sum of the first i equations gives Φ_i - Φ_0, the difference of two contact forces.
3. The force Φ_i of each contact gives the term X_n of its strain C_i φ_x (1 + Σ D^n X_n).
4. The strains give the terms S_n of all fields, up to a shift that the definition of φ fixes.
"""

from __future__ import annotations

from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.algebra.contact import contact
from lwa.algebra.jets import JetAlgebra, Ladder
from lwa.algebra.model import Model
from lwa.base.progress import Progress
from lwa.closure.solution import Solution


def full(
    model: Model, order: int, field: str = "first", progress: Progress[int] = iter
) -> Solution:
    """The closure that satisfies all equations of motion, to D^order in the slaved fields.

    field : the φ of the theory, "first", the displacement of the first particle, or "center", the
        mean Σ m̂_i w_i(x - x_i D) of all fields at one point, x_i = C_0 + … + C_{i-1}.
    """
    chain = _Slaving(model, order, field)
    for n in progress(range(1, order)):
        chain.extend(n)
    S = [particle.S for particle in chain.particles]
    b = [_linear_part(chain.algebra, S[1], n) for n in range(order)] if len(S) > 1 else []
    return Solution(
        algebra=chain.algebra,
        acceleration=tuple(chain.E[n] for n in range(order)),
        ansatz=(chain.algebra.one, *b) if b else (),
        slaved=tuple(tuple(ladder[n] for n in range(order)) for ladder in S),
    )


class _Particle:
    """A particle of the cell, with the field w = φ + D φ_x S, and its contact to the next one.

    mu, c : mass fraction m̂_i of the particle, strain share C_i of the contact.
    x : place x_i = C_0 + … + C_{i-1} of the particle at rest.
    weight : weight g_i of the particle in the mean φ(x) = Σ g_i w_i(x - x_i D).
    S : the series S.
    rate : the series ∂_τ (D φ_x S).
    force : the force of the contact.
    """

    def __init__(
        self, algebra: JetAlgebra, k: fmpq_mpoly, mu: fmpq_mpoly, c: fmpq_mpoly, x: fmpq_mpoly
    ) -> None:
        self.mu, self.c, self.x = mu, c, x
        self.weight = algebra.zero
        self.S = Ladder(algebra, algebra.one)
        self.S.append(x)
        self.rate = Ladder(algebra, algebra.half)
        self.rate.append(algebra.zero)
        self.force = contact(algebra, k)


class _Slaving:
    """The recursion of the full closure, one order of D at a time."""

    def __init__(self, model: Model, order: int, field: str) -> None:
        self.algebra = algebra = model.algebra(max(order - 1, 1), velocity=True)
        self.order = order
        k = model.ring.exponent(algebra.context)
        self.E = Ladder(algebra, k)
        self.E.append(algebra.zero)
        self.particles: list[_Particle] = []
        x = algebra.zero
        for mu, c in zip(
            model.ring.masses.elements(algebra.context),
            model.ring.contacts.elements(algebra.context),
            strict=True,
        ):
            self.particles.append(_Particle(algebra, k, mu, c, x))
            x = x + c
        self.particles[0].weight = algebra.one
        if field == "center":
            for particle in self.particles:
                particle.weight = particle.mu

    def extend(self, n: int) -> None:
        """Append the terms of order D^n to all series: E_n, X_n, Φ_n and S_n."""
        accelerations = [self.algebra.dt(particle.rate, self.E, n) for particle in self.particles]
        if n + 1 < self.order:
            for particle in self.particles:
                particle.rate.append(self.algebra.dt(particle.S, self.E, n))
        self._momentum(n, accelerations)
        self._strains(n, accelerations)
        self._origin(n)

    def _momentum(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """Append E_n, from the sum of the equations of motion: only the end forces remain in it."""
        P = len(self.particles)
        E_n = -self.particles[-1].force.carried(-P, n) / P
        for particle, acceleration in zip(self.particles, accelerations, strict=True):
            E_n = E_n - particle.mu * acceleration
        self.E.append(E_n)

    def _strains(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """Append X_n, the order n of each contact's strain.

        Φ_i - Φ_0 gives the differences of the strains, and the cell their sum.
        """
        P = len(self.particles)
        first = self.particles[0]
        difference = self.algebra.zero
        differs = []
        for particle, acceleration in zip(self.particles, accelerations, strict=True):
            if particle is not first:
                difference = difference + P * particle.mu * (self.E[n] + acceleration)
            differs.append(difference + first.force.known - particle.force.known)
        X = self._shift(n) * P ** (n + 1) + first.S.carried(P, n)
        for particle, d in zip(self.particles, differs, strict=True):
            X = X - particle.c * d
        for particle, d in zip(self.particles, differs, strict=True):
            particle.force.append(X / P + d)

    def _origin(self, n: int) -> None:
        """Append S_n of each particle, by the definition φ(x) = Σ g_i w_i(x - x_i D)."""
        relative = [self.algebra.zero]
        for particle in self.particles[:-1]:
            relative.append(relative[-1] + particle.c * particle.force.X[n])
        origin = self.algebra.zero
        for particle, own in zip(self.particles, relative, strict=True):
            if not particle.weight.is_zero():
                x = particle.x
                moved = (-x) ** (n + 1) * self._shift(n) + particle.S.carried(-x, n)
                origin = origin - particle.weight * (own + moved)
        for particle, own in zip(self.particles, relative, strict=True):
            particle.S.append(origin + own)

    def _shift(self, n: int) -> fmpq_mpoly:
        """Coefficient of D^{n+1} in (φ(x + D) - φ(x)) / φ_x."""
        return self.algebra.r[n] * fmpq(1, factorial(n + 1))


def _linear_part(algebra: JetAlgebra, S: Ladder, n: int) -> fmpq_mpoly:
    return algebra.slope(S[n], n) if n else S[0]
