"""The lattice itself, integrated and measured, to be put beside the theory of `lwa`.

>>> from validation import Scene, measure, simulate
>>> chain = dict(masses=(1,) * 60, stiffnesses=(1,) * 59, k=1.5, duration=60)
>>> run = simulate(Scene(**chain, velocities=(1,), contact_sensors=(20, 40)))
>>> first, second = (measure(run.time, force) for force in run.contact_force)
>>> speed = 20 / (second.arrival - first.arrival)
>>> round(second.fwhm * speed, 4)  # sites under the contact force of a Hertz chain's pulse
1.4119
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from validation.lattice.run import Run
    from validation.lattice.simulate import simulate, simulate_many
    from validation.pulses.pulse import Pulse, measure
    from validation.scenes.scene import Scene, SceneError
    from validation.studies.records import load
    from validation.waves.profile import ExactWave
    from validation.waves.solver import exact_wave

__all__ = [
    "ExactWave",
    "Pulse",
    "Run",
    "Scene",
    "SceneError",
    "exact_wave",
    "load",
    "measure",
    "simulate",
    "simulate_many",
]

_PLACES = {
    "lattice.run": ("Run",),
    "lattice.simulate": ("simulate", "simulate_many"),
    "pulses.pulse": ("Pulse", "measure"),
    "scenes.scene": ("Scene", "SceneError"),
    "studies.records": ("load",),
    "waves.profile": ("ExactWave",),
    "waves.solver": ("exact_wave",),
}
"""Module → what stands here of it."""


def __getattr__(name: str) -> Any:
    """A module is loaded when a name of it is asked for: a command's help wants no SciPy."""
    for module, names in _PLACES.items():
        if name in names:
            return getattr(import_module(f"validation.{module}"), name)
    raise AttributeError(f"module 'validation' has no attribute {name!r}")
