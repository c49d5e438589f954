"""Conservation laws of the wave equation: momentum, energy, and the potential behind them.

The equation u_ττ = u_x^k Σ D^{n-1} E_n conserves the momentum ∫ u_τ dx when every order is the
derivative of a flux, and it is variational, u_ττ = -δV/δu, when every order is minus the
variational derivative of a density V_n. Being of degree k in u, an order that is a derivative of
u_x^k F_n has V_n = u_x^{k+1} F_n / (k+1) for its only candidate (up to derivatives), by Euler's
theorem on homogeneous functions; the test is whether that candidate gives E_n back. Then
φ_τ²/2 + V is the density of a conserved energy.

The variational derivative in the jets' algebra: with V = p^{k+1} f,
∂V/∂u_x = p^k ((k+1) f - Σ r_n ∂f/∂r_n) and ∂V/∂(∂_x^{n+1} u) = p^k ∂f/∂r_n.
"""

from __future__ import annotations

from flint import fmpq_mpoly

from lwa.algebra.jets import JetAlgebra
from lwa.closure.consistency import Closure


def flux(closure: Closure, n: int) -> fmpq_mpoly | None:
    """F with E_n u_x^k = ∂_x (u_x^k F), n ≥ 2; None where there is none."""
    algebra, ring = closure.algebra, closure.model.ring
    return algebra.antiderivative(closure.acceleration[n], ring.exponent(algebra.context))


def variational_derivative(
    algebra: JetAlgebra, k: fmpq_mpoly, density: fmpq_mpoly, n: int
) -> fmpq_mpoly:
    """p^{-k} δ/δu of ∫ p^{k+1} f dx for a density f of weight n without the velocity.

    It is Σ_j (-∂_x)^j ∂V/∂(∂_x^j u), of weight n + 1.
    """
    slopes = [algebra.slope(density, j) for j in range(1, n + 1)]
    first = (k + 1) * density
    for j, slope in enumerate(slopes, start=1):
        first = first - algebra.r[j] * slope
    total = algebra.zero
    for j, part in enumerate([first, *slopes], start=1):
        for _ in range(j):
            part = -algebra.dx(part, k)
        total = total + part
    return total


def potential(closure: Closure, n: int, density: fmpq_mpoly | None) -> fmpq_mpoly | None:
    """(k+1) V_n / u_x^{k+1} if order n is variational, else None (velocity jets exclude it).

    density : the order's `flux`.
    """
    algebra = closure.algebra
    k = closure.model.ring.exponent(algebra.context)
    if density is None or algebra.velocity_slopes(closure.acceleration[n]):
        return None
    if variational_derivative(algebra, k, density, n - 1) != -(k + 1) * closure.acceleration[n]:
        return None
    return algebra.by_parts(density, k + 1)
