"""Beads and their materials as a file names them: a scene of the lattice, or a cell's spheres.

A file of spheres holds, in units that agree (SI if A is to be in N/m^{3/2})::

    [materials.steel]             # any name
    E = 193e9                     # Young's modulus
    nu = 0.3                      # Poisson's ratio
    [beads.ball]                  # any name
    mass = 0.45e-3
    radius = 2.38e-3
    material = "steel"
    [chain]
    cell = ["ball", "ball"]       # names of beads, in their order

These are tables of a scene (`validation.scenes.scenefile`), and any scene of beads without
precompression is such a file: what else it says about its finite chain is not asked for here.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from lwa.exact import InputError
from lwa.spheres.files import load
from lwa.spheres.hertz import Material, Sphere
from lwa.spheres.tables import Table, among, array, each, named, positive, real, table

SCENE = ("duration", "samples", "gravity", "defects", "wall", "striker", "start", "sensors")
"""Keys of a scene that say nothing about its cell."""


def read_materials(file: Table) -> dict[str, Material]:
    """The materials of a file, by name."""
    materials: dict[str, Material] = file.read("materials", named(_material), {})
    return materials


def read_beads(file: Table, materials: Mapping[str, Material]) -> dict[str, Sphere]:
    """The beads of a file, by name."""
    beads: dict[str, Sphere] = file.read("beads", named(partial(_bead, materials=materials)), {})
    return beads


def read_spheres(path: str | Path) -> list[Sphere]:
    """The spheres of the cell that a file describes, in their order.

    Raises `lwa.InputError`, in one line that names file and key, for whatever it cannot mean.
    """
    return load(path, "a list of spheres", spheres)


def spheres(content: Any) -> list[Sphere]:
    """The spheres of the cell of a parsed file, see the module.

    >>> steel, ball = {"E": 193e9, "nu": 0.3}, {"mass": 1, "radius": 0.5, "material": "steel"}
    >>> content = {"materials": {"steel": steel}, "beads": {"ball": ball}}
    >>> [sphere.mass for sphere in spheres(content | {"chain": {"cell": ["ball", "ball"]}})]
    [1, 1]
    """
    file = Table(content, "", ("materials", "beads", "chain", "precompression", *SCENE))
    if file.read("precompression", real, 0.0):
        raise InputError("precompression is given: the wave is that of a chain without load")
    beads = read_beads(file, read_materials(file))
    cell = file.read("chain", table(("cell", "repeat"))).read("cell", array)
    if not cell:
        raise InputError("chain.cell is empty: the names of one bead or more are wanted")
    found: list[Sphere] = each(among(beads))(cell, "chain.cell")
    return found


def _material(value: Any, name: str) -> Material:
    given = Table(value, name, ("E", "nu"))
    E, nu = given.read("E", positive), given.read("nu", real)
    try:
        return Material(E, nu)
    except InputError as error:
        raise InputError(f"{name}.{error}") from None


def _bead(value: Any, name: str, materials: Mapping[str, Material]) -> Sphere:
    given = Table(value, name, ("mass", "radius", "material"))
    return Sphere(
        mass=given.read("mass", positive),
        radius=given.read("radius", positive),
        material=given.read("material", among(materials)),
    )
