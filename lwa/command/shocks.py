"""Shocks and rarefactions of a chain driven by a wall, as rows: `lwa shock`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from lwa.base.errors import InputError
from lwa.command.rows import Answer, Row, attempt
from lwa.shocks.riemann import RULES, Shock


def shock(found: Shock, units: Mapping[str, str], spoken: str) -> Answer:
    """The front between two strains: velocity of the wall, speeds of the edges, leading pulse.

    Speeds are dx/dt, ``plateau`` is the velocity of the wall and ``peak`` the strain of the leading
    pulse by the doubling rule; for a power law without load ``series`` has the pulse's speed and
    force from the series in k - 1. Where a theory does not reach, values are null, and ``notes``
    say why.

    spoken : the chain in text.
    """

    def row(key: str, label: str, value: Any, symbol: str = "") -> Row:
        closed = isinstance(value, sp.Expr) and not value.has(sp.Float)
        return Row(key, label, value, symbol, expression=closed)

    kind = attempt(lambda: found.kind)
    head = {"kind": None if isinstance(kind, InputError) else kind}
    rows: list[Row | str] = [
        spoken,
        Row("behind", "strain behind", found.behind, "p_{-}"),
        Row("ahead", "strain ahead", found.ahead, "p_{+}"),
        "",
        f"{head['kind'] or 'front'}, speeds dx/dt:",
        row("plateau", "velocity of the wall and the plateau", found.plateau, "v_{p}"),
        row("trailing_speed", "trailing edge", attempt(lambda: found.trailing_speed), "s_{-}"),
    ]
    for rule in RULES:
        key, label = f"leading_speed.{rule}", f"leading edge, {rule}"
        rows.append(row(key, label, attempt(found.leading_speed, rule), "s_{+}"))
    if kind != "rarefaction":
        peak, force = attempt(lambda: found.peak), attempt(lambda: found.peak_force)
        rows.append(row("peak", "peak strain, doubling", peak, r"p_{\max}"))
        rows.append(row("peak_force", "peak force, doubling", force, r"F_{\max}"))
        if found.law.homogeneous and found.ahead.is_zero and not found.behind.free_symbols:
            wave, force = attempt(lambda: found.wave.speed), attempt(lambda: found.wave.F)
            rows += [
                Row("series.speed", "leading pulse, series", wave),
                Row("series.force", "peak force, series", force, expression=False),
            ]
    faults = (row.value for row in rows if isinstance(row, Row))
    notes = dict.fromkeys(str(fault) for fault in faults if isinstance(fault, InputError))
    return Answer(head, rows, units, found.cell.spacing, notes=tuple(notes), orders=False)


UNITS = dict.fromkeys(("plateau", "trailing_speed", "leading_speed", "series.speed"), "m/s") | {
    "peak_force": "N",
    "series.force": "N",
}
"""Units of a shock in SI."""
