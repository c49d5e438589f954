"""Mass ratios at which a dimer chain has a solitary wave.

At other ratios the light beads keep oscillating behind the pulse. At these ratios the light beads
come to rest with the heavy ones, with one more full oscillation from each ratio to the next smaller
one (Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606, 2011: 0.3428, 0.1548, 0.0901, …
at k = 3/2). The ratios are zeros of the strain T left by a wave (`validation.waves.newton`);
Newton's method solves T = 0 together with the equations of motion, with m2/m1 as an unknown.

Newton's method alone may end at any of the ratios. The order is kept as follows. The first two
ratios are those of k = 3/2, followed to k in small steps of √(m1/m2). Each further ratio is
searched one step of √(m1/m2) on, as these steps are nearly equal: by Newton's method, and between
changes of sign of the kick that keeps a wave at given masses from leaving a strain. Above k = 3/2
all ratios are followed from k = 3/2.
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
    """Solitary waves at the ``count`` largest special ratios ω = m2/m1 < 1, for k from 1.1 to 5.

    The waves have m1 = 1 and stand in falling order of ω. Nearer to k = 1 the strain T is lost in
    rounding. Raises `SceneError` for numbers out of range, and `NoWave` if fewer waves are found.
    """
    k = between(k, "k", 1.1, 5, "special mass ratios are found for k from 1.1 to 5")
    count = integer(count, "count", 1, MOST)
    first = [solve((1.0, ratio), HERTZ, free=True) for ratio in PUBLISHED]
    if k <= HERTZ:
        return _ladder([_followed(wave, k) for wave in first], count)
    return tuple(_followed(wave, k) for wave in _ladder(first, count))


def _root(wave: ExactWave) -> float:
    """Root √(m1/m2), to which the frequency of the light beads is proportional."""
    return math.sqrt(1 / wave.omega)


def _ladder(waves: list[ExactWave], count: int) -> tuple[ExactWave, ...]:
    """Continue a list of waves to ``count`` waves, each at the next smaller ratio."""
    while len(waves) < count:
        waves.append(_next(*waves[-2:]))
    return tuple(waves[:count])


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """Follow a wave in k: the ratio keeps its place in the order of all ratios."""
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
    """Solve for a solitary wave near the ratio root^-2; None if the solution is not solitary."""
    try:
        wave = solve((1.0, root**-2), k, start=start, free=True)
    except NoWave:
        return None
    return wave if wave.solitary else None


def _next(before: ExactWave, last: ExactWave) -> ExactWave:
    """The solitary wave at the next smaller ratio."""
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
    """Pairs of neighbours (√(m1/m2), kick) with kicks of opposite signs, and a wave near them."""
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
    """The wave without a kick, by the secant method; None where the kick jumps across 0."""
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
