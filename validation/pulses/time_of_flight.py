"""A pulse measured on its way between two contacts.

Runs are made at two tolerances, whose difference is the error.
"""

from __future__ import annotations

from dataclasses import dataclass

from validation.lattice.simulate import simulate
from validation.pulses.pulse import Measured, derived, measure, speed
from validation.scenes.scene import Scene

METHOD = "SRKN14"


@dataclass(frozen=True)
class Passage:
    """A pulse between two contacts, at a tolerance and at a ten times coarser one.

    speed in sites per time; fwhm of the force, in sites, force and strain at the second contact.
    """

    speed: Measured
    fwhm: Measured
    force: Measured
    strain: Measured
    energy_drift: float
    momentum_drift: float
    evaluations: int


def passage(scene: Scene, rtol: float = 1e-6) -> Passage:
    """Run a scene with two contact sensors and measure the pulse on its way between them."""
    a, b = scene.contact_sensors
    rows = []
    for tolerance in (rtol, 10 * rtol):
        run = simulate(scene, method=METHOD, rtol=tolerance, window=False)
        first, second = (measure(run.time, force) for force in run.contact_force)
        V = speed(first, second, b - a)
        deepest = measure(run.time, run.compression[1]).peak
        rows.append(((V, second.fwhm * V, second.peak, deepest), run))
    (fine, run), (coarse, _) = rows
    measured = (Measured(x, y) for x, y in zip(fine, coarse, strict=True))
    pace, fwhm, force, strain = measured
    return Passage(
        pace, fwhm, force, strain, run.energy_drift, run.momentum_drift or 0.0, run.evaluations
    )


def ratio(measured: Measured, expected: float) -> Measured:
    """measured / expected - 1, with its error."""
    return derived(lambda value: value / expected - 1, measured)
