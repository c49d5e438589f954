"""Rows of an answer: one value each, as text, in JSON and in LaTeX.

A value is an exact expression, a tuple of expressions (one per contact or bead), a number with its
error (`Estimate`), or the `InputError` that says why there is no value.
"""

from __future__ import annotations

import math
from collections.abc import Callable
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
        """The value at V_s = 1, |B| = 1, and at D = 1 where the spacing is a symbol."""
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
        """The unit of a number times powers of symbols, such as " D^2"; None for other values."""
        symbols = value.free_symbols
        rest = sp.factor_terms(value).as_independent(*symbols, as_Add=False)[1]
        powers = [factor.as_base_exp() for factor in sp.Mul.make_args(rest)]
        if rest == 1:
            return ""
        if any(not base.is_Symbol or n.free_symbols for base, n in powers):
            return None
        if len(powers) > 1:
            return f"·{rest}"
        ((base, n),) = powers
        if n == 1:
            return f" {base}"
        return f" {base}^{n}" if n.is_Integer else f" {base}^({n})"

    def measured(self, value: Estimate, unit: str) -> str:
        """A number with its error as text; in SI with the prefix that suits its size."""
        if not self.si or not unit:
            return value.text()
        fitted = fitting(unit, abs(value.value))
        text = (value * (1 / fitted.size)).text()
        number, comma, unknown = text.partition(",")
        return f"{number} {fitted.name}{comma}{unknown}"

    def number(self, value: sp.Expr, unit: str) -> str:
        """An exact number in SI as text: six digits, and the unit with a prefix."""
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
    digits : int
        Digits of an expression that are printed.
    estimate : Estimate, optional
        The number of an expression with its error.
    """

    key: str
    label: str
    value: Any
    unit: str = ""
    symbol: str = ""
    form: Form = "both"
    digits: int = EXACT_DIGITS
    estimate: Estimate | None = None

    @property
    def error(self) -> float:
        """The absolute error of the value; NaN if unknown or if there is none."""
        measured = self.value if isinstance(self.value, Estimate) else self.estimate
        return math.nan if measured is None else measured.error

    # --- JSON -------------------------------------------------------------------------------

    def entries(self, scale: Scale) -> dict[str, Any]:
        """The values in JSON, by the ending of their names: "", "_value", "_error_value"."""
        if isinstance(self.value, InputError):
            return {"_value": None, "_error_value": None}
        error = None if math.isnan(self.error) else float(self.error)
        if isinstance(self.value, Estimate):
            return {"_value": float(self.value), "_error_value": error}
        found = {}
        if self.form != "number":
            found[""] = self.value
        floats = None
        if self.form != "formula":
            floats = self._floats(scale)
        if floats is not None:
            found["_value"] = floats
        if self.estimate is not None:
            found["_error_value"] = error
        return found

    def _floats(self, scale: Scale) -> Any:
        """The float of an expression, or a list of floats; None if any value has no float."""
        if not isinstance(self.value, tuple):
            return as_float(scale.plain(self.value))
        floats = [as_float(scale.plain(x)) for x in self.value]
        return None if None in floats else floats

    # --- text -------------------------------------------------------------------------------

    def text(self, scale: Scale) -> str:
        """The row as a line of text."""
        if isinstance(self.value, InputError):
            return f"{self.label}: {self.value.reason}"
        return f"{self.label} = {self._value_text(scale)}"

    def _value_text(self, scale: Scale) -> str:
        if isinstance(self.value, Estimate):
            return scale.measured(self.value, self.unit)
        if self.estimate is not None and not math.isnan(self.error):
            number = scale.measured(self.estimate, self.unit)
            if not scale.si:
                number += scale.unit_of(self.value) or ""
            formula = str(self.value)
            bare = scale.si or self.form == "number" or self.value.has(sp.Float)
            if bare or len(formula) > LONG or self.value.is_Rational:
                return number
            return f"{formula} ≈ {number}"
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        # Contacts that are alike are printed once.
        texts = dict.fromkeys(self._expression(x, scale) for x in values)
        return ", ".join(texts)

    def _expression(self, value: sp.Expr, scale: Scale) -> str:
        """An expression as text: the formula, its digits, or both."""
        if scale.si:
            return scale.number(value, self.unit)
        formula = str(value)
        symbolic = value.free_symbols - {scale.spacing} or value.has(AppliedUndef)
        if self.form == "formula" or symbolic:
            return formula
        plain = scale.plain(value)
        if plain.is_Rational and len(formula) <= FRACTION:
            return formula
        unit = scale.unit_of(value)
        if unit is None:  # no number but at D = 1
            return formula
        digits = sp.sstr(evaluated(plain, self.digits), full_prec=False)
        number = f"{digits}{unit}"
        closed = not plain.has(sp.Float) and not plain.is_Rational
        if closed and self.form == "both" and len(formula) <= LONG:
            return f"{formula} ≈ {number}"
        return number

    # --- LaTeX ------------------------------------------------------------------------------

    def latex(self) -> str:
        """The row as ``symbol = value``; "" without a symbol or a value."""
        if not self.symbol or isinstance(self.value, InputError):
            return ""
        measured = self.value if isinstance(self.value, Estimate) else self.estimate
        if measured is not None and not math.isnan(measured.error):
            return f"{self.symbol} = {measured.latex()}"
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        texts = dict.fromkeys(latex.expression(x) for x in values)
        return f"{self.symbol} = {', '.join(texts)}"


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
    """The estimate of a result's number; None with symbols."""
    found = attempt(result.estimate, name, *arguments)
    return None if isinstance(found, InputError) else found
