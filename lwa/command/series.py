"""The command `lwa expansion`: the lattice's own wave as a series in k - 1."""

from __future__ import annotations

from typing import Any

import click

from lwa.base.frozen import QUANTITIES
from lwa.cell import k
from lwa.command.chain import take_chain
from lwa.command.options import series_options
from lwa.command.rows import Answer, Row, attempt
from lwa.expansion.expand import expand


@click.command()
@series_options(
    k.name, "Highest power of ε = k - 1; by default 8, or 4 with symbols.", None
)
def expansion(order: int | None, style: str, **options: Any) -> None:
    """Expand the lattice's own wave in ε = k - 1, and sum the series.

    Each sum comes with an estimate of its absolute error, at the peak force 1 on the first contact
    and with lengths in D; k and the cell must be numbers.

    In JSON c² is the sum of `c2`[n] ε^n.
    """
    chain = take_chain(options)
    cell = chain.cell
    expanded = expand(cell, order or 4, law=chain.law)
    if order is None and expanded.numeric:
        expanded = expand(cell, 8, law=chain.law)
    head = {
        "k": str(expanded.k),
        "masses": [str(m) for m in cell.masses],
        "stiffnesses": [str(A) for A in cell.stiffnesses],
        "order": expanded.order,
        "c2": [expanded.c2.prefactor * a for a in expanded.c2.coefficients],
    }
    series = {
        "c2": ("c²", expanded.c2),
        **{f"fwhm.{q}": (f"FWHM of the {q}", expanded.fwhm(q)) for q in QUANTITIES},
        "momentum": ("momentum", expanded.momentum),
        "energy": ("energy", expanded.energy),
    }
    rows: list[Row | str] = [
        chain.text,
        "ε = k - 1; peak force 1 on the first contact, lengths in D",
        "",
    ]
    for label, part in series.values():
        factors = [str(part.prefactor)] * (part.prefactor != 1)
        factors += [f"ε^({part.power})"] * (part.power != 0)
        rows.append(f"{label} = {' '.join([*factors, 'Σ a_n ε^n'])}")
        rows += [Row("", f"a{n}", a, digits=0) for n, a in enumerate(part.coefficients)]
    if expanded.numeric:
        rows += ["", f"at k = {expanded.k}, with estimates of the error:"]
        rows += [
            Row(key, label, attempt(part.at)) for key, (label, part) in series.items()
        ]
        mass = attempt(expanded.effective_mass.at)
        rows.append(Row("effective_mass", "effective mass P²/2E", mass))
        if cell.size == 2:
            rows.append(
                "  (of the mean of a dimer's two contacts, which differ behind a striker)"
            )
    Answer(head, rows, shown=[expanded]).print(style)
