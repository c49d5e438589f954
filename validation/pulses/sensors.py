"""What a scene's sensors tell: arrival, peak force and FWHM of the first pulse, and its speed.

The first pulse at a sensor is the first stretch of its force above half the record's highest, so
that what follows, such as the wall's echo, does not count. Forces are dynamic: what gravity and
precompression hold there at rest is subtracted. Every number is measured in two runs, and the less
accurate one, of a tolerance `LESS` times as large, gives its error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.effort import RunProgress, silent
from validation.lattice.equations import Motion
from validation.lattice.run import Run
from validation.lattice.simulate import COMPILED, twice
from validation.pulses.pulse import Measured, MeasureError, Pulse, compared, measure, speed
from validation.scenes.checks import SceneError, between
from validation.scenes.scene import Scene

TOLERANCE = 1e-10  # of the run that counts, unless another one is asked for
LESS = 1e3  # by how much that of the run that gives its errors is larger
_ROUNDING = 10  # times rtol: what rounding may take of a motion, lest the steps follow its noise
READINGS = {"arrival": "arrival", "peak": "peak force", "fwhm": "FWHM"}  # off a pulse
SPEEDS = {"speed_sites": "sites/time", "speed": "length/time"}  # in sites and in length over time


@dataclass(frozen=True)
class Reading:
    """What a "bead" or "contact" sensor tells, or one and the next of its kind; or the reason why
    nothing.

    places : the number of the sensor, or of the two, counted from 1.
    numbers : `READINGS`; of two `SPEEDS`, the second one if the scene has spacings.
    """

    kind: str
    places: tuple[int, ...]
    numbers: Mapping[str, Measured]
    static: float
    missing: str | None = None

    @property
    def name(self) -> str:
        """What people read, such as bead 15 → 34."""
        return f"{self.kind} {' → '.join(map(str, self.places))}"


@dataclass(frozen=True, eq=False)
class Recording:
    """A run, what its sensors tell, and the speeds from each sensor to the next of its kind."""

    run: Run
    sensors: tuple[Reading, ...]
    speeds: tuple[Reading, ...]


@dataclass(frozen=True, eq=False)
class Track:
    """One sensor's dynamic force; ``place`` is where it sits, by what of `SPEEDS` it serves."""

    kind: str
    number: int
    time: Array
    force: Array
    place: Mapping[str, float]
    static: float

    @cached_property
    def pulse(self) -> Pulse:
        """The first pulse; raises `MeasureError` for what is missing in the record."""
        return first_pulse(self.time, self.force)


Tracks = tuple[Track, ...]


def record(
    scene: Scene,
    *,
    method: str = COMPILED[0],
    rtol: Any = TOLERANCE,
    progress: RunProgress = silent,
) -> Recording:
    """Simulate a scene and read its sensors.

    The options are those of `validation.simulate`, but for rtol, from 1e-13 to 1e-5. Raises what
    that raises, and `SceneError` where rounding hides what rtol asks for.
    """
    rtol = between(rtol, "rtol", 1e-13, 1e-2 / LESS)
    motion = Motion(scene)
    if (lost := motion.scales.rounding) > _ROUNDING * rtol:
        raise SceneError(
            f"rtol is {rtol:g}: rounding of the static compression, {motion.rest.max():.1g}, takes "
            f"{lost:.1g} of the motion; {lost / _ROUNDING:.1g} or more is wanted"
        )
    run, check = twice(scene, rtol, LESS * rtol, method=method, progress=progress)
    pairs = tuple(zip(tracks(run), tracks(check), strict=True))
    sensors = tuple(_reading(_pulse, (fine,), (coarse,)) for fine, coarse in pairs)
    both = (zip(*two, strict=True) for two in pairwise(pairs) if two[0][0].kind == two[1][0].kind)
    return Recording(run, sensors, tuple(_reading(_speed, *two) for two in both))


def tracks(run: Run) -> Tracks:
    """What the sensors of a run recorded, beads first. A contact sits midway between its beads,
    that with the wall half a spacing behind the last one."""
    scene = run.scene
    load = np.zeros(scene.size + 1)  # of the contacts on the left and right of the beads
    load[1 : scene.contact_count + 1] = scene.load
    x = np.cumsum((0.0, *scene.spacings, *scene.spacings[-1:]))

    def track(kind: str, i: int, site: float, force: Array, static: float) -> Track:
        length = [float(np.interp(site, range(len(x)), x))] if scene.spacings else []
        place = dict(zip(SPEEDS, (site, *length), strict=False))
        return Track(kind, i + 1, run.time, force - static, place, float(static))

    beads = zip(scene.bead_sensors, run.bead_force, strict=True)
    contacts = zip(scene.contact_sensors, run.contact_force, strict=True)
    return (
        *(track("bead", i, i, force, (load[i] + load[i + 1]) / 2) for i, force in beads),
        *(track("contact", i, i + 0.5, force, load[i + 1]) for i, force in contacts),
    )


def first_pulse(time: Array, force: Array) -> Pulse:
    """`measure` the first stretch of a record that is above half its highest value."""
    if not force.max() > 0:
        return measure(time, force)  # which says what is wrong
    above = force > force.max() / 2
    start = int(np.argmax(above))
    stop = start + int(np.argmin(np.append(above[start:], False)))
    # Behind it the record counts up to where it is as high again.
    again = np.append(force[stop:] >= force[start:stop].max(), True)
    end = max(stop + int(np.argmax(again)), 4)
    return measure(time[:end], force[:end])


def _reading(
    read: Callable[[Tracks], Mapping[str, float]], fine: Tracks, coarse: Tracks
) -> Reading:
    kind, places = fine[0].kind, tuple(track.number for track in fine)
    try:
        return Reading(kind, places, compared(read, fine, coarse), fine[0].static)
    except MeasureError as error:
        return Reading(kind, places, {}, fine[0].static, str(error))


def _pulse(heard: Tracks) -> dict[str, float]:
    return {name: getattr(heard[0].pulse, name) for name in READINGS}


def _speed(heard: Tracks) -> dict[str, float]:
    start, end = heard
    try:
        pulses = start.pulse, end.pulse
    except MeasureError:
        raise MeasureError("one of the two has no pulse") from None
    return {unit: speed(*pulses, abs(end.place[unit] - at)) for unit, at in start.place.items()}
