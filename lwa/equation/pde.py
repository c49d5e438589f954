"""The quasi-continuum wave equation of a chain, at any order.

Acoustic branch (the wave equation of Porter et al. 2008 is order 4 of the dimer), in the time
``τ = t`` · `Cell.time_scale`::

    u_ττ = u_x^{k-1} u_xx + u_x^k Σ_{n≥2} D^{n-1} Σ_jets coefficient · Π_i (∂_x^i u / u_x)^{e_i},

where a jet is a set of pairs (i, e_i), and order n collects the terms with ``D^{k+n}`` in the
equations of motion; G, H and I are the coefficients at order 3, times ``D²``. Under a law F(δ) that
is no power ``F′(D u_x)`` replaces ``u_x^{k-1}``, and coefficients hold ``φ_2, φ_3, …`` (`lwa.law`).
Optical branch, in its time unit::

    u_ττ = -u^k + u^k Σ_{n≥1} D^n Σ_jets coefficient · Π_i (∂_x^i u / u)^{e_i}.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from lwa.algebra.jets import Jet
from lwa.base import latex
from lwa.base.exact import InputError, power, shorten
from lwa.cell import k as symbol_k
from lwa.closure.consistency import OfClosure
from lwa.equation.energy import conservative, energy
from lwa.equation.terms import ENERGY, Terms, by_order, latex_by_order, terms
from lwa.law import power_exponent
from lwa.wave.compact import POWERS_ALONE, CompactWave

LETTERS = {
    "G": Jet(((2, 3),)),
    "H": Jet(((2, 1), (3, 1))),
    "I": Jet(((4, 1),)),
}
"""The paper's letters for the coefficients at ``D^{k+3}``, and their jets."""


@dataclass(frozen=True, repr=False)
class PDE(OfClosure):
    """The wave equation of a closure (`lwa.equation.pde` states its form).

    Parameters
    ----------
    closure : Closure
        The solved consistency condition of a chain.
    """

    @property
    def acoustic(self) -> bool:
        """True for the equation of the acoustic branch."""
        return self.closure.model.branch == "acoustic"

    @cached_property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t of the equation's time to the chain's."""
        if self.acoustic:
            return self.cell.time_scale(self.law.exponent)
        # w = λu strains each contact by (λ - 1)u, and 1 - λ = M/m2. The unit of time makes the
        # leading term -u^k.
        m1, m2 = self.cell.masses
        stretch = power(self.cell.mass / m2, self.k)
        return power(sp.Add(*self.cell.stiffnesses) * stretch / m1, sp.S.Half)

    @cached_property
    def coefficients(self) -> Mapping[int, Terms]:
        """Mapping from n to the terms of ``D^{k+n}`` (optical: ``D^n``), without D.

        The leading term ``u_xx u_x^{k-1}`` (optical: ``-u^k``) is left out. The terms of an order
        that vanishes are {}.
        """
        # The wave equation is u_ττ = u_x^k Σ D^{n-1} E_n with the leading term E_1 on the acoustic
        # branch, and u_ττ = -u^k Σ D^n E_n with E_0 on the optical one.
        base = self.closure.model.base
        sign = 1 if self.acoustic else -1
        acceleration = self.closure.solution.acceleration
        orders = range(base + 1, len(acceleration))
        return {n: terms(self.closure, sign * acceleration[n]) for n in orders}

    @cached_property
    def third_order(self) -> dict[str, sp.Expr]:
        """Mapping from "G", "H", "I" to their values; {} below order 4 or on the optical branch."""
        # The ansatz to D^n gives the wave equation to D^{k+n-1}.
        if not self.acoustic or self.closure.model.order < 4:
            return {}
        values = {}
        for letter, jet in LETTERS.items():
            # A coefficient that vanishes, such as G at k = 2, has no term.
            coefficient = self.coefficients[3].get(jet, sp.S.Zero)
            values[letter] = coefficient * self.cell.spacing**2
        return values

    def _at_third_order(self, letter: str) -> sp.Expr:
        """One of the coefficients G, H and I; raises `lwa.InputError` where there is none."""
        if not self.acoustic:
            raise InputError(
                "branch is 'optical': G, H and I are those of the acoustic branch",
                branch="acoustic",
            )
        if not self.third_order:
            raise InputError(
                f"order is {self.closure.model.order}: G, H and I stand at D^(k+3), from 4 on",
                order=4,
            )
        return self.third_order[letter]

    @property
    def G(self) -> sp.Expr:
        """The coefficient of ``u_x^{k-3} u_xx^3``, with its factor ``D²``."""
        return self._at_third_order("G")

    @property
    def H(self) -> sp.Expr:
        """The coefficient of ``u_x^{k-2} u_xx u_xxx``, with its factor ``D²``."""
        return self._at_third_order("H")

    @property
    def I(self) -> sp.Expr:
        """The coefficient of ``u_x^{k-1} u_xxxx``, with its factor ``D²``."""
        return self._at_third_order("I")

    @property
    def vanishing(self) -> tuple[int, ...]:
        """The n whose order ``D^{k+n}`` (optical: ``D^n``) vanishes identically."""
        return tuple(n for n, of_order in self.coefficients.items() if not of_order)

    @cached_property
    def conservative(self) -> bool:
        """True if ``∫ u_τ dx`` is conserved: each order, at least to ``D^{k+3}``, has a flux."""
        if not self.acoustic:
            return False
        closure = self.closure
        # The answer is that of the paper's order D^{k+3} at least.
        if closure.model.order < 4:
            closure = replace(closure, model=replace(closure.model, order=4))
        return conservative(closure)

    @cached_property
    def energy(self) -> Mapping[int, Terms]:
        """Mapping from n to the terms ``e_n`` of the conserved energy density, n to order - 2.

        The density is ``W(u_x) + Σ D^n e_n``, where W is the energy of the contacts in the units of
        the equation, ``W′ = F``, such as ``u_x^{k+1}/(k(k+1))`` for a power, and
        ``e_0 = u_τ²/2``. It is the energy of the chain in the slaved fields
        (`lwa.equation.energy`), conserved to the order of the closure in every field. Coefficients
        are those of ``u_x² F′(u_x)`` times a jet.

        Raises
        ------
        InputError
            On the optical branch, and for the linear closure of two particles.
        """
        densities = energy(self.closure)
        return {n: terms(self.closure, e, ENERGY) for n, e in enumerate(densities)}

    def _summands(self, write: Callable[[Terms, Jet], str]) -> list[str]:
        """The leading term and those of G, H, I, written by `Terms.text` or `Terms.latex`."""
        # `Terms` has the notation of jets; without coefficients, which the letters do not need.
        notation = Terms(self.closure.model, {})
        if not self.acoustic:
            return [f"-{write(notation, Jet(()))}"]
        summands = [write(notation, Jet(((2, 1),)))]
        for letter in self.third_order:
            summands.append(f"{letter} {write(notation, LETTERS[letter])}")
        return summands

    @property
    def _without_letters(self) -> dict[int, Terms]:
        """The terms by their orders, but for those of G, H and I."""
        # A copy: the equation keeps its own.
        rest = dict(self.coefficients)
        if self.third_order:
            del rest[3]
        return rest

    @property
    def headline(self) -> str:
        """The equation as one line of text: its leading term, those of G, H and I, and dots.

        The dots stand for the terms of all other orders, where there are any.
        """
        summands = self._summands(Terms.text)
        if any(self._without_letters.values()):
            summands.append("…")
        return f"u_ττ = {' + '.join(summands)}"

    def line(self) -> str:
        """The equation and G, H, I as one line of text; long values are cut."""
        values = [f"{name} = {shorten(x)}" for name, x in self.third_order.items()]
        return "; ".join([self.headline, *values])

    def __repr__(self) -> str:
        return f"PDE({self.closure!r}: {self.line()})"

    @property
    def heading(self) -> str:
        """Format string for the heading of an order n, such as ``D^(k+{})``."""
        # F′ stands in the place of the power of D u_x.
        if not self.law.homogeneous:
            return "order {}"
        return "D^(k+{})" if self.acoustic else "D^{}"

    def __str__(self) -> str:
        """The equation as text, with G, H, I and the terms of the other orders below it."""
        lines = [self.headline]
        # -u^k acts on both signs of u.
        if not self.acoustic:
            lines.append("  (contacts that also pull: the odd law |δ|^(k-1) δ)")
        lines += [f"  {letter} = {value}" for letter, value in self.third_order.items()]
        lines += by_order(self._without_letters, self.heading)
        if self.vanishing:
            orders = ", ".join(map(self.heading.format, self.vanishing))
            lines.append(f"  vanishing identically: {orders}")
        return "\n".join(lines)

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of the equation to ``D^{k+most}`` (all orders if None), of τ, and of G, H, I."""
        right_side = latex_by_order(
            self._summands(Terms.latex),
            self._without_letters,
            self.cell.spacing,
            self.closure.model.base,
            most,
        )
        return [
            rf"u_{{\tau\tau}} = {right_side}",
            rf"\tau = {latex.expression(self.time_scale)} \, t",
            *latex.rows(self.third_order),
        ]

    def _repr_latex_(self) -> str:
        # The paper's wave equation goes to D^{k+3}.
        return latex.display(self.latex_rows(3))

    def traveling_wave(self) -> CompactWave:
        """The compact wave of the equation truncated at ``D^{k+3}``, in closed form.

        Returns
        -------
        CompactWave

        Raises
        ------
        NoSolitaryWave
            For numbers with which k - 1, G + H + I or V² is not positive.
        InputError
            If the closed form does not apply: the law is no power, the order is below 4, the branch
            optical, or ``D^{k+2}`` does not vanish (the linear closure with unequal contacts).
        """
        # Called for its refusal of a law that is no power
        power_exponent(self.law, self.cell, symbol_k, POWERS_ALONE)
        # G, H, I refuse an order below 4 and the optical branch.
        wave = CompactWave(self.cell, self.k, self.G, self.H, self.I)
        # The term at D^{k+2}, u_x^{k-2} u_xx², breaks the symmetry x → -x, u → -u of an even pulse.
        if 2 not in self.vanishing:
            raise InputError(
                "unequal stiffnesses leave a term at D^(k+2): no wave in closed form"
            )
        return wave
