"""A number with a bound of its error."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import sympy as sp

from lwa.base.frozen import Value


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
