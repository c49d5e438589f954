"""Exact traveling waves of the lattice: solutions of the equations of motion to rounding.

Waves are mirror symmetric about a bead of a dimer chain (`validation.waves.newton`).

**Equal masses.** A solitary wave exists for every k (Friesecke & Wattis 1994; English & Pego 2005),
on a background strain p0 (a chain under load) too. Newton's method starts from the theory's wave.

**Dimers.** A solitary wave leaves no strain T behind. This is one condition more than there are
unknowns, as amplitude and speed are tied by scaling: a dimer has solitary waves only at isolated
ratios m2/m1 (`validation.waves.resonances`). At any other ratio the chain has periodic waves (Betti
& Pelinovsky, J. Nonlinear Sci. 23, 689 (2013)): on both sides of the pulse the light beads
oscillate between the heavy ones for ever. Such a wave is a nanopteron. Its tail is the largest |o|
on 0.6 L ≤ |ξ| ≤ L, o the odd part of the strain; the strains are 0 at ξ = ±L, half way between two
pulses (L is the half period). There are several branches of such waves; L and the tail change along
each of them.

A struck chain carries no nanopteron, as its light beads are at rest before the pulse; but its
pulse, made symmetric, is near a nanopteron (`validation.waves.start`). Newton's method starts from
this pulse, or else from the theory's wave, at several L unless L is given. Of the waves found on a
rough grid the solution is the wave whose strain differs least from the struck chain's; the
remaining difference counts as the solution's error (`measured`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from lwa import Cell, Power, background_wave
from lwa.base.exact import InputError
from lwa.base.progress import Progress
from lwa.base.quantities import QUANTITIES
from validation.lattice.cost import IntegrationError
from validation.pulses.pulse import Measured
from validation.scenes.checks import SceneError, between, items, positive
from validation.waves import newton
from validation.waves.newton import Pair
from validation.waves.profile import ExactWave, LatticeWave, at_unit_force
from validation.waves.start import Start, StruckPulse, initial, struck_pulse

FALLEN = 38.0  # e-foldings of a wave on a background from its flanks to L
SHALLOWEST = 1e-4  # rise of a wave on a background over the peak strain, at least
LESS = 0.125  # step of the background from wave to wave, at k > 3 on small backgrounds
FIRST = 0.1  # first step along a branch, in k
HOP = 0.15  # change of the strain, over its peak, that leads to another branch
STEEP = 2.0  # k from which branches are followed if Newton's method finds no wave
PERIODS = np.arange(1.0, 1.8, 0.05)  # half periods of the search, over the ample one
ROUGH = 0.35  # points of the search over those that resolve a wave
ENDED = 3e-15  # strain at the half period over the peak strain, for equal masses
ROUNDING = 1e-12  # relative error of a solitary wave's numbers: a strain's, over its slope


class NoWave(InputError):
    """Failure to find a wave; the message names the wave's parameters."""

    def __init__(self, text: str, masses: Pair, k: float, more: str = "") -> None:
        super().__init__(f"{text} at k = {k:g}, masses {masses[0]:g}, {masses[1]:g}{more}")


def exact_wave(
    masses: Sequence[Any],
    k: Any,
    *,
    half_period: float | None = None,
    background: Any = 0,
    progress: Progress[Any] = iter,
) -> ExactWave:
    """Return the solitary wave or else the nanopteron nearest to the pulse of a struck chain.

    masses : m1, or m1 and m2. k : exponent of F = δ^k, from 1.01 to 8.
    half_period : L; by default long enough for the solitary wave to end within L, and for a
        nanopteron the one of several L whose wave is nearest to the struck chain's pulse.
    background : p0, for one mass only, in units of the peak compression of the contacts. The peak
        force, the static force included, is 1.
    progress : shows the half periods tried for unequal masses (such as `tqdm.tqdm`).

    Raises `SceneError` for parameters out of range, and for an L at which the wave of equal masses
    has not ended; `NoWave` if Newton's method fails.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    given = [between(m, "mass", 1e-100, 1e100) for m in items(masses, "masses")]
    if len(given) not in (1, 2):
        raise SceneError(f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads")
    k = between(k, "k", 1.01, 8, "exact waves are found for k from 1.01 to 8")
    wanted = "exact waves are found for 0.01 to 100"
    ratio = between(given[-1] / given[0], "m2/m1", 0.01, 100, wanted)
    wanted = f"one from 0 to 1 - {SHALLOWEST:g} of the peak compression is wanted"
    p0 = between(background, "background", 0, 1 - SHALLOWEST, wanted)
    if p0 and ratio != 1:
        raise SceneError(f"background is {p0:g}: under a load exact waves are for equal masses")
    L = None if half_period is None else positive(half_period, "half_period")
    wave = _uniform(k, L, p0) if ratio == 1 else _dimer((1.0, ratio), k, L, progress)
    return replace(wave, masses=(given[0], given[-1]), c2=wave.c2 / given[0])


def solve(
    masses: Pair,
    k: float,
    half_period: float | None = None,
    points: int | None = None,
    start: LatticeWave | None = None,
    free: bool = False,
) -> ExactWave:
    """Return a wave of peak force 1, on whatever branch Newton's method reaches.

    half_period, points : the grid, see `newton.Problem`. start : a near wave, by default the
    theory's. free : True to solve for an m2 with a solitary wave.

    Raises `NoWave` if the method does not converge.
    """
    problem = newton.Problem(masses, k, half_period, points)
    return converged(problem, initial(problem, start), "mass" if free else "")[0]


def converged(problem: newton.Problem, start: Start, unknown: str = "") -> tuple[ExactWave, float]:
    """Return the wave that a start converges to, and the last unknown of `Problem.wave`."""
    masses = problem.masses
    try:
        forces, c2, last = problem.wave(*start, unknown)
    except np.linalg.LinAlgError:
        on = f" on {problem.p0:g}" if problem.p0 else ""
        raise NoWave(f"Newton's method finds no wave{on}", masses, problem.k) from None
    if unknown == "mass":
        masses = masses[0], 1 / last
    return at_unit_force(masses, problem, forces, c2), last


def measured(wave: ExactWave) -> dict[str, Measured]:
    """Return c², c and tail, and by quantity amplitude, FWHM and rms width, with errors."""
    values = _numbers(wave)
    if wave.solitary:
        error = ROUNDING / (1 - wave.background) + wave.residual + wave.tail
        checks = {name: value * (1 + error) for name, value in values.items()}
        checks["tail"] = wave.tail + error
        return {name: Measured(value, checks[name]) for name, value in values.items()}
    # The error of a nanopteron is the difference from the struck chain's symmetric pulse, for the
    # FWHM also from the recorded pulse: so nanopterons of all half periods agree within it.
    pulse = struck_pulse(wave.k, wave.omega)
    struck = _numbers(replace(pulse, masses=wave.masses, c2=pulse.c2 / wave.masses[0]))
    unit = _numbers(wave.scaled(force=1))
    errors = {name: abs(struck[name] / unit[name] - 1) for name in unit}
    for name, width in zip(("fwhm force", "fwhm strain"), pulse.widths, strict=True):
        errors[name] = max(errors[name], abs(width / unit[name] - 1))
    far = {name: 1 + error + wave.residual for name, error in errors.items()}
    return {name: Measured(value, value * far[name]) for name, value in values.items()}


def _numbers(wave: ExactWave | StruckPulse) -> dict[str, float]:
    """Return c², c and tail, and amplitude, FWHM and rms width of each of `QUANTITIES`."""
    numbers = {"c2": wave.c2, "c": wave.c, "tail": wave.tail}
    for name in QUANTITIES:
        numbers[f"amplitude {name}"] = wave.peak(name)[1]
        numbers[f"fwhm {name}"] = wave.fwhm(name)
        numbers[f"rms {name}"] = wave.rms_width(name)
    return numbers


def _uniform(k: float, half_period: float | None, p0: float) -> ExactWave:
    """Return the solitary wave of masses 1, 1, on a background strain p0, which may be 0."""
    pair = 1.0, 1.0
    ample = newton.ample_half_period(pair, k)
    if p0:
        wave, ample = _pressed(k, half_period, p0)
    elif k <= 3:
        wave = solve(pair, k, half_period)
    else:  # the theory's wave is too wide to start from
        wave = followed(solve(pair, 3.0, half_period or ample), k)
    if wave.end_strain > ENDED / (1 - p0):  # strains are rounded beside p0
        raise SceneError(
            f"half_period is {wave.half_period:g}: the solitary wave at k = {k:g} has not ended "
            f"there, with {wave.end_strain:.0e} of its peak strain; {ample:.3g} is ample"
        )
    return wave


def _pressed(k: float, half_period: float | None, p0: float) -> tuple[ExactWave, float]:
    """Return the wave of equal masses on a background, and a half period within which it ends."""
    pair = 1.0, 1.0
    theory, load = background_wave(Cell((1,), spacing=1), law=Power(k)).numeric(), (p0, 1 - p0)
    # The wave ends as e^{-κ|ξ|} with (c/c0)² = (sinh(κ/2)/(κ/2))².
    speed_squared = float(theory.speed_squared(*load))
    fast = math.sqrt(speed_squared / p0 ** (k - 1))
    half_kappa = scipy.optimize.brentq(
        lambda x: math.log(math.sinh(x) / x / fast), 1e-5, 300, xtol=1e-12
    )
    core = newton.ample_half_period(pair, k)
    ample = max(core, core / 2 + FALLEN / (2 * half_kappa))
    L = half_period or ample
    narrower = float(theory.fwhm(0.0, 1.0) / theory.fwhm(*load))
    n = max(80, math.ceil(newton.points_needed(pair, k, L) * min(1, 1.3 * narrower)))
    problem = newton.Problem(pair, k, L, n, p0)
    if k > 3 and p0 < 0.5:  # the theory's wave is too wide: from the wave on a lower background
        lower = _uniform(k, None, max(0.0, p0 - LESS))
        start = lower.force(problem.xi), lower.c2
    else:
        start = newton.rise(theory.profile(problem.xi, *load), k, p0), k * speed_squared
    return converged(problem, start)[0], ample


def _dimer(pair: Pair, k: float, half_period: float | None, progress: Progress[Any]) -> ExactWave:
    """Return a dimer's solitary wave near the theory's, else the wave nearest a struck pulse."""
    periods = [half_period] if half_period else list(newton.ample_half_period(pair, k) * PERIODS)
    waves: list[ExactWave] = []
    with suppress(NoWave):
        wave = solve(pair, k, periods[0])
        if wave.solitary:
            return wave
        waves.append(wave)
    try:
        pulse = struck_pulse(k, pair[1])
    except (InputError, IntegrationError) as error:
        raise NoWave("no pulse of a struck chain", pair, k, f": {error}") from None

    def rough_waves(start: LatticeWave | None) -> list[ExactWave]:
        """Return the waves that a start leads to at the half periods, on rough grids."""
        rough = []
        for L in progress(periods):
            with suppress(NoWave):
                rough.append(solve(pair, k, L, _rough(pair, k, L), start))
        return rough

    waves += rough_waves(pulse) or rough_waves(None)
    for wave in sorted(waves, key=pulse.difference):
        with suppress(NoWave):
            return solve(pair, k, wave.half_period, start=wave)
    if k > STEEP:
        return followed(_dimer(pair, STEEP, half_period, progress), k)
    tried = f"from a struck chain's pulse, at half periods {periods[0]:.4g} … {periods[-1]:.4g}"
    raise NoWave("no wave found", pair, k, f": Newton's method was begun {tried}")


def _rough(pair: Pair, k: float, half_period: float) -> int:
    """Return the number of points of a rough grid, on which branches can be distinguished."""
    return max(newton.FEWEST, int(ROUGH * newton.points_needed(pair, k, half_period)))


def followed(begin: ExactWave, k: float) -> ExactWave:
    """Continue a wave to another k at the same masses and half period.

    Raises `NoWave` if the branch of waves turns back or is lost.
    """
    masses, L = begin.masses, begin.half_period
    points = _rough(masses, max(begin.k, k), L)

    def at(k: float, path: Sequence[tuple[float, ExactWave]]) -> ExactWave:
        last = path[-1][1]
        wave = solve(masses, k, L, points, last)
        if wave.difference(last) < HOP:
            return wave
        raise NoWave("another branch", masses, k)

    try:
        wave = newton.continued(solve(masses, begin.k, L, points, begin), begin.k, k, FIRST, at)
    except NoWave:
        raise NoWave("the branch of waves ends, or is lost, on the way", masses, k) from None
    return solve(masses, k, L, start=wave)
