"""Any scene: arrival, peak force, FWHM and speed at its sensors; as text, picture and file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path

import click
import numpy as np

import validation.scenes
from validation.lattice.effort import RunProgress
from validation.lattice.simulate import COMPILED, METHODS
from validation.pictures.panel import Curve, Map, Panel
from validation.pulses.sensors import (
    READINGS,
    SPEEDS,
    TOLERANCE,
    Reading,
    Recording,
    Track,
    record,
    tracks,
)
from validation.report.command import option, study
from validation.report.files import output_file
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import document, read
from validation.studies.records import KEPT, SUFFIXES, load, store

_NOTE = """\
The first pulse at each sensor, dynamic forces, in {} units. ±: by how much a less
accurate run differs."""
_SI = {  # what is shown, with its unit where a scene is in SI
    "arrival": "arrival (s)",
    "peak force": "peak force (N)",
    "FWHM": "FWHM (s)",
    "sites/time": "sites/s",
    "length/time": "m/s",
    "time": "time (s)",
    "dynamic force": "dynamic force (N)",
}
_MOST = 10  # sensors of a kind that are drawn as curves; more as a map
_FINEST = 1000  # places and times of a map


def _example(name: str) -> tuple[str, str]:
    """What an example is, which the first line of its file says, and the file without it."""
    file = files(validation.scenes) / "examples" / f"{name}.toml"
    says, _, text = file.read_text(encoding="utf-8").partition("\n")
    return says.removeprefix("# "), text


# read with the command, whose help names them
EXAMPLES = {
    name: _example(name) for name in ("paper", "vertical", "precompressed", "defect", "trimer")
}
_EPILOG = "\n\n".join(
    (
        "\b\nExamples:\n"
        + "\n".join(f"  {name:14} {says}" for name, (says, _) in EXAMPLES.items()),
        "\b\nA scene names what is there, in SI units if its beads are of materials:\n"
        + EXAMPLES["paper"][1].replace("\n\n", "\n").rstrip(),
        "All keys: python -m pydoc validation.scenes.scenefile",
    )
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
    says = _SI if scene.units else {}
    duration = f"{scene.duration:g}{' s' if says else ''}"
    note = _NOTE.format(scene.units or "the scene's own")
    return Report(
        f"{scene.size} beads, {scene.contact_count} contacts{wall}, k = {scene.k:g}; duration "
        f"{duration}, energy drift {run.energy_drift:.0e}, momentum {momentum}",
        (
            _table("sensor", ("number",), READINGS, says, found.sensors),
            _table("speed", ("from", "to"), SPEEDS, says, found.speeds),
        ),
        panels=tuple(_panels(tracks(run), says)),
        notes=("\n".join(missing), note if found.sensors else ""),
        data={
            "scene": document(scene),
            "energy_drift_value": run.energy_drift,
            "momentum_drift_value": run.momentum_drift,
        },
    )


def _table(
    what: str,
    places: Sequence[str],
    labels: Mapping[str, str],
    says: Mapping[str, str],
    found: Sequence[Reading],
) -> Table:
    shown = {name: says.get(label, label) for name, label in labels.items()}
    measured = [Column(name, label, "", ".8g", error=True) for name, label in shown.items()]
    columns = (Column("", what), *map(Column, ("kind", *places)), *measured, Column("missing"))
    rows = ((r.name, r.kind, *r.places, *map(r.numbers.get, labels), r.missing) for r in found)
    return Table(columns, tuple(rows), f"{what}s")


def _panels(heard: Sequence[Track], says: Mapping[str, str]) -> Iterator[Panel]:
    """A panel of curves, and an x–t map for each kind of sensor of which there are many."""
    time, force = (says.get(name, name) for name in ("time", "dynamic force"))
    kinds = [[t for t in heard if t.kind == kind] for kind in ("bead", "contact")]
    few = [track for kind in kinds for track in kind if len(kind) <= _MOST]
    if few:
        yield Panel(time, force, tuple(Curve(f"{t.kind} {t.number}", t.time, t.force) for t in few))
    for kind in kinds:
        if len(kind) > _MOST:
            kind.sort(key=lambda track: track.number)
            x = kind[:: -(-len(kind) // _FINEST)]
            t = slice(None, None, -(-len(x[0].time) // _FINEST))
            values = np.array([track.force[t] for track in x]).T
            places = np.array([track.number for track in x], float)
            yield Panel(x[0].kind, time, map=Map(force, places, x[0].time[t], values))


def _read(path: str) -> Scene:
    return load(path).scene if path.lower().endswith(".npz") else read(path)


def _out(context: click.Context, given: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, SUFFIXES)


def _show(context: click.Context, given: click.Parameter, name: str | None) -> None:
    if name is not None:
        click.echo(EXAMPLES[name][1], nl=False)
        context.exit()


@study(
    click.argument("scene"),
    option(
        "--example",
        type=click.Choice(tuple(EXAMPLES)),
        is_flag=False,
        flag_value="paper",
        is_eager=True,
        expose_value=False,
        callback=_show,
        show_default=False,
        says="Print a scene to begin with, by default that of the paper.",
    ),
    option(
        "--out",
        callback=_out,
        metavar="FILE",
        says="Store the records in a file: .csv, or, "
        "with the result and the scene, which runs again, .json or .npz.",
    ),
    option(
        "--method",
        default=COMPILED[0],
        metavar="NAME",
        says=f"Of integration: {', '.join(COMPILED)} (compiled) or {', '.join(METHODS)} (SciPy).",
    ),
    option(
        "--rtol",
        default=TOLERANCE,
        says="Of the method; errors are those from a run at a tolerance 1000 times as large.",
    ),
    epilog=_EPILOG,
)
def run(
    scene: str,
    out: Path | None,
    method: str,
    rtol: float,
    picture: Path | None,
    run_progress: RunProgress,
) -> Report:
    """A scene from a file, TOML or JSON: arrival, peak force, FWHM and speed at its sensors."""
    what = _read(scene)
    for name, file in (("out", out), ("plot", picture)):
        if file is None:
            continue
        if file.exists() and file.samefile(scene):
            raise SceneError(f"{name} is {file}: it is the scene's own file, which would be lost")
        if file.suffix.lower() not in KEPT and not (what.bead_sensors or what.contact_sensors):
            raise SceneError(f"{name} is {file}, but the scene names no sensors")
    found = record(what, method=method, rtol=rtol, progress=run_progress)
    told = report(found)
    if out is not None:
        store(found.run, told.document(), out)
    return told
