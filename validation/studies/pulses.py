"""Pulses of measured forces: arrival, peak and FWHM at each sensor, and the speeds between them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import click

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulse
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import SPEEDS, Reading, speed_between
from validation.report.command import column_option, option, study
from validation.report.readings import reading_tables
from validation.report.result import Report
from validation.scenes.checks import SceneError, one_of
from validation.scenes.columns import LENGTH, MeasuredFile, amount

_SENSOR = re.compile(r"(?:(bead|contact) )?(?:([1-9]\d{0,8}) )?(?:dynamic )?force")
_KINDS = ("bead", "contact")
_NOTE = (
    "First pulse at each sensor, in {} units; forces are counted from the static force, the mean "
    "before the pulse. ±: one standard deviation, from the noise before the pulse."
)


@study(
    click.argument("records"),
    option("--distance", metavar="LENGTH", says="Distance of neighbouring beads, as in '4.76 mm'."),
    option(
        "--of",
        default="contact",
        type=click.Choice(_KINDS),
        says="Where sensors sit whose columns do not say it.",
    ),
    column_option(),
)
def pulses(
    records: str,
    distance: str | None = None,
    of: str = "contact",
    renamed: Mapping[str, str] | None = None,
) -> Report:
    """Pulses at sensors, and the speeds between them. RECORDS, a CSV file, has the columns time
    and, for each sensor, such as "bead 15 force", "contact 15 force", "15 force" or, of a single
    sensor, "force". Beads and contacts are counted from 1. Units in the header are read: results
    are then in SI, else in the file's own units. A distance without a unit is in m, or in those.

    ``sensors`` and ``speeds`` as of `validation.studies.run`, the static force from the record. A
    sensor has the speeds from the sensor before as well, so that the CSV holds all numbers.
    """
    one_of(of, _KINDS, "of")
    apart = None if distance is None else amount(str(distance), "distance", LENGTH)
    file = MeasuredFile.read(records, renamed)
    time, si = file.column("time"), any(file.units)
    sensors = sorted(_sensors(file, of), key=lambda sensor: sensor.kind)
    if not sensors:
        raise SceneError(f"{records}: no column is the force of a sensor, such as contact 15 force")
    if unknown := set(renamed or ()) - {"time"} - {sensor.column for sensor in sensors}:
        raise SceneError(f"column is {shorten(unknown.pop())}: time or a sensor's force is wanted")
    forces = [file.column(sensor.column) for sensor in sensors]
    found = [_reading(s, time, force) for s, force in zip(sensors, forces, strict=True)]
    neighbours = (two for two in pairwise(found) if two[0].kind == two[1].kind)
    labels = ("arrival (s)", "peak (N)", "FWHM (s)") if si else ("arrival", "peak", "FWHM")
    speeds = []
    for one, other in neighbours:
        sites = abs(other.places[0] - one.places[0])
        ways = (sites,) if apart is None else (sites, sites * apart)
        distances = dict(zip(SPEEDS, ways, strict=False))
        speeds.append(speed_between(one, other, distances, math.hypot))  # independent noise
    tables, missing = reading_tables(found, speeds, labels, si)
    rows = zip(found, forces, strict=True)
    curves = tuple(Curve(r.name, time, f, f"C{i}-") for i, (r, f) in enumerate(rows))
    units = (" (s)", " (N)") if si else ("", "")
    panel = Panel(f"time{units[0]}", f"force{units[1]}", curves, legend_above=True)
    notes = (missing, _NOTE.format("SI" if si else "the file's own"))
    return Report(str(records), tables, panels=(panel,), notes=notes)


@dataclass(frozen=True)
class _Sensor:
    """A sensor with the name of its column."""

    kind: str
    number: int  # of the bead or contact, counted from 1
    column: str


def _sensors(file: MeasuredFile, of: str) -> list[_Sensor]:
    """Return the sensors of a file; a column without a number is the only one."""
    named = [(match, name) for name in file.names if (match := _SENSOR.fullmatch(name))]
    sensors = [_Sensor(m[1] or of, int(m[2] or 1), name) for m, name in named]
    if len(named) > 1 and (without := [name for match, name in named if not match[2]]):
        raise SceneError(f"{file.path}: {shorten(without[0])} has no number: several are there")
    if len({(sensor.kind, sensor.number) for sensor in sensors}) < len(sensors):
        names = shorten([sensor.column for sensor in sensors])
        raise SceneError(f"{file.path}: two columns of {names} are of one sensor")
    return sensors


def _reading(sensor: _Sensor, time: Array, force: Array) -> Reading:
    """Measure the first pulse at a sensor."""
    try:
        pulse = noisy_pulse(time, force)
    except MeasureError as error:
        return Reading(sensor.kind, (sensor.number,), {}, math.nan, str(error))
    return Reading(sensor.kind, (sensor.number,), pulse.numbers, pulse.base)
