"""Signals: the quantities at the sensors of a run, as functions of time.

Between two steps of an integrator the motion of the beads near a sensor is known as a polynomial,
and contacts that open or close add a term. So a signal has a value at every time of the run, as
accurate as the run itself. The samples of a record are values of the same function.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.laws import Contact
from validation.scenes.checks import SceneError

_REGULA_FALSI = 9  # steps, that leave less than 1e-12 of a step of the integrator

_QUANTITIES = {"contact": ("force", "compression"), "bead": ("force", "displacement", "velocity")}


Beads = Sequence[int] | NDArray[np.int_]
"""Numbers of beads."""


class Path(Protocol):
    """The motion of some beads as a function of time, throughout a run.

    Called with the numbers of neighbouring beads and with times (S,) within the run, a path returns
    displacements and velocities (beads, S); NaN from the time at which a window left the bead.
    """

    @property
    def time(self) -> Array:
        """The ends of the steps, from 0 to the duration."""
        ...

    @property
    def kinks(self) -> dict[int, Array]:
        """Times within steps at which each contact opens or closes: a cache for `_kinks`."""
        ...

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]: ...


@dataclass(frozen=True)
class Sensor:
    """A "contact" or "bead" sensor of a scene, with the contacts on which its records depend.

    number : number of the contact or bead, from 0. first : number of the first contact. rest,
    stiffnesses, damping : static compressions, stiffnesses and damping coefficients of these
    contacts. contact : law of the contacts.
    """

    kind: str
    number: int
    first: int
    rest: tuple[float, ...]
    stiffnesses: tuple[float, ...]
    damping: tuple[float, ...]
    contact: Contact

    @classmethod
    def of(cls, motion: Motion, kind: str, number: int) -> Sensor:
        """Return the sensor at a contact or bead of a scene."""
        first = number if kind == "contact" else max(number - 1, 0)
        contacts = slice(first, number + 1)
        rows = motion.rest, motion.stiffnesses, motion.damping
        rest, A, damping = (tuple(row[contacts]) for row in rows)
        return cls(kind, number, first, rest, A, damping, motion.contact)

    @property
    def beads(self) -> range:
        """Numbers of the beads whose motion the sensor needs; bead n is the wall."""
        return range(self.first, self.first + len(self.rest) + 1)

    def compressions(self, y: Array) -> Array:
        """Return compressions (contacts, S) from displacements (beads, S) of the sensor's beads."""
        return np.asarray(y[:-1] - y[1:] + np.array(self.rest)[:, None])

    def values(self, y: Array, v: Array) -> dict[str, Array]:
        """Return each quantity, (S,), from the motion y, v, (beads, S), of the sensor's beads."""
        compressions = self.compressions(y)
        elastic = np.array(self.stiffnesses)[:, None] * self.contact.force(compressions)
        damping = np.array(self.damping)
        forces = self.contact.damped(elastic, damping, compressions, v[:-1] - v[1:])
        if self.kind == "contact":
            return {"force": forces[0], "compression": compressions[0]}
        own = self.number - self.first  # an end without a contact counts as 0
        return {"force": forces.sum(axis=0) / 2, "displacement": y[own], "velocity": v[own]}


@dataclass(frozen=True, eq=False)
class Signal:
    """A quantity at a sensor of a run, as a function of times of any shape.

    times : increasing times from 0 to the duration, the ends of steps and the openings and closings
        of the sensor's contacts. The signal is smooth between neighbouring times.

    Values are NaN outside the run, and after a window has left the sensor.
    """

    times: Array
    sensor: Sensor
    quantity: str
    path: Path

    def __call__(self, time: ArrayLike) -> Array:
        t = np.asarray(time, float)
        inside = (t >= 0) & (t <= self.times[-1])
        values = np.full(t.shape, np.nan)
        values[inside] = self.sensor.values(*self.path(self.sensor.beads, t[inside]))[self.quantity]
        return values


def sensors(motion: Motion) -> Iterator[Sensor]:
    """Yield the sensors of a scene, first at contacts, then at beads."""
    for i in motion.scene.contact_sensors:
        yield Sensor.of(motion, "contact", i)
    for j in motion.scene.bead_sensors:
        yield Sensor.of(motion, "bead", j)


def signal(motion: Motion, path: Path, kind: str, number: int, quantity: str) -> Signal:
    """Return the signal of a quantity at a sensor of a run.

    Raises `SceneError` where the scene has no such sensor, or the sensor no such quantity.
    """
    scene = motion.scene
    if kind not in _QUANTITIES or quantity not in _QUANTITIES[kind]:
        wanted = "; ".join(f"{name}: {', '.join(has)}" for name, has in _QUANTITIES.items())
        raise SceneError(f"no {kind} has a {quantity}: {wanted}")
    if number not in (scene.contact_sensors if kind == "contact" else scene.bead_sensors):
        raise SceneError(f"number is {number!r}: the scene has no sensor at this {kind}")
    contacts = [number] if kind == "contact" else [number - 1, number]
    kinks = [_kinks(motion, path, i) for i in contacts if 0 <= i < scene.contact_count]
    times = np.unique(np.concatenate((path.time, *kinks)))
    return Signal(times, Sensor.of(motion, kind, number), quantity, path)


def _kinks(motion: Motion, path: Path, contact: int) -> Array:
    """Return times within steps at which a contact opens or closes; cached in ``path.kinks``."""
    if contact not in path.kinks:
        sensor, time = Sensor.of(motion, "contact", contact), path.time

        def compression(t: Array) -> Array:
            return np.asarray(sensor.compressions(path(sensor.beads, t)[0])[0])

        d = compression(time)
        step = np.flatnonzero(d[1:] * d[:-1] < 0)
        a, b, f, g = time[step], time[step + 1], d[step], d[step + 1]
        for _ in range(_REGULA_FALSI if len(step) else 0):  # the Illinois variant
            c = b - g * (b - a) / np.where(g == f, 1.0, g - f)
            h = compression(c)
            beyond = h * g < 0
            a, f = np.where(beyond, b, a), np.where(beyond, g, f / 2)
            b, g = c, h
        path.kinks[contact] = b[(b > time[step]) & (b < time[step + 1])]
    return path.kinks[contact]


def recorded(motion: Motion, beads: NDArray[np.int_], y: Array, v: Array) -> dict[str, Array]:
    """Return the records of all sensors by name, from the motion y, v, (B, S), of the beads."""
    rows: dict[str, list[Array]] = {name: [] for name in RECORDS}
    for sensor in sensors(motion):
        near = np.searchsorted(beads, sensor.beads)
        for quantity, values in sensor.values(y[near], v[near]).items():
            name = quantity if quantity == "compression" else f"{sensor.kind}_{quantity}"
            rows[name].append(values)
    return {name: np.array(row).reshape(len(row), y.shape[1]) for name, row in rows.items()}


RECORDS = ("contact_force", "compression", "bead_force", "bead_displacement", "bead_velocity")
"""Names of the records of a run."""


def sampled(motion: Motion) -> tuple[Array, NDArray[np.int_]]:
    """Return the sample times of a scene, and the numbers of the beads that its sensors need."""
    scene = motion.scene
    # np.linspace takes three times as long
    time = np.arange(scene.samples) / (scene.samples - 1) * scene.duration
    return time, np.array(sorted({j for sensor in sensors(motion) for j in sensor.beads}), int)
