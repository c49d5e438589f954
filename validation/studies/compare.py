"""Measured records of forces beside the simulation of their scene, aligned by arrival."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import click
import numpy as np
import scipy

from lwa.base.arrays import Array
from validation.lattice.cost import RunProgress, silent
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.noisy import noisy_pulse
from validation.pulses.pulse import Measured, MeasureError
from validation.pulses.sensors import READINGS, Instrument, record, static_forces, tracks
from validation.pulses.signals import high_passed
from validation.report.command import column_option, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.columns import (
    TIME,
    MeasuredFile,
    amount,
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
_FITTED = "Damping {} fitted to the peak forces: {}, one standard deviation."
_FIT_TOLERANCE = 1e-8  # of the runs from which the damping is fitted
_RUN_ERROR = 1e-6  # bound on the relative error of their peaks
_SHORTEST = 1e-5  # time constant over the duration of a scene
_PART = 1e-3  # change of the damping, as a part of it, that gives the derivatives of the peaks


@study(
    click.argument("scene"),
    click.argument("measured"),
    option(
        "--time-constant",
        metavar="TIME",
        says="Time constant of the amplifier, a high-pass, as in '1 ms': the simulation passes it.",
    ),
    option("--damping", is_flag=True, default=False, says="Fit the value of the scene's damping."),
    column_option(),
)
def compare(
    scene: str,
    measured: str,
    time_constant: str | None = None,
    damping: bool = False,
    renamed: Mapping[str, str] | None = None,
    run_progress: RunProgress = silent,
) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.

    SCENE is a scene file, as of `lwa-validate run`. MEASURED, a CSV file, has the columns time and,
    for each sensor, such as "bead 15 force" (static force included) or "bead 15 dynamic force"; for
    a single sensor also "force" or "dynamic force". Units in the header are read.

    ``rows``: ``kind``, ``number``, ``quantity`` ("arrival", "peak" or "fwhm"), ``simulated_value``,
    ``measured_value`` and ``difference_value``, measured less simulated, with errors;
    ``shift_value``; with ``damping`` the fitted ``damping_value`` and its error.
    """
    chain = read_scene(scene)
    through = None
    if time_constant is not None:
        T = amount(str(time_constant), "time_constant", TIME)
        if (least := _SHORTEST * chain.duration) > T:
            raise SceneError(f"time_constant is {T:g}: at least {least:g} is wanted")
        through = partial(high_passed, time_constant=T)
    records = _Records.read(measured, chain, renamed)
    fitted = None
    if damping:
        chain, fitted = _damped(chain, records, through)
    simulation = record(chain, through=through, progress=run_progress)
    label, t = simulation.run.label, simulation.run.time
    rows: list[tuple[Any, ...]] = []
    curves: list[Curve] = []
    shift, first, start = 0.0, "", Measured(0.0, 0.0)
    for i, (reading, track) in enumerate(zip(simulation.sensors, simulation.tracks, strict=True)):
        if (force := records.forces.get(reading.name)) is None:
            continue
        if reading.missing:
            raise SceneError(f"{reading.name}: {reading.missing}")
        pulse = dict(records.pulses[reading.name])
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
            Curve("measured", records.time + shift, force, f"C{i}."),
        ]
    unit = f"{shift:.6g} s" if chain.units else f"{shift:.6g}"
    data, notes = {"shift_value": shift}, [_NOTE.format(unit, first)]
    if fitted is not None and chain.damping is not None:
        data |= {"damping_value": fitted.value, "damping_error_value": fitted.error}
        notes.insert(0, _FITTED.format(chain.damping.kind, fitted))
    return Report(
        str(chain),
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(Panel(label("time"), label("dynamic force"), tuple(curves), legend_above=True),),
        notes=tuple(notes),
        data=data,
    )


@dataclass(frozen=True, eq=False)
class _Records:
    """Measured dynamic forces and the numbers of their first pulses, by the sensors' names."""

    time: Array
    forces: Mapping[str, Array]
    pulses: Mapping[str, Mapping[str, Measured]]

    @classmethod
    def read(cls, file: str, chain: Scene, renamed: Mapping[str, str] | None) -> _Records:
        """Read the columns of the sensors of a scene, at least one of them."""
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
            pulses = {name: noisy_pulse(time, f, 0.0).numbers for name, f in forces.items()}
        except MeasureError as error:
            raise MeasureError(f"{file}: {error}") from None
        return cls(time, forces, pulses)


def _damped(chain: Scene, records: _Records, through: Instrument | None) -> tuple[Scene, Measured]:
    """Fit the value of a scene's damping to measured peaks; return the scene with it, and it.

    The error is the standard deviation by the peaks' errors, or by their scatter if this is larger.
    """
    if (damping := chain.damping) is None:
        raise SceneError("damping is to be fitted, but the scene has no table damping")

    def scene(value: float) -> Scene:
        return replace(chain, damping=replace(damping, value=value))

    def residuals(value: Array) -> Array:
        run = simulate(scene(float(value[0])), rtol=_FIT_TOLERANCE)
        peaks = {f"{t.kind} {t.number}": t.first.peak for t in tracks(run, 1, through)}
        pairs = ((peaks[name], pulse["peak"]) for name, pulse in records.pulses.items())
        return np.array(
            [
                math.log(ours / p.value) / math.hypot(p.relative_error, _RUN_ERROR)
                for ours, p in pairs
            ]
        )

    most = 1.0 if damping.kind == "restitution" else math.inf
    least = 0.01 if damping.kind == "restitution" else 0.0
    found = scipy.optimize.least_squares(
        residuals, damping.value, bounds=(least, most), x_scale=damping.value, diff_step=_PART
    )
    value, freedom = float(found.x[0]), max(len(found.fun) - 1, 1)
    scatter = max(1.0, math.sqrt(2 * found.cost / freedom)) if len(found.fun) > 1 else 1.0
    error = scatter / float(np.linalg.norm(found.jac))
    return scene(value), Measured(value, value + error)
