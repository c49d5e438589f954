"""Measured records of forces beside the simulation of their scene, aligned by arrival."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from lwa.base.arrays import Array
from validation.lattice.cost import RunProgress, silent
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, compared, dense, derived, first_pulse
from validation.pulses.sensors import READINGS, Track, readings, record, tracks
from validation.pulses.signals import Sampled
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError, columns
from validation.scenes.scenefile import read_scene

_COLUMNS = (
    *(Column("", "sensor"), Column("kind"), Column("number")),
    *(Column("", "first pulse"), Column("quantity")),
    *(Column(name, name, error=True) for name in ("simulated", "measured", "difference")),
)
_LABELS = dict(zip(READINGS, ("arrival", "peak dynamic force", "FWHM"), strict=True))
_NOTE = (
    "First pulses of dynamic forces. Measured times are shifted by {}, so that the pulses arrive "
    "together at {}. ±: of the simulation, difference to a less accurate run; of the measurement, "
    "to every other sample."
)


@study(click.argument("scene"), click.argument("measured"))
def compare(scene: str, measured: str, run_progress: RunProgress = silent) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.
    SCENE is a scene file, as of `lwa-validate run`. MEASURED, a CSV file, has the columns time and,
    for each sensor, such as "bead 15 force" (static force included) or "bead 15 dynamic force"; for
    a single sensor also "force" or "dynamic force".

    ``rows``: ``kind``, ``number``, ``quantity`` ("arrival", "peak" or "fwhm"), ``simulated_value``,
    ``measured_value`` and ``difference_value``, measured less simulated, with errors;
    ``shift_value``.
    """
    chain = read_scene(scene)
    if not (chain.bead_sensors or chain.contact_sensors):
        raise SceneError(f"{scene}: the scene names no sensors")
    simulation = record(chain, progress=run_progress)
    run, label, t = simulation.run, simulation.run.label, simulation.run.time
    names = [f"{reading.name} " for reading in simulation.sensors]
    names += [""] * (len(names) == 1)
    optional = [name + force for name in names for force in ("force", "dynamic force")]
    samples = columns(measured, "time", optional=optional)
    time, shift, first = samples["time"], 0.0, ""
    rows: list[tuple[Any, ...]] = []
    curves: list[Curve] = []
    for i, (reading, track) in enumerate(zip(simulation.sensors, tracks(run), strict=True)):
        force = _dynamic_force(samples, reading.name, track)
        if force is None:
            continue
        if reading.missing:
            raise SceneError(f"{reading.name}: {reading.missing}")
        pulse = compared(_numbers, (time, force), (time[::2], force[::2]))
        if not first:
            first = reading.name
            shift = reading.numbers["arrival"].value - pulse["arrival"].value
        pulse["arrival"] = derived(lambda t, by=shift: t + by, pulse["arrival"])
        for name, quantity in _LABELS.items():
            ours, theirs = reading.numbers[name], pulse[name]
            less = theirs.value - ours.value
            numbers = ours, theirs, Measured(less, less + ours.error + theirs.error)
            rows.append((reading.name, track.kind, track.number, label(quantity), name, *numbers))
        curves += [
            Curve(f"{reading.name}, simulated", t, track.force(t), f"C{i}-"),
            Curve("measured", time + shift, force, f"C{i}."),
        ]
    if not first:
        raise SceneError(
            f"{measured}: no column is {' or '.join(f'{name}force' for name in names)}"
        )
    unit = f"{shift:.6g} s" if chain.units else f"{shift:.6g}"
    return Report(
        str(chain),
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(Panel(label("time"), label("dynamic force"), tuple(curves), legend_above=True),),
        notes=(_NOTE.format(unit, first),),
        data={"shift_value": shift},
    )


def _dynamic_force(samples: Mapping[str, Array], name: str, track: Track) -> Array | None:
    """Return the measured dynamic force at a sensor; None without a column of it."""
    for prefix in (f"{name} ", ""):
        if (total := samples.get(f"{prefix}force")) is not None:
            return total - track.static
        if (dynamic := samples.get(f"{prefix}dynamic force")) is not None:
            return dynamic
    return None


def _numbers(samples: tuple[Array, Array]) -> dict[str, float]:
    """Return `READINGS` of the first pulse in a record, sample times and forces."""
    sampled = Sampled(*samples)
    return readings(dense(sampled, first_pulse(sampled)))
