"""The steady pulse of a struck dimer chain: its width, speed and decay at one k and one ω.

Bead 0 of a chain of masses 1, ω, 1, … at rest is struck (A = D = 1), and the pulse is recorded at
`PLACES` cells at equal distances. F = A δ^k has no scale of its own. So a pulse that leaves
something behind in every cell comes to lose the same share of its force F in each cell,
F ~ e^{-d n} after n sites; its speed then goes as F^{(k-1)/(2k)}, and its width, in sites, stays
the same. Between two places, N sites apart, at which the peak forces are F_1 and F_2,

    decay  d = ln(F_1/F_2) / N,
    speed  c = N (e^z - 1) / (z T F_1^q),   q = (k-1)/(2k),  z = q d N,

T being the time between the peaks: c is the speed at contact force 1 of a pulse whose speed is
c F^q all the way. Widths are times at a contact times the speed there. All numbers are means over
the two contacts of a cell, from the stretch between two places where their errors are least.

The number x_n of stretch n still differs from its limit. Its error is the largest of
|x_n - x_{n-1}|, |x_n - x_{n-2}| and the difference to a less accurate run, plus the sum of all
further differences if they go on to shrink as the last two did: δ r / (1 - r), δ being the last
difference and r, at most 0.9, its ratio to the one before.

The leading pulse at a contact ends where the compression first falls to a quarter of its highest
value so far. Between special mass ratios the force has several humps, as the light bead hits to and
fro; a width is that of the highest hump, and jumps where the dip before another hump passes half.
Where a pulse decays fast, another pulse may overtake it (k ≥ 3/2, ω from 0.53 to 0.65): numbers are
those of the pulse that leads at `Point.sites`, and their errors do not cover the other pulse.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy
import sympy as sp

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.lattice.run import IntegrationError, Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import Measured, MeasureError, Pulse, leading_pulses
from validation.scenes.chains import struck

QUANTITIES = {  # measured numbers and their labels
    "width": "FWHM of the contact force (sites)",
    "strain_width": "FWHM of the contact strain (sites)",
    "speed": "speed at contact force 1 (sites/time)",
    "decay": "decay of the peak force per site",
}
HUMPS = """\
Between special mass ratios a contact's force may have several humps: a width is that of the highest
hump, and jumps where the dip before another hump passes half of the peak"""
PLACES = 10  # cells at which the pulse is recorded
STRETCH = 4  # default number of cells from one place to the next, for k ≥ 3/2
TOLERANCES = (1e-6, 1e-5)  # of the accurate run and of the one that gives its error
_GROWTH, _LONGEST = 1.6, 16  # factor by which, and times that, a run is made longer at most
_SLOWEST = 0.9  # largest ratio of two differences for which their sum is estimated


@dataclass(frozen=True)
class Point:
    """Measured numbers at one k and ω, or the reason why there are none.

    sites : beads from the struck one to both ends of the stretch of measurement. numbers : by the
    names of `QUANTITIES`. missing : the reason.
    """

    k: sp.Rational
    omega: sp.Rational
    sites: tuple[int, int] | None
    numbers: Mapping[str, Measured]
    missing: str | None = None


def cells_apart(k: float, stretch: int) -> int:
    """Number of cells between two places: as k → 1 a pulse leaves its wake behind more slowly.

    >>> [cells_apart(k, 4) for k in (3, 1.5, 1.1)]
    [4, 4, 30]
    """
    return math.ceil(stretch * max(1.0, math.pow(2 * (k - 1), -1.25)))


def point(k: sp.Rational, omega: sp.Rational, stretch: int) -> Point:
    """Strike the chain and measure its pulse; a failure is the ``missing`` of the point."""
    try:
        return _point(k, omega, stretch)
    except (InputError, IntegrationError, ArithmeticError) as error:
        return Point(k, omega, None, {}, str(error) or type(error).__name__)


def _point(k: sp.Rational, omega: sp.Rational, stretch: int) -> Point:
    chain = StruckDimer(float(k), float(omega), 2 * cells_apart(float(k), stretch))
    rtol, less = TOLERANCES
    rough = chain.passed(chain.crossing, less)
    fine = chain.passed(1.01 * rough.until, rtol)
    numbers, check = chain.numbers(fine), chain.numbers(rough)
    errors = np.maximum(unsettled(numbers), np.abs(numbers - check)[:, 2:])
    # Relative errors; for the decay, the error of the force after a stretch.
    worst = np.vstack((errors[:3] / numbers[:3, 2:], chain.sites * errors[3])).max(axis=0)
    if np.isnan(worst).all():
        raise MeasureError("the pulse does not arrive later at each place than at the one before")
    best = int(np.nanargmin(worst))
    place, values = chain.sites * (best + 3), numbers[:, best + 2]
    measured = map(Measured, values.tolist(), (values + errors[:, best]).tolist())
    sites = place, place + chain.sites
    return Point(k, omega, sites, dict(zip(QUANTITIES, measured, strict=True)))


def unsettled(numbers: Array) -> Array:
    """Distance of each stretch's numbers, from the third one on, to their limits; an estimate."""
    steps = np.abs(np.diff(numbers))
    last, before = steps[:, 1:], steps[:, :-1]
    ratio = np.minimum(last / np.where(before > 0, before, np.inf), _SLOWEST)
    seen = np.maximum(last, np.abs(numbers[:, 2:] - numbers[:, :-2]))
    return np.asarray(seen + last * ratio / (1 - ratio))


class Passage(NamedTuple):
    """A run, the leading pulse at each contact, and the time that the pulse needs.

    Each pulse is given twice: with its flanks at half of the force and at half of the compression.
    """

    run: Run
    pulses: list[list[Pulse]]
    until: float


@dataclass(frozen=True)
class StruckDimer:
    """A dimer chain of masses 1, ω whose first bead is struck.

    sites : number of sites from one place of measurement to the next.
    """

    k: float
    omega: float
    sites: int

    @property
    def crossing(self) -> float:
        """Time for a pulse of force 1 at the long-wave speed 2/√((k+1)(1+ω)), and half more."""
        return 0.75 * self.sites * PLACES * math.sqrt((self.k + 1) * (1 + self.omega))

    def passed(self, duration: float, rtol: float) -> Passage:
        """A run of this duration, or longer, in which the pulse passes all places.

        Raises `MeasureError` for a pulse that takes `_LONGEST` times too long.
        """
        last = self.sites * PLACES
        places = range(self.sites, last + 1, self.sites)
        sensors = tuple(place + side for place in places for side in (0, 1))
        chain = struck((1.0, self.omega), last + 12, self.k, contact_sensors=sensors, duration=1)
        for _ in range(_LONGEST):
            run = simulate(replace(chain, duration=duration, samples=2), rtol=rtol)
            signals = (run.signal("contact", i) for i in sensors)
            shares = (0.5, 0.5**self.k)  # half of the force, and half of the compression
            try:
                pulses = [leading_pulses(signal, self.k, shares) for signal in signals]
            except MeasureError:  # it has yet to come
                until = math.inf
            else:
                # A place's time more: the front of a later, slower pulse is no leading pulse.
                until = (1 + 1 / PLACES) * max(pulse.fall for pulse, _ in pulses)
            if until <= duration:
                return Passage(run, pulses, until)
            duration *= _GROWTH
        end = duration / _GROWTH
        raise MeasureError(f"the pulse has not passed {last} sites by t = {end:.3g}")

    def numbers(self, passage: Passage) -> Array:
        """`QUANTITIES` (rows) of each stretch; NaN where the pulse does not arrive later."""
        # Places down, contacts of a cell across.
        read = [(one.arrival, one.peak, one.fwhm, two.fwhm) for one, two in passage.pulses]
        arrival, peak, width, strain_width = np.array(read).T.reshape(4, PLACES, 2)
        elapsed, fall = np.diff(arrival, axis=0), -np.diff(np.log(peak), axis=0)
        elapsed[elapsed <= 0] = np.nan
        q = (self.k - 1) / (2 * self.k)
        speed = self.sites * scipy.special.exprel(q * fall) / (elapsed * peak[:-1] ** q)
        here = speed * peak[1:] ** q
        numbers = (width[1:] * here, strain_width[1:] * here, speed, fall / self.sites)
        return np.asarray(np.mean(numbers, axis=2))
