"""The nonlinear Schrödinger equation i Ψ_T + ½ω″ Ψ_XX = χ |Ψ|²Ψ of a mode of a loaded chain.

To leading order the displacements in cell n are u = Ψ(X,T) U e^{i(κn - ωt)} + c.c.: U is the mode,
Σ m_i |U_i|² = 1 over the beads of a cell, ω its frequency, κ its wavenumber per cell, ω″ = d²ω/dκ²,
X = n - (dω/dκ) t, T = t, and χ the nonlinear coefficient (`lwa.envelopes.modes`). The load is held,
not the length. Equal beads under A δ^k have χ = -ω (k-1) (k - cos² κ/2)/(m δ0²), δ0 the static
compression.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, integer, positive, root, shorten, signed
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.envelopes.breather import KINDS, Breather
from lwa.envelopes.exact import exact_mode
from lwa.envelopes.modes import Contacts, Mode, numeric_mode
from lwa.law import ContactLaw, for_cell, substituted
from lwa.linear.bloch import BRANCHES

K2_ANY, K3_ANY, K4_ANY = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force K2 δ + K3 δ² + K4 δ³ on top of the load, under `lwa.general()`."""

LONG = 400
"""Operations in a result from which on it is not factored: that would take minutes."""


@dataclass(frozen=True, repr=False)
class Envelope(Value):
    """The envelope's equation of one mode (see `envelope`), exact, or `numeric` in floats.

    compression : mean static compression of the contacts.
    branch : 0 is the acoustic branch, 1 the lowest optical one.

    Time and length have the cell's units. Frequencies are in radians per unit of time, for spheres
    in SI in rad/s.
    """

    cell: Cell
    law: ContactLaw
    compression: sp.Expr
    wavenumber: sp.Expr
    branch: int
    floats: bool = False

    def __repr__(self) -> str:
        return f"Envelope({self.cell!r}, κ={self.wavenumber}, branch={self.branch})"

    def latex_rows(self) -> list[str]:
        names = {r"\omega": self.frequency, r"\omega''": self.dispersion}
        equation = r"i \Psi_{T} + \tfrac{1}{2} \omega'' \Psi_{XX} = \chi |\Psi|^{2} \Psi"
        return [equation, *latex.rows(names | {r"\chi": self.nonlinearity})]

    def numeric(self) -> Envelope:
        """Float values of the coefficients, for any cell of numbers and any wavenumber."""
        return replace(self, floats=True)

    def at(self, **values: Any) -> Envelope:
        """The envelope for these values of the named symbols, and of ω = m2/m1 by ``omega``.

        Raises `lwa.InputError` for a name that does not occur or a value that cannot be meant.
        """
        cell, law, compression, wavenumber = substituted(
            values, self.cell, self.law, self.compression, self.wavenumber
        )
        return Envelope(cell, law, compression, wavenumber, self.branch, self.floats)

    # --- coefficients ---

    @cached_property
    def frequency(self) -> sp.Expr:
        """Frequency ω of the mode, in radians per unit of time.

        >>> from lwa import Power
        >>> envelope(Cell(["m1", "m2"]), Power("3/2"), precompression=1).frequency
        sqrt(3)/sqrt(m2)
        """
        square = self._tidy(sp.sympify(self._mode.square) * self._rate)
        return self._tidy(root(square).replace(sp.Abs, lambda x: x))  # sin κ/2 ≥ 0

    @cached_property
    def group_velocity(self) -> sp.Expr:
        """Group velocity dω/dκ, in cells per unit of time."""
        if sp.sin(self.wavenumber).is_zero:  # the edge of a band, in floats as well
            return sp.S.Zero
        return self._tidy(self._mode.slope * self._rate / (2 * self.frequency))

    @cached_property
    def dispersion(self) -> sp.Expr:
        """Dispersion coefficient ω″ = d²ω/dκ².

        >>> from lwa import Power
        >>> envelope(Cell(["m"], ["K"]), Power(1), background="p0", wavenumber="q").dispersion
        -sqrt(K)*sin(q/2)/(2*sqrt(m))
        """
        return self._tidy(self._mode.curvature * self._rate / self.frequency)

    @cached_property
    def nonlinearity(self) -> sp.Expr:
        """Nonlinear coefficient χ: the amplitude Ψ raises the frequency by χ|Ψ|²."""
        found = self._mode.cubic * self._rate / (2 * self.frequency)
        return self._tidy(found / (self._mass * self._length**2))

    @cached_property
    def second_harmonic(self) -> tuple[sp.Expr, ...]:
        """Factor e2 for each contact: its second harmonic is A² e2 e^{2i(κn - ωt)} + c.c."""
        return self._each(self._mode.second, self._mass * self._length)

    @cached_property
    def mean_strain(self) -> tuple[sp.Expr, ...]:
        """Lasting compression of each contact divided by |Ψ|², with the mean flow's part."""
        return self._each(self._mode.mean, self._mass * self._length)

    @cached_property
    def mode(self) -> tuple[sp.Expr, ...]:
        """Mode U, one component per bead; positive for the bead with the largest displacement."""
        return self._each(self._mode.shape, root(self._mass))

    @cached_property
    def strains(self) -> tuple[sp.Expr, ...]:
        """Square |d|² for each contact, whose compression is A d e^{i(κn - ωt)} + c.c. + …."""
        return self._each(self._mode.size, self._mass)

    @property
    def kind(self) -> str:
        """ "bright" or "dark"; raises `lwa.InputError` where symbols leave it open."""
        sign = self.dispersion * self.nonlinearity
        if sign.is_zero:
            raise InputError("the dispersion or the nonlinearity vanishes: no envelope has a shape")
        negative = sp.simplify(sign).is_negative
        if negative is None:
            raise InputError("kind depends on symbols: give numbers")
        return KINDS[0] if negative else KINDS[1]

    def breather(self, frequency: Any = None, *, detuning: Any = None, kind: str = "") -> Breather:
        """The standing envelope of a frequency, or of the detuning Δ = 1 - frequency/ω.

        frequency : in radians per unit of time.
        kind : "bright" or "dark", for symbols that leave the kind open.

        Raises `lwa.InputError` as `lwa.Breather` does.
        """
        if (frequency is None) == (detuning is None):
            raise InputError("frequency or detuning: one of the two is wanted")
        if detuning is None:
            detuning = 1 - positive(frequency, "frequency") / self.frequency
        if self.group_velocity.is_zero is not True:
            raise InputError(f"wavenumber is {self.wavenumber}: a breather stands where dω/dκ = 0")
        return Breather(
            self.frequency, self.dispersion, self.nonlinearity, self.mode, self.wavenumber,
            self._opening, self.load, self.law.exponent if self.law.homogeneous else sp.nan,
            signed(detuning, "detuning"), kind or self.kind,
        )  # fmt: skip

    @property
    def load(self) -> sp.Expr:
        """The static force F0, in the units of the cell."""
        return self.cell.stiffnesses[0] * self.law.at(self.static_compressions[0])

    @property
    def static_compressions(self) -> tuple[sp.Expr, ...]:
        """Static compression δ0 of each contact."""
        return tuple(c * self.compression for c in self.cell.shares(self.law.exponent))

    @property
    def _opening(self) -> sp.Expr:
        """The |Ψ|² at which the compression 2|Ψ||d| of a contact reaches its static δ0."""
        roots = (p for p in self.law.F.atoms(sp.Pow) if p.base == self.law.delta)
        if not self.law.homogeneous and all(p.exp.is_integer for p in roots):  # real at δ < 0
            return sp.oo
        pairs = zip(self.static_compressions, self.strains, strict=True)
        found = sp.Min(*(delta**2 / (4 * d) for delta, d in pairs if d))
        return sp.N(found) if self.floats else found

    # --- the mode, in units of the cell's first bead and contact ---

    @property
    def _mass(self) -> sp.Expr:
        return self.cell.masses[0]

    @property
    def _length(self) -> sp.Expr:
        """The first contact's static compression; 1 without load and for any law."""
        delta = self.static_compressions[0]
        return sp.S.One if self.law.formless or delta.is_zero else delta

    @cached_property
    def _rate(self) -> sp.Expr:
        """Unit of ω²: the first contact's linear stiffness divided by the first bead's mass."""
        K2 = K2_ANY if self.law.formless else self.law.at(self.static_compressions[0], 1)
        return sp.powsimp(self.cell.stiffnesses[0] * K2 / self._mass)

    @cached_property
    def _contacts(self) -> Contacts:
        """Exact masses, compressions and nonlinear coefficients, in the units of the first bead."""
        cell, law, delta = self.cell, self.law, self.static_compressions[0]
        if law.formless:
            s, t = K3_ANY / K2_ANY, K4_ANY / K2_ANY
        elif delta.is_zero:
            s, t = (law.at(delta, n) / law.at(delta, 1) / sp.factorial(n) for n in (2, 3))
        else:
            s, t = (law.phi(n).subs(law.delta, delta) / sp.factorial(n) for n in (2, 3))
        compliances = cell.compliances(law.exponent)
        c = [sp.powsimp(part / compliances[0]) for part in compliances]
        return Contacts(np.array([m / self._mass for m in cell.masses]), np.array(c), s, t)

    def _sampled(self, value: sp.Expr) -> float:
        """Float of the value at sample numbers for its symbols, by which branches are ordered.

        Samples are 1, 1/2, … along the cell, so that the first mass is the heaviest, and 1.5 for
        symbols of neither masses nor stiffnesses.
        """
        symbols = dict.fromkeys(value.free_symbols, 1.5)
        for values in (self.cell.stiffnesses, self.cell.masses):
            for i, part in reversed([*enumerate(values)]):
                symbols |= dict.fromkeys(part.free_symbols, 1 / (1 + i))
        return float(value.xreplace(symbols))

    @cached_property
    def _mode(self) -> Mode:
        """The mode, exact or in floats."""
        contacts, kappa = self._contacts, self.wavenumber
        numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t, kappa)
        if self.floats:
            demand_numbers(set().union(*(x.free_symbols for x in numbers)), "floats need numbers")
        *rows, s, t, number = map(self._sampled, numbers)
        masses, c = np.array(rows).reshape(2, -1)
        sample = Contacts(masses, c, s, t)
        found, bead = numeric_mode(sample, number, self.branch, self.floats)
        if self.floats:
            return found
        return exact_mode(contacts, kappa, self.branch, bead, self._sampled)

    def _each(self, values: Any, unit: sp.Expr) -> tuple[sp.Expr, ...]:
        return tuple(self._tidy(sp.sympify(value) / unit) for value in values)

    def _tidy(self, value: sp.Expr) -> sp.Expr:
        if self.floats:
            return sp.N(value)
        return sp.powsimp(sp.factor(value)) if sp.count_ops(value) < LONG else value


def envelope(
    cell: Cell, law: ContactLaw, *, background: Any = None, precompression: Any = None,
    wavenumber: Any = sp.pi, branch: Any = None,
) -> Envelope:  # fmt: skip
    """The nonlinear Schrödinger equation of a mode of a chain under load.

    Parameters
    ----------
    cell : the periodic cell. Of masses that are symbols the first one is taken to be the heaviest.
    law : the contact law; under `lwa.general()` results hold the symbols K2, K3, K4 of the force
        K2 δ + K3 δ² + K4 δ³ on top of the load, for cells of equal contacts.
    background, precompression : the static strain or the static force, one of the two. A strain
        may be zero or negative under a law that is no power.
    wavenumber : κ per cell, 0 … π.
    branch : "acoustic", "optical" or the number of the branch from 0; by default 0 for equal beads,
        else 1.

    Results are exact for cells of one or two beads, in symbols and at any wavenumber, and for cells
    of numbers where cos κ is rational; they are floats through `numeric` for any cell of numbers.

    Raises `lwa.InputError` for other arguments, where branches touch, at zero frequency, where the
    second harmonic is itself a mode, and at the resonance of a mode that moves with sound,
    c_g = c_0.

    >>> from lwa import Power
    >>> envelope(Cell(["m"], spacing=1), Power(2), background="p0").nonlinearity
    -4*sqrt(2)/(m**(3/2)*p0**(3/2))
    """
    law = for_cell(law, cell)
    if (background is None) == (precompression is None):
        raise InputError("background or precompression: one of the two is wanted")
    if precompression is not None:
        static = law.compression(cell, positive(precompression, "precompression"))
    else:
        read = positive if law.homogeneous else signed  # powers only push
        static = cell.spacing * read(background, "background")
    kappa = signed(wavenumber, "wavenumber")
    if kappa.is_number and not 0 <= kappa <= sp.pi:
        raise InputError(f"wavenumber is {shorten(kappa)}: 0 … pi per cell is wanted")
    if branch is None:
        branch = min(1, cell.size - 1)
    number = BRANCHES.index(branch) if branch in BRANCHES else integer(branch, "branch", 0)
    if number >= cell.size:
        raise InputError(
            f"branch is {shorten(branch)}: a cell of {cell.size} has as many branches, "
            "counted from 0"
        )
    return Envelope(cell, law, static, kappa, number)
