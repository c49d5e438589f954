"""Functions of real numbers as source text: the base of all languages, on SymPy's code printers.

All numbers are doubles: integers and fractions stand as they are where a double holds their parts
exactly, and as the nearest double elsewhere. Symbols keep their names where the language allows.
Where it does not (reserved words, letters beyond ASCII, names that the module has given already, in
Fortran names that differ by case only) they are spelled in ASCII, with underscores behind, and a
comment says so.
"""

from __future__ import annotations

import math
import re
import sys
import unicodedata
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from lwa.base.exact import InputError, shorten

WIDTH = 79
_LONGEST_NAME = 31  # significant letters of an external name in C99

Local = tuple[tuple[sp.Symbol, sp.Expr], ...]
"""Variables and their values."""


@dataclass(frozen=True)
class Function:
    """A function: its value as an expression in its arguments and in ``local`` variables."""

    name: str
    doc: str
    arguments: tuple[sp.Symbol, ...]
    value: sp.Basic
    local: Local = ()

    @property
    def call(self) -> sp.Expr:
        """A call with the function's own arguments, for the value of another function."""
        return sp.Function(self.name)(*self.arguments)


class Writer(ABC):
    """Base of the languages, each of which also derives from one of SymPy's printers."""

    comment: ClassVar[str] = "#"
    indent: ClassVar[str] = "    "
    gap: ClassVar[int] = 1  # empty lines between functions
    reserved: ClassVar[frozenset[str]] = frozenset()
    ignores_case: ClassVar[bool] = False
    head: ClassVar[tuple[str, ...]] = ()
    tail: ClassVar[tuple[str, ...]] = ()
    point: ClassVar[str] = ""  # suffix that makes an integer a double
    power: ClassVar[str] = "e"  # letter before the power of ten in a literal
    end: ClassVar[str] = ""  # text that ends a statement
    more: ClassVar[str] = ""  # at the end of a line that the next one continues
    settings: ClassVar[dict[str, Any]] = {}

    def __init__(self, functions: Sequence[Function], own: Sequence[sp.Symbol] = ()) -> None:
        """Choose names for all symbols; the symbols ``own`` keep theirs before others."""
        super().__init__(dict(self.settings))  # type: ignore[call-arg]  # SymPy's
        self.functions = functions
        self.names: dict[sp.Symbol, str] = {symbol: symbol.name for symbol in own}
        self.renamed: dict[str, str] = {}
        taken = {
            self._folded(name) for name in (*self.names.values(), *(f.name for f in functions))
        }
        for symbol in dict.fromkeys(s for f in functions for s in f.arguments if s not in own):
            name = self._free(symbol.name, taken)
            self.names[symbol] = name
            if name != symbol.name:
                self.renamed[name] = symbol.name
        for function in functions:
            used = set(taken)
            self.names |= {symbol: self._free(symbol.name, used) for symbol, _ in function.local}

    def module(self, title: Sequence[str]) -> str:
        """The source text, without a newline at its end."""
        notes = [f"{name} is the symbol {shorten(given)}" for name, given in self.renamed.items()]
        lines = [f"{self.comment} {line}" for line in (*title, *notes)]
        lines += ["", *self.head] if self.head else []
        for function in self.functions:
            lines += [*[""] * self.gap, *self.function(function)]
        return "\n".join([*lines, *self.tail])

    @abstractmethod
    def function(self, function: Function) -> list[str]:
        """Source lines of a function."""

    def text(self, value: sp.Basic) -> str:
        """The text of a value, on one line."""
        return str(self.doprint(value))  # type: ignore[attr-defined]  # SymPy's

    def arguments(self, function: Function, kind: str = "") -> str:
        """The names of a function's arguments, each after the word ``kind``."""
        return ", ".join(kind + self.names[s] for s in function.arguments)

    def statements(self, function: Function, define: str, result: str) -> list[str]:
        """Statements for the local variables, after ``define``, and the value, after ``result``."""
        rows = [(f"{define}{self.names[symbol]} = ", value) for symbol, value in function.local]
        return [line for row in (*rows, (result, function.value)) for line in self._line(*row)]

    def _line(self, start: str, value: sp.Basic) -> list[str]:
        text = self.text(value)
        line = f"{self.indent}{start}{text}{self.end}"
        if len(line) > WIDTH and text[0] != "{":
            line = f"{self.indent}{start}({text}){self.end}"
        return wrapped(line, self.more)

    @classmethod
    def _folded(cls, name: str) -> str:
        return name.lower() if cls.ignores_case else name

    def _allows(self, name: str) -> bool:
        return name not in self.reserved

    def _free(self, given: str, taken: set[str]) -> str:
        """A free name for the symbol called ``given``, which is added to ``taken``."""
        name = _ascii(given)
        while not self._allows(self._folded(name)) or self._folded(name) in taken:
            name += "_"
        taken.add(self._folded(name))
        return name

    def _print_Symbol(self, symbol: sp.Symbol) -> str:
        return self.names[symbol]

    _print_Dummy = _print_Symbol

    def parenthesize(self, item: sp.Basic, level: int, strict: bool = False) -> str:
        """Parenthesize as SymPy does, except fractions that are one literal."""
        one = item.is_Rational and item.p > 0 and "/" not in self.text(item)
        return str(super().parenthesize(item, 0 if one else level, strict))  # type: ignore[misc]  # SymPy's

    def _print_AppliedUndef(self, call: sp.Expr) -> str:
        return f"{call.func.__name__}({', '.join(map(self._print, call.args))})"  # type: ignore[attr-defined]  # SymPy's

    def _print_Rational(self, number: sp.Rational) -> str:
        p, q = int(number.p), int(number.q)
        if max(abs(p), q) <= 2**sys.float_info.mant_dig and (q == 1 or q & (q - 1)):
            return f"{p}{self.point}" + (f"/{q}{self.point}" if q > 1 else "")
        mantissa, _, power = repr(_nearest(p, q)).partition("e")
        return mantissa + (f"{self.power}{power or 0}" if power or self.power == "d" else "")

    _print_Integer = _print_Half = _print_Rational

    def _format_code(self, lines: list[str]) -> list[str]:
        return lines


def wrapped(line: str, more: str = "") -> list[str]:
    """Break a statement into lines of at most 79 characters; all but the last end in ``more``.

    A line breaks inside as few brackets as possible, after a comma, a sum's sign or another
    operator; the next line is indented to the start of the innermost bracket.

    >>> wrapped("def beta(" + "k, " * 25 + "m):")[1]
    '         k, k, m):'
    """
    lines, start, column, brackets = [], 0, 0, list[int]()
    while column + len(line) - start > WIDTH:
        cuts: list[tuple[float, int, list[int]]] = []  # the best is the least
        opened = list(brackets)
        for i in range(start, start + WIDTH - len(more) - column + 1):
            if i > start and _breaks(line, i):
                tight = 0.0 if line[i - 1] == " " else 0.5
                cuts.append((len(opened) + tight, -i, list(opened)))
            if line[i] in "([{":
                opened.append(column + i - start + 1)
            elif line[i] in ")]}" and opened:
                opened.pop()
        if not cuts:
            break
        _, cut, brackets = min(cuts)
        lines.append(" " * column + line[start:-cut].rstrip() + more)
        start, column = -cut, brackets[-1] if brackets else len(line) - len(line.lstrip()) + 4
    return [*lines, " " * column + line[start:]]


def _breaks(line: str, i: int) -> bool:
    if line[i - 1] == " ":
        return line[i - 2] in ",+-" and line[i] != " "
    return line[i - 1] in "*/" and line[i] != "*" and (line[i - 1] == "/" or line[i - 2] != "*")


def _ascii(name: str) -> str:
    """Spell a name in ASCII letters, digits and underscores: mu1 for μ1."""
    spelled = "".join(c if re.fullmatch("[A-Za-z0-9_]", c) else _letter(c) for c in name)
    return (spelled if spelled[:1].isalpha() else f"x{spelled}")[:_LONGEST_NAME]


def _letter(c: str) -> str:
    words = unicodedata.name(c, "").replace("LAMDA", "LAMBDA").split()
    if words[:1] != ["GREEK"]:
        return "_"
    return words[-1].capitalize() if "CAPITAL" in words else words[-1].lower()


def _nearest(p: int, q: int) -> float:
    """The double nearest to p/q; raise `lwa.InputError` beyond the range of doubles."""
    try:
        value = p / q
    except OverflowError:
        value = math.inf
    if not sys.float_info.min <= abs(value) < math.inf:
        raise InputError(f"{shorten(sp.Rational(p, q))} is beyond the numbers of a program")
    return value
