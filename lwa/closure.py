"""The consistency condition: slaved fields that satisfy the equations of motion order by order.

All displacement fields w_0 … w_{P-1} of a cell are taken at the position x of its first particle
and expressed by one field φ: w_i = φ + D φ_x S_i, S_i a series in D of polynomials in the jets of
φ. In the units of `Cell.time_scale`, with F_i the force of contact i over A_eff D^k, the equations
of motion of the P particles are

    P k D μ_i ∂_ττ w_i = F_i(x) - F_{i-1}(x),    F_{-1}(x) = F_{P-1}(x - P D).

``linear`` is the closure of the paper (Porter et al. 2008, eq. 5): for the dimer, u = w_0 and
w = w_1 = λ (u + Σ b_n D^n ∂_x^n u), with the b_n found from the demand that both equations are
identical at each order. A linear ansatz has one unknown per order, which settles the monomial
∂_x^n u; the wave equation is then read off the first equation, and what the second one says
otherwise is kept as the defect.

``full`` lets S_i be any polynomial in the jets of φ and of φ_τ. All P equations can then be
satisfied at every order, and nothing has to be solved for: their sum (momentum) gives the next term
of the wave equation from lower orders, their partial sums the differences of the contact forces,
and these the strains.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import factorial

import sympy as sp
from flint import fmpq, fmpq_mpoly

from lwa.cell import Cell
from lwa.coefficients import Coefficients
from lwa.exact import InputError
from lwa.jets import JetAlgebra, Ladder, Power

BRANCHES = ("acoustic", "optical")
CLOSURES = ("linear", "full")
FIELDS = ("first", "center")


@dataclass(frozen=True)
class Closure:
    """The solved consistency condition, as polynomials.

    acceleration : E_n. Acoustic: φ_ττ = φ_x^k Σ_{n≥1} D^{n-1} E_n, E_1 = r_1 = φ_xx/φ_x.
        Optical: u_ττ = -u^k Σ_{n≥0} D^n E_n, E_0 = 1, in its own time unit.
    ansatz : b_n, n = 0 … order: the linear part λ Σ b_n D^n ∂_x^n φ of the second particle's
        field, which is all of it in the linear closure (polynomials in the parameters).
    slaved : for each particle S_n, n = 0 … order - 1, of w_i = φ + D φ_x Σ D^n S_n (full only).
    defect : E_n by the first equation minus E_n by the second, for the same ansatz.
    """

    ring: Coefficients
    algebra: JetAlgebra
    order: int
    name: str
    field: str
    ratio: sp.Expr
    acceleration: tuple[fmpq_mpoly, ...]
    ansatz: tuple[fmpq_mpoly, ...]
    slaved: tuple[tuple[fmpq_mpoly, ...], ...] = ()
    defect: tuple[fmpq_mpoly, ...] = ()


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


Progress = Callable[[Iterable[int]], Iterable[int]]
"""What the orders are run through on their way, such as `tqdm.tqdm`."""


def solve(
    ring: Coefficients, order: int, closure: str, field: str, progress: Progress = iter
) -> Closure:
    """The consistency condition by the named closure, for the named field.

    Raises `lwa.InputError` for the combinations that have no solution.
    """
    if closure == "linear" and field != "first":
        raise InputError(
            f"field is {field!r}: with the linear closure it is 'first', as in the paper"
        )
    if closure == "linear":
        return linear(ring, order, progress)
    if ring.branch == "acoustic":
        return full(ring, order, field, progress)
    if ring.k == 1 and field == "first":
        # the linear chain has a linear closure
        return replace(linear(ring, order, progress), name="full")
    raise InputError(
        "the optical branch oscillates at order D^0 and slaves no field algebraically unless "
        "k = 1: use the linear closure, or k = 1 with the field 'first'"
    )


def full(
    ring: Coefficients, order: int, field: str = "first", progress: Progress = iter
) -> Closure:
    """The closure that satisfies all equations of motion, to D^order in the slaved fields.

    ``field`` says which φ describes the chain: "first", the displacement of the first particle, or
    "center", the mean Σ μ_i w_i of the sublattice fields at one point, each w_i shifted back to x
    from where its particle rests in units of strain, x_i = c_0 + … + c_{i-1}.
    """
    algebra = JetAlgebra(ring.names, max(order - 1, 1), ring.exponent)
    P = ring.cell.size
    k = ring.exponent(algebra.context)
    mu = ring.masses.elements(algebra.context)
    c = ring.contacts.elements(algebra.context)
    positions = [sum(c[:i], algebra.zero) for i in range(P)]
    weights = mu if field == "center" else [algebra.one] + [algebra.zero] * (P - 1)

    force = [Power(algebra, k) for _ in range(P)]
    E = Ladder(algebra, k)
    E.append(algebra.zero)
    S = [Ladder(algebra, algebra.one) for _ in range(P)]  # w_i = φ + D φ_x S_i
    for ladder, x in zip(S, positions, strict=True):
        ladder.append(x)
    rate = [Ladder(algebra, algebra.half) for _ in range(P)]  # ∂_τ (D φ_x S_i)
    for ladder in rate:
        ladder.append(algebra.zero)
    for n in progress(range(1, order)):
        r_n = algebra.r[n] * fmpq(1, factorial(n + 1))
        slaved = [algebra.dt(ladder, E, n) for ladder in rate]
        if n + 1 < order:
            for i in range(P):
                rate[i].append(algebra.dt(S[i], E, n))
        # momentum: the sum of the equations, whose forces cancel but for the cell's ends
        E_n = -force[-1].carried(-P, n) / P
        for mu_i, acceleration in zip(mu, slaved, strict=True):
            E_n = E_n - mu_i * acceleration
        E.append(E_n)
        # partial sums: how the strains of the contacts differ from the first one's, Φ_i - Φ_0
        difference = [algebra.zero]
        for i in range(1, P):
            difference.append(difference[-1] + P * mu[i] * (E_n + slaved[i]))
        differs = [d + force[0].known - F.known for d, F in zip(difference, force, strict=True)]
        # all strains of a cell together: w_0(x + PD) - w_0(x)
        first = r_n * P ** (n + 1) + S[0].carried(P, n)
        for c_i, d in zip(c, differs, strict=True):
            first = first - c_i * d
        for F, d in zip(force, differs, strict=True):
            F.append(first / P + d)
        # what φ is: Σ weight_i w_i(x - x_i D) = φ
        relative = [algebra.zero]
        for c_i, F in zip(c[:-1], force[:-1], strict=True):
            relative.append(relative[-1] + c_i * F.X[n])
        origin = algebra.zero
        for weight, x, ladder, own in zip(weights, positions, S, relative, strict=True):
            if not weight.is_zero():
                moved = (-x) ** (n + 1) * r_n + ladder.carried(-x, n)
                origin = origin - weight * (own + moved)
        for ladder, own in zip(S, relative, strict=True):
            ladder.append(origin + own)
    b = [algebra.one, *(_linear_part(algebra, S[1], n) for n in range(order))] if P > 1 else []
    return Closure(
        ring=ring,
        algebra=algebra,
        order=order,
        name="full",
        field=field,
        ratio=sp.Integer(1),
        acceleration=tuple(E[n] for n in range(order)),
        ansatz=tuple(b),
        slaved=tuple(tuple(ladder[n] for n in range(order)) for ladder in S),
    )


def _linear_part(algebra: JetAlgebra, S: Ladder, n: int) -> fmpq_mpoly:
    return algebra.slope(S[n], n) if n else S[0]


def linear(ring: Coefficients, order: int, progress: Progress = iter) -> Closure:
    """The paper's closure, to D^order in the ansatz, on the branch of ``ring``.

    Raises `lwa.InputError` for cells of more than two particles, which the ansatz does not cover.
    """
    size = ring.cell.size
    if size == 1 and ring.branch == "acoustic":
        return _uniform(ring, order, progress)
    if size != 2:
        raise InputError(
            f"the cell has {size} masses: the linear closure's {ring.branch} branch wants two"
        )
    branch = _acoustic if ring.branch == "acoustic" else _optical
    return branch(ring, order, progress)


def _exact_quotient(numerator: fmpq_mpoly, divisor: fmpq_mpoly) -> fmpq_mpoly:
    """numerator/divisor where the mathematics says that it is a polynomial."""
    quotient, remainder = divmod(numerator, divisor)
    if not remainder.is_zero():
        raise AssertionError("a mass fraction does not divide its own equation of motion")
    return quotient


def _applied(b: list[fmpq_mpoly], f: Ladder, n: int) -> fmpq_mpoly:
    """Σ_{0<j<n} b_j ∂_x^j f_{n-j}: what the ansatz adds to a series, short of the newest b_n."""
    return sum((b[j] * f.dx(n - j, j) for j in range(1, min(n, len(f)))), f.algebra.zero)


def _acoustic(ring: Coefficients, order: int, progress: Progress) -> Closure:
    algebra = JetAlgebra(ring.names, max(order - 1, 1))
    k = ring.exponent(algebra.context)
    mu = ring.masses.elements(algebra.context)
    c = ring.contacts.elements(algebra.context)
    right, left = Power(algebra, k), Power(algebra, k)  # of w - u, and of u - w one cell on
    first, second = Ladder(algebra, k), Ladder(algebra, k)  # E by equation 1 and by equation 2
    first.append(algebra.zero)
    second.append(algebra.zero)
    b = [algebra.one, c[0]]  # order D^k: equal forces, so the first contact takes its share
    for n in progress(range(1, order)):
        # The strains of both contacts sum to u(x + 2D) - u(x). Let theirs differ by ξ r_n at D^n;
        # each equation is written as far as it is known, and its ξ r_n has the weight ±1.
        known = right.known - left.known
        one, two = known - left.carried(-2, n), -known
        condition = mu[1] * one - mu[0] * two + 2 * mu[0] * mu[1] * _applied(b, first, n)
        xi = -algebra.slope(condition, n)
        r_n = algebra.r[n]
        mean = algebra.one * fmpq(2**n, factorial(n + 1))
        right.append((mean + c[1] * xi / 2) * r_n)
        left.append((mean - c[0] * xi / 2) * r_n)
        first.append(_exact_quotient(one + xi * r_n, 2 * mu[0]))
        second.append(_exact_quotient(two - xi * r_n, 2 * mu[1]) - _applied(b, second, n))
        b.append(c[0] * (mean + c[1] * xi / 2))
    return _closure(ring, algebra, order, b[: order + 1], first, second)


def _optical(ring: Coefficients, order: int, progress: Progress) -> Closure:
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
    for n in progress(range(1, order + 1)):
        r_n = algebra.r[n]
        carried = stiffness[1] * left.carried(-2, n)
        b.append(-algebra.slope(carried + _applied(b, first, n), n))
        right.append(mu[0] * b[n] * r_n)
        left.append((mu[0] * b[n] + mu[1] * fmpq(2**n, factorial(n))) * r_n)
        force = stiffness[0] * right.Phi[n] + stiffness[1] * left.Phi[n]
        first.append(force + carried)
        second.append(force - b[n] * leading.dx(0, n - 1) - _applied(b, second, n))
    return _closure(ring, algebra, order, b, first, second)


def _uniform(ring: Coefficients, order: int, progress: Progress) -> Closure:
    # One particle per cell: nothing is slaved, and the one equation is the wave equation.
    algebra = JetAlgebra(ring.names, max(order - 1, 1))
    k = ring.exponent(algebra.context)
    force, E = Power(algebra, k), Ladder(algebra, k)
    E.append(algebra.zero)
    for n in progress(range(1, order)):
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
        field="first",
        ratio=sp.Integer(1) if acoustic else amplitude_ratios(ring.cell)["optical"],
        acceleration=tuple(acceleration),
        ansatz=tuple(b),
        defect=tuple(first[n] - second[n] for n in range(len(first))),
    )
