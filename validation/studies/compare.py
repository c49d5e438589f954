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
from validation.report.command import column_option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.columns import (
    MeasuredFile,
    check_span,
    refuse_unknown,
    sensor_columns,
)
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
    column_option(),
)
def compare(
    scene: str,
    measured: str,
    renamed: Mapping[str, str] | None = None,
    run_progress: RunProgress = silent,
) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.

    SCENE is a scene file, as of `lwa-validate run`. MEASURED, a CSV file, has the columns time and,
    for each sensor, such as "bead 15 force" (static force included) or "bead 15 dynamic force"; for
    a single sensor also "force" or "dynamic force". Units in the header are read.

    ``rows``: ``kind``, ``number``, ``quantity`` ("arrival", "peak" or "fwhm"), ``simulated_value``,
    ``measured_value`` and ``difference_value``, measured less simulated, with errors;
    ``shift_value``.
    """
    chain = read_scene(scene)
    time, forces, pulses = _read(measured, chain, renamed)
    simulation = record(chain, progress=run_progress)
    label, t = simulation.run.label, simulation.run.time
    rows: list[tuple[Any, ...]] = []
    curves: list[Curve] = []
    shift, first, start = 0.0, "", Measured(0.0, 0.0)
    for i, (reading, track) in enumerate(zip(simulation.sensors, simulation.tracks, strict=True)):
        if reading.name not in forces:
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
            Curve("measured", time + shift, forces[reading.name], f"C{i}."),
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
    file: str, chain: Scene, renamed: Mapping[str, str] | None
) -> tuple[Array, dict[str, Array], dict[str, dict[str, Measured]]]:
    """Read the measured dynamic forces at sensors of a scene, at least one.

    Returns the times, and by the sensors' names the forces and the numbers of their first pulses.
    """
    static = static_forces(chain)
    if not static:
        raise SceneError("the scene names no sensors")
    measured = MeasuredFile.read(file, renamed)
    time, forces, used = measured.column("time"), dict[str, Array](), ["time"]
    check_span(file, time, chain.duration)
    for sensor in sensor_columns(measured):
        name = f"{sensor.kind} {sensor.number}"
        if sensor.number is None and len(static) == 1:
            (name,) = static
        if name in static:
            used.append(sensor.name)
            forces[name] = measured.column(sensor.name) - (not sensor.dynamic) * static[name]
    if not forces:
        raise SceneError(f"{file}: no column is {' or '.join(f'{n} force' for n in static)}")
    refuse_unknown(renamed, used)
    try:
        pulses = {name: dict(noisy_pulse(time, f, 0.0).numbers) for name, f in forces.items()}
    except MeasureError as error:
        raise MeasureError(f"{file}: {error}") from None
    return time, forces, pulses
