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
    from validation.lattice.run import IntegrationError as IntegrationError
    from validation.lattice.run import Run as Run
    from validation.lattice.simulate import simulate as simulate
    from validation.lattice.simulate import simulate_many as simulate_many
    from validation.pulses.pulse import MeasureError as MeasureError
    from validation.pulses.pulse import Pulse as Pulse
    from validation.pulses.pulse import measure as measure
    from validation.scenes.forcing import Damping as Damping
    from validation.scenes.forcing import Drive as Drive
    from validation.scenes.scene import Scene as Scene
    from validation.scenes.scene import SceneError as SceneError
    from validation.scenes.scenefile import read_scene as read_scene
    from validation.studies.run import load as load
    from validation.waves.profile import ExactWave as ExactWave
    from validation.waves.solver import exact_wave as exact_wave

_MODULES = {
    "lattice.run": "IntegrationError Run",
    "lattice.simulate": "simulate simulate_many",
    "pulses.pulse": "MeasureError Pulse measure",
    "scenes.forcing": "Damping Drive",
    "scenes.scene": "Scene SceneError",
    "scenes.scenefile": "read_scene",
    "studies.run": "load",
    "waves.profile": "ExactWave",
    "waves.solver": "exact_wave",
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names.split()}
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    """Load a public name on its first use: `--help` does not load SciPy."""
    if name not in _HOMES:
        raise AttributeError(f"module 'validation' has no attribute {name!r}")
    return getattr(import_module(f"validation.{_HOMES[name]}"), name)
