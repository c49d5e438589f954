"""Pulses at the sensors of a scene: arrival, peak force, FWHM, and the speed between sensors.

Forces are dynamic: the static force of gravity and precompression is subtracted. Every number of a
recording is measured in two runs, the second with a tolerance `LESS` times as large; the error is
the difference, and at least the tolerance of the first run. Where a hump of about half the record's
maximum precedes the first pulse, or is it, another run may take the other one: the error is then
the distance between them (`first_numbers`).
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from validation.lattice.cost import RunProgress, silent
from validation.lattice.equations import Motion
from validation.lattice.result import Run
from validation.lattice.simulate import COMPILED, twice
from validation.pulses.pulse import (
    MeasureError,
    Pulse,
    all_pulses,
    compared,
    first_pulse,
    first_pulses,
    highest_pulse,
    speed,
)
from validation.pulses.signals import Piecewise, Signal, spline
from validation.scenes.checks import SceneError, between
from validation.scenes.scene import Scene

TOLERANCE = 1e-10  # default tolerance of the accurate run
LESS = 10.0  # tolerance of the less accurate run over that of the accurate one
_ROUNDING = 10  # rounding of the static compression over rtol; with more, steps follow the noise
_UNSURE = 1e-4  # of half the maximum; two of 9,936 arrivals under load depend on its sixth digit
READINGS = ("arrival", "peak", "fwhm")  # names of the numbers of a pulse
SPEEDS = ("speed_sites", "speed")  # in sites per time, and in length per time


@dataclass(frozen=True)
class Reading:
    """Measured numbers of a pulse at a sensor, or its speeds between two sensors."""

    kind: str  # "bead" or "contact"
    places: tuple[int, ...]  # number of the sensor, or of both, counted from 1
    numbers: Mapping[
        str, Estimate
    ]  # `READINGS`, or `SPEEDS` (the second if there are spacings)
    static: float  # static force at the (first) sensor
    missing: str | None = None  # reason why there are no numbers
    pulse: int = 1  # number of the pulse at the sensor, counted from 1

    @property
    def name(self) -> str:
        """The kind and the places as text, such as bead 15 → 34."""
        return f"{self.kind} {' → '.join(map(str, self.places))}"


@dataclass(frozen=True, eq=False)
class Recording:
    """A run, the pulses at the sensors, and the speeds from each sensor to the next."""

    run: Run
    tracks: tuple[Track, ...]  # dynamic forces at the sensors
    sensors: tuple[Reading, ...]
    speeds: tuple[Reading, ...]


@dataclass(frozen=True, eq=False)
class Track:
    """The dynamic force at one sensor as a function of time."""

    kind: str  # "bead" or "contact"
    number: int  # of the bead or contact, counted from 1
    force: Signal
    place: Mapping[
        str, float
    ]  # along the chain in sites and in lengths, by the names `SPEEDS`
    static: float  # static force


def record(
    scene: Scene,
    *,
    method: str = COMPILED[0],
    rtol: Any = TOLERANCE,
    every: bool = False,
    progress: RunProgress = silent,
) -> Recording:
    """Simulate a scene and measure the pulses at its sensors.

    rtol : relative tolerance, from 1e-13 to 1e-5. every : True for all pulses at each sensor
    instead of the first. Other options, and errors raised, are those of `validation.simulate`.
    Raises `SceneError` where rounding hides the motion at this tolerance.
    """
    rtol = between(rtol, "rtol", 1e-13, 1e-5)
    motion = Motion(scene)
    if (lost := motion.scales.rounding) > _ROUNDING * rtol:
        raise SceneError(
            f"rtol is {rtol:g}: rounding of the static compression, {motion.rest.max():.1g}, takes "
            f"{lost:.1g} of the motion; {lost / _ROUNDING:.1g} or more is wanted"
        )
    run, check = twice(scene, rtol, LESS * rtol, method=method, progress=progress)
    pairs = tuple(zip(tracks(run, 1), tracks(check, 2), strict=True))
    firsts = [next(_readings(pair, False, rtol)) for pair in pairs]
    fine = tuple(track for track, _ in pairs)
    # Errors of both arrivals are added: in the less accurate speed they may cancel.
    speeds = speeds_between(firsts, [track.place for track in fine], operator.add)
    found = (reading for pair in pairs for reading in _readings(pair, True, rtol))
    return Recording(run, fine, tuple(found if every else firsts), speeds)


def tracks(run: Run, every: int = 1) -> tuple[Track, ...]:
    """Return the dynamic forces at the sensors of a run; beads first.

    If the motion of a run takes too much memory, the forces are splines through the samples, or
    through every other sample (``every=2``).
    """
    scene, at_rest = run.scene, static_forces(run.scene)
    # A contact is midway between its beads, the wall's half a spacing behind the last bead.
    x = np.cumsum((0.0, *scene.spacings, *scene.spacings[-1:]))

    def track(kind: str, i: int, site: float, samples: Array) -> Track:
        static = at_rest[f"{kind} {i + 1}"]
        length = [float(np.interp(site, range(len(x)), x))] if scene.spacings else []
        place = dict(zip(SPEEDS, (site, *length), strict=False))
        force: Signal = (
            spline(run.time[::every], samples[::every])
            if run.path is None
            else run.signal(kind, i)
        )
        dynamic: Signal = (
            Piecewise(force.times, lambda t: force(t) - static) if static else force
        )
        return Track(kind, i + 1, dynamic, place, static)

    beads = zip(scene.bead_sensors, run.bead_force, strict=True)
    contacts = zip(scene.contact_sensors, run.contact_force, strict=True)
    return (
        *(track("bead", i, i, force) for i, force in beads),
        *(track("contact", i, i + 0.5, force) for i, force in contacts),
    )


def static_forces(scene: Scene) -> dict[str, float]:
    """Return the static forces at the sensors of a scene, by names such as "bead 15"."""
    load = np.zeros(
        scene.size + 1
    )  # of the contacts on the left and right of the beads
    load[1 : scene.contact_count + 1] = scene.load
    beads = {
        f"bead {i + 1}": float(load[i] + load[i + 1]) / 2 for i in scene.bead_sensors
    }
    return beads | {
        f"contact {i + 1}": float(load[i + 1]) for i in scene.contact_sensors
    }


def _readings(pair: tuple[Track, Track], every: bool, rtol: float) -> Iterator[Reading]:
    """Measure the first pulse at a sensor, or every pulse that is in both runs."""
    fine, coarse = pair
    reading = partial(Reading, fine.kind, (fine.number,), static=fine.static)
    try:
        if every:
            both = zip(all_pulses(fine.force), all_pulses(coarse.force), strict=False)
            found = [compared(readings, *same, rtol) for same in both]
        else:
            found = [first_numbers(fine.force, coarse.force, rtol)]
    except MeasureError as error:
        yield reading({}, missing=str(error))
        return
    for number, numbers in enumerate(found, start=1):
        yield reading(numbers, pulse=number)


def first_numbers(fine: Signal, coarse: Signal, rtol: float) -> dict[str, Estimate]:
    """Return `READINGS` of the first pulse, with errors from a less accurate signal.

    The first pulse is the first one above half the maximum. The less accurate signal is also
    searched a little below and above half, and the largest difference is the error.
    rtol : least relative error. Raises `MeasureError`.
    """
    first = first_pulse(fine)
    shares = [(1 + part) / 2 for part in (-_UNSURE, 0.0, _UNSURE)]
    found = [
        compared(readings, first, check, rtol) for check in first_pulses(coarse, shares)
    ]
    return {
        name: max((f[name] for f in found), key=lambda n: n.error) for name in READINGS
    }


def readings(pulse: Pulse) -> dict[str, float]:
    """Return the numbers of a pulse by the names `READINGS`."""
    return {name: getattr(pulse, name) for name in READINGS}


def speeds_between(
    sensors: Sequence[Reading],
    places: Sequence[Mapping[str, float]],
    total: Callable[[float, float], float],
) -> tuple[Reading, ...]:
    """Return the speeds of the pulse from each sensor to the next one of its kind.

    places : of the sensors along the chain, by the names `SPEEDS`. total : error of a time between
    two arrivals as a function of the errors of both.
    """

    def leg(first: Reading, second: Reading, distances: Mapping[str, float]) -> Reading:
        reading = partial(
            Reading, first.kind, (*first.places, *second.places), static=first.static
        )
        if first.missing or second.missing:
            return reading({}, missing="one of the two has no pulse")
        start, end = first.numbers["arrival"], second.numbers["arrival"]
        if not (time := end.value - start.value) > 0:
            return reading({}, missing="a speed needs a later second arrival")
        error = total(start.error, end.error) / time
        speeds = {name: distance / time for name, distance in distances.items()}
        return reading({name: Estimate(V, V * error) for name, V in speeds.items()})

    return tuple(
        leg(one, other, {name: abs(there[name] - at[name]) for name in at})
        for (one, at), (other, there) in pairwise(zip(sensors, places, strict=True))
        if one.kind == other.kind
    )


def echoes(
    sensors: Sequence[Reading], total: Callable[[float, float], float]
) -> list[tuple[Reading, bool]]:
    """Return the later pulses at sensors: delay behind the first pulse, and peak over its peak.

    total : error of a delay or a ratio as a function of the errors of both pulses.

    With each pulse comes whether it is reflected: whether it reaches this sensor and another one of
    the kind in the reverse order of the first pulse, or no other sensor tells.
    """
    found = {(r.kind, r.places, r.pulse): r for r in sensors}
    later = []
    for r in sensors:
        first = found[r.kind, r.places, 1]
        if r.pulse == 1:
            continue
        if r.missing:
            later.append((r, False))
            continue
        at, start = r.numbers["arrival"], first.numbers["arrival"]
        ratio = r.numbers["peak"].value / first.numbers["peak"].value
        error = total(*(one.numbers["peak"].relative_error for one in (r, first)))
        delay = at.value - start.value
        delays = {
            "delay": Estimate(delay, total(at.error, start.error)),
            "ratio": Estimate(ratio, ratio * error),
        }
        reflected = True
        for other in sensors:
            if (
                (other.kind, other.pulse) == (r.kind, r.pulse)
                and other is not r
                and other.numbers
            ):
                ahead = (
                    found[other.kind, other.places, 1].numbers["arrival"].value
                    - start.value
                )
                reflected = ahead * (other.numbers["arrival"].value - at.value) < 0
        later.append((replace(r, numbers=delays), reflected))
    return later


@dataclass(frozen=True)
class Train:
    """A pulse at several beads or contacts: ``pulses`` of dynamic force by number, from 1."""

    pulses: Mapping[int, Pulse]
    spacing: float  # of neighbours

    @classmethod
    def of(cls, run: Run, kind: str = "bead") -> Train:
        """Measure the pulses at the "bead" or "contact" sensors of a run, before the wall's echo.

        The last contact sensor must be the wall's, and all spacings equal. Raises `MeasureError`.
        """
        end = float(run.time[np.argmax(run.contact_force[-1])])
        pulses = {}
        for track in tracks(run)[:-1]:
            if track.kind == kind:
                try:
                    pulses[track.number] = highest_pulse(track.force, end)
                except MeasureError as error:
                    place = f"{kind} {track.number}, before the wave reaches the wall"
                    raise MeasureError(f"{place}: {error}") from None
        return cls(pulses, run.scene.spacings[0])

    def only(self, wanted: Container[int]) -> Train:
        """Return the train of the pulses with the wanted numbers."""
        chosen = {
            number: pulse for number, pulse in self.pulses.items() if number in wanted
        }
        return replace(self, pulses=chosen)

    @property
    def speed(self) -> float:
        """Speed of the pulse from the first sensor to the last, a length per time."""
        first, last = min(self.pulses), max(self.pulses)
        return speed(
            self.pulses[first], self.pulses[last], (last - first) * self.spacing
        )

    @property
    def peak(self) -> float:
        """Mean peak force."""
        return float(np.mean([pulse.peak for pulse in self.pulses.values()]))

    @property
    def fwhm(self) -> float:
        """Mean FWHM, a time."""
        return float(np.mean([pulse.fwhm for pulse in self.pulses.values()]))
