"""The quasi-continuum wave equation of a chain, at any order.

Acoustic branch (the wave equation of Porter et al. 2008 is order 4 of the dimer), in the time
τ = t · `Cell.time_scale`:

    u_ττ = u_x^{k-1} u_xx + u_x^k Σ_{n≥2} D^{n-1} Σ_jets coefficient · Π_i (∂_x^i u / u_x)^{e_i},

where a jet is a set of pairs (i, e_i), and order n collects the terms with D^{k+n} in the equations
of motion; G, H and I are the coefficients of n = 3. Under a law F(δ) that is no power F′(D u_x)
replaces u_x^{k-1}, and coefficients hold φ_2, φ_3, … (`lwa.law`). Optical branch, in its time unit:

    u_ττ = -u^k + u^k Σ_{n≥1} D^n Σ_jets coefficient · Π_i (∂_x^i u / u)^{e_i}.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, power
from lwa.closure.consistency import OfClosure
from lwa.equation.energy import conservative, energy
from lwa.equation.terms import ENERGY, Jet, Terms, by_order, terms
from lwa.wave.compact import CompactWave

_POWER_LAW = (
    "u_x^(k-1) u_xx",
    "G u_x^(k-3) u_xx^3 + H u_x^(k-2) u_xx u_xxx + I u_x^(k-1) u_4x",
)
_OTHER_LAW = "F' u_xx", "G F' u_x^-2 u_xx^3 + H F' u_x^-1 u_xx u_xxx + I F' u_4x"


@dataclass(frozen=True)
class PDE(OfClosure):
    """The wave equation of a closure (`lwa.equation.pde` states its form)."""

    @property
    def acoustic(self) -> bool:
        """True for the equation of the acoustic branch."""
        return self.closure.model.branch == "acoustic"

    @cached_property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t of the equation's time to the chain's."""
        if self.acoustic:
            return self.cell.time_scale(self.law.exponent)
        # w = λu strains each contact by (λ - 1)u, and 1 - λ = M/m2.
        m1, m2 = self.cell.masses
        stretch = power(self.cell.mass / m2, self.k)
        return sp.sqrt(sp.Add(*self.cell.stiffnesses) * stretch / m1)

    @cached_property
    def coefficients(self) -> Mapping[int, Terms]:
        """Mapping from n to the terms of D^{k+n} (optical: D^n), without D; {} if they vanish.

        The leading term u_x^{k-1} u_xx (or -u^k) is left out.
        """
        base = self.closure.model.base
        sign = 1 if base else -1
        acceleration = enumerate(self.closure.acceleration)
        return {n: terms(self.closure, sign * E) for n, E in acceleration if n > base}

    LETTERS: ClassVar[Mapping[str, Jet]] = {
        "G": Jet(((2, 3),)),
        "H": Jet(((2, 1), (3, 1))),
        "I": Jet(((4, 1),)),
    }
    """The paper's letters for the coefficients at D^{k+3}, and their jets."""

    @property
    def third_order(self) -> dict[str, sp.Expr]:
        """Mapping from "G", "H", "I" to their values; {} below order 4 or on the optical branch."""
        known = self.acoustic and self.closure.order >= 4
        return (
            {letter: self._at_third_order(letter) for letter in self.LETTERS}
            if known
            else {}
        )

    def _at_third_order(self, letter: str) -> sp.Expr:
        if not self.acoustic or self.closure.order < 4:
            raise InputError(
                f"order is {self.closure.order}: G, H and I stand at D^(k+3), from order 4 on, on "
                "the acoustic branch"
            )
        return (
            self.coefficients[3].get(self.LETTERS[letter], sp.Integer(0))
            * self.cell.spacing**2
        )

    @cached_property
    def G(self) -> sp.Expr:
        """The coefficient of u_x^{k-3} u_xx^3, D² included."""
        return self._at_third_order("G")

    @cached_property
    def H(self) -> sp.Expr:
        """The coefficient of u_x^{k-2} u_xx u_xxx, D² included."""
        return self._at_third_order("H")

    @cached_property
    def I(self) -> sp.Expr:
        """The coefficient of u_x^{k-1} u_xxxx, D² included."""
        return self._at_third_order("I")

    def latex_rows(self, most: int | None = None) -> list[str]:
        """LaTeX of the equation to D^{k+most} (all orders if None), and of G, H, I."""
        letters = self.third_order
        leading = "u_{x}^{k-1}" if self.law.homogeneous else "F'"
        parts = [f"{leading} u_{{xx}}" if self.acoustic else "-u^{k}"]
        for n, of_order in self.coefficients.items():
            if n == 3 and letters:
                parts += [
                    f"{name} {of_order.latex(jet)}"
                    for name, jet in self.LETTERS.items()
                ]
            elif of_order and most is not None and n > most:
                parts.append(r"\cdots")
                break
            elif of_order:
                D = latex.power(self.cell.spacing, n - self.closure.model.base)
                parts.append(rf"{D} \Bigl({of_order.latex_rows()[0]}\Bigr)")
        rows = [latex.row(letter, value) for letter, value in letters.items()]
        return [rf"u_{{\tau\tau}} = {' + '.join(parts)}", *rows]

    def _repr_latex_(self) -> str:
        return latex.display(self.latex_rows(3))

    @property
    def heading(self) -> str:
        """Format string for the heading of an order n, such as D^(k+{})."""
        if not self.law.homogeneous:
            return "order {}"
        return "D^(k+{})" if self.acoustic else "D^{}"

    def __str__(self) -> str:
        """The equation as text, with G, H, I and the terms of the other orders below it."""
        third, order = self.third_order, self.closure.order
        if not self.acoustic:
            lines = [
                "u_ττ = -u^k + …   (contacts that also pull: the odd law |δ|^(k-1) δ)"
            ]
        elif order == 1:
            lines = [
                "the wave equation starts at D^(k+1), that is at order 2 of the ansatz"
            ]
        else:
            parts = list(
                (_POWER_LAW if self.law.homogeneous else _OTHER_LAW)[
                    : 2 if third else 1
                ]
            )
            parts += ["…"] * (order > (4 if third else 2))
            lines = [f"u_ττ = {' + '.join(parts)}"]
            lines += [f"  {letter} = {value}" for letter, value in third.items()]
        lines += by_order(
            {n: c for n, c in self.coefficients.items() if not (third and n == 3)},
            self.heading,
        )
        vanishing = ", ".join(map(self.heading.format, self.vanishing))
        return "\n".join(
            [*lines, *[f"  vanishing identically: {vanishing}"] * bool(vanishing)]
        )

    @property
    def vanishing(self) -> tuple[int, ...]:
        """The n whose order D^{k+n} (optical: D^n) vanishes identically."""
        return tuple(n for n, of_order in self.coefficients.items() if not of_order)

    @cached_property
    def conservative(self) -> bool:
        """True if all orders, D^{k+3} at least, are ∂_x of a flux: ∫ u_τ dx is conserved."""
        if not self.acoustic:
            return False
        return conservative(
            self.closure if self.closure.order >= 4 else self.closure.anew(order=4)
        )

    @cached_property
    def energy(self) -> Mapping[int, Terms]:
        """Mapping from n ≤ order - 2 to the terms e_n / u_x^{k+1} of the energy density Σ D^n e_n.

        This is the energy of the chain in the slaved fields (`lwa.equation.energy`). To the order
        of the closure it is conserved, in every field. e_0 = u_τ²/2 + u_x^{k+1}/(k(k+1)). For a
        law that is no power the terms are e_n / (u_x² F′), and e_0 lacks W(u_x), W′ = F.

        Raises `lwa.InputError` on the optical branch, and for a closure that leaves a defect.
        """
        algebra, densities = energy(self.closure)
        rows = {
            n: terms(self.closure, e, ENERGY, algebra=algebra)
            for n, e in enumerate(densities)
        }
        if densities and self.law.homogeneous:
            k = self.closure.model.ring.exponent(algebra.context)
            first = k * (k + 1) * densities[0] + 1
            rows[0] = terms(self.closure, first, ENERGY, self.k * (self.k + 1), algebra)
        return rows

    def at(self, **values: Any) -> PDE:
        """The equation for these values of the named symbols, and of ω = m2/m1 by ``omega``.

        Raises `lwa.InputError` for a name that does not occur or a value that is no quantity.
        """
        return PDE(self.closure.at(**values))

    def traveling_wave(self) -> CompactWave:
        """The compact wave of the equation truncated at D^{k+3}, in closed form.

        Raises `lwa.NoSolitaryWave` for numbers without a wave, and `lwa.InputError` if the closed
        form does not apply: the order is below 4, the branch optical, or D^{k+2} does not vanish
        (the linear closure with unequal contacts).
        """
        if not self.law.homogeneous:
            raise InputError(
                "the compact wave in closed form belongs to a power law: `lwa.loaded_wave` "
                "(--background P0) has the waves of any law"
            )
        wave = CompactWave(cell=self.cell, k=self.k, G=self.G, H=self.H, I=self.I)
        if 2 not in self.vanishing:
            raise InputError(
                "unequal stiffnesses leave a term at D^(k+2): no wave in closed form"
            )
        return wave
