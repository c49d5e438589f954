"""The chain of a command, from its options or from a file.

A file is a scene of `lwa-validate run`, or the part of one that describes spheres. Entries such as
length, wall, defects and sensors do not enter the theory.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.files import Reader, Table, among, finite, load, positive, table
from lwa.cell import Cell, D
from lwa.command.answer import Row, Scale
from lwa.law import ContactLaw, Power, for_cell, read_law
from lwa.spheres.beads import (
    FILE,
    STRIKER,
    period,
    read_beads,
    read_materials,
    read_row,
)
from lwa.spheres.beads import Row as Beads
from lwa.spheres.hertz import EXPONENT

HERTZIAN = 0.01
"""Compression over the spacing from which on a note is printed: the radius of contact of equal
spheres is then a tenth of their radius R, ``a/R = √(δ/2R)``, where Hertz (1882) wants a ≪ R."""


@dataclass(frozen=True)
class Striker:
    """The striker of a file: numbers that are not given there are None."""

    velocity: sp.Expr | None = None
    drop: sp.Expr | None = None
    mass: sp.Expr | None = None


@dataclass(frozen=True)
class ChainInput:
    """A chain as the options of a command or a file describe it.

    Parameters
    ----------
    cell : Cell
        One period of the chain.
    law : ContactLaw
        The law of its contacts.
    precompression : Expr
        Static force of the chain, 0 for none.
    si : bool
        True if the numbers are in SI.
    striker : Striker
        The striker of a file.
    gravity : float
        Acceleration along the chain, of a file; no theory here takes it into account.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr = sp.S.Zero
    si: bool = False
    striker: Striker = Striker()
    gravity: float = 0.0

    @property
    def scale(self) -> Scale:
        """The units of the chain's numbers."""
        return Scale(self.si, self.cell.spacing)

    @property
    def text(self) -> str:
        """One line of text with the masses, the contacts and the spacing of the chain."""
        # The exponent with which a force begins gives the unit of A.
        k = self.law.exponent
        force = f"A F, F = {self.law.F}"
        if self.law.homogeneous:
            force = f"A δ^k, k = {k}"
        scale = self.scale
        masses = Row("", "masses", self.cell.masses, "kg").text(scale)
        stiffnesses = Row("", "A", self.cell.stiffnesses, f"N/m^({k})").text(scale)
        spacing = Row("", "spacing D", self.cell.spacing, "m").text(scale)
        return f"{masses}; contact force {force}, {stiffnesses}; {spacing}"

    def load(self, given: sp.Expr | None, background: sp.Expr | None) -> sp.Expr | None:
        """The static force of the chain: the file's, else that of an option; None without both.

        A ``background`` is a strain and never the result: it is only checked here, against a second
        load in the file. With a background alone the result is None.

        Parameters
        ----------
        given : Expr, optional
            Value of ``--precompression``, a static force.
        background : Expr, optional
            Value of ``--background``, a static strain, which is another form of a load.

        Raises
        ------
        lwa.InputError
            For a file with a precompression, and a load by an option.
        """
        if self.precompression and not (given is None and background is None):
            # The line to paste is the user's without both options: None leaves an option out.
            raise InputError(
                f"the file has a precompression of {self.precompression}: give no other load",
                precompression=None,
                background=None,
            )
        return self.precompression or given

    def hertz_notes(self, force: sp.Expr) -> list[str]:
        """A note on a force that presses spheres too much for Hertz's contact; [] for others."""
        if not self.si or self.law.exponent != EXPONENT or force.free_symbols:
            return []
        # Of unlike contacts the mean: a note is no measurement.
        strain = float(self.law.compression(self.cell, force) / self.cell.spacing)
        if strain < HERTZIAN:
            return []
        return [
            f"contacts are compressed by {strain:.2g} of the spacing: Hertz's contact is that of "
            f"elastic spheres up to about {HERTZIAN}, and metals yield before"
        ]


def take_chain(options: dict[str, Any]) -> ChainInput:
    """Remove the options that describe a chain from a command's options and return the chain."""
    # What is left in the options belongs to the theory of the chain.
    names = ("masses", "stiffnesses", "spacing", "k", "law")
    chosen = {name: options.pop(name) for name in names if name in options}
    file = options.pop("spheres", None)
    if file is not None:
        return read_chain(file)
    cell = Cell(chosen["masses"], chosen["stiffnesses"] or (), chosen.get("spacing", D))
    # D = 1 would then set k, too.
    if cell.spacing.is_Symbol and chosen["k"] == cell.spacing:
        raise InputError(
            f"k is {cell.spacing}: the name is that of the spacing, a unit of length"
        )
    return ChainInput(cell, for_cell(chosen.get("law"), cell, chosen["k"]))


def read_chain(path: str | Path) -> ChainInput:
    """Read the chain of a file.

    Raises `lwa.InputError`, in one line that names file and key, for invalid content.
    """
    return load(path, "a list of spheres", _chain)


def _chain(content: Any) -> ChainInput:
    file = Table(content, "", FILE)
    beads = read_beads(file, read_materials(file))
    row = read_row(file, beads)
    force = _number(file, "precompression", finite) or sp.S.Zero
    # Hertz contacts only push.
    if force < 0:
        raise InputError(f"precompression is {force}: it must not be negative")
    # A striker of zero velocity is none; it may be given by an option then.
    described = file.read("striker", table(STRIKER), Table({}, "striker", STRIKER))
    like = described.read("like", among(beads)) if "like" in described else None
    striker = Striker(
        velocity=_number(described, "velocity", finite) or None,
        drop=_number(described, "drop", positive),
        mass=like and like.mass,
    )
    gravity = file.read("gravity", finite, 0.0)
    if row.spheres:  # beads with names are in Hertz contact, and in SI
        cell = Cell.of_spheres(row.spheres)
        return ChainInput(cell, Power(EXPONENT), force, True, striker, gravity)
    law: ContactLaw
    # Masses have no material: their contacts need an exponent or a law.
    if row.given.one("k", "law") == "law":
        law = row.given.read("law", read_law)
    else:
        law = Power(row.given.read("k", finite))
    # Numbers of masses have the units of the file, and SI only where the file says so.
    si = file.read("units", among({"SI": True}), False)
    return ChainInput(_cell_of_masses(row), law, force, si, striker, gravity)


def _number(entries: Table, key: str, reader: Reader) -> sp.Rational | None:
    """Read an entry exactly, as the decimal that it prints as; None if it is absent."""
    if key not in entries:
        return None
    return sp.Rational(str(entries.read(key, reader)))


def _cell_of_masses(row: Beads) -> Cell:
    """The smallest periodic cell of a chain of masses."""
    # Two cells show a period that is longer than one half of a cell.
    masses = row.masses * min(row.repeat, 2)
    stiffnesses = row.stiffnesses or [1.0]
    P = period(masses, stiffnesses)
    contacts = [stiffnesses[i % len(stiffnesses)] for i in range(P)]
    spacing: sp.Expr = D
    if row.spacings:  # the theory knows their mean
        spacing = sp.Rational(str(sum(row.spacings) / len(row.spacings)))
    return Cell(tuple(masses[:P]), tuple(contacts), spacing)
