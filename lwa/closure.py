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

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import factorial
from typing import Any

import sympy as sp
from flint import fmpq, fmpq_mpoly

from lwa import latex
from lwa.cell import Cell, exponent, substitution
from lwa.coefficients import Coefficients
from lwa.exact import InputError
from lwa.jets import JetAlgebra, Ladder, Monomial, Power, exact_quotient

BRANCHES = ("acoustic", "optical")
CLOSURES = ("linear", "full")
FIELDS = ("first", "center")


@dataclass(frozen=True, eq=False, repr=False)
class Closure:
    """The solved consistency condition, as polynomials.

    It is known by its cell, exponent, order, closure, branch and field: by these it is compared,
    and when it is copied or pickled it is derived again from them.

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

    @property
    def key(self) -> tuple[Any, ...]:
        """What it is known by: the arguments of `solve`."""
        return (self.ring, self.order, self.name, self.field)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Closure) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __reduce__(self) -> tuple[Callable[..., Closure], tuple[Any, ...]]:
        return solve, self.key

    def __repr__(self) -> str:
        return (
            f"Closure({self.ring.cell!r}, order={self.order}, k={self.ring.k}, "
            f"closure={self.name!r}, branch={self.ring.branch!r}, field={self.field!r})"
        )

    def _repr_latex_(self) -> str:
        return latex.display(latex.ansatz(self, 4) or [latex.row(r"\lambda", self.ratio)])

    @cached_property
    def b(self) -> dict[int, sp.Expr]:
        """n → b_n of the ansatz, n ≥ 1."""
        return {
            n: self.ring.expression(self.algebra.terms(b).get(Monomial(()), []))
            for n, b in enumerate(self.ansatz)
            if n > 0
        }

    @property
    def fields(self) -> tuple[tuple[fmpq_mpoly, ...], ...]:
        """`slaved`, and the same of the linear ansatz (acoustic branch)."""
        if self.slaved:
            return self.slaved
        r, zero = self.algebra.r, self.algebra.zero
        first = tuple(zero for _ in range(self.order))
        second = tuple(b * r[n] for n, b in enumerate(self.ansatz[1:]))
        return (first, second) if self.ansatz else (first,)

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """Symbols besides those of the cell and the exponent."""
        return ()

    def at(self, **values: Any) -> Closure:
        """The closure for these values of the named symbols; see `lwa.cell.substitution`."""
        return self.anew(substitution(values, self.ring.cell, self.ring.k, self.symbols))

    def anew(
        self, new: Mapping[sp.Symbol, sp.Expr] | None = None, order: int | None = None
    ) -> Closure:
        """The same derivation with these values of its symbols, or to this order."""
        cell, k = self.ring.cell.replaced(new or {}), exponent(self.ring.k.xreplace(new or {}))
        ring = replace(self.ring, cell=cell, k=k)
        return solve(ring, order or self.order, self.name, self.field)


def amplitude_ratios(cell: Cell) -> dict[str, sp.Expr]:
    """λ = w/u of the uniform motions (order D^0) of a two-particle cell, by branch.

    With s the force that w = λu puts on a contact, the equations are m1 ü = 2s and m2 λ ü = -2s.
    They agree where s = 0, that is w = u (acoustic), or where m2 λ + m1 = 0 (optical).

    >>> amplitude_ratios(Cell(sp.symbols("m1 m2", positive=True)))
    {'acoustic': 1, 'optical': -m1/m2}
    """
    m1, m2 = cell.masses
    return {"acoustic": sp.Integer(1), "optical": -sp.cancel(m1 / m2)}


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
    chain = _Slaving(ring, order, field)
    for n in progress(range(1, order)):
        chain.extend(n)
    S = [particle.S for particle in chain.particles]
    b = [_linear_part(chain.algebra, S[1], n) for n in range(order)] if len(S) > 1 else []
    return Closure(
        ring=ring,
        algebra=chain.algebra,
        order=order,
        name="full",
        field=field,
        ratio=sp.Integer(1),
        acceleration=tuple(chain.E[n] for n in range(order)),
        ansatz=(chain.algebra.one, *b) if b else (),
        slaved=tuple(tuple(ladder[n] for n in range(order)) for ladder in S),
    )


class _Particle:
    """A particle w = φ + D φ_x S of the cell and the contact to the next one.

    mu, c : its mass fraction and the contact's share.
    x : where it rests, in units of strain.
    weight : with which it enters φ.
    rate : the series ∂_τ (D φ_x S).
    force : that of the contact.
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
        self.force = Power(algebra, k)


class _Slaving:
    """The recursion of the full closure, one order of D at a time."""

    def __init__(self, ring: Coefficients, order: int, field: str) -> None:
        self.algebra = algebra = JetAlgebra(ring.names, max(order - 1, 1), ring.exponent)
        self.order = order
        k = ring.exponent(algebra.context)
        self.E = Ladder(algebra, k)
        self.E.append(algebra.zero)
        self.particles: list[_Particle] = []
        x = algebra.zero
        for mu, c in zip(
            ring.masses.elements(algebra.context),
            ring.contacts.elements(algebra.context),
            strict=True,
        ):
            self.particles.append(_Particle(algebra, k, mu, c, x))
            x = x + c
        self.particles[0].weight = algebra.one
        if field == "center":
            for particle in self.particles:
                particle.weight = particle.mu

    def extend(self, n: int) -> None:
        """E_n, and all series to D^n."""
        accelerations = [self.algebra.dt(particle.rate, self.E, n) for particle in self.particles]
        if n + 1 < self.order:
            for particle in self.particles:
                particle.rate.append(self.algebra.dt(particle.S, self.E, n))
        self._momentum(n, accelerations)
        self._strains(n, accelerations)
        self._origin(n)

    def _momentum(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """The sum of the equations, whose forces cancel but for those at the cell's ends."""
        P = len(self.particles)
        E_n = -self.particles[-1].force.carried(-P, n) / P
        for particle, acceleration in zip(self.particles, accelerations, strict=True):
            E_n = E_n - particle.mu * acceleration
        self.E.append(E_n)

    def _strains(self, n: int, accelerations: list[fmpq_mpoly]) -> None:
        """Partial sums give Φ_i - Φ_0, and all strains together w_0(x + PD) - w_0(x)."""
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
        """What φ is, Σ weight_i w_i(x - x_i D) = φ, places the first particle."""
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
        """What the shift of φ by D adds at D^{n+1}, over φ_x."""
        return self.algebra.r[n] * fmpq(1, factorial(n + 1))


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
            f"the cell has {size} masses: the linear closure's {ring.branch} branch wants two; "
            'closure="full" (--closure full) covers the acoustic branch of any cell'
        )
    branch = _acoustic if ring.branch == "acoustic" else _optical
    return branch(ring, order, progress)


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
        first.append(exact_quotient(one + xi * r_n, 2 * mu[0]))
        second.append(exact_quotient(two - xi * r_n, 2 * mu[1]) - _applied(b, second, n))
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
