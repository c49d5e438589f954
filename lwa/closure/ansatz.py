"""The paper's closure (Porter et al. 2008): an ansatz that is linear in the field.

For the dimer, u is the field of the first particle and ``w = λ (u + Σ b_n D^n ∂_x^n u)`` that of
the second. The numbers ``b_n`` follow from the demand that both equations of motion
(`lwa.closure.slaving`) give the same acceleration of u. As each order has one unknown ``b_n``, the
demand can be met for one monomial, the n-th derivative of u. The first equation then is the wave
equation; the difference between the two is the defect.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpq_mpoly

from lwa.algebra.jets import GradedSeries, JetAlgebra, taylor
from lwa.algebra.model import Model
from lwa.base.progress import Progress
from lwa.closure.slaving import Force, Solution


def _applied(b: Sequence[fmpq_mpoly], f: GradedSeries, n: int) -> fmpq_mpoly:
    """Term n of the ansatz on a series, ``Σ_j b_j ∂_x^j f_{n-j}``, j > 0 up to the last b."""
    total = f.algebra.zero
    for j in range(1, len(b)):
        total = total + b[j] * f.dx(n - j, j)
    return total


def acoustic(model: Model, progress: Progress[int] = iter) -> Solution:
    """Solve the paper's closure of a dimer's acoustic branch, to ``D^order`` in the ansatz."""
    algebra = JetAlgebra(model, max(model.order - 1, 1))
    mu = algebra.mu  # mass fractions
    c = algebra.c  # strain shares
    right = Force(algebra)  # the force of the contact inside the cell
    left = Force(algebra)  # the force of the contact to the next cell
    first = GradedSeries(algebra, algebra.k, [algebra.zero])  # E by equation 1
    second = GradedSeries(algebra, algebra.k, [algebra.zero])  # E by equation 2
    # At the leading order w - u is the strain of the first contact: its share C_0 of D u_x.
    b = [algebra.one, c[0]]
    for n in progress(range(1, model.order)):
        # Let X_n of the right contact exceed that of the left one by ξ r_n. The forces on the two
        # particles are evaluated without ξ r_n, which then is added to force_1 and taken from
        # force_2.
        r_n = algebra.r[n]
        difference = right.nonlinear - left.nonlinear
        force_1 = difference - left.increment(-2, n)
        force_2 = -difference
        # The equations of motion are 2 m̂_0 E_n = force_1 + ξ r_n of u and, of w,
        # 2 m̂_1 (E_n + applied) = force_2 - ξ r_n with applied = Σ_j b_j ∂_x^j E_{n-j}. The choice
        # of ξ makes E_n the same in both at r_n:
        # m̂_1 (force_1 + ξ r_n) = m̂_0 (force_2 - ξ r_n - 2 m̂_1 applied), m̂_0 + m̂_1 = 1.
        condition = mu[1] * force_1
        condition = condition - mu[0] * force_2
        inertia = mu[0] * mu[1] * _applied(b, first, n)
        xi = -algebra.slope(condition + 2 * inertia, n)
        # The strains sum to u(x + 2D) - u(x): C_0 X_n + C_1 X_n (left) = 2^{n+1}/(n+1)! r_n, and
        # C_0 + C_1 = 2.
        mean = algebra.one * taylor(2, n + 1) / 2
        strain = mean + c[1] * xi / 2
        right.append(strain * r_n)
        other = mean - c[0] * xi / 2
        left.append(other * r_n)
        # The divisions by the masses leave no remainder.
        force_1 = force_1 + xi * r_n
        force_2 = force_2 - xi * r_n
        first.append(force_1 / (2 * mu[0]))
        of_second = force_2 / (2 * mu[1])  # acceleration of w
        second.append(of_second - _applied(b, second, n))
        # w - u is the strain C_0 D u_x (1 + X) of the right contact.
        b.append(c[0] * strain)
    return _solution(b, first, second)


def optical(model: Model, progress: Progress[int] = iter) -> Solution:
    """Solve the paper's closure of a dimer's optical branch, to ``D^order`` in the ansatz.

    Contacts also pull, by the odd law of ``δ^k``. The strains of the contacts are
    ``w - u = -(u/m̂_1)(1 + Y)`` and ``u(x + 2D) - w = (u/m̂_1)(1 + Z)``. Forces are those of a
    `Force` with Y or Z for X: over that of ``X = 0`` they are ``1 + k Φ(Y)`` and ``1 + k Φ(Z)``.
    With the wave equation ``u_ττ = -u^k E``, ``E = Σ D^n E_n``, and the shares c of the stiffness
    the equations of motion of u and of w are::

        1.  u^k E = c_0 u^k (1 + k Φ(Y)) + c_1 [u^k (1 + k Φ(Z))](x - 2D),
        2.  (1 + Σ b_n D^n ∂_x^n) u^k E = c_0 u^k (1 + k Φ(Y)) + c_1 u^k (1 + k Φ(Z)).
    """
    algebra = JetAlgebra(model, model.order)
    k = algebra.k
    mu = algebra.mu  # mass fractions
    stiffness = algebra.c  # shares of the stiffness
    right = Force(algebra)  # with Y
    left = Force(algebra)  # with Z
    first = GradedSeries(algebra, k, [algebra.one])  # E by equation 1
    second = GradedSeries(algebra, k, [algebra.one])  # E by equation 2
    b = [algebra.one]
    for n in progress(range(1, model.order + 1)):
        r_n = algebra.r[n]
        # Equation 1 has the second force at x - 2D: the change of this force from x to there.
        shifted = k * stiffness[1] * left.increment(-2, n)
        # E_n by equation 1 less E_n by equation 2 is this change plus the terms of b_1 … b_n. It
        # vanishes at r_n by the choice of b_n, which brings ∂_x^n u^k = k u^k r_n + ….
        lacking = shifted + _applied(b, first, n)
        b.append(-algebra.slope(lacking, n) / k)
        # With w = λ (u + Σ b_n D^n ∂_x^n u) and λ = -m̂_0/m̂_1: Y_n = m̂_0 b_n r_n, and Z_n has the
        # n-th term of u(x + 2D) besides.
        strain = mu[0] * b[n]
        right.append(strain * r_n)
        strain = strain + mu[1] * taylor(2, n)
        left.append(strain * r_n)
        force = stiffness[0] * right.Phi[n]
        force = force + stiffness[1] * left.Phi[n]
        first.append(k * force + shifted)
        second.append(k * force - _applied(b, second, n))
    return _solution(b, first, second)


def _solution(
    b: Sequence[fmpq_mpoly], first: GradedSeries, second: GradedSeries
) -> Solution:
    """The solution with E_n of the first equation of motion and the defect first - second."""
    pairs = zip(first, second, strict=True)
    return Solution(
        first.algebra,
        acceleration=tuple(first),
        ansatz=tuple(b),
        defect=tuple(E_n - other for E_n, other in pairs),
    )
