"""Chains with a motion put into them: compressions of the contacts, velocities of the beads.

m1 = A = D = 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from validation.scenes.scene import Scene


def carrying(
    masses: Sequence[float], k: float, compression: ArrayLike, velocity: ArrayLike, **rest: Any
) -> Scene:
    """A chain with these compressions of its contacts and velocities of its beads."""
    strain = np.asarray(compression, float)
    return Scene(
        masses=tuple(masses),
        stiffnesses=(1.0,) * len(strain),
        k=k,
        # The beads behind have moved by all compressions before them.
        displacements=tuple(np.append(np.cumsum(strain[::-1])[::-1], 0.0)),
        velocities=tuple(np.asarray(velocity, float)),
        **rest,
    )
