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
WIDTH = 5  # stages that are added up at a time


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


class Chain(NamedTuple):
    """A chain, padded by beads of infinite mass, of which the first is the wall.

    inverse : inverse masses. A, rest, load : stiffnesses, static compressions and static forces of
    the contacts. k : exponent of a power law. generated : True for any other contact law. force,
    slope, energy : addresses of the machine code of F, F′ and ∫ F dδ of another law. pulls : True
    if contacts hold where δ < 0. c, p : of the damping force c δ^p dδ/dt. drive : motion of a first
    bead that is driven; its inverse mass is 0.
    """

    inverse: Array
    A: Array
    c: Array
    rest: Array
    load: Array
    k: float
    generated: bool
    force: int
    slope: int
    energy: int
    pulls: bool
    p: float
    drive: Drive


class Beads(NamedTuple):
    """The state of the beads, and the working memory of a step.

    y, v : displacements and velocities. next_y, next_v : those after the step that is tried.
    force : (stages, padded + 1), force on each bead from behind, less the static force, by stage.
    sums : (6, padded + 1), sums over stages. Row 0: intermediate results. Row 1: impulse of each
        contact in a step. Rows 2 and 3: error estimates of each contact's moment and impulse. Rows
        4 and 5: displacements and velocities at the end of a step of damped contacts.
    contacts : (3, padded + 1), of damped contacts. Row 0: 1 if it is closed, 0 if open. Row 1:
        number of a step's stages in which that is wrong, or nearly so. Row 2: greatest force in a
        step.
    power : (2, stages), power that all contacts dissipate, and power of the drive.
    given : (4,), accelerations of a driven bead at the step's ends; what kinks add to its work, and
        to the work's error.
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    force: Array
    sums: Array
    contacts: Array
    power: Array
    given: Array


class Knots(NamedTuple):
    """The motion of W watched beads at up to C knots, the ends of steps.

    time : (C,), times of the knots. state : (C, W, 3), displacement, velocity and acceleration.
    watched : (W,), increasing numbers of the beads.
    """

    time: Array
    state: Array
    watched: NDArray[np.int_]


class Tableau(NamedTuple):
    """Coefficients of a scheme, either of a splitting or of an embedded pair.

    kicks, drifts : coefficients of a splitting, empty for an embedded pair. nodes, rows, ends :
    arrays of `validation.lattice.schemes.Pair.arrays`, empty for a splitting. lower : order
    of the embedded pair's second solution. points : (2, M), nodes and weights of ∫ u^k f(u) du from
    0 to 1; M is 0 where kinks need no quadrature.
    """

    kicks: Array
    drifts: Array
    nodes: Array
    rows: Array
    ends: Array
    lower: int
    points: Array


class Plan(NamedTuple):
    """Plan of an integration: the scheme, its tolerances and steps, and the number of beads.

    y, v, energy : tolerances, the errors of displacement, velocity and work allowed in a step.
    h : first step of an embedded pair, fixed step of a splitting. longest : greatest step of an
    embedded pair. end : duration. deepest : greatest compression. quickest : greatest stiffness
    divided by the least mass. size : number of beads. stops : times at which steps end, the
    duration the last of them. accelerated : True if a drive, weight or a load accelerates beads
    that nothing touches, so that a contact may close and open again within a step.
    """

    scheme: Any
    y: float
    v: float
    energy: float
    h: float
    longest: float
    end: float
    deepest: float
    quickest: float
    size: int
    stops: Array
    accelerated: bool


_COUNTS = ("steps", "tries", "evaluations", "front", "stored", "stop", "warped", "interval")
_REALS = ("t", "h", "planned", "restart", "energy", "work", "lost", "response")
_PROGRESS = np.dtype([(name, int) for name in _COUNTS] + [(name, float) for name in _REALS])


def initial_progress(plan: Plan, front: int, energy: float) -> Any:
    """Return the record of an integration at time 0, which `advance` updates.

    front : number of the first bead that is still. energy : initial energy of the contacts and of
    the free beads. Fields: t, h : time, next step. planned : step that was tried before it was cut
    short. steps, tries : numbers of steps made and tried. evaluations : sum, over all evaluations
    of the forces, of the number of beads moved. front : first bead ahead of the motion. stored :
    number of stored knots. stop : number of the next of ``plan.stops``. warped : 1 if the next step
    begins where a damped contact closes, otherwise 0. restart : longest step of this kind, by the
    error of the last one. interval : number of the interval of the
    drive's motion. work, lost : ∫ v (F - static force) dt of a driven bead, and dissipated energy.
    response : greatest of the values of ``energy`` on the way.
    """
    rows = np.zeros(1, _PROGRESS)
    # Fields of a plain record are attributes in compiled code alone.
    uncompiled = config.DISABLE_JIT  # type: ignore[attr-defined]
    now = (rows.view(np.recarray) if uncompiled else rows)[0]
    now["front"], now["h"], now["restart"], now["energy"] = front, plan.h, plan.h, energy
    return now
