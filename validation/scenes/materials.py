"""Beads and materials in floats, by `lwa.spheres.hertz`; those of the paper's experiment.

The experiment is that of Porter et al. (2008). Units are SI.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from lwa.base.exact import shorten
from lwa.spheres import hertz
from validation.scenes.checks import SceneError, of_scene, positive, real


@dataclass(frozen=True)
class Material:
    """An isotropic elastic solid: Young's modulus E in Pa, Poisson's ratio ν. Raises `SceneError`
    unless E > 0 and -1 < ν ≤ 1/2."""

    E: float
    nu: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "E", positive(self.E, "E"))
        object.__setattr__(self, "nu", real(self.nu, "nu"))
        of_scene(hertz.Material)(self.E, self.nu)

    @classmethod
    def of(cls, material: hertz.Material) -> Material:
        """A material of the theory, given in numbers."""
        return cls(float(material.E), float(material.nu))


@dataclass(frozen=True)
class Bead:
    """A sphere: mass in kg and radius in m, both positive or a `SceneError`, and material."""

    mass: float
    radius: float
    material: Material

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", positive(self.mass, "mass"))
        object.__setattr__(self, "radius", positive(self.radius, "radius"))
        if not isinstance(self.material, Material):
            raise SceneError(f"material is {shorten(self.material)}: a Material is wanted")

    @classmethod
    def of(cls, sphere: hertz.Sphere) -> Bead:
        """A sphere of the theory, given in numbers."""
        return cls(float(sphere.mass), float(sphere.radius), Material.of(sphere.material))


def contact_stiffness(bead: Bead, other: Bead | Material) -> float:
    """A of F = A δ^{3/2} between a bead and another one or a flat wall, in N/m^{3/2}."""
    return float(hertz.contact(bead, other, math.sqrt))


STEEL = Material(E=193e9, nu=0.3)  # stainless steel, type 316
PTFE = Material(E=1.46e9, nu=0.46)  # with the dynamic modulus that the paper uses
DIAMETER = 4.76e-3  # of all beads of the experiment, in m
STEEL_BEAD = Bead(mass=0.45e-3, radius=DIAMETER / 2, material=STEEL)  # the striker too
PTFE_BEAD = Bead(mass=0.123e-3, radius=DIAMETER / 2, material=PTFE)
