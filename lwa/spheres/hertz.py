"""Hertz's contact between elastic spheres, and a table of materials.

Two spheres pressed together by δ repel each other with the force::

    F = A δ^{3/2},
    A = 4 E1 E2 √(R1 R2 / (R1 + R2)) / (3 [E2 (1 - ν1²) + E1 (1 - ν2²)])

(Porter et al. 2008, eq. 1); a flat wall is the limit R2 → ∞. In SI units A is in ``N/m^{3/2}``.
`lwa.Cell.of_spheres` makes the cell of a chain from them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from lwa.base.exact import InputError, one_of, positive, read_exact, shorten
from lwa.base.frozen import Value

EXPONENT = sp.Rational(3, 2)
"""k of Hertz's contact."""


@dataclass(frozen=True)
class Material(Value):
    """An isotropic elastic solid.

    Parameters
    ----------
    E : number or symbol
        Young's modulus, in any units that agree with the others.
    nu : number or symbol
        Poisson's ratio, above -1 and up to 1/2.
    density : number or symbol, optional
        The density.

    Raises
    ------
    lwa.InputError
        For other values.
    """

    E: Any
    nu: Any
    density: Any = None

    def __post_init__(self) -> None:
        given = self.nu
        self._set(E=positive(self.E, "E"), nu=read_exact(self.nu, "nu"))
        if self.nu.is_number and not -1 < self.nu <= sp.S.Half:
            raise InputError(
                f"nu is {shorten(given)}: Poisson's ratio lies between -1 and 1/2"
            )
        if self.density is not None:
            self._set(density=positive(self.density, "density"))

    @classmethod
    def named(cls, name: str, **changed: Any) -> Material:
        """A material of `BY_NAME`, in SI, with some of its values changed.

        Parameters
        ----------
        name : str
            The name of the material.
        **changed
            Other values of E, nu and density.

        Raises
        ------
        lwa.InputError
            For another name.

        Examples
        --------
        >>> Material.named("PTFE", E="0.6e9")
        Material(E=600000000, nu=23/50, density=2178)
        """
        return replace(BY_NAME[one_of(name, BY_NAME, "material")], **changed)


MATERIALS = {
    # E, density: ASM/MatWeb, AISI Type 316, annealed bar; ν: Porter et al. 2008
    "steel 316": Material("193e9", "0.30", "8000"),
    # makeitfrom.com, AISI 440C, annealed
    "steel 440C": Material("200e9", "0.28", "7700"),
    # ASM/MatWeb, aluminium 6061-T6
    "aluminium": Material("68.9e9", "0.33", "2700"),
    # Gere & Goodno, Mechanics of Materials, appendix: 96-110 GPa, 8400-8600 kg/m³
    "brass": Material("103e9", "0.34", "8500"),
    # soda-lime-magnesia-silicate: Sci. Rep., doi 10.1038/s41598-021-04045-6, table 1
    "glass": Material("72.8e9", "0.222", "2563"),
    # E, ν: Porter et al. 2008; density: its beads of 0.123 g and 4.76 mm
    "PTFE": Material("1.46e9", "0.46", "2178"),
    # acetal homopolymer: DuPont, Delrin Design Guide, Module III, Delrin 500
    "delrin": Material("3.1e9", "0.35", "1420"),
}
"""Materials of beads by name, in SI: typical values at room temperature.

A batch of beads differs from them by some per cent; polymers, which are stiffer the faster they are
compressed, differ by much more.
"""

# Porter et al. 2008, whose chains are the examples, have beads of steel 316.
BY_NAME = MATERIALS | {"steel": MATERIALS["steel 316"]}
"""Built-in materials by all of their names; "steel" is steel 316."""


@dataclass(frozen=True)
class Sphere(Value):
    """An elastic sphere.

    Parameters
    ----------
    mass, radius : number or symbol
        Mass and radius, both positive.
    material : Material
        The elastic solid.

    Raises
    ------
    lwa.InputError
        For other values.
    """

    mass: Any
    radius: Any
    material: Material

    def __post_init__(self) -> None:
        mass = positive(self.mass, "mass")
        self._set(mass=mass, radius=positive(self.radius, "radius"))
        if not isinstance(self.material, Material):
            raise InputError(
                f"material is {shorten(self.material)}: a Material is wanted"
            )

    @classmethod
    def solid(cls, radius: Any, material: Material, density: Any = None) -> Sphere:
        """The solid sphere of a radius, whose mass follows from a density.

        Parameters
        ----------
        radius : number or symbol
            Radius R; the mass is (4π/3) ρ R³.
        material : Material
            The elastic solid.
        density : number or symbol, optional
            Density ρ; that of the material unless it is given.

        Examples
        --------
        >>> Sphere.solid("R", Material.named("steel 316")).mass
        32000*pi*R**3/3
        """
        if density is None:
            density = getattr(material, "density", None)
        if density is None:
            raise InputError(
                f"material is {shorten(material)}: a Material with a density is wanted"
            )
        volume = 4 * sp.pi / 3 * positive(radius, "radius") ** 3
        return cls(positive(density, "density") * volume, radius, material)


def stiffness(sphere: Sphere, other: Sphere | Material) -> sp.Expr:
    """Stiffness A of Hertz's contact between two spheres, or between a sphere and a flat wall.

    Parameters
    ----------
    sphere : Sphere
        One side of the contact.
    other : Sphere or Material
        The other side: a sphere, or the material of a wall.

    Returns
    -------
    sympy.Expr
        A in ``F = A δ^{3/2}``; in ``N/m^{3/2}`` for values in SI.

    Raises
    ------
    lwa.InputError
        For anything else.
    """
    if not isinstance(sphere, Sphere):
        raise InputError(f"sphere is {shorten(sphere)}: a Sphere is wanted")
    if not isinstance(other, Sphere | Material):
        raise InputError(
            f"other is {shorten(other)}: a Sphere, or a wall's Material, is wanted"
        )
    first = sphere.material
    R = sphere.radius
    if isinstance(other, Sphere):
        second = other.material
        R = R * other.radius / (R + other.radius)
    else:
        second = other
    # 1/A = 3 (compliance)/(4 √R), R the reduced radius; a wall's radius is infinite.
    compliance = (1 - first.nu**2) / first.E + (1 - second.nu**2) / second.E
    return 4 * sp.sqrt(R) / (3 * compliance)
