"""The traveling wave of a chain: closed forms, units, loads, floats and source text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import sympy as sp

from lwa.base.exact import InputError, one_of, read_exact, shorten
from lwa.cell import Cell
from lwa.cell import k as symbol_k
from lwa.law import ContactLaw, for_cell
from lwa.wave.closed import CompactWave
from lwa.wave.physical import BEARERS, PhysicalWave

if TYPE_CHECKING:
    from lwa.loaded.wave import LoadedWave
    from lwa.wave.numeric import NumericWave


class TravelingWave(CompactWave):
    """The compact traveling wave of a chain, with units, loads, floats and source text."""

    @overload
    def at_force(self, F: Any = "F", of: str = "contact") -> PhysicalWave: ...

    @overload
    def at_force(
        self, F: Any = "F", of: str = "contact", *, precompression: Any
    ) -> PhysicalWave | LoadedWave: ...

    def at_force(
        self, F: Any = "F", of: str = "contact", *, precompression: Any = 0
    ) -> PhysicalWave | LoadedWave:
        """The `lwa.PhysicalWave`, or under load the `lwa.LoadedWave`, of a given peak force.

        F : the peak force, a number or a name.
        of : "contact" or "bead", whose force peaks at F.
        precompression : static load. F then is the total force of a contact, static and dynamic,
            and this wave must be the canonical field's, as in `on_background`.

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
        """The wave of this chain whose strain rises from p0 by ``rise``, a symbol B unless given.

        Raises `lwa.InputError` for the wave of another field than the canonical one, whose equation
        has no energy.
        """
        return self._loaded(background=p0, rise=rise)

    def _loaded(self, **ends: Any) -> LoadedWave:
        from lwa.loaded.wave import loaded_wave  # start-up: it loads NumPy

        canonical = CompactWave.canonical(self.cell, self.k)
        if any(sp.cancel(getattr(self, x) - getattr(canonical, x)) != 0 for x in "GHI"):
            raise InputError(
                "waves on a background are those of the canonical field, which conserves momentum "
                'and energy: closure="full" with field="center" (--closure full --field center), '
                "or canonical_wave(cell, k)"
            )
        return loaded_wave(self.cell, k=self.k, **ends)

    def numeric(self, missing: Literal["raise", "nan"] = "raise") -> NumericWave:
        """Vectorised float64 functions of (k, ω), ω = m2/m1; see `lwa.wave.numeric.NumericWave`.

        Raises `lwa.InputError` unless k is a symbol and the masses are two, as in N:1 dimers.
        """
        from lwa.wave.numeric import NumericWave  # start-up: it loads NumPy

        return NumericWave(self, missing)

    def code(self, language: str) -> str:
        """Source text of a program: β, widths, speed, amplitude and profile as functions.

        language : a key of `lwa.wave.source.LANGUAGES`, such as "c" or "numpy".

        Arguments and accuracy are those of `lwa.wave.source`. Raises `lwa.InputError` for another
        language, and for symbols that are no names of variables.
        """
        from lwa.wave.source import TITLE, module, wave_functions  # start-up

        return module([*wave_functions(self).values()], language, TITLE)


def canonical_wave(
    cell: Cell, k: Any = symbol_k, *, law: ContactLaw | None = None
) -> TravelingWave:
    """The wave of the canonical field of any cell, from the linear chain's dispersion alone.

    With Ω² = κ² (1 - I κ² + …) the equation of the canonical field has G = I (k-1)(k-2)/2 and
    H = 2I (k-1) for every cell (theorem, see `lwa.equation.energy`), hence
    β = (k-1)/√(2I k(k+1)) and V² = 2 B^{k-1}/(k(k+1)). It is the wave of
    ``homogenize(cell, closure="full", field="center").pde.traveling_wave()``.

    law : a `lwa.Power` in place of k; raises `lwa.InputError` for other laws.

    >>> canonical_wave(Cell((1, 1)), "3/2").beta
    sqrt(10)/(5*D)
    """
    if law is not None:
        law = for_cell(law, cell, k)
        if not law.homogeneous:
            raise InputError(
                f"law is {law.text}: the compact wave is that of a power law; waves of any law are "
                "those of `lwa.loaded_wave`"
            )
        k = law.exponent
    return TravelingWave.canonical(cell, k)
