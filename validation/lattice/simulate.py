"""The equations of motion of a scene (`validation.lattice.equations`), integrated.

One `simulate` stands before two engines. The compiled one (`validation.lattice.engine`), with an
adaptive pair for y'' = f(y) and a symplectic splitting, moves the beads behind the front only.
SciPy's steppers, whose own interpolant gives the samples, are the reference. Tolerances are
relative to the scene's own scales, so that a run does not depend on the units. Either engine keeps
only the sensors' samples.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future
from itertools import islice
from time import perf_counter
from typing import Any

import numpy as np

from lwa.base.exact import shorten
from validation.lattice.cost import RunProgress, silent
from validation.lattice.forced import motion_of
from validation.lattice.run import IntegrationError, Run
from validation.lattice.schemes import SCHEMES
from validation.lattice.signal import RECORDS
from validation.lattice.steppers import METHODS, integrate
from validation.lattice.threads import cores, threads
from validation.scenes.checks import SceneError, between, one_of
from validation.scenes.scene import Scene

__all__ = ["COMPILED", "METHODS", "simulate", "simulate_many", "twice"]

COMPILED = tuple(SCHEMES)
"""The engine's: an adaptive Runge–Kutta–Nyström pair, the default, and a symplectic splitting."""

_BATCH, _SPELL = 8, 0.02  # scenes that a thread is given at a time, at most, and for seconds
_SHORTEST = 8  # beads of a window
_FINITE = (*RECORDS, "displacements", "velocities")


def simulate(
    scene: Scene,
    *,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    method: str = COMPILED[0],
    step: float | None = None,
    window: bool | int = False,
    progress: RunProgress = silent,
) -> Run:
    """Integrate a scene and return what its sensors recorded.

    Parameters
    ----------
    rtol, atol : of the pair ``rtol`` is about the most by which the peak force of a struck
        chain's pulse is off, relatively; a motion that goes on bouncing may be off by some tens of
        it at its end. Of the splitting it is what the peak is off by in the mean. ``atol`` does not
        count. Of SciPy's: local error per step, relative to each component and to the scene's own
        scale of displacement and velocity.
    method : one of `COMPILED` or of `METHODS`. Forces that depend on velocities or on time, of
        damping or a drive, take one of `METHODS`: DOP853 where the default is given.
    step : of a compiled method, the largest, in place of that which ``rtol`` gives.
    window : of a compiled method, the number of beads to follow behind the front of a leading
        pulse, or True for eight widths of the long-wave pulse; the chain must end freely and
        k exceed 1. The run is made with this window and with one twice as long, whose numbers are
        returned; beads further behind are NaN in all arrays. By default the whole chain.
    progress : opens a display, which is called with the share of the run that is done.

    Raises `SceneError` for a tolerance or method that cannot be meant, and for a run that takes
    more steps or memory than `validation.lattice.cost` allows, and `IntegrationError` when the
    integrator fails or the longer window changes the leading pulse by more than some rtol.

    >>> scene = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,))
    >>> simulate(scene).velocities.round(6) + 0.0  # equal masses exchange their velocities
    array([0., 1.])
    >>> simulate(scene, method="DOP853").velocities.round(6) + 0.0
    array([0., 1.])
    """
    if not isinstance(scene, Scene):
        raise SceneError(f"scene is {shorten(scene)}: a Scene is wanted")
    one_of(method, COMPILED + METHODS, "method")
    rtol, atol = between(rtol, "rtol", 1e-13, 1e-2), between(atol, "atol", 1e-13, 1e-2)
    for name, value in (("step", step), ("window", window or None)):
        if method not in COMPILED and value is not None:
            needs = f"it needs one of {', '.join(COMPILED)}"
            raise SceneError(f"{name} is {shorten(value)}: {needs}")
    forced = scene.damping is not None or scene.drive is not None
    if forced and method in COMPILED:
        if method != COMPILED[0] or window or step is not None:
            raise SceneError(
                f"method is {method}: a scene with damping or a drive takes one of "
                f"{', '.join(METHODS)}, without step or window"
            )
        method = METHODS[0]
    with np.errstate(over="ignore", invalid="ignore"):  # told by what comes of it
        motion = motion_of(scene)
        if method in COMPILED:
            from validation.lattice.engine import follow  # start-up: numba takes its time

            run = follow(motion, method, rtol, step, window, progress)
        else:
            run = integrate(motion, method, rtol, atol, progress)
        # of a window NaN is what was not followed, and overflows raise in the engine
        add = np.nansum if run.window else np.sum
        sums = [float(add(getattr(run, name))) for name in _FINITE]
    if not all(map(math.isfinite, (run.energy_drift, *sums))):
        raise IntegrationError("the motion overflows: choose other units")
    return run


def simulate_many(
    scenes: Iterable[Scene], *, workers: int | None = None, **options: Any
) -> Iterator[Run]:
    """The runs of many scenes, in their order, as `simulate` with the same options gives them.

    workers : threads, by default as many as there are cores; compiled methods keep all of them
        busy, as they hold no lock. Scenes are taken as they are needed, some ahead of the run
        that is given.

    Raises what `simulate` raises, in the place of the run.

    >>> chain = dict(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9)
    >>> [run.velocities[1].round(6) for run in
    ...  simulate_many(Scene(**chain, velocities=(v,)) for v in (1, 2))]
    [np.float64(1.0), np.float64(2.0)]
    """
    ahead: deque[Future[_Batch]] = deque()
    waiting, size, count = iter(scenes), 1, cores() if workers is None else workers
    with threads(count) as pool:
        while True:
            while len(ahead) <= 2 * count and (some := list(islice(waiting, size))):
                ahead.append(pool.submit(_batch, some, options))
            if not ahead:
                return
            runs, seconds, error = ahead.popleft().result()
            yield from runs
            if error is not None:
                raise error
            size = math.ceil(min(_BATCH, _SPELL / seconds))


_Batch = tuple[list[Run], float, Exception | None]


def _batch(scenes: list[Scene], options: dict[str, Any]) -> _Batch:
    """The runs before one that fails, the seconds that each took, and why it fails."""
    runs: list[Run] = []
    start = perf_counter()
    try:
        runs.extend(simulate(scene, **options) for scene in scenes)
    except Exception as error:
        return runs, 1.0, error
    return runs, (perf_counter() - start) / len(scenes), None


def twice(scene: Scene, fine: float, coarse: float, **options: Any) -> tuple[Run, Run]:
    """Simulate a scene at two tolerances, for `validation.pulses.pulse.compared`.

    With a window, the coarse run has half of it, so that the difference shows its effect as well.
    """
    run = simulate(scene, rtol=fine, atol=fine, **options)
    if run.window is not None:
        options["window"] = max(_SHORTEST, run.window // 2)
    return run, simulate(scene, rtol=coarse, atol=coarse, **options)
