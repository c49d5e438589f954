"""The paper's closure (Porter et al. 2008): an ansatz that is linear in the field.

For the dimer, u = w_0 is the field of the first particle and w = w_1 = λ (u + Σ b_n D^n ∂_x^n u)
that of the second. The numbers b_n follow from the demand that both equations of motion
(`lwa.closure.slaving`) give the same u_ττ. As each order has one unknown b_n, this can be met for
one monomial, ∂_x^n u. The first equation then is the wave equation; the difference between the two
is the defect.
"""

from __future__ import annotations

from dataclasses import replace
from math import factorial

from flint import fmpq, fmpq_mpoly

from lwa.algebra.jets import GradedSeries
from lwa.algebra.model import Model
from lwa.base.exact import InputError
from lwa.base.progress import Progress
from lwa.closure.slaving import Force, Solution, full


def linear(model: Model, order: int, progress: Progress[int] = iter) -> Solution:
    """Solve the paper's closure to D^order in the ansatz, on the branch of the model.

    Raises `lwa.InputError` for cells of more than two particles, which the ansatz does not cover.
    """
    size = model.cell.size
    if (
        size == 1 and model.branch == "acoustic"
    ):  # the one equation is the wave equation
        return full(model, order, progress=progress)
    if size != 2:
        raise InputError(
            f"the cell has {size} masses: the linear closure's {model.branch} branch wants two; "
            'closure="full" (--closure full) covers the acoustic branch of any cell'
        )
    branch = _acoustic if model.branch == "acoustic" else _optical
    return branch(model, order, progress)


def _applied(b: list[fmpq_mpoly], f: GradedSeries, n: int) -> fmpq_mpoly:
    """Term n of the ansatz applied to a series f, Σ_{0<j<n} b_j ∂_x^j f_{n-j}, without b_n."""
    return sum(
        (b[j] * f.dx(n - j, j) for j in range(1, min(n, len(f)))), f.algebra.zero
    )


def _acoustic(model: Model, order: int, progress: Progress[int]) -> Solution:
    algebra = model.algebra(max(order - 1, 1))
    k, mu, c = model.elements(algebra)
    right, left = (
        Force(algebra, k),
        Force(algebra, k),
    )  # in the cell and to the next one
    # E by equation 1 and by equation 2
    first, second = (GradedSeries(algebra, k, [algebra.zero]) for _ in range(2))
    b = [
        algebra.one,
        c[0],
    ]  # order D^k: equal forces, so the first contact takes its share
    for n in progress(range(1, order)):
        # The strains of both contacts sum to u(x + 2D) - u(x). Let the two differ by ξ r_n at D^n;
        # both equations are evaluated without ξ r_n, which enters with the factors ±1.
        difference = right.nonlinear - left.nonlinear
        force_1, force_2 = difference - left.increment(-2, n), -difference
        # u_ττ is the same at r_n, m̂_0 + m̂_1 = 1, and b_n cancels:
        # m̂_1 (force_1 + ξ r_n) = m̂_0 (force_2 - ξ r_n - 2 m̂_1 applied).
        condition = (
            mu[1] * force_1
            - mu[0] * force_2
            + 2 * mu[0] * mu[1] * _applied(b, first, n)
        )
        xi = -algebra.slope(condition, n)
        r_n = algebra.r[n]
        mean = algebra.one * fmpq(2**n, factorial(n + 1))
        right.append((mean + c[1] * xi / 2) * r_n)
        left.append((mean - c[0] * xi / 2) * r_n)
        first.append((force_1 + xi * r_n) / (2 * mu[0]))  # without a remainder
        second.append((force_2 - xi * r_n) / (2 * mu[1]) - _applied(b, second, n))
        b.append(c[0] * (mean + c[1] * xi / 2))
    return _solution(b[: order + 1], first, second)


def _optical(model: Model, order: int, progress: Progress[int]) -> Solution:
    # Contacts here also pull: the branch belongs to the odd extension of δ^k (or to odd k).
    # w - u = -(u/m̂_1)(1 + Y) and u(x + 2D) - w = (u/m̂_1)(1 + Z); E = 1 + kε.
    algebra = model.algebra(max(order, 1))
    k, mu, stiffness = model.elements(algebra)
    right, left = Force(algebra, k), Force(algebra, k)  # 1 + Y and 1 + Z
    first, second = (GradedSeries(algebra, k, [algebra.zero]) for _ in range(2))
    leading = GradedSeries(algebra, k, [algebra.r[1]])
    b = [algebra.one]
    for n in progress(range(1, order + 1)):
        r_n = algebra.r[n]
        shifted = stiffness[1] * left.increment(-2, n)
        b.append(-algebra.slope(shifted + _applied(b, first, n), n))
        right.append(mu[0] * b[n] * r_n)
        left.append((mu[0] * b[n] + mu[1] * fmpq(2**n, factorial(n))) * r_n)
        force = stiffness[0] * right.Phi[n] + stiffness[1] * left.Phi[n]
        first.append(force + shifted)
        second.append(force - b[n] * leading.dx(0, n - 1) - _applied(b, second, n))
    solution = _solution(b, first, second)
    E = (algebra.one, *(k * e for e in solution.acceleration[1:]))
    return replace(
        solution, acceleration=E, defect=tuple(k * d for d in solution.defect)
    )


def _solution(
    b: list[fmpq_mpoly], first: GradedSeries, second: GradedSeries
) -> Solution:
    """The solution with E_n of the first equation of motion and the defect first - second."""
    return Solution(
        algebra=first.algebra,
        acceleration=tuple(first),
        ansatz=tuple(b),
        defect=tuple(E_n - other for E_n, other in zip(first, second, strict=True)),
    )
