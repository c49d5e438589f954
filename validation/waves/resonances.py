"""Mass ratios at which a dimer chain has a solitary wave.

At these special ratios m2/m1 the light beads come to rest together with the heavy ones, after one
more full oscillation for each smaller ratio (Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83,
036606, 2011: 0.3428, 0.1548, 0.0901, … at k = 3/2); at other ratios they keep oscillating behind
the pulse. The ratios are zeros of the strain T left behind by a wave (`validation.waves.newton`);
Newton's method solves T = 0 together with the equations of motion, with m2/m1 as an unknown.

Newton's method may converge to any of the ratios, so their order is secured as follows. The first
two ratios at k = 3/2 are continued to k in steps that change √(m1/m2) little. The difference of
√(m1/m2) between neighbouring ratios is nearly constant; so each further ratio is searched at this
distance from the last, first by Newton's method, then where the kick that enforces T = 0 at given
masses changes sign. Above k = 3/2 all ratios are found at k = 3/2 and continued from there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from typing import Any

import numpy as np

from validation.scenes.checks import between, integer
from validation.waves.newton import Problem
from validation.waves.profile import ExactWave
from validation.waves.solver import NoWave, solve, solved
from validation.waves.start import initial

MOST = 6  # ratios at one k
HERTZ, PUBLISHED = 1.5, (0.3428, 0.1548)  # the first ratios at k = 3/2, as published
_FARTHEST = 0.15  # change of √(m1/m2) in one step along k; neighbours differ by 0.2 or more


def resonances(k: Any, count: Any) -> tuple[ExactWave, ...]:
    """Return the solitary waves at the ``count`` largest special ratios ω = m2/m1 < 1.

    The waves have m1 = 1 and are sorted by falling ω. k is from 1.1 to 5; nearer to 1 the strain T
    is lost in rounding. Raises `SceneError` for numbers out of range, `NoWave` for missing waves.
    """
    k = between(k, "k", 1.1, 5, "special mass ratios are found for k from 1.1 to 5")
    count = integer(count, "count", 1, MOST)
    first = [solve((1.0, ratio), HERTZ, free=True) for ratio in PUBLISHED]
    if k <= HERTZ:
        return _ladder([_followed(wave, k) for wave in first], count)
    return tuple(_followed(wave, k) for wave in _ladder(first, count))


def _root(wave: ExactWave) -> float:
    """Return √(m1/m2), to which the frequency of the light beads is proportional."""
    return math.sqrt(1 / wave.omega)


def _ladder(waves: list[ExactWave], count: int) -> tuple[ExactWave, ...]:
    """Extend a list of waves to ``count`` waves, each at the next smaller ratio; return them."""
    while len(waves) < count:
        waves.append(_next(*waves[-2:]))
    return tuple(waves[:count])


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """Continue a solitary wave to another k; the ratio keeps its place in the order of ratios."""
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
            raise NoWave(f"on the way to k = {k:g} the ratio is lost", wave.masses, wave.k)
    return wave


def _ending(root: float, k: float, start: ExactWave | None) -> ExactWave | None:
    """Return a solitary wave near the ratio root^-2; None if Newton's method finds none."""
    try:
        wave = solve((1.0, root**-2), k, start=start, free=True)
    except NoWave:
        return None
    return wave if wave.solitary else None


def _next(before: ExactWave, last: ExactWave) -> ExactWave:
    """Return the solitary wave at the next smaller ratio than those of two neighbouring waves."""
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
        f"from {first**-2:.4g} down to {end**-2:.4g} the next special mass ratio is not found",
        last.masses,
        last.k,
    )


def _changes(
    roots: list[float], last: ExactWave
) -> Iterator[tuple[tuple[float, float], tuple[float, float], ExactWave]]:
    """Yield neighbours (√(m1/m2), kick's size) with opposite signs of the kick, and a near wave."""
    before, wave = (math.nan, math.nan), last
    for root in roots:
        for start in (None, wave):
            with suppress(NoWave):
                problem = Problem((1.0, root**-2), last.k)
                found, kick = solved(problem, initial(problem, start), "kick")
                if kick * before[1] < 0:
                    yield before, (root, kick), wave
                before, wave = (root, kick), found
                break


def _zero(low: tuple[float, float], high: tuple[float, float], wave: ExactWave) -> ExactWave | None:
    """Return the solitary wave with kick 0 between low and high, by the secant method, or None."""
    (a, f), (b, g) = low, high
    left, right = a, b
    for _ in range(12):
        if f == g:
            break
        a, b = b, b - g * (b - a) / (g - f)
        if not left <= b <= right:
            return None
        try:
            problem = Problem((1.0, b**-2), wave.k)
            wave, kick = solved(problem, initial(problem, wave), "kick")
        except NoWave:
            return None
        f, g = g, kick
        if abs(b - a) < 1e-6 and (found := _ending(b, wave.k, wave)) is not None:
            return found if abs(_root(found) - b) < 1e-4 else None
    return None
