"""Base classes of results, a number with a bound of its error, and the quantities of a wave."""

from __future__ import annotations

import math
import re
from dataclasses import Field, dataclass, fields, replace
from typing import Any, ClassVar, Self

import sympy as sp

from lwa.base import NoSolitaryWave as NoSolitaryWave
from lwa.base import latex
from lwa.base.words import EXTENTS as EXTENTS
from lwa.base.words import QUANTITIES as QUANTITIES
from lwa.base.words import ExtentName, QuantityName, one_of

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

FALL = sp.Symbol("B", negative=True)
"""B of a wave of lower strain, in a chain that softens."""

SPEED = sp.Symbol("V_s", positive=True)
"""V_s = dx/dτ, the speed of a wave, unless the caller gives another."""


def strain_power(quantity: str, k: Any) -> Any:
    """The exponent q of a quantity that scales as strain^q: k for the force, else 1.

    Raises `lwa.InputError` unless the quantity is among `QUANTITIES`.
    """
    return k if known_quantity(quantity) == "force" else 1


def known_quantity(quantity: Any) -> QuantityName:
    """Return the quantity; raise `lwa.InputError` unless it is among `QUANTITIES`."""
    return one_of(quantity, QUANTITIES, "quantity")


def known_extent(extent: Any) -> ExtentName:
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


@dataclass(frozen=True, repr=False)
class Estimate(Value):
    """A value with the absolute error of that value.

    Parameters
    ----------
    value : float
        The number; `float` gives it, too.
    error : float
        A bound or an estimate of the absolute error; NaN if unknown, 0 for an exact number.

    Examples
    --------
    >>> Estimate(1.4119284, 3e-6)
    1.411928 ± 3e-06
    >>> Estimate(1.4119284, 3e-6) / Estimate(-2, 0.01)
    -0.706 ± 0.004
    """

    value: float
    error: float

    def __float__(self) -> float:
        return float(self.value)

    def __repr__(self) -> str:
        if math.isnan(self.error):
            return f"{self.value:.{UNKNOWN_DIGITS}g}, error unknown"
        digits, error = self.printed
        value = rounded(self.value, digits)
        return f"{value} ± {error}" if self.error else value

    def __mul__(self, factor: float) -> Self:
        return replace(self, value=factor * self.value, error=abs(factor) * self.error)

    def __truediv__(self, other: Estimate) -> Self:
        """The quotient, with the sum of the relative errors."""
        return (self * (1 / other.value)).widened(other.relative)

    @property
    def relative(self) -> float:
        """The error divided by the magnitude of the value."""
        return float(self.error / abs(self.value))

    def widened(self, relative: float) -> Self:
        """Return an estimate of this value with a further error, relative to the value."""
        return replace(self, error=self.error + abs(self.value) * relative)

    @property
    def printed(self) -> tuple[int, str]:
        """The digits of the value that are printed, and the error as text.

        The error is rounded up to one digit, or to two where the first is 1, and the last digit
        of the value is the place of that digit: ± is not below the last digit.
        """
        if not self.error > 0:
            return EXACT_DIGITS, "0"
        place = math.floor(math.log10(self.error))
        if self.error < 2 * 10.0**place:
            place -= 1
        unit = 10.0**place
        # An error of 3e-06 is 3.0000000000000004 units of 1e-06 in floats: no reason for 4e-06.
        error = math.ceil(self.error / unit * (1 - 1e-12)) * unit
        size = abs(self.value)
        digits = math.floor(math.log10(size)) - place + 1 if size else 1
        return min(max(digits, 1), EXACT_DIGITS), f"{error:.2g}"

    def latex(self) -> str:
        """The value and its error, if known, such as 1.411928 ± 3 · 10^{-6}."""
        return re.sub(
            r"e([+-])0*(\d+)", _power_of_ten, repr(self).partition(",")[0]
        ).replace("±", r"\pm")

    def _repr_latex_(self) -> str:
        return f"${self.latex()}$"


EXACT_DIGITS = 15
"""Significant digits of a printed float without an error; the sixteenth is rounding."""

UNKNOWN_DIGITS = 4
"""Significant digits of a printed number whose error nobody knows."""


def rounded(value: float, digits: int) -> str:
    """A number to so many significant digits, whose trailing zeros tell where it was rounded.

    >>> rounded(1.41, 4), rounded(0.0, 3), rounded(1234.0, 2), rounded(123.4, 3)
    ('1.410', '0.00', '1.2e+03', '123')
    """
    if digits >= EXACT_DIGITS:
        return f"{value:.{EXACT_DIGITS}g}"
    return f"{value:#.{digits}g}".rstrip(".").replace(".e", "e")


def _power_of_ten(found: re.Match[str]) -> str:
    sign = found[1].replace("+", "")
    return rf" \cdot 10^{{{sign}{found[2]}}}"
