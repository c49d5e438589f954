"""The recursion for a chain's traveling wave in ε = k - 1: polynomials, exact at every order.

The lattice's equations are expanded about a Gaussian. With the strain r_i and force f_i of contact
i, and the slope s_i = -u_i' of bead i's displacement (its velocity divided by c), each as a
function of the place ξ of its cell in the frame of the wave, and ∂ = d/dξ::

    f_i = f_{i-1} + P m̂_i γ ∂s_i,    s_{i+1} = s_i + C_i ∂r_i,    f_i = r_i^k,
    ∫_0^P s_0(ξ + x) dx = Σ C_i r_i(ξ),    γ Σ P m̂_i s_i(ξ) = ∫_0^P f_{P-1}(ξ - x) dx,

where the strains are in units of their leading shares C_i and c² = γ P/(M ā), ā the mean
compliance. The averages are series in ∂. In the stretched place Z = √(ε/I) ξ, Ω² = κ² - I κ⁴ + …
the linear chain's dispersion (`lwa.linear.bloch`), the force of the first contact is::

    log f_0 = -Z²/4 + Σ_n q_n(Z) (ε/I)^{n/2},

the q_n are polynomials over Q[m̂, C, 1/I], and each solves q'' - Z q' + q = known + γ's next term,
a triangular system; q_n(0) = q_n'(0) = 0 makes the peak force 1, at ξ = 0. The Gaussian as the
limit: James & Pelinovsky, Proc. R. Soc. A 470, 20130462 (2014); its stability in their log-KdV
equation: Carles & Pelinovsky, Nonlinearity 27, 3185 (2014); under a load: arXiv:1405.3385.

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
from lwa.expansion.pulse import Series, by_degree, exp_term, last, log_term
from lwa.linear.bloch import Bloch

LINEAR = 3
"""The first n for which q_n² is beyond t^{n+2}. Without linear changes from there on an expansion
takes two to three times as long (orders 10 to 60, one to three beads)."""


class Pulse:
    """A field e^{-Z²/4} Σ S_n t^n of the wave, with the logarithm of its series.

    Terms are appended to one of the two, and the other follows.
    """

    def __init__(self) -> None:
        self.series: Series = []
        self.log: Series = []

    def append(self, term: fmpq_mpoly) -> None:
        """Append a coefficient of the series."""
        self.series.append(term)
        self.log.append(log_term(self.series, self.log))

    def append_log(self, term: fmpq_mpoly) -> None:
        """Append a coefficient of the logarithm."""
        self.log.append(term)
        self.series.append(exp_term(self.log, self.series))


class Variation(Pulse):
    """A small change of a field e^{-Z²/4} S of the wave: δS = S δ log S."""

    def __init__(self, changed: Pulse) -> None:
        super().__init__()
        self.changed = changed

    def append(self, term: fmpq_mpoly) -> None:
        self.series.append(term)
        known = last([*self.log, 0 * term], self.changed.series)
        self.log.append(term - known)

    def append_log(self, term: fmpq_mpoly) -> None:
        self.log.append(term)
        self.series.append(last(self.log, self.changed.series))


class Fields:
    """Forces, strains and slopes of a wave, or variations of these.

    force, strain : one field per contact.
    slope : the S_n of one field per bead.
    means, pushes : mappings from n to the coefficients of t^n in the mean strain Σ C_i r_i / P, or
        in the last contact's force, and in the first n derivatives of these.
    gaussian : Z²/4 of the wave's e^{-Z²/4}, which a power of a field divides by k; 0 in variations.
    """

    def __init__(
        self, force: list[Pulse], strain: list[Pulse], gaussian: fmpq_mpoly
    ) -> None:
        self.force = force
        self.strain = strain
        self.slope: list[Series] = [[] for _ in force]
        self.means: list[Series] = []
        self.pushes: list[Series] = []
        self.gaussian = gaussian

    @property
    def _rows(self) -> list[Series]:
        rows = list(self.slope)
        for pulse in (*self.force, *self.strain):
            rows += [pulse.series, pulse.log]
        return rows

    def truncate(self, n: int) -> None:
        """Delete the terms from t^n on."""
        for row in self._rows:
            del row[n:]
        del self.means[n:], self.pushes[n:]

    def add(self, change: Fields, n: int) -> None:
        """Add variations of the fields, whose first terms are at t^n."""
        for row, terms in zip(self._rows, change._rows, strict=True):
            for j, term in enumerate(terms, start=n):
                row[j] = row[j] + term
        for rows, changes in ((self.means, change.means), (self.pushes, change.pushes)):
            for j, terms in enumerate(changes, start=n):
                for m, term in enumerate(terms):
                    rows[j][m] = rows[j][m] + term


class Recursion:
    """Solver of the recursion: a wave's `fields` as power series in t over Q[Z, m̂, C].

    model : the cell at its exponent.
    order : highest power of ε; that of t is twice as high.
    """

    def __init__(self, model: Model, order: int) -> None:
        self.model = model
        self.order = order
        self.context = fmpq_mpoly_ctx.get(("Z", *model.ring.names), Ordering.lex)
        self.Z = self.context.gen(0)
        self.zero = self.context.constant(0)
        self.mu = model.ring.masses.elements(self.context)
        self.c = model.ring.contacts.elements(self.context)
        self.P = model.cell.size
        self.I = self._dispersion()
        self.epsilon = self.I**3  # ε = I³ t²
        self._half = self.Z / 2
        self.gamma: Series = [self.context.constant(1)]
        contacts = range(self.P)
        self.fields = Fields(
            [Pulse() for _ in contacts], [Pulse() for _ in contacts], self.Z**2 / 4
        )
        self._solve(2 * order)

    def _dispersion(self) -> fmpq_mpoly:
        """Coefficient I in the dispersion Ω² = κ² - I κ⁴ + … of the linear chain."""
        I = self.zero
        for exponents, coefficient in Bloch(self.model).acoustic(2)[2].terms():
            powers = (0, *map(int, exponents))
            I = I - self.context.from_dict({powers: coefficient})
        return I

    def derivative(self, S: fmpq_mpoly) -> fmpq_mpoly:
        """The polynomial R of the derivative ∂ (e^{-Z²/4} S t^n) = e^{-Z²/4} R t^{n+1}."""
        if not S:
            return S
        return self.I * (S.derivative(0) - self._half * S)

    def _solve(self, order: int) -> None:
        """Solve for γ_2 at the order of the Gaussian, then for q_n and γ_{n+2}, n = 1, 2, …"""
        fields = self.fields
        for n in range(3):
            residual = self._extend(n, self.zero)
        # γ_1 = 0: c² is even, (Z, t) and (-Z, -t) are one wave
        self.gamma += [self.zero, -residual]
        for n in range(1, order + 1):
            if n <= LINEAR:
                fields.truncate(n)
            for m in range(len(fields.means), n + 3):
                residual = self._extend(m, self.zero)
            q, gamma = self._invert(residual)
            self.gamma.append(gamma)
            if n < LINEAR:
                fields.truncate(n)
                self._extend(n, q)
            elif q:
                fields.add(self._variation(q), n)
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

    def _extend(self, n: int, q: fmpq_mpoly) -> fmpq_mpoly:
        """Append the wave's terms at t^n, with q for q_n; return the residual.

        The residual is that of the last equation, the balance of momentum, divided by P.
        """
        fields = self.fields
        self._append(fields, n, q)
        residual = self.zero
        for mu, slope in zip(self.mu, fields.slope, strict=True):
            residual = residual + mu * self._accelerated(slope, n)
        for m, term in enumerate(fields.pushes[n]):  # (1 - e^{-P∂})/(P∂)
            residual = residual - fmpq((-self.P) ** m, factorial(m + 1)) * term
        return residual

    def _variation(self, q: fmpq_mpoly) -> Fields:
        """Contribution of the term q_n of log f_0 to the fields at t^n … t^{n+2}, n ≥ `LINEAR`."""
        wave = self.fields
        force: list[Pulse] = [Variation(pulse) for pulse in wave.force]
        strain: list[Pulse] = [Variation(pulse) for pulse in wave.strain]
        change = Fields(force, strain, self.zero)
        self._append(change, 0, q)
        for j in (1, 2):
            self._append(change, j, self.zero)
        return change

    def _append(self, fields: Fields, n: int, q: fmpq_mpoly) -> None:
        """Append the terms at t^n to the fields of a wave or to variations of these."""
        fields.force[0].append_log(q)
        for i in range(1, self.P):
            fields.force[i].append(self._next_force(fields, i, n))
        for force, strain in zip(fields.force, fields.strain, strict=True):
            strain.append_log(self._log_strain(fields, force, n))
        mean = self.zero
        for c, strain in zip(self.c, fields.strain, strict=True):
            mean = mean + c * strain.series[n]
        push = self._last_force(fields, n)
        fields.means.append(self._derivatives(mean / self.P, fields.means))
        fields.pushes.append(self._derivatives(push, fields.pushes))
        self._append_slopes(fields, n)

    def _next_force(self, fields: Fields, i: int, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force of contact i, by the equation of motion of bead i."""
        return fields.force[i - 1].series[n] + self._inertia(fields, i, n)

    def _last_force(self, fields: Fields, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in the force with which the last contact pushes the next cell."""
        return fields.force[-1].series[n]

    def _inertia(self, fields: Fields, i: int, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in P m̂_i γ ∂s_i, mass times acceleration of bead i."""
        if n == 0:
            return self.zero
        slope = self._accelerated(fields.slope[i], n - 1)
        return self.P * self.mu[i] * self.derivative(slope)

    def _log_strain(self, fields: Fields, force: Pulse, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in log r = (1 - ε + ε² - …) log f, but for the Gaussian at t^0."""
        total = self.zero
        if n > 0 and n % 2 == 0:
            total = -((-self.epsilon) ** (n // 2)) * fields.gaussian
        for m in range(n // 2 + 1):
            total = total + (-self.epsilon) ** m * force.log[n - 2 * m]
        return total

    def _append_slopes(self, fields: Fields, n: int) -> None:
        """Append the terms at t^n to the slopes: s_0 is P∂/(e^{P∂} - 1) of the mean strain."""
        slope = self.zero
        for m, term in enumerate(fields.means[n]):
            number = to_flint(bernoulli(m))
            if m == 1:
                number = fmpq(-1, 2)  # the series has the other sign than SymPy's B_1
            if number:
                slope = slope + fmpq(self.P**m, factorial(m)) * number * term
        for i in range(self.P):
            fields.slope[i].append(slope)
            if n:  # s_{i+1} = s_i + C_i ∂r_i
                strain = fields.strain[i].series[n - 1]
                slope = slope + self.c[i] * self.derivative(strain)

    def _accelerated(self, slope: Series, n: int) -> fmpq_mpoly:
        """Coefficient of t^n in γ s_i, s_i the slope of a bead's displacement."""
        total = self.zero
        for a, factor in enumerate(self.gamma[: n + 1]):
            if factor and slope[n - a]:
                total = total + factor * slope[n - a]
        return total

    def _derivatives(self, term: fmpq_mpoly, rows: list[Series]) -> Series:
        """Coefficients of t^n in a field and its n first derivatives, from those of t^{n-1}."""
        if not rows:
            return [term]
        return [term, *(self.derivative(before) for before in rows[-1])]
