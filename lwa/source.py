"""A theory and its wave as LaTeX, or as the source of a Python module of plain functions."""

from __future__ import annotations

import sympy as sp

from lwa import latex
from lwa.quantities import QUANTITIES
from lwa.render import third_order, wave_values
from lwa.theory import Theory
from lwa.wave import TravelingWave


def theory_latex(theory: Theory) -> str:
    """The ansatz and the wave equation, all orders of it, as LaTeX."""
    return latex.align([*latex.ansatz(theory.closure), *latex.equation(theory.pde)])


def wave_latex(theory: Theory, wave: TravelingWave) -> str:
    """The wave's closed forms as LaTeX."""
    names = {"width": "L", "speed": "V_s"}
    found = {names.get(name, name): value for name, value in wave_values(wave).items()}
    found |= {f"FWHM_{quantity}": wave.fwhm(quantity) for quantity in QUANTITIES}
    return latex.align(latex.values(found))


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
