"""Pulses at the sensors of a scene: arrival, peak force, FWHM, and the speed between sensors.

The first pulse at a sensor is the first time interval in which the force exceeds half its maximum,
so that an echo from the wall does not count. Forces are dynamic: the static force of gravity and
precompression is subtracted. Every number is measured in two runs, the second with a tolerance
`LESS` times as large; the error is the difference, and at least the tolerance of the first run.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.run import Run, RunProgress, silent
from validation.lattice.simulate import COMPILED, twice
from validation.pulses.pulse import (
    Measured,
    MeasureError,
    Pulse,
    all_pulses,
    compared,
    first_pulse,
    speed,
)
from validation.pulses.signals import Mapped, Sampled, Signal
from validation.scenes.checks import SceneError, between
from validation.scenes.scene import Scene

TOLERANCE = 1e-10  # default tolerance of the accurate run
LESS = 1e3  # tolerance of the less accurate run over that of the accurate one
_ROUNDING = 10  # rounding of the static compression over rtol; with more, steps follow the noise
READINGS = ("arrival", "peak", "fwhm")  # names of the numbers of a pulse
SPEEDS = ("speed_sites", "speed")  # in sites per time, and in length per time


@dataclass(frozen=True)
class Reading:
    """Measured numbers of a pulse at a sensor, or its speeds between two sensors.

    kind : "bead" or "contact". places : number of the sensor, or of both, counted from 1.
    numbers : `READINGS`, or `SPEEDS` (the second one if the scene has spacings).
    static : static force at the (first) sensor. missing : reason why there are no numbers.
    pulse : number of the pulse at the sensor, counted from 1.
    """

    kind: str
    places: tuple[int, ...]
    numbers: Mapping[str, Measured]
    static: float
    missing: str | None = None
    pulse: int = 1

    @property
    def name(self) -> str:
        """The kind and the places as text, such as bead 15 → 34."""
        return f"{self.kind} {' → '.join(map(str, self.places))}"


@dataclass(frozen=True, eq=False)
class Recording:
    """A run, the pulses at the sensors, and the speeds from each sensor to the next."""

    run: Run
    sensors: tuple[Reading, ...]
    speeds: tuple[Reading, ...]


@dataclass(frozen=True, eq=False)
class Track:
    """The dynamic force at one sensor as a function of time.

    number : number of the bead or contact, counted from 1. place : position along the chain in
    sites and in lengths, by the names `SPEEDS`. static : static force at the sensor.
    """

    kind: str
    number: int
    force: Signal
    place: Mapping[str, float]
    static: float

    @cached_property
    def pulse(self) -> Pulse:
        """Measure the first pulse; raises `MeasureError` without a pulse."""
        return first_pulse(self.force)

    @cached_property
    def train(self) -> list[Pulse]:
        """Measure all pulses; raises `MeasureError` without a pulse."""
        return all_pulses(self.force)


def record(
    scene: Scene,
    *,
    method: str = COMPILED[0],
    rtol: Any = TOLERANCE,
    every: bool = False,
    window: bool | int = False,
    progress: RunProgress = silent,
) -> Recording:
    """Simulate a scene and measure the pulses at its sensors.

    rtol : relative tolerance, from 1e-13 to 1e-5. every : all pulses at each sensor, not only the
    first. Other options are those of `validation.simulate`, which also says what is raised.
    Raises `SceneError` where rounding hides the motion at this tolerance.
    """
    rtol = between(rtol, "rtol", 1e-13, 1e-2 / LESS)
    motion = Motion(scene)
    if (lost := motion.scales.rounding) > _ROUNDING * rtol:
        raise SceneError(
            f"rtol is {rtol:g}: rounding of the static compression, {motion.rest.max():.1g}, takes "
            f"{lost:.1g} of the motion; {lost / _ROUNDING:.1g} or more is wanted"
        )
    options = {"method": method, "window": window, "progress": progress}
    run, check = twice(scene, rtol, LESS * rtol, **options)
    pairs = tuple(zip(tracks(run), tracks(check, every=2), strict=True))
    sensors = (_train(*pair, rtol) if every else [_reading(*pair, rtol)] for pair in pairs)
    neighbours = (two for two in pairwise(pairs) if two[0][0].kind == two[1][0].kind)
    return Recording(
        run,
        tuple(reading for train in sensors for reading in train),
        tuple(_speed(*two, rtol) for two in neighbours),
    )


def tracks(run: Run, every: int = 1) -> tuple[Track, ...]:
    """Return the dynamic forces at the sensors of a run, beads first.

    A contact's place is midway between its beads, the wall's contact half a spacing behind the last
    bead. If the motion of a run takes too much memory, the forces are splines through the samples,
    or through every other sample (``every=2``).
    """
    scene = run.scene
    load = np.zeros(scene.size + 1)  # of the contacts on the left and right of the beads
    load[1 : scene.contact_count + 1] = scene.load
    x = np.cumsum((0.0, *scene.spacings, *scene.spacings[-1:]))

    def track(kind: str, i: int, site: float, samples: Array, static: float) -> Track:
        length = [float(np.interp(site, range(len(x)), x))] if scene.spacings else []
        place = dict(zip(SPEEDS, (site, *length), strict=False))
        force: Signal = (
            Sampled(run.time[::every], samples[::every])
            if run.path is None
            else run.signal(kind, i)
        )
        dynamic = Mapped(force, lambda f: f - static) if static else force
        return Track(kind, i + 1, dynamic, place, float(static))

    beads = zip(scene.bead_sensors, run.bead_force, strict=True)
    contacts = zip(scene.contact_sensors, run.contact_force, strict=True)
    return (
        *(track("bead", i, i, force, (load[i] + load[i + 1]) / 2) for i, force in beads),
        *(track("contact", i, i + 0.5, force, load[i + 1]) for i, force in contacts),
    )


def _reading(fine: Track, coarse: Track, rtol: float, number: int | None = None) -> Reading:
    """Measure the first pulse at a sensor, or pulse ``number`` of its train."""

    def numbers(track: Track) -> dict[str, float]:
        pulse = track.pulse if number is None else track.train[number]
        return {name: getattr(pulse, name) for name in READINGS}

    place = (fine.number,)
    try:
        found, missing = compared(numbers, fine, coarse, rtol), None
    except MeasureError as error:
        found, missing = {}, str(error)
    return Reading(fine.kind, place, found, fine.static, missing, 1 + (number or 0))


def _train(fine: Track, coarse: Track, rtol: float) -> list[Reading]:
    """Measure all pulses at one sensor that both runs show."""
    try:
        count = min(len(track.train) for track in (fine, coarse))
    except MeasureError:
        return [_reading(fine, coarse, rtol)]
    return [_reading(fine, coarse, rtol, number) for number in range(count)]


def _speed(start: tuple[Track, Track], end: tuple[Track, Track], rtol: float) -> Reading:
    """Measure the speed of the first pulse between two sensors.

    start, end : a sensor's track in the accurate and in the other run. The errors of both arrivals
    are added, as they may cancel in the less accurate speed.
    """
    (first, _), (second, _) = start, end
    read = partial(Reading, first.kind, (first.number, second.number), static=first.static)
    try:
        arrivals = [[track.pulse.arrival for track in pair] for pair in (start, end)]
        late = sum(max(abs(fine - coarse), rtol * fine) for fine, coarse in arrivals)
    except MeasureError:
        return read({}, missing="one of the two has no pulse")
    found = {}
    try:
        for unit, at in first.place.items():
            V = speed(first.pulse, second.pulse, abs(second.place[unit] - at))
            apart = second.pulse.arrival - first.pulse.arrival
            found[unit] = Measured(V, V * (1 + late / apart))
    except MeasureError as error:
        return read({}, missing=str(error))
    return read(found)
