"""Bloch's dispersion relation of the linear chain as polynomials in (m̂, C), solved in series.

Let ``a_i`` be the amplitude of particle i, ``f_i`` that of the force of contact i, Ω the frequency
and κ the wavenumber in the theory's units, ``m̂_i`` mass fractions and ``C_i`` strain shares. The
particles obey::

    -P m̂_i Ω² a_i = f_i - f_{i-1},    a_{i+1} - a_i = C_i f_i,    a_P = e^{iPκ} a_0.

Carrying (a, f) through one cell gives a matrix of determinant 1 whose trace is a polynomial in
``Ω²``, and the branches are the roots of ``2 cos(Pκ) = trace`` (Brillouin, *Wave Propagation in
Periodic Structures*, 1946). Since ``trace = 2 - P²Ω² + …``, the coefficients of the acoustic root
follow one from another. A dimer's relation is ``sin²κ = Ω² - Π Ω⁴``, whose two roots have the sum
1/Π, ``Π = m̂_0 m̂_1 C_0 C_1``.
"""

from __future__ import annotations

from math import factorial

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.model import Model

Polynomial = list[fmpq_mpoly]
"""Coefficients of a truncated polynomial in ``Ω²``."""


class Bloch:
    """The dispersion relation of a cell and the series of its branches.

    Parameters
    ----------
    model : Model
        The cell and its law, over whose ring Q[k, m̂, C] all coefficients are polynomials.
    """

    def __init__(self, model: Model) -> None:
        context = fmpq_mpoly_ctx.get(model.names, Ordering.degrevlex)
        self.P = model.cell.size
        # Mass fractions m̂_i and strain shares C_i as elements of the ring
        self.mu = model.masses.elements(context)
        self.c = model.contacts.elements(context)
        self.one = context.constant(1)
        self.zero = context.constant(0)

    def trace(self, most: int) -> Polynomial:
        """Coefficients ``t_0 … t_P`` of the trace ``Σ t_m Ω^{2m}`` of a cell's matrix.

        The matrix maps (a, f) of a cell to that of the next cell; its diagonal is a of (1, 0) and f
        of (0, 1), polynomials in ``Ω²`` as lists of coefficients.

        Parameters
        ----------
        most : int
            Index of the last coefficient that is wanted, if it is less than P.

        Returns
        -------
        list of elements
        """
        none = [self.zero] * (min(self.P, most) + 1)
        one = [self.one, *none[1:]]
        # The columns of the matrix
        a, _ = self._carried(one, none)
        _, f = self._carried(none, one)
        return [a_m + f_m for a_m, f_m in zip(a, f, strict=True)]

    def _carried(self, a: Polynomial, f: Polynomial) -> tuple[Polynomial, Polynomial]:
        """Displacement and force (a, f) in the next cell, by the transfer matrix of a cell."""
        for mu, c in zip(self.mu, self.c, strict=True):
            shifted = [self.zero, *a[:-1]]  # Ω² a
            f = [f_m - self.P * mu * a_m for f_m, a_m in zip(f, shifted, strict=True)]
            a = [a_m + c * f_m for a_m, f_m in zip(a, f, strict=True)]
        return a, f

    def acoustic(self, order: int) -> list[fmpq_mpoly]:
        """Coefficients ``L_0 … L_order`` of the acoustic root ``Ω² = Σ L_n κ^{2n} = κ² + …``.

        Divided by ``-P²`` the relation is::

            Ω² = (2 - 2 cos Pκ)/P² + Σ_{m≥2} t_m/P² Ω^{2m},

        where each coefficient of the powers on the right depends on earlier ``L_n`` only.
        """
        P = self.P
        trace = self.trace(order)
        omega2 = [self.zero]
        powers = {1: omega2}  # powers[m] is that of Ω^{2m}; powers[1] grows with Ω²
        for n in range(1, order + 1):
            # (2 - 2 cos Pκ)/P² = Σ -2 (-1)^n P^{2n-2} κ^{2n}/(2n)!
            above = -2 * (-1) ** n * P ** (2 * n - 2)
            cosine = fmpq(above, factorial(2 * n))
            following = self.one * cosine
            for m in range(2, len(trace)):
                product = self.zero
                for j in range(1, n):
                    product = product + omega2[j] * powers[m - 1][n - j]
                powers.setdefault(m, [self.zero]).append(product)
                following = following + trace[m] * product / P**2
            omega2.append(following)
        return omega2
