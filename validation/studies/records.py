"""Measured records of forces: their pulses, and the simulation of their scene beside them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import click

from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from validation.lattice.cost import RunProgress, silent
from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulse, noisy_pulses
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import (
    READINGS,
    SPEEDS,
    Reading,
    record,
    speeds_between,
    static_forces,
)
from validation.report.command import column_options, number, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError, one_of, positive
from validation.scenes.columns import MeasuredFile
from validation.scenes.scene import Scene
from validation.scenes.scenefile import check_units, read_scene
from validation.studies.run import reading_tables

_KINDS = ("bead", "contact")
_PULSES = (
    "First pulse at each sensor, in {} units; forces are counted from the static force, the mean "
    "before the pulse. ±: one standard deviation, from the noise before the pulse."
)


@study(
    click.argument("records", type=click.Path()),
    option(
        "--distance",
        callback=number,
        says="Distance of neighbouring beads: in m, or in the unit of a file without units.",
    ),
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
    One column time serves all sensors; or the first serves the first force, the next the next.

    ``sensors``, ``speeds`` and ``echoes`` as of `validation.studies.run`, the static force from the
    record. A sensor has the speeds from the sensor before as well, so that the CSV holds them all.

    Raises `MeasureError` where no sensor has a pulse.
    """
    one_of(of, _KINDS, "of")
    apart = None if distance is None else positive(distance, "distance")
    file = MeasuredFile.read(records, "time", "force", renamed=renamed, units=units)
    si = file.has_units
    found, curves = [], []
    for i, ((kind, which), columns) in enumerate(file.sensors(of).items()):
        time, force = file.record(*columns)
        place = (which or 1,)  # the only sensor of a file is number 1
        number = 1
        try:
            for pulse in noisy_pulses(time, force):
                found.append(
                    Reading(kind, place, pulse.numbers, pulse.base, pulse=number)
                )
                number += 1
        except MeasureError as error:
            found.append(Reading(kind, place, {}, math.nan, str(error), number))
        curves.append(Curve(found[-1].name, time, force, f"C{i}-"))
    firsts = [reading for reading in found if reading.pulse == 1]
    if all(first.missing for first in firsts):
        raise MeasureError(
            f"{records}: no sensor has a pulse: {found[0].name}: {found[0].missing}"
        )
    labels = (
        ("arrival (s)", "peak (N)", "FWHM (s)") if si else ("arrival", "peak", "FWHM")
    )
    lengths = dict(zip(SPEEDS, (1.0,) if apart is None else (1.0, apart), strict=False))
    places = [
        {name: r.places[0] * size for name, size in lengths.items()} for r in firsts
    ]
    speeds = speeds_between(firsts, places, math.hypot)  # independent noise
    tables, missing = reading_tables(found, speeds, labels, si, math.hypot)
    axes = ("time (s)", "force (N)") if si else ("time", "force")
    panel = Panel(*axes, tuple(curves), legend_above=True)
    notes = (missing, _PULSES.format("SI" if si else "the file's own"))
    return Report(str(records), tables, panels=(panel,), notes=notes)


_COLUMNS = (
    *(Column("", "first pulse"), Column("kind"), Column("number"), Column("quantity")),
    *(
        Column(name, name, error=True)
        for name in ("simulated", "measured", "difference")
    ),
)
_LABELS = dict(zip(READINGS, ("arrival", "peak dynamic force", "FWHM"), strict=True))
_COMPARED = (
    "First pulses of dynamic forces. Measured times are shifted by {}, so that the pulses arrive "
    "together at {}. ±: of the simulation, difference to a less accurate run; of the measurement, "
    "one standard deviation, from the noise before the pulse."
)


@study(
    click.argument("scene", type=click.Path()),
    click.argument("measured", type=click.Path()),
    column_options,
)
def compare(
    scene: str,
    measured: str,
    renamed: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    run_progress: RunProgress = silent,
) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.

    SCENE is a scene file, as of `lwa-validate run`. MEASURED, a CSV file, has the columns time and,
    for each sensor, such as "bead 15 force"; for a single sensor also "force". Units are stated in
    the header or by --unit; without any the file is in the scene's own numbers. Base and slope of a
    record are those of its part before the pulse.

    ``rows``: ``kind``, ``number``, ``quantity`` ("arrival", "peak" or "fwhm"), ``simulated_value``,
    ``measured_value`` and ``difference_value``, measured less simulated, with errors;
    ``shift_value``.
    """
    chain = read_scene(scene)
    records = _read(measured, chain, renamed, units)
    simulation = record(chain, progress=run_progress)
    label, t = simulation.run.label, simulation.run.time
    rows: list[tuple[Any, ...]] = []
    curves: list[Curve] = []
    shift, first, start = 0.0, "", Estimate(0.0, 0.0)
    for i, (reading, track) in enumerate(
        zip(simulation.sensors, simulation.tracks, strict=True)
    ):
        if reading.name not in records:
            continue
        if reading.missing:
            raise SceneError(f"{reading.name}: {reading.missing}")
        time, force, pulse = records[reading.name]
        if not first:
            first, start = reading.name, pulse["arrival"]
            shift = reading.numbers["arrival"].value - start.value
        arrival = pulse["arrival"]
        error = (
            arrival.error
            if reading.name == first
            else math.hypot(arrival.error, start.error)
        )
        pulse["arrival"] = Estimate(arrival.value + shift, error)
        for name, quantity in _LABELS.items():
            ours, theirs = reading.numbers[name], pulse[name]
            less = theirs.value - ours.value
            numbers = ours, theirs, Estimate(less, ours.error + theirs.error)
            printed = f"{reading.name}: {label(quantity)}"
            rows.append((printed, track.kind, track.number, name, *numbers))
        curves += [
            Curve(f"{reading.name}, simulated", t, track.force(t), f"C{i}-"),
            Curve("measured", time + shift, force, f"C{i}."),
        ]
    unit = f"{shift:.6g} s" if chain.units else f"{shift:.6g}"
    return Report(
        str(chain),
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(
            Panel(
                label("time"), label("dynamic force"), tuple(curves), legend_above=True
            ),
        ),
        notes=(_COMPARED.format(unit, first),),
        data={"shift_value": shift},
    )


def _read(
    file: str,
    chain: Scene,
    renamed: Mapping[str, str] | None,
    units: Mapping[str, str] | None,
) -> dict[str, tuple[Array, Array, dict[str, Estimate]]]:
    """Read measured forces at sensors of a scene, at least one.

    Returns, by the sensors' names, times, forces over their base, and the numbers of the first
    pulse.
    """
    names = [*static_forces(chain)]
    if not names:
        raise SceneError("the scene names no sensors")
    measured = MeasuredFile.read(file, "time", "force", renamed=renamed, units=units)
    check_units(measured, chain.units)
    records = {}
    for (kind, which), columns in measured.sensors().items():
        alone = which is None and len(names) == 1
        name = names[0] if alone else f"{kind} {which}"
        if name in names:
            time, force = measured.record(*columns)
            try:
                pulse = noisy_pulse(time, force)
            except MeasureError as error:
                raise MeasureError(f"{file}: {name}: {error}") from None
            records[name] = time, force - pulse.base, dict(pulse.numbers)
    if not records:
        raise SceneError(
            f"{file}: no column is {' or '.join(f'{name} force' for name in names)}"
        )
    return records
