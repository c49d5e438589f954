"""What a run takes, known before it starts: its steps, its time and its memory.

A scene's own time is the shortest √(m/spring) of a bead between its contacts at their deepest
(`validation.lattice.equations.Scales.time`). The splitting takes equal steps in proportion to it.
All others choose theirs; counted on uniform chains, dimers and pressed beads, k = 1 … 3, they are
a rtol^{-1/q} in a time, at most 3 times as many, and an eighth where beads part.

What takes longer than `LONGEST`, or more memory than `LARGEST`, is refused. Times tell minutes
from hours, and no more: they are those of one machine.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace

from lwa.base.progress import words
from validation.lattice.schemes import LAWS, SCHEMES
from validation.lattice.schemes.splitting import SRKN14
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene

LONGEST = 6 * 3600.0  # seconds of a run that is not refused
LARGEST = 4e9  # bytes of a run that is not refused
EXCESS = 10  # times as many steps as are expected, beyond which an adaptive method is stopped

_KINKS = 0.01  # (rtol/this)^0.4 natural times a stage of a splitting; of a Hertz dimer of 560 beads
_COARSEST = 0.2  # natural times a stage: the splitting is stable
# (a, q, evaluations a step).
_ADAPTIVE = {
    "RKN86": (0.25, 7, 8), "DOP853": (0.3, 8, 14), "RK45": (0.2, 5, 6), "RK23": (0.2, 3, 3),
    "LSODA": (1.5, 8, 2),
}  # fmt: skip
_FEWEST = 100  # steps that an adaptive method takes to find its step, however slow the motion
_SAMPLE = 2e-6  # seconds to measure, draw and write a sample


@dataclass(frozen=True)
class Effort:
    """What a run takes: ``steps`` of a ``method`` that move ``beads`` each, ``memory`` in bytes;
    ``instead`` says what another method takes, if it is less."""

    scene: Scene
    method: str
    steps: float
    beads: int
    seconds: float
    memory: float
    instead: str = ""

    def __str__(self) -> str:
        listening = _listening(self.scene)
        samples = f", {listening * self.scene.samples:.1e} samples" if listening else ""
        return f"{self.steps:.1e} steps of {self.method} with {self.beads} beads{samples}"

    def check(self) -> None:
        """Raise `SceneError` for a run that is beyond `LONGEST` or `LARGEST`."""
        if self.memory > LARGEST:
            raise SceneError(
                f"samples is {self.scene.samples:g}: with {_listening(self.scene)} sensors and "
                f"{self.scene.size} beads {self.method} takes {self.memory / 1e9:.2g} GB; "
                f"{LARGEST / 1e9:g} GB are the most"
            )
        if self.seconds > LONGEST:
            raise SceneError(
                f"duration is {self.scene.duration:g}: this makes {self.steps:.1e} steps of "
                f"{self.method}, {words(self.seconds)}; {LONGEST / 3600:g} hours are the most"
                f"{self.instead}"
            )


RunProgress = Callable[[Effort], AbstractContextManager[Callable[[float], object]]]
"""Is shown the effort of a run before it starts; what it gives is told the share that is done."""


def silent(effort: Effort) -> AbstractContextManager[Callable[[float], object]]:
    """The `RunProgress` that shows none."""
    return nullcontext(lambda share: None)


def beyond(taken: Effort, steps: int, t: float) -> str:
    """What is told where a method takes too many steps."""
    return (
        f"{steps} steps of {taken.method} reach t = {t:g} where {taken.steps:.0f} are enough for "
        f"all of {taken.scene.duration:g}: rounding hides the motion, or rtol is too small for it"
    )


def step(method: str, rtol: float) -> float:
    """Natural times a step of a method, in the mean if it is adaptive."""
    if method == "SRKN14":
        return float(min((rtol / _KINKS) ** 0.4, _COARSEST)) * SRKN14.stages
    a, order, _ = _ADAPTIVE[method]
    return float(rtol ** (1 / order)) / a


def compiled(scene: Scene, method: str, steps: float, beads: int) -> Effort:
    """The effort of a compiled method."""
    steps += _FEWEST if method in _ADAPTIVE else 0
    bead = 2e-9 if scene.k in LAWS else 9e-9  # a power takes its time
    seconds = steps * (3e-7 + SCHEMES[method].stages * max(beads, 32) * bead)
    return _effort(scene, method, steps, beads, seconds, 16)


def adaptive(scene: Scene, method: str, rtol: float, time: float) -> Effort:
    """The effort of one of SciPy's methods where the scene's shortest time is ``time``."""
    n, evaluations = scene.size, _ADAPTIVE[method][2]
    steps = _FEWEST + scene.duration / time / step(method, rtol)
    seconds = steps * evaluations * (1.3e-5 + 1.2e-7 * n)
    if _listening(scene):
        seconds += 6e-8 * n * scene.samples
    jacobian = (2 * n) ** 2 * 8 if method == "LSODA" else 0
    other = next(iter(SCHEMES))
    less = compiled(scene, other, scene.duration / time / step(other, rtol), n)
    instead = f"; {other} takes {words(less.seconds)}" if less.seconds < LONGEST else ""
    return replace(_effort(scene, method, steps, n, seconds, 4, jacobian), instead=instead)


def _listening(scene: Scene) -> int:
    return len(scene.contact_sensors) + len(scene.bead_sensors)


def _effort(
    scene: Scene, method: str, steps: float, beads: int, seconds: float, rows: int, memory: int = 0
) -> Effort:
    """Of the integration, and of the samples: ``rows`` a sensor, and what reads and writes them."""
    numbers = 80 * scene.size + scene.samples * (rows * _listening(scene) + 20)
    seconds += _SAMPLE * scene.samples * _listening(scene)
    return Effort(scene, method, steps, beads, seconds, 8.0 * numbers + memory)
