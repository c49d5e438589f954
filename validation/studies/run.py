"""Any scene: arrival, peak force, FWHM and speed at its sensors; as text, picture and file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import click
import numpy as np

from validation.lattice.effort import RunProgress
from validation.lattice.simulate import COMPILED, METHODS
from validation.pulses.sensors import (
    READINGS,
    SPEEDS,
    TOLERANCE,
    Reading,
    Recording,
    record,
    tracks,
)
from validation.report.command import option, study
from validation.report.files import output_file, replacing
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import document, read

STORED = (".json", ".npz")
"""Suffixes of the files that `store` writes."""

_NOTE = (
    "The first pulse at each sensor, dynamic forces, in the scene's own units. ±: by how much a "
    "less\naccurate run differs."
)


def report(found: Recording) -> Report:
    """``scene`` (as in a file, see `validation.scenes.scenefile`), ``sensors``: ``kind``,
    ``number``, ``arrival_value``, ``peak_value``, ``fwhm_value``; ``speeds``: ``kind``, ``from``,
    ``to``, ``speed_sites_value``, ``speed_value`` (null without spacings); each value with its
    error, as ``arrival_error_value``, and all null where ``missing`` says why;
    ``energy_drift_value``, and ``momentum_drift_value``, null with a wall. In the picture the
    dynamic force at every sensor over time.
    """
    run, scene = found.run, found.run.scene
    wall = ", the last one the wall's" if scene.wall is not None else ""
    momentum = "not conserved" if (p := run.momentum_drift) is None else f"drift {p:.0e}"
    missing = [f"{r.name}: {r.missing}" for r in found.sensors + found.speeds if r.missing]
    curves = tuple(Curve(f"{t.kind} {t.number}", t.time, t.force) for t in tracks(run))
    return Report(
        f"{scene.size} beads, {scene.contact_count} contacts{wall}, k = {scene.k:g}; duration "
        f"{scene.duration:g}, energy drift {run.energy_drift:.0e}, momentum {momentum}",
        (_table("sensor", ("number",), READINGS, found.sensors),
         _table("speed", ("from", "to"), SPEEDS, found.speeds)),
        panels=(Panel("time", "dynamic force", curves),) if curves else (),
        notes=("\n".join(missing), _NOTE if found.sensors else ""),
        data={
            "scene": document(scene),
            "energy_drift_value": run.energy_drift,
            "momentum_drift_value": run.momentum_drift,
        },
    )  # fmt: skip


def _table(
    what: str, places: Sequence[str], labels: Mapping[str, str], found: Sequence[Reading]
) -> Table:
    measured = [Column(name, label, "", ".8g", error=True) for name, label in labels.items()]
    columns = (Column("", what), *map(Column, ("kind", *places)), *measured, Column("missing"))
    rows = ((r.name, r.kind, *r.places, *map(r.numbers.get, labels), r.missing) for r in found)
    return Table(columns, tuple(rows), f"{what}s")


def store(found: Recording, file: Path) -> None:
    """Write a recording with all its samples; only a complete file replaces an old one.

    JSON: the document of its `report` and ``records``, which holds the arrays of
    `validation.lattice.run.Run` under their names with ``_value``, in the order of
    ``sensors``. NumPy's .npz: the same arrays under their own names and ``document``, a JSON text.
    Static forces are included.
    """
    names = ("time", "contact_force", "compression", "bead_force", "bead_velocity")
    arrays = {name: getattr(found.run, name) for name in names}
    content = report(found).document()
    with replacing(file) as new, new.open("wb") as stream:
        if file.suffix.lower() == ".npz":
            np.savez_compressed(stream, document=json.dumps(content), **arrays)
        else:
            records = {f"{name}_value": array.tolist() for name, array in arrays.items()}
            stream.write(json.dumps(content | {"records": records}).encode())


def _read(context: click.Context, given: click.Parameter, path: str) -> Scene:
    return read(path)


def _out(context: click.Context, given: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, STORED)


@study(
    click.argument("scene", callback=_read),
    option("--out", callback=_out, metavar="FILE", says="Store the result, the records and the "
           f"scene in a file ({', '.join(STORED)})."),
    option("--method", default=METHODS[0], metavar="NAME", says="Of integration: "
           f"{', '.join(METHODS)} (SciPy) or {', '.join(COMPILED)} (compiled)."),
    option("--rtol", default=TOLERANCE, says="Of the method; errors are those from a run at a "
           "tolerance 1000 times as large."),
)  # fmt: skip
def run(
    scene: Scene, out: Path | None, method: str, rtol: float, picture: Path | None,
    run_progress: RunProgress,
) -> Report:  # fmt: skip
    """A scene from a file, TOML or JSON: arrival, peak force, FWHM and speed at its sensors."""
    if picture is not None and not (scene.bead_sensors or scene.contact_sensors):
        raise SceneError("plot is asked for, but the scene names no sensors")
    found = record(scene, method=method, rtol=rtol, progress=run_progress)
    if out is not None:
        store(found, out)
    return report(found)
