"""Pulses of measured forces: arrival, peak and FWHM at each sensor, and the speeds between them."""

from __future__ import annotations

import math
from collections.abc import Mapping

import click

from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulses
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import SPEEDS, Reading, speeds_between
from validation.report.command import column_options, number, option, study
from validation.report.result import Report
from validation.scenes.checks import SceneError, one_of, positive
from validation.scenes.columns import MeasuredFile, sensor_columns
from validation.studies.run import reading_tables

_KINDS = ("bead", "contact")
_NOTE = (
    "First pulse at each sensor, in {} units; forces are counted from the static force, the mean "
    "before the pulse. ±: one standard deviation, from the noise before the pulse."
)


@study(
    click.argument("records", type=click.Path()),
    option("--distance", callback=number, says="Of neighbouring beads, in m or the file's unit."),
    option(
        "--of",
        default="contact",
        type=click.Choice(_KINDS),
        says="Where sensors sit whose columns do not say it.",
    ),
    column_options,
)
def pulses(
    records: str,
    distance: float | None = None,
    of: str = "contact",
    renamed: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
) -> Report:
    """Pulses at sensors, and the speeds between them. RECORDS, a CSV file, has the columns time
    and, for each sensor, such as "bead 15 force", "contact 15 force", "15 force" or, of a single
    sensor, "force". Beads and contacts are counted from 1. Units are stated in the header or by
    --unit: results are then in SI, as is a distance; without any they are in the file's own units.
    "bead 15 time" is the time of one sensor, the nearest column time on its left that of others.

    ``sensors``, ``speeds`` and ``echoes`` as of `validation.studies.run`, the static force from the
    record. A sensor has the speeds from the sensor before as well, so that the CSV holds them all.

    Raises `MeasureError` where no sensor has a pulse.
    """
    one_of(of, _KINDS, "of")
    apart = None if distance is None else positive(distance, "distance")
    file = MeasuredFile.read(records, "time", "force", renamed=renamed, units=units)
    si = file.has_units
    sensors = sensor_columns(file, of)
    if not sensors:
        raise SceneError(f"{records}: no column is the force of a sensor, such as contact 15 force")
    found, curves = [], []
    for i, sensor in enumerate(sensors):
        time, force = file.record(sensor)
        place = (sensor.number or 1,)  # the only sensor of a file is number 1
        number = 1
        try:
            for pulse in noisy_pulses(time, force):
                found.append(Reading(sensor.kind, place, pulse.numbers, pulse.base, pulse=number))
                number += 1
        except MeasureError as error:
            found.append(Reading(sensor.kind, place, {}, math.nan, str(error), number))
        curves.append(Curve(found[-1].name, time, force, f"C{i}-"))
    firsts = [reading for reading in found if reading.pulse == 1]
    if all(first.missing for first in firsts):
        raise MeasureError(f"{records}: no sensor has a pulse: {found[0].name}: {found[0].missing}")
    labels = ("arrival (s)", "peak (N)", "FWHM (s)") if si else ("arrival", "peak", "FWHM")
    lengths = dict(zip(SPEEDS, (1.0,) if apart is None else (1.0, apart), strict=False))
    places = [{name: r.places[0] * size for name, size in lengths.items()} for r in firsts]
    speeds = speeds_between(firsts, places, math.hypot)  # independent noise
    tables, missing = reading_tables(found, speeds, labels, si, math.hypot)
    axes = ("time (s)", "force (N)") if si else ("time", "force")
    panel = Panel(*axes, tuple(curves), legend_above=True)
    notes = (missing, _NOTE.format("SI" if si else "the file's own"))
    return Report(str(records), tables, panels=(panel,), notes=notes)
