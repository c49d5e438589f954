"""The chain of a scene's file: its cell, contact law and static load, in SI where it says so.

Every scene file of `lwa-validate run` describes such a chain. Its other entries, such as length,
striker, wall, defects and sensors, do not enter the theory.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.files import load
from lwa.base.tables import Table, among, array, each, positive, real, table
from lwa.cell import Cell, D
from lwa.command.options import ChainInput
from lwa.law import ContactLaw, Power, read_law
from lwa.spheres.beads import SCENE, spheres
from lwa.spheres.hertz import EXPONENT

CHAIN = ("cell", "repeat", "k", "law", "stiffnesses", "spacings")


def read_chain(path: str | Path) -> ChainInput:
    """Read the chain of a file.

    Raises `lwa.InputError`, in one line that names file and key, for invalid content.
    """
    return load(path, "a list of spheres", _chain)


def _chain(content: Any) -> ChainInput:
    if isinstance(content, dict) and "scene" in content:  # as `lwa-validate run --out` writes
        content = content["scene"]
    file = Table(content, "", ("materials", "beads", "chain", "precompression", *SCENE))
    chain = file.read("chain", table(CHAIN))
    row = chain.read("cell", array)
    if not row:
        raise InputError("chain.cell is empty: the names of one bead or more are wanted")
    load = sp.Rational(str(file.read("precompression", real, 0.0)))
    if load < 0:
        raise InputError(f"precompression is {load}: it must not be negative")
    if isinstance(row[0], int | float):
        return ChainInput(*_masses(chain), load, file.read("units", among({"SI": True}), False))
    return ChainInput(Cell.of_spheres(spheres(content)), Power(EXPONENT), load, True)


def _masses(chain: Table) -> tuple[Cell, ContactLaw]:
    """Read the masses and contacts of a chain as its smallest periodic cell, and its law."""
    repeat = int(chain.read("repeat", positive, 1))
    masses = chain.read("cell", each(positive))
    contacts = partial(_contacts, period=len(masses), beads=len(masses) * repeat)
    stiffnesses = chain.read("stiffnesses", contacts, [1.0])
    spacings = chain.read("spacings", contacts, [])
    P = _period(masses, repeat, stiffnesses)
    stiffnesses = [stiffnesses[i % len(stiffnesses)] for i in range(P)]
    spacing = sp.Rational(str(sum(spacings) / len(spacings))) if spacings else D
    cell = Cell(tuple(masses[:P]), tuple(stiffnesses), spacing)
    return cell, chain.read("law", read_law) if "law" in chain else Power(chain.read("k", real))


def _contacts(value: Any, name: str, period: int, beads: int) -> list[float]:
    """Read one stiffness for all contacts, one for each of a cell, or one for each of the chain."""
    if not isinstance(value, list):
        return [positive(value, name)]
    found: list[float] = each(positive)(value, name)
    if len(found) not in (period, beads - 1, beads):
        raise InputError(f"{name} holds {len(found)}: {period} or {beads - 1} are wanted")
    return found


def _period(masses: Sequence[float], repeat: int, stiffnesses: Sequence[float]) -> int:
    """The length of the smallest cell of a chain."""
    row = list(masses) * (2 if repeat > 1 else 1)

    def repeats(values: Sequence[float], P: int) -> bool:
        return all(a == b for a, b in zip(values, values[P:], strict=False))

    return next(P for P in range(1, len(row) + 1) if repeats(row, P) and repeats(stiffnesses, P))
