"""The command `lwa derive`: ansatz, wave equation and defect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from lwa.command.answer import Answer, Lines, Values, rows_of
from lwa.command.chain import ChainInput
from lwa.command.options import THEORY, command, given
from lwa.equation.terms import Terms, by_order, latex_by_order
from lwa.theory import Theory, homogenize
from lwa.wave.compact import canonical_wave

UNKNOWNS = {
    "first": "u is the displacement of the cell's first particle",
    "center": "u is the canonical field, the mass-weighted mean of the fields at one point",
}
"""Meaning of the unknown u by the name of the field."""

FIRST = "G and H depend on the field u; in the canonical field, whichever bead is the first:"
"""Heading of the canonical equation's coefficients beside those of a first field."""


def settings_json(theory: Theory) -> Values:
    """JSON of the chain, its law and the settings; the φ_n are functions of the compression."""
    # Expressions stay expressions: JSON has them as text when it is printed.
    settings: Values = {
        "k": theory.k,
        "masses": theory.cell.masses,
        "stiffnesses": theory.cell.stiffnesses,
        "spacing": theory.cell.spacing,
        "order": theory.order,
        "closure": theory.closure.name,
        "branch": theory.closure.model.branch,
        "field": theory.closure.field,
    }
    if not theory.law.homogeneous:
        settings |= {"law": theory.law.F, "phi": theory.phi}
    return settings


def closure_lines(theory: Theory) -> list[str]:
    """Lines of text with the closure and the unknown, and why a closure was chosen."""
    closure = theory.closure
    lines = [f"closure {closure.name}; {UNKNOWNS[closure.field]}"]
    # The program says which closure it chose; a closure that the user names needs no words.
    if theory.cell.size > 2 and not given("closure"):
        lines.append(
            f"{theory.cell.size} beads in a cell: the paper's closure is that of one or two, the "
            "full one was taken"
        )
    return lines


def depends_on_first(theory: Theory) -> bool:
    """True for the first field of unlike beads, whose wave depends on which bead is the first."""
    # Under a law that is no power there is no compact wave to compare.
    first = theory.closure.field == "first" and theory.pde.acoustic
    return first and not theory.cell.uniform and theory.law.homogeneous


@command(
    "lwa derive --order 4",
    "lwa derive --masses 1,2,3 --k 5/2 --format latex",
    "lwa derive --law hertz2:1,2 --masses 1",
    page="closure",
)
@THEORY
def derive(chain: ChainInput, **options: Any) -> Answer:
    """Derive the long-wave equation of a chain.

    Results are the ansatz, the wave equation ``u_ττ = u_x^(k-1) u_xx + …`` for the displacement u,
    and the defect: u_ττ by the first bead's equation of motion minus u_ττ by the second bead's.

    In JSON `terms` is the right-hand side of u_ττ after its leading term.
    """
    # The options are order, closure, field and branch.
    theory = homogenize(chain.cell, law=chain.law, **options)
    pde = theory.pde
    head = settings_json(theory) | {
        "lambda": theory.amplitude_ratio,  # 1 on the acoustic branch
        "ansatz": theory.ansatz,
        # null where the order or the branch has none: readers find the same keys
        **dict.fromkeys("GHI"),
        **pde.third_order,
        "terms": _terms_json(pde.coefficients),
        "defect": _terms_json(theory.defect),
        "conservative": pde.conservative,
    }
    rows: Lines = [
        chain.text,
        *closure_lines(theory),
        f"{theory.closure.model.branch} branch, to D^{theory.order}; τ = t·{pde.time_scale}",
        _lines(theory),
    ]
    # G, H and I are the coefficients at D^{k+3}, which an ansatz to D^4 has.
    if depends_on_first(theory) and theory.order >= 4:
        canonical = canonical_wave(theory.cell, theory.k)
        letters = rows_of(canonical, G="G", H="H", I="I")
        rows.append(Answer({}, ["", FIRST, *letters], key="canonical"))
    # In LaTeX: the rows of the theory, and the defect's.
    shown = theory, _defect_latex(theory)
    return Answer(head, rows, shown=shown)


def _defect_latex(theory: Theory) -> Iterator[str]:
    """LaTeX of the difference between the equations of motion of the two beads in a cell."""
    if theory.defect:
        defect = latex_by_order([], theory.defect, theory.cell.spacing)
        yield rf"{{u_{{\tau\tau}}^{{(1)}} - u_{{\tau\tau}}^{{(2)}}}} = {defect}"


def _lines(theory: Theory) -> Iterator[str]:
    """Lines of text with the law, the particles' fields, the equation and the defect."""
    pde = theory.pde
    law = theory.law
    if not law.homogeneous:
        # The coefficients hold the φ_n, whose values by δ stand here once.
        delta = law.delta
        yield f"phi_n = {delta}^(n-1) F^(n)/F', at {delta} = D u_x; F' is taken there"
        for n, value in theory.phi.items():
            yield f"  phi{n} = {value}"
    yield ""
    if theory.ansatz:  # a cell of one particle has none
        yield "w = λ (u + Σ b_n D^n ∂_x^n u), the linear part of the second particle's field"
        yield f"  λ = {theory.amplitude_ratio}"
        for n, b in theory.ansatz.items():
            yield f"  b{n} = {b}"
        yield ""
    # The fields of the full closure. The first field is the first particle's own, which is left
    # out; the canonical field is no particle's, and every particle has one.
    for i, orders in theory.slaved.items():
        title = f"field of particle {i + 1}, less u"
        if i == 1:  # its linear part is the ansatz
            title = "nonlinear terms of w"
            orders = {n: found.nonlinear for n, found in orders.items()}
        terms = by_order(orders, "D^{}")
        if terms:
            yield from [f"{title}:", *terms, ""]
    yield from [str(pde), ""]
    if theory.defect:
        yield "defect: u_ττ by the first equation of motion minus u_ττ by the second"
        yield from by_order(theory.defect, pde.heading)
    else:
        yield "all equations of motion are satisfied at every order shown"
    if pde.acoustic and not pde.conservative:
        # The way to an equation in conservation form is another closure, or another field.
        way_out = " in this field; see --field center"
        if theory.closure.name == "linear":
            way_out = (
                ": the linear closure of unequal particles does not conserve momentum; see "
                "--closure full"
            )
        yield f"not in conservation form{way_out}"


def _terms_json(coefficients: Mapping[int, Terms]) -> list[Values]:
    """JSON of the terms by their orders."""
    # A row a term, whose jet is a list of [derivative, power]: JSON has no jets as keys.
    rows: list[Values] = []
    for n, terms in coefficients.items():
        for jet, coefficient in terms.items():
            row = {"order": n, "jet": jet.x, "jet_t": jet.t, "coefficient": coefficient}
            rows.append(row)
    return rows
