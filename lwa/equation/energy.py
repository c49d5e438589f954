"""Conserved quantities of the wave equation: momentum and energy.

Letters: D is the spacing, P the number of particles of a cell, ``m̂_i`` a mass fraction, ``C_i`` the
strain share of a contact; ``p = u_x`` is the strain, ``r_n = ∂_x^n p / p`` (`lwa.algebra.jets`).
``E_n``, a polynomial in the ``r_n``, is the term of the wave equation
``u_ττ = u_x^k Σ_{n≥1} D^{n-1} E_n``.

**Momentum.** The momentum ``∫ u_τ dx`` is conserved if every order has a flux, a polynomial ``F_n``
with ``u_x^k E_n = ∂_x (u_x^k F_n)``.

**Energy of the chain.** Let ``w_i`` be the field of particle i, ``C_i p (1 + X_i)`` the strain of
contact i, F the force in the units of the wave equation (``p^k/k`` for a power) and W its energy,
``W′ = F``. The energy of a cell per length is::

    e = ½ Σ m̂_i (∂_τ w_i)² + Σ C_i W(p (1 + X_i)) / P = u_τ²/2 + W(u_x) + ….

With ``F_{-1}`` the force on particle 0 from the cell before, the equations of motion give::

    ∂_τ e = (e^{PD∂} - 1) (F_{-1} ∂_τ w_0) / (PD),    ∂ = ∂_x,

the derivative of the flux of energy. This holds for any wave equation that the slaved fields
satisfy, in every field, whether or not the equation derives from a potential. The density is given
up to derivatives, so that no highest jet stands in it linearly.

**Theorem** (proof: the book on cells). At ``D^{k+3}`` the equation of the canonical field φ, the
mean ``Σ m̂_i w_i`` of the fields shifted to one point, derives from a potential for every cell::

    G = I(k-1)(k-2)/2,    H = 2I(k-1),

and I is the coefficient in the linear chain's dispersion ``Ω² = κ² (1 - (I/D²) κ² + …)``. With
``W(φ_x)`` in place of the power it holds for every law with equal contacts.
"""

from __future__ import annotations

from flint import fmpq_mpoly

from lwa.algebra.jets import taylor
from lwa.base.exact import InputError
from lwa.closure.consistency import Closure
from lwa.closure.slaving import Solution


def conservative(closure: Closure) -> bool:
    """True if momentum is conserved: every order has a flux, ``u_x^k E_n = ∂_x (u_x^k F_n)``."""
    # By parts the flux leaves, and nothing is left of E_n. ``E_1 = r_1`` has the flux 1/k.
    algebra = closure.solution.algebra
    orders = closure.solution.acceleration[2:]
    return all(algebra.by_parts(E, algebra.k).is_zero() for E in orders)


def energy(closure: Closure) -> list[fmpq_mpoly]:
    """The energy density e of the chain, up to derivatives, to ``D^{order-2}``.

    Returns the terms of ``(e - W(u_x)) / (u_x² F′(u_x))``; under a power ``u_x² F′`` is
    ``u_x^{k+1}``.

    Raises
    ------
    InputError
        On the optical branch, and for the linear closure of two particles.
    """
    if closure.model.branch != "acoustic":
        raise InputError(
            "the energy in the slaved fields is that of the acoustic branch"
        )
    solution = closure.solution
    # The linear closure keeps no forces.
    if not solution.forces:
        raise InputError(
            "the linear closure does not satisfy both equations of motion (see the defect), so "
            "that no energy is conserved",
            closure="full",
        )
    algebra = solution.algebra
    # The density is known to the order to which the velocities are.
    densities = []
    for n in range(closure.model.order - 1):
        density = _kinetic(solution, n) + _elastic(solution, n)
        densities.append(algebra.by_parts(density, algebra.k + 1))
    return densities


def _kinetic(solution: Solution, n: int) -> fmpq_mpoly:
    """Coefficient of ``D^n`` in the kinetic energy ``½ Σ m̂_i (∂_τ w_i)²`` over ``p² F′``."""
    algebra = solution.algebra
    total = algebra.zero
    for mu, rate in zip(algebra.mu, solution.rates, strict=True):
        # ∂_τ w_i = φ_τ + ∂_τ (D φ_x S_i)
        velocity = list(rate)
        velocity[0] = algebra.s[0]
        for j in range(n + 1):
            total = total + mu * velocity[j] * velocity[n - j] / 2
    return total


def _elastic(solution: Solution, n: int) -> fmpq_mpoly:
    """Coefficient of ``D^n`` in ``[Σ C_i W(p (1 + X_i)) / P - W(p)] / (p² F′)``."""
    algebra = solution.algebra
    total = algebra.zero
    # At D^0 every strain is the mean one, whose energy W(p) stands apart.
    if n == 0:
        return total
    for c, force in zip(algebra.c, solution.forces, strict=True):
        total = total + c * force.work(n)
    # W(p (1 + X)) is W(p) + F(p) p X + p² F′ · work: the terms F(p) p X of all contacts are left.
    # The strains of a cell sum to Σ C_i p (1 + X_i) = [w_0(x + PD) - w_0(x)]/D. As Σ C_i = P, this
    # gives Σ C_i p X_i = ∂_x Y with Y = Σ_j P (PD∂_x)^j/(j+1)! w_0 - Pφ. By parts F(p) ∂_x Y / P
    # becomes -∂_x F(p) Y / P = -p F′ r_1 Y / P.
    P = len(solution.fields)
    # The coefficient of D^n in Y/p, from w_0 = φ + D p S_0
    Y = algebra.r[n - 1] * taylor(P, n + 1)
    for j in range(n):
        Y = Y + solution.fields[0].dx(n - 1 - j, j) * taylor(P, j + 1)
    return (total - algebra.r[1] * Y) / P
