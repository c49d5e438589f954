"""Pulses of measured forces: arrival, peak and FWHM at each sensor, and the speeds between them."""

from __future__ import annotations

import math
from collections.abc import Mapping

import click

from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulse
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import SPEEDS, Reading, speeds_between
from validation.report.command import column_option, option, study
from validation.report.readings import reading_tables
from validation.report.result import Report
from validation.scenes.checks import SceneError, one_of
from validation.scenes.columns import (
    LENGTH,
    MeasuredFile,
    amount,
    refuse_unknown,
    sensor_columns,
)

_KINDS = ("bead", "contact")
_NOTE = (
    "First pulse at each sensor, in {} units; forces are counted from the static force, the mean "
    "before the pulse. ±: one standard deviation, from the noise before the pulse."
)


@study(
    click.argument("records", type=click.Path()),
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

    Raises `MeasureError` where no sensor has a pulse.
    """
    one_of(of, _KINDS, "of")
    apart = None if distance is None else amount(str(distance), "distance", LENGTH)
    file = MeasuredFile.read(records, renamed)
    time, si = file.column("time"), any(file.units)
    sensors = sensor_columns(file, of)
    if not sensors:
        raise SceneError(f"{records}: no column is the force of a sensor, such as contact 15 force")
    refuse_unknown(renamed, ["time", *(sensor.name for sensor in sensors)])
    found, curves = [], []
    for i, sensor in enumerate(sensors):
        force = file.column(sensor.name)
        place = (sensor.number or 1,)  # the only sensor of a file is number 1
        try:
            pulse = noisy_pulse(time, force)
            found.append(Reading(sensor.kind, place, pulse.numbers, pulse.base))
        except MeasureError as error:
            found.append(Reading(sensor.kind, place, {}, math.nan, str(error)))
        curves.append(Curve(found[i].name, time, force, f"C{i}-"))
    if all(reading.missing for reading in found):
        raise MeasureError(f"{records}: no sensor has a pulse: {found[0].name}: {found[0].missing}")
    labels = ("arrival (s)", "peak (N)", "FWHM (s)") if si else ("arrival", "peak", "FWHM")
    lengths = dict(zip(SPEEDS, (1.0,) if apart is None else (1.0, apart), strict=False))
    places = [{name: r.places[0] * size for name, size in lengths.items()} for r in found]
    speeds = speeds_between(found, places, math.hypot)  # independent noise
    tables, missing = reading_tables(found, speeds, labels, si)
    units = (" (s)", " (N)") if si else ("", "")
    panel = Panel(f"time{units[0]}", f"force{units[1]}", tuple(curves), legend_above=True)
    notes = (missing, _NOTE.format("SI" if si else "the file's own"))
    return Report(str(records), tables, panels=(panel,), notes=notes)
