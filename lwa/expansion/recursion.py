"""The recursion for a chain's traveling wave in ε = k - 1: polynomials, exact at every order.

The lattice's equations are expanded about a Gaussian. With the strain r_i and force f_i of contact
i, and the slope s_i = -u_i' of bead i's displacement (its velocity divided by c), each as a
function of the place ξ of its cell in the frame of the wave, and ∂ = d/dξ,

    f_i = f_{i-1} + P m̂_i γ ∂s_i,    s_{i+1} = s_i + C_i ∂r_i,    f_i = r_i^k,
    ∫_0^P s_0(ξ + x) dx = Σ C_i r_i(ξ),    γ Σ P m̂_i s_i(ξ) = ∫_0^P f_{P-1}(ξ - x) dx,

where the strains are in units of their leading shares C_i and c² = γ P/(M ā), ā the mean
compliance. The averages are series in ∂. In the stretched place Z = √(ε/I) ξ, Ω² = κ² - I κ⁴ + …
the linear chain's dispersion (`lwa.linear.bloch`), the force of the first contact is

    log f_0 = -Z²/4 + Σ_n q_n(Z) (ε/I)^{n/2},

the q_n are polynomials over Q[m̂, C, 1/I], and each solves q'' - Z q' + q = known + γ's next term,
a triangular system; q_n(0) = q_n'(0) = 0 makes the peak force 1, at ξ = 0. The Gaussian as the
limit: James & Pelinovsky, Proc. R. Soc. A 470, 20130462 (2014).

The algebra is in powers of t, (ε/I)^{1/2} = I t, so that no denominators appear.

q_n follows from the equations at t^{n+2}. From n = 3 on the fields are linear in q_n up to that
order: they are computed once with q_n = 0, and its contribution is added when q_n is known.
"""

from __future__ import annotations

from math import factorial

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx
from sympy import bernoulli

from lwa.algebra.model import Model
from lwa.algebra.ring import to_flint
from lwa.base.progress import Progress
from lwa.expansion.pulse import Series, by_degree, exp_term, log_term
from lwa.linear.bloch import Bloch

LINEAR = 3
"""The first n for which q_n² is beyond t^{n+2}. Without linear changes from there on an expansion
takes two to three times as long (orders 10 to 60, one to three beads)."""


class Fields:
    """Forces, strains and slopes of a wave, or changes of these: the S_n of e^{-Z²/4} Σ S_n t^n.

    `force` and `strain` (with their logarithms) have one field per contact, `slope` one per bead.
    `means` and `pushes` map n to the coefficients of t^n in the mean strain Σ C_i r_i / P or the
    last contact's force, and in the first n derivatives of these.
    """

    def __init__(self, size: int) -> None:
        self.force, self.strain, self.slope, self.log_force, self.log_strain = (
            [list[fmpq_mpoly]() for _ in range(size)] for _ in range(5)
        )
        self.means: list[Series] = []
        self.pushes: list[Series] = []

    @property
    def _rows(self) -> list[Series]:
        groups = (self.force, self.strain, self.slope, self.log_force, self.log_strain)
        return [row for group in groups for row in group]

    def truncate(self, n: int) -> None:
        """Delete the terms from t^n on."""
        for row in self._rows:
            del row[n:]
        del self.means[n:], self.pushes[n:]

    def add(self, change: Fields, n: int) -> None:
        """Add small changes of the fields, whose first terms are at t^n."""
        for row, terms in zip(self._rows, change._rows, strict=True):
            for j, term in enumerate(terms, start=n):
                row[j] = row[j] + term
        for rows, changes in ((self.means, change.means), (self.pushes, change.pushes)):
            for j, terms in enumerate(changes, start=n):
                for m, term in enumerate(terms):
                    rows[j][m] = rows[j][m] + term


class Recursion:
    """Solver of the recursion: a wave's `fields` as power series in t over Q[Z, m̂, C]."""

    def __init__(
        self, model: Model, order: int, progress: Progress[int] = iter
    ) -> None:
        self.context = fmpq_mpoly_ctx.get(("Z", *model.ring.names), Ordering.lex)
        self.Z, self.zero = self.context.gen(0), self.context.constant(0)
        self.mu = model.ring.masses.elements(self.context)
        self.c = model.ring.contacts.elements(self.context)
        self.P = model.cell.size
        quartic = Bloch(model).acoustic(2)[2]
        self.I = -self.context.from_dict(
            {(0, *map(int, e)): c for e, c in quartic.terms()}
        )
        self.epsilon = self.I**3  # ε = I³ t²
        self._half = self.Z / 2
        self.gamma: Series = [self.context.constant(1)]
        self.fields = Fields(self.P)
        self._solve(order, progress)

    def derivative(self, S: fmpq_mpoly) -> fmpq_mpoly:
        """The polynomial R of the derivative ∂ (e^{-Z²/4} S t^n) = e^{-Z²/4} R t^{n+1}."""
        return self.I * (S.derivative(0) - self._half * S) if S else S

    def _solve(self, order: int, progress: Progress[int]) -> None:
        """Solve for γ_2 at the order of the Gaussian, then for q_n and γ_{n+2}, n = 1, 2, …"""
        fields = self.fields
        for n in range(3):
            residual = self._extend(n)
        # γ_1 = 0: c² is even, (Z, t) and (-Z, -t) are one wave
        self.gamma += [self.zero, -residual]
        for n in progress(range(1, order + 1)):
            if n <= LINEAR:
                fields.truncate(n)
            for m in range(len(fields.means), n + 3):
                residual = self._extend(m)
            q, gamma = self._invert(residual)
            self.gamma.append(gamma)
            if n < LINEAR:
                fields.truncate(n)
                self._extend(n, q)
            elif q:
                fields.add(self._change(q), n)
        fields.truncate(order + 1)

    def _invert(self, residual: fmpq_mpoly) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Solve I³ (q'' - Z q' + q) = residual + γ, q(0) = q'(0) = 0, for q and γ."""
        # At Z^d the left side is I³ [(1 - d) q_d + (d + 2)(d + 1) q_{d+2}]: solved from the top.
        left = by_degree(residual)
        q = self.zero
        for d in range(max(left, default=0), 1, -1):
            a = left.get(d, self.zero) / ((1 - d) * self.epsilon)
            q = q + a * self.Z**d
            left[d - 2] = left.get(d - 2, self.zero) - d * (d - 1) * self.epsilon * a
        if left.get(1, self.zero):
            raise ArithmeticError(
                "no wave at this order: the chain's equations are at odds"
            )
        return q, -left.get(0, self.zero)

    def _extend(self, n: int, q: fmpq_mpoly | None = None) -> fmpq_mpoly:
        """Append the wave's terms at t^n, with q for q_n, by default 0; return the residual.

        The residual is that of the last equation, the balance of momentum, divided by P.
        """
        fields = self.fields
        self._step(fields, n, self.zero if q is None else q)
        residual = self.zero
        for mu, slope in zip(self.mu, fields.slope, strict=True):
            residual = residual + mu * self._accelerated(slope, n)
        for m, term in enumerate(fields.pushes[n]):  # (1 - e^{-P∂})/(P∂)
            residual = residual - fmpq((-self.P) ** m, factorial(m + 1)) * term
        return residual

    def _change(self, q: fmpq_mpoly) -> Fields:
        """Contribution of the term q_n of log f_0 to the fields at t^n … t^{n+2}, n ≥ `LINEAR`."""
        change = Fields(self.P)
        for j in range(3):
            self._step(change, j, self.zero if j else q)
        return change

    def _step(self, fields: Fields, n: int, q: fmpq_mpoly) -> None:
        """Append the terms at t^n to a wave's forces, strains and slopes or to changes of them."""
        wave, P = self.fields, range(self.P)
        linear = fields is not wave

        def exponential(log: Series, S: Series, of_wave: Series) -> fmpq_mpoly:
            return _last(log, of_wave) if linear else exp_term(log, S)  # δ e^S = e^S δS

        def logarithm(S: Series, log: Series, of_wave: Series) -> fmpq_mpoly:
            return (
                S[-1] - _last([*log, self.zero], of_wave)
                if linear
                else log_term(S, log)
            )

        for i in P:
            S, log = fields.force[i], fields.log_force[i]
            if i == 0:
                log.append(q)
                S.append(exponential(log, S, wave.force[0]))
            else:  # f_i = f_{i-1} + P m̂_i γ ∂s_i
                S.append(fields.force[i - 1][n])
                if n:
                    inertia = self.derivative(self._accelerated(fields.slope[i], n - 1))
                    S[n] = S[n] + self.P * self.mu[i] * inertia
                log.append(logarithm(S, log, wave.force[i]))
            # r = f^{1/(1+ε)}: log r = Σ (-ε)^m log f, whose Gaussian leaves -(-ε)^m Z²/4 for m ≥ 1
            gaussian = n and n % 2 == 0 and not linear
            log_r = (
                -((-self.epsilon) ** (n // 2)) * self.Z**2 / 4
                if gaussian
                else self.zero
            )
            for m in range(n // 2 + 1):
                log_r = log_r + (-self.epsilon) ** m * log[n - 2 * m]
            strain = fields.strain[i]
            fields.log_strain[i].append(log_r)
            strain.append(exponential(fields.log_strain[i], strain, wave.strain[i]))
        mean = sum(
            (c * r[n] for c, r in zip(self.c, fields.strain, strict=True)), self.zero
        )
        fields.means.append(self._derivatives(mean / self.P, fields.means))
        fields.pushes.append(self._derivatives(fields.force[-1][n], fields.pushes))
        slope = self.zero
        for m, term in enumerate(
            fields.means[n]
        ):  # s_0 = P∂/(e^{P∂} - 1) of the mean strain
            # Bernoulli's numbers, with B_1 = -1/2
            if factor := fmpq(-1, 2) if m == 1 else to_flint(bernoulli(m)):
                slope = slope + fmpq(self.P**m, factorial(m)) * factor * term
        for i in P:
            fields.slope[i].append(slope)
            if n:  # s_{i+1} = s_i + C_i ∂r_i
                slope = slope + self.c[i] * self.derivative(fields.strain[i][n - 1])

    def _accelerated(self, slope: Series, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in γ s_i, s_i the slope of a bead's displacement."""
        total = self.zero
        for a, factor in enumerate(self.gamma[: n + 1]):
            if factor and slope[n - a]:
                total = total + factor * slope[n - a]
        return total

    def _derivatives(self, term: fmpq_mpoly, rows: list[Series]) -> Series:
        """Coefficients of t^n in a field and its n first derivatives, from those of t^{n-1}."""
        return [term, *map(self.derivative, rows[-1])] if rows else [term]


def _last(a: Series, b: Series) -> fmpq_mpoly:
    """Coefficient of t^n in the product a · b of two series, n the last order of a."""
    n = len(a) - 1
    return sum((x * b[n - j] for j, x in enumerate(a) if x), 0 * b[0])
