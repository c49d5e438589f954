"""Results of a command as rows, each of which is written as text, JSON and LaTeX.

A value is an exact expression, a tuple of them (one per contact), a number with its error
(`Estimate`), or the `InputError` that says why there is no value.
"""

from __future__ import annotations

import json
import math
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import click
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.exact import InputError, evaluated
from lwa.base.frozen import Estimate, Shown

PRINTED_DIGITS = 15  # significant digits of a printed number that is exact
WIDTH = 100  # columns of text
# Breaks of a line: spaces, and within a longer word after an operator but **
_BREAK = re.compile(r"(\s+|(?<=[^*/][*/])(?![*/\s]))")
FRACTION = 24  # characters of a fraction beyond which text has its digits alone
LONG = 160  # characters of an exact number beyond which text has its digits alone

Values = dict[str, Any]


@dataclass(frozen=True)
class Row:
    """A result of a command: one value with its names in JSON, text and LaTeX.

    key : name in JSON; "fwhm.force" is the entry "force" of "fwhm". Not in JSON where empty.
    label : name in text; not in text where empty.
    unit : unit of the value for a chain in SI.
    digits : digits that are printed; 0 for a value that is printed without.
    expression : True if JSON has the expression besides its digits.
    error : bound of the error of an expression, relative; NaN for none that is stated.
    """

    key: str
    label: str
    value: Any
    unit: str = ""
    digits: int = PRINTED_DIGITS
    expression: bool = True
    error: float = math.nan


@dataclass(frozen=True)
class Answer:
    """The result of a command.

    head : JSON of the chain and the settings; expressions become strings when they are printed.
    rows : the results and the other lines of text, in their order.
    si : True if numbers are in SI; then all values are printed in digits, with their units.
    spacing : the symbol of the unit of length, or a number.
    shown : results whose rows make the LaTeX.
    notes : sentences on the validity of the numbers.
    parts : further answers by their key in JSON.
    """

    head: Mapping[str, Any]
    rows: Sequence[Row | str]
    si: bool = False
    spacing: sp.Expr = sp.S.One
    shown: Sequence[Shown] = ()
    notes: Sequence[str] = ()
    parts: Mapping[str, Answer] = field(default_factory=dict)

    def print(self, style: str) -> None:
        """Print the answer as "text", "json" or "latex"."""
        if style == "json":
            click.echo(json.dumps(self.json(), indent=2, default=str))
        else:
            click.echo(self.latex() if style == "latex" else self.text())

    def plain(self, value: sp.Expr) -> sp.Expr:
        """The value at V_s = 1, |B| = 1, and at D = 1 where the spacing is a symbol."""
        letters = (s for s in value.free_symbols if s.name in ("V_s", "B"))
        ones = {s: sp.Integer(-1 if s.is_negative else 1) for s in letters}
        if self.spacing.is_Symbol:
            ones[self.spacing] = sp.S.One
        # a derivative by D, of a law without an expression, at D = 1
        return value.subs(ones) if value.has(sp.Derivative) else value.xreplace(ones)

    # --- JSON -------------------------------------------------------------------------------

    def json(self) -> Values:
        """The object that ``--format json`` prints.

        Names ending in ``_value`` are floats, in the unit of length where the spacing is a symbol,
        at V_s = 1 and B = 1, or -1 where B < 0. Symbols, complex numbers and numbers beyond a
        double have none. The notes include the reasons of missing values.
        """
        result, units, faults = dict(self.head), dict[str, Any](), []
        for row in (row for row in self.rows if isinstance(row, Row) and row.key):
            if row.unit:
                _put(units, row.key, "", row.unit)
            if isinstance(row.value, InputError):
                faults.append(str(row.value))
            if isinstance(row.value, Estimate | InputError):
                value, error = (
                    getattr(row.value, "value", None),
                    getattr(row.value, "error", math.nan),
                )
                _put(result, row.key, "_value", value)
                _put(
                    result,
                    row.key,
                    "_error_value",
                    None if math.isnan(error) else error,
                )
                continue
            if row.expression:
                _put(result, row.key, "", row.value)
            floats = self._floats(row.value) if row.digits else None
            if floats is not None:
                _put(result, row.key, "_value", floats)
                if not math.isnan(row.error):
                    _put(result, row.key, "_error_value", abs(floats) * row.error)
        result |= {"units": units} if self.si else {}
        result |= {key: part.json() for key, part in self.parts.items()}
        notes = dict.fromkeys((*self.notes, *faults))
        return result | ({"notes": list(notes)} if notes else {})

    def _floats(self, value: Any) -> Any:
        """The float of an expression, or a list of floats; None if any value has no float."""
        if not isinstance(value, tuple):
            return as_float(self.plain(value))
        floats = [as_float(self.plain(x)) for x in value]
        return None if None in floats else floats

    # --- text -------------------------------------------------------------------------------

    def text(self) -> str:
        """The lines that ``--format text`` prints."""
        lines = []
        for row in self.rows:
            if isinstance(row, str):
                lines.append(row)
            elif row.label:
                lines.append(f"  {row.label}{self._value_text(row)}")
        lines += [part.text() for part in self.parts.values()]
        lines += [f"\nNote: {note}" for note in self.notes]
        rows = (line for part in lines for line in part.split("\n"))
        return "\n".join(line for row in rows for line in _wrapped(row))

    def _value_text(self, row: Row) -> str:
        unit = f" {row.unit}" if self.si and row.unit else ""
        if isinstance(row.value, InputError):
            return f": {row.value}"
        if isinstance(row.value, Estimate):
            return f" = {summed(row.value, unit)}"
        digits = significant(row.error) if row.error > 0 else row.digits
        values = dict.fromkeys(
            row.value if isinstance(row.value, tuple) else (row.value,)
        )
        text = ", ".join(self._number_text(x, digits) for x in values)
        if row.error > 0 and (number := as_float(self.plain(row.value))):
            text += f" ± {abs(number) * row.error:.1e}{self._length_unit(row.value)}"
        return f" = {text}{unit}"

    def _number_text(self, value: sp.Expr, digits: int) -> str:
        """The value and its ``digits``, if any; a short fraction, or symbols, without digits."""
        if self.si:
            return approximate(value, digits or PRINTED_DIGITS)
        written = str(value)
        if not digits or value.free_symbols - {self.spacing} or value.has(AppliedUndef):
            return written
        plain = self.plain(value)
        if plain.is_Rational and len(written) <= FRACTION:
            return written
        number = sp.sstr(evaluated(plain, digits), full_prec=False) + self._length_unit(
            value
        )
        long = plain.has(sp.Float) or plain.is_Rational or len(written) > LONG
        return number if long else f"{written} ≈ {number}"

    def _length_unit(self, value: sp.Expr) -> str:
        """The unit D^n of a value c D^n, D the symbol of the spacing, after a space; else ""."""
        rest = sp.factor_terms(value).as_independent(self.spacing, as_Add=False)[1]
        base, n = rest.as_base_exp()
        if not self.spacing.is_Symbol or base != self.spacing or not n.is_number:
            return ""
        return f" {base}" if n == 1 else f" {base}^{n}"

    # --- LaTeX ------------------------------------------------------------------------------

    def latex(self) -> str:
        """The display that ``--format latex`` prints, units and notes as comments behind it."""
        notes = [*["numbers are in SI: m, s, kg, N, rad"] * self.si, *self.notes]
        return "\n".join(
            [latex.align(self._equations()), *(f"% {note}" for note in notes)]
        )

    def _equations(self) -> list[str]:
        rows = [row for result in self.shown for row in result.latex_rows()]
        return [
            *rows,
            *(row for part in self.parts.values() for row in part._equations()),
        ]


def _put(result: Values, key: str, suffix: str, value: Any) -> None:
    group, dot, entry = key.partition(".")
    if dot:
        result.setdefault(group + suffix, {})[entry] = value
    else:
        result[group + suffix] = value


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


def approximate(value: sp.Expr, digits: int = PRINTED_DIGITS) -> str:
    """A number in digits; an expression in symbols with its numeric factor in digits."""
    if value.is_zero:
        return "0"
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    number = str(sp.sstr(evaluated(factor, digits), full_prec=False))
    if rest == 1:
        return number
    return str(rest) if factor == 1 else f"{number}·{rest}"


def significant(relative: float) -> int:
    """The digits of a number that reach one beyond its relative error."""
    return min(16, max(1, 2 - math.floor(math.log10(relative))))


def summed(total: Estimate, unit: str) -> str:
    """A number as text: the value to one digit beyond its error, and the error."""
    if math.isnan(total.error):
        return f"{total.value:.4g}{unit}, error unknown"
    if not total.error:
        return f"{total.value:.{PRINTED_DIGITS}g}{unit}"
    digits = significant(total.error / abs(total.value))
    return f"{total.value:.{digits}g} ± {total.error:.1e}{unit}"


def _wrapped(line: str) -> list[str]:
    """Break a line of text at `WIDTH`; further lines are indented by eight columns more."""
    start = line[: len(line) - len(line.lstrip())]
    wrapper = textwrap.TextWrapper(WIDTH, "", f"{start}        ")
    wrapper.wordsep_re = _BREAK
    return wrapper.wrap(line) or [""]
