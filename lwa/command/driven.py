"""The commands `lwa strike` and `lwa shock`: chains driven by a striker or by a wall."""

from __future__ import annotations

import math
from typing import Any

import click
import sympy as sp

from lwa.base import InputError
from lwa.command.chain import take_chain
from lwa.command.options import (
    SPHERES,
    cell_options,
    spheres_option,
    style_option,
    value,
)
from lwa.command.rows import Answer, Row, attempt
from lwa.command.waves import hertz_note
from lwa.expansion.physical import pulse_of_strike
from lwa.shocks import riemann


@click.command()
@spheres_option(required=True)
@value(
    "--velocity", "Velocity of the striker, in m/s in SI.  [default: that in the file]"
)
@value("--drop", "Height from which the striker falls, in m, in place of --velocity.")
@value(
    "--mass",
    "Mass of the striker, in kg in SI.  [default: that in the file, or of a bead]",
)
@style_option()
def strike(
    spheres: str,
    velocity: sp.Expr | None,
    drop: sp.Expr | None,
    mass: sp.Expr | None,
    style: str,
) -> None:
    """Leading pulse of a chain of equal beads that a mass strikes: force, speed and width.

    Needs --spheres, and --velocity or --drop unless the file has a striker. Units are those of the
    file; the width is that of a contact's force.
    """
    chain = take_chain({"spheres": spheres})
    cell, law = chain.cell, chain.law
    if chain.precompression:
        raise InputError(
            f"precompression is {chain.precompression}: the pulse of a strike is that of a chain "
            "without load"
        )
    if velocity is None and drop is None:
        velocity = chain.velocity
    if mass is None:
        mass = chain.mass or cell.masses[0]
    pulse = pulse_of_strike(cell, mass, velocity, drop=drop, k=law.exponent)
    rows: list[Row | str] = [
        f"chain of equal beads; F = A δ^k, k = {law.exponent}",
        Row("", "mass of the beads", cell.masses[0], unit="kg"),
        Row("mass", "mass of the striker", pulse.mass, "kg", expression=False),
        Row(
            "velocity",
            "velocity of the striker",
            pulse.velocity,
            "m/s",
            expression=False,
        ),
        "",
        "leading pulse:",
        Row("force", "peak contact force", pulse.force, "N"),
        Row("speed", "speed dx/dt", pulse.speed, "m/s"),
        Row("fwhm.length", "FWHM of the force", pulse.fwhm("force", "length"), "m"),
        Row("fwhm.time", "FWHM of the force in time", pulse.fwhm(), "s"),
    ]
    notes = hertz_note(chain, pulse.wave.F)
    if pulse.train:
        notes.append(
            "a striker heavier than two beads sends further pulses behind this one"
        )
    Answer({}, rows, chain.si, shown=[pulse], notes=notes).print(style)


@click.command()
@cell_options()
@SPHERES
@value("--behind", "Strain behind the front, compression over D.")
@value(
    "--piston",
    "Velocity of the wall, in m/s if the chain is in SI, in place of --behind.",
)
@value(
    "--ahead", "Strain ahead of the front.  [default: 0, or that of the load in a file]"
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

    In JSON `plateau` is the velocity of the wall, and `peak` the strain of the leading pulse by the
    doubling rule. Errors were measured on driven chains; closed forms without an error are exact
    for the law. Values that no theory here gives are null; `notes` has the reason.
    """
    if (behind is None) == (piston is None):
        raise InputError("--behind or --piston: one of the two is wanted")
    chain = take_chain(options)
    cell, law, static = chain.cell, chain.law, chain.precompression
    if ahead is None:
        ahead = law.compression(cell, static) / cell.spacing if static else sp.S.Zero
    if behind is None:
        front = riemann.piston(cell, piston, ahead, law=law)
    else:
        front = riemann.shock(cell, behind, ahead, law=law)

    def row(key: str, label: str, unit: str = "m/s") -> Row:
        name, _, rule = key.partition(".")
        value = (
            attempt(front.leading_speed, rule)
            if rule
            else attempt(getattr, front, name)
        )
        closed = isinstance(value, sp.Expr) and not value.has(sp.Float)
        error = attempt(front.estimate, name, rule or "doubling")
        bound = math.nan if isinstance(error, InputError) else error.relative_error
        return Row(key, label, value, unit, expression=closed, error=bound)

    kind = attempt(getattr, front, "kind")
    head = {"kind": None if isinstance(kind, InputError) else kind}
    rows: list[Row | str] = [
        chain.text,
        row("behind", "strain behind", ""),
        Row("ahead", "strain ahead", front.ahead),
        "",
        f"{head['kind'] or 'front'}, speeds dx/dt:",
        row("plateau", "velocity of the wall"),
        row("trailing_speed", "trailing edge"),
        *(
            row(f"leading_speed.{rule}", f"leading edge, {rule}")
            for rule in riemann.RULES
        ),
    ]
    if kind != "rarefaction":
        rows.append(row("peak", "peak strain, doubling", ""))
        rows.append(row("peak_force", "peak force, doubling", "N"))
    notes = [
        "c₋ > 2 c₊: the beads near the wall go on oscillating. The strain behind is that of a wall "
        "at rest beside its neighbours, v_p = ∫ c dp; the mean strain is below it."
    ]
    notes *= front.oscillates
    Answer(head, rows, chain.si, cell.spacing, [front], notes).print(style)
