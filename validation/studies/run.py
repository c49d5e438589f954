"""Any scene: arrival, peak force, FWHM and speed of the pulse at its sensors."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import click

import validation.scenes
from validation.lattice.run import Run, RunProgress
from validation.lattice.simulate import COMPILED, METHODS
from validation.pulses.sensors import READINGS, SPEEDS, TOLERANCE, Reading, Recording, record
from validation.report.command import option, study, whole
from validation.report.files import output_file
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import document, read_scene
from validation.studies.records import KEPT, SUFFIXES, load, store

_NOTE = "{} at each sensor, in {} units. ±: difference to a less accurate run."
_DYNAMIC = "\nDynamic force: force less the static force at the sensor."


def _example(name: str) -> tuple[str, str]:
    """Return the title of an example, the first line of its file, and the rest of the file."""
    file = files(validation.scenes) / "examples" / f"{name}.toml"
    title, _, text = file.read_text(encoding="utf-8").partition("\n")
    return title.removeprefix("# "), text


NAMES = ("paper", "vertical", "precompressed", "defect", "trimer")
EXAMPLES = {name: _example(name) for name in NAMES}  # at import: the command's help shows them
_LIST = "\n".join(f"  {name:14} {title}" for name, (title, _) in EXAMPLES.items())
_SHOWN = EXAMPLES["paper"][1].replace("\n\n", "\n").rstrip()
_EPILOG = f"""\b
Examples:
{_LIST}

\b
A scene file, in SI units if its beads are of materials:
{_SHOWN}

All keys: python -m pydoc validation.scenes.scenefile"""


def report(found: Recording, every: bool = False) -> Report:
    """Return the report of a run, with all pulses at each sensor (``every``) or only the first.

    Keys of the JSON document: ``scene`` (as in a file, see `validation.scenes.scenefile`);
    ``sensors``: ``kind``, ``number``, with ``every`` ``pulse``, counted from 1, ``arrival_value``,
    ``peak_value`` (of the dynamic force), ``fwhm_value``, ``static_force_value``, ``missing``;
    ``speeds``: ``kind``, ``from``, ``to``, ``speed_sites_value``, ``speed_value`` (null without
    spacings), ``missing``; each measured value with its error, as ``arrival_error_value``, and all
    null where ``missing`` says why;
    ``energy_drift_value``, and ``momentum_drift_value``, null with a wall; with damping the energy
    ``dissipated_value``, with a drive its ``work_value``.
    The picture shows the force at all sensors.
    """
    run, scene = found.run, found.run.scene
    momentum = "not conserved" if (p := run.momentum_drift) is None else f"drift {p:.0e}"
    missing = [f"{r.name}: {r.missing}" for r in found.sensors + found.speeds if r.missing]
    forced = {}
    if scene.damping is not None:
        forced["dissipated_value"] = run.dissipated
    if scene.drive is not None:
        forced["work_value"] = run.work
    spent = "".join(f", {name.removesuffix('_value')} {E:.6g}" for name, E in forced.items())
    which = "All pulses" if every else "First pulse"
    note = _NOTE.format(which, scene.units or "the scene's own") + _DYNAMIC * any(scene.load)
    return Report(
        f"{scene}, energy drift {run.energy_drift:.0e}{spent}, momentum {momentum}",
        (_sensors(run, found.sensors, every), _speeds(scene, found.speeds)),
        panels=tuple(run.pictured()),
        notes=("\n".join(missing), note if found.sensors else ""),
        data={
            "scene": document(scene),
            "energy_drift_value": run.energy_drift,
            "momentum_drift_value": run.momentum_drift,
        }
        | forced,
    )


def _sensors(run: Run, found: Sequence[Reading], every: bool) -> Table:
    """Return the table of the pulses; JSON alone has the column ``static_force_value``."""
    peak = "peak dynamic force" if any(run.scene.load) else "peak force"
    labels = (run.label("arrival"), run.label(peak), run.label("FWHM"))
    columns = (
        *(Column("", "sensor"), Column("kind"), Column("number")),
        *[Column("pulse", "pulse")] * every,
        *_measured(READINGS, labels),
        *(Column("static_force_value"), Column("missing")),
    )
    rows = (
        (r.name, r.kind, *r.places, *[r.pulse] * every, *_cells(r, READINGS), r.static, r.missing)
        for r in found
    )
    return Table(columns, tuple(rows), "sensors")


def _speeds(scene: Scene, found: Sequence[Reading]) -> Table:
    labels = ("sites/s", "m/s") if scene.units else ("sites/time", "length/time")
    columns = (
        *(Column("", "speed"), Column("kind"), Column("from"), Column("to")),
        *(*_measured(SPEEDS, labels), Column("missing")),
    )
    rows = ((r.name, r.kind, *r.places, *_cells(r, SPEEDS), r.missing) for r in found)
    return Table(columns, tuple(rows), "speeds")


def _measured(names: Sequence[str], labels: Sequence[str]) -> list[Column]:
    pairs = zip(names, labels, strict=True)
    return [Column(name, label, error=True) for name, label in pairs]


def _cells(found: Reading, names: Sequence[str]) -> list[Any]:
    """Return the numbers by name; the first is "not followed" if a window had left the sensor."""
    first, *others = names
    left = "not followed" if (found.missing or "").startswith("not followed") else None
    return [found.numbers.get(first, left), *map(found.numbers.get, others)]


def _read(path: str) -> Scene:
    return load(path).scene if path.lower().endswith(".npz") else read_scene(path)


def _out(context: click.Context, given: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, SUFFIXES)


def _window(context: click.Context, given: click.Parameter, value: str | None) -> bool | int:
    """Read ``--window``: the number of beads, True without a value, False without the option."""
    return value == "" or (whole(context, given, value) or False)


def _show(context: click.Context, given: click.Parameter, name: str | None) -> None:
    if name is not None and not context.resilient_parsing:  # completion parses resiliently
        click.echo(EXAMPLES[name][1], nl=False)
        context.exit()


@study(
    click.argument("scene"),
    option(
        "--example",
        type=click.Choice(NAMES),
        is_flag=False,
        flag_value="paper",
        is_eager=True,
        expose_value=False,
        callback=_show,
        show_default=False,
        says="Print an example of a scene file, by default the paper's chain.",
    ),
    option(
        "--out",
        callback=_out,
        metavar="FILE",
        says="Store the records in a file: .csv, or, with the result and the scene, .json or .npz.",
    ),
    option(
        "--method",
        default=COMPILED[0],
        type=click.Choice((*COMPILED, *METHODS)),
        says=f"Integrator: {' and '.join(COMPILED)} are compiled, the others SciPy's.",
    ),
    option(
        "--rtol",
        default=TOLERANCE,
        says="Relative tolerance. Errors are differences to a run with 1000 times as much.",
    ),
    option(
        "--window",
        callback=_window,
        is_flag=False,
        flag_value="",
        metavar="[BEADS]",
        says="Follow the leading pulse only, with at least so many beads behind its front.",
    ),
    option(
        "--pulses",
        is_flag=True,
        default=False,
        show_default=False,
        says="Measure all pulses at each sensor, not only the first.",
    ),
    epilog=_EPILOG,
)
def run(
    scene: str,
    out: Path | None,
    method: str,
    rtol: float,
    window: bool | int,
    pulses: bool,
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
    found = record(
        what, method=method, rtol=rtol, every=pulses, window=window, progress=run_progress
    )
    result = report(found, every=pulses)
    if out is not None:
        store(found.run, result.document(), out)
    return result
