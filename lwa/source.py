"""A theory and its wave as LaTeX; a theory as the source of a Python module of functions."""

from __future__ import annotations

import sympy as sp

from lwa.code import function_of, in_order
from lwa.languages import LANGUAGES
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
    cell = theory.cell
    order = in_order(theory.k, *cell.masses, *cell.stiffnesses, cell.spacing)
    table = {n: {jet: found[jet] for jet in found} for n, found in theory.pde.coefficients.items()}
    values = {f"b{n}": b for n, b in theory.ansatz.items()} | third_order(theory)
    functions = [
        function_of(order, name, f"The coefficient {name}", v) for name, v in values.items()
    ]
    functions.append(function_of(order, "coefficients", _TABLE, sp.Dict(table)))
    return LANGUAGES["python"](functions).module(
        ["The ansatz and the wave equation. Written by lwa."]
    )


_TABLE = "{n: {(jet, jet_t): c}}, orders D^(k+n), without the power of D"
