"""The answer of a command: rows of values, as text, in JSON and in LaTeX.

A value is an exact expression, a tuple of expressions (one per contact or bead), a number with its
error (`Estimate`), or the `InputError` that says why there is no value.
"""

from __future__ import annotations

import json
import math
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import click
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.exact import InputError, evaluated
from lwa.base.frozen import EXACT_DIGITS, TABLE_DIGITS, Estimate, Shown
from lwa.spheres.units import fitting

FRACTION = 24
"""Most characters of a fraction in text, about a quarter of a line; a longer one has its digits
alone."""

LONG = 160
"""Most characters of another exact number in text, two lines; a longer one has its digits alone."""

Form = Literal["both", "formula", "number"]
"""Parts of an expression in a row: the formula and its digits, or one of them."""


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
        ones: dict[sp.Expr, int] = {}
        if self.spacing.is_Symbol:
            ones[self.spacing] = 1
        for symbol in value.free_symbols:
            if symbol.name in ("V_s", "B"):
                # B is negative in chains that soften.
                ones[symbol] = -1 if symbol.is_negative else 1
        if value.free_symbols <= ones.keys():
            return value.subs(ones)
        # Substitution in an expression with other symbols would take long, for no number.
        return value

    def unit_of(self, value: sp.Expr) -> str | None:
        """The unit of a number times powers of symbols, such as ``" D^2"``; None for others."""
        unit = sp.S.One
        # A sum such as a D + b D becomes a product.
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
        # The unit stands before the words on an unknown error.
        text, comma, unknown = (number * (1 / fitted.size)).text().partition(",")
        return f"{text} {fitted.name}".rstrip() + comma + unknown

    def written(self, value: sp.Expr, unit: str) -> str:
        """An expression as text; in SI six digits, and the unit with a prefix."""
        if not self.si:
            return str(value)
        number = as_float(value)
        if number is None:  # symbols, behind a factor in digits
            factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
            digits = sp.sstr(evaluated(factor, TABLE_DIGITS), full_prec=False)
            return f"{digits}·{rest} {unit}".removeprefix("1·").rstrip()
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
            # A float is a result of numerics; closed forms of the lattice hold floats as factors.
            closed = not any(x.is_Float for x in self._each)
            if closed and self.form != "number":
                found[""] = self.value
            if self.form != "formula" and floats is not None:
                found["_value"] = floats
        if self.measured is not None:
            error = float(self.measured.error)
            found["_error_value"] = error
            if math.isnan(error):  # JSON has no NaN
                found["_error_value"] = None
        return found

    def _floats(self, scale: Scale) -> Any:
        """The float of an expression, or a list of floats; None if any value has no float."""
        if not isinstance(self.value, tuple):
            return as_float(scale.plain(self.value))
        floats = [as_float(scale.plain(x)) for x in self.value]
        if None in floats:
            return None
        return floats

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
        if not scale.si and not isinstance(self.value, Estimate):
            number += scale.unit_of(self.value) or ""
            number = self._beside(self.value, number, scale)
        return f"{self.label} = {number}"

    def _expression(self, value: sp.Expr, scale: Scale) -> str:
        """An expression as text: the formula, its digits, or both."""
        unit = scale.unit_of(value)
        # The functions φ_n of a general law have no value, though no free symbol.
        symbolic = value.free_symbols - {scale.spacing} or value.has(AppliedUndef)
        if scale.si or self.form == "formula" or symbolic or unit is None:
            return scale.written(value, self.unit)
        places = TABLE_DIGITS if self.form == "number" else EXACT_DIGITS
        digits = evaluated(scale.plain(value), places)
        number = f"{sp.sstr(digits, full_prec=False)}{unit}"
        return self._beside(value, number, scale)

    def _beside(self, value: sp.Expr, number: str, scale: Scale) -> str:
        """A number behind its formula, or one of them where the other says no more."""
        if self.form == "number" or value.has(sp.Float):
            return number
        formula = str(value)
        if scale.plain(value).is_Rational:
            # A fraction says all that its digits say, but for an error.
            if self.measured is None and len(formula) <= FRACTION:
                return formula
            return number
        if len(formula) > LONG:
            return number
        return f"{formula} ≈ {number}"

    def latex(self, scale: Scale) -> str:
        """The row as ``symbol = value``; "" without a symbol or a value."""
        if not self.symbol or isinstance(self.value, InputError):
            return ""
        if self.measured is not None:
            number = self.measured.latex()
            unit = not isinstance(self.value, Estimate) and scale.unit_of(self.value)
            if unit:
                number = rf"\left({number}\right){unit}"
            return f"{self.symbol} = {number}"
        return f"{self.symbol} = {', '.join(map(latex.expression, self._each))}"


def as_float(value: sp.Expr) -> float | None:
    """The nearest float of an exact number; None if symbolic, complex or out of range."""
    if value.free_symbols:
        return None
    # Thirty digits, so that the float is the nearest one.
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


def estimated(result: Any, name: str, *arguments: Any) -> Estimate | None:
    """The estimate of a result's number; None with symbols, and for results that have none."""
    if not hasattr(result, "estimate"):
        return None
    found: Estimate | InputError = attempt(result.estimate, name, *arguments)
    if isinstance(found, InputError):
        return None
    return found


WIDTH = 100
"""Columns of text at most, and in a file or a pipe; a narrower terminal has its own."""

# Breaks of a line: spaces, and within a longer word after an operator but **
_BREAK = re.compile(r"(\s+|(?<=[^*/][*/])(?![*/\s]))")

Values = dict[str, Any]
Lines = list["Row | str | Answer"]
"""Rows, lines of text, and parts of an answer."""


@dataclass(frozen=True)
class Answer:
    """The result of a command, or a part of one.

    Parameters
    ----------
    head : mapping
        JSON of the chain and the settings; expressions become strings when they are printed.
    rows : sequence of Row, str or Answer
        Results, lines of text, and parts, in the order of the text.
    scale : Scale
        Units of the numbers.
    shown : sequence of Shown or str
        Results, or equations in LaTeX, that stand in LaTeX before those of the rows.
    errors : str
        Meaning of ±, printed below rows with an error.
    notes : sequence of str
        Sentences on the validity of the numbers.
    key : str
        Name in JSON, of a part.
    """

    head: Mapping[str, Any]
    rows: Sequence[Row | str | Answer]
    scale: Scale = UNITLESS
    shown: Sequence[Shown | str] = ()
    errors: str = ""
    notes: Sequence[str] = ()
    key: str = ""

    def print(self, style: str) -> None:
        """Print the answer as "text", "json" or "latex"."""
        if style == "json":
            click.echo(json.dumps(self.json(), indent=2, default=str))
        elif style == "latex":
            click.echo(self.latex())
        else:
            click.echo(self.text())

    def _values(self) -> Iterator[Row]:
        """The rows that are values."""
        for row in self.rows:
            if isinstance(row, Row):
                yield row

    def json(self) -> Values:
        """The object that ``--format json`` prints.

        Names ending in ``_value`` are floats, in the unit of length where the spacing is a symbol,
        at ``V_s = 1`` and ``B = 1``, or ``B = -1`` if B is negative. Symbols, complex numbers and
        numbers beyond a double have none. The notes include the reasons of missing values.
        """
        result = dict(self.head)
        units: Values = {}
        faults = []
        for row in self._values():
            if not row.key:
                continue
            if row.unit:
                _put(units, row.key, "", row.unit)
            if isinstance(row.value, InputError):
                faults.append(str(row.value))
            for ending, value in row.entries(self.scale).items():
                _put(result, row.key, ending, value)
        if self.scale.si:
            result["units"] = units
        for part in self.rows:
            if isinstance(part, Answer):
                result[part.key] = part.json()
        # Several values may be missing for one reason.
        notes = list(dict.fromkeys((*self.notes, *faults)))
        if notes:
            result["notes"] = notes
        return result

    def text(self) -> str:
        """The lines that ``--format text`` prints."""
        lines = []
        for line in self._lines():
            lines += _wrapped(line, text_width())
        return "\n".join(lines)

    def _lines(self) -> Iterator[str]:
        for row in self.rows:
            if isinstance(row, Answer):
                yield from row._lines()
            elif isinstance(row, str):
                yield from row.split("\n")
            elif row.label:
                yield f"  {row.text(self.scale)}"
        measured = [row.measured for row in self._values() if row.measured is not None]
        if self.errors and any(number.error > 0 for number in measured):
            yield f"±: {self.errors}"
        for note in self.notes:
            yield ""
            yield f"Note: {note}"

    def latex(self) -> str:
        """The display that ``--format latex`` prints, units and notes as comments behind it."""
        # A row may be among those of a result.
        lines = [latex.align(list(dict.fromkeys(self._equations())))]
        if self.scale.si:
            lines.append("% numbers are in SI: m, s, kg, N, rad")
        lines += [f"% {note}" for note in self.notes]
        return "\n".join(lines)

    def _equations(self) -> Iterator[str]:
        for result in self.shown:
            yield from [result] if isinstance(result, str) else result.latex_rows()
        for row in self.rows:
            if isinstance(row, Answer):
                yield from row._equations()
            elif isinstance(row, Row) and row.latex(self.scale):
                yield row.latex(self.scale)


def _put(result: Values, key: str, ending: str, value: Any) -> None:
    """Set the value of a key, whose part behind a dot is the name in a mapping."""
    group, dot, entry = key.partition(".")
    if dot:
        result.setdefault(group + ending, {})[entry] = value
    else:
        result[group + ending] = value


def text_width() -> int:
    """Columns of the terminal, `WIDTH` at most; `WIDTH` in a file or a pipe."""
    if not sys.stdout.isatty():
        return WIDTH
    return min(shutil.get_terminal_size().columns, WIDTH)


def _wrapped(line: str, width: int) -> list[str]:
    """Break a line of text; further lines are indented by eight columns more."""
    indent = line[: len(line) - len(line.lstrip())]
    wrapper = textwrap.TextWrapper(width, "", f"{indent}        ")
    wrapper.wordsep_re = _BREAK
    return wrapper.wrap(line) or [""]
