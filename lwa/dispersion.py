"""The linear chain: its exact dispersion relation, the series of its branches, and Bloch's bands.

A chain at k = 1, or one of any k linearised about a uniform compression, is a chain of springs of
compliances c_i (`Cell.shares`). In the theory's units (time τ, wavenumber κ = qD, so that Ω = κ to
leading order) the particles obey, with f_i the force of contact i,

    -P μ_i Ω² a_i = f_i - f_{i-1},    a_{i+1} - a_i = c_i f_i,    a_P = e^{iPκ} a_0.

Carrying (a, f) through one cell gives a matrix of determinant 1 whose trace is a polynomial in Ω²,
and the branches are the roots of 2 cos(Pκ) = trace (Brillouin, *Wave Propagation in Periodic
Structures*, 1946). Since trace = 2 - P²Ω² + …, the acoustic root is a series

    Ω² = κ² (1 - I κ² + …)

whose coefficients follow one from another, polynomial in μ_i and c_i. A dimer's two roots have the
sum 1/ν, ν = μ_0 μ_1 c_0 c_1, so that its optical branch is 1/ν less the acoustic one.

Numbers come from the same equations as f = B(κ) a in the variables a_i √(P μ_i), f_i √c_i: the Ω_j
are the singular values of B. Eigenvalues of BᴴB would lose half the digits of a small Ω.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import comb, factorial
from typing import TYPE_CHECKING, Any

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lwa.cell import Cell, exponent
from lwa.coefficients import Coefficients
from lwa.exact import InputError, shorten

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

BRANCHES = ("acoustic", "optical")

MOST_TERMS = 200_000
"""What a series may take, by the estimate of `Dispersion._length`: about half a minute."""


@dataclass(frozen=True)
class Dispersion:
    """Ω(κ) of the linear chain with a cell's masses and strain shares.

    Ω is the frequency in τ times D and κ the wavenumber times D. In time t the frequency is
    Ω/D · `Cell.time_scale`, times p^{(k-1)/2} under a mean strain p.

    Parameters
    ----------
    cell : the periodic cell.
    k : exponent of the contact law, which matters for unequal contacts only; 1 makes the
        stiffnesses spring constants.

    Raises `lwa.InputError` for anything else.

    >>> m1, m2 = sp.symbols("m1 m2", positive=True)
    >>> Dispersion(Cell((m1, m2))).acoustic(4)
    {2: 1, 4: -(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)}
    """

    cell: Cell
    k: sp.Expr = sp.S.One

    def __post_init__(self) -> None:
        if not isinstance(self.cell, Cell):
            raise InputError(f"cell is {shorten(self.cell)}: a Cell such as Cell([1, 2]) is wanted")
        object.__setattr__(self, "k", exponent(self.k))

    # --- exact ------------------------------------------------------------------------------

    @cached_property
    def trace(self) -> dict[int, sp.Expr]:
        """m → t_m of the exact dispersion relation 2 cos(Pκ) = Σ t_m Ω^{2m}, m = 0 … P.

        >>> Dispersion(Cell([1])).trace
        {0: 2, 1: -1}
        """
        return {m: self._expression(t) for m, t in enumerate(self._chain.trace(self.cell.size))}

    def acoustic(self, order: int = 4) -> dict[int, sp.Expr]:
        """n → the coefficient of κ^n in Ω² of the acoustic branch, n = 2, 4, … ≤ ``order``."""
        series = self._chain.acoustic(self._length(order))
        return {2 * n: self._expression(c) for n, c in enumerate(series) if n > 0}

    def optical(self, order: int = 4) -> dict[int, sp.Expr]:
        """n → the coefficient of κ^n in Ω² of a dimer's optical branch, n = 0, 2, … ≤ ``order``.

        Raises `lwa.InputError` unless the cell has two particles.
        """
        self._demand_dimer("the optical series")
        acoustic = self.acoustic(order)
        return {0: 1 / self._expression(self._chain.nu)} | {n: -c for n, c in acoustic.items()}

    def amplitude_ratio(self, order: int = 4, branch: str = "acoustic") -> dict[int, sp.Expr]:
        """n → the coefficient of (iκ)^n in a_1/a_0 = w/u of a dimer, n = 0 … ``order``.

        These are λ b_n of the ansatz w = λ Σ b_n D^n ∂_x^n u: a_1 is taken at the place of a_0.

        Raises `lwa.InputError` unless the cell has two particles.
        """
        self._demand_dimer("the amplitude ratio")
        if branch not in BRANCHES:
            raise InputError(f"branch is {shorten(branch)}: one of {', '.join(BRANCHES)} is wanted")
        self._length(order)
        m1, m2 = self.cell.masses
        ratio = sp.Integer(1) if branch == "acoustic" else sp.cancel(-m1 / m2)
        series = self._chain.amplitudes(order, branch)
        return {n: sp.Mul(ratio, self._expression(b)) for n, b in enumerate(series)}

    @cached_property
    def I(self) -> sp.Expr:
        """I of Ω² = κ² (1 - I κ² + …): the wave equation's coefficient of u_4x, over D².

        >>> Dispersion(Cell(["1/2", "1/3", "1/6"])).I
        5/36
        """
        return -self.acoustic(4)[4]

    @cached_property
    def _ring(self) -> Coefficients:
        return Coefficients(self.cell, self.k)

    @cached_property
    def _chain(self) -> _Chain:
        return _Chain(self._ring)

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        count = len(self._ring.names)
        terms = [(tuple(map(int, e[:count])), c) for e, c in polynomial.terms()]
        return sp.together(self._ring.expression(terms))  # compliances enter as 1/A

    def _length(self, order: Any) -> int:
        """The number of powers of κ² up to κ^order, refused where it would take too long.

        The coefficient of κ^{2n} has the degree 2n - 2 in the masses and in the compliances, and
        comes from about n² products.
        """
        if isinstance(order, bool) or not isinstance(order, int):
            raise InputError(f"order is {shorten(order)}: an integer from 1 on is wanted")
        if order < 1:
            raise InputError(f"order is {order}: it must be 1 or more")
        n = order // 2
        terms = n * n
        for part in (self._ring.masses, self._ring.contacts):
            terms *= comb(2 * max(n, 1) - 2 + len(part.names), len(part.names))
        if terms > MOST_TERMS:
            raise InputError(
                f"order is {shorten(order)}: about {min(terms, 10**30):.0e} terms, too many; give "
                "numbers for the cell, or a lower order"
            )
        return n

    def _demand_dimer(self, what: str) -> None:
        if self.cell.size == 1:
            raise InputError(f"{what} needs a cell of 2 masses: 1 mass has no optical branch")
        if self.cell.size > 2:
            raise InputError(
                f"{what} needs a cell of 2 masses, not {self.cell.size}: there its roots are not "
                "rational; use the numerical branches"
            )

    # --- numbers ----------------------------------------------------------------------------

    def branches(self, kappa: ArrayLike) -> Array:
        """Ω_j(κ), ascending along a last axis of length P; error about 1e-15 of the largest.

        Raises `lwa.InputError` for a κ that is no finite number, and where masses, stiffnesses or
        k are symbols.

        >>> Dispersion(Cell([1])).branches(3.141592653589793)
        array([2.])
        """
        import numpy as np

        B, _ = self._strains(kappa)
        return np.linalg.svd(B, compute_uv=False)[..., ::-1].astype(float)

    def group_velocity(self, kappa: ArrayLike) -> Array:
        """dΩ_j/dκ in the order of `branches`, by dΩ = Re (left vector)ᴴ dB (right vector).

        Where branches touch, or touch zero, they have a kink: there it is the slope towards
        larger κ.
        """
        import numpy as np

        B, dB = self._strains(kappa)
        left, omega, right = np.linalg.svd(B)
        # dB has one entry, from the first particle to the last contact
        S = left[..., -1, :, None].conj() * dB[..., None, None] * right[..., None, :, 0].conj()
        slopes = np.diagonal(S, axis1=-2, axis2=-1)
        equal = 64 * np.finfo(float).eps * omega[..., :1]
        velocity = np.where(omega <= equal, np.abs(slopes), slopes.real).astype(float)
        for i in range(self.cell.size - 1):  # no more than two branches meet in a point
            j = i + 1
            mean = (slopes[..., i] + slopes[..., j]).real / 2
            half = (slopes[..., i] - slopes[..., j]).real / 2
            split = np.hypot(half, np.abs(S[..., i, j] + S[..., j, i].conj()) / 2)
            touch = omega[..., i] - omega[..., j] <= equal[..., 0]
            velocity[..., i] = np.where(touch, mean + split, velocity[..., i])
            velocity[..., j] = np.where(touch, mean - split, velocity[..., j])
        return velocity[..., ::-1]

    def band_edges(self) -> Array:
        """(min, max) of Ω of each branch, shape (P, 2): each is monotone between κ = 0 and π/P."""
        import numpy as np

        edges: Array = np.sort(self.branches([0.0, np.pi / self.cell.size]), axis=0).T
        return edges

    def gaps(self) -> Array:
        """(from, to) of the P - 1 intervals of Ω between the bands; closed ones are of length 0."""
        import numpy as np

        edges = self.band_edges()
        return np.stack([edges[:-1, 1], edges[1:, 0]], axis=-1)

    def _strains(self, kappa: ArrayLike) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """B(κ), which takes a_i √(P μ_i) to f_i √c_i, and the one entry of dB/dκ (last row)."""
        import numpy as np

        wave = _finite(kappa)
        P = self.cell.size
        mass = np.sqrt(P * self._floats(self.cell.fractions))
        share = np.sqrt(self._floats(self.cell.shares(self.k)))
        B = np.zeros((*wave.shape, P, P), complex)
        for i in range(P):
            B[..., i, i] = -1 / (share[i] * mass[i])
            if i < P - 1:
                B[..., i, i + 1] = 1 / (share[i] * mass[i + 1])
        end = np.exp(1j * P * wave) / (share[-1] * mass[0])
        B[..., -1, 0] += end
        return B, 1j * P * end

    def _floats(self, values: Iterable[sp.Expr]) -> Array:
        import numpy as np

        values = tuple(values)
        unknown = set().union(*(v.free_symbols for v in values))
        if unknown:
            raise InputError(
                f"{min(map(str, unknown))!r} has no value: the numerical branches need numbers for "
                "the masses, the stiffnesses and, with unequal contacts, k"
            )
        numbers = np.array([float(v) for v in values])
        if not np.all(numbers > 0):
            raise InputError("masses or compliances differ by more than a float can tell")
        return numbers


Polynomial = list[fmpq_mpoly]
"""A polynomial in Ω², truncated: its coefficients."""


class _Chain:
    """The dispersion relation as polynomials in (μ, c), and its solution in series."""

    def __init__(self, ring: Coefficients) -> None:
        context = fmpq_mpoly_ctx.get(ring.names, Ordering.degrevlex)
        self.P = ring.cell.size
        self.mu = ring.masses.elements(context)
        self.c = ring.contacts.elements(context)
        self.one, self.zero = context.constant(1), context.constant(0)

    def trace(self, most: int) -> Polynomial:
        """t_m for m up to P, or up to ``most``: Σ t_m Ω^{2m} is the trace of what takes (a, f) on.

        From a = 1, f = 0 it takes the a of the next cell, from a = 0, f = 1 the f. Both are
        polynomials in Ω², lists of their coefficients.
        """
        powers = range(min(self.P, most) + 1)
        one = [self.one, *(self.zero for _ in powers[1:])]
        none = [self.zero for _ in powers]
        a, _ = self._carried(one, none)
        _, f = self._carried(none, one)
        return [a_m + f_m for a_m, f_m in zip(a, f, strict=True)]

    def _carried(self, a: Polynomial, f: Polynomial) -> tuple[Polynomial, Polynomial]:
        """(a, f) one cell further."""
        for mu, c in zip(self.mu, self.c, strict=True):
            inertia = [self.zero, *(self.P * mu * a_m for a_m in a[:-1])]
            f = [f_m - i_m for f_m, i_m in zip(f, inertia, strict=True)]
            a = [a_m + c * f_m for a_m, f_m in zip(a, f, strict=True)]
        return a, f

    @property
    def nu(self) -> fmpq_mpoly:
        """ν = μ_0 μ_1 c_0 c_1 of the dimer, whose relation is sin²κ = Ω² - ν Ω⁴."""
        return self.mu[0] * self.mu[1] * self.c[0] * self.c[1]

    def acoustic(self, order: int) -> list[fmpq_mpoly]:
        """L_0 … L_order of the root Ω² = Σ L_n κ^{2n} that starts with κ².

        The relation, over -P², reads Ω² = (2 - 2 cos Pκ)/P² + Σ_{m≥2} t_m/P² Ω^{2m}, and in the
        powers of Ω² on the right stand only earlier L_n.
        """
        P = self.P
        trace = self.trace(order)
        omega2 = [self.zero]
        powers = [
            [],
            omega2,
            *([self.zero] for _ in trace[2:]),
        ]  # powers[m] is the series of Ω^{2m}
        for n in range(1, order + 1):
            following = self.one * fmpq(-2 * (-1) ** n * P ** (2 * n - 2), factorial(2 * n))
            for m in range(2, len(trace)):
                power = self.zero
                for j in range(1, n):
                    power = power + omega2[j] * powers[m - 1][n - j]
                powers[m].append(power)
                following = following + trace[m] * power / P**2
            omega2.append(following)
        return omega2

    def amplitudes(self, order: int, branch: str) -> list[fmpq_mpoly]:
        """b_0 … b_order of a dimer's a_1/a_0 = λ Σ b_n q^n, q = iκ.

        The first particle's equation times c_0 c_1 is 2μ_0 c_0 c_1 Ω² = 2 - (c_1 + c_0 e^{-2q}) ρ.
        With Ω² of the acoustic branch, or 1/ν less it and λ = -μ_0/μ_1 taken out,

            (1 + c_0 (e^{-2q} - 1)/2) Σ b_n q^n = 1 - μ c_0 c_1 Ω²_acoustic,

        μ being μ_0 on the acoustic branch and μ_1 on the optical one.
        """
        weight = self.mu[BRANCHES.index(branch)] * self.c[0] * self.c[1]
        omega2 = self.acoustic(order // 2)
        b: list[fmpq_mpoly] = []
        for n in range(order + 1):
            following = self.one if n == 0 else self.zero
            if n % 2 == 0:
                following = following - weight * omega2[n // 2] * (-1) ** (n // 2)
            for j in range(1, n + 1):
                following = following - self.c[0] * b[n - j] * fmpq((-2) ** j, 2 * factorial(j))
            b.append(following)
        return b


def _finite(kappa: ArrayLike) -> Array:
    import numpy as np

    try:
        values = np.asarray(kappa)
        array: Array = values.astype(
            float, casting="safe" if values.dtype.kind != "O" else "unsafe"
        )
    except (TypeError, ValueError):
        raise InputError(f"kappa is {shorten(kappa)}: real wavenumbers are wanted") from None
    if not np.all(np.isfinite(array)):
        value = array[~np.isfinite(array)].flat[0]
        raise InputError(f"kappa is {value}: finite wavenumbers are wanted")
    return array
