"""Rows of an answer: one value each, as text, in JSON and in LaTeX.

A value is an exact expression, a tuple of expressions (one per contact or bead), a number with its
error (`Estimate`), or the `InputError` that says why there is no value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.exact import InputError, evaluated
from lwa.base.frozen import EXACT_DIGITS, TABLE_DIGITS, Estimate
from lwa.spheres.units import fitting

FRACTION = 24  # characters of a fraction beyond which text has its digits alone
LONG = 160  # characters of an exact number beyond which text has its digits alone

Form = Literal["both", "formula", "number"]
"""What a row shows of an expression: the formula and its digits, or one of them."""


@dataclass(frozen=True)
class Scale:
    """The units of an answer's numbers.

    Parameters
    ----------
    si : bool
        True if numbers are in SI; text then has digits with units alone.
    spacing : Expr
        The symbol of the unit of length, or a number.
    """

    si: bool = False
    spacing: sp.Expr = sp.S.One

    def plain(self, value: sp.Expr) -> sp.Expr:
        """The value at ``V_s = 1``, ``|B| = 1``, and at ``D = 1`` where the spacing is a symbol."""
        ones = {}
        for symbol in value.free_symbols:
            if symbol.name in ("V_s", "B"):
                ones[symbol] = sp.Integer(-1 if symbol.is_negative else 1)
        if self.spacing.is_Symbol:
            ones[self.spacing] = sp.S.One
        # A derivative by D, of a law without an expression, is one at D = 1.
        if value.has(sp.Derivative):
            return value.subs(ones)
        return value.xreplace(ones)

    def unit_of(self, value: sp.Expr) -> str | None:
        """The unit of a number times powers of symbols, such as ``" D^2"``; None for others."""
        unit = sp.S.One
        for base, n in sp.factor_terms(value).as_powers_dict().items():
            if base.is_Symbol and n.is_number:
                unit *= base**n
            elif base.free_symbols or n.free_symbols:
                return None
        return "" if unit == 1 else f" {unit}".replace("**", "^")

    def measured(self, number: Estimate, unit: str) -> str:
        """A number with its error as text; in SI with the prefix that suits its size."""
        if not self.si:
            return number.text()
        fitted = fitting(unit, abs(number.value))
        text, comma, unknown = (number * (1 / fitted.size)).text().partition(",")
        return f"{text} {fitted.name}".rstrip() + comma + unknown

    def written(self, value: sp.Expr, unit: str) -> str:
        """An expression as text; in SI six digits, and the unit with a prefix."""
        if not self.si:
            return str(value)
        number = as_float(value)
        if number is None:
            return f"{approximate(value, TABLE_DIGITS)} {unit}".rstrip()
        fitted = fitting(unit, abs(number))
        return f"{number / fitted.size:.{TABLE_DIGITS}g} {fitted.name}".rstrip()


UNITLESS = Scale()
"""The scale of numbers without units."""


@dataclass(frozen=True)
class Row:
    """One value of an answer, with its names.

    Parameters
    ----------
    key : str
        Name in JSON; "fwhm.force" is the entry "force" of "fwhm". Not in JSON where empty.
    label : str
        Name in text; not in text where empty.
    value : Expr, tuple of Expr, Estimate or InputError
        The value, or why there is none.
    unit : str
        Unit of the value for a chain in SI.
    symbol : str
        Name in LaTeX; not in LaTeX where empty.
    form : {"both", "formula", "number"}
        What is shown of an expression.
    estimate : Estimate, optional
        The number of an expression with its error.
    """

    key: str
    label: str
    value: Any
    unit: str = ""
    symbol: str = ""
    form: Form = "both"
    estimate: Estimate | None = None

    @property
    def measured(self) -> Estimate | None:
        """The number with its error; None for an expression whose error nobody knows."""
        if isinstance(self.value, Estimate):
            return self.value
        if self.estimate is None or math.isnan(self.estimate.error):
            return None
        return self.estimate

    def entries(self, scale: Scale) -> dict[str, Any]:
        """The values in JSON, by the ending of their names: "", "_value", "_error_value"."""
        if isinstance(self.value, InputError):
            return {"_value": None, "_error_value": None}
        found: dict[str, Any] = {}
        if isinstance(self.value, Estimate):
            found["_value"] = float(self.value)
        else:
            floats = self._floats(scale)
            if self.form != "number":
                found[""] = self.value
            if self.form != "formula" and floats is not None:
                found["_value"] = floats
        if self.measured is not None:
            error = float(self.measured.error)
            found["_error_value"] = None if math.isnan(error) else error
        return found

    def _floats(self, scale: Scale) -> Any:
        """The float of an expression, or a list of floats; None if any value has no float."""
        if not isinstance(self.value, tuple):
            return as_float(scale.plain(self.value))
        floats = [as_float(scale.plain(x)) for x in self.value]
        return None if None in floats else floats

    @property
    def _each(self) -> Sequence[sp.Expr]:
        """The expressions, those of contacts that are alike once."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        return list(dict.fromkeys(values))

    def text(self, scale: Scale) -> str:
        """The row as a line of text."""
        if isinstance(self.value, InputError):
            return f"{self.label}: {self.value.reason}"
        if self.measured is None:
            texts = [self._expression(x, scale) for x in self._each]
            return f"{self.label} = {', '.join(texts)}"
        number = scale.measured(self.measured, self.unit)
        if not isinstance(self.value, Estimate):
            unit = "" if scale.si else scale.unit_of(self.value)
            number = self._beside(self.value, f"{number}{unit or ''}", scale)
        return f"{self.label} = {number}"

    def _expression(self, value: sp.Expr, scale: Scale) -> str:
        """An expression as text: the formula, its digits, or both."""
        unit = scale.unit_of(value)
        symbolic = value.free_symbols - {scale.spacing} or value.has(AppliedUndef)
        if scale.si or self.form == "formula" or symbolic or unit is None:
            return scale.written(value, self.unit)
        places = TABLE_DIGITS if self.form == "number" else EXACT_DIGITS
        digits = evaluated(scale.plain(value), places)
        number = f"{sp.sstr(digits, full_prec=False)}{unit}"
        return self._beside(value, number, scale)

    def _beside(self, value: sp.Expr, number: str, scale: Scale) -> str:
        """A number behind its formula, or one of them where the other says no more."""
        if scale.si or self.form == "number" or value.has(sp.Float):
            return number
        formula = str(value)
        if scale.plain(value).is_Rational:
            exact = self.measured is None and len(formula) <= FRACTION
            return formula if exact else number
        return number if len(formula) > LONG else f"{formula} ≈ {number}"

    def latex(self) -> str:
        """The row as ``symbol = value``; "" without a symbol or a value."""
        if not self.symbol or isinstance(self.value, InputError):
            return ""
        if self.measured is not None:
            return f"{self.symbol} = {self.measured.latex()}"
        return f"{self.symbol} = {', '.join(map(latex.expression, self._each))}"


def as_float(value: sp.Expr) -> float | None:
    """The nearest float of an exact number; None if symbolic, complex or out of range."""
    if value.free_symbols:
        return None
    number = evaluated(value, 30)
    if not number.is_real or not (number == 0 or 1e-300 < abs(number) < 1e300):
        return None
    return float(number)


def attempt(read: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a call, or the `InputError` that it raises."""
    try:
        return read(*arguments)
    except InputError as fault:
        return fault


def approximate(value: sp.Expr, digits: int = EXACT_DIGITS) -> str:
    """A number in digits; an expression in symbols with its numeric factor in digits."""
    if value.is_zero:
        return "0"
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    number = str(sp.sstr(evaluated(factor, digits), full_prec=False))
    if rest == 1:
        return number
    return str(rest) if factor == 1 else f"{number}·{rest}"


def estimated(result: Any, name: str, *arguments: Any) -> Estimate | None:
    """The estimate of a result's number; None with symbols, and for results that have none."""
    if not hasattr(result, "estimate"):
        return None
    found = attempt(result.estimate, name, *arguments)
    return None if isinstance(found, InputError) else found
