"""Standing envelopes at the edge of a band: bright and dark breathers of a prescribed frequency.

Letters as in `lwa.envelopes.schrodinger`: a mode φ at the edge of a band has the frequency ω and
the envelope Ψ(X,T), i Ψ_T + ½ω″Ψ_XX = χ|Ψ|²Ψ. A breather of the frequency (1 - Δ) ω, Δ the
detuning, in the cells n is Ψ = a f(bn) e^{-iΩT}, Ω = -Δω, with

    bright, ω″χ < 0:   f = sech,   χ a² = 2Ω,   ω″ b² = -2Ω,
    dark,   ω″χ > 0:   f = tanh,   χ a² = Ω,    ω″ b² = Ω,

so that Ω has the sign of χ. A bead is displaced by 2a|φ| at most, and the compression of a contact
differs from its static value δ0 by 2a|d|, d the contact's compression in the mode. Contacts begin
to open at about 2a|d| = δ0, that is at a detuning Δ_o, as a² ∝ Δ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NoReturn

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, one_of, power, root
from lwa.base.frozen import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array

KINDS = ("bright", "dark")
"""Kinds of envelopes: "bright" is localised, ω″χ < 0; "dark" is a dip in a wave train."""

HELD = ("frequency", "amplitude")
"""Quantities of a breather that are held while the load changes."""


@dataclass(frozen=True)
class Breather(Value):
    """The standing envelope of the frequency (1 - Δ) ω (see `lwa.Envelope.breather`).

    edge, dispersion, nonlinearity, mode, wavenumber : ω, ω″, χ, φ and κ of the envelope's equation,
        with frequencies in radians per unit of time.
    opening : |Ψ|² at which contacts begin to open, to leading order; infinite where contacts pull.
    load, k : the static force F0, and the exponent of a power law, NaN for other laws.
    detuning, kind : Δ, and one of `KINDS`.

    Raises `lwa.InputError` for a detuning to the side where there is no such envelope, and for one
    at which contacts open.
    """

    edge: sp.Expr
    dispersion: sp.Expr
    nonlinearity: sp.Expr
    mode: tuple[sp.Expr, ...]
    wavenumber: sp.Expr
    opening: sp.Expr
    load: sp.Expr
    k: sp.Expr
    detuning: sp.Expr
    kind: str

    def __post_init__(self) -> None:
        one_of(self.kind, KINDS, "kind")
        if self.detuning.is_number and self.detuning >= 1:
            self._refuse("a frequency is positive, and the detuning below 1")
        if self._square.is_number and not self._square > 0:
            side, sign = ("below", "> 0") if self.nonlinearity < 0 else ("above", "< 0")
            self._refuse(f"{self.kind} breathers lie {side} f0, at values {sign}")
        part = self.detuning / self.opening_detuning
        if part.is_number and part > 1:
            loads = ""
            if self.k.is_number and (load := self.opening_load("frequency")).is_number:
                loads = f" at every load; this frequency wants a load of at most {float(load):.5g}"
            self._refuse(f"contacts open from {float(self.opening_detuning):.5g} on{loads}")

    def _refuse(self, why: str) -> NoReturn:
        raise InputError(f"detuning 1 - f/f0 is {float(self.detuning):.5g}: {why}")

    def latex_rows(self) -> list[str]:
        shape = r"\operatorname{sech}" if self.kind == KINDS[0] else r"\tanh"
        rows = [rf"|\Psi| = a {shape}(b n)", latex.row("a^{2}", self._square)]
        return [*rows, latex.row("b^{-1}", self.width)]

    @property
    def frequency(self) -> sp.Expr:
        """Frequency (1 - Δ) ω of the breather, in radians per unit of time."""
        return (1 - self.detuning) * self.edge

    @property
    def _shift(self) -> sp.Expr:
        """The ratio χ a²/Δ: 2Ω/Δ for bright, Ω/Δ for dark breathers."""
        return -(2 if self.kind == KINDS[0] else 1) * self.edge

    @cached_property
    def _square(self) -> sp.Expr:
        """Square a² of the envelope's amplitude."""
        return sp.powsimp(sp.factor(self._shift * self.detuning / self.nonlinearity))

    @cached_property
    def amplitude(self) -> tuple[sp.Expr, ...]:
        """Largest displacement 2aφ of each bead, in the cell's units, with the sign of the mode."""
        return tuple(2 * root(self._square) * phi for phi in self.mode)

    @cached_property
    def width(self) -> sp.Expr:
        """Width 1/b, in cells, of the envelope sech(bn) or tanh(bn)."""
        ratio = self.dispersion / (self._shift * self.detuning)
        return root(sp.factor(-ratio if self.kind == KINDS[0] else ratio))

    @cached_property
    def opening_detuning(self) -> sp.Expr:
        """Detuning Δ_o at which contacts begin to open, to leading order; ∞ if contacts pull.

        Under a power law Δ_o is the same at every load. In the lattice contacts open earlier: for
        spheres of mass ratios 0.3 to 0.5 at 0.018 instead of 3/128 = 0.0234.

        >>> from lwa import Cell, Power, envelope
        >>> chain = envelope(Cell([1, "1/2"]), Power("3/2"), precompression=1)
        >>> chain.breather(detuning="1/1000").opening_detuning
        3/128
        """
        return sp.simplify(self.opening * self.nonlinearity / self._shift)

    def opening_load(self, held: str) -> sp.Expr:
        """The static force at which contacts begin to open, ``held`` "frequency" or "amplitude".

        Under F = A δ^k lengths scale as F0^{1/k} and frequencies as F0^{(k-1)/(2k)}, and contacts
        open at the detuning Δ_o whatever the load. A held amplitude keeps a² ∝ Δ F0^{2/k}, and the
        result is F0 (Δ/Δ_o)^{k/2}: contacts open under *smaller* loads. A held frequency keeps
        (1 - Δ) F0^{(k-1)/(2k)}, and the result is F0 ((1-Δ)/(1-Δ_o))^{2k/(k-1)}: contacts open
        under *greater* loads, which lift the band and so increase the detuning and the amplitude.

        NaN for other laws. Raises `lwa.InputError` for another word.
        """
        nu, limit, k = self.detuning, self.opening_detuning, self.k
        if one_of(held, HELD, "held") == "amplitude":
            return self.load * power(nu / limit, k / 2)
        return self.load * power((1 - nu) / (1 - limit), 2 * k / (k - 1))

    def displacements(self, cells: ArrayLike) -> Array:
        """Displacements of the beads at t = 0 to leading order, a row for each cell; in floats."""
        import numpy as np  # start-up: `import lwa` does not load it

        n = np.asarray(cells, float)
        shape = n / float(self.width)
        envelope = 1 / np.cosh(shape) if self.kind == KINDS[0] else np.tanh(shape)
        phase = np.cos(float(self.wavenumber) * n)
        return np.asarray(np.multiply.outer(envelope * phase, np.array(self.amplitude, float)))
