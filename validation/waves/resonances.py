"""Solutions of the wave equations by Newton's method, and the mass ratios of solitary waves.

Newton's method starts from the wave of the long-wave theory, or from a wave of near masses and k.
A dimer's solution may have a tail (`validation.waves.newton`); with m2 among the unknowns the tail
is 0 and the solution is a solitary wave.

At these special ratios m2/m1 the light beads come to rest together with the heavy ones, after one
more full oscillation for each smaller ratio (Jayaprakash, Starosvetsky & Vakakis, Phys. Rev. E 83,
036606, 2011); at other ratios they keep oscillating behind the pulse. The ratios are zeros of the
strain T left behind by a wave (`validation.waves.newton`); Newton's method solves T = 0 together
with the equations of motion, with m2/m1 as an unknown.

Newton's method may converge to any of the ratios, so their order is secured as follows. All ratios
are found at k = 3/2: the first two as published, and each further one at the distance of the last
two in √(m1/m2), which is nearly constant. From there they are continued to k in steps that change
√(m1/m2) little. Below k = 1.3 the smaller ratios are lost on the way (measured: six are found from
k = 1.3 on, five at 1.25, four at 1.2, three at 1.15, two at 1.1).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.scenes.checks import between, integer
from validation.waves import newton
from validation.waves.newton import continued
from validation.waves.profile import ExactWave, at_unit_force

Start = tuple[Array, float]
"""Forces F_a on the grid of a `validation.waves.newton.Problem`, and c²."""


class NoWave(InputError):
    """Failure to find a wave; the message names the wave's parameters."""

    def __init__(self, text: str, masses: newton.Pair, k: float, more: str = "") -> None:
        super().__init__(f"{text} at k = {k:g}, masses {masses[0]:.10g}, {masses[1]:.10g}{more}")


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
    problem = newton.Problem(masses, k, half_period, points)
    return converged(problem, initial(problem, start), free)


def initial(problem: newton.Problem, wave: ExactWave | None = None) -> Start:
    """Return forces and c² to start from: those of a wave of near masses and k, or the theory's."""
    k, (m1, m2) = problem.k, problem.masses
    if wave is not None:
        force, c2 = wave.force(problem.xi), wave.c2 * sum(wave.masses) / (m1 + m2)
    else:
        # The force cos^{2k/(k-1)}(βξ), and c² = 4/((k+1)(m1+m2)). The two contacts' forces are
        # shifted by (m2-m1)/(m1+m2), so that both beads move alike.
        beta = (k - 1) * np.sqrt(6 / (k * (k + 1))) / newton.widening(problem.masses)
        phase = beta * (problem.xi - (m2 - m1) / (m1 + m2) / 2)
        force = np.cos(np.clip(phase, -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
        c2 = 4 / ((k + 1) * (m1 + m2))
    # c² of the wave scaled to force 1 at ξ = 0; `newton.Problem.wave` scales the forces.
    return force, c2 * float(force[0]) ** ((1 - k) / k)


def converged(problem: newton.Problem, start: Start, free: bool = False) -> ExactWave:
    """Return the wave that a start converges to; with ``free`` the one at a solitary wave's m2."""
    masses = problem.masses
    try:
        forces, c2, inverse = problem.wave(*start, free)
    except np.linalg.LinAlgError:
        on = f" on {problem.p0:g}" if problem.p0 else ""
        raise NoWave(f"Newton's method finds no wave{on}", masses, problem.k) from None
    if free:
        masses = masses[0], 1 / inverse
    return at_unit_force(masses, problem, forces, c2)


MOST = 6  # ratios at one k
HERTZ, PUBLISHED = 1.5, (0.3428, 0.1548)  # the first ratios at k = 3/2, as published
_FARTHEST = 0.15  # change of √(m1/m2) in one step along k; neighbours differ by 0.2 or more


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
        expected, bound = 0.0, _FARTHEST
        if len(path) > 1:
            expected = (_root(last) - _root(older)) / (e2 - e1) * (e - e2)
            bound = 0.02 + 0.2 * abs(expected)
        ratio = (_root(last) + expected) ** -2
        exponent = k if e == end else 1 + math.exp(e)  # k itself at the end, without rounding
        following = solve((1.0, ratio), exponent, start=last, free=True)
        change = _root(following) - _root(last)
        if following.solitary and abs(change) < _FARTHEST and abs(change - expected) < bound:
            return following
        raise NoWave(f"on the way to k = {k:g} the special ratio is lost", last.masses, last.k)

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
    raise NoWave(f"{limits} the next special mass ratio is not found", last.masses, last.k)
