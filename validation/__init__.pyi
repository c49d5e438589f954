"""Public names of `validation` and their modules: for type checkers, and for the package itself."""

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

__all__: list[str]
__version__: str
