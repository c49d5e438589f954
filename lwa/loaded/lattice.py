"""Lattices of particles and links with laws of their own, packings, and their static states.

A cell of P particles repeats with the period P·D. A link pushes its two particles apart with the
force factor · F(δ). Along a lattice of mean strain p the compressions of a link of the range r
are::

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
from typing import Any, Literal, NamedTuple, Self, get_args

import numpy as np
import sympy as sp

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
from lwa.cell import Cell, quantities
from lwa.law import ContactLaw, Power, for_cell
from lwa.linear.springs import Bond, Network
from lwa.loaded.statics import Statics

# Stiffness of a lattice of springs 1 that carries no load, but for rounding: 2e-14 at most in rows
# of up to 50 particles without a link to the next cell; with the link a row has the stiffness 1
_NO_LOAD = 1e-9

DirectionName = Literal["across", "along"]
"""A direction of plane waves in a hexagonal packing: across the rows, or along them."""


@dataclass(frozen=True)
class Link(Value):
    """A link between two particles, which count on into the next cells.

    Parameters
    ----------
    i, j : int
        The particles, i < j.
    law : ContactLaw
        The force F(δ).
    factor : number or str
        Factor of the force.
    cosine : number
        Cosine of the link's angle with the lattice; the compression of the link is the difference
        of the particles' displacements times the cosine.

    Raises
    ------
    InputError
        For a link to itself and for values that are not positive.
    """

    i: int
    j: int
    law: ContactLaw
    factor: Any = sp.S.One
    cosine: Any = sp.S.One

    def __post_init__(self) -> None:
        i = integer(self.i, "a link's particle", 0)
        j = integer(self.j, "a link's particle", 0)
        if i >= j:
            raise InputError(
                f"link ({i}, {j}): the second particle must come after the first"
            )
        if not isinstance(self.law, ContactLaw):
            raise InputError(
                f"link ({i}, {j}): its law is {shorten(self.law)}, no contact law"
            )
        self._set(
            factor=positive(self.factor, "link's factor"),
            cosine=positive(self.cosine, "link's cosine"),
        )

    def compression(self, force: sp.Expr) -> sp.Expr:
        """The compression δ at which the link pushes with this force along the lattice."""
        if force.is_zero:
            return sp.S.Zero
        return self.law.inverse(force / (self.factor * self.cosine))


@dataclass(frozen=True)
class Resonator(Value):
    """A mass on a linear spring inside a particle; the resonator carries no static load.

    Parameters
    ----------
    bead : int
        The particle.
    mass, stiffness : number or str
        Mass, and spring constant.

    Raises
    ------
    InputError
        For values that are not positive.
    """

    bead: int
    mass: sp.Expr
    stiffness: sp.Expr

    def __post_init__(self) -> None:
        integer(self.bead, "a resonator's bead", 0)  # for its refusal of other values
        self._set(
            mass=positive(self.mass, "resonator's mass"),
            stiffness=positive(self.stiffness, "resonator's stiffness"),
        )


class Equilibrium(NamedTuple):
    """A lattice at rest under a mean force.

    Parameters
    ----------
    strain : Expr
        The mean strain.
    compressions : tuple of Expr
        The compression δ of each link.
    """

    strain: sp.Expr
    compressions: tuple[sp.Expr, ...]


@dataclass(frozen=True, init=False)
class Lattice(Value):
    """A periodic lattice of particles and links.

    Parameters
    ----------
    masses : iterable of numbers or str
        Masses of the particles of a cell.
    links : iterable of Link
        The links of a cell.
    resonators : iterable of Resonator
        The resonators of a cell.
    spacing : number or str
        Period of the cell over the number of its particles.

    Raises
    ------
    InputError
        For values that are not positive, a particle without a link to the others, and links
        without a path of load from cell to cell.

    Examples
    --------
    >>> from lwa import Lattice, Link, Power
    >>> pair = Lattice([1, 1], [Link(0, 1, Power("3/2"), "A"), Link(1, 2, Power(1), "B")])
    >>> pair.equilibrium("F").strain
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
        self._set(
            masses=quantities(masses, "masses", "mass"),
            links=_parts(links, Link, "links"),
            resonators=_parts(resonators, Resonator, "resonators"),
            spacing=positive(spacing, "spacing"),
        )
        if not self.masses or not self.links:
            raise InputError("a lattice needs at least one mass and one link")
        # A link's second particle may be in a cell ahead, the first one may not.
        named = [link.i for link in self.links]
        named += [resonator.bead for resonator in self.resonators]
        last = max(named)
        if last >= self.size:
            raise InputError(
                f"particle {last}: the cell has particles 0 to {self.size - 1}"
            )
        # All particles hang together, and the links carry a load from cell to cell.
        self._check_paths()

    @classmethod
    def of_cell(cls, cell: Cell, law: ContactLaw) -> Self:
        """The chain of a cell whose contacts share a law."""
        # Called for its refusal of unlike contacts under a law that is no power
        for_cell(law, cell)
        factors = enumerate(cell.stiffnesses)
        links = [Link(i, i + 1, law, factor=A) for i, A in factors]
        return cls(cell.masses, links, (), cell.spacing)

    @property
    def size(self) -> int:
        """The number P of particles in a cell, resonators not counted."""
        return len(self.masses)

    @cached_property
    def mass(self) -> sp.Expr:
        """The mean mass per particle, with the resonators'."""
        masses = [*self.masses, *(x.mass for x in self.resonators)]
        return sp.Add(*masses) / self.size

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The symbols of masses, links and resonators, by name."""
        values = [*self.masses]
        for link in self.links:
            values += [link.factor, link.cosine, *link.law.symbols]
        for resonator in self.resonators:
            values += [resonator.mass, resonator.stiffness]
        free = sp.Tuple(*values).free_symbols
        return tuple(sorted(free, key=str))

    @cached_property
    def in_series(self) -> bool:
        """True if each particle has one link, to the next particle."""
        return self._network.in_series

    @property
    def alike(self) -> bool:
        """True for equal particles, with equal links from each one to the next."""
        links = {(link.law, link.factor, link.cosine) for link in self.links}
        return self.in_series and len({*self.masses}) == len(links) == 1

    def equilibrium(self, force: Quantity) -> Equilibrium:
        """The lattice at rest under a mean force.

        Compressions are exact for links in series, else floats.

        Raises
        ------
        InputError
            For a force that the links do not reach, and for symbols where compressions are floats.
        """
        load = read_exact(force, "force")
        if self.in_series:
            compressions = tuple(link.compression(load) for link in self.links)
            # Along the lattice a link shortens by δ over its cosine.
            length = sp.S.Zero
            for link, delta in zip(self.links, compressions, strict=True):
                length += delta / link.cosine
            strain = length / (self.size * self.spacing)
            return Equilibrium(strain, compressions)
        demand_numbers(load.free_symbols, "numbers are wanted")
        # e is the mean compression D p. Without a force all links are open or slack, whatever their
        # laws.
        e = self.statics.mean_compression(float(load)) if load else 0.0
        found = self.statics.compressions(np.array(e))
        return Equilibrium(sp.Float(e) / self.spacing, tuple(map(sp.Float, found)))

    def energy(self, state: Equilibrium) -> sp.Expr:
        """The energy per particle at rest."""
        total = sp.S.Zero
        for link, delta in zip(self.links, state.compressions, strict=True):
            energy = link.law.energy.subs(link.law.delta, delta)
            total += link.factor * energy
        return total / self.size

    def stiffness(self, state: Equilibrium) -> sp.Expr:
        """The slope ``dF/d(D p) = P / Σ 1/K`` at rest, K the springs of links in series."""
        compliance = sp.S.Zero
        for link, delta in zip(self.links, state.compressions, strict=True):
            # Along the lattice K is factor · dF/dδ times the cosine squared.
            spring = link.factor * link.cosine**2 * link.law.at(delta, 1)
            # One contact that only touches makes the whole lattice soft.
            if spring.is_zero:
                return sp.S.Zero
            compliance += 1 / spring
        return self.size / compliance

    @property
    def resonance_sum(self) -> sp.Expr:
        """The sum R of m_r²/k_r over the resonators, per particle."""
        parts = [x.mass**2 / x.stiffness for x in self.resonators]
        return sp.Add(*parts) / self.size

    def resonance(self, resonator: Resonator) -> float:
        """The frequency ``ω0 = √(k_r (1/m_r + 1/m))`` of a resonator against its bead."""
        inverse_mass = 1 / resonator.mass + 1 / self.masses[resonator.bead]
        return number(sp.sqrt(resonator.stiffness * inverse_mass))

    @cached_property
    def statics(self) -> Statics:
        """Static states in floats; raises `lwa.InputError` for symbols."""
        demand_numbers(self.symbols, "numbers are wanted")
        links = self.links
        bonds = [Bond(link.i, link.j, float(link.cosine)) for link in links]
        # The force of each link and its first two derivatives
        laws = [tuple(link.law.function(n) for n in range(3)) for link in links]
        return Statics(
            Network(self.size, tuple(bonds)),
            masses=np.array(self.masses, float),
            laws=tuple(laws),
            factors=np.array([float(link.factor) for link in links]),
        )

    @cached_property
    def _network(self) -> Network:
        """The links without their angles."""
        return Network(self.size, tuple(Bond(x.i, x.j) for x in self.links))

    def _check_paths(self) -> None:
        """Raise `lwa.InputError` unless the links join all particles and carry a load."""
        # Particles that hang together move against each other in size - 1 ways.
        if np.linalg.matrix_rank(self._network.incidence) < self.size - 1:
            raise InputError("the links leave a particle of the cell free")
        # Springs and masses of 1: whether links carry a load does not depend on their strength.
        springs = np.ones(len(self.links))
        branch = self._network.acoustic(springs, np.ones(self.size))
        if not branch.stiffness > _NO_LOAD:
            raise InputError("the links carry no load from cell to cell")


def _parts(values: Iterable[Any], kind: type, name: str) -> tuple[Any, ...]:
    """Read a sequence of links or resonators."""
    row = items(values, name)
    for part in row:
        if not isinstance(part, kind):
            raise InputError(
                f"{name} hold {shorten(part)}: a {kind.__name__} is wanted"
            )
    return row


def hexagonal(
    law: ContactLaw | Quantity,
    direction: DirectionName,
    mass: Quantity = 1,
    diameter: Quantity = 1,
) -> Lattice:
    """The lattice of plane waves in a hexagonal packing of equal disks or spheres.

    Forces and masses are those per particle of a layer. The contacts do not rotate: strains are
    small. Particles neither spin nor rub.

    Parameters
    ----------
    law : ContactLaw or number
        The law of the contacts, or the exponent k of ``δ^k``.
    direction : {"across", "along"}
        Across the rows, in layers ``√3/2`` diameters apart, each joined to the next by two contacts
        a particle at 30° to the wave; or along the rows, in layers half a diameter apart, joined to
        the next by two contacts at 60° and to the next but one by a contact.
    mass, diameter : number or str
        Mass and diameter of a particle.

    Examples
    --------
    >>> hexagonal(1.5, "along").spacing
    1/2
    """
    # Called for its refusal of another word
    one_of(direction, get_args(DirectionName), "direction")
    law = law if isinstance(law, ContactLaw) else Power(law)
    a = positive(diameter, "diameter")
    if direction == "along":
        # A row's own contact spans two layers: the layers of its neighbours lie between.
        near = Link(0, 1, law, factor=2, cosine=sp.S.Half)
        far = Link(0, 2, law)
        return Lattice([mass], [near, far], spacing=a / 2)
    cosine = sp.sqrt(3) / 2  # of 30°
    near = Link(0, 1, law, factor=2, cosine=cosine)
    return Lattice([mass], [near], spacing=a * cosine)
