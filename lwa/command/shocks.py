"""The command `lwa shock`: shocks and rarefactions of a chain that a wall drives."""

from __future__ import annotations

from typing import Any

import click
import sympy as sp

from lwa.base.errors import InputError
from lwa.command.chain import ChainInput, take_chain
from lwa.command.options import SPHERES, cell_options, quantity
from lwa.command.rows import Answer, Row, attempt
from lwa.shocks import riemann
from lwa.shocks.riemann import RULES, Shock


@click.command()
@cell_options()
@SPHERES
@click.option("--behind", callback=quantity, help="Strain behind the front, compression over D.")
@click.option(
    "--piston",
    callback=quantity,
    help="Velocity of the wall, in m/s if the chain is in SI, in place of --behind.",
)
@click.option(
    "--ahead",
    callback=quantity,
    help="Strain ahead of the front.  [default: 0, or that of the load in a file]",
)
def shock(
    style: str,
    behind: sp.Expr | None,
    piston: sp.Expr | None,
    ahead: sp.Expr | None,
    **options: Any,
) -> None:
    """Shock, or rarefaction, of a chain that a wall drives.

    Needs --behind or --piston. Speeds are dx/dt, in m/s with --spheres.

    In JSON `plateau` is the velocity of the wall, `peak` the strain of the leading pulse by the
    doubling rule, and `series`, for a power law without load, the pulse's speed and force from the
    series in k - 1. Values beyond the reach of a theory are null, for the reason in `notes`.
    """
    if (behind is None) == (piston is None):
        raise InputError("--behind or --piston: one of the two is wanted")
    chain = take_chain(options)
    cell, law, static = chain.cell, chain.law, chain.precompression
    if ahead is None:
        ahead = law.compression(cell, static) / cell.spacing if static else sp.S.Zero
    if behind is None:
        found = riemann.piston(cell, law, piston, ahead)
    else:
        found = riemann.shock(cell, law, behind, ahead)
    _answer(chain, found).print(style)


def _answer(chain: ChainInput, found: Shock) -> Answer:
    """Rows of the front between two strains."""

    def row(key: str, label: str, value: Any, symbol: str = "", unit: str = "m/s") -> Row:
        closed = isinstance(value, sp.Expr) and not value.has(sp.Float)
        return Row(key, label, value, symbol, unit, expression=closed)

    kind = attempt(lambda: found.kind)
    head = {"kind": None if isinstance(kind, InputError) else kind}
    rows: list[Row | str] = [
        chain.text,
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
        rows.append(row("peak", "peak strain, doubling", peak, r"p_{\max}", ""))
        rows.append(row("peak_force", "peak force, doubling", force, r"F_{\max}", "N"))
        if found.law.homogeneous and found.ahead.is_zero and not found.behind.free_symbols:
            speed, force = attempt(lambda: found.wave.speed), attempt(lambda: found.wave.F)
            rows.append(Row("series.speed", "leading pulse, series", speed, unit="m/s"))
            label = "peak force, series"
            rows.append(Row("series.force", label, force, unit="N", expression=False))
    faults = (row.value for row in rows if isinstance(row, Row))
    notes = dict.fromkeys(str(fault) for fault in faults if isinstance(fault, InputError))
    return Answer(head, rows, chain.si, found.cell.spacing, notes=tuple(notes), orders=False)
