"""The nonlinear Schrödinger equation of a mode of a loaded chain::

    i Ψ_T + ½ω″ Ψ_XX = χ |Ψ|²Ψ.

To leading order the displacements in cell n are ``u = Ψ(X,T) U e^{i(κn - ωt)} + c.c.``: U is the
mode, with ``Σ m_i |U_i|² = 1`` over the beads of a cell, ω its frequency, κ its wavenumber per
cell, ``ω″`` the second derivative of ω by κ, ``X = n - (dω/dκ) t``, ``T = t``, and χ the nonlinear
coefficient (`lwa.envelopes.modes`). The load is held, not the length. Equal beads under a power
law of the exponent k have ``χ = -ω (k-1) (k - cos² κ/2)/(m δ0²)``, δ0 the static compression.

At the edge of a band, where the group velocity is 0, envelopes stand. Such a breather of the
frequency (1 - Δ) ω, Δ the detuning, is ``Ψ = a f(bn) e^{-iΩT}`` with ``Ω = -Δω`` and::

    bright, ω″χ < 0:   f = sech,   χ a² = 2Ω,   ω″ b² = -2Ω,
    dark,   ω″χ > 0:   f = tanh,   χ a² = Ω,    ω″ b² = Ω,

so that Ω has the sign of χ. A bead is displaced by ``2a|U|`` at most, and the compression of a
contact differs from its static value δ0 by ``2a|d|``, d the contact's compression in the mode.
Contacts begin to open at about ``2a|d| = δ0``, that is at a detuning Δ_o, as a² is proportional to
Δ.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NoReturn, get_args

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base import latex
from lwa.base.arrays import Array
from lwa.base.exact import (
    InputError,
    brief,
    demand_numbers,
    factored,
    integer,
    positive,
    shorten,
    signed,
)
from lwa.base.frozen import Value
from lwa.base.words import BRANCHES, BranchName, one_of
from lwa.cell import Cell, by_name, k as symbol_k
from lwa.envelopes.modes import LoadedMode
from lwa.law import ContactLaw, for_cell

KindName = Literal["bright", "dark"]
"""A kind of envelope: localised, ``ω″χ < 0``, or a dip in a wave train."""


@dataclass(frozen=True, repr=False)
class Envelope(LoadedMode):
    """The envelope's equation of one mode (see `envelope`), exact or in floats.

    Units are those of the cell; frequencies are in radians per unit of time.

    Parameters are those of `lwa.envelopes.modes.LoadedMode`.
    """

    def __repr__(self) -> str:
        shown = f"{self.cell!r}, κ={self.wavenumber}, branch={self.branch}"
        # Symbols that only floats could solve for have no answer.
        with suppress(InputError):
            shown += f": ω={brief(self.frequency)}, ω″={brief(self.dispersion)}"
            shown += f", χ={brief(self.nonlinearity)}"
        return f"Envelope({shown})"

    def latex_rows(self) -> list[str]:
        equation = (
            r"i \Psi_{T} + \tfrac{1}{2} \omega'' \Psi_{XX} = \chi |\Psi|^{2} \Psi"
        )
        rows = {
            r"\omega": self.frequency,
            r"\omega'": self.group_velocity,
            r"\omega''": self.dispersion,
            r"\chi": self.nonlinearity,
        }
        return [equation, *latex.rows(rows)]

    def numeric(self) -> Envelope:
        """Float values of the coefficients, for any cell of numbers and any wavenumber."""
        return replace(self, floats=True)

    # --- coefficients ---

    @cached_property
    def frequency(self) -> sp.Expr:
        """Frequency ω of the mode, in radians per unit of time."""
        root = sp.sqrt(self._tidy(self._mode.square))
        return self._tidy(root.replace(sp.Abs, lambda x: x))  # sin κ/2 is not negative

    @cached_property
    def group_velocity(self) -> sp.Expr:
        """Group velocity ``dω/dκ``, in cells per unit of time."""
        if sp.sin(self.wavenumber).is_zero:  # the edge of a band, in floats as well
            return sp.S.Zero
        # dω²/dκ = 2ω dω/dκ
        return self._tidy(self._mode.slope / (2 * self.frequency))

    @cached_property
    def dispersion(self) -> sp.Expr:
        """Dispersion coefficient ``ω″``, the second derivative of ω by κ.

        >>> envelope(Cell(["m"], ["K"]), k=1, background="p0", wavenumber="q").dispersion
        -sqrt(K)*sin(q/2)/(2*sqrt(m))
        """
        # The mode's curvature is ω ω″.
        return self._tidy(self._mode.curvature / self.frequency)

    @cached_property
    def nonlinearity(self) -> sp.Expr:
        """Nonlinear coefficient χ: the amplitude Ψ raises the frequency by ``χ|Ψ|²``."""
        # The mode's cubic coefficient is 2ωχ.
        return self._tidy(self._mode.cubic / (2 * self.frequency))

    @cached_property
    def mean_strain(self) -> tuple[sp.Expr, ...]:
        """Lasting compression e0 of each contact over ``|Ψ|²``, with the lasting force's part."""
        return self._each(self._mode.mean)

    @cached_property
    def mode(self) -> tuple[sp.Expr, ...]:
        """Mode U, one component per bead; positive for the bead with the largest displacement."""
        return self._each(self._mode.shape)

    @cached_property
    def squared_strains(self) -> tuple[sp.Expr, ...]:
        """Squared compression ``|d|²`` of each contact in the mode."""
        return self._each(self._mode.size)

    @property
    def kind(self) -> KindName:
        """ "bright" or "dark"; raises `lwa.InputError` where symbols leave it open."""
        sign = self.dispersion * self.nonlinearity
        if sign.is_zero:
            raise InputError(
                "the dispersion or the nonlinearity vanishes: no envelope has a shape"
            )
        # SymPy knows the sign of more expressions once their factors stand apart.
        sign = self._tidy(sign)
        if sign.is_negative is None:
            demand_numbers(sign.free_symbols, "bright or dark depends on it")
        return "bright" if sign.is_negative else "dark"

    def breather(
        self,
        frequency: Any = None,
        *,
        detuning: Any = None,
        kind: KindName | None = None,
    ) -> Breather:
        """The standing envelope of a frequency, or of a detuning.

        Parameters
        ----------
        frequency : number, optional
            Frequency of the breather, in radians per unit of time.
        detuning : number or str, optional
            Detuning Δ, 1 less the ratio of the breather's frequency to ω; in place of a frequency.
        kind : {"bright", "dark"}, optional
            The kind, where symbols leave it open.

        Raises
        ------
        InputError
            Where the group velocity is not 0, and as `lwa.Breather`.
        """
        if (frequency is None) == (detuning is None):
            raise InputError("frequency or detuning: one of the two is wanted")
        if detuning is None:  # Δ = 1 - f/f0
            detuning = 1 - positive(frequency, "frequency") / self.frequency
        if self.group_velocity.is_zero is not True:
            raise InputError(
                f"wavenumber is {self.wavenumber}: a breather stands where dω/dκ = 0",
                wavenumber=sp.pi,
            )
        return Breather(self, signed(detuning, "detuning"), kind or self.kind)

    @property
    def opening(self) -> sp.Expr:
        """The ``|Ψ|²`` at which the first contact opens; ∞ for a law that pulls, or is no formula.

        A contact opens where the mode takes away its static compression. Under a law that pulls
        none opens, and of a law without an expression it is not known if it pulls.
        """
        if self.law.pulls or self.law.formless:
            return sp.oo
        smallest = sp.oo
        contacts = zip(self.static_compressions, self.squared_strains, strict=True)
        for static, square in contacts:
            if square:  # a contact that the mode does not compress never opens
                # 2|Ψ||d| is the largest change of the compression.
                smallest = sp.Min(smallest, static**2 / (4 * square))
        return sp.N(smallest) if self.floats else smallest

    def _each(self, values: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
        """The values in their shortest forms."""
        return tuple(self._tidy(value) for value in values)

    def _tidy(self, value: sp.Expr) -> sp.Expr:
        """A value as a float, or with its factors."""
        return sp.N(value) if self.floats else sp.powsimp(factored(value))


@dataclass(frozen=True, repr=False)
class Breather(Value):
    """The standing envelope of a frequency (see `lwa.Envelope.breather`).

    Parameters
    ----------
    envelope : Envelope
        The equation, of the frequency ω.
    detuning : Expr
        Detuning Δ: the frequency is (1 - Δ) ω.
    kind : {"bright", "dark"}
        The kind.

    Raises
    ------
    InputError
        For a detuning to the side where there is no such envelope, and for one at which contacts
        open.
    """

    envelope: Envelope
    detuning: sp.Expr
    kind: KindName

    def __post_init__(self) -> None:
        # Called for its refusal of another word
        one_of(self.kind, get_args(KindName), "kind")
        # With symbols every condition is taken to hold.
        if self.detuning.is_number and self.detuning >= 1:
            self._refuse("a frequency is positive, and the detuning below 1")
        if self._square.is_positive is False:
            if self.envelope.nonlinearity.is_negative:
                self._refuse(f"{self.kind} breathers lie below f0, at values > 0")
            self._refuse(f"{self.kind} breathers lie above f0, at values < 0")
        # A ratio, as both may be negative
        part = self.detuning / self.opening_detuning
        if part.is_number and part > 1:
            self._refuse(f"contacts open from {float(self.opening_detuning):.5g} on")

    def _refuse(self, why: str) -> NoReturn:
        """Raise an error that names the detuning."""
        detuning = sp.sstr(sp.N(self.detuning, 5), full_prec=False)
        raise InputError(f"detuning 1 - f/f0 is {detuning}: {why}")

    def __repr__(self) -> str:
        beads = ", ".join(map(brief, self.amplitude))
        return (
            f"Breather({self.kind}, frequency={brief(self.frequency)}, "
            f"width={brief(self.width)}, amplitudes {beads})"
        )

    def latex_rows(self) -> list[str]:
        shape = r"\operatorname{sech}" if self.kind == "bright" else r"\tanh"
        return [
            rf"|\Psi| = a {shape}(b n)",
            latex.row("a^{2}", self._square),
            latex.row("b^{-1}", self.width),
        ]

    @property
    def frequency(self) -> sp.Expr:
        """Frequency (1 - Δ) ω of the breather, in radians per unit of time."""
        return (1 - self.detuning) * self.envelope.frequency

    @property
    def _shift(self) -> sp.Expr:
        """The shift ``Ω = -Δω`` of the frequency."""
        return -self.detuning * self.envelope.frequency

    @property
    def _share(self) -> int:
        """The ratio ``χ a²/Ω`` of the two kinds."""
        return 2 if self.kind == "bright" else 1

    @cached_property
    def _square(self) -> sp.Expr:
        """Square a² of the envelope's amplitude."""
        square = self._share * self._shift / self.envelope.nonlinearity
        return sp.powsimp(factored(square))

    @cached_property
    def amplitude(self) -> tuple[sp.Expr, ...]:
        """Largest displacement 2aU of each bead, in the cell's units, with the sign of the mode."""
        return tuple(2 * sp.sqrt(self._square) * U for U in self.envelope.mode)

    @cached_property
    def width(self) -> sp.Expr:
        """Width 1/b, in cells, of the envelope sech(bn) or tanh(bn)."""
        # `_shift` is Ω, and `_share` 2 for a bright breather, 1 for a dark one.
        squared = self.envelope.dispersion / (self._share * self._shift)
        if self.kind == "bright":  # ω″ b² = -2Ω
            squared = -squared
        return sp.sqrt(factored(squared))

    @cached_property
    def opening_detuning(self) -> sp.Expr:
        """Detuning at which contacts begin to open, to leading order; infinite if contacts pull.

        Under a power law it is the same at every load. In the lattice contacts open earlier: for
        spheres of mass ratios 0.3 to 0.5 at 0.018 instead of 3/128, which is 0.0234.
        """
        # a² = -share Δ ω/χ
        rate = self._share * self.envelope.frequency
        opening = self.envelope.opening * self.envelope.nonlinearity
        return sp.simplify(-opening / rate)

    def displacements(self, cells: ArrayLike) -> Array:
        """Displacements of the beads at the time 0 to leading order, in floats.

        Parameters
        ----------
        cells : array_like
            Numbers n of the cells.

        Returns
        -------
        array, shape (cells, beads)
        """
        n = np.asarray(cells, float)
        x = n / float(self.width)
        if self.kind == "bright":
            profile = 1 / np.cosh(x)
        else:
            profile = np.tanh(x)
        # At the edge of a band e^{iκn} is real.
        phase = np.cos(float(self.envelope.wavenumber) * n)
        amplitude = np.array(self.amplitude, float)
        return np.asarray(np.multiply.outer(profile * phase, amplitude))


def envelope(
    cell: Cell,
    *,
    law: ContactLaw | None = None,
    k: Any = symbol_k,
    background: Any = None,
    precompression: Any = None,
    wavenumber: Any = sp.pi,
    branch: BranchName | int | None = None,
) -> Envelope:
    """The nonlinear Schrödinger equation of a mode of a chain under load.

    Results are exact, in symbols as well, for cells of one bead at any wavenumber, and of two beads
    with equal contacts at ``κ = π``, unless they are `numeric`; elsewhere they are floats, for
    numbers.

    Parameters
    ----------
    cell : Cell
        The periodic cell. Of two masses that are symbols the first one is taken to be the heavier
        one.
    law : ContactLaw, optional
        The contact law, by default a power; under `lwa.general` results hold the symbols K2, K3, K4
        of the force ``K2 δ + K3 δ² + K4 δ³`` on top of the load, for equal contacts.
    k : number or str
        Exponent of the power.
    background : number or str, optional
        The static strain. It may be zero or negative under a law that is no power.
    precompression : number or str, optional
        The static force, in place of a strain.
    wavenumber : number or str
        κ per cell, from 0 to π.
    branch : {"acoustic", "optical"} or int, optional
        The branch, or its number from 0; by default 0 for equal beads, else 1.

    Raises
    ------
    InputError
        For other arguments, and unless ``F′`` is positive at the strain. Results raise it where
        branches touch, at zero frequency, where the mode drives a mode of twice its frequency, and,
        in floats, where the mode moves nearly with sound.

    Examples
    --------
    >>> envelope(Cell(["m"], spacing=1), k=2, background="p0").nonlinearity
    -4*sqrt(2)/(m**(3/2)*p0**(3/2))
    """
    law = for_cell(law, cell, k)
    if (background is None) == (precompression is None):
        raise InputError("background or precompression: one of the two is wanted")
    # The load is a force here, and a strain below.
    if precompression is not None:
        load = positive(precompression, "precompression")
        static = law.compression(cell, load)
    else:
        if law.homogeneous:  # a power only pushes
            load = positive(background, "background")
        else:
            load = signed(background, "background")
        static = cell.spacing * load
        law.check_strain(load, cell)
    kappa = signed(wavenumber, "wavenumber")
    if kappa.is_number and not 0 <= kappa <= sp.pi:
        raise InputError(f"wavenumber is {shorten(kappa)}: 0 … pi per cell is wanted")
    # Called for its refusal of two symbols of one name, such as a mass and a wavenumber q
    by_name({*cell.symbols, *law.symbols, *load.free_symbols, *kappa.free_symbols})
    number = _branch_number(branch, cell)
    # A bead between equal contacts swings alone there; other modes are floats.
    edge = cell.size == 2 and kappa == sp.pi and cell.equal_contacts
    exact = cell.size == 1 or edge
    return Envelope(cell, law, static, kappa, number, floats=not exact)


def _branch_number(branch: Any, cell: Cell) -> int:
    """Read a branch; by default the acoustic one of equal beads, else the lowest optical one."""
    # Breathers of a dimer are those of the gap below its optical branch.
    if branch is None:
        return min(1, cell.size - 1)
    if isinstance(branch, str) and branch in BRANCHES:
        number = BRANCHES.index(branch)
    else:
        number = integer(branch, "branch", 0)
    if number >= cell.size:
        raise InputError(
            f"branch is {shorten(branch)}: a cell of {cell.size} has as many branches, "
            "counted from 0"
        )
    return number
