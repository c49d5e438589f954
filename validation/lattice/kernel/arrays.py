"""Arrays and numbers of the compiled loops."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array

MARGIN = 4  # still beads that are moved ahead of the front
SHORTEST = 32  # beads below which the vector loops take no less time
BLOCK = 8  # the number of moved beads is a multiple of it: doubles of the widest vector register
WIDTH = 5  # stages that are added up at a time


class Chain(NamedTuple):
    """A chain, padded by beads of infinite mass, of which the first is the wall.

    inverse : inverse masses. A, rest, load : stiffnesses, static compressions and static forces of
    the contacts. k : exponent of a power law. generated : whether the law is none, but given by
    force, slope, energy : addresses of its functions. pulls : whether contacts hold where δ < 0.
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
    """The state of the beads, and the room for a step.

    y, v : displacements and velocities. next_y, next_v : those after the step that is tried.
    left : times at which a window has left the beads behind; infinite for those it follows.
    force : (stages, padded + 1), force on each bead from behind, less its static force, by stage.
    sums : (4, padded + 1), sums of stages: one for all purposes, then the impulses of a step and
        the errors of displacement and velocity that they bring.
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    left: Array
    force: Array
    sums: Array


class Knots(NamedTuple):
    """The motion of the watched beads at the ends of steps.

    time : (C,). watched : (W,), numbers of the beads, increasing. state : (C, W, 3), displacement,
    velocity and acceleration; NaN for a bead that a window has left behind.
    """

    time: Array
    watched: NDArray[np.int_]
    state: Array


class Tableau(NamedTuple):
    """Coefficients of a scheme.

    kicks, drifts : of a splitting. nodes, rows, ends, lower : of a pair; `lower` is the order of
    its second solution. points : nodes and weights of ∫ u^k q(u) du from 0 to 1.
    """

    kicks: Array
    drifts: Array
    nodes: Array
    rows: Array
    ends: Array
    lower: int
    points: Array


class Plan(NamedTuple):
    """A scheme, its steps, and the beads that it moves.

    y, v : errors of displacement and velocity that a step may make. h : the first step. longest :
    the longest step of a pair. end : the duration. deepest : the greatest compression. quickest :
    greatest stiffness over least mass. size : number of beads. window : number of beads that are
    followed behind the front; 0 for the whole chain.
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
    window: int


_COUNTS = ("steps", "tries", "evaluations", "front", "lo", "kept")
_REALS = ("t", "h", "lost", "impulse")
_PROGRESS = np.dtype([(name, int) for name in _COUNTS] + [(name, float) for name in _REALS])


def beginning(plan: Plan, front: int) -> Any:
    """The progress of an integration at its start: a record that `advance` changes.

    steps, tries : their numbers. evaluations : of the forces, times the beads that each one moves.
    front : the first bead that is still. lo : the first bead that is followed. kept : number of
    knots. t, h : the time and the next step. lost : elastic energy of contacts that a window cut.
    impulse : ∫ F dt of the first contact by a pair, less its static force.
    """
    at = np.zeros(1, _PROGRESS)[0]
    at["front"], at["h"] = front, plan.h
    return at
