"""The command `lwa derive`: ansatz, wave equation and defect."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from lwa.command.chain import take_chain
from lwa.command.options import theory_options
from lwa.command.rows import Answer, Row, Values
from lwa.equation.terms import Terms, by_order
from lwa.theory import Theory, homogenize

UNKNOWNS = {
    "first": "u is the displacement of the cell's first particle",
    "center": "u is the canonical field, the mass-weighted mean of the fields at one point",
}
"""Meaning of the unknown u by the name of the field."""


def settings_json(theory: Theory) -> Values:
    """JSON of the chain, its law and the settings; the φ_n are functions of the compression."""
    law = {}
    if not theory.law.homogeneous:
        law = {
            "law": str(theory.law.F),
            "phi": {str(n): str(x) for n, x in theory.phi.items()},
        }
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
@theory_options()
def derive(style: str, **options: Any) -> None:
    """Derive the long-wave equation of a chain.

    Results are the ansatz, the wave equation u_ττ = u_x^(k-1) u_xx + … for the displacement u, and
    the defect: u_ττ by the first bead's equation of motion minus u_ττ by the second bead's.

    In JSON `terms` is the right-hand side of u_ττ after its leading term.
    """
    chain = take_chain(options)
    theory = homogenize(chain.cell, law=chain.law, **options)
    closure, law, pde = theory.closure, theory.law, theory.pde
    head = {
        **settings_json(theory),
        "lambda": theory.amplitude_ratio,
        "ansatz": {},
        **dict.fromkeys("GHI"),
        **pde.third_order,
        "terms": _terms_json(pde.coefficients),
        "defect": _terms_json(theory.defect),
        "conservative": pde.conservative,
    }
    rows: list[Row | str] = [
        chain.text,
        f"closure {closure.name}, {closure.model.branch} branch, to D^{theory.order}; "
        f"τ = t·{pde.time_scale}",
        UNKNOWNS[closure.field],
    ]
    if not law.homogeneous:
        rows.append(
            f"phi_n = {law.delta}^(n-1) F^(n)/F', at {law.delta} = D u_x; F' is taken there"
        )
        rows += [f"  phi{n} = {value}" for n, value in theory.phi.items()]
    rows.append("")
    if theory.ansatz:
        rows += [
            "w = λ (u + Σ b_n D^n ∂_x^n u), the linear part of the second particle's field",
            f"  λ = {theory.amplitude_ratio}",
            *(
                Row(f"ansatz.{n}", f"b{n}", b, digits=0)
                for n, b in theory.ansatz.items()
            ),
            "",
        ]
    for i, series in theory.slaved.items():
        # the linear part of the second particle's field w is the ansatz
        if i == 1:
            series = {n: found.nonlinear for n, found in series.items()}
        if lines := by_order(series, "D^{}"):
            name = (
                "nonlinear terms of w"
                if i == 1
                else f"field of particle {i + 1}, less u"
            )
            rows += [f"{name}:", *lines, ""]
    rows += [str(pde), ""]
    if theory.defect:
        rows.append(
            "defect: u_ττ by the first equation of motion minus u_ττ by the second"
        )
        rows += by_order(theory.defect, pde.heading)
    else:
        rows.append("all equations of motion are satisfied at every order shown")
    if closure.model.branch == "acoustic" and not pde.conservative:
        rows.append(
            "not in conservation form: the linear closure of unequal particles does not conserve "
            "momentum; see --closure full"
            if closure.name == "linear"
            else "not in conservation form in this field; see --field center"
        )
    Answer(head, rows, shown=[theory]).print(style)


def _terms_json(coefficients: Mapping[int, Terms]) -> list[Values]:
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
