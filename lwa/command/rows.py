"""Results of a command as rows, each of which is written as text, JSON and LaTeX.

A value is an exact expression, a tuple of them (one per contact), a sum with its error, or the
fault that keeps a sum from being formed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, evaluated
from lwa.expansion.approximants import Resummed

PRINTED_DIGITS = 15
"""Significant digits of a printed number; all of them are correct."""

LONG = 160
"""Characters of an exact number beyond which text shows its digits alone."""

SAME = object()
"""Marker: the digits of a row are those of its value."""

Values = dict[str, Any]


@dataclass(frozen=True)
class Row:
    """A result of a command: one value with its names in JSON, text and LaTeX.

    key : name in JSON; "fwhm.force" is the entry "force" of "fwhm". Not in JSON where empty.
    label : name in text; not in text where empty.
    symbol : name in LaTeX; not in LaTeX where empty.
    number : the expression whose digits are printed, by default the value; None for no digits.
    expression : True if JSON has the expression besides its digits.
    formula : LaTeX in place of the value's own where that is wider than a line.
    """

    key: str
    label: str
    value: Any
    symbol: str = ""
    number: Any = SAME
    expression: bool = True
    formula: str = ""

    @property
    def digits(self) -> Any:
        """The expression or sum whose digits are printed."""
        return self.value if self.number is SAME else self.number


@dataclass(frozen=True)
class Answer:
    """The result of a command.

    head : JSON of the chain and the settings; a value that only JSON needs may be a function.
    rows : the results and the other lines of text, in their order.
    units : unit of the values by key, for a chain in SI.
    spacing : the symbol of the unit of length, or a number.
    equations : rows of LaTeX before the others.
    notes : sentences on the validity of the numbers.
    parts : further answers by their key in JSON.
    orders : True if text states the highest power of k - 1 in a sum.
    """

    head: Mapping[str, Any]
    rows: Sequence[Row | str]
    units: Mapping[str, str] = field(default_factory=dict)
    spacing: sp.Expr = sp.S.One
    equations: Sequence[str] = ()
    notes: Sequence[str] = ()
    parts: Mapping[str, Answer] = field(default_factory=dict)
    orders: bool = True

    def plain(self, value: sp.Expr) -> sp.Expr:
        """The value at V_s = 1 and B = 1, and at D = 1 where the spacing is a symbol."""
        ones = {s: sp.S.One for s in value.free_symbols if s.name in ("V_s", "B")}
        if self.spacing.is_Symbol:
            ones[self.spacing] = sp.S.One
        return value.xreplace(ones)

    def unit(self, row: Row) -> str:
        """The unit of a row in SI, empty where there is none."""
        return self.units.get(row.key, self.units.get(row.key.partition(".")[0], ""))

    # --- JSON -------------------------------------------------------------------------------

    def json(self) -> Values:
        """The object that ``--format json`` prints.

        Names ending in ``_value`` are floats, in the unit of length where the spacing is a symbol
        and at V_s = 1 and B = 1. Symbols, complex numbers and numbers beyond a double have none.
        """
        result = {name: x() if callable(x) else x for name, x in self.head.items()}
        rows = [row for row in self.rows if isinstance(row, Row) and row.key]
        for row in rows:
            if row.expression and isinstance(row.value, sp.Expr | tuple):
                _put(result, row.key, "", _each(str, row.value))
        for row in rows:
            self._put_digits(result, row)
        if self.units:
            result["units"] = dict(self.units)
        result |= {key: part.json() for key, part in self.parts.items()}
        return result | ({"notes": list(self.notes)} if self.notes else {})

    def _put_digits(self, result: Values, row: Row) -> None:
        found = row.digits
        if isinstance(found, Resummed):
            _put(result, row.key, "_value", found.value)
            _put(result, row.key, "_error_value", None if math.isnan(found.error) else found.error)
        elif isinstance(found, InputError):
            _put(result, row.key, "_value", None)
            _put(result, row.key, "_error_value", None)
        elif found is not None:
            floats = _each(lambda x: as_float(self.plain(x)), found)
            if floats is not None:
                _put(result, row.key, "_value", floats)

    # --- text -------------------------------------------------------------------------------

    def text(self) -> str:
        """The lines that ``--format text`` prints."""
        lines = []
        for row in self.rows:
            if isinstance(row, str):
                lines.append(row)
            elif row.label:
                lines.append(f"  {row.label}{self._said(row)}")
        lines += [part.text() for part in self.parts.values()]
        return "\n".join([*lines, *(f"\nNote: {note}" for note in self.notes)])

    def _said(self, row: Row) -> str:
        unit = f" {self.unit(row)}".rstrip()
        if isinstance(row.digits, InputError):
            return f": {row.digits}"
        if isinstance(row.digits, Resummed):
            return f" = {summed(row.digits, unit, self.orders)}"
        parts = row.value if isinstance(row.value, tuple) else (row.value,)
        if row.number is not SAME and row.expression is False and row.number is not None:
            parts = (row.number,)
        digits = row.number is not None
        return " = " + ", ".join(self._shown(x, digits) for x in dict.fromkeys(parts)) + unit

    def _shown(self, value: sp.Expr, numeric: bool) -> str:
        """The value, followed by its digits where it is a number that is not rational."""
        if self.units:
            return approximate(value)
        if not numeric or value.free_symbols - {self.spacing}:
            return str(value)
        plain = self.plain(value)
        if plain.is_Rational:
            return str(value)
        digits = sp.sstr(evaluated(plain, PRINTED_DIGITS), full_prec=False)
        digits, written = digits + self._length_unit(value), str(value)
        return digits if plain.has(sp.Float) or len(written) > LONG else f"{written} ≈ {digits}"

    def _length_unit(self, value: sp.Expr) -> str:
        if not self.spacing.is_Symbol or self.spacing not in value.free_symbols:
            return ""
        power = sp.nsimplify(sp.cancel(value.diff(self.spacing) * self.spacing / value))
        if not power.is_number or power.is_zero:
            return ""
        return f" {self.spacing}" if power == 1 else f" {self.spacing}^{power}"

    # --- LaTeX ------------------------------------------------------------------------------

    def latex(self) -> str:
        """The display that ``--format latex`` prints, notes as comments behind it."""
        display = latex.align(self._equations())
        return "\n".join([display, *(f"% {note}" for note in self.notes)])

    def _equations(self) -> list[str]:
        rows = [row for row in self.rows if isinstance(row, Row) and row.symbol]
        lines = [f"{row.symbol} = {text}" for row in rows if (text := self._formula(row))]
        parts = (line for part in self.parts.values() for line in part._equations())
        return [*self.equations, *lines, *parts]

    def _formula(self, row: Row) -> str:
        found = row.digits if isinstance(row.digits, Resummed | InputError) else row.value
        unit = rf"\ \mathrm{{{self.unit(row)}}}" if self.unit(row) else ""
        if found is None or isinstance(found, InputError):
            return ""
        if isinstance(found, Resummed):
            return found.latex() + unit
        parts = dict.fromkeys(found if isinstance(found, tuple) else (found,))
        if self.units:
            return r",\ ".join(approximate(x, tex=True) for x in parts) + unit
        if row.formula and latex.width(str(sp.latex(row.value))) > latex.WIDTH:
            return row.formula
        return r",\ ".join(map(latex.expression, parts)) + unit


def _put(result: Values, key: str, suffix: str, value: Any) -> None:
    group, dot, entry = key.partition(".")
    if dot:
        result.setdefault(group + suffix, {})[entry] = value
    else:
        result[group + suffix] = value


def _each(read: Callable[[sp.Expr], Any], value: Any) -> Any:
    """Apply ``read`` to an expression or to each of a collection; None if any result is None."""
    if isinstance(value, sp.Expr):
        return read(value)
    found = [read(x) for x in value]
    return None if None in found else found


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


def approximate(value: sp.Expr, tex: bool = False) -> str:
    """A number in digits; an expression in symbols with its numeric factor in digits."""
    if value.is_zero:
        return "0"
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    digits = evaluated(factor, PRINTED_DIGITS)
    number = sp.latex(digits) if tex else sp.sstr(digits, full_prec=False)
    others = sp.latex(rest) if tex else str(rest)
    if rest == 1:
        return str(number)
    return str(others) if factor == 1 else f"{number}{' ' if tex else '·'}{others}"


def summed(found: Resummed, unit: str, order: bool) -> str:
    """A sum in text: one digit more than its error leaves, the error, and the order."""
    if math.isnan(found.error):
        return f"{found.value:.4g}{unit}, error unknown"
    digits = min(16, 2 - math.floor(math.log10(found.error / found.value)))
    note = "; higher orders do not help" if found.asymptotic else ""
    value = f"{found.value:.{digits}g} ± {found.error:.1e}{unit}"
    return f"{value} (to ε^{found.order}{note})" if order else value
