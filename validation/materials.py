"""Beads, their materials, and the stiffness of the Hertz contact between them.

Two elastic spheres pressed together by δ repel each other with F = A δ^{3/2},

    A = 4 E1 E2 √(R1 R2 / (R1 + R2)) / (3 [E2 (1 - ν1²) + E1 (1 - ν2²)])

(Porter et al. 2008, eq. 1); a flat wall is the limit R2 → ∞. The beads are those of the same
paper's experiment. Units are SI.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from lwa.exact import shorten
from validation.checked import SceneError, positive, real


@dataclass(frozen=True)
class Material:
    """An isotropic elastic solid: Young's modulus E in Pa, Poisson's ratio ν.

    Raises `SceneError` unless E > 0 and -1 < ν ≤ 1/2.
    """

    E: float
    nu: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "E", positive(self.E, "E"))
        object.__setattr__(self, "nu", real(self.nu, "nu"))
        if not -1 < self.nu <= 0.5:
            raise SceneError(f"nu is {self.nu:g}: Poisson's ratio lies between -1 and 1/2")


@dataclass(frozen=True)
class Bead:
    """A sphere: mass in kg, radius in m, material.

    Raises `SceneError` unless mass and radius are positive.
    """

    mass: float
    radius: float
    material: Material

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", positive(self.mass, "mass"))
        object.__setattr__(self, "radius", positive(self.radius, "radius"))
        if not isinstance(self.material, Material):
            raise SceneError(f"material is {shorten(self.material)}: a Material is wanted")


def contact_stiffness(bead: Bead, other: Bead | Material) -> float:
    """A of F = A δ^{3/2} between a bead and another one or a flat wall, in N/m^{3/2}.

    >>> steel, wall = STEEL_BEAD, STEEL_BEAD.material
    >>> round(contact_stiffness(steel, wall) / contact_stiffness(steel, steel), 12)  # √2
    1.414213562373
    """
    if isinstance(other, Material):
        radius, second = bead.radius, other
    else:
        radius = bead.radius * other.radius / (bead.radius + other.radius)
        second = other.material
    first = bead.material
    compliance = (1 - first.nu**2) / first.E + (1 - second.nu**2) / second.E
    return 4 * math.sqrt(radius) / (3 * compliance)


STEEL = Material(E=193e9, nu=0.3)
"""Stainless steel, type 316."""

PTFE = Material(E=1.46e9, nu=0.46)
"""Polytetrafluoroethylene, with the dynamic modulus that the paper uses."""

DIAMETER = 4.76e-3
"""Of all beads of the experiment, in m."""

STEEL_BEAD = Bead(mass=0.45e-3, radius=DIAMETER / 2, material=STEEL)
"""The heavy bead of the experiment, and its striker."""

PTFE_BEAD = Bead(mass=0.123e-3, radius=DIAMETER / 2, material=PTFE)
"""The light bead of the experiment."""
