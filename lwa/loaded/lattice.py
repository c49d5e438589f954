"""Lattices of particles and links with laws of their own, packings, and their static states.

A cell of P particles repeats with the period P·D. A link pushes its two particles apart with the
force factor · F(δ). Along a lattice of mean strain p the compressions of a link of the range r are

    δ = cosine · (r D p + w_i - w_j),

where the displacements w inside the cell minimise the energy. The mean force F(p), the momentum
that passes a place per time, is the sum over the links of a cell of cosine · r · factor · F(δ) / P.
Links in series, from each particle to the next, all carry the force F: each compression, and their
mean, is an explicit function of the force. Other lattices are solved in numbers.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
import sympy as sp

from lwa.base.arrays import function_of
from lwa.base.exact import (
    InputError,
    Quantity,
    demand_numbers,
    integer,
    number,
    one_of,
    positive,
    read_exact,
    shorten,
)
from lwa.base.files import items
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.law import ContactLaw, Power, for_cell
from lwa.linear.network import Bond, Network
from lwa.loaded.statics import Statics

_NO_LOAD = (
    1e-9  # stiffness of a lattice of springs 1 that carries no load, but for rounding
)


@dataclass(frozen=True)
class Link(Value):
    """A link between the particles i < j, which count on into the next cells.

    law : force F(δ). factor : number or symbol that multiplies F.
    cosine : cosine of the link's angle with the lattice; its compression is the difference of the
        particles' displacements times the cosine.

    Raises `lwa.InputError` for a link to itself and for values that are not positive.
    """

    i: int
    j: int
    law: ContactLaw
    factor: sp.Expr = sp.S.One
    cosine: sp.Expr = sp.S.One

    def __post_init__(self) -> None:
        i, j = (integer(x, "a link's particle", 0) for x in (self.i, self.j))
        if i >= j:
            raise InputError(
                f"link ({i}, {j}): the second particle must come after the first"
            )
        if not isinstance(self.law, ContactLaw):
            raise InputError(
                f"link ({i}, {j}): its law is {shorten(self.law)}, no contact law"
            )
        for name in ("factor", "cosine"):
            object.__setattr__(
                self, name, positive(getattr(self, name), f"link's {name}")
            )

    def compression(self, force: sp.Expr) -> sp.Expr:
        """The compression δ at which the link pushes with this force along the lattice."""
        if force.is_zero:
            return sp.S.Zero
        return self.law.inverse(force / (self.factor * self.cosine))


@dataclass(frozen=True)
class Resonator(Value):
    """A mass on a linear spring inside a particle; the resonator carries no static load."""

    bead: int
    mass: sp.Expr
    stiffness: sp.Expr

    def __post_init__(self) -> None:
        integer(self.bead, "a resonator's bead", 0)
        for name in ("mass", "stiffness"):
            object.__setattr__(
                self, name, positive(getattr(self, name), f"resonator's {name}")
            )


class Static(NamedTuple):
    """A lattice at rest under a mean force: mean strain, and compression δ of each link."""

    force: sp.Expr
    strain: sp.Expr
    compressions: tuple[sp.Expr, ...]


@dataclass(frozen=True, init=False)
class Lattice(Value):
    """A periodic lattice of particles and links.

    masses, links, resonators : of one cell. spacing : period of the cell over its particles.

    Raises `lwa.InputError` for values that are not positive, a particle without a link to the
    others, and links without a path of load from cell to cell.

    >>> from lwa import Lattice, Link, Power
    >>> pair = Lattice([1, 1], [Link(0, 1, Power("3/2"), "A"), Link(1, 2, Power(1), "B")])
    >>> pair.static("F").strain
    F/(2*B) + F**(2/3)/(2*A**(2/3))
    """

    masses: tuple[sp.Expr, ...]
    links: tuple[Link, ...]
    resonators: tuple[Resonator, ...]
    spacing: sp.Expr

    def __init__(
        self,
        masses: Iterable[Quantity],
        links: Iterable[Link],
        resonators: Iterable[Resonator] = (),
        spacing: Quantity = 1,
    ) -> None:
        parts = {"masses": masses, "links": links, "resonators": resonators}
        for name, values in parts.items():
            row = items(values, name)
            if name == "masses":
                row = tuple(positive(m, f"mass {n}") for n, m in enumerate(row, 1))
            kind = {"masses": sp.Expr, "links": Link, "resonators": Resonator}[name]
            if wrong := [x for x in row if not isinstance(x, kind)]:
                raise InputError(
                    f"{name} hold {shorten(wrong[0])}: a {kind.__name__} is wanted"
                )
            object.__setattr__(self, name, row)
        object.__setattr__(self, "spacing", positive(spacing, "spacing"))
        if not self.masses or not self.links:
            raise InputError("a lattice needs at least one mass and one link")
        places = [link.i for link in self.links] + [x.bead for x in self.resonators]
        if max(places) >= self.size:
            raise InputError(
                f"particle {max(places)}: the cell has particles 0 to {self.size - 1}"
            )
        self._check_paths()

    @classmethod
    def of_cell(cls, cell: Cell, law: ContactLaw) -> Self:
        """The chain of a cell whose contacts share a law."""
        for_cell(law, cell)
        links = (Link(i, i + 1, law, A) for i, A in enumerate(cell.stiffnesses))
        return cls(cell.masses, tuple(links), (), cell.spacing)

    @property
    def size(self) -> int:
        """The number P of particles in a cell, resonators not counted."""
        return len(self.masses)

    @cached_property
    def mass(self) -> sp.Expr:
        """The mean mass per particle, with the resonators'."""
        return sp.Add(*self.masses, *(x.mass for x in self.resonators)) / self.size

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The symbols of masses, links and resonators, by name."""
        values = [*self.masses]
        values += [
            x
            for link in self.links
            for x in (link.factor, link.cosine, *link.law.symbols)
        ]
        values += [x for r in self.resonators for x in (r.mass, r.stiffness)]
        return tuple(sorted(set().union(*(x.free_symbols for x in values)), key=str))

    @cached_property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        return self._network.in_series

    @property
    def exact(self) -> bool:
        """True for links in series whose laws are powers: all results are closed forms."""
        return self.in_series and all(
            isinstance(link.law, Power) for link in self.links
        )

    @property
    def alike(self) -> bool:
        """True for equal particles, with equal links from each one to the next."""
        links = {(x.law, x.factor, x.cosine) for x in self.links}
        return self.in_series and len({*self.masses}) == len(links) == 1

    def static(self, force: Any) -> Static:
        """The lattice at rest under a mean force: exact in series, else in floats."""
        force = read_exact(force, "force")
        if self.in_series:
            compressions = tuple(link.compression(force) for link in self.links)
            parts = zip(self.links, compressions, strict=True)
            mean = sp.Add(*(delta / link.cosine for link, delta in parts)) / self.size
        else:
            demand_numbers(force.free_symbols, "numbers are wanted")
            e = self.statics.mean_compression(float(force)) if force else 0.0
            compressions = tuple(map(sp.Float, self.statics.compressions(np.array(e))))
            mean = sp.Float(e)
        return Static(force, mean / self.spacing, compressions)

    def energy(self, state: Static) -> sp.Expr:
        """The energy per particle in a static state."""
        pairs = zip(self.links, state.compressions, strict=True)
        energies = (
            x.factor * x.law.energy.subs(x.law.delta, delta) for x, delta in pairs
        )
        return sp.Add(*energies) / self.size

    def stiffness(self, state: Static) -> sp.Expr:
        """The slope dF/d(D p) of links in series in a static state."""
        # spring constants along the lattice: dF/dδ times the cosine squared
        pairs = zip(self.links, state.compressions, strict=True)
        springs = [x.factor * x.cosine**2 * x.law.at(delta, 1) for x, delta in pairs]
        if any(K.is_zero for K in springs):
            return sp.S.Zero
        return self.size / sp.Add(*(1 / K for K in springs))

    @property
    def resonance_sum(self) -> sp.Expr:
        """The sum R of m_r²/k_r over the resonators, per particle."""
        return sp.Add(*(x.mass**2 / x.stiffness for x in self.resonators)) / self.size

    def resonance(self, resonator: Resonator) -> float:
        """The frequency ω0 of a resonator against its bead."""
        parts = 1 / resonator.mass + 1 / self.masses[resonator.bead]
        return number(sp.sqrt(resonator.stiffness * parts))

    @cached_property
    def statics(self) -> Statics:
        """Static states in floats; raises `lwa.InputError` for symbols."""
        demand_numbers(self.symbols, "numbers are wanted")
        x = sp.Symbol("delta", positive=True)
        forces = (
            tuple(link.factor * link.law.at(x, n) for n in range(3))
            for link in self.links
        )
        compiled = (tuple(function_of(x, f) for f in triple) for triple in forces)
        masses = np.array([float(m) for m in self.masses])
        network = Network(
            self.size, tuple(Bond(x.i, x.j, float(x.cosine)) for x in self.links)
        )
        return Statics(network, masses, tuple(compiled))

    @cached_property
    def _network(self) -> Network:
        """The links without their angles."""
        return Network(self.size, tuple(Bond(x.i, x.j) for x in self.links))

    def _check_paths(self) -> None:
        """Raise `lwa.InputError` unless the links join all particles and carry a load."""
        if np.linalg.matrix_rank(self._network.incidence) < self.size - 1:
            raise InputError("the links leave a particle of the cell free")
        branch = self._network.acoustic(np.ones(len(self.links)), np.ones(self.size))
        if not branch.stiffness > _NO_LOAD:
            raise InputError("the links carry no load from cell to cell")


def hexagonal(
    law: ContactLaw | Quantity,
    direction: str,
    mass: Quantity = 1,
    diameter: Quantity = 1,
) -> Lattice:
    """The lattice of plane waves in a hexagonal packing of equal disks or spheres.

    law : of the contacts, or the exponent k of δ^k.
    direction : "across" the rows, in layers √3/2 diameters apart, each joined to the next by two
        contacts a particle at 30° to the wave; or "along" the rows, in layers half a diameter
        apart, joined to the next by two contacts at 60° and to the next but one by a contact.

    Forces and masses are those per particle of a layer. The contacts do not rotate: strains are
    small. Particles neither spin nor rub.

    >>> hexagonal(1.5, "along").spacing
    1/2
    """
    one_of(direction, ("across", "along"), "direction")
    law = law if isinstance(law, ContactLaw) else Power(law)
    a, cosine = positive(diameter, "diameter"), sp.sqrt(3) / 2
    if direction == "across":
        return Lattice((mass,), (Link(0, 1, law, 2, cosine),), (), a * cosine)
    links = Link(0, 1, law, 2, sp.S.Half), Link(0, 2, law)
    return Lattice((mass,), links, (), a / 2)
