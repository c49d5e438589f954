"""Numerical validation: chains of beads, simulated and measured beside the theory of `lwa`.

>>> from validation import Scene, measure, simulate
>>> chain = dict(masses=(1,) * 60, stiffnesses=(1,) * 59, k=1.5, duration=60)
>>> run = simulate(Scene(**chain, velocities=(1,), contact_sensors=(20, 40)))
>>> first, second = (measure(run.signal("contact", i)) for i in (20, 40))
>>> speed = 20 / (second.arrival - first.arrival)
>>> round(second.fwhm * speed, 4)  # sites under the contact force of a Hertz chain's pulse
1.4119
"""

from typing import TYPE_CHECKING

from lwa.base.lazy import public

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

__getattr__, __all__ = public(__name__)
