"""Any scene: arrival, peak force, FWHM and speed at its sensors; as text, picture and file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from validation.lattice.run import IntegrationError
from validation.lattice.simulate import COMPILED, METHODS
from validation.pulses.pulse import Measured
from validation.pulses.sensors import (
    READINGS,
    SPEEDS,
    TOLERANCE,
    Recording,
    Sensor,
    Speed,
    record,
    tracks,
)
from validation.report.command import output, run_progress, show
from validation.report.figure import figure
from validation.report.files import output_file, replacing
from validation.report.text import document, table, text
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import document as scene_document
from validation.scenes.scenefile import read

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STORED = (".json", ".npz")
"""Suffixes of the files that `store` writes."""

RECORDS = ("time", "contact_force", "compression", "bead_force", "bead_velocity")
"""The samples of a `validation.lattice.run.Run`."""


@text.register
def _(result: Recording) -> str:
    scene = result.run.scene
    wall = ", the last one the wall's" if scene.wall is not None else ""
    momentum = result.run.momentum_drift
    head = (
        f"{scene.size} beads, {scene.contact_count} contacts{wall}, k = {scene.k:g}; "
        f"duration {scene.duration:g}, energy drift {result.run.energy_drift:.0e}"
        + (", momentum not conserved" if momentum is None else f", momentum drift {momentum:.0e}")
    )
    sensors = [(f"{s.kind} {s.number}", s) for s in result.sensors]
    speeds = [(f"{s.kind} {s.start} → {s.end}", s) for s in result.speeds]
    blocks = [head]
    for header, names, lines in (
        (("sensor", "arrival", "peak force", "FWHM"), READINGS, sensors),
        (("speed", "sites/time", "length/time"), SPEEDS, speeds),
    ):
        rows = [(label, *(_number(s.numbers.get(name)) for name in names)) for label, s in lines]
        if rows:
            blocks.append(table(header, rows))
    blocks += ["\n".join(f"{label}: {s.missing}" for label, s in sensors + speeds if s.missing)]
    if sensors:
        blocks.append(
            "The first pulse at each sensor, dynamic forces, in the scene's own units. ±: by how "
            "much a less\naccurate run differs."
        )
    return "\n\n".join(filter(None, blocks))


def _number(measured: Measured | None) -> str:
    return "-" if measured is None else f"{measured.value:.8g} ± {measured.error:.0e}"


@document.register
def _(result: Recording) -> dict[str, Any]:
    """``scene`` (as in a file, see `validation.scenes.scenefile`), ``sensors``: ``kind``,
    ``number``, ``arrival_value``, ``peak_value``, ``fwhm_value``; ``speeds``: ``kind``, ``from``,
    ``to``, ``speed_sites_value``, ``speed_value`` (null without spacings); each value with its
    error, as ``arrival_error_value``, and all null where ``missing`` says why;
    ``energy_drift_value``, and ``momentum_drift_value``, null with a wall.
    """
    return {
        "scene": scene_document(result.run.scene),
        "sensors": [
            {"kind": s.kind, "number": s.number} | _values(READINGS, s) for s in result.sensors
        ],
        "speeds": [
            {"kind": s.kind, "from": s.start, "to": s.end} | _values(SPEEDS, s)
            for s in result.speeds
        ],
        "energy_drift_value": result.run.energy_drift,
        "momentum_drift_value": result.run.momentum_drift,
    }


def _values(names: Sequence[str], found: Sensor | Speed) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name in names:
        measured = found.numbers.get(name)
        values[f"{name}_value"] = None if measured is None else measured.value
        values[f"{name}_error_value"] = None if measured is None else measured.error
    return values | {"missing": found.missing}


def store(result: Recording, file: Path) -> None:
    """Write a recording with all its samples; only a complete file replaces an old one.

    JSON: the `document` and ``records``, which holds the arrays of
    `validation.lattice.run.Run` under their names with ``_value``, in the order of
    ``sensors``. NumPy's .npz: the same arrays under their own names and ``document``, a JSON text.
    Static forces are included.
    """
    arrays = {name: getattr(result.run, name) for name in RECORDS}
    content = document(result)
    with replacing(file) as new, new.open("wb") as stream:
        if file.suffix.lower() == ".npz":
            np.savez_compressed(stream, document=json.dumps(content), **arrays)
        else:
            records = {f"{name}_value": array.tolist() for name, array in arrays.items()}
            stream.write(json.dumps(content | {"records": records}).encode())


@figure.register(Recording)
def _(result: Recording) -> Figure:
    """The dynamic force at every sensor over time."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(8, 4.5), layout="constrained")
    axes = picture.subplots()
    for track in tracks(result.run):
        axes.plot(track.time, track.force, label=f"{track.kind} {track.number}")
    axes.set(xlabel="time", ylabel="dynamic force")
    axes.legend()
    return picture


def _read(context: click.Context, argument: click.Parameter, path: str) -> Scene:
    return read(path)


def _store(context: click.Context, option: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, STORED)


@click.command("run")
@click.argument("scene", callback=_read)
@click.option(
    "--out", callback=_store, metavar="FILE",
    help=f"Store the result, the records and the scene in a file ({', '.join(STORED)}).",
)  # fmt: skip
@click.option(
    "--method", default=METHODS[0], show_default=True, metavar="NAME",
    help=f"Of integration: {', '.join(METHODS)} (SciPy) or {', '.join(COMPILED)} (compiled).",
)  # fmt: skip
@click.option(
    "--rtol", type=float, default=TOLERANCE, show_default=True,
    help="Of the method; errors are those from a run at a tolerance 1000 times as large.",
)  # fmt: skip
@output
def run_command(
    scene: Scene,
    out: Path | None,
    method: str,
    rtol: float,
    style: str,
    picture: Path | None,
) -> None:
    """A scene from a file, TOML or JSON: arrival, peak force, FWHM and speed at its sensors."""
    if picture is not None and not (scene.bead_sensors or scene.contact_sensors):
        raise SceneError("plot is asked for, but the scene names no sensors")
    try:
        result = record(scene, method=method, rtol=rtol, progress=run_progress)
    except IntegrationError as error:
        raise click.ClickException(str(error)) from None
    if out is not None:
        store(result, out)
    show(result, style, picture)
