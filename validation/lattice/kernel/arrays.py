"""Records that the compiled loops share: chain, beads, knots, tableau, plan and progress."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array

MARGIN = 4  # still beads that are moved ahead of the front
SHORTEST = 32  # beads below which the vector loops take no less time
BLOCK = 8  # doubles in the widest vector register; the number of moved beads is a multiple of BLOCK
WIDTH = 5  # stages that are added up at a time


class Chain(NamedTuple):
    """A chain, padded by beads of infinite mass, of which the first is the wall.

    inverse : inverse masses. A, rest, load : stiffnesses, static compressions and static forces of
    the contacts. k : exponent of a power law. generated : True for any other contact law. force,
    slope, energy : addresses of the machine code of F, F′ and ∫ F dδ of another law. pulls : True
    if contacts hold where δ < 0.
    """

    inverse: Array
    A: Array
    rest: Array
    load: Array
    k: float
    generated: bool
    force: int
    slope: int
    energy: int
    pulls: bool


class Beads(NamedTuple):
    """The state of the beads, and the working memory of a step.

    y, v : displacements and velocities. next_y, next_v : those after the step that is tried.
    force : (stages, padded + 1), force on each bead from behind, less the static force, by stage.
    sums : (4, padded + 1), sums over stages. Row 0: intermediate results. Row 1: impulse of each
        contact in a step. Rows 2 and 3: error estimates of each contact's moment and impulse.
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    force: Array
    sums: Array


class Knots(NamedTuple):
    """The motion of W watched beads at up to C knots, the ends of steps.

    time : (C,), times of the knots. watched : (W,), increasing numbers of the beads. state :
    (C, W, 3), displacement, velocity and acceleration.
    """

    time: Array
    watched: NDArray[np.int_]
    state: Array


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

    y, v : tolerances, the errors of displacement and velocity allowed in a step. h : first step of
    an embedded pair, fixed step of a splitting. longest : greatest step of an embedded pair. end :
    duration. deepest : greatest compression. quickest : greatest stiffness divided by the least
    mass. size : number of beads.
    """

    scheme: Tableau
    y: float
    v: float
    h: float
    longest: float
    end: float
    deepest: float
    quickest: float
    size: int


_COUNTS = ("steps", "tries", "evaluations", "front", "stored")
_REALS = ("t", "h", "impulse")
_PROGRESS = np.dtype([(name, int) for name in _COUNTS] + [(name, float) for name in _REALS])


def initial_progress(plan: Plan, front: int) -> Any:
    """Return the record of an integration at time 0, which `advance` updates.

    front : number of the first bead that is still. Fields: t, h : time, next step. steps, tries :
    numbers of steps made and tried. evaluations : sum, over all evaluations of the forces, of the
    number of beads moved. front : first bead ahead of the motion. stored : number of stored knots.
    impulse : ∫ (F - static force) dt of the first contact, computed by an embedded pair only.
    """
    now = np.zeros(1, _PROGRESS)[0]
    now["front"], now["h"] = front, plan.h
    return now
