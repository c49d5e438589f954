"""Measurement of the pulse of a struck dimer chain of masses 1 and ω.

Units: the heavy bead's mass, A and D are 1. Bead 0 is struck with velocity 1. The pulse is read by
`validation.pulses.steady`: the speed belongs to the force at the place of the width, although both
fall along the chain.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from validation.pulses.steady import StruckDimer


@dataclass(frozen=True)
class StruckPulse:
    """The leading pulse at the far end of a stretch of a struck chain.

    speed : at the far end, in sites per unit of time.
    force : peak force of a contact at the far end, the mean of the cell's two contacts.
    width : FWHM of the contact force in sites, the mean of the cell's two contacts.
    decay : loss of ln F per site along the stretch.
    """

    speed: float
    force: float
    width: float
    decay: float


def struck_pulse(k: float, omega: Any, near: int = 40, far: int = 80) -> StruckPulse:
    """Strike a chain and measure its leading pulse between the contacts ``near`` and ``far``."""
    chain = StruckDimer(float(k), float(Fraction(str(omega))), far - near)
    passages = chain.passages(chain.run((near, far), chain.crossing(far), 1e-8))
    numbers = chain.numbers(passages)
    peaks = passages["peak"][-1]  # of the cell's two contacts at the far end
    q = (chain.k - 1) / (2 * chain.k)  # the speed is proportional to F^q
    return StruckPulse(
        speed=float(np.mean(numbers["speed"] * peaks**q)),
        force=float(np.mean(peaks)),
        width=float(numbers["width"][0]),
        decay=float(numbers["decay"][0]),
    )
