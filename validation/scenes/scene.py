"""Scenes: chains of beads, their contacts, initial state and sensors.

Beads 0 … n-1 lie in a row. Contact i joins bead i to bead i+1; with a wall, the last contact joins
bead n-1 to it. A contact pushes with ``F = A_i δ^k`` while its compression δ is positive and is
open otherwise. Displacements count from the equilibrium and are positive towards the wall. By
default a scene has no wall, no gravity, no precompression and no sensors.

Any consistent units will do (``m1 = A = D = 1``, say); scenes of real beads are in SI.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import accumulate, pairwise
from typing import Any

import numpy as np

from lwa import Cell
from lwa.base.exact import shorten
from lwa.base.files import Reader
from lwa.law import ContactLaw
from lwa.spheres.hertz import Material, Sphere, stiffness
from validation.scenes.checks import (
    MISSING,
    SceneError,
    alike,
    check_count,
    contact_law,
    each,
    finite,
    integer,
    items,
    numeric,
    one_of,
    one_or_each,
    positive,
    read_contact_law,
    read_exponent,
)
from validation.scenes.forcing import Damping, Drive

__all__ = ["Scene", "SceneError"]

Row = tuple[float, ...] | Any
"""Any sequence of numbers, which a scene keeps as a tuple of floats."""

Places = tuple[int, ...] | Any
"""Any sequence of numbers of beads or contacts, which a scene keeps as a tuple."""

_LONGEST = 100  # times the duration that a drive's record may last: longer, its unit is another


@dataclass(frozen=True, kw_only=True, repr=False)
class Scene:
    """A chain, its initial state and its sensors.

    Parameters
    ----------
    masses : sequence of float
        Masses of the n beads.
    stiffnesses : sequence of float
        Stiffnesses A_i of the n-1 contacts between beads.
    k : float, str or sequence, optional
        Exponent of the contact law, at least 1, such as 1.5 or "3/2"; one for all contacts, or one
        for each contact, the wall's last.
    law : ContactLaw or sequence of ContactLaw, optional
        Any contact law of `lwa.law` without symbols, in place of ``k``, for all contacts or for
        each; the contact force is ``A F(δ)``. A contact of positive stiffness at ``δ = 0`` (Toda's,
        say) also pulls, any other opens. The k of a contact whose law is no power is 1.
    duration : float
        Time to simulate.
    wall : float, optional
        Stiffness of the contact between the last bead and a fixed wall.
    gravity : float, optional
        Acceleration towards the wall.
    precompression : float, optional
        Constant force F0 on bead 0 towards the wall. At rest every contact carries F0 and the
        weight of the beads above it.
    displacements, velocities : sequence of float, optional
        Initial values for the first beads; all other beads start at 0. A striker is
        ``velocities=(v,)``.
    damping : Damping, optional
        Dissipation in the contacts, see `validation.scenes.forcing.Damping`.
    drive : Drive, optional
        Given motion of bead 0, see `validation.scenes.forcing.Drive`.
    contact_sensors : sequence of int, optional
        Contacts whose force and compression are recorded.
    bead_sensors : sequence of int, optional
        Beads whose displacement, velocity and force are recorded. The force of a bead is the mean
        of the forces in its two contacts (a missing contact counts as 0).
    samples : int, optional
        Number of sample times, equidistant from 0 to the duration.
    spacings : sequence of float, optional
        The n-1 distances between neighbours at rest. They turn speeds from sites into lengths per
        time, and tell a start inside the wall.
    units : {"", "SI"}, optional
        "" stands for any consistent units; labels of results depend on it.

    Raises
    ------
    SceneError
        For invalid values.

    Notes
    -----
    Values of contacts that are all alike are kept as one value: ``k`` and ``law`` of a chain are
    tuples, one entry a contact, where contacts differ. ``law`` is None for a power.

    Examples
    --------
    A scene in four steps: the chain, the wall and the load, the striker, the sensors.

    >>> from dataclasses import replace
    >>> chain = Scene(masses=(1, 0.5) * 10, stiffnesses=(1,) * 19, k="3/2", duration=25)
    >>> loaded = replace(chain, wall=1, precompression=0.1)
    >>> struck = replace(loaded, velocities=(1,))
    >>> scene = replace(struck, contact_sensors=(5, 15))
    >>> print(scene)
    20 beads, 20 contacts, the last one the wall's, k = 1.5; duration 25
    >>> scene.load[:2]  # static forces of the first two contacts
    (0.1, 0.1)
    """

    masses: Row
    stiffnesses: Row
    k: float | Row = MISSING
    duration: float
    wall: float | None = None
    gravity: float = 0.0
    displacements: Row = ()
    velocities: Row = ()
    contact_sensors: Places = ()
    bead_sensors: Places = ()
    samples: int = 1001
    precompression: float = 0.0
    spacings: Row = ()
    units: str = ""
    law: ContactLaw | tuple[ContactLaw | None, ...] | Any = None
    damping: Damping | None = None
    drive: Drive | None = None

    def __post_init__(self) -> None:
        # Each field by its own rule; the rules below join several fields.
        for name, read in _READERS.items():
            if name != "wall" or self.wall is not None:
                # A frozen dataclass is set by its base class while it is made.
                object.__setattr__(self, name, read(getattr(self, name), name))
        n = self.size
        if n == 0:
            raise SceneError("masses is empty: a chain has at least one bead")
        # Between n beads are n - 1 contacts; spacings may be left out.
        for name in ("stiffnesses", "spacings"):
            given = len(getattr(self, name))
            if given != n - 1 and (given or name == "stiffnesses"):
                raise SceneError(f"{given} {name} for {n} beads: {n - 1} are wanted")
        for name in ("displacements", "velocities"):
            given = len(getattr(self, name))
            if given > n:
                raise SceneError(f"{given} {name} for {n} beads: at most {n} wanted")
        # Places along the chain are sums of spacings.
        if not math.isfinite(sum(self.spacings)):
            raise SceneError("the chain's length comes out as inf: choose other units")
        self._read_laws()
        for name in ("gravity", "precompression"):
            value = getattr(self, name)
            # Without a wall nothing holds a chain that is pushed, and it has no equilibrium.
            if value < 0 or (value > 0 and self.wall is None):
                raise SceneError(
                    f"{name} is {value:g}: it must be positive and needs a wall"
                )
        for name, count in (
            ("contact_sensors", self.contact_count),
            ("bead_sensors", n),
        ):
            object.__setattr__(self, name, _sensors(getattr(self, name), name, count))
        self._check_start()
        self._check_damping()
        self._check_drive()

    def _read_laws(self) -> None:
        """Check the exponents and the laws; a law that is a power is kept as its exponent."""
        k = self.k
        if k is not MISSING:
            k = one_or_each(read_exponent)(k, "k")
        law = one_or_each(read_contact_law)(self.law, "law")
        # Called for their refusals alone.
        check_count(k, "k", self.contact_count)
        check_count(law, "law", self.contact_count)
        count = 1
        if isinstance(k, tuple) or isinstance(law, tuple):
            count = self.contact_count
        # `contact_law` returns the pair (k, law) of a contact. A chain has few kinds of contacts.
        read = cache(contact_law)
        contacts = [*map(read, _row(k, count), _row(law, count))]
        object.__setattr__(self, "k", alike(tuple(k for k, _ in contacts)))
        object.__setattr__(self, "law", alike(tuple(law for _, law in contacts)))

    def _check_start(self) -> None:
        """Refuse a start inside the wall or behind a neighbour, where the spacings tell."""
        if not (self.displacements and self.spacings):
            return
        # The wall, and beads whose displacement is not given, start at their places of rest.
        y = np.zeros(self.size + 1)
        y[: len(self.displacements)] = self.displacements
        # A bead's radius, its distance from the wall, is half its distance from the bead before it.
        distances = (*self.spacings, self.spacings[-1] / 2)[: self.contact_count]
        passed = -np.diff(y)[: self.contact_count] > distances
        if passed.any():
            i = np.argmax(passed)
            raise SceneError(
                f"displacements[{i}] is {y[i]:g}, positive towards the wall: bead {i + 1} would "
                f"start behind bead {i + 2}, or inside the wall, {distances[i]:g} from it"
            )

    def _check_damping(self) -> None:
        """Refuse damping with too many or too few values, and of a law for which none is known.

        The coefficients of all kinds but "contact" belong to the exponent of a power. Beside other
        laws such a kind may say no damping alone, ``damping.undamped``.
        """
        damping = self.damping
        if damping is None:
            return
        if not isinstance(damping, Damping):
            raise SceneError(f"damping is {shorten(damping)}: a Damping is wanted")
        count = self.contact_count
        check_count(damping.value, f"damping {damping.kind}", count)
        # A dashpot needs no exponent of the law; the other kinds are made for powers.
        if damping.kind == "contact" or self.law is None:
            return
        values = _row(damping.value, count)
        for law, value in zip(_row(self.law, count), values, strict=True):
            if law is not None and value != damping.undamped:
                raise SceneError(
                    f"damping is {damping.kind}: it is known for powers only, not for {law.text}"
                )

    def _check_drive(self) -> None:
        """Refuse a drive of a bead with a start of its own, and a record of another duration."""
        drive = self.drive
        if drive is None:
            return
        if not isinstance(drive, Drive):
            raise SceneError(f"drive is {shorten(drive)}: a Drive is wanted")
        # The drive says how bead 1 moves, from the start on.
        for row in (self.velocities, self.displacements):
            if row and row[0] != 0:
                raise SceneError(
                    "drive moves bead 1, which has a velocity or displacement of its own"
                )
        # Only a record ends; a piston and an oscillation go on.
        end = self.duration
        if drive.time:
            end = drive.time[-1]
        if not self.duration <= end < _LONGEST * self.duration:
            raise SceneError(
                f"drive.time ends at {end:g}: one to {_LONGEST} times the duration, "
                f"{self.duration:g}, is wanted"
            )

    def __repr__(self) -> str:
        return f"Scene({self})"

    def __str__(self) -> str:
        """Size, law and duration in one line.

        >>> print(Scene(masses=(1, 1), stiffnesses=(1,), k="3/2", duration=2))
        2 beads, 1 contact, k = 1.5; duration 2
        """
        n, c = self.size, self.contact_count
        wall = ", the last one the wall's" if self.wall is not None else ""
        size = f"{n} bead{'s' * (n != 1)}, {c} contact{'s' * (c != 1)}{wall}"
        if isinstance(self.law, ContactLaw):
            law = f"F = {self.law.F}"
        elif isinstance(self.k, tuple) or self.law:
            law = f"{len(set(self.contact_laws))} contact laws"
        else:
            law = f"k = {self.k:g}"
        return f"{size}, {law}; duration {self.duration:g}{' s' if self.units else ''}"

    @property
    def size(self) -> int:
        """Number of beads."""
        return len(self.masses)

    @property
    def contact_count(self) -> int:
        """Number of contacts, the wall's included."""
        return len(self.stiffnesses) + (self.wall is not None)

    @property
    def contact_laws(self) -> tuple[tuple[float, ContactLaw | None], ...]:
        """Exponent k and law (None for a power) of each contact."""
        count = self.contact_count
        return tuple(zip(_row(self.k, count), _row(self.law, count), strict=True))

    @property
    def sensors(self) -> dict[str, tuple[int, ...]]:
        """Numbers of the sensors, from 0, by their kind, "bead" or "contact"."""
        return {"bead": self.bead_sensors, "contact": self.contact_sensors}

    @property
    def load(self) -> tuple[float, ...]:
        """Static force of each contact: F0 and the weight of the beads above."""
        above = accumulate(self.masses[: self.contact_count])
        return tuple(self.precompression + self.gravity * mass for mass in above)

    @classmethod
    def of_cell(cls, cell: Cell, repeats: int, k: Any, **rest: Any) -> Scene:
        """Return a chain of repeated periodic cells of the theory.

        The last contact of the last cell is left out. ``rest`` are further fields of the scene.
        Raises `SceneError` for a cell with symbols.

        >>> from lwa import Dimer
        >>> Scene.of_cell(Dimer(1, "1/2", spacing=1), 2, "3/2", duration=1).masses
        (1.0, 0.5, 1.0, 0.5)
        """
        if not isinstance(cell, Cell):
            raise SceneError(f"cell is {shorten(cell)}: a Cell of lwa is wanted")
        repeats = integer(repeats, "repeats", 1)
        masses = tuple(numeric(m, "mass") for m in cell.masses) * repeats
        stiffnesses = tuple(numeric(A, "stiffness") for A in cell.stiffnesses) * repeats
        spacings: Row = ()
        # Without a number for the spacing speeds are in sites alone.
        if cell.spacing.is_number:
            spacings = (float(cell.spacing),) * (len(masses) - 1)
        return cls(
            # The cell's last contact would join the next cell.
            masses=masses,
            stiffnesses=stiffnesses[:-1],
            k=k,
            spacings=spacings,
            **rest,
        )

    @classmethod
    def of_beads(
        cls, beads: Sequence[Sphere], *, wall: Material | None = None, **rest: Any
    ) -> Scene:
        """Return a chain of spheres in Hertz contact, in SI units, ended by a wall of a material.

        ``rest`` are further fields of the scene. Raises `SceneError` for spheres with symbols.
        """
        given = items(beads, "beads")
        if not given or not all(isinstance(bead, Sphere) for bead in given):
            raise SceneError(
                f"beads is {shorten(given)}: a sequence of spheres is wanted"
            )
        return cls(
            **contacts_of(given),
            wall=None if wall is None else float(stiffness(given[-1], wall)),
            units="SI",
            **rest,
        )


def contacts_of(beads: Sequence[Sphere]) -> dict[str, Any]:
    """Return the fields of a `Scene` that spheres in Hertz contact determine, as lists."""
    # Exact numbers take their time, and a chain has few kinds of beads and contacts.
    mass = cache(lambda bead: numeric(bead.mass, "mass"))
    contact = cache(lambda a, b: numeric(stiffness(a, b), "stiffness"))
    return {
        "masses": [mass(bead) for bead in beads],
        "stiffnesses": [contact(a, b) for a, b in pairwise(beads)],
        "spacings": [float(a.radius + b.radius) for a, b in pairwise(beads)],
        "k": 1.5,
    }


def _row(value: Any, count: int) -> tuple[Any, ...]:
    """Return one value for each contact; a single value is that of all."""
    return value if isinstance(value, tuple) else (value,) * count


_READERS: dict[str, Reader] = {
    "masses": each(positive),
    "stiffnesses": each(positive),
    "spacings": each(positive),
    "displacements": each(finite),
    "velocities": each(finite),
    "samples": partial(integer, low=2),
    "duration": positive,
    "wall": positive,
    "gravity": finite,
    "precompression": finite,
    "units": lambda value, name: one_of(value, ("", "SI"), name),
}


def _sensors(values: Any, name: str, count: int) -> tuple[int, ...]:
    """Read the numbers of sensors, each once, from 0 to ``count`` - 1."""
    given = items(values, name)
    if given and not count:
        raise SceneError(f"{name} is {shorten(given)}: this chain has none")
    sensors = tuple(
        integer(i, f"{name}[{j}]", 0, count - 1) for j, i in enumerate(given)
    )
    if len(set(sensors)) < len(sensors):
        raise SceneError(f"{name} have one sensor twice: each may be named once")
    return sensors
