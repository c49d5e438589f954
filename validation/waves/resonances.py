"""The special mass ratios at which a dimer chain has a solitary wave, whatever the exponent k.

Elsewhere the light beads keep oscillating behind the pulse. At these ratios they come to rest with
the heavy ones, after one more full oscillation from each ratio to the next smaller one
(Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606, 2011: 0.3428, 0.1548, 0.0901, … at
k = 3/2). They are the zeros of the strain T that a wave leaves (`validation.waves.fourier`);
Newton's method solves T = 0 with the equations of motion, m2/m1 being one of the unknowns.

Newton's method alone may end at any of the ratios. What keeps them in order: the first two are
those of k = 3/2, followed to k in steps that change √(m1/m2) little. Each further one is looked for
where √(m1/m2) is one step further, as steps are nearly equal: by Newton's method, and between
changes of sign of the kick that keeps a wave of given masses from leaving a strain. Above k = 3/2
all of them are followed from there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.scenes.checks import SceneError, integer
from validation.waves.profile import ExactWave
from validation.waves.solver import NoWave, kicked, parameters, solve

RANGE = (1.1, 5.0)
"""The k for which special ratios are found. As k → 1, T becomes too small to be told from
rounding."""

MOST = 6
"""Special ratios at one k."""

HERTZ = 1.5
PUBLISHED = (0.3428, 0.1548)
"""The first ratios at k = 3/2 (Jayaprakash et al. 2011), near which Newton's method begins."""


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

    Raises `SceneError` where the roots cannot be told from rounding, and `NoWave` when fewer are
    found.

    >>> [round(ratio, 6) for ratio in resonances(1.5, 2).mass_ratios]
    [0.342846, 0.154752]
    """
    _, k = parameters([1], k)
    low, high = RANGE
    if not low <= k <= high:
        raise SceneError(
            f"k is {k:g}: special mass ratios are found for k from {low:g} to {high:g}"
        )
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


# --- along k --------------------------------------------------------------------------------

_FARTHEST = 0.15
"""Change of √(m1/m2) in one step along k; the ratios are 0.2 apart, or more."""


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """The wave at another k whose special ratio is of the same place in the order."""
    e, end = math.log(wave.k - 1), math.log(k - 1)
    step, slope = 0.1, 0.0
    while e != end:
        to = end if abs(end - e) <= step else e + math.copysign(step, end - e)
        expected = slope * (to - e)
        bound = 0.02 + 0.2 * abs(expected) if slope else _FARTHEST
        found = _ending(_root(wave) + expected, k if to == end else 1 + math.exp(to), wave)
        change = _root(found) - _root(wave) if found is not None else math.inf
        if found is not None and abs(change) < _FARTHEST and abs(change - expected) < bound:
            wave, e, slope, step = found, to, change / (to - e), min(1.5 * step, 0.3)
        else:
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


# --- from one ratio to the next -------------------------------------------------------------


def _next(before: ExactWave, last: ExactWave) -> ExactWave:
    """The wave of the next smaller ratio."""
    step = _root(last) - _root(before)
    places = (_root(last) + step * np.arange(0.6, 1.35, 0.05)).tolist()
    for found in _candidates(places, last):
        if found is not None and places[0] < _root(found) < places[-1]:
            return found
    raise NoWave(
        f"k = {last.k:g}: the special mass ratio next to {last.omega:.6g} is not found from "
        f"{places[0] ** -2:.4g} down to {places[-1] ** -2:.4g}"
    )


def _candidates(roots: list[float], last: ExactWave) -> Iterator[ExactWave | None]:
    """Waves that Newton's method finds from the theory's, the middle first, or between signs."""
    middle = (roots[0] + roots[-1]) / 2
    for root in sorted(roots, key=lambda root: abs(root - middle)):
        yield _ending(root, last.k, None)
    for low, high, start in _changes(roots, last):
        yield _zero(low, high, start)


def _changes(
    roots: list[float], last: ExactWave
) -> Iterator[tuple[tuple[float, float], tuple[float, float], ExactWave]]:
    """Neighbours (√(m1/m2), kick) between which the kick changes its sign, with a wave there."""
    previous: tuple[float, float, ExactWave] | None = None
    for root in roots:
        starts = (None, last if previous is None else previous[2])
        for start in starts:
            try:
                wave, kick = kicked((1.0, root**-2), last.k, start)
            except NoWave:
                continue
            if previous is not None and kick * previous[1] < 0:
                yield previous[:2], (root, kick), previous[2]
            previous = root, kick, wave
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
            wave, kick = kicked((1.0, b**-2), wave.k, wave)
        except NoWave:
            return None
        f, g = g, kick
        if abs(b - a) < 1e-6:
            found = _ending(b, wave.k, wave)
            if found is not None:
                return found if abs(_root(found) - b) < 1e-4 else None
    return None
