"""Traveling waves of the lattice to machine precision: Newton's method on spectral profiles.

The equations are those of `spectral`: a chain of beads m1, m2, m1, … at distance 1 whose contacts
push with r_+^k, and a wave mirror symmetric about a bead, with strains e ± o at its two contacts.

A solitary wave leaves no strain T behind. That is one condition more than there are unknowns
(amplitude and speed are tied by scaling), so that a dimer has solitary waves at isolated ratios
m2/m1 only, those of Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606 (2011).
`resonances` finds them.

At any other ratio the chain has periodic waves (Betti & Pelinovsky, J. Nonlinear Sci. 23, 689
(2013)): on both sides of the pulse the light beads rattle between the heavy ones, for ever and at
an amplitude that does not decay. Such a wave is a nanopteron, its tail the largest |o| on
0.6 L ≤ |ξ| ≤ L. The strains are 0 at ξ = ±L, half way between two pulses. The tail depends on L
through its phase; unless L is given, `exact_wave` returns the wave with the least tail, which is
the same whatever number of the light beads' half oscillations lies between two pulses. Far from the
special ratios there are several branches of waves, each with a least tail of its own, and what is
returned is the least of those found.

A chain of one mass has always a solitary wave (Friesecke & Wattis 1994; English & Pego 2005).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from validation import spectral
from validation.branch import NoWave, follow, least_tail, named, solve
from validation.checked import SceneError, items, positive, real
from validation.profile import TOLERANCE, ExactWave

__all__ = ["TOLERANCE", "ExactWave", "NoWave", "continuation", "exact_wave", "solve"]

NEAR_FROM = 1.2
"""The k from which on the special ratio's wave serves as a start."""

STEEP = 2.0
"""The k up to which waves are looked for from the theory's; above, they are followed from here."""


def exact_wave(
    masses: Sequence[Any],
    k: Any,
    *,
    half_period: float | None = None,
    points: int | None = None,
    start: ExactWave | None = None,
) -> ExactWave:
    """The traveling wave: solitary, or the nanopteron with the least tail.

    Parameters
    ----------
    masses : m1, or m1 and m2.
    k : exponent of F = δ^k, from 1.01 to 8.
    half_period : L, where it is to be this one and not chosen.
    points : n, of the grid on [0, L].
    start : a wave whose branch is followed to these parameters; without, the theory's wave and
        that of the nearest special ratio are tried as starts for Newton's method.

    Raises `SceneError` for parameters that cannot be meant, `NoWave` when Newton's method fails.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    pair, k = parameters(masses, k)
    L = None if half_period is None else positive(half_period, "half_period")
    if start is not None:
        found = follow(start, pair, k, L, points)
    elif pair[0] == pair[1]:
        found = _uniform(pair, k, L, points)
    elif k > STEEP:
        found = _steep(pair, k, L, points)
    else:
        found = _searched(pair, k, L, points)
    chosen = L is not None or pair[0] == pair[1] or found.solitary
    return found if chosen else least_tail(found)


def continuation(
    parameters: Iterable[tuple[Sequence[Any], Any]], **options: Any
) -> Iterator[ExactWave]:
    """Waves along a path of (masses, k), each on the branch of the one before; options as there.

    Raises `NoWave` where the branch turns back, ends or cannot be told from another one.
    """
    wave: ExactWave | None = None
    for masses, k in parameters:
        wave = exact_wave(masses, k, start=wave, **options)
        yield wave


def parameters(masses: Sequence[Any], k: Any) -> tuple[tuple[float, float], float]:
    """m1, m2 and k, checked."""
    given = [positive(m, f"mass {i}") for i, m in enumerate(items(masses, "masses"), start=1)]
    if len(given) not in (1, 2):
        raise SceneError(f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads")
    k = real(k, "k")
    if not 1.01 <= k <= 8:
        raise SceneError(f"k is {k:g}: exact waves are found for k from 1.01 to 8")
    ratio = given[-1] / given[0]
    if not 0.01 <= ratio <= 100:
        raise SceneError(f"m2/m1 is {ratio:g}: exact waves are found for 0.01 to 100")
    return (given[0], given[-1]), k


def _uniform(
    pair: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> ExactWave:
    if k <= 3:
        return solve(pair, k, half_period, points)
    return follow(solve(pair, 3.0), pair, k, half_period, points)  # the theory's is too wide


def _steep(
    pair: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> ExactWave:
    """The wave whose branch leads here from k = `STEEP`, where the theory's wave is near enough."""
    tried = []
    for L in dict.fromkeys((half_period, None)):
        try:
            return follow(_searched(pair, STEEP, L, None), pair, k, half_period, points)
        except NoWave as failure:
            tried.append(str(failure))
    raise NoWave(f"{named('no wave found', pair, k)}: from k = {STEEP:g}, {'; '.join(tried)}")


def _searched(
    pair: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> ExactWave:
    """Of the waves that several starts and half periods lead to, that with the least tail."""
    near = _near_solitary(pair, k) if k >= NEAR_FROM else None
    starts = [None] if near is None else [None, near]
    ample = spectral.ample_half_period(pair, k)
    periods = [half_period] if half_period is not None else list(ample * np.arange(1.0, 1.8, 0.1))
    waves: list[ExactWave] = []
    for L, begin in product(periods, starts):
        try:
            waves.append(solve(pair, k, L, points, begin))
        except NoWave:
            continue
        if waves[-1].solitary:
            return waves[-1]
    if not waves:
        beginnings = "the theory's wave" + " and the nearest special ratio's" * (near is not None)
        lengths = f"{periods[0]:.4g}" + f" to {periods[-1]:.4g}" * (len(periods) > 1)
        raise NoWave(
            named("no wave found", pair, k) + f": Newton's method was begun from {beginnings}, at "
            f"half periods {lengths}"
        )
    return min(waves, key=lambda wave: wave.tail)


def free_wave(masses: tuple[float, float], k: float) -> ExactWave | None:
    """The solitary wave of a special ratio, near the theory's wave of these masses."""
    try:
        return solve(masses, k, free=True)
    except NoWave:
        return None


def _near_solitary(masses: tuple[float, float], k: float) -> ExactWave | None:
    """That of the special ratio next to m2/m1 (or of 1), scaled to m1, if one is found there."""
    m1, m2 = masses
    root = math.sqrt(max(m1, m2) / min(m1, m2))
    found = [
        wave
        for shift in (0.0, 0.15)
        if (wave := free_wave((1.0, (root + shift) ** -2), k)) is not None and wave.solitary
    ]
    if not found:
        return None
    best = min(found, key=lambda wave: abs(math.sqrt(1 / wave.masses[1]) - root))
    if m2 <= m1:
        return replace(best, masses=(m1, best.omega * m1), c2=best.c2 / m1)
    return replace(best, masses=(best.omega * m2, m2), c2=best.c2 / m2, odd=-best.odd)  # mirrored
