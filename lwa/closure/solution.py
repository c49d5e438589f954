"""The equations of motion of a cell in its displacement fields, and their solution.

All displacement fields w_0 … w_{P-1} of a cell are taken at the position x of its first particle
and expressed by one field φ: w_i = φ + D φ_x S_i, S_i a series in D of polynomials in the jets of
φ (`lwa.algebra.jets`). Let m̂_i be the mass fractions, τ the time of `Cell.time_scale`, and F_i the
force of contact i divided by A_eff D^k. The equations of motion of the P particles are

    P k D m̂_i ∂_ττ w_i = F_i(x) - F_{i-1}(x),    F_{-1}(x) = F_{P-1}(x - P D).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from flint import fmpq_mpoly

from lwa.algebra.jets import JetAlgebra


@dataclass(frozen=True, repr=False, kw_only=True)
class Solution:
    """Result of a closure: wave equation and displacement fields, as polynomials by order in D.

    acceleration : E_n. Acoustic: φ_ττ = φ_x^k Σ_{n≥1} D^{n-1} E_n, E_1 = r_1 = φ_xx/φ_x.
        Optical: u_ττ = -u^k Σ_{n≥0} D^n E_n, E_0 = 1, in its own time unit.
    ansatz : b_n, n = 0 … order: the second particle's field is λ Σ b_n D^n ∂_x^n φ in the linear
        closure, and has this linear part in the full one (polynomials in the parameters).
    slaved : `fields`, from the full closure; else ().
    defect : E_n from the first equation of motion minus E_n from the second, for the same ansatz.
    """

    algebra: JetAlgebra = field(compare=False)
    acceleration: tuple[fmpq_mpoly, ...] = field(compare=False)
    ansatz: tuple[fmpq_mpoly, ...] = field(compare=False, default=())
    slaved: tuple[tuple[fmpq_mpoly, ...], ...] = field(compare=False, default=())
    defect: tuple[fmpq_mpoly, ...] = field(compare=False, default=())

    @property
    def fields(self) -> tuple[tuple[fmpq_mpoly, ...], ...]:
        """Polynomials S_0, S_1, … of each field w_i = φ + D φ_x Σ D^n S_n (acoustic branch)."""
        if self.slaved:
            return self.slaved
        first = tuple(self.algebra.zero for _ in self.acceleration)
        second = tuple(b * r for b, r in zip(self.ansatz[1:], self.algebra.r, strict=False))
        return (first, second) if self.ansatz else (first,)
