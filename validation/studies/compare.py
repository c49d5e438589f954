"""Measured records of forces beside the simulation of their scene, aligned by arrival."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import click

from lwa.base.arrays import Array
from validation.lattice.run import Run, RunProgress, silent
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, Pulse, compared, dense, derived, first_pulse
from validation.pulses.sensors import READINGS, Reading, Track, record, tracks
from validation.pulses.signals import Sampled
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError, columns
from validation.scenes.scenefile import read_scene

_COLUMNS = (
    *(Column("", "sensor"), Column("kind"), Column("number")),
    *(Column("", "first pulse"), Column("quantity")),
    Column("simulated", "simulated", error=True),
    Column("measured", "measured", error=True),
    Column("difference", "difference", error=True),
)
_NOTE = (
    "First pulses of dynamic forces. Measured times are shifted by {}, so that the pulses arrive "
    "together at {}. ±: of the simulation, difference to a less accurate run; of the measurement, "
    "to every other sample."
)


@study(click.argument("scene"), click.argument("measured"))
def compare(scene: str, measured: str, run_progress: RunProgress = silent) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.

    The file of measurements, CSV, has the columns time and, for each sensor such as bead 15,
    "bead 15 force" (static force included) or "bead 15 dynamic force"; with one sensor in the
    scene also plain "force" or "dynamic force". ``rows``: ``kind``, ``number``, ``quantity``
    ("arrival", "peak" or "fwhm"), ``simulated_value``, ``measured_value`` and
    ``difference_value``, measured less simulated, with errors; ``shift_value``.
    """
    what = read_scene(scene)
    if not (what.bead_sensors or what.contact_sensors):
        raise SceneError(f"{scene}: the scene names no sensors")
    found = record(what, progress=run_progress)
    heard = tracks(found.run)
    records = dict(_records(measured, heard))
    pairs = [
        (reading, track)
        for reading, track in zip(found.sensors, heard, strict=True)
        if (track.kind, track.number) in records
    ]
    for reading, _ in pairs:
        if reading.missing:
            raise SceneError(f"{reading.name}: {reading.missing}")
    rows: list[tuple[Any, ...]] = []
    curves, shift = [], 0.0
    for i, (reading, track) in enumerate(pairs):
        time, force = records[track.kind, track.number]
        seen = compared(_numbers, (time, force), (time[::2], force[::2]))
        if i == 0:
            shift = reading.numbers["arrival"].value - seen["arrival"].value
        seen["arrival"] = derived(lambda t, by=shift: t + by, seen["arrival"])
        rows += _rows(reading, seen, found.run)
        t = found.run.time
        curves += [
            Curve(f"{reading.name}, simulated", t, track.force(t), f"C{i}-"),
            Curve("measured", time + shift, force, f"C{i}."),
        ]
    label, first = found.run.label, pairs[0][0].name
    unit = f"{shift:.6g} s" if what.units else f"{shift:.6g}"
    return Report(
        str(what),
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(Panel(label("time"), label("dynamic force"), tuple(curves), legend_above=True),),
        notes=(_NOTE.format(unit, first),),
        data={"shift_value": shift},
    )


def _records(
    path: str, heard: tuple[Track, ...]
) -> Iterator[tuple[tuple[str, int], tuple[Array, Array]]]:
    """Yield (kind, number) of each measured sensor, and its sample times and dynamic forces."""
    names = {f"{track.kind} {track.number} ": track for track in heard}
    if len(heard) == 1:
        names[""] = heard[0]
    kinds = ("force", "dynamic force")
    found = columns(path, "time", optional=[name + kind for name in names for kind in kinds])
    if len(found) == 1:
        wanted = " or ".join(f"{name}force" for name in names)
        raise SceneError(f"{path}: no column is {wanted}")
    for name, track in names.items():
        for kind in kinds:
            if name + kind in found:
                static = 0.0 if kind == "dynamic force" else track.static
                yield (track.kind, track.number), (found["time"], found[name + kind] - static)


def _numbers(samples: tuple[Array, Array]) -> dict[str, float]:
    sampled = Sampled(*samples)
    pulse: Pulse = dense(sampled, first_pulse(sampled))
    return {name: getattr(pulse, name) for name in READINGS}


def _rows(simulated: Reading, seen: Mapping[str, Measured], run: Run) -> Iterator[tuple[Any, ...]]:
    """Yield table rows: a simulated number, the measured one, and the difference with its error."""
    names = dict(zip(READINGS, ("arrival", "peak dynamic force", "FWHM"), strict=True))
    for name, quantity in names.items():
        one, other = simulated.numbers[name], seen[name]
        less = other.value - one.value
        difference = Measured(less, less + one.error + other.error)
        place = (simulated.name, simulated.kind, simulated.places[0])
        yield (*place, run.label(quantity), name, one, other, difference)
