"""Traveling waves of the lattice to machine precision: Newton's method on spectral profiles.

The equations are those of `validation.waves.fourier`, of a wave mirror symmetric about a bead of a
dimer chain.

A solitary wave leaves no strain T behind. That is one condition more than there are unknowns
(amplitude and speed are tied by scaling), so that a dimer has solitary waves at isolated ratios
m2/m1 only, those of Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83, 036606 (2011).
`resonances` finds them.

At any other ratio the chain has periodic waves (Betti & Pelinovsky, J. Nonlinear Sci. 23, 689
(2013)): on both sides of the pulse the light beads rattle between the heavy ones, for ever. Such a
wave is a nanopteron, its tail the largest |o| on 0.6 L ≤ |ξ| ≤ L. The strains are 0 at ξ = ±L, half
way between two pulses. Along each of several branches of such waves L and the tail change.

A struck chain makes none of them, as its light beads are at rest before the pulse; but its pulse,
made symmetric, is nearly one (`validation.waves.struck`). Newton's method is begun from that pulse
(and where it finds nothing, from the theory's wave), at several L unless one is given, and of the
waves found that one is taken whose strain differs least from the struck chain's. How much it still
differs is its error (`measured`).

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
from itertools import count
from typing import Any

import numpy as np

from lwa.duration import Progress
from lwa.exact import InputError
from lwa.numeric import Array
from lwa.quantities import QUANTITIES
from validation.lattice.run import IntegrationError
from validation.pulses.pulse import Measured
from validation.scenes.checks import SceneError, items, positive, real
from validation.waves import fourier
from validation.waves.profile import ExactWave, Profile, at_unit_force
from validation.waves.struck import Struck, struck
from validation.waves.theory import Loaded

CLOSE = 0.1  # by how much c² and the strain may change, relatively, in one step along k
HALVINGS = 7  # of a step along k, before a branch counts as lost
FALLEN = 38.0  # e-foldings of a wave on a background from its flanks to L
SHALLOWEST = 1e-4  # of a wave on a background: what it adds to the peak strain
LESS = 0.125  # background, at k > 3 where that is small: from one wave to the next
STEEP = 2.0  # the k from which waves are followed up where Newton's method finds none
PERIODS = np.arange(1.0, 1.8, 0.1)  # ample half periods at which waves are looked for
ENDED = 3e-15  # what equal masses may have of their peak strain at the half period
ROUNDING = 1e-12  # of a solitary wave's numbers: that of a strain, over its slope at half maximum


class NoWave(InputError):
    """Newton's method found no wave; the message names its parameters."""


def exact_wave(
    masses: Sequence[Any],
    k: Any,
    *,
    half_period: float | None = None,
    background: Any = 0,
    progress: Progress[Any] = iter,
) -> ExactWave:
    """The traveling wave: solitary, or the nanopteron nearest to the pulse of a struck chain.

    masses : m1, or m1 and m2.
    k : exponent of F = δ^k, from 1.01 to 8.
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
    p0 = real(background, "background")
    if not 0 <= p0 <= 1 - SHALLOWEST:
        most = f"1 - {SHALLOWEST:g} of the peak compression"
        raise SceneError(f"background is {p0:g}: one from 0 to {most} is wanted")
    if p0 and pair[0] != pair[1]:
        raise SceneError(
            f"background is {p0:g}: under a load exact waves are found for equal masses"
        )
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


def longest(masses: Sequence[Any], k: Any) -> float:
    """Seconds that `exact_wave` takes where Newton's method fails everywhere; a rough bound."""
    pair, k = parameters(masses, k)
    unit = (1.0, pair[1] / pair[0])
    if unit[1] == 1:
        return 0.0
    ample = fourier.ample_half_period(unit, k)
    counts = [fourier.problem(unit, k, L, None).count for L in ample * PERIODS]
    each = sum(5e-8 * count**2 + 4e-11 * count**3 for count in counts)  # a step's, on one core
    return 2 * fourier.MOST_STEPS * each


def _uniform(
    pair: tuple[float, float], k: float, half_period: float | None, p0: float
) -> ExactWave:
    ample = fourier.ample_half_period(pair, k)
    L = half_period or ample
    if p0:
        found, ample = _pressed(pair, k, half_period, p0)
        L = found.half_period
    else:  # above k = 3 the theory's is too wide
        found = solve(pair, k, L) if k <= 3 else _followed(solve(pair, 3.0), k, L)
    if found.rest > ENDED:
        raise SceneError(
            f"half_period is {L:g}: the solitary wave at k = {k:g} has not ended there, with "
            f"{found.rest:.0e} of its peak strain; {ample:.3g} is ample"
        )
    return found


def _pressed(
    pair: tuple[float, float], k: float, half_period: float | None, p0: float
) -> tuple[ExactWave, float]:
    """The wave of equal beads on a background, and the half period that is ample for it."""
    theory, core = Loaded(k, p0), fourier.ample_half_period(pair, k)
    ample = max(core, core / 2 + FALLEN / theory.kappa)
    L = half_period or ample
    n = fourier.problem(pair, k, L, None).n
    n = max(80, math.ceil(n * min(1, 1.3 * theory.narrower)))
    problem = fourier.Problem(pair, k, L, n, p0)
    if k > 3 and p0 < 0.5:  # where the theory's is too wide: from the wave on a little less
        near = _uniform(pair, k, None, max(0.0, p0 - LESS))
        guess, c2 = near.force(problem.xi), near.c2
    else:
        guess, c2 = fourier.rise(theory.strain(problem.xi), k, p0), theory.c2
    try:
        even, c2, _ = problem.wave(guess, c2)
    except np.linalg.LinAlgError:
        raise NoWave(_named(f"Newton's method finds no wave on {p0:g}", pair, k)) from None
    rows = fourier.coefficients(even, np.zeros(problem.n - 1))
    return at_unit_force(pair, k, c2, L, *rows, p0), ample


def _dimer(
    pair: tuple[float, float], k: float, half_period: float | None, progress: Progress[Any] = iter
) -> ExactWave:
    """The solitary wave that the theory's leads to, or the wave nearest to a struck chain's."""
    ample = fourier.ample_half_period(pair, k)
    periods = list(ample * PERIODS) if half_period is None else [half_period]
    # The theory's wave first, and where nothing else led to one, at the other half periods.
    one, *others = ((False, L) for L in periods)
    waves: list[ExactWave] = []
    for i, (from_pulse, L) in enumerate(progress([one, *((True, L) for L in periods), *others])):
        if waves and i > len(periods):
            break
        start = _pulse(pair, k) if from_pulse else None
        with suppress(NoWave):
            waves.append(solve(pair, k, L, start=start))
            if waves[-1].solitary:
                return waves[-1]
    if waves:
        pulse = _pulse(pair, k)
        return min(waves, key=lambda wave: pulse.apart(wave, pulse.pulse))
    lengths = f"{periods[0]:.4g}" + f" to {periods[-1]:.4g}" * (len(periods) > 1)
    begun = "Newton's method was begun from the pulse of a struck chain and from the theory's wave"
    failure = f"{_named('no wave found', pair, k)}: {begun}, at half periods {lengths}"
    if k <= STEEP:
        raise NoWave(failure)
    try:
        begin = _dimer(pair, STEEP, half_period, progress)
        return _followed(begin, k, half_period or max(begin.half_period, ample), progress)
    except NoWave as other:
        raise NoWave(f"{failure}; {other}") from None


def _pulse(pair: tuple[float, float], k: float) -> Struck:
    """Of the struck chain; raises `NoWave` where none comes through."""
    try:
        return struck(k, pair[1])
    except (InputError, IntegrationError) as error:
        raise NoWave(f"{_named('no pulse of a struck chain', pair, k)}: {error}") from None


def _followed(
    begin: ExactWave, k: float, half_period: float, progress: Progress[Any] = iter
) -> ExactWave:
    """The wave at another k and L on the branch of this one.

    A step counts when it changes the wave little and when the same step taken back leads to the
    wave it came from, as far as residuals can tell; otherwise it is halved. Raises `NoWave` where
    the branch turns back or ends on the way.
    """

    def at(t: float) -> tuple[float, float]:
        L = begin.half_period + t * (half_period - begin.half_period)
        return (begin.k + t * (k - begin.k) if t < 1 else k), L

    wave, done, step = begin, 0.0, 1.0
    for _ in progress(count()):
        if done == 1:
            break
        to = min(1.0, done + step)
        with suppress(NoWave):
            found = solve(begin.masses, *at(to), start=wave)
            back = solve(begin.masses, *at(done), start=found)
            L = min(wave.half_period, found.half_period)
            speeds = found.c2 * (found.k + 1) / (wave.c2 * (wave.k + 1))  # over the theory's
            rounding = 1e-6 + 10 * max(wave.residual, back.residual)
            near = abs(speeds - 1) < CLOSE and found.apart(wave, L) < CLOSE
            if near and back.apart(wave, wave.half_period) < rounding:
                wave, done, step = found, to, 2 * step
                continue
        step = (to - done) / 2
        if step < 0.5**HALVINGS:
            lost = "the branch of waves turns back or ends"
            raise NoWave(_named(lost, begin.masses, at(done)[0]))
    return wave


def solve(
    masses: tuple[float, float], k: float, half_period: float | None = None,
    points: int | None = None, start: Profile | None = None, free: bool = False,
) -> ExactWave:  # fmt: skip
    """One wave by Newton's method, scaled to a force 1 at its peak; free: m2 is to be found.

    It begins with the theory's wave, or another near one, and may end on any branch of waves.
    Raises `NoWave` where it fails.
    """
    return solved(masses, k, half_period, points, start, "mass" if free else "")[0]


def solved(
    masses: tuple[float, float], k: float, half_period: float | None = None,
    points: int | None = None, start: Profile | None = None, unknown: str = "",
) -> tuple[ExactWave, float]:  # fmt: skip
    """`solve`, and what was asked for besides: the "mass", as 1/m2, or the "kick" in the middle of
    the pulse that keeps the wave from having a tail."""
    problem = fourier.problem(masses, k, half_period, points)
    try:
        z, c2, found = problem.wave(*_guess(masses, k, problem.xi, start), unknown)
    except np.linalg.LinAlgError:
        raise NoWave(_named("Newton's method finds no wave", masses, k)) from None
    if unknown == "mass":
        masses = masses[0], 1 / found
    n = problem.n
    z = np.append(z, np.zeros(2 * n - len(z)))
    even, odd = fourier.coefficients(z[: n + 1], z[n + 1 :])
    return at_unit_force(masses, k, c2, float(problem.xi[-1]), even, odd), found


def _guess(
    masses: tuple[float, float], k: float, xi: Array, start: Profile | None
) -> tuple[Array, float]:
    """E, O on the grid and c², from a near wave or from the theory at leading order.

    There the force is cos^{2k/(k-1)}(βξ), c² = 4 / ((k+1)(m1+m2)), and the contacts of a cell are
    (m2-m1)/(m1+m2) out of step, by which both beads of a cell move alike.
    """
    if start is not None:
        a, b = start.force(xi, 0), start.force(xi, 1)
        c2 = start.c2 * sum(start.masses) / sum(masses)
    else:
        beta = (k - 1) * math.sqrt(6 / (k * (k + 1))) / fourier.widening(masses)
        shift = (masses[1] - masses[0]) / sum(masses) / 2
        phases = (beta * (xi + side * shift) for side in (-1, 1))
        a, b = (np.cos(np.clip(x, -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1)) for x in phases)
        c2 = 4 / ((k + 1) * sum(masses))
    E, O = (a + b) / 2, (a - b)[1:-1] / 2
    return np.append(E, O), c2 * float(E[0]) ** ((1 - k) / k)


def _named(text: str, masses: tuple[float, float], k: float) -> str:
    return f"{text} at k = {k:g}, masses {masses[0]:g}, {masses[1]:g}"
