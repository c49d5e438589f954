"""Scenes of struck chains of unit stiffness, and the paper's beads in SI.

The beads of Porter et al. (2008) are `STEEL_BEAD`, also their striker, and `PTFE_BEAD`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lwa.spheres.hertz import Material, Sphere
from validation.scenes.scene import Scene

STEEL, PTFE = Material.named("steel 316"), Material.named("PTFE")
DIAMETER = 4.76e-3  # diameter of all beads, in m
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
