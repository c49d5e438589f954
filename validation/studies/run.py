"""Any scene: arrival, peak force, FWHM and speed of the pulse at its sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

import click

import validation.scenes
from validation.lattice.cost import RunProgress
from validation.lattice.run import Run
from validation.lattice.simulate import COMPILED, METHODS
from validation.pulses.sensors import READINGS, SPEEDS, TOLERANCE, Reading, Recording, record
from validation.report.command import option, study
from validation.report.files import output_file
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import document, read
from validation.studies.records import KEPT, SUFFIXES, load, store

_NOTE = "First pulse at each sensor, in {} units. ±: difference to a less accurate run."
_DYNAMIC = "\nDynamic force: force less the static force at the sensor."


def _example(name: str) -> tuple[str, str]:
    """Title of an example, the first line of its file, and the rest of the file."""
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


def report(found: Recording) -> Report:
    """The result of a run.

    ``scene`` (as in a file, see `validation.scenes.scenefile`); ``sensors``: ``kind``, ``number``,
    ``arrival_value``, ``peak_value`` (of the dynamic force), ``fwhm_value``,
    ``static_force_value``; ``speeds``: ``kind``, ``from``, ``to``, ``speed_sites_value``,
    ``speed_value`` (null without spacings); each measured value with its error, as
    ``arrival_error_value``, and all null where ``missing`` says why; ``energy_drift_value``, and
    ``momentum_drift_value``, null with a wall. The picture shows the force at all sensors.
    """
    run, scene = found.run, found.run.scene
    momentum = "not conserved" if (p := run.momentum_drift) is None else f"drift {p:.0e}"
    missing = [f"{r.name}: {r.missing}" for r in found.sensors + found.speeds if r.missing]
    note = _NOTE.format(scene.units or "the scene's own") + _DYNAMIC * any(scene.load)
    return Report(
        f"{scene}, energy drift {run.energy_drift:.0e}, momentum {momentum}",
        (
            _table("sensor", ("number",), _readings(run), found.sensors, static=True),
            _table("speed", ("from", "to"), _speeds(scene), found.speeds),
        ),
        panels=tuple(run.pictured()),
        notes=("\n".join(missing), note if found.sensors else ""),
        data={
            "scene": document(scene),
            "energy_drift_value": run.energy_drift,
            "momentum_drift_value": run.momentum_drift,
        },
    )


def _readings(run: Run) -> dict[str, str]:
    """Column labels of `READINGS`."""
    peak = "peak dynamic force" if any(run.scene.load) else "peak force"
    labels = (run.label("arrival"), run.label(peak), run.label("FWHM"))
    return dict(zip(READINGS, labels, strict=True))


def _speeds(scene: Scene) -> dict[str, str]:
    """Column labels of `SPEEDS`."""
    units = ("sites/s", "m/s") if scene.units else ("sites/time", "length/time")
    return dict(zip(SPEEDS, units, strict=True))


def _table(
    what: str,
    places: Sequence[str],
    labels: Mapping[str, str],
    found: Sequence[Reading],
    static: bool = False,
) -> Table:
    measured = [Column(name, label, "", ".8g", error=True) for name, label in labels.items()]
    columns = [Column("", what), *map(Column, ("kind", *places)), *measured]
    columns += [Column("static_force_value")] * static + [Column("missing")]
    rows = (
        (r.name, r.kind, *r.places, *map(r.numbers.get, labels), *[r.static] * static, r.missing)
        for r in found
    )
    return Table(tuple(columns), tuple(rows), f"{what}s")


def _read(path: str) -> Scene:
    return load(path).scene if path.lower().endswith(".npz") else read(path)


def _out(context: click.Context, given: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, SUFFIXES)


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
    result = report(found)
    if out is not None:
        store(found.run, result.document(), out)
    return result
