"""The recursion for a chain's traveling wave in ε = k - 1: polynomials, exact at every order.

The lattice's own equations are expanded about a Gaussian. With r_i, f_i the strain and force of
contact i, s_i = -u_i' the slope of bead i's displacement (its velocity over c), each in the frame
of its cell, ∂ = d/dξ,

    f_i = f_{i-1} + P μ_i γ ∂s_i,    s_{i+1} = s_i + c_i ∂r_i,    f_i = r_i^k,
    ∫_0^P s_0(ξ + x) dx = Σ c_i r_i(ξ),    γ Σ P μ_i s_i(ξ) = ∫_0^P f_{P-1}(ξ - x) dx,

where the strains are in units of their leading shares c_i and c² = γ P/(M ā), ā the mean
compliance. The averages are series in ∂. In the stretched place Z = √(ε/I) ξ, Ω² = κ² - I κ⁴ + …
the linear chain's dispersion (`lwa.bloch`), the force of the first contact is

    log f_0 = -Z²/4 + Σ_n q_n(Z) (ε/I)^{n/2},

the q_n are polynomials over Q[μ, c, 1/I], and each solves q'' - Z q' + q = known + γ's next term,
a triangular system; q_n(0) = q_n'(0) = 0 puts the peak, of force 1, at ξ = 0. The Gaussian as the
limit: James & Pelinovsky, Proc. R. Soc. A 470, 20130462 (2014).

The parameter in which the algebra runs is t, (ε/I)^{1/2} = I t: no denominators appear.
"""

from __future__ import annotations

from math import factorial

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx
from sympy import bernoulli

from lwa.bloch import Bloch
from lwa.coefficients import Coefficients, rational
from lwa.pulse import Series, by_degree, exp_term, log_term


class Recursion:
    """The fields of a wave, order by order in t, over the ring Q[μ, c] with Z for first generator.

    A field is e^{-Z²/4} Σ S_n t^n and is kept as its S_n; for each contact `force` and `strain`
    with their logarithms, for each bead `slope`, all of them lists over the cell.
    """

    def __init__(self, ring: Coefficients, order: int) -> None:
        self.context = fmpq_mpoly_ctx.get(("Z", *ring.names), Ordering.lex)
        self.Z, self.zero = self.context.gen(0), self.context.constant(0)
        self.mu = ring.masses.elements(self.context)
        self.c = ring.contacts.elements(self.context)
        self.P = P = ring.cell.size
        quartic = Bloch(ring).acoustic(2)[2]
        self.I = -self.context.from_dict({(0, *map(int, e)): c for e, c in quartic.terms()})
        self.epsilon = self.I**3  # of t²
        self.log_first: Series = [self.zero]
        self.gamma: Series = [self.context.constant(1)]
        self.force: list[Series] = [[] for _ in range(P)]
        self.strain: list[Series] = [[] for _ in range(P)]
        self.slope: list[Series] = [[] for _ in range(P)]
        self.log_force: list[Series] = [[] for _ in range(P)]
        self.log_strain: list[Series] = [[] for _ in range(P)]
        self.mean_strain: list[Series] = []  # n → the terms at t^n of its derivatives
        self._last_force: list[Series] = []
        self._solve(order)

    def derivative(self, S: fmpq_mpoly) -> fmpq_mpoly:
        """The term at t^{n+1} of ∂ (e^{-Z²/4} S t^n)."""
        return self.I * (S.derivative(0) - self.Z * S / 2)

    def _solve(self, order: int) -> None:
        """γ_2 closes the order at which the Gaussian does; then q_n and γ_{n+2} for n = 1, 2, …"""
        for n in range(3):
            residual = self._extend(n)
        self.gamma += [self.zero, -residual]
        self._truncate(1)
        for n in range(1, order + 1):
            self.log_first.append(self.zero)
            for m in range(n, n + 3):
                residual = self._extend(m)
            self.log_first[n], gamma = self._invert(residual)
            self.gamma.append(gamma)
            self._truncate(n)
            self._extend(n)

    def _invert(self, residual: fmpq_mpoly) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """q and γ of I³ (q'' - Z q' + q) = residual + γ, q(0) = q'(0) = 0."""
        left = by_degree(residual)
        q = self.zero
        for d in range(max(left, default=0), 1, -1):
            a = left.get(d, self.zero) / ((1 - d) * self.epsilon)
            q = q + a * self.Z**d
            left[d - 2] = left.get(d - 2, self.zero) - d * (d - 1) * self.epsilon * a
        if left.get(1, self.zero):
            raise ArithmeticError("no wave at this order: the chain's equations are at odds")
        return q, -left.get(0, self.zero)

    def _truncate(self, n: int) -> None:
        for group in (self.force, self.strain, self.slope, self.log_force, self.log_strain):
            for row in group:
                del row[n:]
        del self.mean_strain[n:], self._last_force[n:]

    def _extend(self, n: int) -> fmpq_mpoly:
        """Add the terms at t^n of all fields, q_n counting as 0 if it is not known; the residual.

        It is that of the momentum's balance, the last of the equations, over P.
        """
        gamma = {a: term for a, term in enumerate(self.gamma[: n + 1]) if term}
        for i in range(self.P):
            if i == 0:
                known = self.log_first + [self.zero] * (n + 1 - len(self.log_first))
                term = exp_term(known, self.force[0])
            else:
                term = self.force[i - 1][n]
                for a, factor in gamma.items():
                    if a < n:
                        slope = self.derivative(self.slope[i][n - 1 - a])
                        term = term + self.P * self.mu[i] * factor * slope
            self.force[i].append(term)
            self.log_force[i].append(log_term(self.force[i], self.log_force[i]))
            self.log_strain[i].append(self._log_strain(self.log_force[i], n))
            self.strain[i].append(exp_term(self.log_strain[i], self.strain[i]))
        total = sum((c * r[n] for c, r in zip(self.c, self.strain, strict=True)), self.zero)
        self.mean_strain.append(self._derivatives(total / self.P, self.mean_strain, n))
        self._last_force.append(self._derivatives(self.force[-1][n], self._last_force, n))
        slope = self.zero
        for m, term in enumerate(self.mean_strain[n]):  # P∂/(e^{P∂} - 1)
            slope = slope + fmpq(self.P**m, factorial(m)) * _bernoulli(m) * term
        for i in range(self.P):
            self.slope[i].append(slope)
            if n:
                slope = slope + self.c[i] * self.derivative(self.strain[i][n - 1])
        residual = self.zero
        for a, factor in gamma.items():
            for mu, row in zip(self.mu, self.slope, strict=True):
                residual = residual + factor * mu * row[n - a]
        for m, term in enumerate(self._last_force[n]):  # (1 - e^{-P∂})/(P∂)
            residual = residual - fmpq((-self.P) ** m, factorial(m + 1)) * term
        return residual

    def _log_strain(self, log_force: Series, n: int) -> fmpq_mpoly:
        """That of r = f^{1/(1+ε)}: (log f)(1 - ε + ε² - …), -Z²/4 included."""
        total = self.zero
        for m in range(n // 2 + 1):
            total = total + (-self.epsilon) ** m * log_force[n - 2 * m]
        if n and n % 2 == 0:
            total = total - (-self.epsilon) ** (n // 2) * self.Z**2 / 4
        return total

    def _derivatives(self, term: fmpq_mpoly, rows: list[Series], n: int) -> Series:
        """The terms at t^n of a field and of its n first derivatives."""
        return [term, *(self.derivative(rows[n - 1][m]) for m in range(n))]


def _bernoulli(m: int) -> fmpq:
    """B_m, with B_1 = -1/2."""
    return fmpq(-1, 2) if m == 1 else rational(bernoulli(m))
