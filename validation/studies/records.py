"""Measured records of forces and velocities: their pulses, and their scene's simulation beside."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Unpack

import click

from lwa.base.exact import shorten
from lwa.base.frozen import Estimate
from lwa.command.cli import called
from lwa.command.options import Words
from validation.lattice.cost import RunProgress, silent
from validation.pictures import Curve, Panel
from validation.pulses.noisy import (
    InvertedError,
    NoisyPulse,
    corrected,
    noisy_pulse,
    suggested,
)
from validation.pulses.pulse import MeasureError
from validation.pulses.sensors import Reading, forces_at_start, record, speeds_between
from validation.report.study import Report, number, option, study
from validation.report.table import Column, Estimates, Table
from validation.scenes.checks import SceneError, one_of, positive
from validation.scenes.columns import BASES, Stated, read_time
from validation.scenes.measured import MeasuredFile, Record
from validation.scenes.scenefile import check_units, read_scene
from validation.studies.run import reading_tables

Paths = str | Path | Sequence[str | Path]
"""The name of a file, "-" for standard input, or the names of several files."""

_KINDS = ("bead", "contact")
_PULSES = (
    "First pulse at each sensor, in {} units; forces are counted from the static force, the base "
    "before the pulse. ±: one standard deviation by the noise before the pulse; without noise, the "
    "difference to every second sample."
)
_UNIT = (
    "Unit of a column, as in --unit time=us, --unit 'time=0.04 us' (of an entry 1), --unit "
    "'CH1=12.5 N/V', 'CH1=80 mV/N' or, in SI, --unit CH1=12.5; repeatable. It stands above the "
    "file's own. With 'CH1=? N/V' no peak is read. If one unit is stated, all are wanted."
)
_COLUMN = (
    "Header or number, from 1, of a column, as in --column time=1 --column 'bead 8 force=CH1'; "
    "repeatable. Names: time, bead 8 force, contact 8 force, bead 8 velocity, force, speed."
)

_TIMES = {"column": "1", "unit": "s"}  # examples of statements on the column of times


def _pairs(
    context: click.Context, given: click.Parameter, pairs: Sequence[str]
) -> dict[str, str]:
    """Read the texts NAME=VALUE of an option."""
    stated = {}
    fault = ""
    for pair in pairs:
        name, equals, value = (part.strip() for part in pair.partition("="))
        if not (name and equals and value) or name in stated:
            fault = shorten(pair)
        else:
            stated[name] = value
    if fault:
        # The line that is proposed keeps the valid pairs, and has an example if there are none.
        wanted = f"{given.metavar} is wanted, once a name"
        key = called(given)
        change = {key: stated or {"time": _TIMES[key]}}
        raise SceneError(f"{key} is {fault}: {wanted}", **change)
    return stated


COLUMN_OPTIONS = (
    option(
        "--column",
        _COLUMN,
        to="columns",
        callback=_pairs,
        multiple=True,
        metavar="NAME=HEADER|NUMBER",
    ),
    option(
        "--unit", _UNIT, to="units", callback=_pairs, multiple=True, metavar="NAME=UNIT"
    ),
)
"""Options of a study that reads a measured file."""

RECORD_OPTIONS = (
    *COLUMN_OPTIONS,
    option(
        "--step",
        "Time from sample to sample, or the rate, in place of a column, as in --step '0.4 ms'.",
        metavar="TIME",
    ),
    option(
        "--time-constant",
        "Time in which sensors lose their charge, which is corrected, as in "
        "--time-constant '0.4 ms'.",
        metavar="TIME",
    ),
)
"""Options of a study that reads records."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Records of sensors, from one or several files.

    Parameters
    ----------
    signals : sequence of Record
        Records, each sensor once.
    si : bool
        Whether they are in SI.
    """

    signals: Sequence[Record]
    si: bool

    @classmethod
    def read(
        cls,
        paths: Paths,
        of: str,
        time_constant: str | None,
        stated: Stated,
        wanted: Sequence[str] = ("force",),
    ) -> Measured:
        """Read files; records of sensors with a time constant are corrected.

        Several sensors without a number are numbered in the order of files and columns. Several
        names of one column are those of the files in turn. The ``wanted`` names are proposed for
        columns of files without sensors. Raises `SceneError` for files of which some have no units,
        and for a sensor that is there twice.
        """
        constant = math.inf
        if time_constant:
            constant = read_time(time_constant, "time_constant")
        names = [paths] if isinstance(paths, str | Path) else [*paths]
        # Files of one sensor each may have one header: its names are those of the files in turn.
        by_header: dict[str, list[str]] = {}
        for name, header in (stated.get("columns") or {}).items():
            by_header.setdefault(header, []).append(name)
        files = []
        for place, path in enumerate(names):
            columns = {
                own[place % len(own)]: header for header, own in by_header.items()
            }
            files.append(MeasuredFile.read(path, **stated | {"columns": columns}))
        # A picture, or a comparison, has one unit for each quantity: all files have units, or none.
        for file in files:
            if file.si != files[0].si:
                raise SceneError(
                    f"{file.path}: it has units, {names[0]} not, or the reverse"
                )
        records = [record for file in files for record in file.records(of, wanted)]
        signals = {}
        for place, signal in enumerate(records, start=1):
            # A single sensor needs no number.
            if len(records) > 1:
                signal = replace(signal, number=signal.number or place)
            if time_constant:
                values = corrected(signal.time, signal.values, constant)
                signal = replace(signal, values=values)
            if (signal.kind, signal.number) in signals:
                raise SceneError(f"{signal.kind} {signal.number} is there twice")
            signals[signal.kind, signal.number] = signal
        return cls([*signals.values()], files[0].si)

    def pulse(self, signal: Record) -> NoisyPulse:
        """Measure the first pulse of a record.

        Raises
        ------
        MeasureError
            For a record without a whole pulse. For an inverted record the error proposes the
            user's statements of units with the sign changed, which turn the record upright.
        """
        try:
            pulse = noisy_pulse(signal.time, signal.values, self.unit)
        except InvertedError as error:
            raise MeasureError(str(error), units=signal.turned) from None
        if signal.doubt:
            numbers = {**pulse.numbers}
            numbers.pop("peak", None)
            missing = f"no peak: a number in place of the ? in {signal.doubt} is wanted"
            pulse = replace(pulse, numbers=numbers, base=math.nan, missing=missing)
        return pulse

    @property
    def unit(self) -> str:
        """Unit of the times, "" if it is the file's own."""
        return "s" if self.si else ""

    def panel(self, curves: Sequence[Curve]) -> Panel:
        """Return a picture of the signals."""
        axes = []
        quantities = {signal.quantity for signal in self.signals}
        for quantity in ("time", *sorted(quantities)):
            axes.append(f"{quantity} ({BASES[quantity]})" if self.si else quantity)
        time, *signals = axes
        return Panel(time, ", ".join(signals), curves, legend_above=True)


@study(
    click.argument("records", type=click.Path(), nargs=-1, required=True),
    option(
        "--distance",
        "Distance of neighbouring beads: in m, or in the unit of a file without units.",
        read=number,
    ),
    option(
        "--of",
        "Where sensors sit whose columns do not say it.",
        default="contact",
        type=Words(_KINDS),
    ),
    *RECORD_OPTIONS,
    page="experiment",
    examples=(
        "lwa-validate run --example > scene.toml",
        "lwa-validate run scene.toml --out forces.csv",
        "lwa-validate pulses forces.csv --distance 4.76e-3",
    ),
)
def pulses(
    records: Paths,
    distance: float | None = None,
    of: str = "contact",
    time_constant: str | None = None,
    **stated: Unpack[Stated],
) -> Report:
    """Pulses at sensors, and the speeds between them. RECORDS, files of any recorder or program (-
    is standard input), have the columns time and, for each sensor, such as "bead 15 force", "15
    force", "bead 15 velocity" or "force"; --column names others by header or number. Beads and
    contacts are counted from 1; several sensors without a number, in the order of files and
    columns. Units are stated in the file or by --unit: results are then in SI, as is a distance;
    without any they are in the file's own units. One column time serves all sensors; or the first
    serves the first one, the next the next.

    ``sensors`` and ``speeds`` as of `validation.studies.run`, the static force from the
    record. A sensor has the speeds from the sensor before as well, so that the CSV holds them all.

    Raises `MeasureError` where no sensor has a pulse.
    """
    one_of(of, _KINDS, "of")
    apart = None if distance is None else positive(distance, "distance")
    read = Measured.read(records, of, time_constant, stated)
    found = []
    curves = []
    notes = []
    refusals = []
    for i, signal in enumerate(read.signals):
        # Beads, and contacts, lie a site apart; where they begin does not matter to a speed.
        site = signal.number or 1
        along = {"speed_sites": float(site)}
        if apart is not None:
            along["speed"] = apart * site
        blank = Reading(
            signal.kind, (site,), {}, math.nan, quantity=signal.quantity, along=along
        )
        curves.append(Curve(blank.name, signal.time, signal.values, f"C{i}-"))
        try:
            pulse = read.pulse(signal)
        except MeasureError as error:
            found.append(replace(blank, missing=error.reason))
            refusals.append(error)
            if error.change:
                turned = f"{signal.key}={signal.turned[signal.key]}"
                notes.append(f"{blank.name}: --unit '{turned}' turns it.")
            continue
        reading = replace(
            blank, numbers=pulse.numbers, missing=pulse.missing, static=pulse.base
        )
        found.append(reading)
        hint = suggested(signal.time, signal.values, pulse, read.unit)
        if hint and not time_constant:
            notes.append(f"{blank.name}: {hint}")
    # The first refusal may know the statement that turns an inverted record.
    if len(refusals) == len(found):
        raise MeasureError(
            f"no sensor has a pulse: {found[0].name}: {found[0].missing}",
            **refusals[0].change,
        )
    # The noise of two sensors is independent.
    speeds = speeds_between(found, math.hypot)
    tables, missing = reading_tables(found, speeds, "peak", read.si)
    units = "SI" if read.si else "the file's own"
    return Report(
        ", ".join(map(str, [records] if isinstance(records, str | Path) else records)),
        tables,
        panels=(read.panel(curves),),
        notes=(missing, *notes, _PULSES.format(units)),
    )


_COLUMNS = (
    Column("", "first pulse"),
    Column("kind"),
    Column("number"),
    Column("quantity"),
    Estimates("simulated", "simulated"),
    Estimates("measured", "measured"),
    Estimates("difference", "difference"),
)
_COMPARED = (
    "First pulses of dynamic forces. Measured times are shifted by {}, so that the pulses arrive "
    "together at {}. ±: of the simulation, differences to a more accurate run; of the measurement, "
    "one standard deviation by the noise before the pulse."
)


@study(
    click.argument("scene", type=click.Path()),
    click.argument("measured", type=click.Path(), nargs=-1, required=True),
    *RECORD_OPTIONS,
    page="experiment",
    examples=(
        "lwa-validate run --example > scene.toml",
        "lwa-validate run scene.toml --out forces.csv",
        "lwa-validate compare scene.toml forces.csv",
    ),
)
def compare(
    scene: str,
    measured: Paths,
    time_constant: str | None = None,
    run_progress: RunProgress = silent,
    **stated: Unpack[Stated],
) -> Report:
    """Measured forces at the sensors of a scene beside the simulated ones: arrival, peak, FWHM.

    SCENE is a scene file, as of `lwa-validate run`. MEASURED, files as of `lwa-validate pulses`,
    have the columns time and, for each sensor, such as "bead 15 force" or "bead 15 velocity"; for a
    single sensor also "force". Without units they are in the scene's own numbers. Base and slope of
    a record are those of its part before the pulse; simulated forces count from the start.

    ``rows``: ``kind``, ``number``, ``quantity`` ("arrival", "peak" or "fwhm"), ``simulated_value``,
    ``measured_value`` and ``difference_value``, measured less simulated, with errors;
    ``shift_value``.
    """
    chain = read_scene(scene)
    sensors = [*forces_at_start(chain)]
    wanted = [f"{name} force" for name in sensors]
    read = Measured.read(measured, "contact", time_constant, stated, wanted)
    check_units(read.si, chain.units, "the measured file")
    signals = _by_sensor(read, sensors, stated)
    found = {}
    for name, signal in signals.items():
        try:
            found[name] = read.pulse(signal)
        except MeasureError as error:
            raise MeasureError(f"{name}: {error.reason}", **error.change) from None
    # The simulation has the quantity that was measured at each sensor.
    velocities = [name for name, s in signals.items() if s.quantity == "velocity"]
    simulation = record(chain, velocities=velocities, progress=run_progress)
    run = simulation.run
    simulated = {}
    for track in simulation.sensors:
        name = f"{track.kind} {track.number}"
        if name in signals:
            if track.missing:
                raise SceneError(f"{track.name}: {track.missing}")
            simulated[name] = track
    # A recorder starts at any time: measured times are shifted so that the first pulses arrive
    # together at the first sensor.
    first, leader = next(iter(simulated.items()))
    late = found[first].numbers["arrival"]
    shift = Estimate(leader.numbers["arrival"].value - late.value, late.error)
    rows = []
    curves = []
    for i, (name, track) in enumerate(simulated.items()):
        theirs = dict(found[name].numbers)
        arrival = theirs["arrival"]
        doubt = arrival.error
        # The shift has the error of the first arrival, and is a part of the arrivals at the other
        # sensors.
        if name != first:
            doubt = math.hypot(doubt, shift.error)
        theirs["arrival"] = Estimate(arrival.value + shift.value, doubt)
        peak = f"peak dynamic {track.quantity}"
        labels = {"arrival": "arrival", "peak": peak, "fwhm": "FWHM"}
        for quantity, measured_number in theirs.items():
            ours = track.numbers[quantity]
            off = measured_number.value - ours.value
            rows.append(
                {
                    "first pulse": f"{track.name}: {run.label(labels[quantity])}",
                    "kind": track.kind,
                    "number": track.number,
                    "quantity": quantity,
                    "simulated": ours,
                    "measured": measured_number,
                    "difference": Estimate(off, ours.error + measured_number.error),
                }
            )
        # In the picture both are dynamic: measured signals less their base, simulated ones less the
        # force at the start.
        ours_drawn = track.force(run.time)
        curves.append(Curve(f"{track.name}, simulated", run.time, ours_drawn, f"C{i}-"))
        times = signals[name].time + shift.value
        swing = signals[name].values - found[name].base
        curves.append(Curve("measured", times, swing, f"C{i}."))
    shown = f"{shift.value:.6g} {chain.units and 's'}".strip()
    return Report(
        str(chain),
        (Table(_COLUMNS, rows, "rows"),),
        panels=(read.panel(curves),),
        notes=(_COMPARED.format(shown, leader.name),),
        data={"shift_value": shift.value},
    )


def _by_sensor(
    read: Measured, sensors: Sequence[str], stated: Stated
) -> dict[str, Record]:
    """Return the measured signals by the names of a scene's sensors, at least one.

    Signals at other sensors are left out. If none is left, the error proposes the file's signals
    for the scene's first sensors.
    """
    named = {}
    for signal in read.signals:
        name = f"{signal.kind} {signal.number}"
        # A single sensor of the scene needs no number in the file.
        if signal.number is None and len(sensors) == 1:
            (name,) = sensors
        if name in sensors:
            named[name] = signal
    if named:
        return named
    wanted = " or ".join(sensors[:5]) or "wanted: the scene has none"
    # The signals of the file are proposed for the first sensors of the scene.
    headers = {}
    for name, header in (stated.get("columns") or {}).items():
        if not name.endswith(("force", "velocity")):
            headers[name] = header
    for sensor, signal in zip(sensors, read.signals, strict=False):
        headers[f"{sensor} {signal.quantity}"] = str(signal.column)
    raise SceneError(f"no measured sensor is {wanted}", columns=headers)
