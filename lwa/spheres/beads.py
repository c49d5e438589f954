"""Files of beads: materials, beads and the table of the chain, in scenes and lists of spheres.

A file of spheres holds, in SI, for which scenes and commands take the numbers of spheres::

    [materials.resin]             # any name
    E = 3e9                       # Young's modulus
    nu = 0.4                      # Poisson's ratio
    density = 1200                # for beads without a mass
    [materials.soft]
    like = "PTFE"                 # a material of `lwa.spheres.hertz` …
    E = 0.6e9                     # … but for this
    [beads.ball]                  # any name
    radius = 2.38e-3
    mass = 0.45e-3                # or density, or that of the material
    material = "steel 316"        # of the file or, in SI, of `lwa.spheres.hertz`
    [beads.light]
    radius = 2.38e-3
    material = "soft"
    [chain]
    cell = ["ball", "light"]      # names of beads, in their order

These are tables of a scene (`validation.scenes.scenefile`), and any scene is such a file: the
readers of this module leave its other entries alone. A chain of masses has numbers in ``cell`` and
its contacts beside them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.files import (
    Table,
    among,
    array,
    each,
    finite,
    integer,
    named,
    positive,
    table,
)
from lwa.spheres.hertz import BY_NAME, Material, Sphere

GRAVITY = sp.Rational("9.81")
"""Gravity in m/s², of strikers that drop and of the scenes."""

FILE = (
    "duration",
    "units",
    "samples",
    "gravity",
    "precompression",
    "materials",
    "beads",
    "chain",
    "defects",
    "wall",
    "damping",
    "drive",
    "striker",
    "start",
    "sensors",
)
"""Keys of a file."""

CHAIN = ("cell", "k", "law", "stiffnesses", "spacings", "repeat")
"""Keys of the table ``chain``; beads with names have ``cell`` and ``repeat`` alone."""

STRIKER = ("velocity", "drop", "like", "mass")
"""Keys of the table ``striker``: velocity of bead 1 or height of its fall, and the name of a bead
like it, or its mass."""


def read_materials(file: Table) -> dict[str, Material]:
    """Materials by name: the built-in ones, and those of a file."""
    materials: dict[str, Material] = file.read("materials", named(_material), {})
    # A file's own names come first in lists, and its values stand above the built-in ones.
    return materials | BY_NAME | materials


def striker_velocity(striker: Table) -> float:
    """Read the velocity of the table ``striker``, or that of a fall from the height ``drop``."""
    if striker.one("velocity", "drop") == "velocity":
        return float(striker.read("velocity", positive))
    return math.sqrt(2 * float(GRAVITY) * striker.read("drop", positive))


def read_beads(file: Table, materials: Mapping[str, Material]) -> dict[str, Sphere]:
    """Read the table ``beads`` of a parsed file: a mapping from names to spheres."""
    beads: dict[str, Sphere] = file.read(
        "beads", named(partial(_bead, materials=materials)), {}
    )
    return beads


@dataclass(frozen=True)
class Row:
    """The table ``chain`` of a file.

    Parameters
    ----------
    given : Table
        The table itself, for ``k`` and ``law``.
    spheres, masses : list of Sphere, list of float
        The beads in one cell, as one of the two; the other is empty.
    repeat : int
        Number of cells.
    stiffnesses, spacings : list of float
        Values by contact, of one cell or of the whole chain; empty where not given.
    """

    given: Table
    spheres: list[Sphere]
    masses: list[float]
    repeat: int
    stiffnesses: list[float]
    spacings: list[float]

    @property
    def size(self) -> int:
        """The number of beads in the chain."""
        return self.repeat * len(self.spheres or self.masses)

    def by_contact(self, values: list[float]) -> list[float]:
        """Return one value for each contact between two beads of the chain; [] if none is given."""
        contacts = self.size - 1
        if len(values) == contacts:
            return values
        # The last contact of the last cell joins the chain to nothing.
        return (values * self.repeat)[:contacts]


def read_row(file: Table, beads: Mapping[str, Sphere]) -> Row:
    """Read the table ``chain``, whose cell holds names of these beads or masses."""
    given = file.read("chain", table(CHAIN))
    cell = given.read("cell", array)
    # An array of TOML may be empty; a cell of no beads has no mass.
    if not cell:
        raise InputError(
            "chain.cell is empty: names, or masses, of one bead or more are wanted"
        )
    repeat = given.read("repeat", partial(integer, low=1), 1)
    spheres: list[Sphere] = []
    masses: list[float] = []
    if isinstance(cell[0], str):
        spheres = each(among(beads))(cell, "chain.cell")
        # Spheres have the law of Hertz, and touch where the chain is unloaded.
        for key in ("k", "law", "stiffnesses", "spacings"):
            if key in given:
                raise InputError(
                    f"chain.{key} is given, but named beads are in Hertz contact"
                )
    else:
        masses = each(positive)(cell, "chain.cell")
    contacts = partial(_by_contact, period=len(cell), beads=len(cell) * repeat)
    stiffnesses = given.read("stiffnesses", contacts, [])
    spacings = given.read("spacings", contacts, [])
    return Row(given, spheres, masses, repeat, stiffnesses, spacings)


def _by_contact(value: Any, name: str, period: int, beads: int) -> list[float]:
    """Read one number for all contacts, one for each of a cell, or one for each of the chain."""
    if not isinstance(value, list):
        return [positive(value, name)] * period
    numbers: list[float] = each(positive)(value, name)
    # A row of beads has one contact less than beads.
    if len(numbers) not in (period, beads - 1):
        wanted = " or ".join(map(str, sorted({period, beads - 1})))
        raise InputError(
            f"{name} holds {len(numbers)}: {wanted} are wanted, or one number"
        )
    return numbers


def period(*rows: Sequence[Any]) -> int:
    """Size of the smallest cell whose repetition, the last one whole or cut, gives all rows."""
    size = 1
    # A row has the period P if, moved by P, it agrees with itself where the two overlap.
    while any(row[size:] != row[: max(len(row) - size, 0)] for row in rows):
        size += 1
    return size


def spheres(content: Any) -> list[Sphere]:
    """Read the spheres of the cell of a parsed file (see the module), in their order.

    >>> steel, ball = {"E": 193e9, "nu": 0.3}, {"mass": 1, "radius": 0.5, "material": "steel"}
    >>> content = {"materials": {"steel": steel}, "beads": {"ball": ball}}
    >>> [sphere.mass for sphere in spheres(content | {"chain": {"cell": ["ball", "ball"]}})]
    [1, 1]
    """
    file = Table(content, "", FILE)
    row = read_row(file, read_beads(file, read_materials(file)))
    if not row.spheres:
        raise InputError("chain.cell holds masses: the names of beads are wanted")
    return row.spheres


def _material(value: Any, name: str) -> Material:
    """Read a material: E, ν and the density, or a known material and the numbers that differ."""
    entries = Table(value, name, ("like", "E", "nu", "density"))
    # Density is needed by beads without a mass alone, which ask for it.
    needed = {"E", "nu"}
    values: dict[str, Any] = {}
    if "like" in entries:
        values = vars(entries.read("like", among(BY_NAME)))
        needed = set()
    for key, read in {"E": positive, "nu": finite, "density": positive}.items():
        # A needed key that is missing is refused by its reader.
        if key in entries or key in needed:
            values = values | {key: entries.read(key, read)}
    try:
        return Material(**values)
    except InputError as fault:
        # A material does not know its name in the file.
        raise InputError(f"{name}.{fault}") from None


def _bead(value: Any, name: str, materials: Mapping[str, Material]) -> Sphere:
    """Read a bead: its radius and material, and its mass or the density of a solid sphere."""
    entries = Table(value, name, ("mass", "density", "radius", "material"))
    radius = entries.read("radius", positive)
    material = entries.read("material", among(materials))
    if "mass" in entries and "density" in entries:
        raise InputError(f"{name} has both mass and density: one is wanted")
    if "mass" in entries:
        return Sphere(entries.read("mass", positive), radius, material)
    if "density" not in entries and material.density is None:
        raise InputError(
            f"{name}.mass is missing: it, or a density here or of the material"
        )
    density = entries.read("density", positive, material.density)
    return Sphere.solid(radius, material, density)
