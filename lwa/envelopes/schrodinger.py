"""The nonlinear Schrödinger equation i A_T + ½ω″ A_XX = χ |A|²A of a mode of a loaded chain.

u = A(X,T) φ e^{i(κn - ωt)} + c.c., Σ m|φ|² = 1, with the cell n, and κ and X per cell, is the
motion to leading order (`lwa.envelopes.modes`). The load is held, not the length. Equal beads under
A δ^k have χ = -ω (k-1) (k - cos² κ/2)/(m δ0²), δ0 the static compression.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, integer, one_of, positive, root, shorten, signed
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.envelopes.breather import KINDS, Breather
from lwa.envelopes.exact import exact_mode
from lwa.envelopes.modes import Coefficients, NumericMode, numeric_mode
from lwa.law import ContactLaw, for_cell, substituted

BRANCHES = ("acoustic", "optical")
"""Names of the two lowest branches."""

LONG = 400
"""Operations in a result from which on it is not factored."""

SINE, COSINE = sp.symbols("s c", positive=True, cls=sp.Dummy)
"""sin κ/2 and cos κ/2."""


@dataclass(frozen=True, repr=False)
class Envelope(Value):
    """The envelope's equation of one mode (see `envelope`), exact, or `numeric` in floats.

    compression : mean static compression of the contacts.
    branch : 0 is the acoustic branch, 1 the lowest optical one.

    Time and length have the cell's units, frequencies are in radians per unit of time.
    """

    cell: Cell
    law: ContactLaw
    compression: sp.Expr
    wavenumber: sp.Expr
    branch: int
    floats: bool = False

    def __repr__(self) -> str:
        return f"Envelope({self.cell!r}, κ={self.wavenumber}, branch={self.branch})"

    def _repr_latex_(self) -> str:
        names = {
            r"\omega": self.frequency,
            r"\omega''": self.dispersion,
            r"\chi": self.nonlinearity,
        }
        equation = r"i A_{T} + \tfrac{1}{2} \omega'' A_{XX} = \chi |A|^{2} A"
        return latex.display([equation, *(latex.row(name, value) for name, value in names.items())])

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
        """ω of the mode.

        >>> from lwa import Power
        >>> envelope(Cell(["m1", "m2"]), Power("3/2"), precompression=1).frequency
        sqrt(3)/sqrt(m2)
        """
        return self._tidy(self._omega * self._rate)

    @cached_property
    def group_velocity(self) -> sp.Expr:
        """dω/dκ, in cells per unit of time."""
        halves = self._cosine.has(SINE)
        sine = 2 * SINE * COSINE if halves else sp.sin(self.wavenumber)
        return self._tidy(-sine * self._found.slope / self._omega * self._rate)

    @cached_property
    def dispersion(self) -> sp.Expr:
        """ω″ = d²ω/dκ².

        >>> from lwa import Power
        >>> envelope(Cell(["m"], ["K"]), Power(1), background="p0", wavenumber="q").dispersion
        -sqrt(K)*sin(q/2)/(2*sqrt(m))
        """
        square = (1 - self._cosine**2) * self._found.slope**2 / self._omega**2
        return self._tidy((self._found.bend / 2 - square) / self._omega * self._rate)

    @cached_property
    def nonlinearity(self) -> sp.Expr:
        """χ, the rise of the frequency over |A|²."""
        found = self._found.cubic / (2 * self._omega)
        return self._tidy(found * self._rate / (self._action * self._curvatures[3]))

    @cached_property
    def second_harmonic(self) -> tuple[sp.Expr, ...]:
        """Contact → compression at 2ω over A², a factor of e^{2i(κn - ωt)}; cf. `mode`."""
        return tuple(self._tidy(e / self._action) for e in self._found.second)

    @cached_property
    def mean_strain(self) -> tuple[sp.Expr, ...]:
        """Contact → lasting compression over |A|², that of the mean flow included."""
        return tuple(self._tidy(e / self._action) for e in self._found.mean)

    @cached_property
    def mode(self) -> tuple[sp.Expr, ...]:
        """φ of each bead, Σ m|φ|² = 1; positive for the bead with the largest displacement."""
        unit = root(self._found.mode[self._start.reference] * self.cell.masses[0])
        return tuple(self._tidy(value / unit) for value in self._found.mode)

    @cached_property
    def strains(self) -> tuple[sp.Expr, ...]:
        """|d|² of each contact, the square of its compression over |A|²."""
        return tuple(self._tidy(d / self.cell.masses[0]) for d in self._found.size)

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
        """The standing envelope of a frequency, or of the detuning ν = 1 - frequency/ω.

        kind : "bright" or "dark", for symbols that leave it open.

        Raises `lwa.InputError` as `lwa.Breather` does.
        """
        if (frequency is None) == (detuning is None):
            raise InputError("frequency or detuning: one of the two is wanted")
        if kind:
            one_of(kind, KINDS, "kind")
        if detuning is None:
            detuning = 1 - positive(frequency, "frequency") / self.frequency
        if self.group_velocity.is_zero is not True:
            raise InputError(f"wavenumber is {self.wavenumber}: a breather stands where dω/dκ = 0")
        return Breather(
            self.frequency, self.dispersion, self.nonlinearity, self.mode, self.wavenumber,
            self._opening, signed(detuning, "detuning"), kind or self.kind,
        )  # fmt: skip

    @property
    def _opening(self) -> sp.Expr:
        """|A|² at which the alternating compression 2|A||d| of a contact reaches the static one."""
        if not self.law.homogeneous:
            return sp.oo
        pairs = zip(self.static_compressions, self.strains, strict=True)
        found = sp.Min(*(delta**2 / (4 * d) for delta, d in pairs if d))
        return sp.N(found) if self.floats else found

    # --- the chain in units of its first mass and contact ---

    @property
    def static_compressions(self) -> tuple[sp.Expr, ...]:
        """δ0 of each contact."""
        return tuple(c * self.compression for c in self.cell.shares(self.law.exponent))

    @cached_property
    def _curvatures(self) -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]:
        """K2 of the first contact, K3 ℓ/K2 and K4 ℓ²/K2, and the length ℓ."""
        law, delta = self.law, self.static_compressions[0]
        if law.formless:
            K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
            return K2, K3 / K2, K4 / K2, sp.S.One
        stiffness = sp.powsimp(self.cell.stiffnesses[0] * law.at(delta, 1))
        if not delta.is_zero:
            a, b = (law.phi(n).subs(law.delta, delta) for n in (2, 3))
            return stiffness, a / 2, b / 6, delta
        a, b = (law.at(delta, n) / law.at(delta, 1) for n in (2, 3))
        return stiffness, a / 2, b / 6, sp.S.One

    @cached_property
    def _springs(self) -> list[sp.Expr]:
        """K2 of each contact over that of the first one."""
        if len({*self.cell.stiffnesses}) == 1:
            return [sp.S.One] * self.cell.size
        compliances = self.cell.compliances(self.law.exponent)
        return [sp.powsimp(compliances[0] / c) for c in compliances]

    def _rows(self, springs: list[sp.Expr]) -> list[list[sp.Expr]]:
        """Masses, K2, K3 and K4 of the cell over those of its first bead and contact."""
        _, a, b, _ = self._curvatures
        masses = [m / self.cell.masses[0] for m in self.cell.masses]
        return [masses, springs, [a * q**2 for q in springs], [b * q**3 for q in springs]]

    @cached_property
    def _letters(self) -> dict[sp.Expr, sp.Symbol]:
        """Ratios of springs that are no fractions, and the letters that stand for them."""
        return {q: sp.Dummy() for q in self._springs if not q.is_Rational}

    @cached_property
    def _sample(self) -> dict[sp.Symbol, Any]:
        """Values of symbols by which branches are told apart: masses that fall along the cell."""
        cell = self.cell
        found = dict.fromkeys((*self.law.symbols, *self.wavenumber.free_symbols), 1.5)
        for values in (cell.stiffnesses, cell.masses):
            for i, value in enumerate(values):
                found |= dict.fromkeys(value.free_symbols - found.keys(), 1 / (1 + i))
        return found

    @cached_property
    def _free(self) -> set[sp.Symbol]:
        """Symbols without a value, the spacing aside."""
        values = (x for row in (*self._rows(self._springs), [self.wavenumber]) for x in row)
        return set().union(*(value.free_symbols for value in values))

    @cached_property
    def _start(self) -> NumericMode:
        """The mode in floats, at the sample where there are symbols."""
        rows = self._rows(self._springs)
        if self._free:  # K3 and K4 do not matter to the choice of the branch
            rows[2:] = [[sp.S.Zero] * self.cell.size] * 2
        numbers = [[float(x.xreplace(self._sample)) for x in row] for row in rows]
        return numeric_mode(numbers, float(self.wavenumber.xreplace(self._sample)), self.branch)

    @cached_property
    def _found(self) -> Coefficients:
        """Coefficients of the mode, exact or floats."""
        if not self.floats:
            return self._exact[1]
        if self._free:
            raise InputError(f"{min(map(str, self._free))!r} has no value: floats need numbers")
        return self._start.coefficients

    @property
    def _cosine(self) -> sp.Expr:
        cosine = sp.cos(self.wavenumber)
        if self.floats or cosine.is_Rational:
            return cosine
        if self.cell.size > 1:
            raise InputError(
                f"wavenumber is {shorten(self.wavenumber)}: in a cell of {self.cell.size} results "
                "are exact where cos κ is rational (0, π/3, π/2, 2π/3, π); numeric() gives floats"
            )
        return 1 - 2 * SINE**2

    @cached_property
    def _exact(self) -> tuple[sp.Expr, Coefficients]:
        start, sample, phase = self._start, self._sample, sp.exp(sp.I * self.wavenumber)
        sample = sample | {SINE: float(sp.sin(self.wavenumber / 2).xreplace(sample))}
        sample |= {letter: float(q.xreplace(sample)) for q, letter in self._letters.items()}
        rows = self._rows([self._letters.get(q, q) for q in self._springs])
        return exact_mode(rows, self._cosine, phase, start.square, sample, start.reference)

    @property
    def _omega(self) -> sp.Expr:
        """ω over `_rate`."""
        return root(self._exact[0]) if not self.floats else sp.Float(self._start.square) ** 0.5

    @property
    def _rate(self) -> sp.Expr:
        return root(self._curvatures[0] / self.cell.masses[0])

    @property
    def _action(self) -> sp.Expr:
        """Unit of |A|² over that of a compression."""
        return self._curvatures[3] * self.cell.masses[0]

    def _tidy(self, value: sp.Expr) -> sp.Expr:
        if self.floats:
            return sp.N(value)
        back = {SINE: sp.sin(self.wavenumber / 2), COSINE: sp.cos(self.wavenumber / 2)}
        short = sp.count_ops(value) < LONG  # factors of long results take minutes
        found = sp.powsimp(sp.factor(value)) if short else value
        return found.xreplace(back | {letter: q for q, letter in self._letters.items()})


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

    Results are exact for symbols in cells of one or two beads, for cells of numbers whose frequency
    is algebraic, and floats through `numeric` for any cell of numbers.

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
            f"branch is {shorten(branch)}: a cell of {cell.size} has {cell.size} branches"
        )
    return Envelope(cell, law, static, kappa, number)
