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

from lwa.base import latex
from lwa.base.exact import InputError, one_of, root
from lwa.base.frozen import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array

KINDS = ("bright", "dark")
"""An envelope that is localised, ω″χ < 0, and a dip in a wave train."""


@dataclass(frozen=True)
class Breather(Value):
    """The standing envelope of the frequency (1 - ν) ω (see `lwa.Envelope.breather`).

    edge, dispersion, nonlinearity, mode, wavenumber : ω, ω″, χ, φ and κ of the envelope's equation.
    opening : |A|² at which contacts begin to open, to leading order; infinite where contacts pull.
    detuning, kind : ν, and one of `KINDS`.

    Raises `lwa.InputError` for a detuning to the side where there is no such envelope, and for one
    at which contacts open.
    """

    edge: sp.Expr
    dispersion: sp.Expr
    nonlinearity: sp.Expr
    mode: tuple[sp.Expr, ...]
    wavenumber: sp.Expr
    opening: sp.Expr
    detuning: sp.Expr
    kind: str

    def __post_init__(self) -> None:
        one_of(self.kind, KINDS, "kind")
        given = f"frequency is {sp.N(self.frequency, 8)}"
        if self._square.is_number and not self._square > 0:
            side = "below" if self.nonlinearity < 0 else "above"
            raise InputError(f"{given}: {self.kind} breathers lie {side} {sp.N(self.edge, 8)}")
        part = self.detuning / self.opening_detuning
        if part.is_number and part > 1:
            end = (1 - self.opening_detuning) * self.edge
            raise InputError(
                f"{given}: contacts open from {sp.N(end, 8)} on, a detuning of "
                f"{sp.N(self.opening_detuning, 5)}"
            )

    def _repr_latex_(self) -> str:
        shape = r"\operatorname{sech}" if self.kind == KINDS[0] else r"\tanh"
        rows = [rf"|A| = a {shape}(b n)", latex.row("a^{2}", self._square)]
        return latex.display([*rows, latex.row("b^{-1}", self.width)])

    @property
    def frequency(self) -> sp.Expr:
        """(1 - ν) ω."""
        return (1 - self.detuning) * self.edge

    @property
    def _shift(self) -> sp.Expr:
        """2Ω of bright, Ω of dark breathers, over ν."""
        return -(2 if self.kind == KINDS[0] else 1) * self.edge

    @cached_property
    def _square(self) -> sp.Expr:
        """a², the largest |A|²."""
        return sp.powsimp(sp.factor(self._shift * self.detuning / self.nonlinearity))

    @cached_property
    def amplitude(self) -> tuple[sp.Expr, ...]:
        """Largest displacement 2aφ of each bead of a cell, with the sign of the mode."""
        return tuple(2 * root(self._square) * phi for phi in self.mode)

    @cached_property
    def width(self) -> sp.Expr:
        """1/b in cells, of sech(bn) or tanh(bn)."""
        ratio = self.dispersion / (self._shift * self.detuning)
        return root(sp.factor(-ratio if self.kind == KINDS[0] else ratio))

    @cached_property
    def opening_detuning(self) -> sp.Expr:
        """The detuning at which contacts begin to open; infinite where contacts pull.

        >>> from lwa import Cell, Power, envelope
        >>> chain = envelope(Cell([1, "1/2"]), Power("3/2"), precompression=1)
        >>> chain.breather(detuning="1/1000").opening_detuning
        3/128
        """
        return sp.simplify(self.opening * self.nonlinearity / self._shift)

    def displacements(self, cells: ArrayLike) -> Array:
        """Displacements of the beads at t = 0 to leading order, a row for each cell; in floats."""
        import numpy as np  # start-up: `import lwa` does not load it

        n = np.asarray(cells, float)
        shape = n / float(self.width)
        envelope = 1 / np.cosh(shape) if self.kind == KINDS[0] else np.tanh(shape)
        phase = np.cos(float(self.wavenumber) * n)
        return np.asarray(np.multiply.outer(envelope * phase, np.array(self.amplitude, float)))
