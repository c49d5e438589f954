"""Scenes of chains that are struck or carry a wave, of unit stiffness, and the paper's beads in SI.

The beads of Porter et al. (2008) are `STEEL_BEAD`, also their striker, and `PTFE_BEAD`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lwa import Cell
from lwa.spheres.hertz import Material, Sphere
from validation.scenes.checks import numeric
from validation.scenes.scene import Scene

STEEL, PTFE = Material.named("steel 316"), Material.named("PTFE")
DIAMETER = 4.76e-3  # of all beads, in m
STEEL_BEAD = Sphere("0.45e-3", DIAMETER / 2, STEEL)
PTFE_BEAD = Sphere("0.123e-3", DIAMETER / 2, PTFE)


def struck(masses: Sequence[float], beads: int, k: float = 1.5, **rest: Any) -> Scene:
    """Return a chain of repeating masses whose first bead, by default, has velocity 1.

    Parameters
    ----------
    masses : sequence of float
        Masses of a cell.
    beads : int
        Number of beads.
    k : float
        Exponent of the contacts, of stiffness 1.
    **rest
        Further fields of the scene.

    Examples
    --------
    >>> struck((1, 0.5), 3, duration=1).masses
    (1.0, 0.5, 1.0)
    """
    row = np.resize(masses, beads)  # repeats them
    # A blow of velocity 1, unless another start is given.
    blow = {"velocities": (1.0,)} | rest
    return Scene(masses=row, stiffnesses=(1.0,) * (beads - 1), k=k, **blow)


def numeric_cell(masses: Sequence[Any]) -> Cell:
    """Return the unit cell of masses that are numbers, with spacing 1; `SceneError` for symbols."""
    cell = Cell(tuple(masses), spacing=1)
    for mass in cell.masses:
        numeric(mass, "mass")
    return cell


def carrying(
    masses: Sequence[float], compression: ArrayLike, velocity: ArrayLike, **rest: Any
) -> Scene:
    """Return a chain with given initial compressions of the contacts and velocities of the beads.

    Parameters
    ----------
    masses : sequence of float
        Masses of the n beads.
    compression : array_like
        Compressions of the n-1 contacts, of stiffness 1.
    velocity : array_like
        Velocities of the beads.
    **rest
        Further fields of the scene, ``k`` or ``law`` among them.
    """
    strain = np.asarray(compression, float)
    return Scene(
        masses=masses,
        stiffnesses=(1.0,) * len(strain),
        # The last bead stays in its place. Each other bead is displaced by the compressions of all
        # contacts between it and the last bead.
        displacements=np.append(np.cumsum(strain[::-1])[::-1], 0.0),
        velocities=velocity,
        **rest,
    )
