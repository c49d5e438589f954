"""Plane waves of packings: layers that move as the particles of a lattice."""

from __future__ import annotations

from typing import Any

import sympy as sp

from lwa.base.exact import one_of, positive
from lwa.law import ContactLaw
from lwa.links.lattice import Lattice, Link

_COSINE = sp.sqrt(3) / 2


def hexagonal(law: ContactLaw, direction: str, mass: Any = 1, diameter: Any = 1) -> Lattice:
    """The lattice of plane waves in a hexagonal packing of equal disks or spheres.

    direction : "across" the rows, in layers √3/2 diameters apart, each joined to the next by two
        contacts a particle at 30° to the wave; or "along" the rows, in layers half a diameter
        apart, joined to the next by two contacts at 60° and to the next but one by a contact.

    Forces and masses are those per particle of a layer. The contacts do not rotate: strains are
    small. Particles neither spin nor rub.

    >>> from lwa import Power
    >>> hexagonal(Power("3/2"), "along").spacing
    1/2
    """
    one_of(direction, ("across", "along"), "direction")
    a = positive(diameter, "diameter")
    if direction == "across":
        return Lattice((mass,), (Link(0, 1, law, 2, _COSINE),), (), a * _COSINE)
    links = Link(0, 1, law, 2, sp.S.Half), Link(0, 2, law)
    return Lattice((mass,), links, (), a / 2)
