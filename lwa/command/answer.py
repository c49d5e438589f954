"""The answer of a command: rows of values, as text, in JSON and in LaTeX.

A value is an exact expression, a tuple of expressions (one per contact or bead), a number with its
error (`Estimate`), or the `InputError` that says why there is no value.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import repeat
from typing import Any, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, evaluated
from lwa.base.frozen import EXACT_DIGITS, TABLE_DIGITS, Estimate, Shown
from lwa.spheres.units import Unit, fitting

FRACTION = 24
"""Most characters of a fraction in text, about a quarter of a line; a longer one has its digits
alone."""

LONG = 160
"""Most characters of another exact number in text, two lines; a longer one has its digits alone."""

_SIZES = ("V_s", "B", "F")
"""Symbols of a wave's size, which results hold where no number is given."""


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

    def number(self, value: sp.Expr) -> Estimate | None:
        """The number of an exact value at ``V_s = F = |B| = 1``, and at ``D = 1`` for a symbol D.

        None with other symbols, and for complex numbers and numbers beyond a double.
        """
        ones: dict[sp.Expr, int] = {}
        for symbol in value.free_symbols:
            # Substitution in an expression with other symbols would take long, for no number.
            if symbol.name not in _SIZES and symbol != self.spacing:
                return None
            # B is negative in chains that soften.
            ones[symbol] = -1 if symbol.is_negative else 1
        # Thirty digits, twice those of a float, so that the float is the nearest one.
        number = evaluated(value.subs(ones), 30)
        # Nearer to the ends of a float's range the product of number and unit may be lost.
        if not number.is_real or not (number == 0 or 1e-300 < abs(number) < 1e300):
            return None
        return Estimate(float(number), 0.0)

    def symbols(self, value: sp.Expr) -> sp.Expr | None:
        """The powers of symbols behind a value's number, such as D²; None for other functions."""
        powers = sp.S.One
        # A sum such as a D + b D becomes a product.
        for base, n in sp.factor_terms(value).as_powers_dict().items():
            if base.is_Symbol and n.is_number:
                powers *= base**n
            elif base.free_symbols or n.free_symbols:
                return None
        return powers

    def digits(self, number: Estimate, unit: str, most: int = EXACT_DIGITS) -> str:
        """A number with its error and its unit; in SI with the prefix that suits its size.

        Parameters
        ----------
        number : Estimate
            The number.
        unit : str
            SI unit of the number, or powers of symbols.
        most : int
            Digits of a number without an error.
        """
        # A prefix belongs to a unit of measurement, not to powers of symbols.
        fitted = fitting(unit, abs(number.value)) if self.si else Unit(unit)
        number *= 1 / fitted.size
        text = number.text() if number.error else f"{number.value:.{most}g}"
        # The unit stands before the words on an unknown error.
        text, comma, unknown = text.partition(",")
        return f"{text} {fitted.name}".rstrip() + comma + unknown


UNITLESS = Scale()
"""The scale of numbers without units."""


@dataclass(frozen=True)
class Row:
    """One value of an answer, with its names: text, JSON and LaTeX are made from it.

    Parameters
    ----------
    key : str
        Name in JSON; "fwhm.force" is the entry "force" of "fwhm". Not in JSON where empty.
    label : str
        Name in text, and in brackets the unit for a chain in SI: "speed (m/s)". Not in text where
        empty.
    value : Expr, tuple of Expr, Estimate or InputError
        The value, or why there is none.
    symbol : str
        Name in LaTeX; not in LaTeX where empty.
    estimate : Estimate, optional
        The number of an expression with its error.
    """

    key: str
    label: str
    value: Any
    symbol: str = ""
    estimate: Estimate | None = None

    @classmethod
    def of(
        cls,
        result: Any,
        name: str,
        label: str,
        *arguments: Any,
        key: str = "",
        symbol: str = "",
    ) -> Self:
        """Make the row of a result's attribute or method, with its error where the error is known.

        Parameters
        ----------
        result : object
            The result, such as a wave.
        name : str
            Name of the attribute or method, and of the row in JSON unless there is a key.
        label : str
            Label of the row.
        *arguments
            Arguments of a method.
        key, symbol : str
            Key and symbol of the row.
        """
        value = attempt(getattr, result, name)
        if callable(value):
            value = attempt(value, *arguments)
        # A result that knows the errors of its numbers has a method `estimate`.
        estimate = None
        if hasattr(result, "estimate"):
            estimate = attempt(result.estimate, name, *arguments)
            # Numbers with symbols have no estimate, and some names have none.
            if isinstance(estimate, InputError):
                estimate = None
        return cls(key or name, label, value, symbol, estimate)

    @property
    def unit(self) -> str:
        """The unit in the label; empty without one."""
        return self.label.partition(" (")[2].removesuffix(")")

    @property
    def values(self) -> Sequence[Any]:
        """The values, those of contacts or beads one by one."""
        return self.value if isinstance(self.value, tuple) else (self.value,)

    def numbers(self, scale: Scale) -> list[Estimate]:
        """The number of each value; [] if any value has none."""
        # A list with gaps would be read as if it were complete.
        found = []
        for number in self.values:
            if not isinstance(number, Estimate):
                estimate = self.estimate
                if scale.symbols(number) is None:
                    # An estimate stands beside powers of symbols, and not for √(m1 + m2).
                    estimate = None
                number = estimate or scale.number(number)
            if number is None:
                return []
            found.append(number)
        return found

    def entries(self, scale: Scale) -> dict[str, Any]:
        """The values in JSON, by the ending of their names: "", "_value", "_error_value"."""
        if isinstance(self.value, InputError):
            return {"_value": None, "_error_value": None}
        found: dict[str, Any] = {}
        # A float is a result of numerics; closed forms of the lattice hold floats as factors.
        if not any(isinstance(x, Estimate | sp.Float) for x in self.values):
            found[""] = self.value
        numbers = self.numbers(scale)
        if isinstance(self.value, tuple) and numbers:
            found["_value"] = [number.value for number in numbers]
        elif numbers:
            found["_value"] = numbers[0].value
            error = numbers[0].error
            if error:
                # JSON has no NaN.
                found["_error_value"] = None if math.isnan(error) else error
        return found

    def text(self, scale: Scale) -> str:
        """The row as a line of text; values that are all alike stand once."""
        label, _, _ = self.label.partition(" (")
        if isinstance(self.value, InputError):
            return f"{label}: {self.value}"
        # No number at all if one of the values has none.
        numbers = self.numbers(scale) or repeat(None)
        texts = []
        for value, number in zip(self.values, numbers, strict=False):
            texts.append(self._text(value, number, scale))
        if len(set(texts)) == 1:  # as of contacts that are alike
            texts = texts[:1]
        return f"{label} = {', '.join(texts)}"

    def _text(
        self, value: sp.Expr | Estimate, number: Estimate | None, scale: Scale
    ) -> str:
        """A value as text: its formula, its digits, or both.

        `number` holds the digits of an exact value (`numbers`); None if symbols leave it open.
        """
        unit = self.unit if scale.si else ""
        if isinstance(value, Estimate):
            return scale.digits(value, unit)
        formula = str(value)
        symbols = scale.symbols(value)
        # A number stands beside powers of symbols alone: D², not 1 + D.
        if number is None or symbols is None or value.is_Symbol:
            return f"{formula} {unit}".rstrip()
        if symbols != 1:
            unit = f"{symbols} {unit}".rstrip().replace("**", "^")
        # Constants of materials have few digits, and results of numerics no more than these.
        if scale.si or value.has(sp.Float):
            return scale.digits(number, unit, TABLE_DIGITS)
        digits = scale.digits(number, unit)
        factor = value / symbols
        if factor.is_Rational:
            # A fraction says all that its digits say, but for an error.
            short = len(str(factor)) <= FRACTION and not number.error
            return formula if short else digits
        if len(formula) > LONG:
            return digits
        return f"{formula} ≈ {digits}"

    def latex(self, scale: Scale) -> str:
        """The row as an equation: the exact value, or digits with their error if that is known."""
        if self.estimate is None or math.isnan(self.estimate.error):
            return latex.row(self.symbol, self.value)
        digits = self.estimate.latex()
        # An estimate is a number of units of length where the spacing is a symbol: (1.41 ± 0.01) D.
        unit = scale.symbols(self.value)
        if unit is None or unit == 1:
            return f"{self.symbol} = {digits}"
        return rf"{self.symbol} = \left({digits}\right) {sp.latex(unit)}"


def rows_of(result: Any, **labels: str) -> list[Row]:
    """Make rows of several attributes of a result, whose labels are given by name."""
    return [Row.of(result, name, label) for name, label in labels.items()]


def attempt(read: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a call, or the `InputError` that it raises."""
    try:
        return read(*arguments)
    except InputError as fault:
        return fault


Values = dict[str, Any]
Made = Iterable[str]
"""Lines that take long to print: a generator makes them when they are printed, once."""

Shows = list[Shown | Made]
"""Results, and lines of equations, that stand in LaTeX."""

Lines = list["Row | str | Answer | Made"]
"""Rows, lines of text, and parts of an answer."""


@dataclass(frozen=True)
class Answer:
    """The result of a command, or a part of one.

    Parameters
    ----------
    head : mapping
        JSON of the chain and the settings; expressions become strings when they are printed.
    rows : sequence of Row, str, Answer or generator
        Results, lines of text (or a generator of them), and parts, in the order of the text.
    scale : Scale
        Units of the numbers.
    shown : sequence of Shown or generator
        Results, or generators of equations, that stand in LaTeX before those of the rows.
    errors : str
        Meaning of ±, printed below rows with an error.
    notes : sequence of str
        Sentences on the validity of the numbers.
    key : str
        Name in JSON, of a part.
    """

    head: Mapping[str, Any]
    rows: Sequence[Row | str | Answer | Made]
    scale: Scale = UNITLESS
    shown: Sequence[Shown | Made] = ()
    errors: str = ""
    notes: Sequence[str] = ()
    key: str = ""

    def json(self) -> str:
        """The text that ``--format json`` prints."""
        # Expressions are printed so that SymPy reads them again.
        return json.dumps(self.document(), indent=2, default=str)

    def document(self) -> Values:
        """The answer as an object of JSON.

        Names ending in ``_value`` are floats. Where the spacing is a symbol, it is the unit of
        length of these floats. A symbol of the wave's size has the value 1 in them: ``V_s = 1``,
        ``F = 1`` and ``B = 1``, or ``B = -1`` if B is negative. Values with other symbols, complex
        numbers and numbers beyond a double have no such float. The notes include the reasons of
        missing values.
        """
        result = dict(self.head)
        units: Values = {}
        notes = [*self.notes]
        for row in self.rows:
            if isinstance(row, Answer):
                result[row.key] = row.document()
            elif isinstance(row, Row) and row.key:
                if row.unit:
                    # The entries "_value" and "_error_value" of a row have one unit.
                    _put(units, row.key, "", row.unit)
                if isinstance(row.value, InputError):
                    notes.append(str(row.value))
                for ending, value in row.entries(self.scale).items():
                    _put(result, row.key, ending, value)
        if self.scale.si:
            result["units"] = units
        if notes:
            # Several values may be missing for one reason.
            result["notes"] = list(dict.fromkeys(notes))
        return result

    def text(self) -> str:
        """The lines that ``--format text`` prints; a formula is one line, which can be copied."""
        lines = []
        for row in self.rows:
            if isinstance(row, Answer):
                lines.append(row.text())
            elif isinstance(row, str):
                lines.append(row)
            elif not isinstance(row, Row):
                lines += row
            elif row.label:
                lines.append(f"  {row.text(self.scale)}")
        # The meaning of ± is said once, below the rows, and only if a row holds a ±.
        if self.errors and "±" in "".join(lines):
            lines.append(f"±: {self.errors}; at least one in the last digit shown")
        for note in self.notes:
            lines += ["", f"Note: {note}"]
        return "\n".join(lines)

    def latex(self) -> str:
        """The display that ``--format latex`` prints, units and notes as comments behind it."""
        # A row may be among those of a result.
        lines = [latex.align(list(dict.fromkeys(self._equations())))]
        if self.scale.si:
            lines.append("% numbers are in SI: m, s, kg, N, rad")
        lines += [f"% {note}" for note in self.notes]
        return "\n".join(lines)

    def _equations(self) -> Iterator[str]:
        """LaTeX of the results shown and of the rows with a symbol, one equation each."""
        for result in self.shown:
            yield from result.latex_rows() if isinstance(result, Shown) else result
        for row in self.rows:
            if isinstance(row, Answer):
                yield from row._equations()
            elif isinstance(row, Row) and row.symbol:
                yield row.latex(self.scale)


def _put(result: Values, key: str, ending: str, value: Any) -> None:
    """Set ``result[key + ending]``, or an entry of that mapping for a key with a dot.

    The key "fwhm.force" with the ending "_value" is the entry "force" of "fwhm_value".
    """
    group, dot, entry = key.partition(".")
    if dot:
        result.setdefault(group + ending, {})[entry] = value
    else:
        result[group + ending] = value
