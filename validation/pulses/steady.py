"""The steady pulse of a dimer chain: its width, its speed and its decay, at one k and one ω.

Bead 0 of a chain of masses 1, ω, 1, … at rest is struck (A = D = 1), and the pulse recorded at
`PLACES` cells, equally far from each other. As F = A δ^k has no scale of its own, a
pulse that leaves something behind in every cell comes to lose the same share of its force F in
each, F ~ e^{-d n} after n sites, and is similar to itself ever after: its speed goes as
F^{(k-1)/(2k)} and its width, in sites, does not change. From one place to the next, N sites on,

    decay  d = ln(F_1/F_2) / N,
    speed  c = N (e^z - 1) / (z T F_1^q),   q = (k-1)/(2k),  z = q d N,

T the time between the two peaks: c is the speed at contact force 1, exactly so for a pulse whose
speed is c F^q all the way. Widths are times at a contact times the speed there. Every number is
the mean over the two contacts of a cell, on that stretch where its error is least.

A number x_n of stretch n differs from its limit by what the pulse has yet to shed. Its error is
the largest of |x_n - x_{n-1}|, |x_n - x_{n-2}| and the difference from a less accurate run, and on
top of it what the differences add up to if they go on to shrink as they do: δ r / (1 - r), δ the
last one, r its ratio to the one before, of which 0.9 is the most that is believed.

The leading pulse ends at a contact where the compression first falls to a quarter of its highest
so far. Between special mass ratios the force has several humps, as the light bead hits to and fro;
a width is that of the highest, so that it jumps where the dip before another hump passes half.
Where a pulse decays fast, another may overtake it (k ≥ 3/2, ω from 0.53 to 0.65). The errors say
nothing of the other one: numbers are those of the pulse that leads at the `Point.sites`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
import sympy as sp

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.lattice.run import IntegrationError, Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import FEWEST, FORGOTTEN, Measured, MeasureError, read
from validation.scenes.chains import struck

QUANTITIES = {  # what is measured, and what it is called
    "width": "FWHM of the contact force (sites)",
    "strain_width": "FWHM of the contact strain (sites)",
    "speed": "speed at contact force 1 (sites/time)",
    "decay": "decay of the peak force per site",
}
PLACES = 10  # cells at which the pulse is recorded
STRETCH = 4  # cells from one to the next, for k from 3/2 on, unless a sweep sets another number
TOLERANCES = (1e-6, 1e-5)  # of the run that counts and of the one that gives its error
_SAMPLES = 40.0  # per unit of time, in the run that counts, at k ≤ 3/2 and ω from 1/4 to 1
_GROWTH, _LONGEST = 1.6, 16  # by how much, and how often, a run is made longer, at most
_SLOWEST = 0.9  # ratio of two differences, next to 1 of which nothing can be said of their sum


@dataclass(frozen=True)
class Point:
    """What one k and ω gave: `QUANTITIES` by name, or the reason why there are none; and the sites
    (beads from the struck one) at both ends of the stretch that was measured."""

    k: sp.Rational
    omega: sp.Rational
    sites: tuple[int, int] | None
    numbers: Mapping[str, Measured]
    missing: str | None = None


def cells_apart(k: float, stretch: int) -> int:
    """Cells from one place to the next: as k → 1 a pulse needs longer to leave its wake behind.

    >>> [cells_apart(k, 4) for k in (3, 1.5, 1.1)]
    [4, 4, 30]
    """
    return math.ceil(stretch * max(1.0, math.pow(2 * (k - 1), -1.25)))


def point(k: sp.Rational, omega: sp.Rational, stretch: int) -> Point:
    """Strike the chain and measure its pulse; what cannot be measured, the point itself tells."""
    try:
        return _point(k, omega, stretch)
    except (InputError, IntegrationError, ArithmeticError) as error:
        return Point(k, omega, None, {}, str(error) or type(error).__name__)


def _point(k: sp.Rational, omega: sp.Rational, stretch: int) -> Point:
    chain = Chain(float(k), float(omega), 2 * cells_apart(float(k), stretch))
    rtol, less = TOLERANCES
    rough = chain.passed(chain.crossing, less, _SAMPLES / 2)
    fine = chain.passed(1.01 * rough.until, rtol, _SAMPLES)
    numbers, check = chain.numbers(fine), chain.numbers(rough)
    errors = np.maximum(_unsettled(numbers), np.abs(numbers - check)[:, 2:])
    # Relatively; of the force where it is its decay.
    worst = np.vstack((errors[:3] / numbers[:3, 2:], chain.sites * errors[3])).max(axis=0)
    if np.isnan(worst).all():
        raise MeasureError("the pulse does not arrive later at each place than at the one before")
    best = int(np.nanargmin(worst))
    place, values = chain.sites * (best + 3), numbers[:, best + 2]
    measured = map(Measured, values.tolist(), (values + errors[:, best]).tolist())
    sites = place, place + chain.sites
    return Point(k, omega, sites, dict(zip(QUANTITIES, measured, strict=True)))


def _unsettled(numbers: Array) -> Array:
    """How far each stretch's numbers, from the third one on, may be from what they settle at."""
    steps = np.abs(np.diff(numbers))
    last, before = steps[:, 1:], steps[:, :-1]
    ratio = np.minimum(last / np.where(before > 0, before, np.inf), _SLOWEST)
    seen = np.maximum(last, np.abs(numbers[:, 2:] - numbers[:, :-2]))
    return np.asarray(seen + last * ratio / (1 - ratio))


class Record(NamedTuple):
    """A run, the pulse's part of each contact's record, and how long it has to be."""

    run: Run
    parts: tuple[slice, ...]
    until: float


@dataclass(frozen=True)
class Chain:
    """A dimer chain whose first bead is struck, with so many sites from place to place."""

    k: float
    omega: float
    sites: int

    @property
    def crossing(self) -> float:
        """A pulse's of force 1, by the long-wave speed 2/√((k+1)(1+ω)), and half as long again."""
        return 0.75 * self.sites * PLACES * math.sqrt((self.k + 1) * (1 + self.omega))

    def passed(self, duration: float, rtol: float, samples: float = _SAMPLES) -> Record:
        """A run of this duration, or longer, with ``samples`` per unit of time, more where hits are
        shorter. Raises `MeasureError` where the pulse does not come through."""
        units = min(1.0, 4 * self.omega) * max(1.0, self.omega)
        samples *= max(1.0, self.k / 1.5) / math.sqrt(units)
        last = self.sites * PLACES
        places = range(self.sites, last + 1, self.sites)
        sensors = tuple(place + side for place in places for side in (0, 1))
        for _ in range(_LONGEST):
            scene = struck(
                (1.0, self.omega),
                last + 12,
                self.k,
                contact_sensors=sensors,
                duration=duration,
                samples=math.ceil(samples * duration),
            )
            run = simulate(scene, rtol=rtol)
            parts = tuple(leading_pulse(force, self.k) for force in run.contact_force)
            # One place's time more, lest the front of a pulse yet to come be taken for it.
            until = (1 + 1 / PLACES) * float(run.time[max(part.stop for part in parts) - 1])
            if until <= duration:
                return Record(run, parts, until)
            duration *= _GROWTH
        end = duration / _GROWTH
        raise MeasureError(f"the pulse has not passed {last} sites by t = {end:.3g}")

    def numbers(self, record: Record) -> Array:
        """`QUANTITIES` (rows) of each stretch; NaN where the pulse does not arrive later."""
        time, force = record.run.time, record.run.contact_force
        pulses = [f[part] for f, part in zip(force, record.parts, strict=True)]
        tops = np.array([part.start for part in record.parts]) + list(map(np.argmax, pulses))
        # As far as where the longest one has half of its strain, and where a spline forgets.
        high = max(np.count_nonzero(f > f.max() / 2**self.k) for f in pulses)
        step, reach = time[1], high + FORGOTTEN
        near = np.arange(-reach, reach + 1)
        places = np.clip(tops[:, None] + near, 0, len(time) - 1)
        rows = np.take_along_axis(force, places, axis=1)
        rows = np.concatenate((rows, rows ** (1 / self.k)))
        found = read(step * near, rows, np.full(len(rows), reach))
        # Places down, contacts of a cell across.
        arrival, peak, rise, back = (x.reshape(2, PLACES, 2) for x in found)
        width, strain_width = widths = back - rise
        if not (widths > FEWEST * step).all():
            few = f"at least {FEWEST} samples above half of its peak"
            raise MeasureError(f"the pulse is not wholly in the record, with {few}")
        arrival, peak = arrival[0] + time[tops].reshape(PLACES, 2), peak[0]
        elapsed, fall = np.diff(arrival, axis=0), -np.diff(np.log(peak), axis=0)
        elapsed[elapsed <= 0] = np.nan
        q = (self.k - 1) / (2 * self.k)
        speed = self.sites * scipy.special.exprel(q * fall) / (elapsed * peak[:-1] ** q)
        here = speed * peak[1:] ** q
        numbers = (width[1:] * here, strain_width[1:] * here, speed, fall / self.sites)
        return np.asarray(np.mean(numbers, axis=2))


def leading_pulse(force: Array, k: float) -> slice:
    """Where the leading pulse is in a contact's record, at most to its end, with as much before."""
    quarter = 0.25**k  # of the compression
    start = int(np.argmax(force > quarter * force.max()))
    relieved = force[start:] < quarter * np.maximum.accumulate(force[start:])
    length = int(np.argmax(relieved)) + 1 if relieved.any() else len(force) - start
    return slice(max(0, start - length), start + length)
