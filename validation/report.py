"""A result as a table for people and as a document for JSON.

`text` and `document` take any result of this package. In a document floats stand under names that
end in ``_value`` and exact numbers as strings that SymPy reads.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from itertools import groupby
from typing import Any

from validation.experiments import SOURCES, Paper
from validation.limits import Limits, Row


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Columns of text, the first aligned left, the others right.

    >>> print(table(("bead", "force"), (("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    lines = [header, *rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if i else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


@singledispatch
def text(result: Any) -> str:
    """The result as a table, with what it takes to read it."""
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


@singledispatch
def document(result: Any) -> dict[str, Any]:
    """The result for JSON.

    `Limits` → ``ok``, ``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null where all
    enter, ``omega`` 0 for the limit), ``theory`` (exact), ``theory_value``, ``lattice_value``,
    ``lattice_error_value`` (absolute), ``error_value`` (theory over lattice - 1),
    ``bound_value``, ``ok``.

    `Paper` → ``velocity_value``, ``beads``, ``sensors``, ``gravity_value``, ``rows``:
    ``quantity``, ``unit``, ``lattice_value``, ``lattice_error_value``, and by what sets the
    theory's amplitude (``F_m``, ``speed``, ``striker``) ``theory_value`` {…} and ``error_value``
    {…}.
    """
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


def _percent(error: float) -> str:
    return f"{100 * error:+.3g} %"


def _chain(row: Row) -> str:
    if not row.omega:
        return "ω = m2/m1 → 0, extrapolated from runs at small ω"
    name = "m1 = m2" if row.omega == 1 else "m1 ≫ m2"
    return f"{name}, ω = {row.omega}"


@text.register
def _(result: Limits) -> str:
    header = ("quantity", "k", "theory", "lattice", "error", "bound", "")
    blocks = []
    for chain, rows in groupby(result.rows, _chain):
        lines = [
            (
                row.quantity,
                "→ 1" if row.k is None else str(row.k),
                f"{row.theory_value:.8g}",
                str(row.lattice),
                _percent(row.error),
                _percent(row.bound).lstrip("+"),
                "ok" if row.ok else "FAILS",
            )
            for row in rows
        ]
        blocks.append(f"{chain}\n{table(header, lines)}")
    failed = sum(not row.ok for row in result.rows)
    verdict = f"{failed} of {len(result.rows)} fail" if failed else "all hold"
    notes = (
        "Lengths in D, m1 = A = D = 1; force and strain of a contact; error: theory/lattice - 1.\n"
        "±: the lattice's own error, by how much a number still changed over the last stretch."
    )
    return "\n\n".join((*blocks, notes, f"{len(result.rows)} checks: {verdict}"))


@document.register
def _(result: Limits) -> dict[str, Any]:
    return {
        "ok": result.ok,
        "rows": [
            {
                "quantity": row.quantity,
                "k": None if row.k is None else str(row.k),
                "omega": str(row.omega),
                "theory": str(row.theory),
                "theory_value": row.theory_value,
                "lattice_value": row.lattice.value,
                "lattice_error_value": row.lattice.error,
                "error_value": row.error,
                "bound_value": row.bound,
                "ok": row.ok,
            }
            for row in result.rows
        ],
    }


@text.register
def _(result: Paper) -> str:
    header = ["quantity", "unit", "lattice"]
    for source in SOURCES:
        header += [f"by {source}", "error"]
    lines = []
    for row in result.rows:
        line = [row.quantity, row.unit, str(row.lattice)]
        for source, fixed in SOURCES.items():
            by_construction = fixed == row.quantity
            line += [f"{row.theory[source]:.5g}"]
            line += ["set" if by_construction else _percent(row.error(source))]
        lines.append(line)
    first, second = result.sensors
    gravity = f"gravity {result.gravity:g} m/s²" if result.gravity else "no gravity"
    return "\n\n".join(
        (
            f"{result.beads} beads, steel (the striker, {result.velocity:g} m/s) and PTFE in turn, "
            f"steel wall, {gravity}; sensors in beads {first} and {second}",
            table(header, lines),
            "The force of a bead is the mean of its two contacts'; what names no bead is the mean "
            "over both sensor\nbeads (odd ones are steel, even ones PTFE) or over their four "
            "contacts. The theory's amplitude is set by\nF_m, by the speed, or by all of the "
            "striker's momentum; error: theory/lattice - 1. ±: the error of the\nintegration.",
        )
    )


@document.register
def _(result: Paper) -> dict[str, Any]:
    return {
        "velocity_value": result.velocity,
        "beads": result.beads,
        "sensors": list(result.sensors),
        "gravity_value": result.gravity,
        "rows": [
            {
                "quantity": row.quantity,
                "unit": row.unit,
                "lattice_value": row.lattice.value,
                "lattice_error_value": row.lattice.error,
                "theory_value": dict(row.theory),
                "error_value": {source: row.error(source) for source in SOURCES},
            }
            for row in result.rows
        ],
    }
