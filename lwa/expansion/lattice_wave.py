"""The lattice's own solitary wave, of a given peak force, in the units of the cell.

One class for each theory; `best_wave` takes the one that is nearest to the lattice:

| class | beads | theory |
|---|---|---|
| `LatticeWave` | equal | closed form (`lwa.expansion.forms.joined`) for every k > 1 |
| `FollowingWave` | m2/m1 ≤ 0.5 | light beads that follow (`lwa.expansion.forms.following`) |
| `AlikeWave` | m2/m1 ≥ 0.75 | equal beads of the mean mass |
| `ExpandedWave` | any cell, k near 1 | sums of the series (`lwa.expansion.expand`) |
| `LongWave` | any cell | the canonical compact wave; its error is not known |

Between 0.5 and 0.75 and above k = 1.2 the light beads of a dimer resonate, and the pulse of a
struck chain decays. The force of a light bead's contacts has several humps from k = 7/4 on (at
7/4 for m2/m1 > 0.3, at 2 for > 0.1): the width of the highest means little there, as its error says.

With the compression δ = (F/A)^{1/k} of contacts by the peak force F and the mean mass m, speeds are
in units of D √(F/(m δ)), velocities of √(F δ/m), momenta of √(m F δ) and energies of F δ.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, number, positive, power, shorten
from lwa.base.frozen import RISE, Estimate, NoSolitaryWave, Value
from lwa.base.words import (
    EXTENTS,
    QUANTITIES,
    ExtentName,
    LanguageName,
    QuantityName,
    one_of,
)
from lwa.cell import Cell, exponent, read_cell, substitution
from lwa.cell import k as symbol_k
from lwa.expansion.expand import Expansion, expand
from lwa.expansion.forms.code import source
from lwa.expansion.forms.errors import (
    ALIKE,
    DECAYING,
    FARTHEST,
    alike_error,
    following_error,
    joined_error,
)
from lwa.expansion.forms.following import exponent_of_light_beads
from lwa.expansion.forms.joined import RATIOS, TWO_BODIES, joined
from lwa.expansion.series import EpsilonSeries
from lwa.expansion.sums import Resummed
from lwa.law import ContactLaw, Power, for_cell
from lwa.wave.compact import canonical_wave

ORDER = 10
"""Order in k - 1 of the sums that `best_wave` weighs."""

Name = Literal[
    "speed",
    "scaled_speed",
    "bead_velocity",
    "momentum",
    "energy",
    "effective_mass",
    "fwhm",
]
"""Attributes and methods of a wave that `LatticeWave.estimate` takes."""

_PARTS = {
    "speed": ("c",),
    "scaled_speed": ("c",),
    "bead_velocity": ("peak_velocity",),
    "momentum": ("momentum",),
    "energy": ("energy",),
    "effective_mass": ("momentum", "momentum", "energy"),
}
"""Quantities in a result, in the units of the module; their relative errors add up."""


@dataclass(frozen=True, repr=False)
class LatticeWave(Value):
    """The solitary wave of equal beads in closed form, for every k > 1; see `lattice_wave`.

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

    theory = "equal beads, closed form"

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", positive(self.force, "force"))
        if self.k.is_number and not self.k > 1:
            raise NoSolitaryWave(f"k is {self.k}: a solitary wave needs k > 1")

    def __repr__(self) -> str:
        shown = f"force={self.force}"
        if not self.speed.free_symbols:
            shown = f"speed {self.estimate('speed')}, width {self.estimate('fwhm')}"
        return f"{type(self).__name__}({self.cell!r}, k={self.k}, {shown})"

    # --- quantities in the units of the module, and their errors ------------------------------

    def _value(self, quantity: str) -> sp.Expr:
        """A quantity in the units of the module."""
        return joined(quantity).subs(symbol_k, self.k)

    def _error(self, quantity: str) -> float:
        """The relative error of a quantity; NaN if unknown."""
        return joined_error(quantity, self.k)

    def _scale(self, quantity: str) -> sp.Expr:
        """The unit of a quantity, as in the module, in the units of the cell."""
        mass = self.cell.mass / self.cell.size
        work = self.force * self.compression
        units = {
            "c": self.cell.spacing * sp.sqrt(self.force / (mass * self.compression)),
            "peak_velocity": sp.sqrt(work / mass),
            "momentum": sp.sqrt(mass * work),
            "energy": work,
        }
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
        return self._result("c")

    def scaled_speed(self, B: Any = RISE) -> sp.Expr:
        """The speed V_s = dx/dτ of the wave whose strain peaks at B, as `CompactWave.speed`."""
        scale = power(positive(B, "B"), (self.k - 1) / 2)
        return self._value("c") * scale / sp.sqrt(self.k)  # τ/t = √(k A D^{k+1}/m)

    @property
    def short_speed(self) -> sp.Expr:
        """The `speed` of equal beads by c = c₂ [1 + (π/√8 - 1) 4^{1-k}], to 0.2 %."""
        rest = (sp.pi / sp.sqrt(8) - 1) * 4 ** (1 - self.k)
        c = TWO_BODIES["c"].subs(symbol_k, self.k) * (1 + rest)
        return self.speed * c / self._value("c")

    @property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity of the beads; of the heavy ones where light beads follow."""
        return self._result("peak_velocity")

    @property
    def momentum(self) -> sp.Expr:
        """The momentum Σ m v of the chain."""
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
            Force or strain of a contact, or velocity of a bead, as of `bead_velocity`.
        extent : {"length", "time"}
            Extent in space, or time of passage.

        Returns
        -------
        sympy.Expr
        """
        length = self._result(one_of(quantity, QUANTITIES, "quantity"))
        if one_of(extent, EXTENTS, "extent") == "length":
            return length
        return length / self.speed

    def estimate(self, name: Name, *arguments: Any) -> Estimate:
        """The number of an attribute or a method, with its error against the lattice.

        Parameters
        ----------
        name : {"speed", "scaled_speed", "bead_velocity", "momentum", "energy", ...}
            Name of the attribute or method; also "effective_mass" and "fwhm".
        *arguments
            Arguments of the method, such as ``"force", "time"``.

        Returns
        -------
        Estimate
            Its error is NaN where the theory was not measured.

        Raises
        ------
        lwa.InputError
            For another name, if the wave holds symbols, and where a series has no sum.
        """
        one_of(name, (*_PARTS, "fwhm"), "name")
        value = getattr(self, name)
        if callable(value):
            value = value(*arguments)
        parts = list(_PARTS.get(name, ()))
        if name == "fwhm":
            parts.append(arguments[0] if arguments else "force")
            if "time" in arguments:
                parts.append("c")
        result = Estimate(number(value), 0.0)
        for part in parts:
            result = result.widened(self._error(part))
        return result

    def at_force(self, F: Any = "F") -> Self:
        """The wave of another peak force, a number or a name."""
        return replace(self, force=F)

    def at(self, **values: Any) -> LatticeWave:
        """Substitute numbers or other symbols for named symbols, and for ω = m2/m1 by ``omega``.

        >>> lattice_wave(Cell(["m"], spacing=1)).at(m=1, k=2).estimate("speed")
        0.845860 ± 1e-05
        """
        more = sorted(self.force.free_symbols, key=str)
        new = substitution(values, self.cell, self.k, more)
        cell = self.cell.replaced(new)
        force = self.force.xreplace(new)
        return lattice_wave(cell, k=self.k.xreplace(new), force=force)

    def latex_rows(self) -> list[str]:
        """LaTeX of speed and widths at the peak force."""
        rows = {latex.SPEED: self.speed}
        for quantity in QUANTITIES:
            name = rf"\mathrm{{FWHM}}_\mathrm{{{quantity}}}"
            rows[name] = self.fwhm(quantity)
        return latex.rows(rows)

    def code(self, language: LanguageName) -> str:
        """Source text of a program: speed, widths, momentum and energy as functions.

        Parameters
        ----------
        language : {"numpy", "c", "javascript"}
            The language. Γ and the incomplete beta function are written out, to 1e-8.

        Raises
        ------
        lwa.InputError
            For another language, and for symbols that are no names of variables.
        """
        values = {"speed": self.speed, "momentum": self.momentum, "energy": self.energy}
        for quantity in QUANTITIES:
            values[f"fwhm_{quantity}"] = self.fwhm(quantity)
        cell = self.cell
        arguments = (self.force, self.k, *cell.masses, *cell.stiffnesses, cell.spacing)
        return source(values, arguments, language)

    @property
    def doubt(self) -> float:
        """The larger relative error of the speed and the force's width; infinite if unknown."""
        try:
            errors = (self._error("c"), self._error("force"))
        except InputError:  # a series without a sum
            return math.inf
        if math.isnan(sum(errors)):
            return math.inf
        return max(errors)


@dataclass(frozen=True, repr=False)
class AlikeWave(LatticeWave):
    """The wave of two beads that are nearly alike: of equal beads of their mean mass."""

    theory = "beads that are nearly alike, closed form of their mean mass"

    def _error(self, quantity: str) -> float:
        ratio = mass_ratio(self.cell)
        return super()._error(quantity) + alike_error(quantity, self.k, ratio)


@dataclass(frozen=True, repr=False)
class FollowingWave(LatticeWave):
    """The wave of heavy beads between which light beads follow."""

    theory = "light beads that follow, closed form"

    def _value(self, quantity: str) -> sp.Expr:
        # From the units of heavy beads to the module's: m1 = 2m/(1 + ω), D and δ are doubled.
        shift = {"c": sp.S.Half, "peak_velocity": sp.S.Half, "momentum": -sp.S.Half}
        power = exponent_of_light_beads(quantity).subs(symbol_k, self.k)
        ratio = 1 + mass_ratio(self.cell)
        value = super()._value(quantity) * ratio ** (shift.get(quantity, 0) - power)
        return value if quantity in RATIOS else 2 * value

    def _error(self, quantity: str) -> float:
        ratio = mass_ratio(self.cell)
        return super()._error(quantity) + following_error(quantity, self.k, ratio)


@dataclass(frozen=True, repr=False)
class ExpandedWave(LatticeWave):
    """The wave by the sums of its series in k - 1, of any cell of numbers; see `lwa.expand`.

    Attributes
    ----------
    order : int
        Highest power of k - 1.

    Examples
    --------
    >>> wave = ExpandedWave(Cell([1], spacing=2), sp.Rational(3, 2), 64, order=16)
    >>> wave.estimate("speed"), wave.estimate("fwhm", "force")
    (3.622063 ± 2e-09, 2.823857 ± 4e-08)
    """

    order: int = ORDER

    theory = "series in k - 1"

    @cached_property
    def expansion(self) -> Expansion:
        """The expansion of the cell."""
        return expand(self.cell, self.order, k=self.k)

    def _sum(self, quantity: str) -> Resummed:
        """The sum of a quantity at peak force 1 and D = 1."""
        series: dict[str, EpsilonSeries] = {
            "c": self.expansion.c,
            "momentum": self.expansion.momentum,
            "energy": self.expansion.energy,
        }
        if quantity in QUANTITIES:
            return self.expansion.fwhm(quantity).at()
        if quantity not in series:
            raise InputError(f"no series gives the {quantity}: lattice_wave does")
        return series[quantity].at()

    def _value(self, quantity: str) -> sp.Expr:
        scale = replace(self, force=sp.S.One)._scale(quantity) / self.cell.spacing
        if quantity in ("momentum", "energy"):
            scale = scale * self.cell.spacing
        return sp.Float(self._sum(quantity).value) / scale

    def _error(self, quantity: str) -> float:
        return self._sum(quantity).relative_error


@dataclass(frozen=True, repr=False)
class LongWave(LatticeWave):
    """The canonical compact wave of any cell, whose error is not known."""

    theory = "canonical wave, error unknown"

    def _result(self, quantity: str) -> sp.Expr:
        wave = canonical_wave(self.cell, k=self.k).at_force(self.force)
        if quantity in QUANTITIES:
            return wave.fwhm(quantity)
        found = {"c": wave.speed, "momentum": wave.momentum}
        return found.get(quantity, sp.nan)

    def _error(self, quantity: str) -> float:
        return math.nan


def mass_ratio(cell: Cell) -> sp.Expr:
    """The ratio m2/m1 ≤ 1 of two beads' masses; of symbols, the second over the first."""
    first, second = cell.masses
    if first.is_number and second.is_number and second > first:
        return first / second
    return second / first


def lattice_wave(
    cell: Cell,
    *,
    k: Any = symbol_k,
    force: Any = 1,
    law: ContactLaw | None = None,
) -> LatticeWave:
    """The lattice's own solitary wave in closed form.

    Parameters
    ----------
    cell : Cell
        Equal beads and contacts, however many are listed, or two beads with equal contacts: a
        light one that follows its heavy neighbours, up to m2/m1 = 0.5, or beads that are nearly
        alike. Of two symbols the second is the light bead.
    k : number or symbol
        Exponent k > 1 of the contact law F = A δ^k.
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
        For k ≤ 1.

    Examples
    --------
    >>> wave = lattice_wave(Cell(["m"], ["A"]))
    >>> wave.at(k=3, m=1, A=1).estimate("energy")
    0.51146 ± 2.5e-04
    >>> lattice_wave(Cell([1], spacing=1), k="3/2").estimate("fwhm", "force")
    1.4122 ± 0.0006
    """
    read_cell(cell)
    law = for_cell(law, cell, k)
    if not law.homogeneous:
        raise InputError(
            f"law is {law.text}: closed forms of the lattice's wave are those of a power law; "
            "loaded_wave(cell, rise=…, background=…, law=law) takes any law"
        )
    k = exponent(law.exponent)
    if cell.uniform:
        return LatticeWave(
            Cell(cell.masses[:1], cell.stiffnesses[:1], cell.spacing), k, force
        )
    if cell.size != 2 or len(set(cell.stiffnesses)) > 1:
        raise InputError(
            f"cell is {shorten(cell)}: closed forms are those of equal beads and of two beads with "
            "equal contacts; best_wave(cell, k=…) takes any cell"
        )
    ratio = mass_ratio(cell)
    if ratio.is_number and ratio > FARTHEST:
        return AlikeWave(cell, k, force)
    return FollowingWave(cell, k, force)


def best_wave(
    cell: Cell,
    *,
    k: Any = symbol_k,
    force: Any = 1,
    law: ContactLaw | None = None,
) -> LatticeWave:
    """The lattice's wave by the theory that is nearest to the lattice.

    Parameters
    ----------
    cell : Cell
        The chain, all numbers.
    k, force : number
        Exponent of the contact law F = A δ^k, and peak force of the contacts.
    law : Power, optional
        A power law in place of k.

    Returns
    -------
    LatticeWave
        Its `theory` is the name in words; numbers with errors by `LatticeWave.estimate`.

    Raises
    ------
    lwa.InputError
        For symbols, and laws other than powers.
    lwa.NoSolitaryWave
        For k ≤ 1, and where light beads resonate so that the pulse of a struck chain decays.

    Examples
    --------
    >>> from lwa import Dimer
    >>> wave = best_wave(Dimer("0.45", "0.123", spacing=1), k="3/2")
    >>> wave.theory, wave.estimate("speed")
    ('light beads that follow, closed form', 1.71 ± 0.03)
    """
    law = for_cell(law, cell, k)
    sums = ExpandedWave(cell, exponent(law.exponent), force)
    if not sums.expansion.numeric:
        raise InputError(
            "k and the cell hold symbols: the best theory is that of numbers; give them by at(…)"
        )
    waves: list[LatticeWave] = [sums]
    with suppress(InputError):  # cells without a closed form
        waves.append(lattice_wave(cell, law=law, force=force))
    best = min(waves, key=lambda wave: wave.doubt)
    if math.isfinite(best.doubt):
        return best
    if len(waves) > 1 and sums.k > DECAYING:
        ratio = mass_ratio(cell)
        if FARTHEST < ratio < ALIKE:
            raise NoSolitaryWave(
                f"m2/m1 is {shorten(ratio)}: between {FARTHEST} and {ALIKE} and for k above "
                f"{DECAYING} the light beads resonate, and the pulse decays"
            )
    return LongWave(cell, sums.k, sums.force)
