"""The equations of motion of a cell in its fields, and the full closure, which satisfies them all.

All displacement fields ``w_0 … w_{P-1}`` of a cell are taken at the position x of its first
particle and expressed by one field φ as ``w_i = φ + D φ_x S_i``, where ``S_i`` is a series in D of
polynomials in the jets of φ (`lwa.algebra.jets`). Let ``m̂_i`` be the mass fractions, τ the time of
`Cell.time_scale`, and ``F_i`` the force of contact i divided by ``A_eff D^k``. The equations of
motion of the P particles are::

    P k D m̂_i ∂_ττ w_i = F_i(x) - F_{i-1}(x),    F_{-1}(x) = F_{P-1}(x - P D).

In the full closure the coefficient ``S_n`` of ``D^n`` in each series is a polynomial in the jets of
φ and of its velocity. All P equations of motion can then be satisfied, order by order and without
a system to solve:

1. The sum of all equations, the balance of momentum, gives the next term ``E_n`` of the wave
   equation.
2. The sum of the first i equations gives ``Φ_i - Φ_0``, the difference of two contact forces.
3. The force ``Φ_i`` of each contact gives the term ``X_n`` of its strain
   ``C_i φ_x (1 + Σ D^n X_n)``.
4. The strains give the terms ``S_n`` of all fields, up to a shift that the definition of φ fixes:
   φ is the field of the first particle, or the canonical field, the mean
   ``Σ m̂_i w_i(x - x_i D)`` of all fields at one point, with ``x_i = C_0 + … + C_{i-1}``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import accumulate

from flint import fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra, taylor
from lwa.algebra.model import Model
from lwa.base.progress import Progress
from lwa.base.words import FieldName


class Force:
    """The force of a contact as a series in D, to which terms are appended order by order.

    Let p be the strain of the field and p (1 + X), where ``X = Σ_{n≥1} D^n X_n``, the strain of a
    contact divided by its share ``C_i``. With the parameters ``φ_m`` of the algebra's law the force
    of the contact is::

        F(p (1 + X)) = F(p) + p F'(p) Φ,    Φ = Σ_{m≥1} φ_m X^m/m! = Σ_{n≥1} D^n Φ_n.
    """

    def __init__(self, algebra: JetAlgebra) -> None:
        self.algebra = algebra
        self.X = [algebra.zero]
        self.Phi = GradedSeries(algebra, algebra.k, [algebra.zero])
        # The first derivative of F(p) over p F′: r_1
        self._slope = GradedSeries(algebra, algebra.k, [algebra.r[1]])
        # Cached, as the terms of a power are made from those of all lower powers
        self._power = cache(self._term_of_power)

    @property
    def nonlinear(self) -> fmpq_mpoly:
        """The nonlinear part ``Φ_n - X_n`` of the next order n, known from ``X_1 … X_{n-1}``.

        It is the coefficient of ``D^n`` in ``Σ_{m≥2} φ_m X^m/m!``.
        """
        n = len(self.X)
        total = self.algebra.zero
        # X begins at D: the power X^m reaches D^n for m ≤ n.
        for m in range(2, n + 1):
            total = total + self.algebra.phi[m] * self._power(m, n)
        return total

    def _term_of_power(self, m: int, n: int) -> fmpq_mpoly:
        """The coefficient of ``D^n`` in ``X^m/m! = (1/m) X · X^{m-1}/(m-1)!``, n ≥ m ≥ 1."""
        if m == 1:
            return self.X[n]
        total = self.algebra.zero
        for j in range(1, n - m + 2):
            total = total + self.X[j] * self._power(m - 1, n - j)
        return total / m

    def append(self, X_n: fmpq_mpoly) -> None:
        """Append the next term ``X_n`` to X, and ``Φ_n`` to Φ."""
        self.Phi.append(X_n + self.nonlinear)
        self.X.append(X_n)

    def increment(self, h: int, n: int) -> fmpq_mpoly:
        """Coefficient of ``D^n`` in the force at x + hD minus the force at x, over ``p F'``."""
        # F(p) adds h^n/n! ∂_x^n F(p) = h^n/n! ∂_x^{n-1} (p F' r_1), r_1 = p_x/p.
        of_strain = self._slope.dx(0, n - 1) * taylor(h, n)
        return self.Phi.increment(h, n) + of_strain

    def work(self, n: int) -> fmpq_mpoly:
        """Coefficient of ``D^n`` in the integral of Φ over X.

        With the energy W of the contact it is ``[W(p (1 + X)) - W(p) - p F(p) X] / (p² F')``.
        """
        # The derivative by D is Φ ∂X/∂D, so that n times the coefficient is a sum of products.
        total = self.algebra.zero
        for j in range(1, n):
            total = total + j * self.X[j] * self.Phi[n - j]
        return total / n


@dataclass(frozen=True)
class Solution:
    """Result of a closure: wave equation and displacement fields, as polynomials by order in D.

    Parameters
    ----------
    algebra : JetAlgebra
    acceleration : tuple of elements
        The ``E_n`` of the wave equation. On the acoustic branch it is
        ``φ_ττ = φ_x^k Σ_{n≥1} D^{n-1} E_n``, ``E_1 = r_1``; on the optical one, in its own unit of
        time, ``u_ττ = -u^k Σ_{n≥0} D^n E_n``, ``E_0 = 1``.
    ansatz : tuple of elements
        The numbers ``b_0 … b_order``. The second particle's field is ``λ Σ b_n D^n ∂_x^n φ`` in the
        linear closure, and has this linear part in the full one.
    fields : tuple of GradedSeries
        The series S of each field ``w_i = φ + D φ_x S_i``; () in the linear closure, as `rates`
        and `forces`.
    rates : tuple of GradedSeries
        The series ``∂_τ (D φ_x S_i)`` of each field.
    forces : tuple of Force
        The forces of the contacts.
    defect : tuple of elements
        The ``E_n`` of the first equation of motion minus those of the second.
    """

    algebra: JetAlgebra
    acceleration: tuple[fmpq_mpoly, ...]
    ansatz: tuple[fmpq_mpoly, ...] = ()
    fields: tuple[GradedSeries, ...] = ()
    rates: tuple[GradedSeries, ...] = ()
    forces: tuple[Force, ...] = ()
    defect: tuple[fmpq_mpoly, ...] = ()


def full(
    model: Model, field: FieldName = "first", progress: Progress[int] = iter
) -> Solution:
    """Find the closure that satisfies all equations of motion, to ``D^order`` in all fields."""
    chain = _Slaving(model, field)
    for n in progress(range(1, model.order)):
        chain.extend(n)
    algebra = chain.algebra
    # The linear part of the second particle's field
    ansatz = []
    if chain.size > 1:
        second = chain.S[1]
        ansatz = [algebra.one, second[0]]
        # b_{n+1} is the coefficient of r_n in S_n, as D φ_x · D^n r_n = D^{n+1} ∂_x^{n+1} φ.
        for n in range(1, model.order):
            ansatz.append(algebra.slope(second[n], n))
    return Solution(
        algebra,
        acceleration=tuple(chain.E),
        ansatz=tuple(ansatz),
        fields=tuple(chain.S),
        rates=tuple(chain.rates),
        forces=tuple(chain.forces),
    )


class _Slaving:
    """Solver of the full closure, one order of D at a time.

    Attributes
    ----------
    x : list of elements
        Places ``x_i = C_0 + … + C_{i-1}`` of the particles at rest.
    weights : list of elements
        The weights ``g_i`` of the mean ``φ(x) = Σ g_i w_i(x - x_i D)``.
    E : GradedSeries
        The terms of the wave equation.
    S, rates : lists of GradedSeries
        The series S and ``∂_τ (D φ_x S)`` of each field ``w = φ + D φ_x S``.
    forces : list of Force
    """

    def __init__(self, model: Model, field: FieldName) -> None:
        self.algebra = algebra = JetAlgebra(model, max(model.order - 1, 1))
        self.order = model.order
        self.size = model.cell.size
        self.x = list(accumulate(algebra.c[:-1], initial=algebra.zero))
        self.weights = algebra.mu if field == "center" else [algebra.one]
        # Terms of D^0: E begins with E_1, and every rate with D^1.
        self.E = GradedSeries(algebra, algebra.k, [algebra.zero])
        self.S = []
        self.rates = []
        self.forces = []
        # At D^0 the field w_i = φ(x + D x_i) has S_i = x_i.
        for x in self.x:
            self.S.append(GradedSeries(algebra, algebra.one, [x]))
            self.rates.append(GradedSeries(algebra, algebra.half, [algebra.zero]))
            self.forces.append(Force(algebra))

    def extend(self, n: int) -> None:
        """Append the terms in ``D^n`` of wave equation E, strains X, forces Φ and fields S.

        Let ``a_i`` be the term of ``∂_ττ (D φ_x S_i)``, which is known from lower orders. At
        ``D^n`` the equation of motion of particle i > 0, and the sum of all equations, are, with
        forces over ``p F′(p)``::

            P m̂_i (E_n + a_i) = Φ_i - Φ_{i-1},
            P (E_n + Σ m̂_i a_i) = F_{P-1}(x) - F_{P-1}(x - PD).
        """
        accelerations = [rate.dt(self.E, n) for rate in self.rates]
        # A rate is the series of ∂_τ (D φ_x S): its term in D^n is that of ∂_τ (φ_x S) in D^{n-1}.
        # The rates of the last order would enter the next one.
        if n + 1 < self.order:
            for rate, S in zip(self.rates, self.S, strict=True):
                rate.append(S.dt(self.E, n))
        # The force of the last contact one cell before, less the force here
        outside = self.forces[-1].increment(-self.size, n)
        E_n = -outside / self.size
        for mu, acceleration in zip(self.algebra.mu, accelerations, strict=True):
            E_n = E_n - mu * acceleration
        self.E.append(E_n)
        self._append_strains(n, accelerations)
        self._append_fields(n)

    def _append_strains(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """Append the term ``X_n`` of each contact's strain.

        Let ``X_i`` and ``Φ_i`` be these terms of contact i. The equations of motion (see `extend`)
        give ``Φ_i - Φ_0``, and with ``Φ_i = X_i + nonlinear_i`` the differences ``X_i - X_0``. The
        cell, in which ``Σ C_i = P``, gives their sum::

            Σ C_i (1 + X_i) = [w_0(x + PD) - w_0(x)] / (D φ_x).
        """
        P, c = self.size, self.algebra.c
        first = self.forces[0].nonlinear
        # P m̂_i (E_n + a_i) is mass times acceleration of bead i, with the a_i of `extend`.
        push = self.algebra.zero  # Φ_i - Φ_0
        differences = [push]  # X_i - X_0
        for i in range(1, P):
            inertia = self.E[n] + accelerations[i]
            push = push + P * self.algebra.mu[i] * inertia
            differences.append(push + first - self.forces[i].nonlinear)
        # The right side is Σ C_i X_i; less Σ C_i (X_i - X_0) it is Σ C_i X_0 = P X_0.
        total = self.algebra.shift(P, n) + self.S[0].increment(P, n)
        for share, difference in zip(c, differences, strict=True):
            total = total - share * difference
        for force, difference in zip(self.forces, differences, strict=True):
            force.append(total / P + difference)

    def _append_fields(self, n: int) -> None:
        """Append ``S_n`` of each particle.

        Neighbours differ by a strain, ``S_{i+1} - S_i = C_i (1 + X_i)``. The term ``origin`` of the
        first particle follows from the definition ``φ(x) = Σ g_i w_i(x - x_i D)``, ``Σ g_i = 1``.
        """
        relative = [self.algebra.zero]  # S_n less that of the first particle
        for c, force in zip(self.algebra.c[:-1], self.forces, strict=False):
            relative.append(relative[-1] + c * force.X[n])
        # With S_n = origin + relative the definition is 0 = origin + Σ g_i (relative_i + moved_i):
        # `moved` is what the shift by h D adds to the field w_i = φ + D φ_x S_i at D^{n+1}.
        origin = self.algebra.zero
        for i, weight in enumerate(self.weights):
            h = -self.x[i]
            moved = self.algebra.shift(h, n) + self.S[i].increment(h, n)
            origin = origin - weight * (relative[i] + moved)
        for S, difference in zip(self.S, relative, strict=True):
            S.append(origin + difference)
