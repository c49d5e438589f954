"""The commands `lwa strike` and `lwa shock`: chains driven by a striker or by a wall."""

from __future__ import annotations

import shlex
from typing import Any

import sympy as sp

from lwa.base import InputError
from lwa.base.exact import positive
from lwa.command.answer import Answer, Lines, Row, attempt
from lwa.command.chain import take_chain
from lwa.command.options import (
    SPHERES,
    cell_options,
    command,
    not_negative,
    style_option,
    value,
)
from lwa.expansion.strike import pulse_of_strike
from lwa.shocks import front as fronts
from lwa.shocks.riemann import RULES

_STRIKE_FILE = "lwa-validate run --example striker > chain.toml"


@command(
    _STRIKE_FILE,
    "lwa strike --spheres chain.toml --drop 0.5",
    "lwa strike --spheres chain.toml --velocity 1 --mass 0.01",
    page="recipes",
)
@SPHERES
@value(
    "--velocity",
    "Velocity of the striker, in m/s in SI.  [default: that in the file]",
    "1",
    positive,
)
@value(
    "--drop",
    "Height from which the striker falls, in m, in place of --velocity.",
    "0.5",
    positive,
)
@value(
    "--mass",
    "Mass of the striker, in kg in SI.  [default: that in the file, or of a bead]",
    "0.01",
    positive,
)
@style_option()
def strike(
    spheres: str | None,
    velocity: sp.Expr | None,
    drop: sp.Expr | None,
    mass: sp.Expr | None,
    style: str,
) -> None:
    """Leading pulse of a chain of equal beads that a mass strikes: force, speed and width.

    Needs --spheres, and --velocity or --drop unless the file has a striker. Units are those of the
    file; the width is that of a contact's force. Gravity acts on the striker that falls, and is
    neglected in the chain.
    """
    if spheres is None:
        raise InputError(
            f"the chain is read from a file by --spheres; try: {_STRIKE_FILE}"
        )
    chain = take_chain({"spheres": spheres})
    cell, striker = chain.cell, chain.striker
    file = shlex.quote(spheres)
    # The relation of a strike rests on the wave without load, which scales with the force.
    if chain.precompression:
        raise InputError(
            f"precompression is {chain.precompression} in {spheres}: the pulse of a strike is that "
            f"of a chain without load; leave the key out; try: lwa-validate run {file}"
        )
    # A closed form of unlike beads knows no striker.
    if not cell.uniform:
        raise InputError(
            f"{spheres} has unlike beads or contacts: the pulse is that of equal ones, and a "
            f"simulation takes any; try: lwa-validate run {file}"
        )
    # Speed and width are lengths, which a file of masses may lack.
    if cell.spacing.is_Symbol:
        raise InputError(
            f"{spheres} has no spacing: add spacings = 1.0 to [chain]; try: lwa-validate run --keys"
        )
    # Options stand above the file.
    if velocity is None and drop is None:
        velocity, drop = striker.velocity, striker.drop
    if velocity is None and drop is None:
        raise InputError(f"{spheres} has no striker that moves", velocity="1")
    # A striker is one of the beads unless it is described.
    if mass is None:
        mass = striker.mass or cell.masses[0]
    pulse = pulse_of_strike(cell, mass, velocity, drop=drop, k=chain.law.exponent)
    # A mass in front of the wave's numbers: the striker decides how good they are.
    rows: Lines = [
        f"chain of equal beads; F = A δ^k, k = {chain.law.exponent}",
        Row("", "mass of the beads", cell.masses[0], "kg"),
        Row.of(pulse, "mass", "mass of the striker", "kg"),
        Row.of(pulse, "velocity", "velocity of the striker", "m/s"),
        "",
        "leading pulse:",
        Row.of(pulse, "force", "peak contact force", "N"),
        Row.of(pulse, "speed", "speed dx/dt", "m/s"),
        Row("fwhm.length", "FWHM of the force", pulse.fwhm("force", "length"), "m"),
        Row("fwhm.time", "FWHM of the force in time", pulse.fwhm(), "s"),
    ]
    # Limits of the model, each said where it is reached.
    notes = chain.hertz_notes(pulse.wave.force)
    if chain.gravity:
        notes.append(
            f"gravity {chain.gravity:g} is neglected: the weight of the beads is taken for small "
            "beside the pulse's force; lwa-validate run has it"
        )
    if pulse.train:
        notes.append(
            "a striker heavier than two beads sends further pulses behind this one"
        )
    errors = "bound of the difference to struck chains, as measured"
    Answer({}, rows, chain.scale, [pulse], errors, notes).print(style)


@command(
    "lwa shock --k 3/2 --masses 1 --spacing 1 --behind 2 --ahead 1",
    "lwa shock --k 3/2 --masses 1 --behind 1",
    page="shocks",
)
@cell_options()
@SPHERES
@value("--behind", "Strain behind the front, compression over D.", "2", not_negative)
@value(
    "--piston",
    "Velocity of the wall, in m/s if the chain is in SI, in place of --behind.",
    "1",
    positive,
)
@value(
    "--ahead",
    "Strain ahead of the front.  [default: 0, or that of the load in a file]",
    "1",
    not_negative,
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
    if behind is None and piston is None:
        raise InputError("neither --behind nor --piston is given", behind=1)
    # The load of a file is a force, and the state ahead a strain.
    chain = take_chain(options)
    cell, law, static = chain.cell, chain.law, chain.precompression
    # A load of the file is the state ahead of the front, as a strain.
    if ahead is None:
        ahead = law.compression(cell, static) / cell.spacing if static else sp.S.Zero
    if behind is None:
        front = fronts.piston(cell, piston, ahead, law=law)
    else:
        front = fronts.shock(cell, behind, ahead, law=law)

    # With symbols nobody knows whether the front is a shock.
    kind = attempt(getattr, front, "kind")
    named = None if isinstance(kind, InputError) else kind
    rows: Lines = [
        chain.text,
        Row.of(front, "behind", "strain behind"),
        Row.of(front, "ahead", "strain ahead"),
        "",
        f"{named or 'front'}, speeds dx/dt:",
        Row.of(front, "plateau", "velocity of the wall", "m/s"),
        Row.of(front, "trailing_speed", "trailing edge", "m/s"),
    ]
    for rule in RULES:
        label = f"leading edge, {rule}"
        key = f"leading_speed.{rule}"
        rows.append(Row.of(front, "leading_speed", label, "m/s", rule, key=key))
    if kind != "rarefaction":  # which has no leading pulse
        rows.append(Row.of(front, "peak", "peak strain, doubling"))
        rows.append(Row.of(front, "peak_force", "peak force, doubling", "N"))
    # The closed form takes the strain behind for constant.
    notes = []
    if front.oscillates:
        notes.append(
            "c₋ > 2 c₊: the beads near the wall go on oscillating. The strain behind is that of a "
            "wall at rest beside its neighbours, v_p = ∫ c dp; the mean strain is below it."
        )
    errors = "bound of the difference to driven chains, as measured"
    Answer({"kind": named}, rows, chain.scale, [front], errors, notes).print(style)
