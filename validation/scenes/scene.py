"""What is simulated: the beads, their contacts, what sets them in motion, and who listens.

Beads 0 … n-1 lie in a row. Contact i joins bead i to bead i+1, the last one (only with a wall)
bead n-1 to the wall. Each pushes with F = A_i δ^k when its compression δ is positive and is open
otherwise. Displacements count from the equilibrium and are positive towards the wall. A scene
holds only what it names: no wall, no gravity, no precompression and no sensors unless they are
given.

Units are the caller's own, as long as they agree (m1 = A = D = 1, say); those of real beads are SI.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, pairwise
from typing import Any

import sympy as sp

from lwa import Cell
from lwa.base.exact import shorten
from lwa.base.tables import Reader
from lwa.cell import exponent
from validation.scenes import checks
from validation.scenes.checks import SceneError, integer, items, of_scene, positive, real
from validation.scenes.materials import Bead, Material, contact_stiffness

__all__ = ["Scene", "SceneError"]


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A chain, its initial state and its sensors.

    Parameters
    ----------
    masses : of the n beads.
    stiffnesses : A_i of the n-1 contacts between them.
    k : exponent of the contact law, at least 1.
    duration : time that is simulated.
    wall : stiffness of the contact of the last bead with a fixed wall.
    gravity, precompression : acceleration, and a constant force F0 on bead 0, towards the wall. In
        equilibrium every contact carries F0 and the weight of the beads above it.
    displacements, velocities : initial, from the equilibrium; beads that the sequence does not
        reach start at 0. A striker is ``velocities=(v,)``.
    contact_sensors : of the force and the compression of these contacts.
    bead_sensors : of the velocity of these beads and of their force, the mean of the two contacts
        (at an end that touches nothing, of one contact and 0).
    samples : number of sample times, equidistant from 0 to the duration.
    spacings : distances of the n-1 pairs of neighbours in equilibrium. The motion does not ask for
        them; without, a speed is known in sites only.
    units : "SI", or nothing for any that agree; what results say.

    Raises `SceneError` for whatever cannot be meant.
    """

    masses: tuple[float, ...]
    stiffnesses: tuple[float, ...]
    k: float
    duration: float
    wall: float | None = None
    gravity: float = 0.0
    displacements: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    contact_sensors: tuple[int, ...] = ()
    bead_sensors: tuple[int, ...] = ()
    samples: int = 1001
    precompression: float = 0.0
    spacings: tuple[float, ...] = ()
    units: str = ""

    def __post_init__(self) -> None:
        for name, read in _READERS.items():
            if name != "wall" or self.wall is not None:
                object.__setattr__(self, name, read(getattr(self, name), name))
        n = self.size
        if n == 0:
            raise SceneError("masses is empty: a chain has at least one bead")
        for name in ("stiffnesses", "spacings"):
            if (given := len(getattr(self, name))) != n - 1 and (given or name == "stiffnesses"):
                raise SceneError(f"{given} {name} for {n} beads: {n - 1} are wanted")
        for name in ("displacements", "velocities"):
            if (given := len(getattr(self, name))) > n:
                raise SceneError(f"{given} {name} for {n} beads: at most {n} wanted")
        if not math.isfinite(sum(self.spacings)):
            raise SceneError("the chain's length comes out as inf: choose other units")
        if self.k < 1:
            raise SceneError(f"k is {self.k:g}: the contact law A δ^k is simulated for k ≥ 1")
        for name, act in (("gravity", "pull towards"), ("precompression", "push against")):
            if (value := getattr(self, name)) < 0 or (value > 0 and self.wall is None):
                wanted = f"it must be positive and needs a wall to {act}"
                raise SceneError(f"{name} is {value:g}: {wanted}")
        for name, count in (("contact_sensors", self.contact_count), ("bead_sensors", n)):
            object.__setattr__(self, name, _sensors(getattr(self, name), name, count))

    @property
    def size(self) -> int:
        """n, the number of beads."""
        return len(self.masses)

    @property
    def contact_count(self) -> int:
        """The number of contacts, that with the wall included."""
        return len(self.stiffnesses) + (self.wall is not None)

    @property
    def load(self) -> tuple[float, ...]:
        """The static force of each contact: F0 and the weight of the beads above."""
        above = accumulate(self.masses[: self.contact_count])
        return tuple(self.precompression + self.gravity * mass for mass in above)

    @classmethod
    def of_cell(cls, cell: Cell, repeats: int, k: Any, **rest: Any) -> Scene:
        """A chain of the theory's own periodic cell, repeated; ``rest`` as for a `Scene`.

        The last cell's last contact is left out. Raises `SceneError` when the cell holds symbols.

        >>> from lwa import Dimer
        >>> Scene.of_cell(Dimer(1, "1/2", spacing=1), 2, "3/2", duration=1).masses
        (1.0, 0.5, 1.0, 0.5)
        """
        repeats = integer(repeats, "repeats", 1)
        k_value = _number(of_scene(exponent)(k), "k")
        masses = tuple(_number(m, "mass") for m in cell.masses) * repeats
        stiffnesses = tuple(_number(A, "stiffness") for A in cell.stiffnesses) * repeats
        spacings = (float(cell.spacing),) * (len(masses) - 1) if cell.spacing.is_number else ()
        contacts = stiffnesses[:-1]
        return cls(masses=masses, stiffnesses=contacts, k=k_value, spacings=spacings, **rest)

    @classmethod
    def of_beads(cls, beads: Sequence[Bead], *, wall: Material | None = None, **rest: Any) -> Scene:
        """A chain of real beads in Hertz contact, ended by a flat wall if its material is given."""
        given = items(beads, "beads")
        for i, bead in enumerate(given):
            if not isinstance(bead, Bead):
                raise SceneError(f"bead {i} is {shorten(bead)}: a Bead is wanted")
        if not given:
            raise SceneError("beads is empty: a chain has at least one bead")
        return cls(
            masses=tuple(bead.mass for bead in given),
            stiffnesses=tuple(contact_stiffness(a, b) for a, b in pairwise(given)),
            k=1.5,
            wall=None if wall is None else contact_stiffness(given[-1], wall),
            spacings=tuple(a.radius + b.radius for a, b in pairwise(given)),
            units="SI",
            **rest,
        )


def _all(read: Reader) -> Reader:
    return lambda values, name: tuple(
        checks.row(items(values, name), read, lambda i: f"{name}[{i}]")
    )


_READERS: dict[str, Reader] = {
    "masses": _all(positive),
    "stiffnesses": _all(positive),
    "spacings": _all(positive),
    "displacements": _all(real),
    "velocities": _all(real),
    "samples": partial(integer, least=2),
    "k": real,
    "duration": positive,
    "wall": positive,
    "gravity": real,
    "precompression": real,
    "units": lambda value, name: checks.one_of(value, ("", "SI"), name),
}


def _sensors(values: Any, name: str, count: int) -> tuple[int, ...]:
    given = items(values, name)
    if given and not count:
        raise SceneError(f"{name} is {shorten(given)}: this chain has none")
    sensors = tuple(integer(i, f"{name}[{j}]", 0, count - 1) for j, i in enumerate(given))
    if len(set(sensors)) < len(sensors):
        raise SceneError(f"{name} is {shorten(sensors)}: each may be named once")
    return sensors


def _number(value: sp.Expr, name: str) -> float:
    if not value.is_number:
        raise SceneError(f"{name} is {value}: the lattice needs numbers in place of symbols")
    return float(value)
