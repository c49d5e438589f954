"""A pulse measured on its way between two contacts, at two tolerances that differ by its error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from validation.lattice.result import Run
from validation.lattice.simulate import simulate, twice
from validation.pulses.pulse import Measured, compared, derived, highest_pulse, speed
from validation.scenes.scene import Scene


@dataclass(frozen=True)
class Passage:
    """speed in sites per time; fwhm of the force, in sites, force and strain at the second
    contact; the run's drifts."""

    speed: Measured
    fwhm: Measured
    force: Measured
    strain: Measured
    energy_drift: float
    momentum_drift: float


def passage(scene: Scene, rtol: float = 1e-6) -> Passage:
    """Run a scene with two contact sensors at rtol, and at a ten times coarser one."""
    a, b = scene.contact_sensors

    def numbers(run: Run) -> dict[str, float]:
        first, second = (highest_pulse(run.signal("contact", i)) for i in (a, b))
        deepest = highest_pulse(run.signal("contact", b, "compression")).peak
        V = speed(first, second, b - a)
        return {"speed": V, "fwhm": second.fwhm * V, "force": second.peak, "strain": deepest}

    run, check = twice(scene, rtol, 10 * rtol)
    return Passage(
        **compared(numbers, run, check),
        energy_drift=run.energy_drift,
        momentum_drift=run.momentum_drift or 0.0,
    )


def ratio(measured: Measured, expected: float) -> Measured:
    """measured / expected - 1, with its error."""
    return derived(lambda value: value / expected - 1, measured)


def peaks(
    masses: Sequence[float],
    stiffnesses: Sequence[float],
    k: float,
    sensors: Sequence[int],
    duration: float,
) -> list[float]:
    """Largest forces at contacts of a chain whose first bead has velocity 1."""
    scene = Scene(
        masses=tuple(masses), stiffnesses=tuple(stiffnesses), k=k, duration=duration,
        velocities=(1,), contact_sensors=sensors, samples=20001,
    )  # fmt: skip
    return [force.max() for force in simulate(scene).contact_force]
