"""Motion of the beads near sensors, interpolated between the ends of the engine's steps.

A knot is the end of a step, with the motion of the beads stored by the engine; a sample is a value
at one of the scene's sample times, interpolated between knots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Chain, Knots
from validation.lattice.kernel.samples import interpolate
from validation.lattice.laws import Contact
from validation.lattice.signal import Beads

_BUFFER = 2**18  # numbers of the knots that the engine stores between two calls of `take`
_MOST_BYTES = 2**28  # bytes of knots that a run keeps


@dataclass(frozen=True, eq=False)
class KnotPath:
    """A `validation.lattice.signal.Path` through knots (`validation.lattice.kernel.samples`).

    contact : law of the contacts. points : nodes and weights of the quadrature at kinks.
    """

    contact: Contact
    chain: Chain
    points: Array
    knots: Knots

    @property
    def time(self) -> Array:
        """The ends of the steps."""
        return self.knots.time

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore a pickled path: a law's machine code has another address in each process."""
        chain = state["chain"]._replace(**state["contact"].addresses)
        self.__dict__.update(state | {"chain": chain})

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        rows = np.searchsorted(self.knots.watched, beads)
        step = np.searchsorted(self.time[1:-1], time, side="right")
        y, v = np.empty((2, len(rows), len(time)))
        interpolate(self.chain, self.points, self.knots, rows, time, step, y, v)
        return y, v


class Recorder:
    """Collector of a run's knots, which computes the samples and stores the knots for signals.

    needed : numbers of the B beads that the sensors need. time : (S,), sample times. y, v : (B, S),
    samples of displacements and velocities.
    """

    def __init__(
        self, contact: Contact, chain: Chain, points: Array, needed: NDArray[np.int_], time: Array
    ) -> None:
        self._path = partial(KnotPath, contact, chain, points)
        self.needed, self.time = needed, time
        # A bead's acceleration changes with its neighbours' displacements.
        near = {j + m for j in needed.tolist() for m in (-1, 0, 1)}
        watched = np.array(sorted(near - {-1}), int)
        most = 2 + _BUFFER // (3 * len(watched) + 1)
        self.knots = Knots(np.empty(most), watched, np.empty((most, len(watched), 3)))
        self.y, self.v = np.empty((2, len(needed), len(time)))
        self.parts: list[tuple[Array, Array]] = []
        self.done = self.size = 0

    def take(self, count: int) -> int:
        """Compute the samples between the first ``count`` knots, and store these knots.

        Returns the number of knots left for the engine: 1, the last knot, or 0 without sensors.
        """
        time, watched, state = self.knots
        if not len(watched):
            return 0
        part = time[:count].copy(), state[:count].copy()
        path = self._path(Knots(part[0], watched, part[1]))
        due = int(np.searchsorted(self.time, part[0][-1], side="right"))
        now = slice(self.done, due)
        self.y[:, now], self.v[:, now] = path(self.needed, self.time[now])
        self.done, self.size = due, self.size + part[1].nbytes
        if self.size <= _MOST_BYTES:
            self.parts.append(part)
        else:
            self.parts.clear()
        time[0], state[0] = time[count - 1], state[count - 1]
        return 1

    def path(self) -> KnotPath | None:
        """Return the motion of the whole run; None if it takes more than `_MOST_BYTES` bytes."""
        if not self.parts:
            return None
        # Each part begins with the last knot of the part before.
        time, state = (
            np.concatenate((arrays[0], *(array[1:] for array in arrays[1:])))
            for arrays in zip(*self.parts, strict=True)
        )
        return self._path(Knots(time, self.knots.watched, state))
