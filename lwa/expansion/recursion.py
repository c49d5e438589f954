"""The recursion for a chain's traveling wave: polynomials, exact at every order of ``ε = k - 1``.

The lattice's equations are expanded about a Gaussian. With the strain r_i and force f_i of contact
i, and the slope ``s_i = -u_i'`` of bead i's displacement (its velocity divided by c), each as a
function of the place ξ of its cell in the frame of the wave, and ``∂ = d/dξ``::

    f_i = f_{i-1} + P m̂_i γ ∂s_i,    s_{i+1} = s_i + C_i ∂r_i,    f_i = r_i^k,
    ∫_0^P s_0(ξ + x) dx = Σ C_i r_i(ξ),    γ Σ P m̂_i s_i(ξ) = ∫_0^P f_{P-1}(ξ - x) dx,

where the strains are in units of their leading shares C_i and ``c² = γ P/(M ā)``, ā the mean
compliance. The averages are series in the derivative. In the stretched place ``Z = √(ε/I) ξ``, with
``Ω² = κ² - I κ⁴ + …`` the linear chain's dispersion (`lwa.linear.bloch`), the force of the first
contact is::

    log f_0 = -Z²/4 + Σ_n q_n(Z) (ε/I)^{n/2},

the q_n are polynomials over Q[m̂, C, 1/I], and each solves ``q'' - Z q' + q = known + γ's next
term``, a triangular system; ``q_n(0) = q_n'(0) = 0`` makes the peak force 1, in the place 0. The
Gaussian as the limit: James & Pelinovsky, Proc. R. Soc. A 470, 20130462 (2014); its stability in
their log-KdV equation: Carles & Pelinovsky, Nonlinearity 27, 3185 (2014); under a load:
arXiv:1405.3385.

The algebra is in powers of t, ``(ε/I)^{1/2} = I t``, so that no denominators appear. The equations
at ``t^{n+2}`` give q_n: the fields are first computed with zero in its place, and at ``t^n`` the
solution is added to each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.model import Model
from lwa.expansion.pulse import Series, by_degree, exp_term, log_term
from lwa.linear.bloch import Bloch


class Pulse:
    """A field ``e^{-Z²/4} Σ S_n t^n`` of the wave, with the logarithm of its series.

    Terms are appended to one of the two, and the other follows.
    """

    def __init__(self) -> None:
        self.series: Series = []
        self.log: Series = []

    def append(self, term: fmpq_mpoly) -> None:
        """Append a coefficient of the series."""
        self.series.append(term)
        # A power of the field needs its logarithm.
        self.log.append(log_term(self.series, self.log))

    def append_log(self, term: fmpq_mpoly) -> None:
        """Append a coefficient of the logarithm."""
        self.log.append(term)
        self.series.append(exp_term(self.log, self.series))


class Recursion:
    """A chain's wave as power series in t over Q[Z, m̂, C].

    Parameters
    ----------
    model : Model
        The cell at its exponent.
    order : int
        Highest power of ε; that of t is twice as high.

    Attributes
    ----------
    Z, zero : polynomial
        The place Z and the number 0 in the ring Q[Z, m̂, C].
    mu, c : list of polynomial
        Mass fractions m̂_i of the beads, and shares C_i of the contacts.
    P : int
        Number of beads of a cell.
    I, epsilon : polynomial
        The dispersion of the linear chain, and ``I³``, by which ε is ``I³ t²``.
    force, strain : list of Pulse
        Forces and strains of the contacts.
    slope : list of Series
        The S_n of the slope of each bead's displacement.
    mean, push : Series
        The mean strain, and the force with which the last contact pushes the next cell.
    gamma : Series
        The square of the speed, divided by its leading term.
    """

    def __init__(self, model: Model, order: int) -> None:
        self.model = model
        self.order = order
        self.context = fmpq_mpoly_ctx.get(("Z", *model.names), Ordering.lex)
        self.Z = self.context.gen(0)
        self.zero = self.context.constant(0)
        self.mu = model.masses.elements(self.context)
        self.c = model.contacts.elements(self.context)
        self.P = model.cell.size
        self.I = self._dispersion()
        # -I times the logarithmic slope -Z/2 of the Gaussian e^{-Z²/4}
        self._fall = self.I * self.Z / 2
        # (ε/I)^{1/2} = I t, so that ε = I³ t²
        self.epsilon = self.I**3
        self.gamma: Series = [self.context.constant(1)]
        # The fields, still without a term: forces and strains of the contacts, slopes of the
        # beads' displacements, the mean strain, and the last contact's push on the next cell
        self.force = [Pulse() for _ in range(self.P)]
        self.strain = [Pulse() for _ in range(self.P)]
        self.slope: list[Series] = [[] for _ in range(self.P)]
        self.mean: Series = []
        self.push: Series = []
        # ε is in proportion to t²
        self._solve(2 * order)

    def _dispersion(self) -> fmpq_mpoly:
        """Coefficient I in the dispersion Ω² = κ² - I κ⁴ + … of the linear chain."""
        I = self.zero
        *_, fourth = Bloch(self.model).acoustic(2)  # coefficients of 1, κ² and κ⁴
        for exponents, coefficient in fourth.terms():
            # The ring of the wave has Z before the generators of the cell.
            powers = (0, *map(int, exponents))
            I = I - self.context.from_dict({powers: coefficient})
        return I

    def derivative(self, S: fmpq_mpoly) -> fmpq_mpoly:
        """The polynomial R of the derivative ``∂ (e^{-Z²/4} S t^n) = e^{-Z²/4} R t^{n+1}``."""
        if not S:
            return S
        return self.I * S.derivative(0) - self._fall * S

    # --- the order of the equations ---

    def _solve(self, order: int) -> None:
        """Solve for γ_2 at the order of the Gaussian, then for q_n and γ_{n+2}, n = 1, 2, …"""
        residual = self._residual(0)
        # γ_1 = 0: c² is even, since (Z, t) and (-Z, -t) are one wave.
        self.gamma += [self.zero, -residual]
        for n in range(1, order + 1):
            residual = self._residual(n)
            q, gamma = self._invert(residual)
            self.gamma.append(gamma)
            # Equal beads have no odd q_n, and their later terms stand.
            if q:
                self._put(n, q)
        self._truncate(order + 1)

    def _residual(self, n: int) -> fmpq_mpoly:
        """The residual at t^{n+2} of the balance of momentum, with 0 for q_n and later ones.

        It is ``γ Σ m̂_i s_i(ξ) - (1/P) ∫_0^P f_{P-1}(ξ - x) dx``, without the coefficient
        γ_{n+2}, which is not known yet.
        """
        # All fields are as long as `mean`: `_put` cuts them behind t^{n-1}; if q_{n-1} was 0, they
        # go on to t^{n+1}. The residual at t^{n+2} needs their terms up to t^{n+2}.
        for m in range(len(self.mean), n + 3):
            self._append(m)
        residual = self.zero
        for mu, slope in zip(self.mu, self.slope, strict=True):
            residual = residual + mu * self._accelerated(slope, n + 2)
        return residual - self._applied(self._cell_mean, self.push, n + 2)

    def _invert(self, residual: fmpq_mpoly) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Solve I³ (q'' - Z q' + q) = residual + γ, q(0) = q'(0) = 0, for q and γ."""
        # At Z^d the left side is I³ [(1 - d) q_d + (d + 2)(d + 1) q_{d+2}]: solved from the top.
        left = by_degree(residual)
        q = self.zero
        for d in range(max(left, default=0), 1, -1):
            a = left.get(d, self.zero) / ((1 - d) * self.epsilon)
            q = q + a * self.Z**d
            carried = d * (d - 1) * self.epsilon * a
            left[d - 2] = left.get(d - 2, self.zero) - carried
        if left.get(1, self.zero):
            raise ArithmeticError(
                "no wave at this order: the chain's equations are at odds"
            )
        return q, -left.get(0, self.zero)

    # --- the fields ---

    def _put(self, n: int, q: fmpq_mpoly) -> None:
        """Put q in the place of zero for q_n, and delete the terms of the fields beyond t^n."""
        self._truncate(n + 1)
        # A change of q_n adds q_n to the term at t^n of every field, strain, force and logarithm:
        # they differ by derivatives, which stand at higher powers of t.
        for row in self._rows():
            row[n] = row[n] + q

    def _truncate(self, n: int) -> None:
        """Delete the terms of the fields from t^n on."""
        for row in self._rows():
            del row[n:]

    def _rows(self) -> list[Series]:
        """The series of all fields, and the logarithms of forces and strains."""
        rows = [*self.slope, self.mean, self.push]
        for pulse in (*self.force, *self.strain):
            rows += [pulse.series, pulse.log]
        return rows

    def _append(self, n: int) -> None:
        """Append the terms at t^n to the fields, with zero for q_n."""
        # Forces from contact to contact, then strains, then slopes: each needs those before.
        self.force[0].append_log(self.zero)
        for i in range(1, self.P):
            self.force[i].append(self._next_force(i, n))
        mean = self.zero
        for i in range(self.P):
            strain = self.strain[i]
            strain.append_log(self._log_strain(self.force[i], n))
            mean = mean + self.c[i] * strain.series[n]
        self.mean.append(mean / self.P)
        self.push.append(self._last_force(n))
        self._append_slopes(n)

    def _next_force(self, i: int, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force of contact i, by the equation of motion of bead i."""
        return self.force[i - 1].series[n] + self._inertia(i, n)

    def _last_force(self, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force with which the last contact pushes the next cell."""
        return self.force[-1].series[n]

    def _inertia(self, i: int, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in P m̂_i γ ∂s_i, mass times acceleration of bead i."""
        # The derivative raises the power of t by one.
        if n == 0:
            return self.zero
        slope = self._accelerated(self.slope[i], n - 1)
        return self.P * self.mu[i] * self.derivative(slope)

    def _log_strain(self, force: Pulse, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in log r = (1 - ε + ε² - …) log f; that of Z²/4 at t^0 is left out."""
        total = self.zero
        for m in range(n // 2 + 1):
            factor = (-self.epsilon) ** m
            total = total + factor * force.log[n - 2 * m]
            if m > 0 and n == 2 * m:
                # The logarithm of the force's own Gaussian stands outside of its series.
                total = total - factor * self.Z**2 / 4
        return total

    def _append_slopes(self, n: int) -> None:
        """Append the terms at t^n to the slopes.

        ``∫_0^P s_0(ξ + x) dx = Σ C_i r_i``, P times the mean strain, gives s_0 as
        ``P∂/(e^{P∂} - 1)`` of the mean strain; the strain of each contact gives the next slope.
        """
        slope = self._applied(self._inverse_cell_mean, self.mean, n)
        for i in range(self.P):
            self.slope[i].append(slope)
            # s_{i+1} = s_i + C_i ∂r_i, and ∂ raises the power of t by one
            if n > 0:
                strain = self.strain[i].series[n - 1]
                slope = slope + self.c[i] * self.derivative(strain)

    def _accelerated(self, slope: Series, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in γ s_i, s_i the slope of a bead's displacement.

        Its derivative is the bead's acceleration, in the recursion's units.
        """
        # If γ ends before t^n the product lacks γ_n, the unknown that `_solve` finds next.
        total = self.zero
        for a, factor in enumerate(self.gamma[: n + 1]):
            if factor and slope[n - a]:
                total = total + factor * slope[n - a]
        return total

    def _applied(
        self, operator: Callable[[int], fmpq], field: Series, n: int
    ) -> fmpq_mpoly:
        """Coefficient of t^n in ``Σ_m operator(m) ∂^m`` of a field, by Horner's rule."""
        total = self.zero
        for m in range(n, -1, -1):
            total = self.derivative(total)
            total = total + operator(m) * field[n - m]
        return total

    def _cell_mean(self, m: int) -> fmpq:
        """Coefficient of ∂^m in the mean over a cell behind a place, ``(1 - e^{-P∂})/(P∂)``."""
        return fmpq((-self.P) ** m, factorial(m + 1))

    def _inverse_cell_mean(self, m: int) -> fmpq:
        """Coefficient of ∂^m in the inverse of the mean over a cell ahead, ``P∂/(e^{P∂} - 1)``."""
        taylor = fmpq(self.P**m, factorial(m))
        return taylor * fmpq.bernoulli(m)
