"""A theory and its wave as LaTeX; a theory as the source of a Python module of functions."""

from __future__ import annotations

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES
from lwa.code.languages import LANGUAGES
from lwa.command.document import wave_values
from lwa.law import Law
from lwa.theory import Theory
from lwa.wave.functions import function_of, in_order
from lwa.wave.traveling import TravelingWave


def theory_latex(theory: Theory) -> str:
    """The ansatz and the wave equation, all orders of it, as LaTeX."""
    return latex.align([*theory.closure.latex_rows(), *theory.pde.latex_rows()])


def wave_latex(theory: Theory, wave: TravelingWave) -> str:
    """The wave's closed forms as LaTeX."""
    names = {"width": "L", "speed": "V_s"}
    found = {names.get(name, name): value for name, value in wave_values(wave).items()}
    found |= {f"FWHM_{quantity}": wave.fwhm(quantity) for quantity in QUANTITIES}
    return latex.align(latex.values(found))


def theory_python(theory: Theory) -> str:
    """A module of functions: b1 …, G, H, I, and all coefficients by order and jet."""
    if isinstance(theory.law, Law):
        raise InputError("--format python is for power laws: others have text, json and latex")
    cell = theory.cell
    order = in_order(theory.k, *cell.masses, *cell.stiffnesses, cell.spacing)
    table = {n: {jet: found[jet] for jet in found} for n, found in theory.pde.coefficients.items()}
    values = {f"b{n}": b for n, b in theory.ansatz.items()} | theory.pde.third_order
    functions = [
        function_of(order, name, f"The coefficient {name}", v) for name, v in values.items()
    ]
    functions.append(function_of(order, "coefficients", _TABLE, sp.Dict(table)))
    return LANGUAGES["python"](functions).module(
        ["The ansatz and the wave equation. Written by lwa."]
    )


_TABLE = "{n: {(jet, jet_t): c}}, orders D^(k+n), without the power of D"
