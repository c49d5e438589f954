"""Exact solitary waves of the lattice: solutions of the equations of motion to rounding.

Waves are mirror symmetric about a bead of a dimer chain (`validation.waves.newton`). Newton's
method starts from the wave of the long-wave theory, or from a wave of near masses and k.

**Equal masses.** A solitary wave exists for every k (Friesecke & Wattis 1994; English & Pego 2005),
on a background strain p0 (a chain under load) too.

**Dimers.** A solitary wave leaves no strain T behind. This is one condition more than there are
unknowns, as amplitude and speed are tied by scaling: a dimer has solitary waves only at isolated
ratios m2/m1, the special ratios. There the light beads come to rest together with the heavy ones,
after one more full oscillation for each smaller ratio (Jayaprakash, Starosvetsky & Vakakis, Phys.
Rev. E 83, 036606, 2011). At any other ratio the chain has periodic waves with an oscillating tail
on both sides of the pulse, on which the light beads oscillate between the heavy ones for ever
(Betti & Pelinovsky, J. Nonlinear Sci. 23, 689 (2013)). A struck chain carries no such wave, as its
light beads are at rest before the pulse: its pulse is measured by `validation.pulses.steady`.

Newton's method solves T = 0 together with the equations of motion, with m2 as an unknown, and may
converge to any of the special ratios, so their order is secured as follows. All ratios are found at
k = 3/2: the first two as published, and each further one at the distance of the last two in
√(m1/m2), which is nearly constant. From there they are continued to k in steps that change √(m1/m2)
little. Below k = 1.3 the smaller ratios are lost on the way (measured: six are found from k = 1.3
on, five at 1.25, four at 1.2, three at 1.15, two at 1.1).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np
import scipy

from lwa import Cell, loaded_wave
from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.frozen import QUANTITIES, Estimate
from validation.scenes.checks import SceneError, between, integer, items
from validation.waves import newton
from validation.waves.newton import continued
from validation.waves.profile import ExactWave, at_unit_force

FALLEN = 38.0  # e-foldings of a wave on a background from its flanks to L
LIGHTEST = (
    1e-12  # background over the peak strain, at least: a lighter one does not show
)
SHALLOWEST = 1e-4  # rise of a wave on a background over the peak strain, at least
LESS = 0.125  # step of the background from wave to wave, at k > 3 on small backgrounds
STEEP = 3.0  # k above which the theory's wave is too wide to start from
FARTHEST = 2.0  # step in k from wave to wave above
NEAR = 1e-7  # relative difference from a special mass ratio: ratios are given in seven digits
ROUNDING = (
    1e-13  # relative error of a solitary wave's numbers: a strain's, over its slope
)
MOST = 6  # ratios at one k
HERTZ, PUBLISHED = 1.5, (0.3428, 0.1548)  # the first ratios at k = 3/2, as published
_CHANGE = (
    0.15  # change of √(m1/m2) in one step along k; neighbours differ by 0.2 or more
)


class NoWave(InputError):
    """Failure to find a wave; the message names the wave's parameters."""

    def __init__(
        self, text: str, masses: newton.Pair, k: float, more: str = ""
    ) -> None:
        super().__init__(
            f"{text} at k = {k:g}, masses {masses[0]:.10g}, {masses[1]:.10g}{more}"
        )


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
        raise SceneError(
            f"{len(given)} masses: exact waves are found for a cell of 1 or 2 beads"
        )
    k = between(k, "k", 1.01, 8, "exact waves are found for k from 1.01 to 8")
    wanted = f"0 or {LIGHTEST:g} … 1 - {SHALLOWEST:g} of the peak compression is wanted"
    p0 = between(background, "background", 0, 1 - SHALLOWEST, wanted)
    if p0:
        between(background, "background", LIGHTEST, 1, wanted)
    if given[0] == given[-1]:
        wave = _uniform(k, p0)
        return replace(wave, masses=(given[0], given[0]), c2=wave.c2 / given[0])
    if p0:
        raise SceneError(
            f"background is {p0:g}: under a load exact waves are for equal masses"
        )
    light, heavy = sorted(given)
    between(light / heavy, "ratio of the masses", 0.01, 1)
    wave = _dimer((given[0], given[1]), k)
    if given[0] == heavy:
        return replace(wave, masses=(heavy, heavy * wave.omega), c2=wave.c2 / heavy)
    # The mirror image, with b(ξ) for a(ξ): F_a = E + O and F_b = E - O.
    masses = light, light / wave.omega
    return replace(wave, masses=masses, c2=wave.c2 / masses[1], odd=-wave.odd)


def measured(wave: ExactWave) -> dict[str, Estimate]:
    """Return c², c and tail, and amplitude and FWHM of each of `QUANTITIES`, with errors."""
    values = {"c2": wave.c2, "c": wave.c}
    for name in QUANTITIES:
        values[f"amplitude {name}"] = wave.peak(name)[1]
        values[f"fwhm {name}"] = wave.fwhm(name)
    error = ROUNDING / (1 - wave.background) + wave.residual + wave.tail
    numbers = {name: Estimate(value, value * error) for name, value in values.items()}
    return numbers | {"tail": Estimate(wave.tail, error)}


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
    if (
        k > STEEP and p0 < 0.5
    ):  # the theory's wave is too wide: from the wave on a lower background
        lower = _uniform(k, max(0.0, p0 - LESS))
        force, c2 = lower.force(problem.xi), lower.c2
    else:
        force = newton.rise(theory.along(problem.xi, "strain"), k, p0)
        c2 = float(theory.speed) ** 2
    return _converged(problem, force, c2)


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


def solve(
    masses: newton.Pair,
    k: float,
    half_period: float | None = None,
    points: int | None = None,
    start: ExactWave | None = None,
    free: bool = False,
) -> ExactWave:
    """Return a wave of peak force 1, on whatever branch Newton's method reaches.

    half_period, points : the grid, see `newton.Problem`. start : a near wave, by default the
    theory's. free : True to solve for an m2 with a solitary wave.

    Raises `NoWave` if the method does not converge.
    """
    problem, (m1, m2) = newton.Problem(masses, k, half_period, points), masses
    if start is not None:
        force, c2 = start.force(problem.xi), start.c2 * sum(start.masses) / (m1 + m2)
    else:
        # The force cos^{2k/(k-1)}(βξ), and c² = 4/((k+1)(m1+m2)). The two contacts' forces are
        # shifted by (m2-m1)/(m1+m2), so that both beads move alike.
        beta = (k - 1) * np.sqrt(6 / (k * (k + 1))) / newton.widening(masses)
        phase = beta * (problem.xi - (m2 - m1) / (m1 + m2) / 2)
        force = np.cos(np.clip(phase, -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
        c2 = 4 / ((k + 1) * (m1 + m2))
    # c² of the wave scaled to force 1 at ξ = 0; `newton.Problem.wave` scales the forces.
    return _converged(problem, force, c2 * float(force[0]) ** ((1 - k) / k), free)


def _converged(
    problem: newton.Problem, force: Array, c2: float, free: bool = False
) -> ExactWave:
    """Return the wave that forces on the grid and c² converge to, see `solve`."""
    masses = problem.masses
    try:
        force, c2, inverse = problem.wave(force, c2, free)
    except np.linalg.LinAlgError:
        on = f" on {problem.p0:g}" if problem.p0 else ""
        raise NoWave(f"Newton's method finds no wave{on}", masses, problem.k) from None
    if free:
        masses = masses[0], 1 / inverse
    return at_unit_force(masses, problem, force, c2)


def resonances(k: Any, count: Any) -> tuple[ExactWave, ...]:
    """Return the solitary waves, m1 = 1, at the ``count`` largest special ratios ω = m2/m1 < 1.

    Raises `SceneError` for numbers out of range, `NoWave` for missing waves.
    """
    return tuple(islice(special_waves(k), integer(count, "count", 1, MOST)))


def special_waves(k: Any) -> Iterator[ExactWave]:
    """Yield the solitary waves, m1 = 1, at the `MOST` largest special ratios, the largest first.

    Raises `SceneError` for k out of range, `NoWave` for a ratio that is lost on the way to k.
    """
    # Nearer to k = 1 the strain T is lost in rounding.
    k = between(k, "k", 1.1, 5, "special mass ratios are found for k from 1.1 to 5")
    waves = [solve((1.0, ratio), HERTZ, free=True) for ratio in PUBLISHED]
    for i in range(MOST):
        if i == len(waves):
            waves.append(_next(*waves[-2:]))
        try:
            yield waves[i] if waves[i].k == k else _followed(waves[i], k)
        except NoWave:
            lost = f"special ratio number {i + 1} is lost on the way from k = 3/2 and is not known"
            raise NoWave(lost, waves[i].masses, k) from None


def _root(wave: ExactWave) -> float:
    """Return √(m1/m2), to which the frequency of the light beads is proportional."""
    return math.sqrt(1 / wave.omega)


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """Continue a solitary wave and its special mass ratio to another exponent k."""
    end = math.log(k - 1)

    def at(e: float, path: Sequence[tuple[float, ExactWave]]) -> ExactWave:
        """Return the wave at ln(k - 1) = e; raise `NoWave` if √(m1/m2) is far from extrapolated."""
        (e1, older), (e2, last) = path[0], path[-1]
        expected, bound = 0.0, _CHANGE
        if len(path) > 1:
            expected = (_root(last) - _root(older)) / (e2 - e1) * (e - e2)
            bound = 0.02 + 0.2 * abs(expected)
        ratio = (_root(last) + expected) ** -2
        exponent = (
            k if e == end else 1 + math.exp(e)
        )  # k itself at the end, without rounding
        following = solve((1.0, ratio), exponent, start=last, free=True)
        change = _root(following) - _root(last)
        if (
            following.solitary
            and abs(change) < _CHANGE
            and abs(change - expected) < bound
        ):
            return following
        raise NoWave(
            f"on the way to k = {k:g} the special ratio is lost", last.masses, last.k
        )

    return continued(wave, math.log(wave.k - 1), end, 0.1, at)


def _next(before: ExactWave, last: ExactWave) -> ExactWave:
    """Return the solitary wave at the next smaller ratio than those of two neighbouring waves."""
    step = _root(last) - _root(before)
    places = (_root(last) + step * np.arange(0.6, 1.35, 0.05)).tolist()
    first, end = places[0], places[-1]
    middle_first = sorted(places, key=lambda x: abs(x - (first + end) / 2))
    for root in middle_first:
        with suppress(NoWave):
            following = solve((1.0, root**-2), last.k, free=True)
            if following.solitary and first < _root(following) < end:
                return following
    limits = f"from {first**-2:.4g} down to {end**-2:.4g}"
    raise NoWave(
        f"{limits} the next special mass ratio is not found", last.masses, last.k
    )
