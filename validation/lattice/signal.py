"""Signals: the quantities at the sensors of a run, as functions of time.

Between two steps of an integrator the motion of the beads near a sensor is known as a polynomial,
and contacts that open or close add a term. So a signal has a value at every time of the run, as
accurate as the run itself. The samples of a record are values of the same function.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import SceneError

_REGULA_FALSI = 9  # iterations, which leave less than 1e-12 of a step of the integrator

_QUANTITIES = {"contact": ("force", "compression"), "bead": ("force", "displacement", "velocity")}

Beads = Sequence[int] | NDArray[np.int_]
"""Numbers of beads."""


class Path(Protocol):
    """The motion of some beads as a function of time, throughout a run.

    Called with the numbers of neighbouring beads and with times (S,) within the run, a path returns
    displacements and velocities (beads, S).
    """

    @property
    def time(self) -> Array:
        """The ends of the steps, from 0 to the duration."""
        ...

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]: ...


@dataclass(frozen=True, eq=False)
class Sensor:
    """A sensor at a "contact" or "bead" of a scene, whose ``number`` counts from 0."""

    motion: Motion
    kind: str
    number: int

    @property
    def contacts(self) -> slice:
        """Numbers of the contacts on which the records depend."""
        first = self.number if self.kind == "contact" else max(self.number - 1, 0)
        return slice(first, self.number + 1)

    @property
    def beads(self) -> range:
        """Numbers of the beads whose motion the sensor needs; bead n is the wall."""
        first = self.contacts.start
        return range(first, first + len(self.motion.rest[self.contacts]) + 1)

    def compressions(self, y: Array) -> Array:
        """Return compressions (contacts, S) from displacements (beads, S) of the sensor's beads."""
        return np.asarray(y[:-1] - y[1:] + self.motion.rest[self.contacts, None])

    def values(self, y: Array, v: Array) -> dict[str, Array]:
        """Return each quantity, (S,), from the motion y, v, (beads, S), of the sensor's beads."""
        compressions = self.compressions(y)
        contact, damping = self.motion.contact, self.motion.damping[self.contacts]
        elastic = self.motion.stiffnesses[self.contacts, None] * contact.force(compressions)
        forces = contact.damped(elastic, damping, compressions, v[:-1] - v[1:])
        if self.kind == "contact":
            return {"force": forces[0], "compression": compressions[0]}
        bead = self.number - self.beads[0]
        # an end without a contact counts as 0
        return {"force": forces.sum(axis=0) / 2, "displacement": y[bead], "velocity": v[bead]}


@dataclass(frozen=True, eq=False)
class SensorSignal:
    """A quantity at a sensor of a run, as a function of times of any shape.

    times : increasing times from 0 to the duration, the ends of steps and the openings and closings
        of the sensor's contacts. The signal is smooth between neighbouring times.

    Values are NaN outside the run.
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


def sensors(motion: Motion) -> list[Sensor]:
    """Return the sensors of a scene, first at contacts, then at beads."""
    contacts, beads = motion.scene.contact_sensors, motion.scene.bead_sensors
    at_contacts = [Sensor(motion, "contact", i) for i in contacts]
    return at_contacts + [Sensor(motion, "bead", j) for j in beads]


def signal(motion: Motion, path: Path, kind: str, number: int, quantity: str) -> SensorSignal:
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
    return SensorSignal(times, Sensor(motion, kind, number), quantity, path)


def _kinks(motion: Motion, path: Path, contact: int) -> Array:
    """Return the times within steps at which a contact opens or closes."""
    sensor, time = Sensor(motion, "contact", contact), path.time

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
    return np.asarray(b[(b > time[step]) & (b < time[step + 1])])


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
