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
from validation.lattice.kernel.arrays import Chain, Knots
from validation.lattice.kernel.samples import interpolate
from validation.lattice.signal import Beads

BUFFER = 2**18  # numbers that the engine stores between two calls of `take`
_MOST_BYTES = 2**28  # bytes of the motion that a run keeps


@dataclass(frozen=True, eq=False)
class KnotPath:
    """A `validation.lattice.signal.Path` through knots (`validation.lattice.kernel.samples`).

    points : nodes and weights of the quadrature at kinks.
    """

    motion: Motion
    chain: Chain
    points: Array
    knots: Knots

    @property
    def time(self) -> Array:
        """The ends of the steps."""
        return self.knots.time

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore a pickled path: a law's machine code has another address in each process."""
        chain = state["chain"]._replace(**state["motion"].contact.addresses)
        self.__dict__.update(state | {"chain": chain})

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        rows = np.searchsorted(self.knots.watched, beads)
        step = np.searchsorted(self.time[1:-1], time, side="right")
        y, v = np.empty((2, len(rows), len(time)))
        interpolate(self.chain, self.points, self.knots, rows, time, step, y, v)
        if self.motion.scene.drive is not None and 0 in beads:
            y[0], v[0], _ = self.motion.scene.drive.at(time)
        return y, v


class Recorder:
    """Collector of a run's steps, which computes the samples and keeps the motion for signals.

    store : arrays that the engine fills, by steps, and last the watched beads. path : makes a
    `validation.lattice.signal.Path` of these arrays. shared : rows that two parts share. needed :
    numbers of the B beads that the sensors need. time : (S,), sample times. y, v : (B, S), samples
    of displacements and velocities.
    """

    def __init__(
        self, store: Any, path: Any, shared: int, needed: NDArray[np.int_], time: Array
    ) -> None:
        self.store, self._path, self.shared = store, path, shared
        self.needed, self.time = needed, time
        self.y, self.v = np.empty((2, len(needed), len(time)))
        self.parts: list[tuple[Array, ...]] = []
        self.done = self.size = 0

    def take(self, count: int) -> int:
        """Compute the samples in the first ``count`` rows of the store, and keep these rows.

        Returns the number of rows left for the engine.
        """
        *arrays, watched = self.store
        if not len(watched):
            return 0
        part = tuple(array[:count].copy() for array in arrays)
        path = self._path(*part, watched)
        due = int(np.searchsorted(self.time, path.time[-1], side="right"))
        now = slice(self.done, due)
        self.y[:, now], self.v[:, now] = path(self.needed, self.time[now])
        self.done, self.size = due, self.size + part[-1].nbytes
        if self.size <= _MOST_BYTES:
            self.parts.append(part)
        else:
            self.parts.clear()
        for array in arrays:
            array[: self.shared] = array[count - self.shared : count]
        return self.shared

    def path(self) -> Any:
        """Return the motion of the whole run; None if it takes more than `_MOST_BYTES` bytes."""
        if not self.parts:
            return None
        rows = zip(*self.parts, strict=True)
        kept = ((first, *(array[self.shared :] for array in more)) for first, *more in rows)
        return self._path(*map(np.concatenate, kept), self.store[-1])


def knot_recorder(
    motion: Motion, chain: Chain, scheme: Any, needed: NDArray[np.int_], time: Array
) -> Recorder:
    """Return the recorder of the knots of a pair or a splitting."""
    # A bead's acceleration changes with its neighbours' displacements.
    near = {j + m for j in needed.tolist() for m in (-1, 0, 1)}
    watched = np.array(sorted(near - {-1}), int)
    most = 2 + BUFFER // (3 * len(watched) + 1)
    knots = Knots(np.empty(most), np.empty((most, len(watched), 3)), watched)

    def path(*arrays: Any) -> KnotPath:
        return KnotPath(motion, chain, scheme.points, Knots(*arrays))

    return Recorder(knots, path, 1, needed, time)
