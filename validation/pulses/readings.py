"""Measured numbers of pulses at sensors, and the speeds between them.

A number is an `Estimate`, of a run or of a record.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from lwa.base.frozen import Estimate
from validation.pulses.pulse import MeasureError, Pulse

READINGS = ("arrival", "peak", "fwhm")
"""Names of the numbers of a pulse."""

SPEEDS = ("speed_sites", "speed")
"""Names of its speeds between two sensors, in sites per time and in length per time."""


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
        Those of `READINGS` or of `SPEEDS` that are known, by name.
    static : float
        Force at the (first) sensor from which dynamic forces count: the one at the start.
    missing : str, optional
        Reason why numbers are missing.
    pulse : int
        Number of the pulse at the sensor, counted from 1.
    quantity : {"force", "velocity"}
        The measured signal.
    """

    kind: str
    places: tuple[int, ...]
    numbers: Mapping[str, Estimate]
    static: float
    missing: str | None = None
    pulse: int = 1
    quantity: str = "force"

    @property
    def name(self) -> str:
        """Kind, places, and a quantity other than force, such as bead 15 → 34."""
        places = " → ".join(map(str, self.places))
        quantity = "" if self.quantity == "force" else f" {self.quantity}"
        return f"{self.kind} {places}{quantity}"


def readings(pulse: Pulse) -> dict[str, float]:
    """Return the numbers of a pulse by the names `READINGS`."""
    return {name: getattr(pulse, name) for name in READINGS}


def speeds_between(
    sensors: Sequence[Reading],
    places: Sequence[Mapping[str, float]],
    total: Callable[[float, float], float],
    doubt: Callable[[Reading, Reading, float], str] = lambda *_: "",
) -> tuple[Reading, ...]:
    """Return the speeds of the pulse from each sensor to the next one of its kind.

    Parameters
    ----------
    sensors : sequence of Reading
        First pulses.
    places : sequence of mappings
        Places of the sensors along the chain, by the names `SPEEDS`.
    total : callable
        Error of a time between two arrivals as a function of the errors of both.
    doubt : callable
        Reason, "" if there is none, why one pulse does not pass two sensors at a speed in sites.
    """
    legs = []
    for (first, at), (second, there) in pairwise(zip(sensors, places, strict=True)):
        if first.kind != second.kind:
            continue
        leg = replace(
            first, places=first.places + second.places, numbers={}, missing=None
        )
        try:
            time = _elapsed(first, second, total)
            if not (at and there):
                raise MeasureError(
                    "a bead with one contact has a force of half a site away"
                )
            speeds = {name: abs(there[name] - at[name]) / time.value for name in at}
            reason = doubt(first, second, speeds["speed_sites"])
            if reason:
                raise MeasureError(reason)
        except MeasureError as reason:
            legs.append(replace(leg, missing=str(reason)))
            continue
        error = time.relative_error
        numbers = {name: Estimate(V, V * error) for name, V in speeds.items()}
        legs.append(replace(leg, numbers=numbers))
    return tuple(legs)


def _elapsed(
    first: Reading, second: Reading, total: Callable[[float, float], float]
) -> Estimate:
    """Return the time from one arrival to a later one; raises `MeasureError` if there is none."""
    if "arrival" not in first.numbers or "arrival" not in second.numbers:
        raise MeasureError("one of the two has no pulse")
    start = first.numbers["arrival"]
    end = second.numbers["arrival"]
    time = Estimate(end.value - start.value, total(start.error, end.error))
    if time.value <= 0:
        raise MeasureError("a speed needs a later second arrival")
    if time.value <= time.error:
        raise MeasureError("the arrivals are equal but for their errors")
    return time
