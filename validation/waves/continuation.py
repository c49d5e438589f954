"""From one traveling wave to the next: near a start, and along a path of parameters.

`solve` takes Newton's method from a near wave, which may end on another branch of waves than that
of its start. `follow` stays on the branch: a step counts when it changes the wave little and when
the same step taken back leads to the wave it came from; otherwise it is halved.
"""

from __future__ import annotations

import math

import numpy as np

from lwa.exact import InputError
from validation.scenes.checks import integer
from validation.waves import fourier
from validation.waves.fourier import Array, Problem
from validation.waves.profile import ExactWave, Profile, at_unit_force

CLOSE = 0.1
"""By how much c², the tail or the strain may change in one step along a branch, over c² or the
peak strain."""

HALVINGS = 7
"""Of a step, before a branch counts as lost."""


class NoWave(InputError):
    """Newton's method found no wave; the message names its parameters."""


def solve(
    masses: tuple[float, float],
    k: float,
    half_period: float | None = None,
    points: int | None = None,
    start: Profile | None = None,
    free: bool = False,
) -> ExactWave:
    """One wave, solved on a grid and scaled to a force 1 at its peak; free: m2 is to be found.

    Without a start Newton's method begins with the theory's wave. Raises `NoWave` where it fails.
    """
    problem = _problem(masses, k, half_period, points)
    guess = _guess(masses, k, problem.xi, start)
    try:
        if not free:
            return _wave(problem, masses, *problem.wave(*guess))
        z, c2, light = problem.ending(*guess)
    except np.linalg.LinAlgError:
        raise NoWave(named("Newton's method finds no wave", masses, k)) from None
    return _wave(problem, (masses[0], float(1 / light)), z, c2)


def kicked(
    masses: tuple[float, float], k: float, start: ExactWave | None = None
) -> tuple[ExactWave, float]:
    """The wave that a kick in the middle of its pulse keeps from having a tail, and the kick.

    It obeys the equations of motion but for the kick. Raises `NoWave` where Newton's method fails.
    """
    problem = _problem(masses, k, None, None)
    try:
        z, c2, kick = problem.kicked(*_guess(masses, k, problem.xi, start))
    except np.linalg.LinAlgError:
        raise NoWave(named("Newton's method finds no kicked wave", masses, k)) from None
    return _wave(problem, masses, z, c2), kick


def named(text: str, masses: tuple[float, float], k: float) -> str:
    """A message with the parameters."""
    return f"{text} at k = {k:g}, masses {masses[0]:g}, {masses[1]:g}"


def _problem(
    masses: tuple[float, float], k: float, half_period: float | None, points: int | None
) -> Problem:
    L = fourier.ample_half_period(masses, k) if half_period is None else half_period
    # Per site: the pulse's own Fourier width, its steeper flanks at large k, the light beads.
    beads = math.sqrt(sum(masses) / min(masses) - 1)
    dense = 3 + 9 * math.sqrt(k - 1) + 7 * max(k - 2, 0) + 1.5 * beads
    n = max(40, math.ceil(dense * L)) if points is None else integer(points, "points", 8, 2000)
    return Problem(masses, k, L, n)


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
        m1, m2 = masses
        beta = (k - 1) * math.sqrt(6 / (k * (k + 1))) / fourier.widening(masses)
        shift = (m2 - m1) / (m1 + m2) / 2
        a, b = (
            np.cos(np.clip(beta * (xi + side * shift), -np.pi / 2, np.pi / 2)) ** (2 * k / (k - 1))
            for side in (-1, 1)
        )
        c2 = 4 / ((k + 1) * (m1 + m2))
    E, O = (a + b) / 2, (a - b)[1:-1] / 2
    return np.append(E, O), c2 * float(E[0]) ** ((1 - k) / k)


def _wave(problem: Problem, masses: tuple[float, float], z: Array, c2: float) -> ExactWave:
    n = problem.n
    z = np.append(z, np.zeros(2 * n - len(z)))
    even, odd = fourier.coefficients(z[: n + 1], z[n + 1 :])
    return at_unit_force(masses, problem.k, c2, float(problem.xi[-1]), even, odd)


# --- along a path of parameters -------------------------------------------------------------


def follow(
    wave: ExactWave,
    masses: tuple[float, float],
    k: float,
    half_period: float | None = None,
    points: int | None = None,
) -> ExactWave:
    """The wave of these parameters on the branch of another one, at force 1.

    The way there is straight in k, the logarithms of the masses and L, of which a dimer's stays
    what it is unless one is given.

    Raises `NoWave` where the branch turns back or ends on the way.
    """
    begin = wave
    uniform = masses[0] == masses[1]
    longer = fourier.ample_half_period(masses, k)
    L = half_period or (longer if uniform else max(wave.half_period, longer))

    def at(t: float) -> tuple[tuple[float, float], float, float]:
        one, two = (
            a * (b / a) ** t if t < 1 else b for a, b in zip(begin.masses, masses, strict=True)
        )
        return (
            (one, two),
            begin.k + t * (k - begin.k) if t < 1 else k,
            begin.half_period + t * (L - begin.half_period),
        )

    done, step = 0.0, 1.0
    while done < 1:
        to = min(1.0, done + step)
        try:
            found = solve(*at(to), points if to == 1 else None, wave)
            kept = _close(found, wave) and _same(solve(*at(done), None, found), wave)
        except NoWave:
            kept = False
        if kept:
            wave, done, step = found, to, 2 * step
        else:
            step = (to - done) / 2
            if step < 0.5**HALVINGS:
                (one, two), there, _ = at(done)
                raise NoWave(named("the branch of waves turns back or ends", (one, two), there))
    return wave


def _close(wave: ExactWave, other: ExactWave) -> bool:
    """Whether a step from one to the other is small; c² in units of the theory's."""
    a, b = (w.c2 * sum(w.masses) * (w.k + 1) for w in (wave, other))
    return abs(a / b - 1) < CLOSE and _apart(wave, other) < CLOSE


def _same(wave: ExactWave, other: ExactWave) -> bool:
    """Whether two waves of the same parameters are one, as far as their residuals can tell."""
    return _apart(wave, other) < 1e-6 + 10 * max(wave.residual, other.residual)


def _apart(wave: ExactWave, other: ExactWave) -> float:
    """The largest difference of the two strains, which holds that of the tails."""
    L = min(wave.half_period, other.half_period)
    xi = np.linspace(-L, L, 401)
    return float(np.abs(wave.strain(xi) - other.strain(xi)).max())
