"""Hertz's contact between elastic spheres: A of F = A δ^{3/2} from elasticity and shape.

Two spheres pressed together by δ repel each other with F = A δ^{3/2},

    A = 4 E1 E2 √(R1 R2 / (R1 + R2)) / (3 [E2 (1 - ν1²) + E1 (1 - ν2²)])

(Porter et al. 2008, eq. 1); a flat wall is the limit R2 → ∞. In SI units A is in N/m^{3/2}.
`lwa.Cell.of_spheres` makes the cell of a chain from them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, exact, one_of, positive, shorten
from lwa.base.frozen import Value
from lwa.spheres.materials import MATERIALS

EXPONENT = sp.Rational(3, 2)
"""k of Hertz's contact."""


@dataclass(frozen=True)
class Material(Value):
    """An isotropic elastic solid: Young's modulus E, Poisson's ratio ν and perhaps its density.

    The values are numbers or symbols. Raises `lwa.InputError` unless E > 0, -1 < ν ≤ 1/2, and the
    density, where it is given, is positive.
    """

    E: sp.Expr
    nu: sp.Expr
    density: sp.Expr | None = None

    def __post_init__(self) -> None:
        given = self.nu
        object.__setattr__(self, "E", positive(self.E, "E"))
        object.__setattr__(self, "nu", exact(self.nu, "nu"))
        if self.nu.is_number and not -1 < self.nu <= sp.S.Half:
            raise InputError(f"nu is {shorten(given)}: Poisson's ratio lies between -1 and 1/2")
        if self.density is not None:
            object.__setattr__(self, "density", positive(self.density, "density"))

    def latex_rows(self) -> list[str]:
        density = {} if self.density is None else {r"\rho": self.density}
        return latex.rows({"E": self.E, r"\nu": self.nu} | density)

    @classmethod
    def named(cls, name: str, *, E: Any = None, nu: Any = None, density: Any = None) -> Material:
        """A material of `lwa.spheres.materials`, in SI, with some of its values replaced.

        Raises `lwa.InputError`, with the known names, for another name.

        >>> Material.named("PTFE", E="0.6e9")
        Material(E=600000000, nu=23/50, density=2178)
        """
        table = MATERIALS[one_of(name, MATERIALS, "material")]
        return cls(
            table.E if E is None else E,
            table.nu if nu is None else nu,
            table.density if density is None else density,
        )


@dataclass(frozen=True)
class Sphere(Value):
    """A sphere: mass, radius and material, numbers or symbols.

    Raises `lwa.InputError` unless mass and radius are positive.

    >>> steel = Material(E="193e9", nu="0.3")
    >>> stiffness(Sphere("m", "R", steel), steel)
    38600000000000*sqrt(R)/273
    """

    mass: sp.Expr
    radius: sp.Expr
    material: Material

    def __post_init__(self) -> None:
        for name in ("mass", "radius"):
            object.__setattr__(self, name, positive(getattr(self, name), name))
        if not isinstance(self.material, Material):
            raise InputError(f"material is {shorten(self.material)}: a Material is wanted")

    def latex_rows(self) -> list[str]:
        return [*latex.rows({"m": self.mass, "R": self.radius}), *self.material.latex_rows()]

    @classmethod
    def solid(cls, radius: Any, material: Material) -> Sphere:
        """The solid sphere of a material, whose density gives the mass.

        >>> Sphere.solid("R", Material.named("steel 316")).mass
        32000*pi*R**3/3
        """
        density = material.density if isinstance(material, Material) else None
        if density is None:
            raise InputError(
                f"material is {shorten(material)}: a Material with a density is wanted"
            )
        return cls.of_density(density, radius, material)

    @classmethod
    def of_density(cls, density: Any, radius: Any, material: Material) -> Sphere:
        """The solid sphere of this density, of mass (4π/3) ρ R³."""
        volume = 4 * sp.pi / 3 * positive(radius, "radius") ** 3
        return cls(positive(density, "density") * volume, radius, material)


def stiffness(sphere: Sphere, other: Sphere | Material) -> sp.Expr:
    """Stiffness A of F = A δ^{3/2} between two spheres, or a sphere and a flat wall.

    >>> R, E, nu = sp.symbols("R E nu", positive=True)
    >>> ball = Sphere("m", R, Material(E, nu))
    >>> sp.simplify(stiffness(ball, ball) - E * sp.sqrt(2 * R) / (3 * (1 - nu**2)))
    0
    """
    if not isinstance(sphere, Sphere):
        raise InputError(f"sphere is {shorten(sphere)}: a Sphere is wanted")
    if not isinstance(other, Sphere | Material):
        raise InputError(f"other is {shorten(other)}: a Sphere, or a wall's Material, is wanted")
    return contact(sphere, other, sp.sqrt)


def contact(sphere: Any, other: Any, sqrt: Callable[[Any], Any]) -> Any:
    """The `stiffness` in the arithmetic of ``sqrt``; `math.sqrt` computes in floats."""
    first, second = sphere.material, getattr(other, "material", other)
    wall = second is other
    R = sphere.radius if wall else sphere.radius * other.radius / (sphere.radius + other.radius)
    compliance = (1 - first.nu**2) / first.E + (1 - second.nu**2) / second.E
    return 4 * sqrt(R) / (3 * compliance)
