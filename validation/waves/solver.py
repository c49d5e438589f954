"""Exact solitary waves of the lattice: solutions of the equations of motion to rounding.

Waves are mirror symmetric about a bead of a dimer chain (`validation.waves.newton`).

**Equal masses.** A solitary wave exists for every k (Friesecke & Wattis 1994; English & Pego 2005),
on a background strain p0 (a chain under load) too. Newton's method starts from the theory's wave.

**Dimers.** A solitary wave leaves no strain T behind. This is one condition more than there are
unknowns, as amplitude and speed are tied by scaling: a dimer has solitary waves only at isolated
ratios m2/m1 (`validation.waves.resonances`). At any other ratio the chain has periodic waves with
an oscillating tail on both sides of the pulse, on which the light beads oscillate between the heavy
ones for ever (Betti & Pelinovsky, J. Nonlinear Sci. 23, 689 (2013)). A struck chain carries no such
wave, as its light beads are at rest before the pulse: its pulse is measured by
`validation.pulses.steady`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import scipy

from lwa import Cell, loaded_wave
from lwa.base.frozen import QUANTITIES
from validation.pulses.pulse import Measured
from validation.scenes.checks import SceneError, between, items
from validation.waves import newton
from validation.waves.profile import ExactWave
from validation.waves.resonances import NoWave, converged, solve, special_waves

FALLEN = 38.0  # e-foldings of a wave on a background from its flanks to L
LIGHTEST = 1e-12  # background over the peak strain, at least: a lighter one does not show
SHALLOWEST = 1e-4  # rise of a wave on a background over the peak strain, at least
LESS = 0.125  # step of the background from wave to wave, at k > 3 on small backgrounds
STEEP = 3.0  # k above which the theory's wave is too wide to start from
FARTHEST = 2.0  # step in k from wave to wave above
NEAR = 1e-7  # relative difference from a special mass ratio: ratios are given in seven digits
ROUNDING = 1e-13  # relative error of a solitary wave's numbers: a strain's, over its slope


def exact_wave(masses: Sequence[Any], k: Any, *, background: Any = 0) -> ExactWave:
    """Return the solitary wave of peak contact force 1.

    masses : m1, or m1 and m2. A ratio m2/m1 within 1e-7 of a special ratio counts as that ratio,
        and the wave has its masses: m1 and the special m2.
    k : exponent of F = δ^k, from 1.01 to 8; for unequal masses from 1.1 to 5.
    background : p0, for one mass only, in units of the peak compression of the contacts. The peak
        force, the static force included, is 1.

    Raises `SceneError` for parameters out of range; `NoWave` at a mass ratio without a solitary
    wave, with the tail of the wave that Newton's method finds there.

    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    given = [between(m, "mass", 1e-100, 1e100) for m in items(masses, "masses")]
    if len(given) not in (1, 2):
        raise SceneError(f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads")
    k = between(k, "k", 1.01, 8, "exact waves are found for k from 1.01 to 8")
    wanted = f"0 or {LIGHTEST:g} … 1 - {SHALLOWEST:g} of the peak compression is wanted"
    p0 = between(background, "background", 0, 1 - SHALLOWEST, wanted)
    if p0:
        between(background, "background", LIGHTEST, 1, wanted)
    if given[0] == given[-1]:
        wave = _uniform(k, p0)
        return replace(wave, masses=(given[0], given[0]), c2=wave.c2 / given[0])
    if p0:
        raise SceneError(f"background is {p0:g}: under a load exact waves are for equal masses")
    light, heavy = sorted(given)
    between(light / heavy, "ratio of the masses", 0.01, 1)
    wave = _dimer((given[0], given[1]), k)
    if given[0] == heavy:
        return replace(wave, masses=(heavy, heavy * wave.omega), c2=wave.c2 / heavy)
    # The mirror image, with b(ξ) for a(ξ): F_a = E + O and F_b = E - O.
    masses = light, light / wave.omega
    return replace(wave, masses=masses, c2=wave.c2 / masses[1], odd=-wave.odd)


def measured(wave: ExactWave) -> dict[str, Measured]:
    """Return c², c and tail, and amplitude and FWHM of each of `QUANTITIES`, with errors."""
    values = {"c2": wave.c2, "c": wave.c}
    for name in QUANTITIES:
        values[f"amplitude {name}"] = wave.peak(name)[1]
        values[f"fwhm {name}"] = wave.fwhm(name)
    error = ROUNDING / (1 - wave.background) + wave.residual + wave.tail
    numbers = {name: Measured(value, value * (1 + error)) for name, value in values.items()}
    return numbers | {"tail": Measured(wave.tail, wave.tail + error)}


def _uniform(k: float, p0: float) -> ExactWave:
    """Return the solitary wave of masses 1, 1, on a background strain p0, which may be 0."""
    if p0:
        return _pressed(k, p0)
    wave = solve((1.0, 1.0), min(k, STEEP))
    while wave.k < k:
        wave = solve((1.0, 1.0), min(k, wave.k + FARTHEST), start=wave)
    return wave


def _pressed(k: float, p0: float) -> ExactWave:
    """Return the wave of equal masses on a background."""
    pair = 1.0, 1.0
    chain = Cell((1,), spacing=1)
    theory = loaded_wave(chain, rise=1 - p0, background=p0, k=k)
    # The wave ends as e^{-κ|ξ|} with (c/c0)² = (sinh(κ/2)/(κ/2))².
    fast = float(theory.speed / theory.sound_speed)
    half_kappa = scipy.optimize.brentq(
        lambda x: math.log(math.sinh(x) / x / fast), 1e-5, 300, xtol=1e-12
    )
    core = newton.ample_half_period(pair, k)
    L = max(core, core / 2 + FALLEN / (2 * half_kappa))
    bare = loaded_wave(chain, rise=1, background=0, k=k)
    narrower = float(bare.fwhm("strain") / theory.fwhm("strain"))
    n = max(80, math.ceil(newton.points_needed(pair, k, L) * min(1, 1.3 * narrower)))
    problem = newton.Problem(pair, k, L, n, p0)
    if k > STEEP and p0 < 0.5:  # the theory's wave is too wide: from the wave on a lower background
        lower = _uniform(k, max(0.0, p0 - LESS))
        start = lower.force(problem.xi), lower.c2
    else:
        start = newton.rise(theory.along(problem.xi, "strain"), k, p0), float(theory.speed) ** 2
    return converged(problem, start)


def _dimer(pair: newton.Pair, k: float) -> ExactWave:
    """Return the solitary wave of masses 1 and m2 < 1, in the ratio of a pair of masses."""
    ratio = min(pair) / max(pair)
    special: list[ExactWave] = []
    with suppress(NoWave):  # smaller ratios may be unknown near k = 1
        for wave in special_waves(k):
            special.append(wave)
            if wave.omega < ratio:
                break
    near = min(special, key=lambda wave: abs(wave.omega / ratio - 1))
    if abs(near.omega / ratio - 1) < NEAR:
        return near
    seen = f"see resonances (nearest ratio {near.omega:.9g}) and sweep"
    raise NoWave("no solitary wave", pair, k, f": {seen}")
