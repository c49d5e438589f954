"""The command `lwa derive`: ansatz, wave equation and defect, or a module of NumPy functions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError
from lwa.command.chain import ChainInput, take_chain
from lwa.command.options import STYLES, theory_options
from lwa.command.rows import Answer, Row, Values
from lwa.equation.terms import Terms, by_order
from lwa.theory import Theory, homogenize
from lwa.wave.source import Functions, module

FIELDS = {
    "first": "u is the displacement of the cell's first particle",
    "center": "u is the canonical field, the mass-weighted mean of the fields at one point",
}


def chain_json(theory: Theory) -> dict[str, Any]:
    """JSON of the chain, its law and the settings; the φ_n are functions of the compression."""
    law = {}
    if not theory.law.homogeneous:
        law = {"law": str(theory.law.F), "phi": {str(n): str(x) for n, x in theory.phi.items()}}
    return {
        "k": str(theory.k),
        **law,
        "masses": [str(m) for m in theory.cell.masses],
        "stiffnesses": [str(A) for A in theory.cell.stiffnesses],
        "spacing": str(theory.cell.spacing),
        "order": theory.order,
        "closure": theory.closure.name,
        "branch": theory.closure.model.branch,
        "field": theory.closure.field,
    }


@click.command()
@theory_options((*STYLES, "numpy"))
def derive(style: str, **options: Any) -> None:
    """Derive the long-wave equation of a chain.

    Results are the ansatz, the wave equation u_ττ = u_x^(k-1) u_xx + … for the displacement u, and
    the defect: u_ττ by the first bead's equation of motion minus u_ττ by the second bead's.

    In JSON `terms` is the right-hand side of u_ττ after its leading term, and `slaved` (closure
    full) has, for each bead from the second on, the terms J_n of its field u + u_x Σ D^n J_n.
    """
    chain = take_chain(options)
    theory = homogenize(chain.cell, law=chain.law, **options)
    if style == "numpy":
        click.echo(_source(theory))
    else:
        _answer(chain, theory).print(style)


def _answer(chain: ChainInput, theory: Theory) -> Answer:
    """Rows of a derivation."""
    head: Values = {
        **chain_json(theory),
        "lambda": theory.amplitude_ratio,
        "ansatz": {},
        **dict.fromkeys("GHI"),
        **theory.pde.third_order,
        "terms": _terms_json(theory.pde.coefficients),
        "vanishing": list(theory.pde.vanishing),
        "slaved": [
            {"particle": i + 1, **term}
            for i, series in theory.slaved.items()
            for term in _terms_json(series)
        ],
        "defect": _terms_json(theory.defect),
        "conservative": theory.pde.conservative,
    }
    rows = [
        chain.text,
        f"closure {theory.closure.name}, {theory.closure.model.branch} branch, to "
        f"D^{theory.order}; τ = t·{theory.pde.time_scale}",
        FIELDS[theory.closure.field],
        *_law_text(theory),
        "",
        *_ansatz(theory),
        str(theory.pde),
        "",
        *_consistency_text(theory),
    ]
    return Answer(head, rows, shown=[theory])


def _terms_json(coefficients: Mapping[int, Terms]) -> list[dict[str, Any]]:
    return [
        {
            "order": n,
            "jet": [list(power) for power in jet.x],
            "jet_t": [list(power) for power in jet.t],
            "coefficient": terms[jet],
        }
        for n, terms in coefficients.items()
        for jet in terms
    ]


def _law_text(theory: Theory) -> list[str]:
    """Lines of text with definition and values of the φ_n; [] for a power law."""
    law = theory.law
    if law.homogeneous:
        return []
    lines = [f"phi_n = {law.delta}^(n-1) F^(n)/F', at {law.delta} = D u_x; F' is taken there"]
    return lines + [f"  phi{n} = {value}" for n, value in theory.phi.items()]


def _ansatz(theory: Theory) -> list[Row | str]:
    rows: list[Row | str] = []
    if theory.ansatz:
        rows += [
            "w = λ (u + Σ b_n D^n ∂_x^n u), the linear part of the second particle's field",
            f"  λ = {theory.amplitude_ratio}",
            *(Row(f"ansatz.{n}", f"b{n}", b, digits=0) for n, b in theory.ansatz.items()),
            "",
        ]
    for i, series in theory.slaved.items():
        w = i == 1  # the second particle's field, whose linear part is the ansatz
        if lines := by_order(series, "D^{}", linear=not w):
            name = "nonlinear terms of w" if w else f"field of particle {i + 1}, less u"
            rows += [f"{name}:", *lines, ""]
    return rows


def _consistency_text(theory: Theory) -> list[str]:
    if not theory.defect:
        lines = ["all equations of motion are satisfied at every order shown"]
    else:
        lines = ["defect: u_ττ by the first equation of motion minus u_ττ by the second"]
        lines += by_order(theory.defect, theory.pde.heading)
    if theory.closure.model.branch == "acoustic" and not theory.pde.conservative:
        lines.append(
            "not in conservation form: the linear closure of unequal particles does not conserve "
            "momentum; see --closure full"
            if theory.closure.name == "linear"
            else "not in conservation form in this field; see --field center"
        )
    return lines


def _source(theory: Theory) -> str:
    """NumPy source of a module with b1 …, G, H, I, and all coefficients by order and jet."""
    if not theory.law.homogeneous:
        raise InputError("--format numpy is for power laws: others have text, json and latex")
    cell = theory.cell
    functions = Functions(theory.k, *cell.masses, *cell.stiffnesses, cell.spacing)
    values = {f"b{n}": b for n, b in theory.ansatz.items()} | theory.pde.third_order
    for name, value in values.items():
        functions.define(name, f"The coefficient {name}", value)
    table = {n: {jet: terms[jet] for jet in terms} for n, terms in theory.pde.coefficients.items()}
    doc = "{n: {(jet, jet_t): c}}, orders D^(k+n), without the power of D"
    functions.define("coefficients", doc, sp.Dict(table))
    title = ["The ansatz and the wave equation. Written by lwa."]
    return module([*functions.values()], "numpy", title)
