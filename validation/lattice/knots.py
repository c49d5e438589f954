"""Motion of the beads near sensors, interpolated between the ends of the engine's steps.

A knot is the end of a step, with the motion of the beads stored by the engine; a sample is a value
at one of the scene's sample times, interpolated between knots.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.kernel.arrays import ROOM, Chain, Knots
from validation.lattice.kernel.kinks import EDGES
from validation.lattice.kernel.samples import interpolate
from validation.lattice.signal import Beads

BUFFER = 2**18  # numbers that the engine stores between two calls of `take`
_MOST_BYTES = 2**28  # bytes of the motion that a run keeps


def _with_neighbours(beads: Beads) -> NDArray[np.int_]:
    """Return the increasing numbers of beads and their neighbours."""
    numbers = np.asarray(beads, int)
    near = np.zeros(numbers.max(initial=-2) + 3, bool)  # of beads -1, 0, 1, …
    near[numbers] = near[numbers + 1] = near[numbers + 2] = True
    return np.flatnonzero(near[1:])


def set_addresses(laws: Any, motion: Motion) -> None:
    """Write the addresses of the laws' machine code, which differ in each process."""
    for row, law in zip(laws, motion.laws, strict=False):
        for name, address in law.addresses.items():
            row[name] = address


@dataclass(frozen=True, eq=False)
class KnotPath:
    """A `validation.lattice.signal.Path` through knots (`validation.lattice.kernel.samples`)."""

    motion: Motion
    chain: Chain
    knots: Knots

    @property
    def time(self) -> Array:
        """The ends of the steps."""
        return self.knots.time

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore a pickled path: a law's machine code has another address in each process."""
        self.__dict__.update(state)
        set_addresses(self.chain.laws, self.motion)

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        # A bead's acceleration changes with its neighbours' displacements.
        near = _with_neighbours(beads)
        rows = np.searchsorted(self.knots.watched, near)
        step = np.searchsorted(self.time[1:-1], time, side="right")
        y, v = np.empty((2, len(rows), len(time)))
        working = np.empty((2, len(rows), 4)), np.empty((3, ROOM)), np.empty(EDGES)
        interpolate(self.chain, self.knots, rows, time, step, y, v, *working)
        own = np.searchsorted(near, beads)
        y, v = y[own], v[own]
        if self.motion.scene.drive is not None and 0 in beads:
            y[0], v[0], _ = self.motion.scene.drive.at(time)
        return y, v


class Recorder:
    """Collector of a run's knots, which computes the samples and keeps the motion for signals.

    needed : numbers of the B beads that the sensors need. time : (S,), sample times. knots : arrays
    that the engine fills. y, v : (B, S), samples of displacements and velocities.
    """

    def __init__(
        self, motion: Motion, chain: Chain, needed: NDArray[np.int_], time: Array
    ) -> None:
        self.motion, self.chain, self.needed, self.time = motion, chain, needed, time
        watched = _with_neighbours(needed)
        # A knot: four numbers a bead, and its time.
        most = 2 + (BUFFER // (4 * len(watched) + 1) if len(watched) else 0)
        self.knots = Knots(np.empty(most), np.empty((most, len(watched), 4)), watched)
        self.y, self.v = np.empty((2, len(needed), len(time)))
        self.parts: list[tuple[Array, Array]] = []
        self.done = self.size = 0

    def take(self, count: int) -> int:
        """Compute the samples up to knot ``count`` - 1, and keep the knots.

        Returns the number of knots left for the engine: the last knot begins its next step.
        """
        times, states, watched = self.knots
        if not len(watched):
            return 0
        part = times[:count].copy(), states[:count].copy()
        path = KnotPath(self.motion, self.chain, Knots(*part, watched))
        due = int(np.searchsorted(self.time, path.time[-1], side="right"))
        now = slice(self.done, due)
        self.y[:, now], self.v[:, now] = path(self.needed, self.time[now])
        self.done, self.size = due, self.size + part[1].nbytes
        if self.size <= _MOST_BYTES:
            self.parts.append(part)
        else:
            self.parts.clear()
        times[0], states[0] = times[count - 1], states[count - 1]
        return 1

    def path(self) -> KnotPath | None:
        """Return the motion of the whole run; None if it takes more than `_MOST_BYTES` bytes."""
        if not self.parts:
            return None
        times = np.concatenate(
            [self.parts[0][0], *(time[1:] for time, _ in self.parts[1:])]
        )
        states = np.concatenate(
            [self.parts[0][1], *(state[1:] for _, state in self.parts[1:])]
        )
        return KnotPath(
            self.motion, self.chain, Knots(times, states, self.knots.watched)
        )
