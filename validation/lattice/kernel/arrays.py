"""Records that the compiled loops share: chain, beads, knots, tableau, plan and progress."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import config
from numpy.typing import NDArray

from lwa.base.arrays import Array

Numbers = NDArray[np.int_]

# Still beads that are moved besides, the last ones before the front. Measured on struck chains of
# 200 beads, k = 1.05 to 3: velocities differ from those of a run that moves all beads by a fiftieth
# of rtol at most; with 2 such beads by a sixth.
MARGIN = 4
SHORTEST = 16  # beads that are moved at least: two of the widest registers
BLOCK = 8  # doubles in the widest vector register; the number of moved beads is a multiple of it
# Beads whose memory stays in the processor's cache throughout a step. Measured for 20,000 beads:
# 128 and 256 take the same time, 512 a tenth more, 1,024 a fifth more.
TILE = 256
GROUP = 4  # stages that `pair` adds up at a time
ROOM = 4 * GROUP  # most stages of a pair
# Entries of `Beads.books`; rows of `Beads.power` are HEAT and WORK.
HEAT, WORK, HEAT_ERROR, WORK_ERROR, SQUARES, AFTER = range(6)


class Forcing(NamedTuple):
    """Damping of a chain, and the motion of a first bead that is driven.

    The motion is ``y(t) = c0 + c1 s + c2 s² + c3 s³ + amplitude r(t) sin(wt)``. A chain without
    damping and drive has None, for which numba compiles loops that know nothing of both: a first
    run takes a third less time.

    Parameters
    ----------
    times : array
        Beginnings of intervals; s is the time since the last of them.
    cubics : array, (intervals, 4)
        Coefficients c.
    amplitude, w : float
        Amplitude and angular frequency of the oscillation.
    ramp : float
        Time within which r grows from 0 to 1; 0 if r is 1.
    driven : bool
        False if the first bead is as free as the others.
    damped : bool
        True with damping.
    """

    times: Array
    cubics: Array
    amplitude: float
    w: float
    ramp: float
    driven: bool
    damped: bool


LAW = np.dtype(
    [
        ("k", float),
        ("p", float),
        ("q", float),
        ("generated", bool),
        ("pulls", bool),
        ("sticks", bool),
        ("force", np.int64),
        ("slope", np.int64),
        ("energy", np.int64),
    ]
)
"""A contact law for unit stiffness, ``F(δ) + r [δ]_+^p dδ/dt``, by its fields:

- k, the exponent of a power law ``F = [δ]_+^k``;
- p, the exponent of the damping;
- q, such that the force is smooth in u if ``δ = u^q``;
- generated, True for a law that is no power;
- pulls, True if contacts hold where ``δ < 0``;
- sticks, True if damping may pull, as the law pulls, or attracts where the contact opens;
- force, slope, energy: addresses of the machine code of F, its derivative and its integral, of a
  law that is no power.
"""


class Chain(NamedTuple):
    """A chain, padded by beads of infinite mass, of which the first is the wall.

    Parameters
    ----------
    inverse : array
        Inverse masses.
    A, r, rest, load : array
        Stiffnesses, damping coefficients over stiffnesses, static compressions and static forces of
        the contacts.
    opens : array
        1 for contacts that open, 0 for those that pull and for the padding.
    laws : record array, (L,)
        Records of `LAW`.
    law : array of int
        Number of each contact's law.
    alike : array of int
        For each contact the number of the next contact with another law.
    """

    inverse: Array
    A: Array
    r: Array
    rest: Array
    load: Array
    opens: Array
    laws: Any
    law: Numbers
    alike: Numbers


class Beads(NamedTuple):
    """The state of the beads, and the working memory of a step.

    Parameters
    ----------
    y, v : array, (padded + 1,)
        Displacements and velocities.
    next_y, next_v : array, (padded + 1,)
        Displacements and velocities after the step that is tried.
    force : array, (2, padded + 1)
        Force on each bead from behind, less the static force, at the start of the step and at the
        stage that was computed last.
    push : array, (`ROOM`, padded + 1)
        Acceleration of each bead by its two contacts, by stage: row 0 at the step's start, the row
        of the last stage at its end. A driven bead, of infinite mass, has 0.
    errors : array, (2 or 4, padded + 1)
        The pair's estimates of each bead's error in displacement and velocity, in units of the
        tolerance; two more rows for a third solution of lower order. While a stage is computed, row
        0 is the power that each contact dissipates.
    marks : array, (padded + 1,)
        1 for each contact with a kink.
    power : array, (2, `ROOM`)
        Power that all contacts dissipate, and power of the drive, by stage.
    given : array, (2,)
        Accelerations of a driven bead at the step's two ends; 0 without a drive.
    books : array, (6,)
        Sums over the corrected contacts of a step. HEAT and WORK: corrections of the heat and of
        the drive's work. HEAT_ERROR and WORK_ERROR: what these contacts contribute to the pair's
        estimates of the errors of both. SQUARES: the squared errors of the corrections themselves,
        in units of the tolerance. AFTER is no sum, but the greatest share of the step that comes
        after the first kink of a damped contact.
    points : array, (3, `ROOM`)
        Working memory of one contact at a time. In `kinks.integrals` rows 0 and 1 are the places
        and the weights of Gauss's rule. In `corrections` the rows are δ, δ' and the force for unit
        stiffness at the stages of the pair.
    edges : array, (`kinks.EDGES`,)
        Places between which the force of a contact is smooth.
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    force: Array
    push: Array
    errors: Array
    marks: Array
    power: Array
    given: Array
    books: Array
    points: Array
    edges: Array


class Knots(NamedTuple):
    """The motion of W watched beads at up to C knots, the ends of steps.

    Parameters
    ----------
    time : array, (C,)
        Times of the knots.
    state : array, (C, W, 4)
        Displacement, velocity, acceleration, and 1 if the step to the knot was corrected for a kink
        of the contact ahead of the bead; otherwise 0.
    watched : array of int, (W,)
        Increasing numbers of the beads.
    """

    time: Array
    state: Array
    watched: Numbers


class Pair(NamedTuple):
    """Coefficients of an embedded pair in Nyström form; the last stage is the step's end.

    Stage s moves a bead by ``h c_s v + h² Σ_j moments[s, j] f_j``, and changes its velocity by
    ``h Σ_j impulses[s, j] f_j``.

    Parameters
    ----------
    nodes : array, (stages,)
        The places ``c_s`` of the stages in the step.
    moments, impulses : array, (stages, `ROOM`)
        Weights, 0 beyond the last stage; of the impulses only the last row counts if forces do not
        depend on velocities.
    errors : array, (2 or 4, `ROOM`)
        Weights of the differences of the two solutions, in displacement and velocity; two more rows
        for a third solution of lower order.
    thirds : array, (stages,)
        Weights of ``∫ (1 - x)²/2 f(x) dx``, x from 0 to 1.
    order : int
        The error of a step is estimated in proportion to ``h^order``.
    """

    nodes: Array
    moments: Array
    impulses: Array
    errors: Array
    thirds: Array
    order: int


class Splitting(NamedTuple):
    """Coefficients of a splitting: of the kicks, one more than of the drifts."""

    kicks: Array
    drifts: Array


class Plan(NamedTuple):
    """Plan of an integration: the scheme, its tolerances and steps, and the number of beads.

    Parameters
    ----------
    scheme : Pair or Splitting
        The coefficients.
    rtol : float
        The tolerance relative to the scene's scales.
    y, v, energy : float
        Tolerances: the errors of displacement, velocity and work allowed in a step.
    h : float
        First step of an embedded pair, fixed step of a splitting.
    longest : float
        Greatest step of an embedded pair.
    end : float
        Duration.
    deepest : float
        Greatest compression.
    lightest : float
        Least mass.
    size : int
        Number of beads.
    stops : array
        Times at which steps end, the duration the last of them.
    most : float
        Energy of the response at which the loop returns, as the tolerances are those of a smaller
        one.
    """

    scheme: Any
    rtol: float
    y: float
    v: float
    energy: float
    h: float
    longest: float
    end: float
    deepest: float
    lightest: float
    size: int
    stops: Array
    most: float


_COUNTS = ("steps", "tries", "front", "stored", "stop")
_REALS = ("t", "late", "h", "energy", "work", "lost", "response")
_PROGRESS = np.dtype(
    [(name, int) for name in _COUNTS] + [(name, float) for name in _REALS]
)


def records(rows: Any) -> Any:
    """Return an array of records whose fields are attributes, in uncompiled code as well."""
    uncompiled = config.DISABLE_JIT  # type: ignore[attr-defined]
    return rows.view(np.recarray) if uncompiled else rows


def initial_progress(plan: Plan, front: int, energy: float) -> Any:
    """Return the record of an integration at time 0, which `advance` updates.

    Parameters
    ----------
    plan : Plan
        The plan.
    front : int
        Number of the first bead that is still.
    energy : float
        Initial energy of the contacts and of the free beads.

    Returns
    -------
    record
        The record's fields: the time t and its rounding error, late; the next step h; the numbers
        of steps that were made and tried; the first bead ahead of the motion, front; the number of
        stored knots; the number of the next of ``plan.stops``, stop; the initial energy; the
        integral of ``v (F - static force)`` of a driven bead, work; the dissipated energy, lost;
        and the greatest energy on the way, response.
    """
    now = records(np.zeros(1, _PROGRESS))[0]
    now["front"], now["h"], now["energy"] = front, plan.h, energy
    return now
