"""The quasi-continuum wave equation of a chain, at any order.

Acoustic branch (Porter et al. 2008, eq. 6, is order 4 of the dimer), in the time
τ = t · `Cell.time_scale`:

    u_ττ = u_x^{k-1} u_xx + u_x^k Σ_{n≥2} D^{n-1} Σ_jets coefficient · Π_i (∂_x^i u / u_x)^{e_i},

where n stands at D^{k+n} of the equations of motion; n = 3 holds G, H and I. Optical branch, in
its own time unit: u_ττ = -u^k + u^k Σ_{n≥1} D^n Σ_jets coefficient · Π_i (∂_x^i u / u)^{e_i}.

Coefficients are converted to SymPy when they are asked for, one by one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import sympy as sp
from flint import fmpq_mpoly

from lwa.cell import Cell
from lwa.closure import Closure
from lwa.coefficients import Coefficients
from lwa.conservation import flux, potential
from lwa.exact import InputError, exact
from lwa.fields import change_field
from lwa.jets import Term
from lwa.wave import TravelingWave

Powers = tuple[tuple[int, int], ...]


class Jet(NamedTuple):
    """The product of (∂_x^i u / base)^e over ``x`` and (∂_x^i u_τ / base^{(k+1)/2})^e over ``t``.

    Both are tuples of (i, e). The base is u_x, on the optical branch u.
    """

    x: Powers
    t: Powers = ()


class Terms(Mapping[Jet, sp.Expr]):
    """Jet → coefficient at one order; a coefficient becomes SymPy when it is looked up.

    A jet without u_τ may also be given by its plain tuple, as in ``terms[(2, 1), (3, 1)]``.
    """

    def __init__(self, ring: Coefficients, raw: dict[Jet, list[Term]]) -> None:
        self._ring = ring
        self._raw = raw
        self._converted: dict[Jet, sp.Expr] = {}

    def __getitem__(self, jet: Jet | Powers) -> sp.Expr:
        jet = jet if isinstance(jet, Jet) else Jet(jet)
        if jet not in self._converted:
            self._converted[jet] = self._ring.expression(self._raw[jet])
        return self._converted[jet]

    def __iter__(self) -> Iterator[Jet]:
        return iter(self._raw)

    def __len__(self) -> int:
        return len(self._raw)

    def __repr__(self) -> str:
        return repr(dict(self))


def terms(closure: Closure, polynomial: fmpq_mpoly) -> Terms:
    """A polynomial of the closure's algebra as jets of the field with their coefficients."""
    base = base_order(closure)
    raw = {
        Jet(tuple((n + base, e) for n, e in monomial.x), monomial.t): coefficient
        for monomial, coefficient in closure.algebra.terms(polynomial).items()
    }
    return Terms(closure.ring, dict(sorted(raw.items(), key=lambda item: _complexity(item[0]))))


def base_order(closure: Closure) -> int:
    """The order of the derivative that the jets are normalised by: u_x, on the optical branch u."""
    return 1 if closure.ring.branch == "acoustic" else 0


def _complexity(jet: Jet) -> tuple[bool, int, Jet]:
    return bool(jet.t), -sum(e for _, e in jet.x), jet


@dataclass(frozen=True)
class PDE:
    """The wave equation that a closure leads to (see the module's first lines for its form)."""

    closure: Closure

    @property
    def cell(self) -> Cell:
        """The chain."""
        return self.closure.ring.cell

    @property
    def k(self) -> sp.Expr:
        """The exponent of the contact law."""
        return self.closure.ring.k

    @cached_property
    def time_scale(self) -> sp.Expr:
        """τ/t."""
        if self.closure.ring.branch == "acoustic":
            return self.cell.time_scale(self.k)
        # w = λu strains each contact by (λ - 1)u, and 1 - λ = M/m2.
        m1, m2 = self.cell.masses
        stretch = (self.cell.mass / m2) ** self.k
        return sp.sqrt(sp.Add(*self.cell.stiffnesses) * stretch / m1)

    @cached_property
    def coefficients(self) -> Mapping[int, Terms]:
        """n → the terms at D^{k+n} (optical: D^n), without the power of D; {} where none stand.

        The leading term is left out: `coefficients` starts behind u_x^{k-1} u_xx (or -u^k).
        """
        base = base_order(self.closure)
        sign = 1 if base else -1
        acceleration = enumerate(self.closure.acceleration)
        return {n: terms(self.closure, sign * E) for n, E in acceleration if n > base}

    def _at_third_order(self, jet: Powers) -> sp.Expr:
        if self.closure.ring.branch != "acoustic":
            raise InputError("G, H and I belong to the acoustic branch")
        if self.closure.order < 4:
            raise InputError(
                f"order is {self.closure.order}: G, H and I stand at D^(k+3), from order 4 on"
            )
        return self.coefficients[3].get(Jet(jet), sp.Integer(0)) * self.cell.spacing**2

    @cached_property
    def G(self) -> sp.Expr:
        """The coefficient of u_x^{k-3} u_xx^3, D² included."""
        return self._at_third_order(((2, 3),))

    @cached_property
    def H(self) -> sp.Expr:
        """The coefficient of u_x^{k-2} u_xx u_xxx, D² included."""
        return self._at_third_order(((2, 1), (3, 1)))

    @cached_property
    def I(self) -> sp.Expr:
        """The coefficient of u_x^{k-1} u_xxxx, D² included."""
        return self._at_third_order(((4, 1),))

    @property
    def vanishing(self) -> tuple[int, ...]:
        """The n whose order D^{k+n} (optical: D^n) vanishes identically."""
        return tuple(n for n, found in self.coefficients.items() if not found)

    @cached_property
    def conservative(self) -> bool:
        """Whether every order is ∂_x of a flux, so that the momentum ∫ u_τ dx is conserved."""
        acoustic = self.closure.ring.branch == "acoustic"
        return acoustic and None not in self._fluxes.values()

    @cached_property
    def _fluxes(self) -> dict[int, fmpq_mpoly | None]:
        """n → F_n, None where order D^{k+n} has none."""
        return {n: flux(self.closure, n) for n in self._orders}

    @cached_property
    def fluxes(self) -> Mapping[int, Terms]:
        """n → F_n, u_x^k E_n = ∂_x (u_x^k F_n), for the orders D^{k+n}, n ≥ 2, that have one."""
        return {n: terms(self.closure, F) for n, F in self._fluxes.items() if F is not None}

    @cached_property
    def potentials(self) -> Mapping[int, Terms]:
        """n → (k+1) V_n / u_x^{k+1} for the variational orders among D^{k+n}, n ≥ 2.

        Where all orders are there, u_ττ is minus the variational derivative of Σ D^{n-1} V_n with
        V_1 = u_x^{k+1}/(k(k+1)), and u_τ²/2 + Σ D^{n-1} V_n is the density of a conserved energy.
        """
        found = {n: potential(self.closure, n, F) for n, F in self._fluxes.items()}
        return {n: terms(self.closure, V) for n, V in found.items() if V is not None}

    @property
    def variational(self) -> bool:
        """Whether every order derives from a potential (see `potentials`)."""
        return bool(self._orders) and all(n in self.potentials for n in self._orders)

    @property
    def _orders(self) -> tuple[int, ...]:
        return tuple(self.coefficients) if self.closure.ring.branch == "acoustic" else ()

    def energy_density(self, u: sp.Expr, x: sp.Symbol, velocity: sp.Expr = sp.S.Zero) -> sp.Expr:
        """u_τ²/2 + Σ D^{n-1} V_n for fields u(x) and u_τ(x): the density of a conserved energy.

        Raises `lwa.InputError` where an order does not derive from a potential.

        >>> from lwa import Cell, homogenize
        >>> x = sp.Symbol("x")
        >>> homogenize(Cell([1]), k=3).pde.energy_density(x**2, x)
        -2*D**2*x**2/3 + 4*x**4/3
        """
        if not self.variational:
            raise InputError(
                "the wave equation has no energy in this field: it is variational with closure "
                "full and field center (see `PDE.variational`)"
            )
        k, D, p = self.k, self.cell.spacing, u.diff(x)
        result = velocity**2 / 2 + p ** (k + 1) / (k * (k + 1))
        for n, found in self.potentials.items():
            for jet, coefficient in found.items():
                jets = sp.Mul(*((u.diff(x, i) / p) ** e for i, e in jet.x))
                result += coefficient / (k + 1) * D ** (n - 1) * p ** (k + 1) * jets
        return result

    def in_field(self, alphas: Mapping[int, Any]) -> PDE:
        """The wave equation of φ = u + Σ α_n D^n ∂_x^n u, for {n: α_n}.

        Raises `lwa.InputError` on the optical branch, for n < 1 or α_n that are no quantities.

        >>> from lwa import Dimer, homogenize
        >>> pde = homogenize(Dimer(1, 1)).pde
        >>> pde.H, pde.in_field({2: "alpha"}).H
        (D**2*(k/6 - 1/6), D**2*(12*alpha + 1)*(k - 1)/6)
        """
        exact_alphas = {n: exact(a, f"alpha_{n}") for n, a in alphas.items()}
        return PDE(change_field(self.closure, exact_alphas))

    def right_side(self, u: sp.Expr, x: sp.Symbol, velocity: sp.Expr = sp.S.Zero) -> sp.Expr:
        """The right-hand side of u_ττ for fields u(x) and u_τ(x), as a SymPy expression.

        >>> from lwa import homogenize, Cell
        >>> x = sp.Symbol("x")
        >>> homogenize(Cell([1]), k=1, order=4).pde.right_side(sp.exp(x), x)
        D**2*exp(x)/12 + exp(x)
        """
        base_derivative = base_order(self.closure)
        base = u.diff(x, base_derivative) if base_derivative else u
        k, D = self.k, self.cell.spacing
        result = base ** (k - 1) * u.diff(x, 2) if base_derivative else -(base**k)
        for n, found in self.coefficients.items():
            for jet, coefficient in found.items():
                product = sp.Mul(*(u.diff(x, i) ** e for i, e in jet.x))
                product *= sp.Mul(*(velocity.diff(x, i) ** e for i, e in jet.t))
                degree = sum(e for _, e in jet.x) + (k + 1) / 2 * sum(e for _, e in jet.t)
                result += coefficient * D ** (n - base_derivative) * base ** (k - degree) * product
        return result

    def traveling_wave(self) -> TravelingWave:
        """The compact wave of the equation truncated at D^{k+3}, in closed form.

        Raises `lwa.NoSolitaryWave` where numbers show that there is none, and `lwa.InputError`
        when the order is below 4, the branch optical, or D^{k+2} does not vanish (the linear
        closure with unequal contacts), so that the closed form does not apply.
        """
        wave = TravelingWave(cell=self.cell, k=self.k, G=self.G, H=self.H, I=self.I)
        if 2 not in self.vanishing:
            raise InputError("unequal stiffnesses leave a term at D^(k+2): no wave in closed form")
        return wave
