"""The special mass ratios at which a dimer chain has a solitary wave, whatever the exponent k.

Elsewhere the light beads keep oscillating behind the pulse. At these ratios they come to rest with
the heavy ones, after one more half oscillation from each ratio to the next smaller one
(Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606, 2011: 0.3428, 0.1548, 0.0901, … at
k = 3/2). They are the zeros of the strain T that a wave leaves, of `spectral`; Newton's method
solves T = 0 with the equations of motion, m2/m1 being one of the unknowns.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.checked import SceneError, integer
from validation.solitary import SPECIAL_FROM, ExactWave, NoWave, free_wave, parameters, solve


@dataclass(frozen=True, eq=False)
class Resonances:
    """The solitary waves at the largest special ratios m2/m1 < 1, in falling order; m1 = 1."""

    k: float
    waves: tuple[ExactWave, ...]

    @property
    def mass_ratios(self) -> tuple[float, ...]:
        """m2/m1."""
        return tuple(wave.omega for wave in self.waves)


def resonances(k: Any, count: Any) -> Resonances:
    """The first ``count`` special ratios and their waves, for k from 1.2 to 5."""
    waves = special_waves(k, count)
    return Resonances(waves[0].k, waves)


def special_ratios(k: Any, count: Any) -> tuple[float, ...]:
    """The ``count`` largest m2/m1 < 1 at which a dimer has a solitary wave.

    Raises `SceneError` where the roots cannot be told from rounding, and `NoWave` when fewer are
    found.

    >>> [round(ratio, 6) for ratio in special_ratios(1.5, 2)]
    [0.342846, 0.154752]
    """
    return tuple(wave.masses[1] for wave in special_waves(k, count))


def special_waves(k: Any, count: Any) -> tuple[ExactWave, ...]:
    """The solitary waves at `special_ratios`, with m1 = 1.

    Newton's method is begun from the theory's wave at many ratios; √(m1/m2) grows by nearly equal
    steps from one special ratio to the next, so that one missed leaves a step too long. Above k = 2
    the waves are followed from there.
    """
    _, k = parameters([1], k)
    if not SPECIAL_FROM <= k <= 5:
        raise SceneError(f"k is {k:g}: special mass ratios are found for k from 1.2 to 5")
    count = integer(count, "count", 1, 6)
    if k > 2:  # the theory's wave is too far from the first ones there
        waves = special_waves(2, count)
        for between in np.linspace(2, k, math.ceil((k - 2) / 0.1) + 1)[1:]:
            waves = tuple(solve(w.masses, float(between), start=w, free=True) for w in waves)
        ratios = [wave.omega for wave in waves]
        if not all(wave.solitary for wave in waves) or np.any(np.diff(ratios) > -1e-6):
            raise NoWave(f"k = {k:g}: the path from k = 2 leaves its special mass ratios")
        return waves
    found: dict[float, ExactWave] = {}  # by √(m1/m2)
    for fine in (0.1, 0.03):
        for root in np.arange(1.5, 4.5 + count, fine):
            wave = free_wave((1.0, float(root**-2)), k)
            if wave is not None and wave.solitary and wave.masses[1] < 0.999:
                found.setdefault(round(wave.masses[1] ** -0.5, 6), wave)
            first = sorted(found)[:count]
            steps = np.diff([1.0, *first])
            regular = len(first) == count and np.all(steps < 1.75 * steps[0])
            if regular and root > first[-1] + 0.3:
                return tuple(found[place] for place in first)
    raise NoWave(f"k = {k:g}: {len(found)} special mass ratios found, {count} wanted")
