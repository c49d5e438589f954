"""Traveling waves of the lattice to machine precision: Newton's method on spectral profiles.

The equations are those of `validation.waves.fourier`, of a wave mirror symmetric about a bead of a
dimer chain.

A solitary wave leaves no strain T behind. That is one condition more than there are unknowns
(amplitude and speed are tied by scaling), so that a dimer has solitary waves at isolated ratios
m2/m1 only, those of `validation.waves.resonances`.

At any other ratio the chain has periodic waves (Betti & Pelinovsky, J. Nonlinear Sci. 23, 689
(2013)): on both sides of the pulse the light beads rattle between the heavy ones, for ever. Such a
wave is a nanopteron, its tail the largest |o| on 0.6 L ≤ |ξ| ≤ L. The strains are 0 at ξ = ±L, half
way between two pulses. Along each of several branches of such waves L and the tail change.

A struck chain makes none of them, as its light beads are at rest before the pulse; but its pulse,
made symmetric, is nearly one (`validation.waves.struck`). Newton's method is begun from it, or
where it finds nothing from the theory's wave, at several L unless one is given; of the waves found,
on a rough grid, the one is taken whose strain differs least from the struck chain's. How much it
still differs is its error (`measured`).

A chain of one mass has always a solitary wave (Friesecke & Wattis 1994; English & Pego 2005), on a
background strain p0 (a chain under load) too. There it ends as e^{-κ|ξ|}, c² κ² = 4 c0² sinh²(κ/2),
and Newton's method is begun from the theory's wave on that background.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from lwa import Cell, Power, background_wave
from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.progress import Progress
from lwa.base.quantities import QUANTITIES
from validation.lattice.run import IntegrationError
from validation.pulses.pulse import Measured
from validation.scenes.checks import SceneError, between, integer, items, positive
from validation.waves import fourier
from validation.waves.profile import ExactWave, Profile, at_unit_force
from validation.waves.struck import Struck, struck

FALLEN = 38.0  # e-foldings of a wave on a background from its flanks to L
SHALLOWEST = 1e-4  # of a wave on a background: what it adds to the peak strain
LESS = 0.125  # background, at k > 3 where that is small: from one wave to the next
STEEP = 2.0  # the k from which waves are followed up where Newton's method finds none
PERIODS = np.arange(1.0, 1.8, 0.05)  # ample half periods at which waves are looked for
ROUGH = 0.35  # of the points that resolve a wave: enough to see which one is the nearest
ENDED = 3e-15  # what equal masses may have of their peak strain at the half period
ROUNDING = 1e-12  # of a solitary wave's numbers: that of a strain, over its slope at half maximum
Pair = tuple[float, float]  # m1 and m2


class NoWave(InputError):
    """Newton's method found no wave; the message names its parameters."""


def exact_wave(
    masses: Sequence[Any], k: Any, *, half_period: float | None = None, background: Any = 0,
    progress: Progress[Any] = iter,
) -> ExactWave:  # fmt: skip
    """The traveling wave: solitary, or the nanopteron nearest to the pulse of a struck chain.

    masses : m1, or m1 and m2. k : exponent of F = δ^k, from 1.01 to 8.
    half_period : L, where it is to be this one and not chosen.
    background : of one mass, p0 in units of the peak compression of the contacts: the static
        force is p0^k, its sum with the wave's peaks at 1.
    progress : is shown what is tried on the way, where the masses differ (such as `tqdm.tqdm`).

    Raises `SceneError` for parameters that cannot be meant, among them a half period at which the
    wave of equal masses has not ended; `NoWave` when Newton's method fails.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    >>> round(exact_wave([1], 1.5, background=0.5).c2, 6)
    1.222413
    """
    pair, k = parameters(masses, k)
    wanted = f"one from 0 to 1 - {SHALLOWEST:g} of the peak compression is wanted"
    p0 = between(background, "background", 0, 1 - SHALLOWEST, wanted)
    if p0 and pair[0] != pair[1]:
        found_for = "under a load exact waves are found for equal masses"
        raise SceneError(f"background is {p0:g}: {found_for}")
    L = None if half_period is None else positive(half_period, "half_period")
    unit = (1.0, pair[1] / pair[0])
    found = _uniform(unit, k, L, p0) if unit[1] == 1 else _dimer(unit, k, L, progress)
    c2 = found.c2 / pair[0]
    if not sys.float_info.min <= c2 <= sys.float_info.max:
        raise SceneError(f"mass 1 is {pair[0]:g}: c² leaves the range of floats")
    return replace(found, masses=pair, c2=c2)


def measured(wave: ExactWave) -> dict[str, Measured]:
    """c², c, tail, and the amplitude, FWHM and rms width of each quantity, each with its error.

    A nanopteron's error is the difference from a struck chain's pulse, made symmetric or (its
    widths) as it is, so that with it waves of all half periods agree. That of a solitary wave is,
    relatively, the sum of residual, tail and `ROUNDING`.
    """
    values = _numbers(wave)
    if wave.solitary:
        least = ROUNDING / (1 - wave.background) + wave.residual + wave.tail
        errors = {name: least * value for name, value in values.items()} | {"tail": least}
        return {name: Measured(value, value + errors[name]) for name, value in values.items()}
    here, pulse = _numbers(wave.scaled(force=1)), struck(wave.k, wave.omega)
    there = _numbers(pulse, wave.masses[0])
    off = {name: abs(there[name] / here[name] - 1) for name in here}
    for name, width in zip(("fwhm force", "fwhm strain"), pulse.widths, strict=True):
        off[name] = max(off[name], abs(width / here[name] - 1))
    far = {name: 1 + off[name] + wave.residual for name in off}
    return {name: Measured(value, value * far[name]) for name, value in values.items()}


def _numbers(wave: ExactWave | Struck, mass: float = 1.0) -> dict[str, float]:
    """In units in which m1 is ``mass``."""
    root = math.sqrt(mass)
    found = {"c2": wave.c2 / mass, "c": wave.c / root, "tail": wave.tail}
    for name in QUANTITIES:
        found[f"amplitude {name}"] = wave.peak(name)[1] / (root if name == "velocity" else 1.0)
        found[f"fwhm {name}"] = wave.fwhm(name)
        found[f"rms {name}"] = wave.rms_width(name)
    return found


def parameters(masses: Sequence[Any], k: Any) -> tuple[Pair, float]:
    """m1, m2 and k, checked."""
    given = [positive(m, f"mass {i}") for i, m in enumerate(items(masses, "masses"), start=1)]
    if len(given) not in (1, 2):
        raise SceneError(f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads")
    k = between(k, "k", 1.01, 8, "exact waves are found for k from 1.01 to 8")
    ratio = given[-1] / given[0]
    if not 0.01 <= ratio <= 100:
        raise SceneError(f"m2/m1 is {ratio:g}: exact waves are found for 0.01 to 100")
    return (given[0], given[-1]), k


def _uniform(pair: Pair, k: float, half_period: float | None, p0: float) -> ExactWave:
    """Of equal masses, on a background or none."""
    ample = fourier.ample_half_period(pair, k)
    if p0:
        found, ample = _pressed(pair, k, half_period, p0)
    elif k <= 3:
        found = solve(pair, k, half_period)
    else:  # the theory's is too wide
        found = _followed(solve(pair, 3.0, half_period or ample), k)
    if found.rest > ENDED / (1 - p0):  # strains are rounded beside p0
        raise SceneError(
            f"half_period is {found.half_period:g}: the solitary wave at k = {k:g} has not ended "
            f"there, with {found.rest:.0e} of its peak strain; {ample:.3g} is ample"
        )
    return found


def _pressed(pair: Pair, k: float, half_period: float | None, p0: float) -> tuple[ExactWave, float]:
    """The wave of equal beads on a background, and the half period that is ample for it."""
    theory, load = background_wave(Cell((1,), spacing=1), law=Power(k)).numeric(), (p0, 1 - p0)
    c2 = float(k * theory.speed_squared(*load))
    core = fourier.ample_half_period(pair, k)
    ample = max(core, core / 2 + FALLEN / _kappa(c2 / (k * p0 ** (k - 1))))
    L = half_period or ample
    narrower = float(theory.fwhm(0.0, 1.0) / theory.fwhm(*load))
    n = max(80, math.ceil(fourier.enough(pair, k, L) * min(1, 1.3 * narrower)))
    problem = fourier.Problem(pair, k, L, n, p0)
    xi = problem.xi[: problem.count]
    if k > 3 and p0 < 0.5:  # where the theory's is too wide: from the wave on a little less
        near = _uniform(pair, k, None, max(0.0, p0 - LESS))
        guess, c2 = near.force(xi), near.c2
    else:
        guess = fourier.rise(theory.profile(xi, *load), k, p0)
    try:
        forces, c2, _ = problem.wave(guess, c2)
    except np.linalg.LinAlgError:
        raise NoWave(_named(f"Newton's method finds no wave on {p0:g}", pair, k)) from None
    return at_unit_force(pair, problem, forces, c2), ample


def _kappa(square: float) -> float:
    """κ of a wave's end e^{-κ|ξ|}, at (c/c0)² = (sinh(κ/2)/(κ/2))²."""
    excess = math.sqrt(square)
    return 2 * float(
        scipy.optimize.brentq(lambda x: math.log(math.sinh(x) / x / excess), 1e-5, 300, xtol=1e-12)
    )


def _dimer(
    pair: Pair, k: float, half_period: float | None, progress: Progress[Any] = iter
) -> ExactWave:
    """The solitary wave that the theory's leads to, or the wave nearest to a struck chain's."""
    ample = fourier.ample_half_period(pair, k)
    periods = list(ample * PERIODS) if half_period is None else [half_period]
    # The theory's wave first, and where the pulse led to none, at the other half periods.
    one, *others = ((False, L) for L in periods)
    waves: list[ExactWave] = []
    led = False
    for i, (from_pulse, L) in enumerate(progress([one, *((True, L) for L in periods), *others])):
        if led and i > len(periods):
            break
        points = _rough(pair, k, L) if i else None
        with suppress(NoWave):
            start = _pulse(pair, k) if from_pulse else None
            waves.append(solve(pair, k, L, points, start))
            led |= from_pulse
            if waves[-1].solitary:
                return solve(pair, k, L, start=waves[-1])
    if waves:
        pulse = _pulse(pair, k)
        for wave in sorted(waves, key=pulse.apart):
            with suppress(NoWave):
                return solve(pair, k, wave.half_period, start=wave)
    lengths = f"{periods[0]:.4g}" + f" to {periods[-1]:.4g}" * (len(periods) > 1)
    begun = "Newton's method was begun from the pulse of a struck chain and from the theory's wave"
    failure = f"{_named('no wave found', pair, k)}: {begun}, at half periods {lengths}"
    if k <= STEEP:
        raise NoWave(failure)
    try:
        begin = _dimer(pair, STEEP, half_period, progress)
        return next(_followed(begin, end) for end in progress([k]))
    except NoWave as other:
        raise NoWave(f"{failure}; {other}") from None


def _rough(pair: Pair, k: float, half_period: float) -> int:
    """Points on which a wave is told from others."""
    return max(fourier.FEWEST, int(ROUGH * fourier.enough(pair, k, half_period)))


def _pulse(pair: Pair, k: float) -> Struck:
    """Of the struck chain; raises `NoWave` where none comes through."""
    try:
        return struck(k, pair[1])
    except (InputError, IntegrationError) as error:
        raise NoWave(f"{_named('no pulse of a struck chain', pair, k)}: {error}") from None


def _followed(begin: ExactWave, k: float) -> ExactWave:
    """The wave at another k, of the same half period, on the branch of this one.

    Raises `NoWave` where the branch does not get there, or is lost.
    """
    masses, L = begin.masses, begin.half_period
    problem = fourier.Problem(masses, begin.k, L, _rough(masses, max(begin.k, k), L))
    try:
        z, c2, _ = problem.wave(*_guess(masses, begin.k, problem.xi, begin))
        z, c2 = problem.followed(z, c2, k)
    except np.linalg.LinAlgError:
        lost = "the branch of waves ends, or is lost, on the way"
        raise NoWave(_named(lost, masses, k)) from None
    problem.k = k
    return solve(masses, k, L, start=at_unit_force(masses, problem, z, c2))


def solve(
    masses: Pair, k: float, half_period: float | None = None, points: int | None = None,
    start: Profile | None = None, free: bool = False,
) -> ExactWave:  # fmt: skip
    """One wave by Newton's method, scaled to a force 1 at its peak; free: m2 is to be found.

    It begins with the theory's wave, or another near one, and may end on any branch of waves.
    Raises `NoWave` where it fails.
    """
    return solved(masses, k, half_period, points, start, "mass" if free else "")[0]


def solved(
    masses: Pair, k: float, half_period: float | None = None, points: int | None = None,
    start: Profile | None = None, unknown: str = "",
) -> tuple[ExactWave, float]:  # fmt: skip
    """`solve`, and what was asked for besides: the "mass", as 1/m2, or the "kick" in the middle of
    the pulse that keeps the wave from having a tail."""
    points = None if points is None else integer(points, "points", 8, 2000)
    problem = fourier.Problem(masses, k, half_period, points)
    try:
        z, c2, found = problem.wave(*_guess(masses, k, problem.xi, start), unknown)
    except np.linalg.LinAlgError:
        raise NoWave(_named("Newton's method finds no wave", masses, k)) from None
    if unknown == "mass":
        masses = masses[0], 1 / found
    return at_unit_force(masses, problem, z, c2), found


def _guess(masses: Pair, k: float, xi: Array, start: Profile | None) -> tuple[Array, float]:
    """F_a on the grid and c², from a near wave or from the theory at leading order.

    There the force is cos^{2k/(k-1)}(βξ), c² = 4 / ((k+1)(m1+m2)), and the contacts of a cell are
    (m2-m1)/(m1+m2) out of step, by which both beads of a cell move alike.
    """
    if start is not None:
        force, c2 = start.force(xi), start.c2 * sum(start.masses) / sum(masses)
    else:
        beta = (k - 1) * math.sqrt(6 / (k * (k + 1))) / fourier.widening(masses)
        phase = beta * (xi - (masses[1] - masses[0]) / sum(masses) / 2)
        force = np.cos(np.clip(phase, -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
        c2 = 4 / ((k + 1) * sum(masses))
    return force, c2 * float(force[0]) ** ((1 - k) / k)


def _named(text: str, masses: Pair, k: float) -> str:
    return f"{text} at k = {k:g}, masses {masses[0]:g}, {masses[1]:g}"
