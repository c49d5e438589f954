"""Records that the compiled loops share: chain, beads, knots, tableau, plan and progress."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import config
from numpy.typing import NDArray

from lwa.base.arrays import Array

MARGIN = 4  # still beads that are moved ahead of the front
SHORTEST = 32  # beads below which the vector loops take no less time
BLOCK = 8  # doubles in the widest vector register; the number of moved beads is a multiple of BLOCK
# Beads whose memory stays in the processor's cache throughout a step. Measured for 20,000 beads:
# 128 and 256 take the same time, 512 a tenth more, 1,024 a fifth more.
TILE = 256
WIDTH = 9  # stages of both embedded pairs


class Drive(NamedTuple):
    """Motion of the first bead: y(t) = c0 + c1 s + c2 s² + c3 s³ + amplitude r(t) sin(wt).

    times : beginnings of intervals; s is the time since the last of them. cubics : (intervals, 4),
    coefficients c. amplitude, w : of the oscillation. ramp : time within which r grows from 0 to 1;
    0 for r = 1. driven : False if the first bead is as free as the others.
    """

    times: Array
    cubics: Array
    amplitude: float
    w: float
    ramp: float
    driven: bool


class Law(NamedTuple):
    """The law that all contacts share, for unit stiffness: F(δ) + r [δ]_+^p dδ/dt.

    k : exponent of a power law F = [δ]_+^k. p : exponent of the damping. q : the force is smooth in
    u if δ = u^q. generated : True for any other law. force, slope, energy : addresses of the
    machine code of F, F′ and ∫ F dδ of another law. pulls : True if contacts hold where δ < 0.
    """

    k: float
    p: float
    q: float
    generated: bool
    force: int
    slope: int
    energy: int
    pulls: bool


class Chain(NamedTuple):
    """A chain, padded by beads of infinite mass, of which the first is the wall.

    inverse : inverse masses. A, r, rest, load : stiffnesses, damping coefficients over stiffnesses,
    static compressions and static forces of the contacts. damped : True with damping. law : law of
    all contacts. drive : motion of a first bead that is driven; its inverse mass is 0.
    """

    inverse: Array
    A: Array
    r: Array
    rest: Array
    load: Array
    damped: bool
    law: Law
    drive: Drive


class Beads(NamedTuple):
    """The state of the beads, and the working memory of a step.

    y, v : displacements and velocities. next_y, next_v : those after the step that is tried.
    force : (stages, padded + 1), force on each bead from behind, less the static force, by stage.
    sums : (5, padded + 1), sums over stages. Row 0: moments, then 1 for each contact with a kink.
        Row 1: impulse of each contact in a step. Rows 2 and 3: error estimates of each contact's
        moment and impulse. Row 4: 1 for each contact that closes at the step's end.
    power : (2, stages), power that all contacts dissipate, and power of the drive.
    given : (2,), accelerations of a driven bead at the step's ends.
    corrections : (4,), at kinks, of the heat and its error, and of the drive's work and its error.
    points : (8, `POINTS`), places of a quadrature, their weights and the forces there, a free row,
        and the intervals of a contact (`validation.lattice.kernel.kinks.find_intervals`).
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    force: Array
    sums: Array
    power: Array
    given: Array
    corrections: Array
    points: Array


class Knots(NamedTuple):
    """The motion of W watched beads at up to C knots, the ends of steps.

    time : (C,), times of the knots. state : (C, W, 4), displacement, velocity, acceleration, and 1
    if the step to the knot was corrected for a kink of the contact ahead of the bead; otherwise 0.
    watched : (W,), increasing numbers of the beads.
    """

    time: Array
    state: Array
    watched: NDArray[np.int_]


class Pair(NamedTuple):
    """Coefficients of an embedded pair in Nyström form; the last stage is the step's end.

    Stage s moves a bead by h c_s v + h² Σ_j moments[s, j] f_j, and changes its velocity by
    h Σ_j impulses[s, j] f_j.

    nodes : (WIDTH,), c. moments, impulses : (WIDTH, WIDTH); of `impulses` only the last row counts
    if forces do not depend on velocities. errors : (2, WIDTH), differences of the two solutions, in
    displacement and velocity. thirds : (WIDTH,), weights of ∫ (1 - x)²/2 f(x) dx. lower : order of
    the second solution.
    """

    nodes: Array
    moments: Array
    impulses: Array
    errors: Array
    thirds: Array
    lower: int


class Splitting(NamedTuple):
    """Coefficients of a splitting: of the kicks, one more than of the drifts."""

    kicks: Array
    drifts: Array


class Plan(NamedTuple):
    """Plan of an integration: the scheme, its tolerances and steps, and the number of beads.

    y, v, energy : tolerances, the errors of displacement, velocity and work allowed in a step.
    h : first step of an embedded pair, fixed step of a splitting. longest : greatest step of an
    embedded pair. end : duration. deepest : greatest compression. lightest : least mass. size :
    number of beads. stops : times at which steps end, the duration the last of them. jumps :
    True if forces jump where contacts close, as damping forces c dδ/dt do.
    """

    scheme: Any
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
    jumps: bool


_COUNTS = ("steps", "tries", "front", "stored", "stop")
_REALS = ("t", "h", "planned", "energy", "work", "lost", "response")
_PROGRESS = np.dtype(
    [(name, int) for name in _COUNTS] + [(name, float) for name in _REALS]
)


def initial_progress(plan: Plan, front: int, energy: float) -> Any:
    """Return the record of an integration at time 0, which `advance` updates.

    front : number of the first bead that is still. energy : initial energy of the contacts and of
    the free beads. Fields: t, h : time, next step. planned : step that was tried before it was
    cut short. steps, tries : numbers of steps made and tried. front : first bead ahead of the
    motion. stored : number of stored knots. stop : number of the next of ``plan.stops``. work,
    lost : ∫ v (F - static force) dt of a driven bead, and dissipated energy. response :
    greatest of the values of ``energy`` on the way.
    """
    rows = np.zeros(1, _PROGRESS)
    # Fields of a plain record are attributes in compiled code alone.
    uncompiled = config.DISABLE_JIT  # type: ignore[attr-defined]
    now = (rows.view(np.recarray) if uncompiled else rows)[0]
    now["front"], now["h"], now["energy"] = front, plan.h, energy
    return now
