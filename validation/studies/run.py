"""Simulation of a scene: pulses at its sensors, and files of the records.

A stored run holds the records of the sensors, the pulses measured in them. JSON: the
result's document, and under ``records`` the arrays of `validation.lattice.result.Run`, their
names ending in ``_value``. CSV, for spreadsheets: time and records by sensor, with units in the
header, but not the result. Forces are total: static forces are included.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from lwa.command.options import Words
from lwa.spheres.hertz import MATERIALS
from validation.lattice.cost import RunProgress
from validation.lattice.signal import RECORDS
from validation.lattice.simulate import COMPILED
from validation.lattice.steppers import METHODS
from validation.pulses.sensors import (
    TOLERANCE,
    Reading,
    Recording,
    enough_samples,
    record,
)
from validation.report.study import Report, option, output_option, replacing, study
from validation.report.table import Column, Estimates, Table, plain
from validation.scenes.checks import SceneError
from validation.scenes.columns import BASES
from validation.scenes.scenefile import packaged, read_scene

EXAMPLES = ("paper", "vertical", "precompressed", "defect", "trimer", "striker")
"""Names of the examples of scene files."""

_NOTE = "{} at each sensor, in {} units. ±: differences to a more accurate run."
_FIRST = "First pulse above half of the record's maximum"
_DYNAMIC = (
    "\nDynamic force: force less that at the start, the static force in equilibrium."
)


def example(name: str) -> str:
    """Return the text of an example scene file."""
    return packaged(f"examples/{name}.toml")


def report(recording: Recording, every: bool = False) -> Report:
    """Return the report of a run, with all pulses at each sensor (``every``) or only the first.

    Keys of the JSON document:
    ``sensors``: ``kind``, ``number``, with ``every`` ``pulse``, counted from 1, ``arrival_value``,
    ``peak_value`` (of the dynamic force), ``fwhm_value``, ``static_force_value``, ``missing``;
    ``speeds``: ``kind``, ``from``, ``to``, ``speed_sites_value``, ``speed_value`` (null without
    spacings), ``missing``; ``end`` of the bead sensors: ``bead``, ``velocity_value`` and
    ``displacement_value`` at the end; each value with its error, as ``arrival_error_value``, and
    null where ``missing`` is the reason; ``energy_drift_value``; with damping the energy
    ``dissipated_value``, with a drive its ``work_value``.
    """
    run = recording.run
    scene = run.scene
    title = f"{scene}, energy drift {run.energy_drift:.0e}"
    joule = scene.units and " J"
    data = {"energy_drift_value": run.energy_drift}
    if scene.damping is not None:
        data["dissipated_value"] = run.dissipated
        title += f", dissipated {run.dissipated:.6g}{joule}"
    if scene.drive is not None:
        data["work_value"] = run.work
        title += f", work {run.work:.6g}{joule}"
    which = "All pulses" if every else _FIRST
    note = _NOTE.format(which, scene.units or "the scene's own")
    peak = "peak force"
    if any(scene.load):
        note += _DYNAMIC
        peak = "peak dynamic force"
    if not recording.sensors:
        note = "No sensors: beads = [5] or contacts = [5] in [sensors] read pulses."
    tables, missing = reading_tables(
        recording.sensors,
        recording.speeds,
        peak,
        bool(scene.units),
        every,
    )
    columns = (
        Column("", "at the end"),
        Column("bead"),
        Estimates("velocity", run.label("velocity")),
        Estimates("displacement", run.label("displacement")),
    )
    end = [
        {"at the end": f"bead {bead}", "bead": bead, **state}
        for bead, state in recording.end.items()
    ]
    return Report(
        title,
        (*tables, Table(columns, end, "end")),
        panels=run.pictured(),
        notes=(missing, note),
        data=data,
    )


def reading_tables(
    sensors: Sequence[Reading],
    speeds: Sequence[Reading],
    peak: str,
    si: bool,
    every: bool = False,
) -> tuple[list[Table], str]:
    """Return the tables ``sensors`` and ``speeds``, and lines on the numbers that are missing.

    The table of the sensors, which is the CSV, also holds the speeds of the first pulses from the
    sensor before; they are not printed twice.

    Parameters
    ----------
    sensors : sequence of Reading
        Pulses at the sensors.
    speeds : sequence of Reading
        Speeds between sensors.
    peak : str
        Label of the peaks.
    si : bool
        Whether results are in SI units.
    every : bool
        True if later pulses are among them: the table has their numbers in a column ``pulse``.
    """
    time, speed, in_time = "time", "length/time", ""
    if si:
        time, speed, in_time = "s", "m/s", " (s)"
    quantities = sorted({reading.quantity for reading in sensors})
    if si:
        peak = f"{peak} ({', '.join(BASES[quantity] for quantity in quantities)})"
    kind = Column("kind")
    missing = Column("missing")
    columns = [Column("", "sensor"), kind, Column("number")]
    # Columns with one value in all rows, force or pulse 1, are left out.
    if "velocity" in quantities:
        columns.append(Column("signal"))
    if every:
        columns.append(Column("pulse", "pulse"))
    columns += [
        Estimates("arrival", f"arrival{in_time}", _arrival_format(sensors)),
        Estimates("peak", peak),
        Estimates("fwhm", f"FWHM{in_time}"),
        Column("static_force_value"),
        missing,
        Estimates("speed_sites"),
        Estimates("speed"),
    ]
    # The speed from the sensor before, by the sensor at which the pulse arrives
    arriving = {(leg.kind, leg.places[1]): leg.numbers for leg in speeds}
    rows = []
    for reading in sensors:
        row = _row("sensor", reading)
        if reading.pulse == 1:
            row |= arriving.get((reading.kind, reading.number), {})
        rows.append(row)
    legs = [
        Column("", "between"),
        kind,
        Column("from"),
        Column("to"),
        Estimates("speed_sites", f"sites/{time}"),
        Estimates("speed", speed),
        missing,
    ]
    leg_rows = [_row("between", leg) for leg in speeds]
    tables = [
        Table(columns, rows, "sensors"),
        Table(legs, leg_rows, "speeds"),
    ]
    lines = []
    for reading in (*sensors, *speeds):
        if reading.missing:
            lines.append(f"{reading.name}: {reading.missing}")
    return tables, "\n".join(lines)


def _row(label: str, reading: Reading) -> dict[str, Any]:
    """Return the cells of a reading, a row of a table, by the keys of the table's columns.

    label : key of the column that holds the reading's name.
    """
    places = ("number",) if len(reading.places) == 1 else ("from", "to")
    row = dict(zip(places, reading.places, strict=True))
    return row | {
        **reading.numbers,
        label: reading.name,
        "kind": reading.kind,
        "signal": reading.quantity,
        "pulse": reading.pulse,
        "static_force_value": reading.static,
        "missing": reading.missing,
    }


def _arrival_format(sensors: Sequence[Reading]) -> str:
    """Return the number of digits of arrivals, as the format of their column.

    Six digits, or as many as show a ten-thousandth of a pulse's width in its arrival: late pulses
    are thousands of widths away from time 0.
    """
    late = 1.0
    for reading in sensors:
        if "fwhm" in reading.numbers:
            arrival = reading.numbers["arrival"].value
            width = reading.numbers["fwhm"].value
            late = max(late, abs(arrival) / width)
    before_point = math.ceil(math.log10(late))
    return str(max(6, before_point + 4))


def print_option(
    name: str, text: Callable[[Any], str], says: str, **settings: Any
) -> Any:
    """Return an option that prints a text, a function of its value, and ends the command."""

    def show(context: click.Context, given: click.Parameter, value: Any) -> None:
        if value and not context.resilient_parsing:  # completion parses resiliently
            click.echo(text(value), nl=False)
            context.exit()

    settings |= {"is_eager": True, "expose_value": False, "callback": show}
    return option(name, says, **settings)


SUFFIXES = (".json", ".csv")

_METHODS = Words((*COMPILED, *METHODS))
_INTEGRATOR = f"Integrator: {' and '.join(COMPILED)} are compiled, the others SciPy's."
_RTOL = "Relative tolerance. Errors are differences to a more accurate run."


@study(
    click.argument("scene", type=click.Path()),
    print_option(
        "--example",
        example,
        "Print an example of a scene file, by default the paper's chain.",
        type=Words(EXAMPLES),
        is_flag=False,
        flag_value=EXAMPLES[0],
    ),
    print_option(
        "--keys",
        lambda _: packaged("keys.toml"),
        "Print all keys of a scene file, with examples.",
        is_flag=True,
    ),
    output_option(
        "--out",
        SUFFIXES,
        "Store the records in a file: .csv or, with the result, .json.",
    ),
    option("--method", _INTEGRATOR, default=COMPILED[0], type=_METHODS),
    option("--rtol", _RTOL, default=TOLERANCE),
    option(
        "--pulses",
        "Measure all pulses at each sensor, not only the first.",
        is_flag=True,
        default=False,
    ),
    page="recipes",
    examples=(
        "lwa-validate run --example > scene.toml",
        "lwa-validate run scene.toml --out forces.csv --plot forces.svg",
    ),
)
def run(
    scene: str,
    out: Path | None,
    method: str,
    rtol: float,
    pulses: bool,
    run_progress: RunProgress,
) -> Report:
    """A scene from a file, TOML or JSON: arrival, peak force, FWHM and speed at its sensors."""
    chain = read_scene(scene, enough_samples)
    # The files are compared, not their names: one may be a link to the other.
    if (
        out is not None
        and out.exists()
        and Path(scene).exists()
        and out.samefile(scene)
    ):
        raise SceneError(
            f"out is {out}: it is the scene's own file, which would be lost"
        )
    # A CSV holds the records alone; JSON has the result as well.
    as_csv = out is not None and out.suffix.lower() == ".csv"
    if as_csv and not (chain.bead_sensors or chain.contact_sensors):
        raise SceneError(f"out is {out}, but the scene names no sensors")
    recording = record(
        chain, method=method, rtol=rtol, every=pulses, progress=run_progress
    )
    result = report(recording, every=pulses)
    if out is None:
        return result
    done = recording.run
    with replacing(out) as new, new.open("wb") as stream:
        if as_csv:
            columns = done.columns()
            # "%s" writes the shortest text that reads back as the same float.
            rows = np.column_stack(list(columns.values()))
            header = ",".join(columns)
            np.savetxt(stream, rows, "%s", ",", header=header, comments="")
        else:
            names = "time", *RECORDS.values()
            records = {f"{name}_value": plain(getattr(done, name)) for name in names}
            document = {**result.document(), "records": records}
            stream.write(json.dumps(document).encode())
    return result


# --- materials ---

_MATERIALS = (
    Column("name", "material"),
    Column("E_value", "E (Pa)"),
    Column("nu_value", "ν"),
    Column("density_value", "density (kg/m³)"),
)
_MATERIALS_NOTE = """\
A bead of a file names its material, as in material = "PTFE". A material of the file's own may be
like another one but for the constants that are stated: [materials.soft], like = "PTFE", E = 6e8."""


@study(
    page="recipes",
    examples=("lwa-validate materials", "lwa-validate materials --format csv"),
)
def materials() -> Report:
    """Names and constants of the materials of beads.

    ``rows``: ``name``, Young's modulus ``E_value`` in Pa, Poisson's ratio ``nu_value`` and
    ``density_value`` in kg/m³. Sources: `lwa.spheres.hertz`.
    """
    rows = []
    for name, material in MATERIALS.items():
        row: dict[str, object] = {"name": name}
        for constant in ("E", "nu", "density"):
            row[f"{constant}_value"] = float(getattr(material, constant))
        rows.append(row)
    return Report("Materials", (Table(_MATERIALS, rows, "rows", note=_MATERIALS_NOTE),))
