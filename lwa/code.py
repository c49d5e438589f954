"""Functions of real numbers as source text in several languages, on SymPy's code printers.

All numbers are doubles: integers and fractions stand as they are where a double holds their parts
exactly, and as the nearest double elsewhere.

Symbols keep their names if these are a letter, Latin or Greek (written as nu), with digits or an
underscore behind. Other names, which may be words of the language, and names that the module has
given already (in Fortran also by case only) are spelled in ASCII with underscores behind, and a
comment says so.
"""

from __future__ import annotations

import math
import re
import sys
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp
from sympy.core.alphabets import greeks
from sympy.printing.c import C99CodePrinter
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.fortran import FCodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.numpy import NumPyPrinter
from sympy.printing.precedence import PRECEDENCE

from lwa.base.exact import InputError, shorten
from lwa.base.lines import wrapped

WIDTH = 79

# No word of a language has this form but for lambda, and macros of C such as M_PI
_FREE_NAME = re.compile(
    rf"(?!M_[A-Z]|lambda$)([A-Z]|{'|'.join(greeks)})([0-9_]\w*)?", re.IGNORECASE
)

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
        """Symbolic call of this function, name(arguments), for use in another function's value."""
        return sp.Function(self.name)(*self.arguments)


class Writer:
    """Base class of the writers of source text; those also derive from SymPy's printers."""

    comment: ClassVar[str] = "#"
    head: ClassVar[tuple[str, ...]] = ()  # lines of a module before its functions
    tail: ClassVar[tuple[str, ...]] = ()
    opening: ClassVar[tuple[str, ...]] = ()  # lines of a function before its statements
    closing: ClassVar[tuple[str, ...]] = ()
    gap: ClassVar[int] = 1  # empty lines between functions
    indent: ClassVar[str] = "    "
    define: ClassVar[str] = ""  # before the name of a local variable
    end: ClassVar[str] = ""  # text that ends a statement
    more: ClassVar[str] = ""  # at the end of a line that the next one continues
    point: ClassVar[str] = ""  # suffix that makes an integer a double
    power: ClassVar[str] = "e"  # letter before the power of ten in a literal
    ignores_case: ClassVar[bool] = False
    settings: ClassVar[dict[str, Any]] = {}  # of SymPy's printer

    def __init__(self, functions: Sequence[Function], first: Sequence[sp.Symbol] = ()) -> None:
        """Choose names for all symbols; the symbols ``first`` before others."""
        super().__init__(dict(self.settings))  # type: ignore[call-arg]  # SymPy's
        self.functions = functions
        self.names: dict[sp.Symbol, str] = {symbol: symbol.name for symbol in first}
        self.renamed: dict[str, str] = {}
        taken = {self._folded(n) for n in (*self.names.values(), *(f.name for f in functions))}
        for symbol in dict.fromkeys(s for f in functions for s in f.arguments if s not in first):
            name = self.names[symbol] = self._free(symbol.name, taken)
            if name != symbol.name:
                self.renamed[name] = symbol.name
        for function in functions:
            used = set(taken)
            self.names |= {symbol: self._free(symbol.name, used) for symbol, _ in function.local}

    def module(self, title: Sequence[str]) -> str:
        """Source text with comments ``title``, without a newline at its end."""
        notes = [f"{name} is the symbol {shorten(given)}" for name, given in self.renamed.items()]
        lines = [f"{self.comment} {line}" for line in (*title, *notes)]
        lines += ["", *self.head] if self.head else []
        for function in self.functions:
            lines += [*[""] * self.gap, *self.function(function)]
        return "\n".join([*lines, *self.tail])

    def function(self, function: Function) -> list[str]:
        """Source lines of a function."""
        words = {"name": function.name, "doc": function.doc} | self.words(function)
        lines = [part for line in self.opening for part in self.wrapped(line.format(**words))]
        lines += self.entry(function)
        for symbol, value in function.local:
            lines += self._statement(f"{self.define}{self.names[symbol]} =", value)
        lines += self._statement(self.result(function), function.value)
        return [*lines, *(line.format(**words) for line in self.closing)]

    def words(self, function: Function) -> dict[str, str]:
        """Values of the fields in the lines ``opening`` and ``closing``, besides name and doc."""
        return {"arguments": self.arguments(function)}

    def arguments(self, function: Function, kind: str = "") -> str:
        """The names of a function's arguments, each after the word ``kind``."""
        return ", ".join(kind + self.names[s] for s in function.arguments)

    def entry(self, function: Function) -> list[str]:
        """Statements before those for the local variables and the value."""
        return []

    def result(self, function: Function) -> str:
        """Return the text before the value of a function."""
        return "return"

    def text(self, value: sp.Basic) -> str:
        """The text of a value, on one line."""
        return str(self.doprint(value))  # type: ignore[attr-defined]  # SymPy's

    def _statement(self, start: str, value: sp.Basic) -> list[str]:
        text = self.text(value)
        line = f"{self.indent}{start} {text}{self.end}"
        if len(line) > WIDTH and text[0] != "{":
            line = f"{self.indent}{start} ({text}){self.end}"
        return self.wrapped(line)

    @classmethod
    def wrapped(cls, line: str) -> list[str]:
        """Break a line into lines of at most 79 characters; all but the last end in ``more``.

        >>> NumPy.wrapped("def beta(" + "k, " * 25 + "m):")[1]
        '        k, k, m):'
        """
        return wrapped(line, WIDTH, cls.more)

    def _folded(self, name: str) -> str:
        return name.lower() if self.ignores_case else name

    def _free(self, given: str, taken: set[str]) -> str:
        """A free name for the symbol called ``given``, which is added to ``taken``."""
        name = "".join(c if re.fullmatch("[A-Za-z0-9_]", c) else _letter(c) for c in given)
        name = (name if name[:1].isalpha() else f"x{name}")[:31]  # significant letters in C99
        name += "" if _FREE_NAME.fullmatch(name) else "_"
        while self._folded(name) in taken:
            name += "_"
        taken.add(self._folded(name))
        return name

    def _print_Symbol(self, symbol: sp.Symbol) -> str:
        return self.names[symbol]

    _print_Dummy = _print_Symbol

    def parenthesize(self, item: sp.Basic, level: int, strict: bool = False) -> str:
        """Parenthesize as SymPy does, but no positive number that is one literal, such as 0.5."""
        literal = item.is_Rational and item.p > 0 and "/" not in self.text(item)
        return str(super().parenthesize(item, 0 if literal else level, strict))  # type: ignore[misc]  # SymPy's

    def _print_AppliedUndef(self, call: sp.Expr) -> str:
        return f"{call.func.__name__}({', '.join(map(self._print, call.args))})"  # type: ignore[attr-defined]  # SymPy's

    def _print_Rational(self, number: sp.Rational) -> str:
        p, q = int(number.p), int(number.q)
        # a quotient of doubles is the nearest double to p/q, and a power of two divides exactly
        if max(abs(p), q) <= 2**sys.float_info.mant_dig and (q == 1 or q & (q - 1)):
            return f"{p}{self.point}" + (f"/{q}{self.point}" if q > 1 else "")
        mantissa, _, power = repr(_nearest(p, q)).partition("e")
        return mantissa + (f"{self.power}{power or 0}" if power or self.power == "d" else "")

    _print_Integer = _print_Half = _print_Rational

    def _format_code(self, lines: list[str]) -> list[str]:
        return lines


def _letter(c: str) -> str:
    """Spelling of a Greek letter, such as mu for μ; an underscore for others."""
    words = unicodedata.name(c, "").split()
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


class NumPy(Writer, NumPyPrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Python functions of numbers, or of arrays that broadcast, by NumPy."""

    gap = 2
    head = ("import numpy as np",)
    opening = ("def {name}({arguments}):", '    """{doc}"""')

    def entry(self, function: Function) -> list[str]:
        """Convert the arguments to floats, as powers of NumPy's integers overflow."""
        names = self.arguments(function)
        if len(function.arguments) < 2:
            return [f"    {names} = np.float64({names})"] if names else []
        line = f"    {names} = map(np.float64, ({names}))"
        return self.wrapped(line if len(line) <= WIDTH else line.replace(names, f"({names})", 1))

    def text(self, value: sp.Basic) -> str:
        return super().text(value).replace("numpy.", "np.")


class C(Writer, C99CodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of C99 functions, by <math.h>."""

    comment = "//"
    head = ("#include <math.h>",)
    opening = ("// {doc}", "double {name}({arguments})", "{{")
    closing = ("}}",)
    define, end, point = "const double ", ";", ".0"
    settings: ClassVar[dict[str, Any]] = {"math_macros": {}}

    def words(self, function: Function) -> dict[str, str]:
        return {"arguments": self.arguments(function, "double ") or "void"}

    def _print_Pi(self, number: sp.Expr) -> str:
        return repr(math.pi)


class Fortran(Writer, FCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Fortran 2008 in free form, by the intrinsic functions."""

    comment = "!"
    head = (
        "module lwa_wave",
        "    implicit none",
        "    integer, parameter, private :: dp = kind(1d0)",
        "contains",
    )
    tail = ("end module lwa_wave",)
    opening = ("    ! {doc}", "    {kind} real(dp) function {name}({arguments})")
    closing = ("    end function {name}",)
    indent, more, point, power = "        ", " &", "d0", "d"
    ignores_case = True
    settings: ClassVar[dict[str, Any]] = {
        "source_format": "free",
        "standard": 2008,
        "user_functions": {"asinh": "asinh"},
    }

    def words(self, function: Function) -> dict[str, str]:
        kind = "elemental" if function.arguments else "pure"
        return {"arguments": self.arguments(function), "kind": kind}

    def entry(self, function: Function) -> list[str]:
        """Declare the arguments and the local variables."""
        local = ", ".join(self.names[symbol] for symbol, _ in function.local)
        declared = [f"real(dp), intent(in) :: {self.arguments(function)}"]
        declared = declared * bool(function.arguments) + [f"real(dp) :: {local}"] * bool(local)
        return [line for d in declared for line in self.wrapped(self.indent + d)]

    def result(self, function: Function) -> str:
        return f"{function.name} ="

    def _print_Pi(self, number: sp.Expr) -> str:
        return f"{math.pi!r}d0"

    def _print_Pow(self, power: sp.Pow) -> str:
        base = self.parenthesize(power.base, PRECEDENCE["Pow"])
        if power.exp.is_Integer and power.exp > 1:
            return f"{base}**{power.exp}"  # not x**2d0, which wants x > 0
        if power.exp == sp.S.Half:
            return f"sqrt({self._print(power.base)})"
        return str(super()._print_Pow(power))

    _print_Function = CodePrinter._print_Function  # SymPy's own rounds constant arguments


class JavaScript(Writer, JavascriptCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of JavaScript functions of numbers, by `Math`, for pages and modules."""

    comment = "//"
    opening = ("// {doc}", "function {name}({arguments}) {{")
    closing = ("}}",)
    define, end = "const ", ";"

    def _print_sinh(self, call: sp.Expr) -> str:
        return f"Math.{call.func.__name__}({self._print(call.args[0])})"

    _print_asinh = _print_sinh


LANGUAGES: dict[str, type[Writer]] = {
    "numpy": NumPy,
    "c": C,
    "fortran": Fortran,
    "javascript": JavaScript,
}
"""Language by the name that `lwa.TravelingWave.code` takes."""
