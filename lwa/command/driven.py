"""The commands `lwa strike` and `lwa shock`: chains driven by a striker or by a wall."""

from __future__ import annotations

import shlex
from contextlib import suppress

import sympy as sp

from lwa.base import InputError
from lwa.base.exact import positive
from lwa.command.answer import Answer, Lines, Row, rows_of
from lwa.command.chain import STRIKER_FILE, ChainInput
from lwa.command.cli import KEYS
from lwa.command.options import CELL, SPHERES, command, not_negative, value
from lwa.expansion.strike import pulse_of_strike
from lwa.shocks import front as fronts
from lwa.shocks.riemann import RULES


@command(
    STRIKER_FILE,
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
def strike(
    chain: ChainInput,
    velocity: sp.Expr | None,
    drop: sp.Expr | None,
    mass: sp.Expr | None,
) -> Answer:
    """Leading pulse of a chain of equal beads that a mass strikes: force, speed and width.

    Needs --spheres, and --velocity or --drop unless the file has a striker. Units are those of the
    file; the width is that of a contact's force. Gravity acts on the striker that falls, and is
    neglected in the chain.
    """
    cell = chain.cell
    # Refusals propose a simulation of the file, which takes what the rule lacks.
    simulation = f"try: lwa-validate run {shlex.quote(chain.file)}"
    # The relation of a strike rests on the wave without load, which scales with the force.
    if chain.precompression is not None:
        raise InputError(
            f"precompression is {chain.precompression} in {chain.file}: the pulse of a strike is "
            f"that of a chain without load; leave the key out; {simulation}"
        )
    # A closed form of unlike beads knows no striker.
    if not cell.uniform:
        raise InputError(
            f"{chain.file} has unlike beads or contacts: the pulse is that of equal ones, and a "
            f"simulation takes any; {simulation}"
        )
    # Speed and width are lengths, which a file of masses may lack.
    if cell.spacing.is_Symbol:
        raise InputError(
            f"{chain.file} has no spacing: add spacings = 1.0 to [chain]; try: {KEYS}"
        )
    # Options stand above the file, whose striker may have the velocity 0.
    if velocity is None and drop is None:
        velocity = chain.striker.get("velocity") or None
        drop = chain.striker.get("drop")
    if velocity is None and drop is None:
        raise InputError(f"{chain.file} has no striker that moves", velocity="1")
    # A striker is one of the beads unless it is described.
    if mass is None:
        mass = chain.striker.get("mass", cell.masses[0])
    pulse = pulse_of_strike(cell, mass, velocity, drop=drop, k=chain.law.exponent)
    # First the two masses, whose ratio decides how exact the pulse's numbers below are.
    rows: Lines = [
        f"chain of equal beads; F = A δ^k, k = {chain.law.exponent}",
        Row("", "mass of the beads (kg)", cell.masses[0]),
        *rows_of(
            pulse,
            mass="mass of the striker (kg)",
            velocity="velocity of the striker (m/s)",
        ),
        "",
        "leading pulse:",
        *rows_of(pulse, force="peak contact force (N)", speed="speed dx/dt (m/s)"),
        Row("fwhm.length", "FWHM of the force (m)", pulse.fwhm("force", "length")),
        Row("fwhm.time", "FWHM of the force in time (s)", pulse.fwhm()),
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
    return Answer({}, rows, chain.scale, [pulse], errors, notes)


@command(
    "lwa shock --k 3/2 --masses 1 --spacing 1 --behind 2 --ahead 1",
    "lwa shock --k 3/2 --masses 1 --behind 1",
    page="shocks",
)
@CELL
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
    chain: ChainInput,
    behind: sp.Expr | None,
    piston: sp.Expr | None,
    ahead: sp.Expr | None,
) -> Answer:
    """Shock, or rarefaction, of a chain that a wall drives.

    Needs --behind or --piston. Speeds are dx/dt, in m/s with --spheres. Two rules give the leading
    edge: El's conditions for dispersive shocks (dispersion), and the solitary wave whose beads
    reach twice the velocity of the wall (doubling).

    In JSON `plateau` is the velocity of the wall, and `peak` the strain of the leading pulse by the
    doubling rule. Errors were measured on driven chains; closed forms without an error are exact
    for the law. Values that no theory here gives are null; `notes` has the reason.
    """
    if behind is None and piston is None:
        raise InputError("neither --behind nor --piston is given", behind=1)
    cell = chain.cell
    law = chain.law
    if ahead is None:
        ahead = sp.S.Zero
        # A load of the file is a force, and the state ahead of the front a strain.
        if chain.precompression is not None:
            ahead = law.compression(cell, chain.precompression) / cell.spacing
    if behind is None:
        front = fronts.piston(cell, piston, ahead, law=law)
    else:
        front = fronts.shock(cell, behind, ahead, law=law)

    kind: str | None = None
    with suppress(InputError):  # with symbols nobody knows whether the front is a shock
        kind = front.kind
    rows: Lines = [
        chain.text,
        *rows_of(front, behind="strain behind", ahead="strain ahead"),
        "",
        f"{kind or 'front'}, speeds dx/dt:",
        *rows_of(
            front,
            plateau="velocity of the wall (m/s)",
            trailing_speed="trailing edge (m/s)",
        ),
    ]
    for rule in RULES:
        label = f"leading edge, {rule} (m/s)"
        key = f"leading_speed.{rule}"
        rows.append(Row.of(front, "leading_speed", label, rule, key=key))
    if kind != "rarefaction":  # which has no leading pulse
        rows += rows_of(
            front,
            peak="peak strain, doubling",
            peak_force="peak force, doubling (N)",
        )
    # The closed form takes the strain behind for constant. c₋ and c₊ are the speeds of sound behind
    # the front and ahead of it.
    notes = []
    if front.oscillates:
        notes.append(
            "c₋ > 2 c₊: the beads near the wall go on oscillating. The strain behind is that of a "
            "wall at rest beside its neighbours, v_p = ∫ c dp; the mean strain is below it."
        )
    errors = "bound of the difference to driven chains, as measured"
    return Answer({"kind": kind}, rows, chain.scale, [front], errors, notes)
