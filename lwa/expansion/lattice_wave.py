"""The lattice's own solitary wave in closed form, in the units of the cell.

The wave of equal beads has closed forms for every k > 1 (`lwa.expansion.joined`), and so has that
of dimers (`lwa.expansion.dimers`): for m2/m1 < 0.75 the light beads follow their neighbours, from
there on the pulse is that of equal beads of the mean mass.

Errors are bounds of measured deviations (`LatticeWave.estimate`). Where the light beads resonate,
above k of 1.2 from m2/m1 of 0.5 to 0.75 and at some smaller ratios, the pulse of a struck chain
decays. The force of a light bead's contacts has several humps from k of 7/4 on (at 7/4 for m2/m1 >
0.3, at 2 for > 0.1): the width of the highest means little there, as its error says. The series of
`lwa.expand` is nearer for equal beads at k < 3, and for any cell near k of 1.

With the compression ``δ = (F/A)^{1/k}`` of contacts by the peak force F and the mean mass m, speeds
are in units of ``D √(F/(m δ))``, momenta of ``√(m F δ)`` and energies of ``F δ``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, number, positive, power, shorten
from lwa.base.frozen import RISE, Estimate, NoSolitaryWave, known_extent, known_quantity
from lwa.base.words import QUANTITIES, ExtentName, LanguageName, QuantityName, one_of
from lwa.cell import Cell, Parametric, exponent, k as symbol_k, read_cell
from lwa.expansion.dimers import ALIKE, dimer_error, exponent_of_light_beads, steadiness
from lwa.expansion.joined import FORMS, joined, joined_error
from lwa.law import ContactLaw, Power, power_exponent
from lwa.wave.source import Functions, module

_PARTS = {
    "speed": ("speed",),
    "scaled_speed": ("speed",),
    "momentum": ("momentum",),
    "energy": ("energy",),
    "effective_mass": ("momentum", "momentum", "energy"),
    "fwhm": (),
}
"""The quantities of which a result is a product or a quotient: their relative errors add up. The
quantity of `fwhm` is its argument."""


_TITLE = (
    "The lattice's own solitary wave, written by lwa: exact to 1e-5 (speed) and",
    "1e-3 for equal beads at every k > 1. Peak contact force F, lengths in units of D.",
)

_DIGITS = 17
"""Digits of the numbers in a program, those of a double."""

_MEANINGS = {
    "speed": "dx/dt",
    "momentum": "Momentum of the chain",
    "energy": "Kinetic and elastic energy of the chain",
}
"""Functions of a program besides the widths, and their comments."""


@dataclass(frozen=True, repr=False)
class LatticeWave(Parametric):
    """The solitary wave of equal beads or of a dimer in closed form; see `lattice_wave`.

    Attributes
    ----------
    cell, k : Cell, sympy.Expr
        The chain and the exponent of its contact law.
    force : sympy.Expr
        Peak force of the contacts; of a light bead's two contacts, the mean.
    """

    cell: Cell
    k: sp.Expr
    force: sp.Expr

    def __post_init__(self) -> None:
        self._set(force=positive(self.force, "force"), k=exponent(self.k))
        cell = read_cell(self.cell)
        if cell.uniform:
            # However many equal beads a cell lists, its wave is that of one.
            one = Cell(cell.masses[:1], cell.stiffnesses[:1], cell.spacing)
            self._set(cell=one)
        elif cell.size != 2 or not cell.equal_contacts:
            raise InputError(
                f"cell is {shorten(cell)}: closed forms are those of equal beads and of two beads "
                "with equal contacts; expand(cell, 8, k=…) takes any cell"
            )
        # A symbol k is taken for one above 1.
        if self.k.is_number and not self.k > 1:
            raise NoSolitaryWave(f"k is {self.k}: a solitary wave needs k > 1")
        ratio = self.mass_ratio
        # A wave is refused if half or more of the measured pulses next to it were not steady.
        if ratio.is_number and self.k.is_number and steadiness(self.k, ratio) <= 0.5:
            raise NoSolitaryWave(
                f"m2/m1 is {shorten(ratio)} at k = {self.k}: the light beads resonate with the "
                "pulse of a struck chain, which decays"
            )

    def __repr__(self) -> str:
        shown = f"force={self.force}"
        # The answer is shown where there is one: numbers.
        if not self.speed.free_symbols:
            shown = f"speed {self.estimate('speed')}, width {self.estimate('fwhm')}"
        return f"{type(self).__name__}({self.cell!r}, k={self.k}, {shown})"

    @property
    def mass_ratio(self) -> sp.Expr:
        """The lesser of two beads' masses over the other; of symbols, the second over the first."""
        # A cell of equal beads has one mass: the ratio is 1.
        ratio = self.cell.masses[-1] / self.cell.masses[0]
        # Of two symbols nobody knows which is less: the second counts as the lesser one.
        if ratio.is_number and ratio > 1:
            return 1 / ratio
        return ratio

    @property
    def follows(self) -> bool:
        """True if a light bead follows its neighbours, false for beads that are nearly alike."""
        return not (self.mass_ratio.is_number and self.mass_ratio >= ALIKE)

    @property
    def theory(self) -> str:
        """The theory in words."""
        if self.mass_ratio == 1:
            return "equal beads, closed form"
        if self.follows:
            return "light beads that follow, closed form"
        return "beads that are nearly alike, closed form of their mean mass"

    # --- quantities in the units of the module, and their errors ------------------------------

    def _value(self, quantity: str) -> sp.Expr:
        """A quantity in the units of the module."""
        value = joined(quantity)
        if self.follows:
            # From the units of heavy beads to the module's: m1 = 2m/(1 + ω), D and δ are doubled.
            shift = {"speed": sp.S.Half, "momentum": -sp.S.Half}.get(quantity, 0)
            exponent = shift - exponent_of_light_beads(quantity)
            value = value * (1 + self.mass_ratio) ** exponent
            if quantity != "speed":
                value = 2 * value
        return value.subs(symbol_k, self.k)

    def _error(self, quantity: str) -> float:
        """The relative error of a quantity; NaN if unknown."""
        error = joined_error(quantity, self.k)
        # The closed form of equal beads has an error, and what a dimer adds to it has another one:
        # both are bounds, so that their sum is one.
        if self.mass_ratio != 1:
            error += dimer_error(quantity, self.k, self.mass_ratio)
        return error

    def _scale(self, quantity: str) -> sp.Expr:
        """The unit of a quantity, as in the module, in the units of the cell."""
        mass = self.cell.mass / self.cell.size
        work = self.force * self.compression
        units = {
            "speed": self.cell.spacing
            * sp.sqrt(self.force / (mass * self.compression)),
            "momentum": sp.sqrt(mass * work),
            "energy": work,
        }
        # Every other quantity is a width.
        return units.get(quantity, self.cell.spacing)

    def _result(self, quantity: str) -> sp.Expr:
        """A quantity in the units of the cell."""
        return self._value(quantity) * self._scale(quantity)

    # --- results in the units of the cell -----------------------------------------------------

    @property
    def compression(self) -> sp.Expr:
        """The peak compression of a contact; the mean over unlike contacts."""
        return Power(self.k).compression(self.cell, self.force)

    @property
    def strain(self) -> sp.Expr:
        """The peak strain of a contact, its compression over the spacing."""
        return self.compression / self.cell.spacing

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed dx/dt."""
        return self._result("speed")

    def scaled_speed(self, B: Any = RISE) -> sp.Expr:
        """Speed ``V_s = dx/dτ`` of the wave whose strain peaks at B, as `lwa.CompactWave.speed`."""
        scale = power(positive(B, "B"), (self.k - 1) / 2)
        # The unit of speeds is D √(F/(m δ)), with F/δ = A (D B)^{k-1}, and τ/t = √(k A D^{k+1}/m).
        return self._value("speed") * scale / sp.sqrt(self.k)

    @property
    def short_speed(self) -> sp.Expr:
        """The `speed` of equal beads by ``c = c₂ [1 + (π/√8 - 1) 4^{1-k}]``, to 0.2 %."""
        # e^{-εφ} of `lwa.expansion.joined` with ln 4, 1.386, for φ, which is 1.539 at k = 1 and
        # 1.226 in the limit of large k
        rest = (sp.pi / sp.sqrt(8) - 1) * 4 ** (1 - self.k)
        c = FORMS["speed"].two_bodies.subs(symbol_k, self.k) * (1 + rest)
        return self.speed * c / self._value("speed")

    @property
    def momentum(self) -> sp.Expr:
        """The momentum ``Σ m v`` of the chain."""
        return self._result("momentum")

    @property
    def energy(self) -> sp.Expr:
        """The kinetic and elastic energy of the chain."""
        return self._result("energy")

    @property
    def effective_mass(self) -> sp.Expr:
        """The mass P²/(2E) of a particle with the wave's momentum P and energy E, at any force."""
        return self.momentum**2 / (2 * self.energy)

    def fwhm(
        self, quantity: QuantityName = "force", extent: ExtentName = "length"
    ) -> sp.Expr:
        """Full width at half maximum.

        Parameters
        ----------
        quantity : {"force", "strain", "velocity"}
            Force or strain of a contact, or velocity of a bead (of a dimer, a heavy one).
        extent : {"length", "time"}
            Extent in space, or time of passage.

        Returns
        -------
        sympy.Expr
        """
        length = self._result(known_quantity(quantity))
        if known_extent(extent) == "length":
            return length
        return length / self.speed

    def estimate(self, name: str, *arguments: Any) -> Estimate:
        """The number of an attribute or a method, with its error against the lattice.

        Parameters
        ----------
        name : {"speed", "scaled_speed", "momentum", "energy", "effective_mass", "fwhm"}
            Name of the attribute or method.
        *arguments
            Arguments of the method, such as ``"force", "time"``.

        Returns
        -------
        Estimate
            Its error is NaN where the theory was not measured. A spacing that is a symbol is the
            unit of length.

        Raises
        ------
        lwa.InputError
            For another name, and if the wave holds symbols.
        """
        one_of(name, _PARTS, "name")  # refuses any other name
        spacing = self.cell.spacing
        if spacing.is_Symbol and not self.force.has(spacing):
            return self.at(**{spacing.name: 1}).estimate(name, *arguments)
        value = getattr(self, name)
        # A method is read with its arguments, an attribute has none.
        if callable(value):
            value = value(*arguments)
        parts = [*_PARTS[name]]
        if name == "fwhm":
            quantity, *extent = arguments or ("force",)
            parts.append(quantity)
            # A time is a length over the speed.
            if "time" in extent:
                parts.append("speed")
        return Estimate(number(value), 0.0).widened(sum(map(self._error, parts)))

    def at_force(self, F: Any = "F") -> Self:
        """The wave of another peak force, a number or a name."""
        return replace(self, force=F)

    def latex_rows(self) -> list[str]:
        """LaTeX of speed and widths at the peak force."""
        widths = {latex.fwhm(quantity): self.fwhm(quantity) for quantity in QUANTITIES}
        return latex.rows({latex.SPEED: self.speed} | widths)

    def code(self, language: LanguageName) -> str:
        """Source text of a program: speed, widths, momentum and energy as functions.

        Parameters
        ----------
        language : {"numpy", "c", "javascript"}
            The language.

        Raises
        ------
        lwa.InputError
            For another language, for symbols that are no names of variables, and for a symbol k:
            Γ and the incomplete beta function are numbers for a number k alone.
        """
        why = (
            "the languages lack the incomplete beta function, which is a number for a number k, as "
            "in wave.at(k='3/2').code('c')"
        )
        demand_numbers(self.k.free_symbols, why)
        cell = self.cell
        # A function has as arguments, in this order, the symbols on which it depends.
        functions = Functions(self.force, *cell.masses, *cell.stiffnesses, cell.spacing)
        for name, meaning in _MEANINGS.items():
            functions.define(name, meaning, getattr(self, name).n(_DIGITS))
        for quantity in QUANTITIES:
            meaning = f"Full width at half maximum of the {quantity}"
            width = self.fwhm(quantity).n(_DIGITS)
            functions.define(f"fwhm_{quantity}", meaning, width)
        return module([*functions.values()], language, _TITLE)


def lattice_wave(
    cell: Cell, *, k: Any = symbol_k, force: Any = 1, law: ContactLaw | None = None
) -> LatticeWave:
    """The lattice's own solitary wave in closed form.

    Parameters
    ----------
    cell : Cell
        Equal beads and contacts, however many are listed, or two beads with equal contacts: a
        light one that follows its heavy neighbours, or beads that are nearly alike. Of two symbols
        the second is the light bead.
    k : number or symbol
        Exponent k > 1 of the contact law ``F = A δ^k``.
    force : number or symbol
        Peak force of the contacts.
    law : Power, optional
        A power law in place of k.

    Returns
    -------
    LatticeWave
        Exact SymPy expressions in the units of the cell; numbers with errors by
        `LatticeWave.estimate`.

    Raises
    ------
    lwa.InputError
        For other cells and laws.
    lwa.NoSolitaryWave
        For k up to 1, and where the light beads resonate and the pulse of a struck chain decays.

    Examples
    --------
    >>> wave = lattice_wave(Cell(["m"], ["A"]))
    >>> wave.at(k=3, m=1, A=1).estimate("energy")
    0.51146 ± 1.7e-04
    >>> lattice_wave(Cell([1], spacing=1), k="3/2").estimate("fwhm", "force")
    1.4122 ± 6e-04
    >>> wave = lattice_wave(Cell(["0.45", "0.123"], spacing=1), k="3/2")
    >>> wave.theory, wave.estimate("speed")
    ('light beads that follow, closed form', 1.708 ± 0.006)
    """
    why = (
        "closed forms of the lattice's wave are those of a power law; "
        "loaded_wave(cell, rise=…, background=…, law=law) takes any law"
    )
    return LatticeWave(cell, power_exponent(law, cell, k, why), force)
