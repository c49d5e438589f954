"""What a run takes, known before it starts: its steps, its time and its memory.

A scene's own time is the shortest √(m/spring) of a bead between its contacts at their deepest
(`validation.lattice.equations.Scales.time`). A compiled method takes equal steps in proportion to
it. SciPy's choose theirs; counted on uniform chains, dimers and pressed beads, k = 1 … 3, they are
a rtol^{-1/q} in a time, at most 3 times as many, and an eighth where beads part.

What takes longer than `LONGEST`, or more memory than `LARGEST`, is refused. Times tell minutes
from hours, and no more: they are those of one machine.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace

from lwa.duration import words
from validation.lattice.schemes import LAWS, SCHEMES
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene

LONGEST = 6 * 3600.0
"""Seconds of a run that is not refused."""
LARGEST = 4e9
"""Bytes of a run that is not refused."""
EXCESS = 10
"""Times as many steps as are expected, beyond which an adaptive method is stopped."""

_SPLITTING = {2: (0.5, 0.5), 4: (0.01, 0.4), 6: (0.01, 0.4)}
"""By order: c, q of (rtol/c)^q natural times a stage; c of a Hertz dimer of 560 beads."""
_COARSEST = 0.2
"""Natural times a stage: all splittings are stable."""
_ADAPTIVE = {"DOP853": (0.3, 8, 14), "RK45": (0.2, 5, 6), "RK23": (0.2, 3, 3), "LSODA": (1.5, 8, 2)}
"""(a, q, evaluations a step)."""
_FEWEST = 100
"""Steps that an adaptive method takes to find its step, however slow the motion."""

_SAMPLE = 2e-6
"""Seconds to measure, draw and write a sample."""


@dataclass(frozen=True)
class Effort:
    """What a run takes: ``steps`` of a ``method`` that move ``beads`` each, ``memory`` in bytes.

    instead : what another method takes, if it is less.
    """

    scene: Scene
    method: str
    steps: float
    beads: int
    seconds: float
    memory: float
    instead: str = ""

    @property
    def time(self) -> str:
        """The seconds, in round words.

        >>> Effort(Scene(masses=(1,), stiffnesses=(), k=1, duration=1), "S6", 1, 1, 7.2e3, 0).time
        'about 2 hours'
        """
        return words(self.seconds)

    def __str__(self) -> str:
        listening = _listening(self.scene)
        samples = f", {listening * self.scene.samples:.1e} samples" if listening else ""
        return f"{self.steps:.1e} steps of {self.method} with {self.beads} beads{samples}"

    def check(self) -> None:
        """Raise `SceneError` for a run that is beyond `LONGEST` or `LARGEST`."""
        if self.memory > LARGEST:
            scene = self.scene
            raise SceneError(
                f"samples is {scene.samples:g}: with {_listening(scene)} sensors and {scene.size} "
                f"beads {self.method} takes {self.memory / 1e9:.2g} GB; {LARGEST / 1e9:g} GB are "
                "the most"
            )
        if self.seconds > LONGEST:
            raise SceneError(
                f"duration is {self.scene.duration:g}: this makes {self.steps:.1e} steps of "
                f"{self.method}, {self.time}; {LONGEST / 3600:g} hours are the most{self.instead}"
            )


RunProgress = Callable[[Effort], AbstractContextManager[Callable[[float], object]]]
"""Is shown the effort of a run before it starts; what it gives is told the share that is done."""


def silent(effort: Effort) -> AbstractContextManager[Callable[[float], object]]:
    """The `RunProgress` that shows none."""
    return nullcontext(lambda share: None)


def step(method: str, rtol: float) -> float:
    """Natural times a step of a method, in the mean if it is SciPy's.

    >>> step("Verlet", 1e-2), step("SRKN14", 1e-2)
    (0.1414213562373095, 2.8000000000000003)
    """
    if method in SCHEMES:
        scheme = SCHEMES[method]
        c, q = _SPLITTING[scheme.order]
        return float(min((rtol / c) ** q, _COARSEST)) * scheme.stages
    a, order, _ = _ADAPTIVE[method]
    return float(rtol ** (1 / order)) / a


def compiled(scene: Scene, method: str, steps: float, beads: int) -> Effort:
    """The effort of a splitting."""
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
    found = _effort(scene, method, steps, n, seconds, 4, jacobian)
    other = next(iter(SCHEMES))
    less = compiled(scene, other, scene.duration / time / step(other, rtol), n)
    return (
        replace(found, instead=f"; {other} takes {less.time}") if less.seconds < LONGEST else found
    )


def _listening(scene: Scene) -> int:
    return len(scene.contact_sensors) + len(scene.bead_sensors)


def _effort(
    scene: Scene, method: str, steps: float, beads: int, seconds: float, rows: int, memory: int = 0
) -> Effort:
    """Of the integration, and of the samples: ``rows`` a sensor, and what reads and writes them."""
    numbers = 80 * scene.size + scene.samples * (rows * _listening(scene) + 20)
    seconds += _SAMPLE * scene.samples * _listening(scene)
    return Effort(scene, method, steps, beads, seconds, 8.0 * numbers + memory)
