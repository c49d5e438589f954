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
0.6 L ≤ |ξ| ≤ L. The strains are 0 at ξ = ±L, half way between two pulses. There are several
branches of such waves, along each of which L and the tail change.

A struck chain makes none of them, as its light beads are at rest before the pulse; but its pulse,
made symmetric, is nearly one (`validation.waves.struck`). Newton's method is begun from that pulse
(and where it finds nothing, from the theory's wave), at several L unless one is given, and of the
waves found that one is taken whose strain differs least from the struck chain's. How much it still
differs is its error: that is how well a nanopteron, which depends on L, tells what a chain does
(`measured`).

A chain of one mass has always a solitary wave (Friesecke & Wattis 1994; English & Pego 2005).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from lwa.exact import InputError
from lwa.quantities import QUANTITIES
from validation.lattice.run import IntegrationError
from validation.pulses.pulse import Measured
from validation.scenes.checks import SceneError, items, positive, real
from validation.waves import fourier
from validation.waves.continuation import NoWave, follow, named, solve
from validation.waves.profile import TOLERANCE, ExactWave
from validation.waves.struck import Struck, struck

__all__ = ["TOLERANCE", "ExactWave", "NoWave", "continuation", "exact_wave", "measured", "solve"]

STEEP = 2.0
"""The k from which waves are followed up where Newton's method finds none."""

PERIODS = np.arange(1.0, 1.8, 0.1)
"""Ample half periods at which waves are looked for."""

ROUNDING = 1e-12
"""Of a solitary wave's numbers: that of a strain, over its slope at half maximum."""


def exact_wave(
    masses: Sequence[Any],
    k: Any,
    *,
    half_period: float | None = None,
    points: int | None = None,
    start: ExactWave | None = None,
) -> ExactWave:
    """The traveling wave: solitary, or the nanopteron nearest to the pulse of a struck chain.

    Parameters
    ----------
    masses : m1, or m1 and m2.
    k : exponent of F = δ^k, from 1.01 to 8.
    half_period : L, where it is to be this one and not chosen.
    points : n, of the grid on [0, L].
    start : a wave whose branch is followed to these parameters; without, a solitary wave that the
        theory's leads to is taken, and otherwise of all waves found that which is nearest to the
        pulse of a struck chain.

    Raises `SceneError` for parameters that cannot be meant, `NoWave` when Newton's method fails.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    pair, k = parameters(masses, k)
    L = None if half_period is None else positive(half_period, "half_period")
    unit = (1.0, pair[1] / pair[0])
    if start is not None:
        c2 = start.c2 * start.masses[0]
        found = follow(replace(start, masses=(1.0, start.omega), c2=c2), unit, k, L, points)
    elif unit[1] == 1:
        found = _uniform(unit, k, L, points)
    else:
        found = _dimer(unit, k, L, points)
    c2 = found.c2 / pair[0]
    if not sys.float_info.min <= c2 <= sys.float_info.max:
        raise SceneError(f"mass 1 is {pair[0]:g}: c² leaves the range of floats")
    return replace(found, masses=pair, c2=c2)


def measured(wave: ExactWave) -> dict[str, Measured]:
    """c², c, tail, and the amplitude, FWHM and rms width of each quantity, each with its error.

    A nanopteron's error is the difference from a struck chain's pulse, made symmetric or (its
    widths) as it is, so that with it waves of all half periods agree. That of a solitary wave is,
    relatively, the sum of residual, tail and `ROUNDING`.

    >>> measured(exact_wave([1], 1.5))["fwhm force"]
    1.411928348539 ± 1e-12
    """
    values = _numbers(wave)
    if wave.solitary:
        least = ROUNDING + wave.residual + wave.tail
        errors = {name: least * value for name, value in values.items()} | {"tail": least}
        return {name: Measured(value, value + errors[name]) for name, value in values.items()}
    here, pulse = _numbers(wave.scaled(force=1)), struck(wave.k, wave.omega)
    there = _numbers(pulse, wave.masses[0])
    off = {name: abs(there[name] / here[name] - 1) for name in here}
    for name, width in zip(("fwhm force", "fwhm strain"), pulse.widths, strict=True):
        off[name] = max(off[name], abs(width / here[name] - 1))
    return {
        name: Measured(value, value * (1 + off[name] + wave.residual))
        for name, value in values.items()
    }


def _numbers(wave: ExactWave | Struck, mass: float = 1.0) -> dict[str, float]:
    """In units in which m1 is ``mass``."""
    found = {"c2": wave.c2 / mass, "c": wave.c / math.sqrt(mass), "tail": wave.tail}
    for name in QUANTITIES:
        unit = math.sqrt(mass) if name == "velocity" else 1.0
        found[f"amplitude {name}"] = wave.peak(name)[1] / unit
        found[f"fwhm {name}"] = wave.fwhm(name)
        found[f"rms {name}"] = wave.rms_width(name)
    return found


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


def _dimer(
    pair: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> ExactWave:
    """The solitary wave that the theory's leads to, or the wave nearest to a struck chain's."""
    ample = fourier.ample_half_period(pair, k)
    periods = list(ample * PERIODS) if half_period is None else [half_period]
    waves: list[ExactWave] = []

    def look(L: float, start: Struck | None) -> bool:
        with suppress(NoWave):
            waves.append(solve(pair, k, L, points, start))
            return waves[-1].solitary
        return False

    if look(periods[0], None):
        return waves[0]
    try:
        pulse = struck(k, pair[1])
    except (InputError, IntegrationError) as error:
        raise NoWave(f"{named('no pulse of a struck chain', pair, k)}: {error}") from None
    for start in (pulse, None):
        for L in periods:
            if look(L, start):
                return waves[-1]
        if waves:
            return min(waves, key=pulse.distance)
    lengths = f"{periods[0]:.4g}" + f" to {periods[-1]:.4g}" * (len(periods) > 1)
    failure = (
        f"{named('no wave found', pair, k)}: Newton's method was begun from the pulse of a struck "
        f"chain and from the theory's wave, at half periods {lengths}"
    )
    if k <= STEEP:
        raise NoWave(failure)
    try:
        return follow(_dimer(pair, STEEP, half_period, None), pair, k, half_period, points)
    except NoWave as other:
        raise NoWave(f"{failure}; {other}") from None
