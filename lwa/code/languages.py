"""Python, NumPy, C, Fortran, Julia and JavaScript: SymPy's printers with frames of functions."""

from __future__ import annotations

import keyword
import math
import re
from typing import Any, ClassVar

import sympy as sp
from sympy.printing.c import C99CodePrinter, reserved_words, reserved_words_c99
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.fortran import FCodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.julia import JuliaCodePrinter
from sympy.printing.numpy import NumPyPrinter
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.pycode import PythonCodePrinter

from lwa.code.writer import WIDTH, Function, Writer, wrapped

_MATHEMATICS = frozenset({"abs", "atan", "asinh", "exp", "log", "pow", "sin", "sinh", "sqrt"})
_NEWER_C = re.findall(
    r"\w+",
    "alignas alignof asm bool constexpr false i386 linux nullptr static_assert thread_local true "
    "typeof typeof_unqual unix",
)
_JULIA = re.findall(
    r"\w+",
    "baremodule begin break catch const continue do else elseif end export false finally for "
    "function global if import in isa let local macro module outer pi quote return struct true "
    "try using where while",
)

_JAVASCRIPT = re.findall(
    r"\w+",
    "Math arguments async await break case catch class const continue debugger default delete do "
    "else enum eval export extends false finally for function if implements import in instanceof "
    "interface let new null of package private protected public return static super switch this "
    "throw true try typeof undefined var void while with yield",
)


class Python(Writer, PythonCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Python functions of numbers, by the module `math`."""

    gap = 2
    reserved = frozenset({*keyword.kwlist, "abs", "math", "l", "O", "I"})  # I, l, O: PEP 8
    head = ("import math",)

    def function(self, function: Function) -> list[str]:
        """Generate the source lines that define a function in this language."""
        return [
            *wrapped(f"def {function.name}({self.arguments(function)}):"),
            f'    """{function.doc}"""',
            *self.entry(function),
            *self.statements(function, "", "return "),
        ]

    def entry(self, function: Function) -> list[str]:
        """Statements that prepare the arguments."""
        return []


class NumPy(Python, NumPyPrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Python functions of arrays that broadcast, by NumPy."""

    reserved = Python.reserved - {"math"} | {"np", "map"}
    head = ("import numpy as np",)

    def entry(self, function: Function) -> list[str]:
        """Convert the arguments to floats, as powers of NumPy's integers overflow."""
        names = self.arguments(function)
        if len(function.arguments) < 2:
            return [f"    {names} = np.float64({names})"] if names else []
        line = f"    {names} = map(np.float64, ({names}))"
        return wrapped(line if len(line) <= WIDTH else line.replace(names, f"({names})", 1))

    def text(self, value: sp.Basic) -> str:
        """The text of a value, on one line."""
        return super().text(value).replace("numpy.", "np.")


class C(Writer, C99CodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of C99 functions, by <math.h>."""

    comment = "//"
    reserved = frozenset({*_MATHEMATICS, "fabs", *reserved_words, *reserved_words_c99, *_NEWER_C})
    head = ("#include <math.h>",)
    point = ".0"
    end = ";"
    settings: ClassVar[dict[str, Any]] = {"math_macros": {}}

    def function(self, function: Function) -> list[str]:
        """Generate the source lines that define a function in this language."""
        arguments = self.arguments(function, "double ") or "void"
        return [
            f"// {function.doc}",
            *wrapped(f"double {function.name}({arguments})"),
            "{",
            *self.statements(function, "const double ", "return "),
            "}",
        ]

    def _allows(self, name: str) -> bool:
        # names in capitals are macros, some of them in <math.h>: FP_NAN, M_PI, M_PIf
        return super()._allows(name) and not re.fullmatch(r"(M_|[A-Z]{2})\w+(?<!_)", name)

    def _print_Pi(self, number: sp.Expr) -> str:
        return repr(math.pi)


class Fortran(Writer, FCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Fortran 2008 in free form, by the intrinsic functions."""

    comment = "!"
    indent = "        "
    reserved = _MATHEMATICS | {"real", "kind", "dp", "lwa_wave"}
    ignores_case = True
    head = (
        "module lwa_wave",
        "    implicit none",
        "    integer, parameter, private :: dp = kind(1d0)",
        "contains",
    )
    tail = ("end module lwa_wave",)
    point = "d0"
    power = "d"
    more = " &"
    settings: ClassVar[dict[str, Any]] = {
        "source_format": "free",
        "standard": 2008,
        "user_functions": {"asinh": "asinh"},
    }

    def function(self, function: Function) -> list[str]:
        """Generate the source lines that define a function in this language."""
        kind = "elemental" if function.arguments else "pure"
        head = f"    {kind} real(dp) function {function.name}({self.arguments(function)})"
        local = ", ".join(self.names[symbol] for symbol, _ in function.local)
        declared = [f"real(dp), intent(in) :: {self.arguments(function)}"]
        declared = declared * bool(function.arguments) + [f"real(dp) :: {local}"] * bool(local)
        return [
            f"    ! {function.doc}",
            *wrapped(head, self.more),
            *(line for d in declared for line in wrapped(self.indent + d, self.more)),
            *self.statements(function, "", f"{function.name} = "),
            f"    end function {function.name}",
        ]

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


class Julia(Writer, JuliaCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of Julia functions of numbers; f.(x, …) broadcasts them."""

    reserved = frozenset({*_MATHEMATICS, *_JULIA})

    def function(self, function: Function) -> list[str]:
        """Generate the source lines that define a function in this language."""
        return [
            f'"{function.doc}"',
            *wrapped(f"function {function.name}({self.arguments(function)})"),
            *self.statements(function, "", "return "),
            "end",
        ]

    def text(self, value: sp.Basic) -> str:
        """The text of a value on one line, with the operators of numbers."""
        text: str = re.sub(r" \.?([*/^]) ", r"\1", super().text(value))
        return text


class JavaScript(Writer, JavascriptCodePrinter):  # type: ignore[misc]  # untyped in SymPy
    """Writer of JavaScript functions of numbers, by `Math`, for pages and modules."""

    comment = "//"
    reserved = frozenset(_JAVASCRIPT)
    end = ";"

    def function(self, function: Function) -> list[str]:
        """Generate the source lines that define a function in this language."""
        return [
            f"// {function.doc}",
            *wrapped(f"function {function.name}({self.arguments(function)}) {{"),
            *self.statements(function, "const ", "return "),
            "}",
        ]

    def _print_asinh(self, call: sp.Expr) -> str:
        return f"Math.asinh({self._print(call.args[0])})"

    def _print_sinh(self, call: sp.Expr) -> str:
        return f"Math.sinh({self._print(call.args[0])})"


LANGUAGES: dict[str, type[Writer]] = {
    "python": Python,
    "numpy": NumPy,
    "c": C,
    "fortran": Fortran,
    "julia": Julia,
    "javascript": JavaScript,
}
"""Language by the name that `lwa.TravelingWave.code` takes."""
