"""Sensors that lose their charge, as piezoelectric ones do.

Behind such a sensor and its amplifier a force f gives a signal v with ``v' = f' - v/T``, T the time
constant. So ``f = v + ∫ v dt/T``, and v swings below its base behind a pulse.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import cumulative_trapezoid

from lwa.base.arrays import Array
from validation.pulses.noisy import NoisyPulse, in_unit

_EARLY = 5  # samples at the start of a record whose mean is about its base
_BEHIND = (
    1.5,
    2.5,
    3.5,
)  # widths behind the arrival: ends of two stretches that are looked at
_SURE = 4.0  # mean of a stretch below the base, in its standard deviations, at least
_LEAST = 0.002  # likewise over the peak
_ALIKE = 1.5  # ratio of the constants that two stretches tell, at most


def corrected(t: Array, signal: Array, constant: float) -> Array:
    """Return the force behind the signal of a sensor with a time constant.

    An error of the base makes a slope, which the base of a pulse takes out.
    """
    swing = signal - signal[:_EARLY].mean()
    return np.asarray(signal + cumulative_trapezoid(swing, t, initial=0) / constant)


def suggested(t: Array, signal: Array, pulse: NoisyPulse, unit: str) -> str:
    """Return a line on an undershoot behind a pulse, with the time constant; "" without any.

    Waves behind a pulse rarely swing alike in both stretches. unit : of the times.
    """
    arrival = pulse.numbers["arrival"].value
    width = pulse.numbers["fwhm"].value
    swing = signal - pulse.base
    charge = cumulative_trapezoid(swing, t, initial=0)
    constants = []
    for start, end in pairwise(_BEHIND):
        inside = (t > arrival + start * width) & (t < arrival + end * width)
        below = -swing[inside]
        if len(below) < _EARLY:
            return ""
        error = pulse.noise / math.sqrt(len(below))
        if not 0 < _SURE * error < below.mean() > _LEAST * swing.max():
            return ""
        constants.append(float(charge[inside].mean() / below.mean()))
    near, far = constants
    if not 1 / _ALIKE < near / far < _ALIKE:
        return ""
    return (
        "the signal falls below its base behind the pulse, as that of a sensor that loses its "
        f"charge: --time-constant '{in_unit(near, unit)}' corrects it"
    )
