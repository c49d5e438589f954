"""Numerical validation: chains of beads, simulated and measured beside the theory of `lwa`.

>>> from validation import Scene, measure, simulate
>>> chain = Scene(masses=(1,) * 60, stiffnesses=(1,) * 59, k="3/2", duration=60,
...               velocities=(1,), contact_sensors=(20, 40))
>>> run = simulate(chain)
>>> first, second = (measure(run.signal("contact", i)) for i in (20, 40))
>>> speed = 20 / (second.arrival - first.arrival)
>>> round(second.fwhm * speed, 4)  # sites under the contact force of a Hertz chain's pulse
1.4119
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from validation.lattice.cost import IntegrationError as IntegrationError
    from validation.lattice.result import Run as Run
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
    from validation.waves.profile import ExactWave as ExactWave
    from validation.waves.solver import exact_wave as exact_wave

    __version__: str

# Public names by their module, each loaded on its first use (PEP 562).
_HOMES = {
    "validation.lattice.cost": "IntegrationError",
    "validation.lattice.result": "Run",
    "validation.lattice.simulate": "simulate simulate_many",
    "validation.pulses.pulse": "MeasureError Pulse measure",
    "validation.scenes.forcing": "Damping Drive",
    "validation.scenes.scene": "Scene SceneError",
    "validation.scenes.scenefile": "read_scene",
    "validation.waves.profile": "ExactWave",
    "validation.waves.solver": "exact_wave",
}
_HOME = {name: module for module, names in _HOMES.items() for name in names.split()}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    """Load a public name on its first use."""
    if name == "__version__":
        return import_module("lwa").__version__
    if name not in _HOME:
        raise AttributeError(f"module 'validation' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    """Names that editors and shells complete, loaded or not."""
    return sorted({*globals(), *__all__})
