"""Base classes of the package's results, and a number with a bound of its error."""

from __future__ import annotations

import math
from dataclasses import Field, dataclass, fields, replace
from typing import Any, ClassVar, Self

import sympy as sp

from lwa.base import latex


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
