"""Base classes of results, a number with a bound of its error, and the quantities of a wave."""

from __future__ import annotations

import math
from dataclasses import Field, dataclass, fields, replace
from typing import Any, ClassVar, Self

import sympy as sp

from lwa.base import NoSolitaryWave as NoSolitaryWave
from lwa.base import latex
from lwa.base.exact import one_of

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

FALL = sp.Symbol("B", negative=True)
"""B of a wave of lower strain, in a chain that softens."""

SPEED = sp.Symbol("V_s", positive=True)
"""V_s = dx/dτ, the speed of a wave, unless the caller gives another."""

QUANTITIES = ("strain", "force", "velocity")
"""The quantities of a wave that have a width."""

EXTENTS = ("length", "time")
"""The kinds of a width: an extent in space, or the time of passage."""


def strain_power(quantity: str, k: Any) -> Any:
    """The exponent q of a quantity that scales as strain^q: k for the force, else 1.

    Raises `lwa.InputError` unless the quantity is among `QUANTITIES`.
    """
    return k if known_quantity(quantity) == "force" else 1


def known_quantity(quantity: str) -> str:
    """Return the quantity; raise `lwa.InputError` unless it is among `QUANTITIES`."""
    return one_of(quantity, QUANTITIES, "quantity")


def known_extent(extent: str) -> str:
    """Return the extent; raise `lwa.InputError` unless it is among `EXTENTS`."""
    return one_of(extent, EXTENTS, "extent")


class Shown:
    """Base of results that notebooks and `sympy.latex` show by the rows of `latex_rows`."""

    def latex_rows(self) -> list[str]:
        """LaTeX of the value in rows such as ``I = …``; if empty, a notebook shows the repr."""
        return []

    def _repr_latex_(self) -> str | None:
        rows = self.latex_rows()
        return latex.display(rows) if rows else None

    def _latex(self, printer: Any) -> str:  # SymPy's name: `sympy.latex` calls it
        return (self._repr_latex_() or str(self)).strip("$")


class Value(Shown):
    """Base of frozen dataclasses: equality, hash and pickle go by the fields alone.

    Pickles and copies leave out cached properties.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}


@dataclass(frozen=True)
class Estimate(Value):
    """A value and a bound or an estimate of its absolute error, NaN if unknown."""

    value: float
    error: float

    @classmethod
    def against(cls, value: float, rough: float) -> Self:
        """Return a value whose error is the difference from a less accurate value."""
        return cls(value, abs(value - rough))

    @property
    def relative_error(self) -> float:
        """The error over the value."""
        return self.error / abs(self.value)

    def __str__(self) -> str:
        """The value to the digits that its error leaves, six at most; ± covers those left out.

        >>> print(Estimate(4859925635.0, 99925635.0))
        4.86e+09 ± 1e+08
        """
        short = f"{self.value:.6g}"
        if not self.value or not self.error < math.inf:
            return f"{short} ± {self.error:.0e}"
        if not self.error and float(short) == self.value:
            return f"{short} ± 0"
        # Powers of ten of the first digit and of the last that is shown
        first = math.floor(math.log10(abs(self.value)))
        last = first - 5 if not self.error else math.floor(math.log10(self.error))
        last = min(max(last, first - 5), first)
        error = self.error if self.error >= 10.0**last / 2 else 10.0**last
        if last > 4 or not -12 < first < 16:
            return f"{self.value:.{first - last}e} ± {error:.0e}"
        return f"{round(self.value, -last):.{max(0, -last)}f} ± {error:.0e}"

    def __mul__(self, factor: float) -> Self:
        return replace(self, value=factor * self.value, error=abs(factor) * self.error)

    def __truediv__(self, other: Estimate) -> Self:
        """The quotient, with the sum of the relative errors."""
        return (self * (1 / other.value)).widened(other.error / other.value)

    def widened(self, relative: float) -> Self:
        """Return an estimate of this value with a further error, relative to the value."""
        return replace(self, error=self.error + abs(self.value) * relative)

    def latex(self) -> str:
        """The value and its error, if known, such as 1.411928 ± 3.0 · 10^{-6}."""
        parts = ((self.value, 10), (self.error, 2))
        known = ((x, digits) for x, digits in parts if not math.isnan(x))
        return r" \pm ".join(str(sp.latex(sp.Float(x, digits))) for x, digits in known)

    def _repr_latex_(self) -> str:
        return f"${self.latex()}$"
