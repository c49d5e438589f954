"""Numerical validation: chains of beads, simulated and measured beside the theory of `lwa`.

>>> from validation import Scene, measure, simulate
>>> chain = dict(masses=(1,) * 60, stiffnesses=(1,) * 59, k=1.5, duration=60)
>>> run = simulate(Scene(**chain, velocities=(1,), contact_sensors=(20, 40)))
>>> first, second = (measure(run.signal("contact", i)) for i in (20, 40))
>>> speed = 20 / (second.arrival - first.arrival)
>>> round(second.fwhm * speed, 4)  # sites under the contact force of a Hertz chain's pulse
1.4119
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from validation.lattice.run import IntegrationError, Run
    from validation.lattice.simulate import simulate, simulate_many
    from validation.pulses.pulse import MeasureError, Pulse, measure
    from validation.scenes.forcing import Damping, Drive
    from validation.scenes.scene import Scene, SceneError
    from validation.scenes.scenefile import read_scene
    from validation.studies.records import load
    from validation.waves.profile import ExactWave
    from validation.waves.solver import exact_wave

__all__ = [
    "Damping",
    "Drive",
    "ExactWave",
    "IntegrationError",
    "MeasureError",
    "Pulse",
    "Run",
    "Scene",
    "SceneError",
    "exact_wave",
    "load",
    "measure",
    "read_scene",
    "simulate",
    "simulate_many",
]

_PLACES = {
    "lattice.run": ("IntegrationError", "Run"),
    "lattice.simulate": ("simulate", "simulate_many"),
    "pulses.pulse": ("MeasureError", "Pulse", "measure"),
    "scenes.forcing": ("Damping", "Drive"),
    "scenes.scene": ("Scene", "SceneError"),
    "scenes.scenefile": ("read_scene",),
    "studies.records": ("load",),
    "waves.profile": ("ExactWave",),
    "waves.solver": ("exact_wave",),
}
"""Public names by module."""


def __getattr__(name: str) -> Any:
    """Load the module of a public name when the name is used: `--help` does not load SciPy."""
    for module, names in _PLACES.items():
        if name in names:
            return getattr(import_module(f"validation.{module}"), name)
    raise AttributeError(f"module 'validation' has no attribute {name!r}")
