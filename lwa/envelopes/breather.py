"""Standing envelopes at the edge of a band: bright and dark breathers of a prescribed frequency.

With A = a f(bn) e^{-iΩT}, Ω = -νω the distance from the band's edge, i A_T + ½ω″A_XX = χ|A|²A has

    bright, ω″χ < 0:   f = sech,   χ a² = 2Ω,   ω″ b² = -2Ω,
    dark,   ω″χ > 0:   f = tanh,   χ a² = Ω,    ω″ b² = Ω,

so that Ω has the sign of χ. A bead moves by 2a|φ| at most, and a contact by 2a|d| about its static
compression δ0: contacts begin to open about 2a|d| = δ0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from lwa.base.exact import InputError, root
from lwa.base.frozen import Value
from lwa.envelopes.schrodinger import KINDS, Envelope

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array


@dataclass(frozen=True)
class Breather(Value):
    """The standing envelope of the frequency (1 - ν) ω, ν the detuning.

    Raises `lwa.InputError` unless the mode stands (its group velocity is zero), for a detuning to
    the side where there is no such envelope, and, under a power law, where contacts open.
    """

    envelope: Envelope
    detuning: sp.Expr
    kind: str

    def __post_init__(self) -> None:
        mode = self.envelope
        if mode.group_velocity.is_zero is not True:
            raise InputError(f"wavenumber is {mode.wavenumber}: a breather stands where ω′ = 0")
        if self._square.is_number and not self._square > 0:
            side = "below" if mode.nonlinearity < 0 else "above"
            raise InputError(
                f"frequency is {sp.N(self.frequency, 8)}: {self.kind} breathers lie {side} "
                f"{sp.N(mode.frequency, 8)}"
            )
        part = self.detuning / self.opening_detuning
        if part.is_number and part > 1:
            end = (1 - self.opening_detuning) * mode.frequency
            raise InputError(
                f"frequency is {sp.N(self.frequency, 8)}: contacts open from {sp.N(end, 8)} on, a "
                f"detuning of {sp.N(self.opening_detuning, 5)}"
            )

    @property
    def frequency(self) -> sp.Expr:
        """(1 - ν) ω."""
        return (1 - self.detuning) * self.envelope.frequency

    @property
    def _shift(self) -> sp.Expr:
        """2Ω of bright, Ω of dark breathers, over ν."""
        return -(2 if self.kind == KINDS[0] else 1) * self.envelope.frequency

    @cached_property
    def _square(self) -> sp.Expr:
        """a², the largest |A|²."""
        return sp.powsimp(sp.factor(self._shift * self.detuning / self.envelope.nonlinearity))

    @cached_property
    def amplitude(self) -> tuple[sp.Expr, ...]:
        """Largest displacement 2aφ of each bead of a cell, with the sign of the mode."""
        return tuple(2 * root(self._square) * phi for phi in self.envelope.mode)

    @cached_property
    def width(self) -> sp.Expr:
        """1/b in cells, of sech(bn) or tanh(bn)."""
        ratio = self.envelope.dispersion / (self._shift * self.detuning)
        return root(sp.factor(-ratio if self.kind == KINDS[0] else ratio))

    @cached_property
    def opening_detuning(self) -> sp.Expr:
        """The detuning at which contacts begin to open, to leading order; under a power law only.

        >>> from lwa import Cell, Power
        >>> from lwa import envelope
        >>> e = envelope(Cell([1, "1/2"]), Power("3/2"), precompression=1)
        >>> e.breather(detuning="1/1000").opening_detuning
        3/128
        """
        mode = self.envelope
        if not mode.law.homogeneous:
            return sp.oo * sp.sign(self.detuning)
        pairs = zip(mode.static_compressions, mode.strains, strict=True)
        squares = (delta**2 / (4 * d) for delta, d in pairs if d)
        return sp.simplify(sp.Min(*squares) * mode.nonlinearity / self._shift)

    @property
    def opening_load(self) -> sp.Expr:
        """The static force at which contacts open at this frequency, ω ∝ F0^{(k-1)/(2k)}."""
        law, cell = self.envelope.law, self.envelope.cell
        if not law.homogeneous:
            raise InputError("contacts open under a power law only")
        ratio = (1 - self.detuning) / (1 - self.opening_detuning)
        load = cell.stiffness(law.exponent) * self.envelope.compression**law.exponent
        return load * ratio ** (2 * law.exponent / (law.exponent - 1))

    def displacements(self, cells: ArrayLike) -> Array:
        """Displacements of the beads at t = 0 to leading order, a row for each cell; in floats."""
        import numpy as np  # start-up: `import lwa` does not load it

        n = np.asarray(cells, float)
        shape = n / float(self.width)
        envelope = 1 / np.cosh(shape) if self.kind == KINDS[0] else np.tanh(shape)
        phase = np.cos(float(self.envelope.wavenumber) * n)
        return np.asarray(np.multiply.outer(envelope * phase, np.array(self.amplitude, float)))
