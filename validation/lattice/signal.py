"""Signals: the quantities at the sensors of a run, as functions of time.

Between two steps of an integrator the motion of the beads near a sensor is known as a polynomial,
and contacts that open or close add a term. So a signal has a value at every time of the run, as
accurate as the run itself. The samples of a record are values of the same function.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.checks import SceneError, one_of

_REGULA_FALSI = 9  # iterations, which leave less than 1e-12 of a step of the integrator

_QUANTITIES = {
    "contact": ("force", "compression"),
    "bead": ("force", "displacement", "velocity"),
}

_RECORDS = (
    "contact_force",
    "compression",
    "bead_force",
    "bead_displacement",
    "bead_velocity",
)
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

    @property
    def motion(self) -> Motion:
        """The equations of motion."""
        ...

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]: ...


def beads_at(
    motion: Motion, contacts: Sequence[int], beads: Sequence[int]
) -> NDArray[np.int_]:
    """Return increasing numbers of the beads on which sensors depend; bead n is the wall."""
    around = {*contacts, *beads, *(j - 1 for j in beads)}
    between = {i for i in around if 0 <= i < len(motion.rest)}
    return np.array(sorted({*beads, *between, *(i + 1 for i in between)}), int)


def _compressions(motion: Motion, beads: NDArray[np.int_], y: Array) -> Array:
    """Return compressions (B - 1, S) between ``beads``, (B,), from displacements y, (B, S).

    Rows between beads that are no neighbours in the chain mean nothing.
    """
    compressions = y[:-1] - y[1:]
    compressions += motion.rest[beads[:-1], None]
    return compressions


def _forces(
    motion: Motion, beads: NDArray[np.int_], compressions: Array, v: Array
) -> tuple[Array, Array]:
    """Return forces of contacts, (B - 1, S), and of beads, (B, S), from velocities v, (B, S).

    The force of a bead is the mean of its two contacts; an end without a contact counts as 0.
    """
    contacts, rate = beads[:-1], v[:-1] - v[1:]
    elastic = motion.force(compressions, contacts)
    forces = motion.damped_force(elastic, compressions, rate, contacts)
    means = np.zeros(v.shape)
    means[1:] = forces
    means[:-1] += forces
    means /= 2
    return forces, means


def recorded(
    motion: Motion, beads: NDArray[np.int_], y: Array, v: Array
) -> dict[str, Array]:
    """Return the records of all sensors by name, from the motion y, v, (B, S), of `beads_at`.

    The forces of all contacts are computed at once: of 76 sensors, one after the other, they took
    ten times as long as the integration.
    """
    if not len(beads):
        return dict.fromkeys(_RECORDS, y)
    compressions = _compressions(motion, beads, y)
    forces, means = _forces(motion, beads, compressions, v)
    at_contacts = np.searchsorted(beads, motion.scene.contact_sensors)
    at_beads = np.searchsorted(beads, motion.scene.bead_sensors)
    return {
        "contact_force": _rows(forces, at_contacts),
        "compression": _rows(compressions, at_contacts),
        "bead_force": _rows(means, at_beads),
        "bead_displacement": _rows(y, at_beads),
        "bead_velocity": _rows(v, at_beads),
    }


def _rows(values: Array, numbers: NDArray[np.int_]) -> Array:
    """Return rows of an array, without a copy, of which large records gain an eighth."""
    neighbours = len(numbers) > 1 and bool((np.diff(numbers) == 1).all())
    return values[numbers[0] : numbers[-1] + 1] if neighbours else values[numbers]


def sampled(motion: Motion) -> tuple[Array, NDArray[np.int_]]:
    """Return the sample times of a scene, and the numbers of the beads that its sensors need."""
    scene = motion.scene
    # np.linspace takes three times as long
    time = np.arange(scene.samples) / (scene.samples - 1) * scene.duration
    return time, beads_at(motion, scene.contact_sensors, scene.bead_sensors)


@dataclass(frozen=True, eq=False)
class SensorSignal:
    """A quantity at a sensor of a run, as a function of times of any shape.

    times : increasing times from 0 to the duration, the ends of steps and the openings and closings
        of the sensor's contacts. The signal is smooth between neighbouring times.
    kind, number : the sensor, at a "contact" or "bead" whose number counts from 0.

    Values are NaN outside the run.
    """

    times: Array
    motion: Motion
    path: Path
    kind: str
    number: int
    quantity: str

    @cached_property
    def _beads(self) -> NDArray[np.int_]:
        at_contact, number = self.kind == "contact", (self.number,)
        return beads_at(self.motion, *((number, ()) if at_contact else ((), number)))

    def __call__(self, time: ArrayLike) -> Array:
        t = np.asarray(time, float)
        inside = (t >= 0) & (t <= self.times[-1])
        values = np.full(t.shape, np.nan)
        y, v = self.path(self._beads, t[inside])
        compressions = _compressions(self.motion, self._beads, y)
        rows = {"compression": compressions, "displacement": y, "velocity": v}
        if self.quantity == "force":
            forces, means = _forces(self.motion, self._beads, compressions, v)
            rows["force"] = means if self.kind == "bead" else forces
        values[inside] = rows[self.quantity][self.number - self._beads[0]]
        return values


def signal(path: Path, kind: str, number: int, quantity: str) -> SensorSignal:
    """Return the signal of a quantity at a sensor of a run.

    Raises `SceneError` where the scene has no such sensor, or the sensor no such quantity.
    """
    motion, scene = path.motion, path.motion.scene
    one_of(kind, tuple(_QUANTITIES), "kind")
    one_of(quantity, _QUANTITIES[kind], "quantity")
    if number not in (
        scene.contact_sensors if kind == "contact" else scene.bead_sensors
    ):
        raise SceneError(
            f"number is {number!r}: the scene has no sensor at this {kind}"
        )
    contacts = [number] if kind == "contact" else [number - 1, number]
    kinks = [_kinks(motion, path, i) for i in contacts if 0 <= i < scene.contact_count]
    times = np.unique(np.concatenate((path.time, *kinks)))
    return SensorSignal(times, motion, path, kind, number, quantity)


def _kinks(motion: Motion, path: Path, contact: int) -> Array:
    """Return the times within steps at which a contact opens or closes."""
    time, beads = path.time, np.array([contact, contact + 1])

    def compression(t: Array) -> Array:
        return np.asarray(_compressions(motion, beads, path(beads, t)[0])[0])

    d = compression(time)
    step = np.flatnonzero(
        np.sign(d[1:]) * np.sign(d[:-1]) < 0
    )  # d itself over- or underflows
    a, b, f, g = time[step], time[step + 1], d[step], d[step + 1]
    for _ in range(_REGULA_FALSI if len(step) else 0):  # the Illinois variant
        c = b - g * (b - a) / np.where(g == f, 1.0, g - f)
        h = compression(c)
        beyond = np.sign(h) * np.sign(g) < 0
        a, f = np.where(beyond, b, a), np.where(beyond, g, f / 2)
        b, g = c, h
    return np.asarray(b[(b > time[step]) & (b < time[step + 1])])
