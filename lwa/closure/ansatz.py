"""The paper's closure (Porter et al. 2008): an ansatz that is linear in the field.

For the dimer, u is the field of the first particle and ``w = λ (u + Σ b_n D^n ∂_x^n u)`` that of
the second. The numbers ``b_n`` follow from the demand that both equations of motion
(`lwa.closure.slaving`) give the same acceleration of u. As each order has one unknown ``b_n``, the
demand can be met for one monomial, the n-th derivative of u. The first equation then is the wave
equation; the difference between the two is the defect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra, taylor
from lwa.algebra.model import Model
from lwa.base.progress import Progress
from lwa.closure.slaving import (
    Force,
    Solution,
    full,
)


def linear(
    model: Model,
    progress: Progress[int] = iter,
) -> Solution:
    """Solve the paper's closure to ``D^order`` in the ansatz, on the branch of the model.

    The cell has two particles, or on the acoustic branch one, whose equation of motion is the wave
    equation.
    """
    if model.branch == "optical":
        return _optical(model, progress)
    if model.cell.size == 1:
        return full(model, progress=progress)
    return _acoustic(model, progress)


def _applied(
    b: Sequence[fmpq_mpoly],
    f: GradedSeries,
    n: int,
) -> fmpq_mpoly:
    """Term n of the ansatz applied to a series, ``Σ_{0<j<n} b_j ∂_x^j f_{n-j}``, without b_n."""
    total = f.algebra.zero
    for j in range(1, n):
        total = total + b[j] * f.dx(n - j, j)
    return total


def _acoustic(
    model: Model,
    progress: Progress[int],
) -> Solution:
    """The ansatz of a dimer's acoustic branch."""
    algebra = JetAlgebra(model, max(model.order - 1, 1))
    mu, c = algebra.mu, algebra.c  # mass fractions, strain shares
    right = Force(algebra)  # of the contact inside the cell
    left = Force(algebra)  # of the contact to the next cell
    first = GradedSeries(algebra, algebra.k, [algebra.zero])  # E by equation 1
    second = GradedSeries(algebra, algebra.k, [algebra.zero])  # E by equation 2
    # At the leading order w - u is the strain of the first contact: its share C_0 of D u_x.
    b = [algebra.one, c[0]]
    for n in progress(range(1, model.order)):
        # The strains of both contacts sum to u(x + 2D) - u(x). Let the two differ by ξ r_n at D^n.
        # The forces on the particles are evaluated without ξ r_n, which enters with the factors ±1.
        r_n = algebra.r[n]
        difference = right.nonlinear - left.nonlinear
        force_1 = difference - left.increment(-2, n)
        force_2 = -difference
        # u_ττ is the same at r_n, m̂_0 + m̂_1 = 1, and b_n cancels:
        # m̂_1 (force_1 + ξ r_n) = m̂_0 (force_2 - ξ r_n - 2 m̂_1 applied).
        condition = mu[1] * force_1 - mu[0] * force_2
        inertia = mu[0] * mu[1] * _applied(b, first, n)
        xi = -algebra.slope(condition + 2 * inertia, n)
        mean = algebra.one * taylor(2, n + 1) / 2
        strain = mean + c[1] * xi / 2
        right.append(strain * r_n)
        left.append((mean - c[0] * xi / 2) * r_n)
        # The divisions by the masses leave no remainder.
        force_1 = force_1 + xi * r_n
        force_2 = force_2 - xi * r_n
        first.append(force_1 / (2 * mu[0]))
        of_second = force_2 / (2 * mu[1])  # acceleration of w
        second.append(of_second - _applied(b, second, n))
        b.append(c[0] * strain)
    return _solution(b, first, second)


def _optical(
    model: Model,
    progress: Progress[int],
) -> Solution:
    """The ansatz of a dimer's optical branch; its contacts also pull, by the odd law of δ^k.

    The strains of the contacts are ``w - u = -(u/m̂_1)(1 + Y)`` and
    ``u(x + 2D) - w = (u/m̂_1)(1 + Z)``. Forces are those of a `Force` with Y or Z for X, and the
    series of both equations of motion are those of ε in ``u_ττ = -u^k (1 + kε)``.
    """
    algebra = JetAlgebra(model, model.order)
    k, mu, stiffness = algebra.k, algebra.mu, algebra.c
    right = Force(algebra)  # with Y
    left = Force(algebra)  # with Z
    first = GradedSeries(algebra, k, [algebra.zero])
    second = GradedSeries(algebra, k, [algebra.zero])
    # ∂_x^n of -u^k, the leading order, begins at ∂_x u^k = k u^k r_1.
    leading = GradedSeries(algebra, k, [algebra.r[1]])
    b = [algebra.one]
    for n in progress(range(1, model.order + 1)):
        r_n = algebra.r[n]
        # At r_n the accelerations by the two equations differ by this sum and b_n.
        shifted = stiffness[1] * left.increment(-2, n)
        lacking = shifted + _applied(b, first, n)
        b.append(-algebra.slope(lacking, n))
        strain = mu[0] * b[n]
        right.append(strain * r_n)
        strain = strain + mu[1] * taylor(2, n)
        left.append(strain * r_n)
        force = stiffness[0] * right.Phi[n]
        force = force + stiffness[1] * left.Phi[n]
        first.append(force + shifted)
        inertia = b[n] * leading.dx(0, n - 1)
        inertia = inertia + _applied(b, second, n)
        second.append(force - inertia)
    solution = _solution(b, first, second)
    acceleration = [algebra.one]
    for epsilon in solution.acceleration[1:]:
        acceleration.append(k * epsilon)
    defect = tuple(k * difference for difference in solution.defect)
    return replace(solution, acceleration=tuple(acceleration), defect=defect)


def _solution(
    b: Sequence[fmpq_mpoly],
    first: GradedSeries,
    second: GradedSeries,
) -> Solution:
    """The solution with E_n of the first equation of motion and the defect first - second."""
    defect = []
    for E_n, other in zip(first, second, strict=True):
        defect.append(E_n - other)
    return Solution(
        first.algebra,
        acceleration=tuple(first),
        ansatz=tuple(b),
        defect=tuple(defect),
    )
