"""Source text of programs: functions for β, widths, speed, amplitude and profile of compact waves.

SymPy's printers write the expressions; a table has what they leave out, the lines about them. All
numbers are doubles. The formulas are written in forms that keep their digits in floating point:
relative errors are 1e-14, with three ill-conditioned exceptions. The amplitude's exponent 2/(k-1)
makes each rounding |ln B| times larger. Near the edge of the domain of waves (G + H + I → 0,
V² → 0) the last digit of k or of a mass changes the result by more. Near the end of the support the
last digit of ξ does: the profile is right to 1e-14 B at a ξ off by 1e-14 ξ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.numpy import NumPyPrinter

from lwa.base.exact import InputError, one_of, shorten
from lwa.base.frozen import QUANTITIES, strain_power
from lwa.law import Power
from lwa.wave.closed import CompactWave

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


@dataclass(frozen=True)
class Language:
    """A language: SymPy's printer, and the lines of a module and of a function.

    opening, closing : lines of a function, with the fields name, doc and arguments.
    entry : line after the opening of a function that has arguments. argument : an argument in the
        opening. statement, result : lines of a variable and of the value.
    reserved : names that a symbol may not have, besides those that the printer knows.
    settings : settings of the printer.
    """

    printer: Any
    comment: str
    head: tuple[str, ...]
    opening: tuple[str, ...]
    entry: str
    closing: tuple[str, ...]
    argument: str
    statement: str
    result: str
    reserved: frozenset[str] = frozenset()
    settings: Mapping[str, Any] = field(default_factory=dict)


LANGUAGES: Mapping[str, Language] = {
    "numpy": Language(
        NumPyPrinter,
        "#",
        ("import numpy as np",),
        ("", "", "def {name}({arguments}):", '    """{doc}"""'),
        "    {arguments}, = map(np.float64, ({arguments},))",  # powers of integers overflow
        (),
        "{}",
        "    {} = {}",
        "    return {}",
        reserved=frozenset({"np"}),
    ),
    "c": Language(
        C99CodePrinter,
        "//",
        ("#include <math.h>",),
        ("", "// {doc}", "double {name}({arguments})", "{{"),
        "",
        ("}}",),
        "double {}",
        "    const double {} = {};",
        "    return {};",
        settings={"math_macros": {}},  # M_LN2 and its like are no part of C99
    ),
    "javascript": Language(
        JavascriptCodePrinter,
        "//",
        (),
        ("", "// {doc}", "function {name}({arguments}) {{"),
        "",
        ("}}",),
        "{}",
        "    const {} = {};",
        "    return {};",
        reserved=frozenset({"Math"}),
        settings={
            "user_functions": {name: f"Math.{name}" for name in ("sinh", "asinh")}
        },
    ),
}
"""Language by the name that `lwa.TravelingWave.code` takes."""

_EXACT = 2**53  # a double holds integers up to this one


def module(functions: Sequence[Function], language: str, title: Sequence[str]) -> str:
    """The source text of functions in one of the `LANGUAGES`, under a comment ``title``.

    Symbols keep their names, with underscores behind those that have another meaning.

    Raises `lwa.InputError` for other languages, and for symbols that are no names.
    """
    words = LANGUAGES[one_of(language, LANGUAGES, "language")]
    calls = {f.name: f.name for f in functions}
    known = words.settings.get("user_functions", {})
    printer = words.printer({**words.settings, "user_functions": {**known, **calls}})
    taken = {*calls, *words.reserved, *printer.reserved_words}
    names: dict[sp.Symbol, sp.Symbol] = {}
    arguments = (s for f in functions for s in f.arguments)
    local = (s for f in functions for s, _ in f.local)
    # The name of a symbol of the chain yields to those of ξ, B, V_s and F.
    ordered = sorted(
        dict.fromkeys(arguments), key=lambda symbol: symbol not in _ARGUMENTS
    )
    for symbol in ordered + list(dict.fromkeys(local)):
        name = symbol.name
        if not name.isidentifier():
            raise InputError(f"{shorten(name)} is no name of a variable in a program")
        while name in taken:
            name += "_"
        taken.add(name)
        names[symbol] = sp.Symbol(name)

    def text(value: sp.Basic) -> str:
        numbers = {
            q: sp.Float(q, 17)
            for q in value.atoms(sp.Rational, sp.NumberSymbol)
            if q.is_NumberSymbol or max(abs(q.p), q.q) > _EXACT
        }
        return str(printer.doprint(value.xreplace({**numbers, **names}))).replace(
            "numpy.", "np."
        )

    lines = [f"{words.comment} {line}" for line in title] + ["", *words.head] * bool(
        words.head
    )
    for f in functions:
        listed = ", ".join(words.argument.format(names[s]) for s in f.arguments)
        fields = {"name": f.name, "doc": f.doc, "arguments": listed}
        entry = (words.entry,) * bool(listed and words.entry)
        lines += [line.format(**fields) for line in (*words.opening, *entry)]
        lines += [words.statement.format(names[s], text(value)) for s, value in f.local]
        lines += [
            words.result.format(text(f.value)),
            *(x.format() for x in words.closing),
        ]
    return "\n".join(lines)


_XI = sp.Dummy("xi", real=True)
_B, _V, _F = (sp.Dummy(name, positive=True) for name in ("B", "V_s", "F"))
_ARGUMENTS = (_XI, _B, _V, _F)  # that are no symbols of the chain

_SHIFT, _INSIDE = (sp.Dummy(name, real=True) for name in ("k_2", "h"))

TITLE = (
    "The compact traveling wave v = u_x = B cos^m(beta xi), m = 2/(k - 1),",
    "xi = x - V_s tau, |xi| <= pi/(2 beta), written by lwa. There is one where",
    "k > 1, G + H + I > 0 and V_s^2 > 0, which is not checked here.",
)


class Functions(dict[str, Function]):
    """Functions by name, whose arguments are ξ, B, V_s, F and the symbols of the given parts.

    Arguments stand in this order, those of a part by name, each where it is used.
    """

    def __init__(self, *parts: sp.Expr) -> None:
        super().__init__()
        ordered = (s for part in parts for s in sorted(part.free_symbols, key=str))
        self.symbols = tuple(dict.fromkeys(ordered))

    def define(
        self, name: str, doc: str, value: sp.Basic, local: Local = ()
    ) -> sp.Expr:
        """Add a function and return a call of it; ``local`` has variables that it may use."""
        used = value.free_symbols
        for symbol, part in reversed(local):
            used |= part.free_symbols if symbol in used else set()
        arguments = tuple(s for s in (*_ARGUMENTS, *self.symbols) if s in used)
        local = tuple(row for row in local if row[0] in used)
        self[name] = Function(name, doc, arguments, value, local)
        return sp.Function(name)(*arguments)


def wave_functions(wave: CompactWave) -> Functions:
    """Functions for β, width, FWHM, speed, amplitude and profile.

    Arguments: ξ, B, V_s, F, the symbols of k, of the masses, of the stiffnesses and of the spacing.
    """
    k, cell, factor = wave.k, wave.cell, wave.speed_factor
    functions = Functions(
        k, *cell.masses, *cell.stiffnesses, wave.D, wave.coefficient_sum
    )
    define = functions.define
    local = {k - 2: _SHIFT}  # value → variable
    S, excess, f = (
        _stable(value, k, local)
        for value in (wave.coefficient_sum, sp.factor(sp.cancel(factor - 1)), factor)
    )
    variables = tuple((symbol, value) for value, symbol in local.items())
    value = (k - 1) / (2 * wave.D * sp.sqrt(S))
    beta = define("beta", "beta = (k - 1)/(2 sqrt(G + H + I))", value, variables)
    define("width", "Length of the support, pi/beta", sp.pi / beta)
    for quantity in QUANTITIES:
        # arccos(2^-x) = arctan √(4^x - 1), in a form that keeps its digits as x → 0
        x = (k - 1) / (2 * strain_power(quantity, k))
        width = 2 * sp.atan(sp.sqrt(2 ** (x + 1) * sp.sinh(x * sp.log(2)))) / beta
        define(
            f"fwhm_{quantity}", f"Full width at half maximum of the {quantity}", width
        )
    value = sp.sqrt(f) * _B ** ((k - 1) / 2)
    speed = define(
        "speed", "V_s = dx/dtau of the wave whose strain peaks at B", value, variables
    )
    # ln f = 2 arsinh((f-1)/(2√f)) keeps its digits as f → 1, that is as k → 1
    value = _V ** (2 / (k - 1)) * sp.exp(
        -2 * sp.asinh(excess / (2 * sp.sqrt(f))) / (k - 1)
    )
    define("amplitude", "B, the peak strain of the wave of speed V_s", value, variables)
    # cos(βξ) on the support and 0 outside of it is sin((h + |h|)/2), h = π/2 - |βξ|
    value = _B * sp.sin((_INSIDE + sp.Abs(_INSIDE)) / 2) ** (2 / (k - 1))
    inside = ((_INSIDE, sp.pi / 2 - sp.Abs(beta * _XI)),)
    define("profile", "v at xi, 0 outside of the support", value, inside)
    scale = define("time_scale", "tau/t: dx/dt = V_s tau/t", cell.time_scale(k))
    value = Power(k).compression(cell, _F) / cell.spacing
    strain = define("strain", "B of the wave whose contact force peaks at F", value)
    doc = "dx/dt, in m/s for a chain in SI, of the wave whose force peaks at F"
    define("speed_at_force", doc, speed.subs(_B, strain) * scale)
    return functions


def _stable(ratio: sp.Expr, k: sp.Expr, local: dict[sp.Expr, sp.Symbol]) -> sp.Expr:
    """Rewrite the sums of a rational expression in powers of k - 2, in which less cancels.

    New variables for powers A^{1/k} are added to ``local``.
    """
    if not k.is_Symbol:
        return ratio

    def root(power: sp.Pow) -> sp.Expr:
        n, _ = (power.exp * k).as_coeff_Mul()
        symbol = sp.Dummy(f"r_{len(local)}", positive=True)
        return local.setdefault(power.base ** (power.exp / n), symbol) ** n

    def about_two(total: sp.Expr) -> sp.Expr:
        terms = sp.Poly(total.subs(k, _SHIFT + 2), _SHIFT).terms()
        return sp.Add(*(sp.factor(c) * _SHIFT**n for (n,), c in terms))

    ratio = ratio.replace(lambda e: e.is_Pow and e.exp.has(k), root)
    return ratio.replace(
        lambda e: e.is_Add and e.has(k) and not (e - k).is_number, about_two
    )
