"""Limits on the steps and the memory of a run, checked before it starts."""

from __future__ import annotations

from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene

MOST_STEPS = 1e9
MOST_BYTES = 4e9
EXCESS = 10  # times as many steps as are expected, at which an adaptive method is stopped

# (a, q): about a rtol^{-1/q} steps in a scene's shortest time √(m/spring), counted on uniform
# chains, dimers and pressed beads, k = 1 … 3; at most 3 times as many.
_STEPS = dict(RKN86=(0.25, 7), DOP853=(0.3, 8), RK45=(0.2, 5), RK23=(0.2, 3), LSODA=(1.5, 8))
_FEWEST = 100  # steps that an adaptive method takes to find its step, however slow the motion


def mean_step(method: str, rtol: float) -> float:
    """Return the expected mean step of an adaptive method, in units of a scene's shortest time."""
    a, order = _STEPS[method]
    return float(rtol ** (1 / order)) / a


def most_steps(scene: Scene, method: str, steps: float, rows: int, memory: int = 0) -> int:
    """Return the number of steps at which a run is stopped.

    steps : expected number of steps. rows : numbers stored for each sensor and sample. memory :
    further bytes. Raises `SceneError` for more than `MOST_STEPS` steps or `MOST_BYTES` bytes.
    """
    sensors = len(scene.contact_sensors) + len(scene.bead_sensors)
    memory += 8 * (80 * scene.size + scene.samples * (rows * sensors + 20))
    if memory > MOST_BYTES:
        raise SceneError(
            f"samples is {scene.samples:g}: with {sensors} sensors and {scene.size} beads {method} "
            f"takes {memory / 1e9:.2g} GB; {MOST_BYTES / 1e9:g} GB are the most"
        )
    if steps > MOST_STEPS:
        raise SceneError(
            f"duration is {scene.duration:g}: this makes {steps:.1e} steps of {method}; "
            f"{MOST_STEPS:g} are the most"
        )
    return EXCESS * (_FEWEST + int(steps))


def beyond(method: str, steps: int, t: float, duration: float) -> str:
    """Return the message of the error for too many steps."""
    return (
        f"{steps} steps of {method} reach t = {t:g} of {duration:g}: rounding hides the motion, "
        "or rtol is too small for it"
    )
