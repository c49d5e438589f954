"""Signals: the quantities at the sensors of a run, as functions of time.

Between two steps of an integrator the motion of the beads near a sensor is known as a polynomial,
and contacts that open or close add a term. So a signal has a value at every time of the run, as
accurate as the run itself. The samples of a record are values of the same function.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.scenes.scene import Scene

# Iterations of Newton's method. Of 227 contacts of random scenes one, which opened at a small rate,
# was left more than 1e-12 of a step away; three iterations leave twenty.
_NEWTON = 7

RECORDS = {
    ("bead", "force"): "bead_force",
    ("bead", "displacement"): "bead_displacement",
    ("bead", "velocity"): "bead_velocity",
    ("contact", "force"): "contact_force",
    ("contact", "compression"): "compression",
}
"""Name of a record, an attribute of `Run`, by kind of sensor and quantity."""

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

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities, (beads, S), of every bead at every time."""
        ...


def beads_at(motion: Motion, sensors: Mapping[str, Sequence[int]]) -> NDArray[np.int_]:
    """Return increasing numbers of the beads on which sensors depend; bead n is the wall."""
    beads = {*sensors.get("bead", ())}
    contacts = {*sensors.get("contact", ())}
    contacts |= beads | {i - 1 for i in beads}
    for i in contacts:
        # An end bead has one contact.
        if 0 <= i < len(motion.rest):
            beads |= {i, i + 1}
    return np.array(sorted(beads), int)


def quantities(
    motion: Motion, beads: NDArray[np.int_], y: Array, v: Array
) -> dict[str, Array]:
    """Return all records by name, at ``beads``, (B, S), and between them, (B - 1, S).

    The force of a bead is the mean of its two contacts; an end without a contact counts as 0. Rows
    between beads that are no neighbours in the chain mean nothing. The forces of all contacts are
    computed at once: of 76 sensors, one after the other, they took ten times as long as the
    integration.
    """
    contacts = beads[:-1]
    compressions = y[:-1] - y[1:]
    compressions += motion.rest[contacts, None]
    elastic = motion.force(compressions, contacts)
    rates = v[:-1] - v[1:]
    forces = motion.damped_force(elastic, compressions, rates, contacts)
    # Half of the contact behind, and half of the contact ahead of each bead.
    means = np.zeros(v.shape)
    means[1:] = forces
    means[:-1] += forces
    means /= 2
    return {
        "bead_force": means,
        "bead_displacement": y,
        "bead_velocity": v,
        "contact_force": forces,
        "compression": compressions,
    }


def sensed_beads(motion: Motion) -> NDArray[np.int_]:
    """Return increasing numbers of the beads on which a scene's sensors depend."""
    return beads_at(motion, motion.scene.sensors)


def sample_times(scene: Scene) -> Array:
    """Return the sample times of a scene, (S,)."""
    # np.linspace takes three times as long
    shares = np.arange(scene.samples) / (scene.samples - 1)
    return shares * scene.duration


@dataclass(frozen=True, eq=False)
class SensorSignal:
    """A quantity at a sensor of a run, as a function of times of any shape; NaN outside the run.

    Parameters
    ----------
    times : array, shape (T,)
        Increasing times from 0 to the duration: the ends of steps, and the openings and closings of
        the sensor's contacts. The signal is smooth between neighbouring times.
    path : Path
        Motion of the beads near the sensor.
    beads : array of int
        Numbers of the beads on which the quantity depends.
    record : str
        Name of the record whose samples are values of the signal, one of `RECORDS`.
    number : int
        Number of the bead or contact, counted from 0.
    """

    times: Array
    path: Path
    beads: NDArray[np.int_]
    record: str
    number: int

    def __call__(self, time: ArrayLike) -> Array:
        t = np.asarray(time, float)
        inside = (t >= 0) & (t <= self.times[-1])
        values = np.full(t.shape, np.nan)
        y, v = self.path(self.beads, t[inside])
        rows = quantities(self.path.motion, self.beads, y, v)[self.record]
        # Row r belongs to bead ``beads[0] + r``, or to the contact ahead of it: the beads are
        # neighbours.
        row = self.number - self.beads[0]
        values[inside] = rows[row]
        return values


def contact_changes(path: Path, contact: int) -> Array:
    """Return the times within steps at which a contact opens or closes.

    A contact that does both within a step changes twice, unseen: the signal is less smooth there.
    """
    time = path.time
    beads = np.array([contact, contact + 1])

    def compression(t: Array) -> tuple[Array, Array]:
        """Return δ and dδ/dt at times within the run."""
        y, v = path(beads, t)
        pressed = path.motion.rest[contact] + y[0] - y[1]
        return pressed, v[0] - v[1]

    d, _ = compression(time)
    # Signs are compared, as products of compressions over- or underflow.
    sign = np.sign(d)
    step = np.flatnonzero(sign[1:] * sign[:-1] < 0)
    early = time[step]
    late = time[step + 1]
    # The root of the straight line through both ends of the step
    first = d[step]
    last = d[step + 1]
    change = early + (late - early) * first / (first - last)
    if not len(step):
        return change
    for _ in range(_NEWTON):
        d, rate = compression(change)
        rate[rate == 0] = 1.0  # any number: the change stays within its step
        change = np.clip(change - d / rate, early, late)
    return change[(change > early) & (change < late)]
