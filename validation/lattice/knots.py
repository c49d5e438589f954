"""Motion of the beads near sensors, interpolated between the ends of the engine's steps.

A knot is the end of a step, with the motion of the beads stored by the engine; a sample is a value
at one of the scene's sample times, interpolated between knots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.kernel.arrays import ROOM, Chain, Knots
from validation.lattice.kernel.kinks import EDGES
from validation.lattice.kernel.samples import interpolate
from validation.lattice.signal import Beads, sample_times, sensed_beads

# Numbers that the engine stores between two calls of `take`: 2 MB, which a cache holds.
BUFFER = 2**18
# Largest motion that a run keeps: a small part of a machine's memory.
_MOST_BYTES = 2**28


def _with_neighbours(beads: Beads) -> NDArray[np.int_]:
    """Return the increasing numbers of beads and their neighbours.

    Behind bead 0 is none. Beyond the last bead the wall and the chain's padding are beads at rest.
    """
    near = np.unique(np.add.outer(beads, (-1, 0, 1)))
    return near[near >= 0]


@lru_cache(maxsize=1)
def _watched(motion: Motion) -> NDArray[np.int_]:
    """Return the numbers of the beads whose motion a run stores."""
    return _with_neighbours(sensed_beads(motion))


@dataclass(frozen=True, eq=False)
class KnotPath:
    """A `validation.lattice.signal.Path` through knots (`validation.lattice.kernel.samples`).

    Parameters
    ----------
    motion : Motion
        The equations of motion.
    chain : Chain
        The chain of the compiled loops.
    knots : Knots
        Motion of the beads at the ends of the steps.
    """

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
        # The padding may have a law of its own behind those of the motion, a linear one.
        for row, law in zip(self.chain.laws, self.motion.laws, strict=False):
            for name, address in law.addresses.items():
                row[name] = address

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        # A bead's acceleration changes with its neighbours' displacements.
        near = _with_neighbours(beads)
        rows = self.knots.watched.searchsorted(near)
        step = self.time[1:-1].searchsorted(time, side="right")
        y, v = np.empty((2, len(rows), len(time)))
        interpolate(
            self.chain,
            self.knots,
            rows,
            np.array(time),  # numba compiles once more for an array that is read-only
            step,
            y,
            v,
            # Working memory: the compiled loops allocate nothing.
            ends=np.empty((2, len(rows), 3)),
            moved=np.empty((2, len(rows), 7)),
            pushes=np.empty((len(rows), 7)),
            points=np.empty((3, ROOM)),
            edges=np.empty(EDGES),
        )
        own = near.searchsorted(beads)
        y, v = y[own], v[own]
        if self.motion.scene.drive is not None and 0 in beads:
            y[0], v[0], _ = self.motion.scene.drive.at(time)
        return y, v


class Recorder:
    """Collector of a run's knots, which keeps them for signals, or computes the samples.

    Parameters
    ----------
    motion : Motion
        The equations of motion.
    chain : Chain
        The chain of the compiled loops.

    Attributes
    ----------
    knots : Knots
        Arrays that the engine fills.
    samples : list of array, (2, B, S)
        Displacements and velocities of the beads that the sensors need, at the sample times of
        knots that were not kept.
    """

    def __init__(self, motion: Motion, chain: Chain) -> None:
        self.motion = motion
        self.chain = chain
        watched = _watched(motion)
        most = 2  # the ends of a step
        if len(watched):
            # A knot is its time, and for each bead displacement, velocity, acceleration and the
            # mark of a kink of the contact ahead.
            most += BUFFER // (4 * len(watched) + 1)
        self.knots = Knots(
            time=np.empty(most),
            state=np.empty((most, len(watched), 4)),
            watched=watched,
        )
        self.samples: list[Array] = []
        self._parts: list[tuple[Array, Array]] = []  # times and states of knots
        self._bytes = 0

    def take(self, count: int) -> int:
        """Keep the knots up to number ``count`` - 1, or compute their samples.

        Returns the number of knots left for the engine: the last knot begins its next step.
        """
        times, states, watched = self.knots
        if not len(watched):
            return 0
        # The first knot of a part is also the last knot of the part before.
        part = times[:count].copy(), states[:count].copy()
        self._parts.append(part)
        self._bytes += part[1].nbytes
        times[0] = times[count - 1]
        states[0] = states[count - 1]
        if self._bytes > _MOST_BYTES:
            self._sample()
        return 1

    def _sample(self) -> None:
        """Compute the samples up to the last knot, and drop the knots.

        `take` has put the last knot first in the engine's arrays: the next part begins with it. The
        bytes stay counted: once they are too many, the samples of each later part are computed too.
        """
        path = self.path()
        assert path is not None  # `take` has just appended a part
        time = sample_times(self.motion.scene)
        # Parts of the samples: displacements and velocities (2, beads, times).
        done = sum(part.shape[2] for part in self.samples)
        due = time.searchsorted(path.time[-1], side="right")
        motions = path(sensed_beads(self.motion), time[done:due])
        self.samples.append(np.array(motions))
        self._parts.clear()

    def path(self) -> KnotPath | None:
        """Return the motion of the whole run; None if it takes more than `_MOST_BYTES` bytes."""
        # Parts that took too much memory have become samples.
        if not self._parts:
            return None
        times, states = zip(*self._parts, strict=True)
        knots = Knots(
            time=np.concatenate(times),
            state=np.concatenate(states),
            watched=self.knots.watched,
        )
        return KnotPath(self.motion, self.chain, knots)
