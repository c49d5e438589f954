"""Simulation of a scene: `simulate`, `simulate_many` on threads, `repeated` at several tolerances.

The compiled engine (`validation.lattice.engine`) has an embedded Runge–Kutta–Nyström (RKN) pair for
``y'' = f(t, y)``, a pair for damped contacts, ``y'' = f(t, y, y')``, both with adaptive steps, and
a symplectic splitting. SciPy's methods (`validation.lattice.steppers`) are the reference.
Tolerances are relative to the scene's scales, so that results do not depend on the units. A run
stores the motion of the beads near its sensors only.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import partial
from itertools import islice
from typing import Any

import numpy as np

from lwa.base.exact import shorten
from validation.lattice import steppers
from validation.lattice.cost import RunProgress, silent
from validation.lattice.equations import motion_of
from validation.lattice.result import Run
from validation.lattice.steppers import METHODS
from validation.lattice.threads import cores, threads
from validation.scenes.checks import SceneError, between, one_of, positive
from validation.scenes.scene import Scene

COMPILED = ("RKN86", "symplectic")
"""The engine's: an adaptive Runge–Kutta–Nyström pair, the default, and a symplectic splitting."""

_PART = 8  # scenes a thread that wait at once; at the end of a part a thread waits for half a run


def simulate(
    scene: Scene,
    *,
    rtol: float = 1e-9,
    method: str = COMPILED[0],
    step: float | None = None,
    progress: RunProgress = silent,
) -> Run:
    """Integrate a scene and return the records of its sensors.

    Parameters
    ----------
    scene : Scene
        The chain, its initial state and its sensors.
    rtol : float
        Error in units of the scene's own scales. With the default method the peak force of a struck
        chain's pulse errs by about ``rtol`` at most, and a motion with many collisions, at its end,
        by some tens of ``rtol``; the force at a wall 1e5 times as stiff as the chain errs by less
        than 10 times ``rtol``. With the splitting the peak errs by at most 10 times ``rtol`` for
        exponents from 1.1 to 5, and by at most 200 times for those from 1 to 20. For SciPy's
        methods ``rtol`` bounds the local error of a step.
    method : str
        One of `COMPILED` or of `validation.lattice.steppers.METHODS`. A scene with damping or a
        drive takes all but the splitting; with damping, where forces depend on velocities, the
        default takes the coefficients of another pair.
    step : float, optional
        Greatest step, the splitting's step; by default ``rtol`` determines the steps.
    progress : RunProgress
        Function that opens a display, which a compiled method calls with the finished fraction of
        the run.

    Returns
    -------
    Run

    Raises
    ------
    SceneError
        For invalid arguments and for too many steps or too much memory
        (`validation.lattice.cost`).
    IntegrationError
        When the integrator fails.

    Examples
    --------
    >>> scene = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,))
    >>> simulate(scene).velocities.round(6) + 0.0  # equal masses exchange their velocities
    array([0., 1.])
    >>> simulate(scene, method="DOP853").velocities.round(6) + 0.0
    array([0., 1.])
    """
    if not isinstance(scene, Scene):
        raise SceneError(f"scene is {shorten(scene)}: a Scene is wanted")
    one_of(method, COMPILED + METHODS, "method")
    if method == "symplectic" and (scene.damping or scene.drive):
        others = ", ".join((COMPILED[0], *METHODS))
        raise SceneError(
            f"method is {method}: a scene with damping or a drive takes one of {others}"
        )
    rtol = between(rtol, "rtol", 1e-13, 1e-2)
    longest = math.inf if step is None else positive(step, "step")
    # Values beyond floats are refused by name: no warnings of NumPy besides.
    with np.errstate(over="ignore", invalid="ignore"):
        motion = motion_of(scene)
        if method in METHODS:
            return steppers.integrate(motion, method, rtol, longest)
        from validation.lattice import engine  # start-up: numba takes its time

        return engine.integrate(motion, method, rtol, longest, progress)


def simulate_many(
    scenes: Iterable[Scene], *, workers: int | None = None, **options: Any
) -> Iterator[Run]:
    """Simulate many scenes on threads; yields the runs in the order of the scenes.

    Parameters
    ----------
    scenes : iterable of Scene
        Scenes, of which some are taken at a time.
    workers : int, optional
        Number of threads, by default one for each core; compiled methods run in parallel.
    **options
        Options of `simulate`.

    Yields
    ------
    Run
        The error of a run that fails is raised when the run would be yielded.

    Examples
    --------
    >>> from dataclasses import replace
    >>> chain = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9)
    >>> [run.velocities[1].round(6) for run in
    ...  simulate_many(replace(chain, velocities=(v,)) for v in (1, 2))]
    [np.float64(1.0), np.float64(2.0)]
    """
    if not isinstance(scenes, Iterable):
        raise SceneError(f"scenes is {shorten(scenes)}: several scenes are wanted")
    waiting = iter(scenes)
    count = cores() if workers is None else workers
    with threads(count) as pool:
        # A part at a time: runs that nobody has looked at yet take memory.
        while part := [*islice(waiting, _PART * count)]:
            yield from pool.map(partial(simulate, **options), part)


def repeated(
    scene: Scene, tolerances: Iterable[float], **options: Any
) -> tuple[Run, ...]:
    """Simulate a scene at several tolerances; return the runs in their order.

    `validation.pulses.pulse.compared` turns differences of runs into errors.

    Parameters
    ----------
    scene : Scene
        The scene.
    tolerances : iterable of float
        Tolerances.
    **options
        Options of `simulate`.
    """
    return tuple(simulate(scene, rtol=rtol, **options) for rtol in tolerances)
