"""The chain of a command, from its options or from a file.

A file is a scene of `lwa-validate run`, or the part of one that describes spheres. Entries such as
length, striker, wall, defects and sensors do not enter the theory.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.files import load
from lwa.base.tables import Table, among, array, each, finite, positive, table
from lwa.cell import Cell, D
from lwa.command.options import given
from lwa.law import ContactLaw, Power, read_law, refuse_two_laws
from lwa.spheres.beads import SCENE, spheres
from lwa.spheres.hertz import EXPONENT

_KEYS = ("cell", "repeat", "k", "law", "stiffnesses", "spacings")


@dataclass(frozen=True)
class ChainInput:
    """A chain as the options of a command or a file describe it.

    precompression : static force of the chain, 0 for none. si : True if the numbers are in SI.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr = sp.S.Zero
    si: bool = False

    @property
    def text(self) -> str:
        """One line of text with the masses and the contact law of the chain."""
        masses = ", ".join(map(str, self.cell.masses))
        return f"masses {masses}; contact force A F, F = {self.law.F}"

    def load(self, background: sp.Expr | None, precompression: sp.Expr | None) -> sp.Expr | None:
        """Static force of the file or of the options; raises `lwa.InputError` for two loads."""
        static = self.precompression
        if static and (background is not None or precompression is not None):
            raise InputError(f"the file has a precompression of {static}: give no other load")
        return static or precompression

    def without_load(self) -> list[str]:
        """Note on a result that leaves out the static force of the file; [] without a force."""
        if not self.precompression:
            return []
        force = f"{float(self.precompression):g}{' N' * self.si}"
        without = "is left out: the theory used is of a chain without"
        return [f"the load of the file, {force}, {without}"]


def take_chain(options: dict[str, Any]) -> ChainInput:
    """Remove the options that describe a chain from a command's options and return the chain."""
    names = ("masses", "stiffnesses", "spacing", "k", "law")
    chosen = {name: options.pop(name) for name in names if name in options}
    file = options.pop("spheres", None)
    if file is not None:
        for name in filter(given, chosen):
            raise InputError(f"--{name} and --spheres are both given: spheres have their own")
        return read_chain(file)
    law = chosen.get("law")
    if law is not None:
        refuse_two_laws(chosen["k"], law)
    cell = Cell(chosen["masses"], chosen["stiffnesses"], chosen.get("spacing", D))
    return ChainInput(cell, law or Power(chosen["k"]))


def read_chain(path: str | Path) -> ChainInput:
    """Read the chain of a file.

    Raises `lwa.InputError`, in one line that names file and key, for invalid content.
    """
    return load(path, "a list of spheres", _chain)


def _chain(content: Any) -> ChainInput:
    if isinstance(content, dict) and "scene" in content:  # as `lwa-validate run --out` writes
        content = content["scene"]
    file = Table(content, "", ("materials", "beads", "chain", "precompression", *SCENE))
    chain = file.read("chain", table(_KEYS))
    row = chain.read("cell", array)
    if not row:
        raise InputError("chain.cell is empty: the names of one bead or more are wanted")
    force = sp.Rational(str(file.read("precompression", finite, 0.0)))
    if force < 0:
        raise InputError(f"precompression is {force}: it must not be negative")
    if isinstance(row[0], int | float):
        return ChainInput(*_of_masses(chain), force, file.read("units", among({"SI": True}), False))
    return ChainInput(Cell.of_spheres(spheres(content)), Power(EXPONENT), force, True)


def _of_masses(chain: Table) -> tuple[Cell, ContactLaw]:
    """Read masses and contacts as the smallest periodic cell, and the contact law."""
    repeat = int(chain.read("repeat", positive, 1))
    masses = chain.read("cell", each(positive))
    contacts = partial(_contacts, period=len(masses), beads=len(masses) * repeat)
    stiffnesses = chain.read("stiffnesses", contacts, [1.0])
    spacings = chain.read("spacings", contacts, [])
    P = _period(masses * min(repeat, 2), stiffnesses)
    stiffnesses = [stiffnesses[i % len(stiffnesses)] for i in range(P)]
    spacing = sp.Rational(str(sum(spacings) / len(spacings))) if spacings else D
    cell = Cell(tuple(masses[:P]), tuple(stiffnesses), spacing)
    return cell, chain.read("law", read_law) if "law" in chain else Power(chain.read("k", finite))


def _contacts(value: Any, name: str, period: int, beads: int) -> list[float]:
    """Read one value for all contacts, one for each of a cell, or one for each of the chain."""
    if not isinstance(value, list):
        return [positive(value, name)]
    values: list[float] = each(positive)(value, name)
    if len(values) not in (period, beads - 1, beads):
        raise InputError(f"{name} holds {len(values)}: {period} or {beads - 1} are wanted")
    return values


def _period(masses: Sequence[float], stiffnesses: Sequence[float]) -> int:
    """Number of beads in the smallest cell of a chain."""

    def repeats(values: Sequence[float], P: int) -> bool:
        return all(a == b for a, b in zip(values, values[P:], strict=False))

    return next(
        P for P in range(1, len(masses) + 1) if repeats(masses, P) and repeats(stiffnesses, P)
    )
