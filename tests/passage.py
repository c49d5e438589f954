"""A pulse measured on its way between two contacts."""

from typing import NamedTuple

from validation.lattice.result import Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import highest_pulse, speed
from validation.scenes.scene import Scene


class Passage(NamedTuple):
    """Speed in sites per time; FWHM of the force in sites, force and strain at the second contact;
    the run."""

    speed: float
    fwhm: float
    force: float
    strain: float
    run: Run


def passage(scene: Scene, rtol: float = 1e-6) -> Passage:
    """Run a scene with two contact sensors."""
    a, b = scene.contact_sensors
    run = simulate(scene, rtol=rtol)
    first, second = (highest_pulse(run.signal("contact", i)) for i in (a, b))
    V = speed(first, second, b - a)
    strain = highest_pulse(run.signal("contact", b, "compression")).peak
    return Passage(V, second.fwhm * V, second.peak, strain, run)
