"""The pulse of a struck dimer chain of masses 1 and ω, as several pages measure it.

Units: the heavy bead's mass, A and D are 1. Bead 0 is struck with velocity 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from lwa import Dimer
from validation import Scene, measure, simulate


@dataclass(frozen=True)
class StruckPulse:
    """The leading pulse between two cells of a struck chain.

    speed : between like contacts, in sites per unit of time.
    force : peak force of a contact at the far cell, the mean of the cell's two contacts.
    width : FWHM of the contact force in sites, the mean of the cell's two contacts.
    decay : loss of ln F per site between the two cells.
    """

    speed: float
    force: float
    width: float
    decay: float


def struck_pulse(k: float, omega: Any, near: int = 40, far: int = 80) -> StruckPulse:
    """Strike a chain and measure its leading pulse at the contacts ``near`` and ``far``."""
    contacts = (near, near + 1, far, far + 1)
    heavy = max(
        float(Fraction(str(omega))), 1.0
    )  # a light bead strikes heavy ones: a slow, weak pulse
    scene = Scene.of_cell(
        Dimer(1, omega, spacing=1),
        far // 2 + 20,
        k,
        velocities=(1.0,),
        contact_sensors=contacts,
        duration=(1.45 * far + 30) * heavy**0.7,
        samples=40 * far,
    )
    run = simulate(scene, rtol=1e-8)
    pulses = [_leading(run.time, force) for force in run.contact_force]
    times = [late.arrival - early.arrival for early, late in zip(pulses, pulses[2:], strict=False)]
    peaks = [np.mean([p.peak for p in pair]) for pair in (pulses[:2], pulses[2:])]
    speed = (far - near) / float(np.mean(times))
    return StruckPulse(
        speed,
        float(peaks[1]),
        speed * float(np.mean([p.fwhm for p in pulses[2:]])),
        float(np.log(peaks[0] / peaks[1])) / (far - near),
    )


def _leading(time: Any, force: Any) -> Any:
    """The first pulse of a record: before the force falls below 40 % of its maximum so far."""
    highest = np.maximum.accumulate(force)
    fallen = (force < 0.4 * highest) & (highest > 0.25 * force.max())
    end = int(np.argmax(fallen)) if fallen.any() else len(force) - 1
    while end + 1 < len(force) and force[end + 1] < force[end]:
        end += 1  # to the bottom of the gap behind the pulse
    return measure(time[: end + 1], force[: end + 1])
