"""Pulse that a wall sends back, as a function of the wall's Young's modulus.

A chain of steel spheres is struck at one end and touches a flat wall at the other. The contact with
the wall is Hertz's, of stiffness A_w (`lwa.spheres.hertz`): a thick wall that carries no sound
away. The softer the wall, the longer it holds the last beads, and the later the pulse is back at a
contact inside the chain. Delay: time from the incident pulse to the pulse that follows it.
Ratio: of their peak forces.

Scaling: with the velocity v of the blow all times go as v^{-1/5}, and the ratio does not change.
Both depend on the wall by A_w alone, that is by E/(1 - ν²).

Deng, Nasrollahi, Rizzo and Li 2016, Sensors 16, 5, test materials by this delay.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any

import scipy

from lwa import Cell, Material, Sphere, canonical_wave
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command.options import quantities
from lwa.spheres.hertz import stiffness
from validation.pictures import Curve, Panel
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import record
from validation.report.study import Report, option, study
from validation.report.table import Column, Estimates, Table
from validation.scenes.checks import SceneError, integer, items, positive
from validation.scenes.scene import Scene
from validation.studies.paper import of_momentum

BEAD = Sphere("29.0e-3", "9.525e-3", Material("193e9", "0.3"))  # steel, 19.05 mm
MODULI = (1e9, 3e9, 10e9, 30e9, 70e9, 200e9)  # in Pa: polymers to steel
SOFTEST, STIFFEST = 1e8, 1e13  # in Pa: walls that `modulus` tries
_HOLD = 6.0  # (m/A_w)^{2/5} v^{-1/5}: a sphere alone leaves the wall after 3.2 of them
_CLOSE = 1e-9  # error of ln E, beside that of the delay


def echo(
    E: float,
    nu: float = 0.3,
    *,
    velocity: float = 0.5,
    beads: int = 20,
    sensor: int = 10,
    bead: Sphere = BEAD,
) -> tuple[Estimate, Estimate]:
    """Return the delay in s, and the ratio of the peaks, at a contact of the struck chain.

    E, nu : Young's modulus of the wall in Pa, its Poisson's ratio. velocity : of the blow in m/s.
    sensor : number of the contact, from 1. Errors are those of the integration.
    Raises `MeasureError` if no pulse comes back.
    """
    m, v = float(bead.mass), positive(velocity, "velocity")
    wall = Material(positive(E, "E"), nu)
    beads = integer(beads, "beads", 5, 1000)
    pulse = of_momentum(canonical_wave(Cell.of_spheres([bead]), "3/2"), m * v)
    held = _HOLD * (m / float(stiffness(bead, wall))) ** 0.4 / v**0.2
    scene = Scene.of_beads(
        [bead] * beads,
        wall=wall,
        velocities=(v,),
        contact_sensors=(integer(sensor, "sensor", 2, beads - 2) - 1,),
        duration=2.5 * beads * float(2 * bead.radius / pulse.speed) + held,
    )
    passed = record(scene, every=True).sensors
    if len(passed) < 2:
        raise MeasureError(f"contact {sensor}: no pulse comes back from the wall")
    first, back = (pulse.numbers for pulse in passed[:2])
    early, late = first["arrival"], back["arrival"]
    delay = Estimate(late.value - early.value, late.error + early.error)
    return delay, back["peak"] / first["peak"]


def modulus(delay: Estimate, nu: float = 0.3, **chain: Any) -> Estimate:
    """Return the Young's modulus of a wall, in Pa, from the delay of the pulse that comes back.

    delay : in s, with its error. nu : Poisson's ratio of the wall. chain : as in `echo`.
    Raises `SceneError` for a delay that no wall from `SOFTEST` to `STIFFEST` makes.
    """

    @cache  # the ends of the search are those of each root
    def late(log_E: float) -> float:
        return echo(math.exp(log_E), nu, **chain)[0].value

    soft, stiff = math.log(SOFTEST), math.log(STIFFEST)
    longest, shortest = late(soft), late(stiff)

    def at(time: float) -> float:
        if not shortest < time < longest:
            wanted = f"walls make delays from {shortest:.4g} to {longest:.4g} s"
            raise SceneError(f"delay is {delay}: {wanted}, and its error has to fit")
        found = scipy.optimize.brentq(
            lambda x: late(x) - time, soft, stiff, xtol=_CLOSE
        )
        return math.exp(found)

    ends = (at(delay.value - delay.error), at(delay.value + delay.error))
    return Estimate.against(at(delay.value), max(ends))


_ROWS = (
    Column("modulus_value", "E of the wall (Pa)", format=".3g"),
    Estimates("delay", "delay (s)"),
    Estimates("ratio", "peak/first"),
)


@study(
    option(
        "--moduli", "In Pa.", read=quantities, default="1e9,3e9,10e9,30e9,70e9,200e9"
    ),
    option("--nu", "Poisson's ratio of the wall.", default=0.3),
    option("--velocity", "Velocity of the struck bead in m/s.", default=0.5),
    option("--beads", "Number of beads.", default=20),
    option("--sensor", "Contact at which the pulses are measured, from 1.", default=10),
)
def wall(
    moduli: Sequence[Any] = MODULI,
    nu: float = 0.3,
    velocity: float = 0.5,
    beads: int = 20,
    sensor: int = 10,
    progress: Progress[float] = iter,
) -> Report:
    """Pulse that a wall sends back in a struck chain of steel spheres: delay and height.

    ``rows``: ``modulus_value`` in Pa, ``delay`` in s and ``ratio``, each with its error.
    """
    tried = [float(E) for E in items(moduli, "moduli")]
    found = [
        echo(E, nu, velocity=velocity, beads=beads, sensor=sensor)
        for E in progress(tried)
    ]
    delays, ratios = (
        [number.value for number in numbers] for numbers in zip(*found, strict=True)
    )
    rows = []
    for E, (late, ratio) in zip(tried, found, strict=True):
        rows.append({"modulus_value": E, "delay": late, "ratio": ratio})
    return Report(
        f"{beads} steel spheres struck at {velocity:g} m/s, a wall, contact {sensor}",
        (Table(_ROWS, rows, "rows", note="±: change in a less accurate run."),),
        panels=(
            Panel(
                "E of the wall (Pa)",
                "delay (s)",
                (Curve("", tried, delays, "C0o-"),),
                "x",
            ),
            Panel(
                "E of the wall (Pa)",
                "peak/first",
                (Curve("", tried, ratios, "C1o-"),),
                "x",
            ),
        ),
    )


if __name__ == "__main__":
    wall.main()
