"""Base classes of results, a number with a bound of its error, and the quantities of a wave."""

from __future__ import annotations

import math
import re
from dataclasses import Field, dataclass, fields, replace
from typing import Any, ClassVar, Self

import sympy as sp

from lwa.base import NoSolitaryWave as NoSolitaryWave, latex
from lwa.base.words import (
    EXTENTS as EXTENTS,
    QUANTITIES as QUANTITIES,
    ExtentName,
    QuantityName,
    one_of,
)

RISE = sp.Symbol("B", positive=True)
"""B, the peak strain of a wave, unless the caller gives another."""

FALL = sp.Symbol("B", negative=True)
"""B of a wave of lower strain, in a chain that softens."""

SPEED = sp.Symbol("V_s", positive=True)
"""``V_s = dx/dτ``, the speed of a wave, unless the caller gives another."""


def strain_power(quantity: str, k: Any) -> Any:
    """The exponent q of a quantity that scales as ``strain^q``: k for the force, else 1.

    Raises `lwa.InputError` unless the quantity is among `QUANTITIES`.
    """
    return k if known_quantity(quantity) == "force" else 1


def known_quantity(quantity: Any) -> QuantityName:
    """Return the quantity; raise `lwa.InputError` unless it is among `QUANTITIES`."""
    return one_of(quantity, QUANTITIES, "quantity")


def known_extent(extent: Any) -> ExtentName:
    """Return the extent; raise `lwa.InputError` unless it is among `EXTENTS`."""
    return one_of(extent, EXTENTS, "extent")


EXACT_DIGITS = 15
"""Significant digits of a printed float without an error; the sixteenth is rounding."""

TABLE_DIGITS = 6
"""Significant digits of a number in a table of text, at most."""

PLAIN = -5, 5
"""Powers of ten of the first digit of a number that is printed without a power of ten: five zeros
are counted at a glance."""

LEAST_PLAIN = 1e-3
"""The least error that is printed without a power of ten."""

UNKNOWN_DIGITS = 4
"""Significant digits of a printed number whose error nobody knows."""


class Shown:
    """Base of results that notebooks and `sympy.latex` show by the rows of `latex_rows`."""

    def latex_rows(self) -> list[str]:
        """LaTeX of the value in rows such as ``I = …``; if empty, a notebook shows the repr."""
        return []

    def _repr_latex_(self) -> str | None:
        rows = self.latex_rows()
        if not rows:
            return None  # a notebook then shows the repr
        return latex.display(rows)

    def _latex(self, printer: Any) -> str:  # SymPy's name: `sympy.latex` calls it
        # SymPy puts its own dollars around.
        return (self._repr_latex_() or str(self)).strip("$")


class Value(Shown):
    """Base of frozen dataclasses: equality, hash and pickle go by the fields alone.

    Pickles and copies leave out cached properties.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def _set(self, **values: Any) -> None:
        """Set fields to values that were read, which a frozen dataclass takes in this way only."""
        for name, value in values.items():
            object.__setattr__(self, name, value)


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

    @classmethod
    def against(cls, value: float, rough: float) -> Self:
        """Return a value whose error is the difference from a less accurate value."""
        return cls(value, abs(value - rough))

    def __float__(self) -> float:
        return float(self.value)

    def __repr__(self) -> str:
        return self.text()

    def __str__(self) -> str:
        return self.text(TABLE_DIGITS)

    def text(self, most: int = EXACT_DIGITS) -> str:
        """The value to the digits that its error leaves, and the error.

        Parameters
        ----------
        most : int
            Significant digits of the value at most; ± then covers the digits that are left out.

        Notes
        -----
        The error is rounded up to one digit, or to two where the first one is 1. The last digit
        of the value stands at the place of that digit, so that ± is never below the last digit.

        Examples
        --------
        >>> print(Estimate(4859925635.0, 99925635.0), Estimate(1.4119284, 3e-6))
        4.86e+09 ± 1.0e+08 1.41193 ± 1e-05
        """
        # NaN or infinite if either number is.
        if not math.isfinite(self.value + self.error):
            return f"{self.value:.{UNKNOWN_DIGITS}g}, error unknown"
        # Powers of ten of the first and the last digit that are shown
        first = _place(self.value)
        last = first - most + 1
        if not self.error:
            # An exact number has no ±, unless digits are left out.
            short = f"{self.value:.{most}g}"
            if most == EXACT_DIGITS or float(short) == self.value:
                return short
        elif not self.value:
            return f"0 ± {self.error:.2g}"
        else:
            own = _place(self.error)
            if self.error < 2 * 10.0**own:
                own -= 1  # rounding 1.1 up to 2 would nearly double the error
            last = min(max(own, last), first)
        unit = 10.0**last
        # An error of 3e-06 is 3.0000000000000004 units of 1e-06 in floats: no reason for 4e-06.
        error = max(math.ceil(self.error / unit * (1 - 1e-12)), 1) * unit
        scientific = f"{error:.{max(_place(error) - last, 0)}e}"
        if not PLAIN[0] <= first <= PLAIN[1]:
            return f"{self.value:.{first - last}e} ± {scientific}"
        decimals = max(0, -last)
        width = scientific
        if error >= LEAST_PLAIN:
            width = f"{error:.{decimals}f}"
        return f"{round(self.value, -last):.{decimals}f} ± {width}"

    @property
    def relative_error(self) -> float:
        """The error divided by the magnitude of the value."""
        return self.error / abs(self.value)

    def __mul__(self, factor: float) -> Self:
        return replace(self, value=factor * self.value, error=abs(factor) * self.error)

    def __truediv__(self, other: Estimate) -> Self:
        """The quotient, with the sum of the relative errors."""
        return (self * (1 / other.value)).widened(other.relative_error)

    def widened(self, relative: float) -> Self:
        """Return an estimate of this value with a further error, relative to the value."""
        return replace(self, error=self.error + abs(self.value) * relative)

    def latex(self) -> str:
        """The value and its error, if known, such as ``1.411928 ± 3 · 10^{-6}``."""
        text = repr(self).partition(",")[0].replace("e+", "e").replace("±", r"\pm")
        return re.sub(r"e(-?)0*(\d+)", r" \\cdot 10^{\1\2}", text)

    def _repr_latex_(self) -> str:
        return f"${self.latex()}$"


def _place(value: float) -> int:
    """The power of ten of the first digit of a number; 0 for 0."""
    if not value:
        return 0
    return math.floor(math.log10(abs(value)))
