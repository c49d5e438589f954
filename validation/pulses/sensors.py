"""Pulses at the sensors of a scene: arrival, peak force, FWHM, and the speed between sensors.

Forces are dynamic: they count from the start, as in a record. Beads that start in equilibrium carry
the static force of gravity and precompression; beads that fall onto each other carry none. Every
number of a recording is measured in a run and in a second, more accurate one, whose difference
tells its error (`validation.pulses.pulse.compared`).
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from validation.lattice.cost import RunProgress, silent
from validation.lattice.equations import Motion
from validation.lattice.result import Run
from validation.lattice.signal import RECORDS, quantities, sensed_beads, sensors_of
from validation.lattice.simulate import COMPILED, repeated
from validation.pulses.pulse import (
    MeasureError,
    Piecewise,
    Pulse,
    Signal,
    all_pulses,
    compared,
    first_pulse,
    readings,
    spline,
    tolerances,
)
from validation.scenes.checks import SceneError, between
from validation.scenes.scene import Scene

TOLERANCE = 1e-10  # default tolerance of the accurate run
_ROUNDING = 10  # rounding of the static compression over rtol; with more, steps follow the noise
# Least time in which a pulse passes a site, over that of a small wave (`_time_of_a_site`).
_QUICK = 0.9
# Samples in the shortest time √(m/spring) of a bead between two contacts. The force of two beads
# that collide, or of a Hertz chain's wave, has 1.5 or 1.9 √(m/spring) of one contact above half:
# some 33 and 42 samples.
_RESOLVED = 22.0
_MOST_SAMPLES = 100_000  # of more samples a run would take much memory
_HIDDEN = 0.5  # relative error of the peak from which on a pulse may be rounding alone
# Chosen: a pulse with a FWHM of a tenth of the time between is above its half at twenty of them.
_LOOKS = 200  # times at which a sensor is searched for an earlier pulse


@dataclass(frozen=True)
class Reading:
    """Measured numbers of a pulse at a sensor, or its speeds between two sensors.

    Parameters
    ----------
    kind : {"bead", "contact"}
        Kind of the sensor.
    places : tuple of int
        Number of the sensor, or of both, counted from 1.
    numbers : mapping of Estimate
        Numbers of a pulse that are known, by their names in `validation.pulses.pulse.READINGS`; of
        speeds ``speed_sites``, in sites per time, and ``speed``, in length per time.
    static : float
        Force at the (first) sensor from which dynamic forces count: the one at the start.
    missing : str, optional
        Reason why numbers are missing.
    pulse : int
        Number of the pulse at the sensor, counted from 1.
    quantity : {"force", "velocity"}
        The measured signal.
    along : mapping of float
        Place of the sensor along the chain by the names of the speeds; empty where it has none.
    """

    kind: str
    places: tuple[int, ...]
    numbers: Mapping[str, Estimate]
    static: float
    missing: str | None = None
    pulse: int = 1
    quantity: str = "force"
    along: Mapping[str, float] = field(default_factory=dict)

    @property
    def number(self) -> int:
        """Number of the (first) sensor."""
        return self.places[0]

    @property
    def name(self) -> str:
        """Kind, places, and a quantity other than force, such as bead 15 → 34."""
        places = " → ".join(map(str, self.places))
        quantity = "" if self.quantity == "force" else f" {self.quantity}"
        return f"{self.kind} {places}{quantity}"


@dataclass(frozen=True, eq=False)
class Track(Reading):
    """A sensor of a run, and its signal as a function of time.

    Parameters
    ----------
    force : Signal
        The force less ``static``, or the velocity of a bead.
    """

    force: Signal = field(kw_only=True)


@dataclass(frozen=True, eq=False)
class Recording:
    """A run, the pulses at the sensors, the speeds from each sensor to the next, and the end.

    Parameters
    ----------
    run : Run
        The run.
    sensors : sequence of Track
        Dynamic forces at the sensors, and their pulses.
    speeds : sequence of Reading
        Speeds between sensors.
    end : mapping
        Velocity and displacement at the end, by these names, of the bead sensors, counted from 1.
    """

    run: Run
    sensors: Sequence[Track]
    speeds: Sequence[Reading]
    end: Mapping[int, Mapping[str, Estimate]]


def record(
    scene: Scene,
    *,
    method: str = COMPILED[0],
    rtol: Any = TOLERANCE,
    every: bool = False,
    velocities: Container[str] = (),
    progress: RunProgress = silent,
) -> Recording:
    """Simulate a scene and measure the pulses at its sensors.

    Parameters
    ----------
    scene : Scene
        The scene.
    method : str
        Integrator, as of `validation.simulate`.
    rtol : float
        Relative tolerance, from 1e-13 to 1e-5.
    every : bool
        True for all pulses at each sensor instead of the first.
    velocities : container of str
        Names of bead sensors, such as "bead 15", whose velocity is measured, not the force.
    progress : callable
        Progress of the runs, as of `validation.simulate`.

    Raises
    ------
    SceneError
        If rounding hides the motion at this tolerance, and as `validation.simulate` does.
    """
    rtol = between(rtol, "rtol", 1e-13, 1e-5)
    motion = Motion(scene)
    lost = motion.scales.rounding
    if lost > _ROUNDING * rtol:
        raise SceneError(
            f"rtol is {rtol:g}: rounding of the static compression, {motion.rest.max():.1g}, takes "
            f"{lost:.1g} of the motion; {lost / _ROUNDING:.1g} or more is wanted"
        )
    both = tolerances(rtol, lost)
    runs = repeated(scene, both, method=method, progress=progress)
    run, check = runs
    # Splines through half of the samples show the error of the splines, too.
    checks = tracks(check, velocities, 2)
    firsts: list[Track] = []
    found: list[Track] = []
    for track, other in zip(tracks(run, velocities), checks, strict=True):
        firsts += _readings(track, other, lambda signal: [first_pulse(signal)])
        if every:
            found += _readings(track, other, all_pulses)

    def doubt(first: Track, second: Track, sites: float) -> None:
        """Raise `MeasureError` if two sensors do not see one pulse.

        The argument ``sites`` is the speed between the sensors, in sites per time.
        """
        # Total forces, which set the stiffness of the contacts
        peaks = [r.numbers["peak"].value + r.static for r in (first, second)]
        numbers = sorted(first.places + second.places)
        # The contacts from one sensor to the other, and that behind a second bead; numbers count
        # from 1.
        between = slice(numbers[0] - 1, numbers[1])
        time = _time_of_a_site(motion, between, max(peaks))
        # From site to site the pulse takes 1/sites.
        if 1 / sites < _QUICK * time:
            raise MeasureError("no wave is so fast: the sensors see different pulses")
        # From the arrival at the first sensor until a width before that at the second one
        start = first.numbers["arrival"].value
        end = second.numbers["arrival"].value - second.numbers["fwhm"].value
        looks = np.linspace(start, end, _LOOKS)
        half = first.numbers["peak"].value / 2
        if end > start and second.force(looks).max() > half:
            raise MeasureError("another pulse passes the second sensor before")

    # Errors of both arrivals are added: in the other run's speed they may cancel.
    speeds = speeds_between(firsts, operator.add, doubt)
    end = {
        i + 1: compared(partial(_state_at_end, bead=i), runs)
        for i in scene.bead_sensors
    }
    return Recording(run, found or firsts, speeds, end)


def _state_at_end(run: Run, bead: int) -> dict[str, float]:
    """Return velocity and displacement of a bead at the end of a run."""
    return {
        "velocity": float(run.velocities[bead]),
        "displacement": float(run.displacements[bead]),
    }


def enough_samples(scene: Scene) -> int:
    """Return a number of samples that resolve pulses, from 1001 to `_MOST_SAMPLES`."""
    wanted = _RESOLVED * scene.duration / Motion(scene).scales.time
    return int(min(max(1001.0, wanted), _MOST_SAMPLES))


def _time_of_a_site(motion: Motion, contacts: slice, force: float) -> float:
    """Return the time in which a small wave passes a site where the contacts carry a force."""
    if motion.scene.law is not None:
        return motion.scales.time
    A = motion.stiffnesses[contacts]
    exponents = np.broadcast_to(motion.scene.k, len(motion.stiffnesses))
    k = exponents[contacts]
    # dF/dδ of F = A δ^k at the force F
    springs = k * A ** (1 / k) * force ** (1 - 1 / k)
    beside = np.append(motion.masses, np.inf)  # the wall has no mass of its own
    lighter_of_all = np.minimum(beside[:-1], beside[1:])
    lighter = lighter_of_all[contacts]
    # Sound passes a site of equal beads in √(m/spring); with the lighter of unlike beads this time
    # is too short, if anything.
    times = np.sqrt(lighter[: len(A)] / springs)
    return float(np.mean(times))


def tracks(
    run: Run,
    velocities: Container[str] = (),
    every: int = 1,
) -> list[Track]:
    """Return the dynamic forces at the sensors of a run; beads first.

    Parameters
    ----------
    run : Run
        The run.
    velocities : container of str
        Names of bead sensors, such as "bead 15", whose velocity is returned, not the force.
    every : int
        Step from sample to sample of the splines that are the signals where the motion takes too
        much memory to be kept: 1 for all samples, 2 for each second one.
    """
    scene = run.scene
    levels = forces_at_start(scene)
    # Places of the beads, and of one more, imagined a spacing after the last
    x = np.cumsum((0.0, *scene.spacings, *scene.spacings[-1:]))
    found = []
    for kind, numbers in sensors_of(scene).items():
        for row, i in enumerate(numbers):
            name = f"{kind} {i + 1}"
            quantity = "force"
            static = levels[name]
            if name in velocities:
                quantity = "velocity"
                static = 0.0
            # A motion too long to be kept leaves its samples.
            if run.path is None:
                samples = getattr(run, RECORDS[kind, quantity])[row]
                signal: Signal = spline(run.time[::every], samples[::every])
            else:
                signal = run.signal(kind, i, quantity)
            place = _place(scene, x, kind, i)
            found.append(
                Track(
                    kind,
                    (i + 1,),
                    {},
                    static,
                    quantity=quantity,
                    along=place,
                    force=_above(signal, static),
                )
            )
    return found


def _place(scene: Scene, x: Array, kind: str, i: int) -> dict[str, float]:
    """Return the place of a sensor as in `Reading.along`; empty for a bead with one contact.

    x : places of the beads, and of one more bead, imagined a spacing after the last.
    """
    # The force of a bead between two contacts is their mean, at the bead; with one contact it is a
    # force at this contact.
    if kind == "bead" and not 0 < i < scene.contact_count:
        return {}
    # A contact is midway between its beads; the wall's is half a spacing after the last bead.
    site = i + 0.5 if kind == "contact" else float(i)
    place = {"speed_sites": site}
    if scene.spacings:
        sites = np.arange(len(x))
        place["speed"] = float(np.interp(site, sites, x))
    return place


def _above(force: Signal, static: float) -> Piecewise:
    """Return the force less the static force, on the same smooth intervals."""
    return Piecewise(force.times, lambda t: force(t) - static)


def forces_at_start(scene: Scene) -> dict[str, float]:
    """Return the forces at the start at the sensors of a scene, by names such as "bead 15".

    Where beads start in equilibrium, whatever their velocities, they are the static forces: a
    damped contact of a moving bead resists at once, but a sensor has been at rest before.
    """
    motion = Motion(scene)
    beads = sensed_beads(motion)
    y = np.append(motion.start[: scene.size], 0.0)  # the wall stays at 0
    at_rest = np.zeros((len(beads), 1))
    records = quantities(motion, beads, y[beads, np.newaxis], at_rest)
    forces = {}
    for kind, numbers in sensors_of(scene).items():
        for i in numbers:
            rows = records[RECORDS[kind, "force"]]
            # A row for each of ``beads``, and for the contact ahead of it, which has its number
            force = rows[beads.searchsorted(i)]
            forces[f"{kind} {i + 1}"] = float(force[0])
    return forces


def _readings(
    track: Track, other: Track, pulses: Callable[[Signal], list[Pulse]]
) -> list[Track]:
    """Measure pulses at a sensor, the first or all, with errors from another run."""
    try:
        measured, known = map(pulses, (track.force, other.force))
    except MeasureError as error:
        return [replace(track, missing=str(error))]
    found: list[Track] = []
    for pulse in measured:
        # One run may see a pulse more: those that arrive at nearly one time are the same pulse.
        same = min(known, key=lambda other: abs(other.arrival - pulse.arrival))
        numbers = compared(readings, [pulse, same])
        if numbers["peak"].relative_error < _HIDDEN:
            found.append(replace(track, numbers=numbers, pulse=len(found) + 1))
    if not found:
        reason = "no pulse: the force is the static one, but for errors"
        return [replace(track, missing=reason)]
    return found


def speeds_between(
    sensors: Sequence[Reading],
    total: Callable[[float, float], float],
    doubt: Callable[[Any, Any, float], object] = lambda *_: None,
) -> list[Reading]:
    """Return the speeds of the pulse from each sensor to the next one of its kind.

    Parameters
    ----------
    sensors : sequence of Reading
        First pulses.
    total : callable
        Error of a time between two arrivals as a function of the errors of both.
    doubt : callable
        Function of two sensors and of the speed between them in sites per time, which raises
        `MeasureError` if they do not see one pulse.
    """
    legs = []
    for first, second in pairwise(sensors):
        if first.kind != second.kind:
            continue
        both = first.places + second.places
        leg = replace(first, places=both, numbers={}, missing=None)
        try:
            speeds = _speeds(first, second, total)
            doubt(first, second, speeds["speed_sites"].value)
            leg = replace(leg, numbers=speeds)
        except MeasureError as error:
            leg = replace(leg, missing=str(error))
        legs.append(leg)
    return legs


def _speeds(
    first: Reading, second: Reading, total: Callable[[float, float], float]
) -> dict[str, Estimate]:
    """Return the speeds of a pulse from one sensor to another, later one.

    Names are ``speed_sites``, in sites per time, and ``speed``, in length per time, as far as both
    sensors' `Reading.along` have them. The error of the time between is ``total`` of the errors of
    both arrivals. Raises `MeasureError` if there are none.
    """
    if "arrival" not in first.numbers or "arrival" not in second.numbers:
        raise MeasureError("one of the two has no pulse")
    start = first.numbers["arrival"]
    end = second.numbers["arrival"]
    error = total(start.error, end.error)
    time = Estimate(end.value - start.value, error)
    if time.value <= time.error:
        raise MeasureError(
            "a speed needs a later second arrival, by more than its error"
        )
    if not (first.along and second.along):
        raise MeasureError(
            "a bead with one contact shows the pulse of the contact, half a site away"
        )
    speeds = {}
    for name, place in first.along.items():
        distance = abs(second.along[name] - place)
        V = distance / time.value
        speeds[name] = Estimate(V, V * time.relative_error)
    return speeds
