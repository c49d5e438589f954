"""The consistency condition: slaved fields that satisfy the equations of motion order by order.

The particles of a cell share one position x, that of the first one, whose displacement field is
u; the field of particle i > 0 is slaved to it. In the units of `Cell.time_scale`, with F_i the
force of contact i over A_eff D^k, the equations of motion of the P particles are

    P k D μ_i ∂_ττ w_i = F_i(x) - F_{i-1}(x),    F_{-1}(x) = F_{P-1}(x - P D).

``linear`` is the closure of the paper (Porter et al. 2008, eq. 5): for the dimer
w = λ (u + Σ b_n D^n ∂_x^n u), with the b_n found from the demand that both equations are identical
at each order. A linear ansatz has one unknown per order, which settles the monomial ∂_x^n u; the
wave equation is then read off the first equation, and what the second one says otherwise is kept
as the defect.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import sympy as sp
from flint import fmpq, fmpq_mpoly

from lwa.cell import Cell
from lwa.coefficients import Coefficients
from lwa.exact import InputError
from lwa.jets import JetAlgebra, Ladder, Power

BRANCHES = ("acoustic", "optical")
CLOSURES = ("linear",)


@dataclass(frozen=True)
class Closure:
    """The solved consistency condition, as polynomials.

    acceleration : E_n. Acoustic: u_ττ = u_x^k Σ_{n≥1} D^{n-1} E_n, E_1 = r_1 = u_xx/u_x.
        Optical: u_ττ = -u^k Σ_{n≥0} D^n E_n, E_0 = 1, in its own time unit.
    ansatz : b_n for n = 0 … order, of w = λ Σ b_n D^n ∂_x^n u (polynomials in the parameters).
    defect : E_n by the first equation minus E_n by the second, for the same ansatz.
    """

    ring: Coefficients
    algebra: JetAlgebra
    order: int
    name: str
    ratio: sp.Expr
    acceleration: tuple[fmpq_mpoly, ...]
    ansatz: tuple[fmpq_mpoly, ...]
    defect: tuple[fmpq_mpoly, ...]


def amplitude_ratios(cell: Cell) -> dict[str, sp.Expr]:
    """λ = w/u of the uniform motions (order D^0) of a two-particle cell, by branch.

    With s the force that w = λu puts on a contact, the equations are m1 ü = 2s and m2 λ ü = -2s.
    They agree where s = 0, that is w = u (acoustic), or where m2 λ + m1 = 0 (optical).

    >>> amplitude_ratios(Cell(sp.symbols("m1 m2", positive=True)))
    {'acoustic': 1, 'optical': -m1/m2}
    """
    m1, m2 = cell.masses
    lam = sp.Symbol("lambda")
    s = lam - 1  # the force vanishes with the strain, and only there
    first, second = 2 * s, -2 * s
    condition = sp.Poly(sp.expand(m2 * lam * first - m1 * second), lam)
    optical, remainder = sp.div(condition, sp.Poly(lam - 1, lam))
    if not remainder.is_zero:
        raise AssertionError("w = u moves the chain as a whole and is always a solution")
    slope, constant = optical.all_coeffs()
    return {"acoustic": sp.Integer(1), "optical": sp.cancel(-constant / slope)}


def linear(ring: Coefficients, order: int) -> Closure:
    """The paper's closure, to D^order in the ansatz, on the branch of ``ring``.

    Raises `lwa.InputError` for cells of more than two particles, which the ansatz does not cover.
    """
    size = ring.cell.size
    if size == 1 and ring.branch == "acoustic":
        return _uniform(ring, order)
    if size != 2:
        raise InputError(
            f"the cell has {size} masses: the linear closure's {ring.branch} branch wants two"
        )
    return _acoustic(ring, order) if ring.branch == "acoustic" else _optical(ring, order)


def _exact_quotient(numerator: fmpq_mpoly, divisor: fmpq_mpoly) -> fmpq_mpoly:
    """numerator/divisor where the mathematics says that it is a polynomial."""
    quotient, remainder = divmod(numerator, divisor)
    if not remainder.is_zero():
        raise AssertionError("a mass fraction does not divide its own equation of motion")
    return quotient


def _applied(b: list[fmpq_mpoly], f: Ladder, n: int) -> fmpq_mpoly:
    """Σ_{0<j<n} b_j ∂_x^j f_{n-j}: what the ansatz adds to a series, short of the newest b_n."""
    return sum((b[j] * f.dx(n - j, j) for j in range(1, min(n, len(f)))), f.algebra.zero)


def _acoustic(ring: Coefficients, order: int) -> Closure:
    algebra = JetAlgebra(ring.names, max(order - 1, 1))
    k = ring.exponent(algebra.context)
    mu = ring.masses.elements(algebra.context)
    c = ring.contacts.elements(algebra.context)
    right, left = Power(algebra, k), Power(algebra, k)  # of w - u, and of u - w one cell on
    first, second = Ladder(algebra, k), Ladder(algebra, k)  # E by equation 1 and by equation 2
    first.append(algebra.zero)
    second.append(algebra.zero)
    b = [algebra.one, c[0]]  # order D^k: equal forces, so the first contact takes its share
    for n in range(1, order):
        # The strains of both contacts sum to u(x + 2D) - u(x). Let theirs differ by ξ r_n at D^n;
        # each equation is written as far as it is known, and its ξ r_n has the weight ±1.
        known = right.known(n) - left.known(n)
        one, two = known - left.carried(-2, n), -known
        condition = mu[1] * one - mu[0] * two + 2 * mu[0] * mu[1] * _applied(b, first, n)
        xi = -algebra.linear(condition, n)
        r_n = algebra.r[n]
        mean = algebra.one * fmpq(2**n, factorial(n + 1))
        right.append((mean + c[1] * xi / 2) * r_n)
        left.append((mean - c[0] * xi / 2) * r_n)
        first.append(_exact_quotient(one + xi * r_n, 2 * mu[0]))
        second.append(_exact_quotient(two - xi * r_n, 2 * mu[1]) - _applied(b, second, n))
        b.append(c[0] * (mean + c[1] * xi / 2))
    return _closure(ring, algebra, order, b[: order + 1], first, second)


def _optical(ring: Coefficients, order: int) -> Closure:
    # Contacts here also pull: the branch belongs to the odd extension of δ^k (or to odd k).
    # w - u = -(u/μ_1)(1 + Y) and u(x + 2D) - w = (u/μ_1)(1 + Z); E = 1 + kε.
    algebra = JetAlgebra(ring.names, max(order, 1))
    k = ring.exponent(algebra.context)
    mu = ring.masses.elements(algebra.context)
    stiffness = ring.contacts.elements(algebra.context)
    right, left = Power(algebra, k), Power(algebra, k)  # 1 + Y and 1 + Z
    first, second, leading = Ladder(algebra, k), Ladder(algebra, k), Ladder(algebra, k)
    first.append(algebra.zero)
    second.append(algebra.zero)
    leading.append(algebra.r[1])
    b = [algebra.one]
    for n in range(1, order + 1):
        r_n = algebra.r[n]
        carried = stiffness[1] * left.carried(-2, n)
        b.append(-algebra.linear(carried + _applied(b, first, n), n))
        right.append(mu[0] * b[n] * r_n)
        left.append((mu[0] * b[n] + mu[1] * fmpq(2**n, factorial(n))) * r_n)
        force = stiffness[0] * right.Phi[n] + stiffness[1] * left.Phi[n]
        first.append(force + carried)
        second.append(force - b[n] * leading.dx(0, n - 1) - _applied(b, second, n))
    return _closure(ring, algebra, order, b, first, second)


def _uniform(ring: Coefficients, order: int) -> Closure:
    # One particle per cell: nothing is slaved, and the one equation is the wave equation.
    algebra = JetAlgebra(ring.names, max(order - 1, 1))
    k = ring.exponent(algebra.context)
    force, E = Power(algebra, k), Ladder(algebra, k)
    E.append(algebra.zero)
    for n in range(1, order):
        force.append(algebra.r[n] * fmpq(1, factorial(n + 1)))
        E.append(-force.carried(-1, n))
    return _closure(ring, algebra, order, [], E, E)


def _closure(
    ring: Coefficients,
    algebra: JetAlgebra,
    order: int,
    b: list[fmpq_mpoly],
    first: Ladder,
    second: Ladder,
) -> Closure:
    acoustic = ring.branch == "acoustic"
    acceleration = [first[n] for n in range(len(first))]
    if not acoustic:
        k = ring.exponent(algebra.context)
        acceleration = [algebra.one, *(k * e for e in acceleration[1:])]
    return Closure(
        ring=ring,
        algebra=algebra,
        order=order,
        name="linear",
        ratio=sp.Integer(1) if acoustic else amplitude_ratios(ring.cell)["optical"],
        acceleration=tuple(acceleration),
        ansatz=tuple(b),
        defect=tuple(first[n] - second[n] for n in range(len(first))),
    )
