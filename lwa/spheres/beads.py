"""Beads and their materials in files: scenes of the lattice, or the spheres of a cell.

A file of spheres holds, in units that agree (SI if A is to be in N/m^{3/2})::

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

These are tables of a scene (`validation.scenes.scenefile`), and any scene of beads is such a file;
the load and the other entries of the scene are ignored.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from lwa.base.exact import InputError
from lwa.base.tables import Table, among, array, each, finite, named, positive, table
from lwa.spheres.hertz import MATERIALS, Material, Sphere

SCENE = (
    "duration",
    "samples",
    "units",
    "gravity",
    "defects",
    "wall",
    "striker",
    "start",
    "sensors",
    "damping",
    "drive",
)
"""Keys of a scene that do not concern its cell."""


def read_materials(file: Table) -> dict[str, Material]:
    """Materials by name: the built-in `MATERIALS`, and those of a file, which come first."""
    materials: dict[str, Material] = file.read("materials", named(_material), {})
    return materials | MATERIALS | materials  # the names of the file come first


def read_beads(file: Table, materials: Mapping[str, Material]) -> dict[str, Sphere]:
    """Read the table ``beads`` of a parsed file: a mapping from names to spheres."""
    beads: dict[str, Sphere] = file.read("beads", named(partial(_bead, materials=materials)), {})
    return beads


def spheres(content: Any) -> list[Sphere]:
    """Read the spheres of the cell of a parsed file (see the module), in their order.

    >>> steel, ball = {"E": 193e9, "nu": 0.3}, {"mass": 1, "radius": 0.5, "material": "steel"}
    >>> content = {"materials": {"steel": steel}, "beads": {"ball": ball}}
    >>> [sphere.mass for sphere in spheres(content | {"chain": {"cell": ["ball", "ball"]}})]
    [1, 1]
    """
    file = Table(content, "", ("materials", "beads", "chain", "precompression", *SCENE))
    beads = read_beads(file, read_materials(file))
    cell = file.read("chain", table(("cell", "repeat"))).read("cell", array)
    if not cell:
        raise InputError("chain.cell is empty: the names of one bead or more are wanted")
    row: list[Sphere] = each(among(beads))(cell, "chain.cell")
    return row


def _material(value: Any, name: str) -> Material:
    entries = Table(value, name, ("like", "E", "nu", "density"))
    like = entries.read("like", among(MATERIALS)) if "like" in entries else None
    readers = {"E": positive, "nu": finite, "density": positive}
    keys = [key for key in readers if key in entries or (like is None and key != "density")]
    values = {key: entries.read(key, readers[key]) for key in keys}
    try:
        return replace(like, **values) if like else Material(**values)
    except InputError as fault:
        raise InputError(f"{name}.{fault}") from None


def _bead(value: Any, name: str, materials: Mapping[str, Material]) -> Sphere:
    entries = Table(value, name, ("mass", "density", "radius", "material"))
    radius = entries.read("radius", positive)
    material = entries.read("material", among(materials))
    if "mass" in entries and "density" in entries:
        raise InputError(f"{name} has both mass and density: one is wanted")
    if "mass" in entries:
        return Sphere(entries.read("mass", positive), radius, material)
    if "density" not in entries and material.density is None:
        raise InputError(f"{name}.mass is missing: it, or a density here or of the material")
    return Sphere.solid(radius, material, entries.read("density", positive, material.density))
