"""Measured records of forces beside the simulation of their scene, aligned by arrival."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import click

from lwa.base.arrays import Array
from validation.lattice.cost import RunProgress, silent
from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulse
from validation.pulses.pulse import Measured, MeasureError
from validation.pulses.sensors import READINGS, record, static_forces
from validation.report.command import column_options, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.columns import MeasuredFile, check_span, sensor_columns
from validation.scenes.scene import Scene
from validation.scenes.scenefile import read_scene

_COLUMNS = (
    *(Column("", "first pulse"), Column("kind"), Column("number"), Column("quantity")),
    *(Column(name, name, error=True) for name in ("simulated", "measured", "difference")),
)
_LABELS = dict(zip(READINGS, ("arrival", "peak dynamic force", "FWHM"), strict=True))
_NOTE = (
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
    records, pulses = _read(measured, chain, renamed, units)
    simulation = record(chain, progress=run_progress)
    label, t = simulation.run.label, simulation.run.time
    rows: list[tuple[Any, ...]] = []
    curves: list[Curve] = []
    shift, first, start = 0.0, "", Measured(0.0, 0.0)
    for i, (reading, track) in enumerate(zip(simulation.sensors, simulation.tracks, strict=True)):
        if reading.name not in records:
            continue
        if reading.missing:
            raise SceneError(f"{reading.name}: {reading.missing}")
        pulse = pulses[reading.name]
        if not first:
            first, start = reading.name, pulse["arrival"]
            shift = reading.numbers["arrival"].value - start.value
        arrival = pulse["arrival"]
        error = arrival.error if reading.name == first else math.hypot(arrival.error, start.error)
        pulse["arrival"] = Measured(arrival.value + shift, arrival.value + shift + error)
        for name, quantity in _LABELS.items():
            ours, theirs = reading.numbers[name], pulse[name]
            less = theirs.value - ours.value
            numbers = ours, theirs, Measured(less, less + ours.error + theirs.error)
            printed = f"{reading.name}: {label(quantity)}"
            rows.append((printed, track.kind, track.number, name, *numbers))
        curves += [
            Curve(f"{reading.name}, simulated", t, track.force(t), f"C{i}-"),
            Curve("measured", records[reading.name][0] + shift, records[reading.name][1], f"C{i}."),
        ]
    unit = f"{shift:.6g} s" if chain.units else f"{shift:.6g}"
    return Report(
        str(chain),
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(Panel(label("time"), label("dynamic force"), tuple(curves), legend_above=True),),
        notes=(_NOTE.format(unit, first),),
        data={"shift_value": shift},
    )


def _read(
    file: str, chain: Scene, renamed: Mapping[str, str] | None, units: Mapping[str, str] | None
) -> tuple[dict[str, tuple[Array, Array]], dict[str, dict[str, Measured]]]:
    """Read measured forces at sensors of a scene, at least one.

    Returns, by the sensors' names, times and forces over their base, and the numbers of the first
    pulses.
    """
    names = [*static_forces(chain)]
    if not names:
        raise SceneError("the scene names no sensors")
    measured = MeasuredFile.read(file, "time", "force", renamed=renamed, units=units)
    if not chain.units and (measured.has_units):
        raise SceneError(
            f"{file}: its units are stated, the scene's are not: units = 'SI' is wanted"
        )
    records, pulses = {}, {}
    for sensor in sensor_columns(measured):
        alone = sensor.number is None and len(names) == 1
        name = names[0] if alone else f"{sensor.kind} {sensor.number}"
        if name in names:
            time, force = measured.record(sensor)
            check_span(file, time, chain.duration)
            try:
                pulse = noisy_pulse(time, force)
            except MeasureError as error:
                raise MeasureError(f"{file}: {sensor.name}: {error}") from None
            records[name], pulses[name] = (time, force - pulse.base), dict(pulse.numbers)
    if not records:
        raise SceneError(f"{file}: no column is {' or '.join(f'{name} force' for name in names)}")
    return records, pulses
