"""The compact traveling wave of the wave equation at the first order of dispersion.

The equation, at ``D^{k+3}``, is::

    u_ττ = u_x^{k-1} u_xx + G u_x^{k-3} u_xx³ + H u_x^{k-2} u_xx u_xxx + I u_x^{k-1} u_4x.

With ``ξ = x - V τ`` the strain ``v = u_ξ`` obeys a third-order equation, whose compact wave is the
arch ``v = B cos^m(βξ)`` (Porter et al. 2008; `lwa.wave.arch`), with::

    β = (k-1) / (2 √(G+H+I)),    V² = B^{k-1} (1 - β² [(H + 3I) m - 2I]).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, read_exact, shorten
from lwa.base.words import LanguageName, one_of
from lwa.cell import Cell, k as symbol_k
from lwa.law import ContactLaw, power_exponent
from lwa.linear.dispersion import Dispersion
from lwa.wave.arch import Arch
from lwa.wave.physical import BEARERS, BearerName, PhysicalWave

if TYPE_CHECKING:
    from lwa.loaded.wave import LoadedWave
    from lwa.wave.numeric import Missing, NumericWave


POWERS_ALONE = (
    "the compact wave in closed form belongs to a power law; `lwa.loaded_wave` has the waves of "
    "any law, on a background or of a force"
)
"""Refusal of other laws."""


@dataclass(frozen=True, repr=False)
class CompactWave(Arch):
    """The compact wave ``v = u_x = B cos^m(βξ)`` of a wave equation, ``ξ = x - V τ``.

    Parameters are those of `lwa.wave.arch.Arch`; `canonical_wave` and `lwa.PDE.traveling_wave` make
    such waves.
    """

    def __repr__(self) -> str:
        return f"CompactWave({self.cell!r}, k={self.k}, β={shorten(self.beta)})"

    def latex_rows(self) -> list[str]:
        arch = rf"\cos^{{{latex.expression(self.m)}}}(\beta \xi)"
        wave = rf"v = u_{{x}} = B {arch}, \quad |\xi| \leq \frac{{\pi}}{{2\beta}}"
        values = {
            r"\beta": self.beta,
            r"\frac{\pi}{\beta}": self.width,
            latex.fwhm("strain"): self.fwhm("strain"),
            latex.fwhm("force"): self.fwhm("force"),
            "V_{s}": self.speed(),
        }
        return [wave, *latex.rows(values)]

    @overload
    def at_force(self, F: Any = "F", of: BearerName = "contact") -> PhysicalWave: ...

    @overload
    def at_force(
        self, F: Any = "F", of: BearerName = "contact", *, precompression: Any
    ) -> PhysicalWave | LoadedWave: ...

    def at_force(
        self, F: Any = "F", of: BearerName = "contact", *, precompression: Any = 0
    ) -> PhysicalWave | LoadedWave:
        """The wave of a given peak force: a `PhysicalWave`, or under load a `LoadedWave`.

        Parameters
        ----------
        F : number or str
            The peak force, or its name; under load the total force, static and dynamic.
        of : {"contact", "bead"}
            The bearer of this force; under load a contact.
        precompression : number or str
            Static load. This wave must then be the canonical field's, as in `on_background`.

        Examples
        --------
        A formula of the symbol F takes arrays once it is compiled:

        >>> speed = canonical_wave(Cell([1], spacing=1), "3/2").at_force("F").speed
        >>> import numpy as np
        >>> sp.lambdify("F", speed)(np.array([1.0, 64.0])).round(8)
        array([0.89442719, 1.78885438])
        """
        load = read_exact(precompression, "precompression")
        if load.is_zero:
            return PhysicalWave(self, F, of)
        if one_of(of, BEARERS, "of") != "contact":
            raise InputError(
                f"of is {shorten(of)}: under a load it is the force of a contact"
            )
        return self._loaded(force=F, precompression=load)

    def on_background(self, p0: Any = "p0", rise: Any = None) -> LoadedWave:
        """The wave of this chain whose strain rises from p0 by ``rise``, by default a symbol B.

        Raises
        ------
        InputError
            For the wave of another field than the canonical one, whose equation has no energy.
        """
        return self._loaded(background=p0, rise=rise)

    def _loaded(self, **states: Any) -> LoadedWave:
        """The wave between two static states, of the canonical field alone."""
        from lwa.loaded.wave import loaded_wave  # start-up: it loads NumPy

        canonical = canonical_wave(self.cell, self.k)
        # Equal coefficients may be written in different ways: the difference decides.
        for name in ("G", "H", "I"):
            difference = getattr(self, name) - getattr(canonical, name)
            if sp.cancel(difference) != 0:
                raise InputError(
                    "waves on a background are those of the canonical field, which conserves "
                    "momentum and energy; canonical_wave(cell, k) is such a wave",
                    closure="full",
                    field="center",
                )
        return loaded_wave(self.cell, k=self.k, **states)

    def numeric(self, missing: Missing = "raise") -> NumericWave:
        """Vectorised float64 functions of (k, ω), ``ω = m2/m1``.

        Parameters
        ----------
        missing : {"raise", "nan"}
            Result where there is no wave: an error, or NaN; see `lwa.wave.numeric.NumericWave`.

        Raises
        ------
        InputError
            Unless k is a symbol and the masses are two symbols, as in N:1 dimers.
        """
        from lwa.wave.numeric import NumericWave  # start-up: it loads NumPy

        return NumericWave(self, missing)

    def code(self, language: LanguageName) -> str:
        """Source text of a program: β, widths, speed, amplitude and profile as functions.

        Arguments and accuracy of the functions are those of `lwa.wave.source`.

        Parameters
        ----------
        language : {"numpy", "c", "javascript"}
            A key of `lwa.wave.source.LANGUAGES`.

        Raises
        ------
        InputError
            For another language, and for symbols that are no names of variables.
        """
        from lwa.wave.source import TITLE, module, wave_functions  # start-up

        functions = wave_functions(self)
        return module([*functions.values()], language, TITLE)


def canonical_wave(
    cell: Cell, k: Any = symbol_k, *, law: ContactLaw | None = None
) -> CompactWave:
    """The wave of the canonical field of any cell, from the linear chain's dispersion alone.

    With ``Ω² = κ² (1 - (I/D²) κ² + …)`` the equation of the canonical field has
    ``G = I (k-1)(k-2)/2`` and ``H = 2I (k-1)`` for every cell (theorem, see `lwa.equation.energy`),
    hence ``β = (k-1)/√(2I k(k+1))`` and ``V² = 2 B^{k-1}/(k(k+1))``. The wave is that of
    ``homogenize(cell, closure="full", field="center").pde.traveling_wave()``.

    Parameters
    ----------
    cell : Cell
        The chain.
    k : number or str
        Exponent of the contact law.
    law : Power, optional
        The contact law in place of its exponent.

    Raises
    ------
    InputError
        For a law that is no power.

    Examples
    --------
    >>> canonical_wave(Cell((1, 1)), "3/2").beta
    sqrt(10)/(5*D)
    """
    k = power_exponent(law, cell, k, POWERS_ALONE)
    # Masses and contacts enter by I alone.
    I = Dispersion(cell, k).I
    G = I * (k - 1) * (k - 2) / 2
    H = 2 * I * (k - 1)
    return CompactWave(cell, k, G, H, I)
