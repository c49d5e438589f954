"""The special mass ratios at which a dimer chain has a solitary wave, whatever the exponent k.

Elsewhere the light beads keep oscillating behind the pulse. At these ratios they come to rest with
the heavy ones, after one more full oscillation from each ratio to the next smaller one
(Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606, 2011: 0.3428, 0.1548, 0.0901, … at
k = 3/2). They are the zeros of the strain T that a wave leaves (`validation.waves.fourier`);
Newton's method solves T = 0 with the equations of motion, m2/m1 being one of the unknowns.

It alone may end at any of the ratios. What keeps them in order: the first two are those of k = 3/2,
followed to k in steps that change √(m1/m2) little. Each further one is looked for where √(m1/m2) is
one step further, as steps are nearly equal: by Newton's method, and between changes of sign of the
kick that keeps a wave of given masses from leaving a strain. Above k = 3/2 all of them are followed
from there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from validation.scenes.checks import between, integer
from validation.waves.profile import ExactWave
from validation.waves.solver import NoWave, solve, solved

MOST = 6  # special ratios at one k
HERTZ, PUBLISHED = 1.5, (0.3428, 0.1548)  # the first ratios there, near which Newton begins
_FARTHEST = 0.15  # change of √(m1/m2) in one step along k; the ratios are 0.2 apart, or more


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
    """The solitary waves at the ``count`` largest special ratios m2/m1 < 1, for k from 1.1 to 5.

    Nearer to 1 the strain T cannot be told from rounding. Raises `SceneError` for other numbers
    than can be meant, and `NoWave` when fewer are found.
    """
    k = between(k, "k", 1.1, 5, "special mass ratios are found for k from 1.1 to 5")
    count = integer(count, "count", 1, MOST)
    first = [solve((1.0, ratio), HERTZ, free=True) for ratio in PUBLISHED]
    if k <= HERTZ:
        return Resonances(k, _ladder([_followed(wave, k) for wave in first], count))
    return Resonances(k, tuple(_followed(wave, k) for wave in _ladder(first, count)))


def _root(wave: ExactWave) -> float:
    """√(m1/m2), as the light beads' frequency goes."""
    return math.sqrt(1 / wave.omega)


def _ladder(waves: list[ExactWave], count: int) -> tuple[ExactWave, ...]:
    while len(waves) < count:
        waves.append(_next(*waves[-2:]))
    return tuple(waves[:count])


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """The wave at another k whose special ratio is of the same place in the order."""
    e, end = math.log(wave.k - 1), math.log(k - 1)
    step, slope = 0.1, 0.0
    while e != end:
        to = end if abs(end - e) <= step else e + math.copysign(step, end - e)
        expected = slope * (to - e)
        bound = 0.02 + 0.2 * abs(expected) if slope else _FARTHEST
        found = _ending(_root(wave) + expected, k if to == end else 1 + math.exp(to), wave)
        if found is not None:
            change = _root(found) - _root(wave)
            if abs(change) < _FARTHEST and abs(change - expected) < bound:
                wave, e, slope, step = found, to, change / (to - e), min(1.5 * step, 0.3)
                continue
        step /= 2
        if step < 1e-3:
            raise NoWave(f"k = {k:g}: special mass ratios are lost on the way, at {wave.k:g}")
    return wave


def _ending(root: float, k: float, start: ExactWave | None) -> ExactWave | None:
    """The wave of a special ratio near root^-2, from a start or the theory's, if one is found."""
    try:
        wave = solve((1.0, root**-2), k, start=start, free=True)
    except NoWave:
        return None
    return wave if wave.solitary else None


def _next(before: ExactWave, last: ExactWave) -> ExactWave:
    """The wave of the next smaller ratio."""
    step = _root(last) - _root(before)
    places = (_root(last) + step * np.arange(0.6, 1.35, 0.05)).tolist()
    first, end = places[0], places[-1]
    middle_first = sorted(places, key=lambda root: abs(root - (first + end) / 2))
    found_by_newton = (_ending(root, last.k, None) for root in middle_first)
    between_signs = (_zero(*change) for change in _changes(places, last))
    for found in chain(found_by_newton, between_signs):
        if found is not None and first < _root(found) < end:
            return found
    raise NoWave(
        f"k = {last.k:g}: the special mass ratio next to {last.omega:.6g} is not found from "
        f"{first**-2:.4g} down to {end**-2:.4g}"
    )


def _changes(
    roots: list[float], last: ExactWave
) -> Iterator[tuple[tuple[float, float], tuple[float, float], ExactWave]]:
    """Neighbours (√(m1/m2), kick) between which the kick changes its sign, with a wave there."""
    before, wave = (math.nan, math.nan), last
    for root in roots:
        for start in (None, wave):
            with suppress(NoWave):
                found, kick = solved((1.0, root**-2), last.k, start=start, unknown="kick")
                if kick * before[1] < 0:
                    yield before, (root, kick), wave
                before, wave = (root, kick), found
                break


def _zero(low: tuple[float, float], high: tuple[float, float], wave: ExactWave) -> ExactWave | None:
    """The wave without a kick, by the secant method; None where the kick jumps through 0."""
    (a, f), (b, g) = low, high
    left, right = a, b
    for _ in range(12):
        if f == g:
            break
        a, b = b, b - g * (b - a) / (g - f)
        if not left <= b <= right:
            return None
        try:
            wave, kick = solved((1.0, b**-2), wave.k, start=wave, unknown="kick")
        except NoWave:
            return None
        f, g = g, kick
        if abs(b - a) < 1e-6 and (found := _ending(b, wave.k, wave)) is not None:
            return found if abs(_root(found) - b) < 1e-4 else None
    return None
