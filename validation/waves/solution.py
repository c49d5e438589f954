"""One solution of the wave equations: from a start, by Newton's method, at peak contact force 1.

Newton's method starts from the wave of the long-wave theory, or from a wave of near masses and k.
A dimer's solution may have a tail (`validation.waves.newton`); with m2 among the unknowns the tail
is 0 and the solution is a solitary wave.
"""

from __future__ import annotations

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.waves import newton
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
