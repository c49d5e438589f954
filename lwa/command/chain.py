"""The chain of a command, from its options or from a file.

A file is a scene of `lwa-validate run`, or the part of one that describes spheres. Entries such as
length, wall, defects and sensors do not enter the theory.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.files import Reader, Table, among, finite, load, positive, table
from lwa.base.frozen import RISE, SPEED
from lwa.cell import Cell, D
from lwa.command.answer import Row, Scale
from lwa.law import ContactLaw, Power, for_cell, read_law
from lwa.spheres.beads import (
    FILE,
    STRIKER,
    Row as Beads,
    period,
    read_beads,
    read_materials,
    read_row,
)
from lwa.spheres.hertz import EXPONENT

HERTZIAN = 0.01
"""Compression over the spacing from which on a note is printed: the radius of contact of equal
spheres is then a tenth of their radius R, ``a/R = √(δ/2R)``, where Hertz (1882) wants a ≪ R."""

STRIKER_FILE = "lwa-validate run --example striker > chain.toml"
"""The line that writes a file of equal beads and a striker."""


@dataclass(frozen=True)
class ChainInput:
    """A chain as the options of a command or a file describe it.

    Parameters
    ----------
    cell : Cell
        One period of the chain.
    law : ContactLaw
        The law of its contacts.
    precompression : Expr, optional
        Static force of the chain, of an option or of the file.
    si : bool
        True if the numbers are in SI.
    file : str
        Name of the file; empty for a chain of options.
    striker : mapping
        Numbers of a file's striker: "velocity" or "drop", and "mass", as far as they are given.
    gravity : float
        Acceleration along the chain, of a file; no theory here takes it into account.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr | None = None
    si: bool = False
    file: str = ""
    striker: Mapping[str, sp.Expr] = field(default_factory=dict)
    gravity: float = 0.0

    @property
    def scale(self) -> Scale:
        """The units of the chain's numbers."""
        return Scale(self.si, self.cell.spacing)

    @property
    def text(self) -> str:
        """One line of text with the masses, the contacts and the spacing of the chain."""
        # The unit of A is that of force over F, which under another law depends on its parameters.
        force = f"A F, F = {self.law.F}"
        stiffness = "A"
        if self.law.homogeneous:
            k = self.law.exponent
            force = f"A δ^k, k = {k}"
            stiffness = f"A (N/m^({k}))"
        parts = []
        for label, value in {
            "masses (kg)": self.cell.masses,
            stiffness: self.cell.stiffnesses,
            "spacing D (m)": self.cell.spacing,
        }.items():
            parts.append(Row("", label, value).text(self.scale))
        masses, stiffnesses, spacing = parts
        return f"{masses}; contact force {force}, {stiffnesses}; {spacing}"

    def hertz_notes(self, force: sp.Expr) -> list[str]:
        """A note on a force that presses spheres too much for Hertz's contact; [] for others."""
        if not self.si or self.law.exponent != EXPONENT or force.free_symbols:
            return []
        # The mean compression stands for those of unlike contacts: a note is no measurement.
        strain = float(self.law.compression(self.cell, force) / self.cell.spacing)
        if strain < HERTZIAN:
            return []
        return [
            f"contacts are compressed by {strain:.2g} of the spacing: Hertz's contact is that of "
            f"elastic spheres up to about {HERTZIAN}, and metals yield before"
        ]


def take_chain(options: dict[str, Any]) -> ChainInput:
    """Remove the options that describe a chain from a command's options and return the chain."""
    # Options that do not describe the chain stay: they belong to its theory.
    masses = options.pop("masses", None)
    stiffnesses = options.pop("stiffnesses", None)
    spacing = options.pop("spacing", None)
    k = options.pop("k", None)
    law = options.pop("law", None)
    load = options.pop("precompression", None)
    file = options.pop("spheres", None)
    if file is not None:
        chain = read_chain(file)
        if chain.precompression is None:
            return replace(chain, precompression=load)
        # A static strain is a load, too.
        if load is None and options.get("background") is None:
            return chain
        # The line to paste is the user's without both options: None leaves an option out.
        raise InputError(
            f"the file has a precompression of {chain.precompression}: give no other load",
            precompression=None,
            background=None,
        )
    if masses is None:  # a command that reads files alone
        raise InputError(
            f"the chain is read from a file by --spheres; try: {STRIKER_FILE}"
        )
    cell = Cell(masses, stiffnesses or (), spacing or D)
    law = for_cell(law, cell, k)
    # A name with two meanings would be one symbol: D = 1 would then set a mass D, too. A mass and a
    # stiffness may well be one number.
    names = (
        RISE,
        SPEED,
        cell.spacing,
        *law.symbols,
        *set(cell.masses + cell.stiffnesses),
    )
    for name in names:
        if name.is_Symbol and names.count(name) > 1:
            raise InputError(
                f"{name} has two meanings: beside the law's symbols {cell.spacing} is the spacing, "
                f"{RISE} and {SPEED} are a wave's peak strain and speed"
            )
    return ChainInput(cell, law, load)


def read_chain(path: str) -> ChainInput:
    """Read the chain of a file.

    Raises `lwa.InputError`, in one line that names file and key, for invalid content.
    """
    return replace(load(path, "a list of spheres", _chain), file=path)


def _chain(content: Any) -> ChainInput:
    """Read the chain of a file's content."""
    file = Table(content, "", FILE)
    beads = read_beads(file, read_materials(file))
    row = read_row(file, beads)
    force = _numbers(file, {"precompression": finite}).get("precompression", sp.S.Zero)
    # Hertz contacts only push.
    if force < 0:
        raise InputError(f"precompression is {force}: it must not be negative")
    described = file.read("striker", table(STRIKER), Table({}, "striker", STRIKER))
    numbers = {"velocity": finite, "drop": positive, "mass": positive}
    striker = _numbers(described, numbers)
    if "like" in described:
        striker["mass"] = described.read("like", among(beads)).mass
    law: ContactLaw
    si = True
    if row.spheres:  # beads with names are in Hertz contact, and in SI
        cell = Cell.of_spheres(row.spheres)
        law = Power(EXPONENT)
    else:
        cell = _cell_of_masses(row)
        # Masses have no material: their contacts need an exponent or a law.
        if row.given.one("k", "law") == "law":
            law = row.given.read("law", read_law)
        else:
            law = Power(row.given.read("k", finite))
        # Numbers of masses have the units of the file, and SI only where the file says so.
        si = file.read("units", among({"SI": True}), False)
    gravity = file.read("gravity", finite, 0.0)
    return ChainInput(cell, law, force or None, si, striker=striker, gravity=gravity)


def _numbers(entries: Table, readers: Mapping[str, Reader]) -> dict[str, sp.Expr]:
    """Read the entries that a table has exactly, as the decimals that they print as."""
    found = {}
    for key, reader in readers.items():
        if key in entries:
            found[key] = sp.Rational(str(entries.read(key, reader)))
    return found


def _cell_of_masses(row: Beads) -> Cell:
    """The smallest periodic cell of a chain of masses."""
    # Two cells in a row show how a cell that repeats goes on: 1, 2, 1 has the period 3, not 2.
    masses = row.masses * min(row.repeat, 2)
    stiffnesses = row.stiffnesses or [1.0]
    P = period(masses, stiffnesses)
    contacts = [stiffnesses[i % len(stiffnesses)] for i in range(P)]
    spacing: sp.Expr = D
    if row.spacings:  # the theory knows their mean
        spacing = sp.Rational(str(sum(row.spacings) / len(row.spacings)))
    return Cell(tuple(masses[:P]), tuple(contacts), spacing)
