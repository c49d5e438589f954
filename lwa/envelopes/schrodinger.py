"""The nonlinear Schrödinger equation i Ψ_T + ½ω″ Ψ_XX = χ |Ψ|²Ψ of a mode of a loaded chain.

To leading order the displacements in cell n are u = Ψ(X,T) U e^{i(κn - ωt)} + c.c.: U is the mode,
Σ m_i |U_i|² = 1 over the beads of a cell, ω its frequency, κ its wavenumber per cell, ω″ = d²ω/dκ²,
X = n - (dω/dκ) t, T = t, and χ the nonlinear coefficient (`lwa.envelopes.response`). The load is
held, not the length. Equal beads under A δ^k have χ = -ω (k-1) (k - cos² κ/2)/(m δ0²), δ0 the
static compression.

At the edge of a band, dω/dκ = 0, envelopes stand. Such a breather of the frequency (1 - Δ) ω, Δ the
detuning, is Ψ = a f(bn) e^{-iΩT}, Ω = -Δω, with

    bright, ω″χ < 0:   f = sech,   χ a² = 2Ω,   ω″ b² = -2Ω,
    dark,   ω″χ > 0:   f = tanh,   χ a² = Ω,    ω″ b² = Ω,

so that Ω has the sign of χ. A bead is displaced by 2a|U| at most, and the compression of a contact
differs from its static value δ0 by 2a|d|, d the contact's compression in the mode. Contacts begin
to open at about 2a|d| = δ0, that is at a detuning Δ_o, as a² ∝ Δ.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NoReturn

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.algebra.model import BRANCHES
from lwa.base import latex
from lwa.base.arrays import Array
from lwa.base.exact import InputError, integer, one_of, positive, shorten, signed
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.cell import k as symbol_k
from lwa.envelopes.modes import cell_mode
from lwa.envelopes.response import Mode
from lwa.law import ContactLaw, for_cell, substituted

LONG = 400  # operations in a result that from there on would take minutes to factor
# Greatest q of powers x^{p/q} that are factored, as polynomials in x^{1/q}: a decimal k such as
# 3.1185 makes polynomials of thousands of terms.
FINE = 100

KINDS = ("bright", "dark")  # localised, ω″χ < 0, or a dip in a wave train


@dataclass(frozen=True, repr=False)
class Envelope(Value):
    """The envelope's equation of one mode (see `envelope`), exact, or `numeric` in floats.

    compression : mean static compression of the contacts.
    branch : 0 is the acoustic branch, 1 the lowest optical one.

    Units are those of the cell; frequencies are in radians per unit of time.
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
        equation = (
            r"i \Psi_{T} + \tfrac{1}{2} \omega'' \Psi_{XX} = \chi |\Psi|^{2} \Psi"
        )
        return [equation, *latex.rows(names | {r"\chi": self.nonlinearity})]

    def numeric(self) -> Envelope:
        """Float values of the coefficients, for any cell of numbers and any wavenumber."""
        return replace(self, floats=True)

    def at(self, **values: Any) -> Envelope:
        """The envelope for these values of the named symbols, and of ω = m2/m1 by ``omega``."""
        cell, law, compression, wavenumber = substituted(
            values, self.cell, self.law, self.compression, self.wavenumber
        )
        return Envelope(cell, law, compression, wavenumber, self.branch, self.floats)

    # --- coefficients ---

    @cached_property
    def frequency(self) -> sp.Expr:
        """Frequency ω of the mode, in radians per unit of time."""
        square = self._tidy(self._mode.square)
        return self._tidy(sp.sqrt(square).replace(sp.Abs, lambda x: x))  # sin κ/2 ≥ 0

    @cached_property
    def group_velocity(self) -> sp.Expr:
        """Group velocity dω/dκ, in cells per unit of time."""
        if sp.sin(self.wavenumber).is_zero:  # the edge of a band, in floats as well
            return sp.S.Zero
        return self._tidy(self._mode.slope / (2 * self.frequency))

    @cached_property
    def dispersion(self) -> sp.Expr:
        """Dispersion coefficient ω″ = d²ω/dκ².

        >>> envelope(Cell(["m"], ["K"]), k=1, background="p0", wavenumber="q").dispersion
        -sqrt(K)*sin(q/2)/(2*sqrt(m))
        """
        return self._tidy(self._mode.curvature / self.frequency)

    @cached_property
    def nonlinearity(self) -> sp.Expr:
        """Nonlinear coefficient χ: the amplitude Ψ raises the frequency by χ|Ψ|²."""
        return self._tidy(self._mode.cubic / (2 * self.frequency))

    @cached_property
    def mean_strain(self) -> tuple[sp.Expr, ...]:
        """Lasting compression of each contact divided by |Ψ|², with the mean flow's part."""
        return self._each(self._mode.mean)

    @cached_property
    def mode(self) -> tuple[sp.Expr, ...]:
        """Mode U, one component per bead; positive for the bead with the largest displacement."""
        return self._each(self._mode.shape)

    @cached_property
    def strains(self) -> tuple[sp.Expr, ...]:
        """Square |d|² for each contact, whose compression is A d e^{i(κn - ωt)} + c.c. + …."""
        return self._each(self._mode.size)

    @property
    def kind(self) -> str:
        """ "bright" or "dark"; raises `lwa.InputError` where symbols leave it open."""
        sign = self.dispersion * self.nonlinearity
        if sign.is_zero:
            raise InputError(
                "the dispersion or the nonlinearity vanishes: no envelope has a shape"
            )
        negative = (sp.simplify(sign) if _short(sign) else sign).is_negative
        if negative is None:
            raise InputError("kind depends on symbols: give numbers")
        return KINDS[0] if negative else KINDS[1]

    def breather(
        self, frequency: Any = None, *, detuning: Any = None, kind: str = ""
    ) -> Breather:
        """The standing envelope of a frequency, or of the detuning Δ = 1 - frequency/ω.

        frequency : in radians per unit of time.
        kind : "bright" or "dark", for symbols that leave the kind open. Errors are `Breather`'s.
        """
        if (frequency is None) == (detuning is None):
            raise InputError("frequency or detuning: one of the two is wanted")
        if detuning is None:
            detuning = 1 - positive(frequency, "frequency") / self.frequency
        if self.group_velocity.is_zero is not True:
            raise InputError(
                f"wavenumber is {self.wavenumber}: a breather stands where dω/dκ = 0"
            )
        return Breather(self, signed(detuning, "detuning"), kind or self.kind)

    @property
    def load(self) -> sp.Expr:
        """The static force F0, in the units of the cell."""
        return self.cell.stiffnesses[0] * self.law.at(self.static_compressions[0])

    @property
    def static_compressions(self) -> tuple[sp.Expr, ...]:
        """Static compression δ0 of each contact."""
        return tuple(c * self.compression for c in self.cell.shares(self.law.exponent))

    @property
    def opening(self) -> sp.Expr:
        """The |Ψ|² at which a contact's compression 2|Ψ||d| reaches δ0; ∞ if contacts pull."""
        roots = (p for p in self.law.F.atoms(sp.Pow) if p.base == self.law.delta)
        if not self.law.homogeneous and all(
            p.exp.is_integer for p in roots
        ):  # real at δ < 0
            return sp.oo
        pairs = zip(self.static_compressions, self.strains, strict=True)
        smallest = sp.Min(*(delta**2 / (4 * d) for delta, d in pairs if d))
        return sp.N(smallest) if self.floats else smallest

    @cached_property
    def _mode(self) -> Mode:
        """The Bloch mode and its nonlinear response, exact or in floats."""
        return cell_mode(
            self.cell,
            self.law,
            self.compression,
            self.wavenumber,
            self.branch,
            self.floats,
        )

    def _each(self, values: Any) -> tuple[sp.Expr, ...]:
        return tuple(self._tidy(value) for value in values)

    def _tidy(self, value: sp.Expr) -> sp.Expr:
        if self.floats:
            return sp.N(value)
        return sp.powsimp(sp.factor(value)) if _short(value) else value


def _short(value: sp.Expr) -> bool:
    """Return True for an expression that is factored within seconds."""
    roots = (power.exp.q for power in value.atoms(sp.Pow) if power.exp.is_Rational)
    return bool(sp.count_ops(value) < LONG and max(roots, default=1) <= FINE)


@dataclass(frozen=True)
class Breather(Value):
    """The standing envelope of the frequency (1 - Δ) ω (see `lwa.Envelope.breather`).

    envelope : the equation, of frequency ω. detuning, kind : Δ, and one of `KINDS`.

    Raises `lwa.InputError` for a detuning to the side where there is no such envelope, and for one
    at which contacts open.
    """

    envelope: Envelope
    detuning: sp.Expr
    kind: str

    def __post_init__(self) -> None:
        one_of(self.kind, KINDS, "kind")
        if self.detuning.is_number and self.detuning >= 1:
            self._refuse("a frequency is positive, and the detuning below 1")
        if self._square.is_positive is False:
            below = self.envelope.nonlinearity.is_negative
            side, sign = ("below", "> 0") if below else ("above", "< 0")
            self._refuse(f"{self.kind} breathers lie {side} f0, at values {sign}")
        part = self.detuning / self.opening_detuning
        if part.is_number and part > 1:
            self._refuse(f"contacts open from {float(self.opening_detuning):.5g} on")

    def _refuse(self, why: str) -> NoReturn:
        raise InputError(
            f"detuning 1 - f/f0 is {sp.sstr(sp.N(self.detuning, 5), full_prec=False)}: {why}"
        )

    def latex_rows(self) -> list[str]:
        shape = r"\operatorname{sech}" if self.kind == KINDS[0] else r"\tanh"
        rows = [rf"|\Psi| = a {shape}(b n)", latex.row("a^{2}", self._square)]
        return [*rows, latex.row("b^{-1}", self.width)]

    @property
    def frequency(self) -> sp.Expr:
        """Frequency (1 - Δ) ω of the breather, in radians per unit of time."""
        return (1 - self.detuning) * self.envelope.frequency

    @property
    def _shift(self) -> sp.Expr:
        """The ratio χ a²/Δ: 2Ω/Δ for bright, Ω/Δ for dark breathers."""
        return -(2 if self.kind == KINDS[0] else 1) * self.envelope.frequency

    @cached_property
    def _square(self) -> sp.Expr:
        """Square a² of the envelope's amplitude."""
        return sp.powsimp(
            self._factored(self._shift * self.detuning / self.envelope.nonlinearity)
        )

    def _factored(self, value: sp.Expr) -> sp.Expr:
        """The value with its factors, unless SymPy would take minutes, as where Δ is a surd."""
        return (
            sp.factor(value)
            if _short(value) and not self.detuning.is_irrational
            else value
        )

    @cached_property
    def amplitude(self) -> tuple[sp.Expr, ...]:
        """Largest displacement 2aU of each bead, in the cell's units, with the sign of the mode."""
        return tuple(2 * sp.sqrt(self._square) * U for U in self.envelope.mode)

    @cached_property
    def width(self) -> sp.Expr:
        """Width 1/b, in cells, of the envelope sech(bn) or tanh(bn)."""
        ratio = self.envelope.dispersion / (self._shift * self.detuning)
        return sp.sqrt(self._factored(-ratio if self.kind == KINDS[0] else ratio))

    @cached_property
    def opening_detuning(self) -> sp.Expr:
        """Detuning Δ_o at which contacts begin to open, to leading order; ∞ if contacts pull.

        Under a power law Δ_o is the same at every load. In the lattice contacts open earlier: for
        spheres of mass ratios 0.3 to 0.5 at 0.018 instead of 3/128 = 0.0234.
        """
        return sp.simplify(
            self.envelope.opening * self.envelope.nonlinearity / self._shift
        )

    def displacements(self, cells: ArrayLike) -> Array:
        """Displacements of the beads at t = 0 to leading order, a row for each cell; in floats."""
        n = np.asarray(cells, float)
        shape = n / float(self.width)
        profile = 1 / np.cosh(shape) if self.kind == KINDS[0] else np.tanh(shape)
        phase = np.cos(float(self.envelope.wavenumber) * n)
        return np.asarray(
            np.multiply.outer(profile * phase, np.array(self.amplitude, float))
        )


def envelope(
    cell: Cell,
    *,
    law: ContactLaw | None = None,
    k: Any = symbol_k,
    background: Any = None,
    precompression: Any = None,
    wavenumber: Any = sp.pi,
    branch: Any = None,
) -> Envelope:
    """The nonlinear Schrödinger equation of a mode of a chain under load.

    Parameters
    ----------
    cell : the periodic cell. Of masses that are symbols the first one is taken to be the heaviest.
    law, k : the contact law, δ^k unless given; under `lwa.general()` results hold the symbols
        K2, K3, K4 of the force K2 δ + K3 δ² + K4 δ³ on top of the load, for equal contacts.
    background, precompression : the static strain or the static force, one of the two. A strain
        may be zero or negative under a law that is no power.
    wavenumber : κ per cell, 0 … π.
    branch : "acoustic", "optical" or the number of the branch from 0; by default 0 for equal beads,
        else 1.

    Results are exact for cells of one bead at any wavenumber and of two beads at κ = 0 and π, in
    symbols as well, unless they are `numeric`; elsewhere they are floats, for numbers.

    Raises `lwa.InputError` for other arguments, and unless F′ > 0 at the strain. Results raise it
    where branches touch, at zero frequency, where the mode drives a mode of twice its frequency,
    and, in floats, where the mode moves nearly with sound.

    >>> envelope(Cell(["m"], spacing=1), k=2, background="p0").nonlinearity
    -4*sqrt(2)/(m**(3/2)*p0**(3/2))
    """
    law = for_cell(law, cell, k)
    if (background is None) == (precompression is None):
        raise InputError("background or precompression: one of the two is wanted")
    if precompression is not None:
        static = law.compression(cell, positive(precompression, "precompression"))
    else:
        read = positive if law.homogeneous else signed  # powers only push
        static = cell.spacing * read(background, "background")
        law.check_strain(static / cell.spacing, cell)
    kappa = signed(wavenumber, "wavenumber")
    if kappa.is_number and not 0 <= kappa <= sp.pi:
        raise InputError(f"wavenumber is {shorten(kappa)}: 0 … pi per cell is wanted")
    if branch is None:
        branch = min(1, cell.size - 1)
    named = isinstance(branch, str) and branch in BRANCHES
    number = BRANCHES.index(branch) if named else integer(branch, "branch", 0)
    if number >= cell.size:
        raise InputError(
            f"branch is {shorten(branch)}: a cell of {cell.size} has as many branches, "
            "counted from 0"
        )
    edge = cell.size == 2 and kappa in (sp.S.Zero, sp.pi)
    return Envelope(
        cell, law, static, kappa, number, floats=not (cell.size == 1 or edge)
    )
