"""A theory and its wave as LaTeX, or as the source of a Python module of plain functions."""

from __future__ import annotations

import sympy as sp

from lwa.render import third_order, wave_values
from lwa.theory import Theory
from lwa.wave import QUANTITIES, TravelingWave


def theory_latex(theory: Theory) -> str:
    """The ansatz and the wave equation as LaTeX, one display line each."""
    rows = [_equation(sp.Symbol("lambda"), theory.amplitude_ratio)]
    rows += [_equation(sp.Symbol(f"b_{n}"), b) for n, b in theory.ansatz.items()]
    rows += [_equation(sp.Symbol(name), value) for name, value in third_order(theory).items()]
    x = sp.Symbol("x")
    right = theory.pde.right_side(sp.Function("u")(x), x, sp.Function(r"u_{\tau}")(x))
    rows.append(rf"u_{{\tau\tau}} = {sp.latex(right)}")
    return _align(rows)


def wave_latex(theory: Theory, wave: TravelingWave) -> str:
    """The wave's closed forms as LaTeX."""
    names = {"width": "L", "speed": "V_s"}
    rows = [_equation(sp.Symbol(names.get(n, n)), value) for n, value in wave_values(wave).items()]
    rows += [_equation(sp.Symbol(f"FWHM_{q}"), wave.fwhm(q)) for q in QUANTITIES]
    return _align(rows)


def _equation(name: sp.Symbol, value: sp.Expr) -> str:
    return f"{sp.latex(name)} = {sp.latex(value)}"


def _align(rows: list[str]) -> str:
    body = " \\\\\n".join(row.replace("=", "&=", 1) for row in rows)
    return f"\\begin{{align}}\n{body}\n\\end{{align}}"


def theory_python(theory: Theory) -> str:
    """A module of functions: b1 …, G, H, I, and all coefficients by order and jet."""
    functions = {f"b{n}": b for n, b in theory.ansatz.items()} | third_order(theory)
    table = {n: {jet: found[jet] for jet in found} for n, found in theory.pde.coefficients.items()}
    symbols = _symbols([c for found in table.values() for c in found.values()])
    rows = [f"def coefficients({symbols}):", f'    """{_TABLE}"""', "    return {"]
    for n, found in table.items():
        rows.append(f"        {n}: {{")
        rows += [f"            {tuple(jet)}: {sp.pycode(value)}," for jet, value in found.items()]
        rows.append("        },")
    return _module(functions, [*rows, "    }"])


_TABLE = "{n: {(jet, jet_t): coefficient}} of the orders D^(k+n), without the power of D."


def wave_python(theory: Theory, wave: TravelingWave) -> str:
    """A module of functions: beta, p, a, …, B(V_s), speed(B), fwhm_strain, …"""
    functions = {**wave_values(wave), **{f"fwhm_{q}": wave.fwhm(q) for q in QUANTITIES}}
    return _module(functions, [])


def _symbols(values: list[sp.Expr]) -> str:
    return ", ".join(sorted({s.name for value in values for s in value.free_symbols}))


def _module(functions: dict[str, sp.Expr], more: list[str]) -> str:
    blocks = [
        f"def {name}({_symbols([value])}):\n    return {sp.pycode(value)}"
        for name, value in functions.items()
    ]
    if more:
        blocks.append("\n".join(more))
    return "\n\n\n".join(["import math", *blocks])
