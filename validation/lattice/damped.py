"""Coefficients and interpolant of the Runge–Kutta pair that integrates damped contacts.

The pair is Dormand and Prince's of order 8 with Hairer's interpolant of order 7, as SciPy has it:
Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.5, II.6 and II.10. How it
is used stands in `validation.lattice.kernel.damped`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import DOP853

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.kernel.arrays import Chain
from validation.lattice.kernel.damped import DENSE, STEP, WIDTH, Scheme, Steps
from validation.lattice.knots import BUFFER, Recorder
from validation.lattice.laws import Contact
from validation.lattice.signal import Beads
from validation.scenes.forcing import Drive

COLUMNS = -(-DENSE // WIDTH) * WIDTH
"""Rows of stored forces: the stages, and zeros that fill the last group of `WIDTH`."""


def scheme_of(contact: Contact) -> Scheme:
    """Return the coefficients for a law of contact and its damping.

    From a closing on the force is a series in t^k and t^p, which are smooth in x if t = x^q with
    integer q k and q p. For other k and p, q = 4 leaves weak singularities to the error estimate.
    """
    powers = contact.k, contact.damping_power or 0.0
    if contact.pulls:
        return _scheme(1)
    if contact.law is not None:
        return _scheme(4)
    whole = (q for q in (1, 2) if all((q * power).is_integer() for power in powers))
    return _scheme(next(whole, 4))


@cache
def _scheme(power: int) -> Scheme:
    """Return the coefficients of steps in which time runs as x, and as x^``power``."""
    both = zip(_coefficients(1), _coefficients(power), strict=True)
    times, rows, errors = map(np.stack, both)
    return Scheme(times, rows, errors, power)


@cache
def _tableau() -> tuple[Array, Array]:
    """Return nodes and matrix of all stages; row `STEP` is the step's end."""
    c = np.concatenate((DOP853.C, [1.0], DOP853.C_EXTRA))
    a = np.zeros((DENSE, DENSE))
    a[:STEP, :STEP], a[STEP, :STEP], a[STEP + 1 :] = DOP853.A, DOP853.B, DOP853.A_EXTRA
    return c, a


def _pace(q: int) -> Array:
    """Return dt/dx at the stages for t = x^q."""
    return np.asarray(q * _tableau()[0] ** (q - 1.0))


def _coefficients(q: int) -> tuple[Array, ...]:
    """Return the arrays of `Scheme` for t = x^q: a right-hand side f becomes f dt/dx.

    The pair is applied to the difference to a motion under constant forces f_0, which is exact.
    """
    c, a = _tableau()
    speeds, t = a * _pace(q), c**q
    errors = np.zeros((3, DENSE))
    errors[:2, : STEP + 1] = DOP853.E3, DOP853.E5
    errors[2] = 4**4 * 3**3 / 7**7 * DOP853.D[3]  # the greatest x^4 (1 - x)^3, times F_6
    errors *= _pace(q)
    rows = _balanced(speeds @ speeds, t * t / 2), _balanced(speeds, t)
    ends = _balanced(errors @ speeds, 0), _balanced(errors, 0)
    zeros = (0, 0), (0, 0), (0, COLUMNS - DENSE)
    return t, *(np.pad(np.stack(pair, axis=1), zeros) for pair in (rows, ends))


def _balanced(weights: Array, total: ArrayLike) -> Array:
    """Change the first column of weights so that the rows have given sums."""
    weights[:, 0] += total - weights.sum(axis=1)
    return weights


def _interpolant(x: Array) -> Array:
    """Return the interpolant's weights of the stages at places x of a step, (S, `DENSE`).

    It is x (F_0 + (1 - x) (F_1 + x (F_2 + … + x F_6))), with the row F_n of weights.
    """
    _, a = _tableau()
    first, last = np.eye(DENSE)[[0, STEP]]
    rows = [a[STEP], first - a[STEP], 2 * a[STEP] - first - last, *DOP853.D]
    total, x = np.zeros(DENSE), x[:, None]
    for n in reversed(range(len(rows))):
        total = (rows[n] + total) * (x if n % 2 == 0 else 1 - x)
    return total


@dataclass(frozen=True, eq=False)
class StepPath:
    """A `validation.lattice.signal.Path` through stored steps.

    scheme : coefficients of the steps. inverse : (W,), inverse masses of the watched beads. drive :
    motion of bead 0. steps : the steps.
    """

    scheme: Scheme
    inverse: Array
    drive: Drive | None
    steps: Steps

    @property
    def time(self) -> Array:
        """The ends of the steps."""
        return np.append(self.steps.step[:, 0], self.steps.step[-1, 3])

    def __call__(self, beads: Beads, time: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (beads, S) at times (S,) within the run."""
        n = np.searchsorted(self.steps.step[1:, 0], time, side="right")
        rows, kind = np.searchsorted(self.steps.watched, beads), self.steps.step[n, 2]
        y, v = np.empty((2, len(rows), len(time)))
        for row, q in enumerate((1, self.scheme.power)):
            at = np.flatnonzero(kind == row)
            y[:, at], v[:, at] = self._moved(n[at], time[at], rows, q)
        if self.drive is not None and 0 in beads:
            y[0], v[0], _ = self.drive.at(time)
        return y, v

    def _moved(
        self, n: NDArray[np.int_], time: Array, rows: NDArray[np.int_], q: int
    ) -> tuple[Array, Array]:
        """Return the motion in steps with numbers ``n``, (S,), in which time runs as x^q."""
        begin, h, _, _ = self.steps.step[n].T
        x = ((time - begin) / h).clip(0.0, 1.0) ** (1 / q)
        speeds = _interpolant(x) * _pace(q)
        t, a = x**q, _tableau()[1] * _pace(q)
        moments, speeds = _balanced(speeds @ a, t * t / 2), _balanced(speeds, t)
        force = self.steps.force[n]
        push = (force[:, rows] - force[:, rows + 1]) * self.inverse[rows, None]
        y, v = self.steps.start[n][:, rows].T
        moved = h * t * v + h * h * np.einsum("sj,sbj->bs", moments, push)
        return y + moved, v + h * np.einsum("sj,sbj->bs", speeds, push)


def step_recorder(
    motion: Motion, chain: Chain, scheme: Scheme, needed: NDArray[np.int_], time: Array
) -> Recorder:
    """Return the recorder of the steps of damped contacts."""
    watched = np.array(sorted({j + m for j in needed.tolist() for m in (0, 1)}), int)
    most, count = 2 + BUFFER // (DENSE * len(watched) + 1), len(watched)
    steps = Steps(
        np.empty((most, 4)), np.empty((most, count, 2)), np.empty((most, count, DENSE)), watched
    )

    def path(*arrays: Any) -> StepPath:
        return StepPath(scheme, chain.inverse[watched], motion.scene.drive, Steps(*arrays))

    return Recorder(steps, path, 0, needed, time)
