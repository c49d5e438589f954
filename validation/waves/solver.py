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

Newton's method solves ``T = 0`` together with the equations of motion, with m2 as an unknown, and
may converge to any of the special ratios, so their order is secured as follows. All ratios are
found at ``k = 3/2``, from starts that lead to one after another. From there they are continued to
k in steps that change ``√(m1/m2)`` little. Below ``k = 1.3`` the smaller ratios are lost on the way
(measured: six are found from ``k = 1.3`` on, five at 1.25, four at 1.2, three at 1.15, two at 1.1).
"""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np

from lwa import Cell, loaded_wave
from lwa.base.exact import InputError
from validation.scenes.checks import SceneError, between, integer, items
from validation.waves import newton
from validation.waves.newton import SpecialRatio
from validation.waves.profile import ExactWave, at_unit_force

# e-foldings of a wave on a background from its flanks to L: e^-38 is 3e-17
FALLEN = 38.0
LIGHTEST = 1e-12  # background over peak strain, at least: a lighter one does not show
SHALLOWEST = 1e-4  # rise of a wave on a background over the peak strain, at least
# The theory's wave is too wide to start from above this k. There the wave at this k is near enough
# (tried from k = 3.2 to 60, and to 8 under load), on a background below HIGH, a share of the peak
# strain; on higher ones the theory's is.
STEEP = 3.0
HIGH = 0.5
STEEPEST = 60.0  # largest k: 1200 points take a second there
STEEPEST_LOADED = 8.0  # largest k on a background, where narrower waves were not tried
NEAR = 1e-7  # relative difference from a special mass ratio: ratios are given in seven digits
FOLLOWED = (1.15, 1.2, 1.25, 1.3)
"""Least k of the third to the sixth special ratio, measured: below, the strain T that tells a
ratio from its neighbours is lost in rounding."""
HERTZ = 1.5
# From the theory's wave of these ratios Newton's method reaches the six special ratios at k = 3/2
# (0.3428, 0.1548, 0.0901, … by Jayaprakash et al.). √(m1/m2) is 0.3 larger than theirs, and any
# value from 0.2 to 0.4 leads to the same ratios.
STARTS = (0.248, 0.1238, 0.0758, 0.0533, 0.0401, 0.0309)
# One step of ln(k - 1) changes √(m1/m2) by up to 6 % (the sixth ratio, k near 1.3), and neighbours
# differ by 11 % or more there: a change below 4 % is that of the ratio itself. Measured at 21 k
# from 1.1 to 5, all ratios; with 0.3 and 5 % two waves were those of neighbours.
_FARTHEST = 0.175
# Above k = 3/2 ratios change less: at k from 1.7 to 5 all six are the same by either step.
_FARTHEST_STEEP = 0.36
_NEARER = 0.04
_SHORTEST = 1e-3  # a wave that a shorter step does not reach is lost
_EQUAL = (1.0, 1.0)


class NoWave(InputError):
    """Failure to find a wave; the message names the wave's parameters."""


def _parameters(masses: newton.Pair, k: float) -> str:
    """The parameters of a wave in a message."""
    m1, m2 = masses
    return f"at k = {k:g}, masses {m1:.10g}, {m2:.10g}"


def exact_wave(masses: Sequence[Any], k: Any, *, background: Any = 0) -> ExactWave:
    """Return the solitary wave of peak contact force 1.

    Parameters
    ----------
    masses : sequence
        m1, or m1 and m2. A ratio m2/m1 within 1e-7 of a special ratio counts as that ratio, and the
        wave has its masses: m1 and the special m2.
    k : float
        Exponent of the force, from 1.01 to 60; with a background to 8; for unequal masses from 1.1
        to 5.
    background : float
        p0, for one mass only, in units of the peak compression of the contacts. The peak force, the
        static force included, is 1.

    Returns
    -------
    ExactWave

    Raises
    ------
    SceneError
        For parameters out of range.
    NoWave
        At a mass ratio without a solitary wave; the message has the nearest special ratio.

    Examples
    --------
    >>> wave = exact_wave([1], 1.5)
    >>> round(wave.fwhm("force"), 6), round(wave.fwhm("strain"), 6), wave.solitary
    (1.411928, 1.725713, True)
    """
    # Squares and inverses of masses within these limits are floats.
    given = [between(m, "masses", 1e-100, 1e100) for m in items(masses, "masses")]
    if len(given) not in (1, 2):
        raise SceneError(
            f"{len(given)} masses: exact waves are found for cells of 1 or 2 beads; others are "
            "simulated, see lwa-validate run --example trimer",
            masses=tuple(given[:1]),
        )
    p0 = _background(background)
    most = STEEPEST
    where = ""
    if p0:
        most = STEEPEST_LOADED
        where = " on a background"
    wanted = f"exact waves are found for k from 1.01 to {most:g}{where}"
    k = between(k, "k", 1.01, most, wanted)
    if given[0] == given[-1]:
        wave = _equal(k, p0)
        mass = given[0]
        return replace(wave, masses=(mass, mass), c2=wave.c2 / mass)
    if p0:
        raise SceneError(
            f"background is {p0:g}: under a load exact waves are for equal masses"
        )
    light, heavy = sorted(given)
    ratio = "the ratio of two masses lies between 0.01 and 1"
    # Called for a refusal alone. The smallest special ratios that are found lie above 0.01.
    between(light / heavy, "masses", 0.01, 1, ratio)
    wave = _dimer((given[0], given[1]), k)
    if given[0] == heavy:
        light = heavy * wave.omega
        return replace(wave, masses=(heavy, light), c2=wave.c2 / heavy)
    heavy = light / wave.omega
    # The mirror image, with b(ξ) for a(ξ): F_a = E + O and F_b = E - O.
    mirrored = wave.series.conj()
    return replace(wave, masses=(light, heavy), c2=wave.c2 / heavy, series=mirrored)


def _background(value: Any) -> float:
    """Read a background strain over the peak strain."""
    wanted = f"0 or {LIGHTEST:g} … 1 - {SHALLOWEST:g} of the peak compression is wanted"
    p0 = between(value, "background", 0, 1 - SHALLOWEST, wanted)
    if 0 < p0 < LIGHTEST:
        raise SceneError(f"background is {p0:g}: {wanted}")
    return p0


def _equal(k: float, p0: float) -> ExactWave:
    """Return the wave of masses 1, 1 on a background, or on none."""
    problem = newton.Problem(_EQUAL, k)
    if p0:
        chain = Cell((1,), spacing=1)
        theory = loaded_wave(chain, rise=1 - p0, background=p0, k=k)
        # The wave ends as e^{-κ|ξ|} with c/c0 = sinh(κ/2)/(κ/2) ≤ e^{κ²/24}: κ is at least this.
        fast = float(theory.speed / theory.sound_speed)
        decay = math.sqrt(24 * math.log(fast))
        # Half of the L that a wave without a background needs, for the crest, and then the flank's
        # e-foldings
        L = max(problem.L, problem.L / 2 + FALLEN / decay)
        # `points_needed` gives as many points a site as the wave without a background needs. On a
        # background the wave is wider, and the points a site are fewer by the factor ``narrower``,
        # the width without a background over the width with it. 1.3 is a margin, and 80 points are
        # enough for the widest waves.
        bare = loaded_wave(chain, rise=1, background=0, k=k)
        narrower = float(bare.fwhm("strain") / theory.fwhm("strain"))
        points = newton.points_needed(_EQUAL, k, L) * min(1, 1.3 * narrower)
        n = max(80, math.ceil(points))
        problem = newton.Problem(_EQUAL, k, L, n, p0)
    # Three starts of Newton's method: the wave at a smaller k; without a background that of the
    # theory, which `solve` takes; on one the theory's wave on this background.
    if k > STEEP and p0 < HIGH:
        return solve(problem, _equal(STEEP, p0))
    if not p0:
        return solve(problem)
    force = newton.rise(theory.along(problem.xi, "strain"), k, p0)
    return _converged(problem, force, float(theory.speed) ** 2)


def _dimer(pair: newton.Pair, k: float) -> ExactWave:
    """Return the solitary wave of masses 1 and m2 < 1, in the ratio of a pair of masses."""
    ratio = min(pair) / max(pair)
    special = []
    for wave in special_waves(k):
        special.append(wave)
        if wave.omega < ratio:
            break
    near = min(special, key=lambda wave: abs(wave.omega / ratio - 1))
    if abs(near.omega / ratio - 1) < NEAR:
        return near
    # Nine digits are enough for `NEAR`.
    nearest = float(f"{near.omega:.9g}")
    heavy = max(pair)
    masses = tuple(mass if mass == heavy else heavy * nearest for mass in pair)
    raise NoWave(
        f"no solitary wave {_parameters(pair, k)}: the nearest ratio with one is {nearest:g} "
        f"(resonances); lwa-validate sweep --k {k:.10g} --omega {ratio:.10g} measures a pulse",
        masses=masses,  # of a valid call, which the command's message proposes
    )


def solve(problem: newton.Problem, start: ExactWave | None = None) -> ExactWave:
    """Return a wave of peak force 1, on whatever branch Newton's method reaches.

    Parameters
    ----------
    problem : newton.Problem
        Masses, exponent and grid; of a `newton.SpecialRatio` m2 is solved for.
    start : ExactWave, optional
        A near wave; by default the theory's.

    Raises
    ------
    NoWave
        If the method does not converge.
    """
    k = problem.k
    m1, m2 = problem.masses
    if start is not None:
        force = start.force(problem.xi)
        c2 = start.c2 * sum(start.masses) / (m1 + m2)
    else:
        # The wave of the long-wave theory at peak force 1: the force cos^{2k/(k-1)}(βξ), and
        # c² = 4/((k+1)(m1+m2)). β is (k-1) √(6/(k(k+1))) at equal masses, and at others smaller by
        # the factor by which the wave is wider. The forces F_a and F_b are shifted by
        # (m2-m1)/(m1+m2) against each other, each by half of it, so that both beads move alike.
        of_equal = (k - 1) * math.sqrt(6 / (k * (k + 1)))
        beta = of_equal / newton.widening(problem.masses)
        middle = (m2 - m1) / (m1 + m2) / 2
        phase = beta * (problem.xi - middle)
        quarter = np.pi / 2  # of a period: the arch ends there
        arch = np.cos(np.clip(phase, -quarter, quarter))
        force = arch ** (2 * k / (k - 1))
        c2 = 4 / ((k + 1) * (m1 + m2))
    # `newton.Problem.wave` divides the forces by this share. With the forces of a wave times f go
    # its strains times f^{1/k} and c² times f^{(k-1)/k}.
    share = force[0] / problem.height
    return _converged(problem, force, c2 * share ** ((1 - k) / k))


def _converged(problem: newton.Problem, force: Any, c2: float) -> ExactWave:
    """Return the wave of peak force 1 that forces on the grid and c² lead to, or raise `NoWave`."""
    try:
        found = problem.wave(force, c2)
    except np.linalg.LinAlgError:
        wave = _parameters(problem.masses, problem.k)
        on = f"background {problem.p0:g}"
        raise NoWave(f"Newton's method finds no wave {wave}, {on}") from None
    return at_unit_force(problem, found)


def resonances(k: Any, count: Any) -> tuple[ExactWave, ...]:
    """Return the solitary waves at the largest special mass ratios m2/m1 below 1; m1 is 1.

    Parameters
    ----------
    k : float
        Exponent, from 1.1 to 5.
    count : int
        Number of ratios, from 1 to 6.

    Raises
    ------
    SceneError
        For numbers out of range, and for more ratios than are found at k: six from 1.3 on, two at
        1.1 (`FOLLOWED`).
    """
    count = integer(count, "count", 1, len(STARTS))
    known = _known(k)
    if count > known:
        raise SceneError(
            f"count is {count}: at k = {k:g} the {known} largest special mass ratios are found",
            count=known,
        )
    return tuple(islice(special_waves(float(k)), count))


def _known(k: Any) -> int:
    """Number of the special ratios that are found at k."""
    # Nearer to k = 1 the strain T is lost in rounding.
    k = between(k, "k", 1.1, 5, "special mass ratios are found for k from 1.1 to 5")
    return len(STARTS) - len(FOLLOWED) + bisect(FOLLOWED, k)


def special_waves(k: float) -> Iterator[ExactWave]:
    """Yield the solitary waves at all special ratios that are found at k, the largest first.

    The mass m1 is 1. Raises `SceneError` for k out of range.
    """
    for start in STARTS[: _known(k)]:
        wave = solve(SpecialRatio((1.0, start), HERTZ))
        yield _followed(wave, k)


def _followed(wave: ExactWave, k: float) -> ExactWave:
    """Continue a solitary wave and its special mass ratio to another exponent k.

    A step that loses the wave, or leads to another ratio, is divided in two.
    """
    length = abs(math.log((k - 1) / (wave.k - 1)))
    farthest = _FARTHEST if k < HERTZ else _FARTHEST_STEEP
    if length < farthest:
        with suppress(NoWave):
            following = solve(SpecialRatio(wave.masses, k), wave)
            # The frequency of the light beads is proportional to √(m1/m2).
            faster = math.sqrt(wave.omega / following.omega)
            if following.solitary and abs(faster - 1) < _NEARER:
                return following
    if length < _SHORTEST:
        lost = _parameters(wave.masses, wave.k)
        raise NoWave(f"the special ratio is lost {lost}")
    # Half way in ln(k - 1)
    middle = 1 + math.sqrt((k - 1) * (wave.k - 1))
    return _followed(_followed(wave, middle), k)
