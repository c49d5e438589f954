"""Source text of programs: functions for β, widths, speed, amplitude and profile of compact waves.

SymPy's printers write the expressions; a table has what they leave out, the lines about them. All
numbers are doubles. Widths and ``ln V²`` are written in forms that keep their digits as k → 1.
Relative errors are 1e-14, with three ill-conditioned exceptions. The amplitude's exponent
``2/(k-1)`` makes each rounding ``|ln B|`` times larger. Near the edge of the domain of waves, where
(G + H + I)/D² or ``f = V²/B^{k-1}`` is small, terms cancel: errors are 1e-14/f, as is the change by
the last digit of k or of a mass. Near the end of the support the last digit of ξ does the same: the
profile is right to 1e-14 B at a ξ off by 1e-14 ξ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.numpy import NumPyPrinter

from lwa.base.exact import InputError, shorten
from lwa.base.frozen import QUANTITIES, strain_power
from lwa.base.words import LanguageName, one_of
from lwa.law import Power
from lwa.wave.arch import Arch


@dataclass(frozen=True)
class Function:
    """A function of a program.

    Parameters
    ----------
    name, doc : str
        Name, and one line that says what the function returns.
    arguments : tuple of Symbol
        Arguments in their order.
    value : Basic
        The value, an expression in the arguments, which may call functions before this one.
    """

    name: str
    doc: str
    arguments: tuple[sp.Symbol, ...]
    value: sp.Basic


@dataclass(frozen=True)
class Language:
    """A programming language: SymPy's printer, and the lines of a module and of a function.

    A new language is an entry of `LANGUAGES`, and a word of `lwa.base.words.LanguageName`.

    Parameters
    ----------
    printer : type
        SymPy's printer of expressions.
    comment : str
        Beginning of a comment.
    head : tuple of str
        First lines of a module.
    function : str
        A function, with the fields ``name``, ``doc``, ``arguments``, ``entry`` and ``value``.
    argument : str
        An argument in the function's head.
    entry : str
        First line of the body of a function that has ``arguments``.
    reserved : frozenset of str
        Names that a symbol may not have, besides those that the printer knows.
    settings : mapping
        Settings of the printer.
    """

    printer: Any
    comment: str
    head: tuple[str, ...]
    function: str
    argument: str = "{}"
    entry: str = ""
    reserved: frozenset[str] = frozenset()
    settings: Mapping[str, Any] = field(default_factory=dict)


LANGUAGES: Mapping[LanguageName, Language] = {
    "numpy": Language(
        NumPyPrinter,
        "#",
        ("import numpy as np",),
        '''

def {name}({arguments}):
    """{doc}"""
{entry}    return {value}''',
        # powers of integers overflow
        entry="    {arguments}, = map(np.float64, ({arguments},))\n",
        reserved=frozenset({"np"}),
    ),
    "c": Language(
        C99CodePrinter,
        "//",
        ("#include <math.h>",),
        """
// {doc}
double {name}({arguments})
{{
    return {value};
}}""",
        argument="double {}",
        settings={"math_macros": {}},  # M_LN2 and its like are no part of C99
    ),
    "javascript": Language(
        JavascriptCodePrinter,
        "//",
        (),
        """
// {doc}
function {name}({arguments}) {{
    return {value};
}}""",
        reserved=frozenset({"Math"}),
        settings={
            "user_functions": {name: f"Math.{name}" for name in ("sinh", "asinh")}
        },
    ),
}
"""Language by the name that `lwa.CompactWave.code` takes."""

_EXACT = 2**53  # a double holds integers up to this one


def module(
    functions: Sequence[Function], language: LanguageName, title: Sequence[str]
) -> str:
    """Write the source text of functions.

    Symbols keep their names, with underscores behind those that are words of the language.

    Parameters
    ----------
    functions : sequence of Function
        The functions; each may call those before it.
    language : {"numpy", "c", "javascript"}
        A key of `LANGUAGES`.
    title : sequence of str
        Lines of the comment at the top.

    Raises
    ------
    InputError
        For other languages, and for symbols that are no names.
    """
    syntax = LANGUAGES[one_of(language, LANGUAGES, "language")]
    # The functions call each other by their own names, which the printer must not translate.
    calls = {f.name: f.name for f in functions}
    known = syntax.settings.get("user_functions", {})
    printer = syntax.printer({**syntax.settings, "user_functions": {**known, **calls}})
    taken = {*calls, *syntax.reserved, *printer.reserved_words}
    names = _names(functions, taken)

    def text(value: sp.Basic) -> str:
        """Write an expression in the language."""
        new: dict[sp.Basic, sp.Basic] = {**names}
        for number in value.atoms(sp.Rational, sp.NumberSymbol):
            # Printers write π, and long integers, in ways that C does not know.
            if number.is_NumberSymbol or max(abs(number.p), number.q) > _EXACT:
                new[number] = sp.Float(number, 17)
        written = str(printer.doprint(value.xreplace(new)))
        # SymPy's printer writes the module's full name.
        return written.replace("numpy.", "np.")

    lines = [f"{syntax.comment} {line}" for line in title]
    if syntax.head:
        lines += ["", *syntax.head]
    for f in functions:
        listed = ", ".join(syntax.argument.format(names[s]) for s in f.arguments)
        # Without arguments there is nothing to convert to doubles.
        entry = syntax.entry.format(arguments=listed) if listed else ""
        written = syntax.function.format(
            name=f.name, doc=f.doc, arguments=listed, entry=entry, value=text(f.value)
        )
        lines.append(written)
    return "\n".join(lines)


def _names(
    functions: Sequence[Function], taken: set[str]
) -> dict[sp.Symbol, sp.Symbol]:
    """Different names for the symbols of functions; a name in ``taken`` gets underscores."""
    # A dict keeps the order of the arguments and drops repetitions.
    arguments: dict[sp.Symbol, None] = {}
    for f in functions:
        arguments |= dict.fromkeys(f.arguments)
    # ξ, B, V_s and F keep their names: a symbol of the chain that has one of these yields.
    ordered = sorted(arguments, key=lambda symbol: symbol not in _ARGUMENTS)
    names = {}
    for symbol in ordered:
        name = symbol.name
        if not name.isidentifier():
            raise InputError(f"{shorten(name)} is no name of a variable in a program")
        while name in taken:
            name += "_"
        taken.add(name)
        names[symbol] = sp.Symbol(name)
    return names


_XI = sp.Dummy("xi", real=True)
_B = sp.Dummy("B", positive=True)
_V = sp.Dummy("V_s", positive=True)
_F = sp.Dummy("F", positive=True)
_ARGUMENTS = (_XI, _B, _V, _F)  # arguments that are no symbols of the chain


TITLE = (
    "The compact traveling wave v = u_x = B cos^m(beta xi), m = 2/(k - 1),",
    "xi = x - V_s tau, |xi| <= pi/(2 beta), written by lwa. There is one where",
    "k > 1, G + H + I > 0 and V_s^2 > 0, which is not checked here.",
)


class Functions(dict[str, Function]):
    """Functions by name, whose arguments are ξ, B, V_s, F and the symbols of the given parts.

    Arguments stand in this order, those of a part by name, each where it is used.

    Parameters
    ----------
    *parts : Expr
        Expressions whose symbols are arguments.
    """

    def __init__(self, *parts: sp.Expr) -> None:
        super().__init__()
        # Each symbol once, in the order of the parts, those of one part by name
        ordered: dict[sp.Symbol, None] = {}
        for part in parts:
            ordered |= dict.fromkeys(sorted(part.free_symbols, key=str))
        self.symbols = tuple(ordered)

    def define(self, name: str, doc: str, value: sp.Basic) -> sp.Expr:
        """Add a function and return a call of it."""
        used = value.free_symbols
        arguments = tuple(s for s in (*_ARGUMENTS, *self.symbols) if s in used)
        self[name] = Function(name, doc, arguments, value)
        return sp.Function(name)(*arguments)


def wave_functions(wave: Arch) -> Functions:
    """Functions for β, width, FWHM, speed, amplitude and profile of a compact wave.

    The arguments of the functions are ξ, B, V_s, F and the symbols of k, of the masses, of the
    stiffnesses and of the spacing.

    Parameters
    ----------
    wave : Arch
        The wave, with rational functions of k and the masses for the sum of its coefficients and
        its speed factor.
    """
    k = wave.k
    cell = wave.cell
    D = cell.spacing
    functions = Functions(k, *cell.masses, *cell.stiffnesses, D, wave.coefficient_sum)
    define = functions.define
    # f - 1 of the speed factor f, for ln f below
    excess = sp.factor(sp.cancel(wave.speed_factor - 1))
    total = define("coefficient_sum", "(G + H + I)/D^2", wave.coefficient_sum)
    factor = define("speed_factor", "V_s^2/B^(k - 1)", wave.speed_factor)
    beta = define(
        "beta", "beta = (k - 1)/(2 sqrt(G + H + I))", (k - 1) / (2 * D * sp.sqrt(total))
    )
    define("width", "Length of the support, pi/beta", sp.pi / beta)
    for quantity in QUANTITIES:
        # arccos(2^-x) = arctan √(4^x - 1), in a form that keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        angle = sp.atan(sp.sqrt(2 ** (x + 1) * sp.sinh(x * sp.log(2))))
        doc = f"Full width at half maximum of the {quantity}"
        define(f"fwhm_{quantity}", doc, 2 * angle / beta)
    speed = define(
        "speed",
        "V_s = dx/dtau of the wave whose strain peaks at B",
        sp.sqrt(factor) * _B ** ((k - 1) / 2),
    )
    # ln f = 2 arsinh((f-1)/(2√f)) keeps its digits as f → 1, that is as k → 1
    log_factor = define(
        "log_speed_factor",
        "ln(V_s^2/B^(k - 1))",
        2 * sp.asinh(excess / (2 * sp.sqrt(factor))),
    )
    define(
        "amplitude",
        "B, the peak strain of the wave of speed V_s",
        _V ** (2 / (k - 1)) * sp.exp(-log_factor / (k - 1)),
    )
    # cos(βξ) on the support and 0 outside of it is sin((h + |h|)/2)
    inside = define(
        "inside",
        "h = pi/2 - |beta xi|, positive on the support",
        sp.pi / 2 - sp.Abs(beta * _XI),
    )
    define(
        "profile",
        "v at xi, 0 outside of the support",
        _B * sp.sin((inside + sp.Abs(inside)) / 2) ** (2 / (k - 1)),
    )
    # Without load there is no strain ahead, so that B follows from F alone.
    scale = define("time_scale", "tau/t: dx/dt = V_s tau/t", cell.time_scale(k))
    strain = define(
        "strain",
        "B of the wave whose contact force peaks at F",
        Power(k).compression(cell, _F) / D,
    )
    define(
        "speed_at_force",
        "dx/dt, in m/s for a chain in SI, of the wave whose force peaks at F",
        speed.subs(_B, strain) * scale,
    )
    return functions
