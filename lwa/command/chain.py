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
from lwa.base.files import Table, among, finite, load, table
from lwa.cell import Cell, D
from lwa.command.options import given
from lwa.command.rows import approximate
from lwa.law import ContactLaw, Power, for_cell, read_law
from lwa.spheres.beads import (
    FILE,
    STRIKER,
    period,
    read_beads,
    read_materials,
    read_row,
    striker_velocity,
)
from lwa.spheres.hertz import EXPONENT


@dataclass(frozen=True)
class ChainInput:
    """A chain as the options of a command or a file describe it.

    precompression : static force of the chain, 0 for none. si : True if the numbers are in SI.
    velocity, mass : of the striker, where the file names them.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr = sp.S.Zero
    si: bool = False
    velocity: sp.Expr | None = None
    mass: sp.Expr | None = None

    @property
    def text(self) -> str:
        """One line of text with the masses, the contacts and the spacing of the chain."""
        law, cell, k = self.law, self.cell, self.law.exponent
        force = f"A δ^k, k = {k}" if law.homogeneous else f"A F, F = {law.F}"
        write = approximate if self.si else str
        kg, of_A, m = (" kg", f" N/m^({k})", " m") if self.si else ("", "", "")
        masses, A = (
            ", ".join(map(write, row)) for row in (cell.masses, cell.stiffnesses)
        )
        chain = f"masses {masses}{kg}; contact force {force}, A = {A}{of_A}"
        return f"{chain}; spacing D = {write(cell.spacing)}{m}"

    def load(
        self, background: sp.Expr | None, precompression: sp.Expr | None
    ) -> sp.Expr | None:
        """Static force of the file or of the options; raises `lwa.InputError` for two loads."""
        static = self.precompression
        if static and (background is not None or precompression is not None):
            raise InputError(
                f"the file has a precompression of {static}: give no other load"
            )
        return static or precompression


def take_chain(options: dict[str, Any]) -> ChainInput:
    """Remove the options that describe a chain from a command's options and return the chain."""
    names = ("masses", "stiffnesses", "spacing", "k", "law")
    chosen = {name: options.pop(name) for name in names if name in options}
    file = options.pop("spheres", None)
    if file is not None:
        for name in filter(given, chosen):
            raise InputError(
                f"--{name} and --spheres are both given: spheres have their own"
            )
        return read_chain(file)
    cell = Cell(chosen["masses"], chosen["stiffnesses"], chosen.get("spacing", D))
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
    striker = file.read("striker", table(STRIKER), Table({}, "striker", STRIKER))
    velocity = None
    if "velocity" in striker or "drop" in striker:
        velocity = sp.Rational(str(striker_velocity(striker))) or None
    mass = striker.read("like", among(beads)).mass if "like" in striker else None
    force = sp.Rational(str(file.read("precompression", finite, 0.0)))
    if force < 0:
        raise InputError(f"precompression is {force}: it must not be negative")
    if row.spheres:
        return ChainInput(
            Cell.of_spheres(row.spheres), Power(EXPONENT), force, True, velocity, mass
        )
    # the smallest periodic cell of a chain of masses
    masses, stiffnesses = row.masses * min(row.repeat, 2), row.stiffnesses or [1.0]
    P = period(masses, stiffnesses)
    stiffnesses = [stiffnesses[i % len(stiffnesses)] for i in range(P)]
    spacings = row.spacings
    spacing = sp.Rational(str(sum(spacings) / len(spacings))) if spacings else D
    cell = Cell(tuple(masses[:P]), tuple(stiffnesses), spacing)
    named = row.given.one("k", "law") == "law"
    law = (
        row.given.read("law", read_law) if named else Power(row.given.read("k", finite))
    )
    si = file.read("units", among({"SI": True}), False)
    return ChainInput(cell, law, force, si, velocity, mass)
