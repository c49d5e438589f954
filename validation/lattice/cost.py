"""Limits on the steps and the memory of an integration, and the display of its progress."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

from validation.scenes.checks import Failure, SceneError
from validation.scenes.scene import Scene

# The fastest steps, those of the splitting at k = 3/2, take 0.2 µs for 2 beads and 6 µs for 1,000
# that all move (measured): so many take four minutes and an hour and three quarters. A usual
# machine has more memory than this.
MOST_STEPS = 1e9
MOST_BYTES = 4e9
# Most steps of an adaptive method in the scene's shortest time √(m/spring). RKN86 takes about
# rtol^(-1/7)/4, which is 18 at the smallest tolerance; RK23, of the lowest order, 200 at 1e-9.
_DENSEST = 1000
_DOUBLE = 8  # bytes of a number
# Numbers of a bead, a bound: the engine's 27 rows of state and stages and 8 of the chain, those of
# the equations, and NumPy's copies. Numbers of a sample without sensors: times, steps and copies.
_PER_BEAD, _PER_SAMPLE = 80, 20


class IntegrationError(Failure):
    """Failure of an integrator; the message says where and why."""


RunProgress = Callable[[], AbstractContextManager[Callable[[float], object]]]
"""Opens a display of a run's progress, which is called with the share that is done."""


def silent() -> AbstractContextManager[Callable[[float], object]]:
    """Return a `RunProgress` without a display."""
    return nullcontext(lambda share: None)


def step_limit(scene: Scene, method: str, steps: float) -> int:
    """Return the number of steps at which a run is stopped.

    Parameters
    ----------
    scene : Scene
        The scene.
    method : str
        Name of the method, for the message.
    steps : float
        Number of steps of a splitting; for an adaptive method the duration divided by the scene's
        shortest time, or by the greatest step if this is shorter.

    Raises
    ------
    SceneError
        For more than `MOST_STEPS`.
    """
    if steps > MOST_STEPS:
        raise SceneError(
            f"duration is {scene.duration:g}: this makes some {steps:.0e} steps of {method}; "
            f"{MOST_STEPS:g} are the most"
        )
    return _DENSEST * (1 + int(steps))


def check_memory(scene: Scene, method: str, rows: int, more: float = 0) -> None:
    """Raise `SceneError` for a run that needs more than `MOST_BYTES` bytes.

    Parameters
    ----------
    scene : Scene
        The scene.
    method : str
        Name of the method, for the message.
    rows : int
        Numbers that the method holds at a time for each sensor and sample.
    more : float
        Further bytes of the method.
    """
    sensors = len(scene.contact_sensors) + len(scene.bead_sensors)
    samples = scene.samples * (rows * sensors + _PER_SAMPLE)
    memory = more + _DOUBLE * (_PER_BEAD * scene.size + samples)
    if memory > MOST_BYTES:
        raise SceneError(
            f"samples is {scene.samples:g}: with {sensors} sensors and {scene.size} beads {method} "
            f"takes {memory / 1e9:.2g} GB; {MOST_BYTES / 1e9:g} GB are the most"
        )
