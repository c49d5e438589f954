"""The bands of a chain under a static load, in the units of the cell: s⁻¹ and m/s in SI.

About the load F0 contact i is a spring of the constant A_i F′(δ_i), A_i F(δ_i) = F0, for A δ^k
k A_i^{1/k} F0^{(k-1)/k}, and the chain the linear one of these springs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from lwa.base.exact import InputError, positive
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.law import ContactLaw, for_cell
from lwa.linear.dispersion import Dispersion

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array


@dataclass(frozen=True)
class LoadedChain(Value):
    """The linear chain about the static load ``precompression``, the same in all contacts.

    Raises `lwa.InputError` unless the load is positive, and where unlike contacts have a law that
    is no power.

    >>> LoadedChain(Cell(["m"], ["A"]), Power("3/2"), "F0").spring_constants
    (3*A**(2/3)*F0**(1/3)/2,)
    >>> LoadedChain(Cell([1], [1], 1), Power("3/2"), 8).band_edges().round(9)
    array([[0.        , 3.46410162]])
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr

    def __post_init__(self) -> None:
        for_cell(self.law, self.cell)
        load = positive(self.precompression, "precompression")
        object.__setattr__(self, "precompression", load)

    @cached_property
    def static_compressions(self) -> tuple[sp.Expr, ...]:
        """δ_i of each contact under the load."""
        return self.law.compressions(self.cell, self.precompression)

    @cached_property
    def spring_constants(self) -> tuple[sp.Expr, ...]:
        """A_i F′(δ_i)."""
        pairs = zip(self.cell.stiffnesses, self.static_compressions, strict=True)
        return tuple(sp.powsimp(A * self.law.at(delta, 1)) for A, delta in pairs)

    @cached_property
    def springs(self) -> Dispersion:
        """The chain of these springs, Ω(κ) in the theory's units."""
        constants = tuple(sp.nsimplify(K, rational=True) if K.has(sp.Float) else K
                          for K in self.spring_constants)  # fmt: skip
        return Dispersion(Cell(self.cell.masses, constants, self.cell.spacing))

    @cached_property
    def rate(self) -> sp.Expr:
        """ω/Ω, in s⁻¹ where the cell is in SI."""
        springs = self.springs.cell
        return springs.time_scale(1) / springs.spacing

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """dω/dq of long waves."""
        return self.cell.spacing * self.rate

    def branches(self, q: ArrayLike) -> Array:
        """ω_j(q), ascending along a last axis of length P; q is a wavenumber, q D = κ."""
        import numpy as np  # start-up: `import lwa` does not load it

        return self.springs.branches(np.asarray(q) * self._length) * self._rate

    def group_velocity(self, q: ArrayLike) -> Array:
        """dω_j/dq in the order of `branches`."""
        import numpy as np  # start-up: `import lwa` does not load it

        slopes = self.springs.group_velocity(np.asarray(q) * self._length)
        return slopes * (self._rate * self._length)

    def band_edges(self) -> Array:
        """(min, max) of ω of each branch, shape (P, 2)."""
        return self.springs.band_edges() * self._rate

    def gaps(self) -> Array:
        """(from, to) of the intervals of ω between the bands."""
        return self.springs.gaps() * self._rate

    @property
    def _rate(self) -> float:
        return self._float(self.rate)

    @property
    def _length(self) -> float:
        """D; 1 where it is a symbol."""
        D = self.cell.spacing
        return 1.0 if D.is_Symbol else self._float(D)

    def _float(self, value: sp.Expr) -> float:
        if value.free_symbols:
            name = min(map(str, value.free_symbols))
            raise InputError(f"{name!r} has no value: bands under a load are numbers")
        return float(value)
