"""The command `lwa-validate`: the lattice, measured against the theory."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
import sympy as sp
from tqdm import tqdm

from lwa.command.terminal import quantities, quantity, run
from lwa.duration import announce
from lwa.exact import InputError
from validation.lattice.effort import Effort
from validation.lattice.run import IntegrationError
from validation.lattice.simulate import COMPILED, METHODS
from validation.pulses.sensors import TOLERANCE, record
from validation.pulses.steady import STRETCH
from validation.report.figure import SUFFIXES, plot_file, save
from validation.report.files import output_file
from validation.report.text import STORED, document, store, text
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.scenes.scenefile import read
from validation.studies.accuracy.integrators import NAMES
from validation.studies.accuracy.integrators import accuracy as run_accuracy
from validation.studies.accuracy.peers import PeerError
from validation.studies.accuracy.workprecision import Accuracy
from validation.studies.exact import ExactWave, Resonances
from validation.studies.hard.cases import CASES
from validation.studies.hard.cases import hard as run_hard
from validation.studies.hard.verdicts import Hard
from validation.studies.limits import limits as run_limits
from validation.studies.porter2008 import experiment
from validation.studies.porter2008.figures import figures as run_figures
from validation.studies.porter2008.gallery import Figures
from validation.studies.sweep.atlas import Sweep
from validation.studies.sweep.executors import cluster, processes
from validation.studies.sweep.sweep import SweepError, axis
from validation.studies.sweep.sweep import sweep as run_sweep
from validation.waves.resonances import resonances
from validation.waves.solver import exact_wave

Command = Callable[..., Any]


@click.group()
def validate() -> None:
    """The lattice of F = A δ^k contacts, measured against the long-wave theory.

    Ends with 1 when a comparison does not hold and with 2 on bad input.
    """


def _picture(context: click.Context, option: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else plot_file(path)


def _output(command: Command) -> Command:
    """The options that say where a result goes."""
    command = click.option(
        "--plot", "picture", callback=_picture, metavar="FILE",
        help=f"Draw the result into a file ({', '.join(SUFFIXES)}).",
    )(command)  # fmt: skip
    return click.option(
        "--format", "style", type=click.Choice(("text", "json")), default="text",
        show_default=True, help="How to print the result.",
    )(command)  # fmt: skip


def _show(result: Any, style: str, picture: Path | None) -> None:
    if picture is not None:
        save(result, picture)
    click.echo(text(result) if style == "text" else json.dumps(document(result), indent=2))


def _progress(cases: Collection[Any]) -> tqdm[Any]:
    # disable=None: only on a terminal
    return tqdm(cases, desc="lattice runs", disable=None, leave=False, file=sys.stderr)


SILENCE = 60.0
"""Seconds after which a run that was not expected to take long says how far it is."""


@contextmanager
def _run(effort: Effort) -> Iterator[Callable[[float], None]]:
    """What one run takes, and how far it is."""
    start, said = time.monotonic(), announce(str(effort), effort.seconds)
    with tqdm(
        total=1.0, desc="lattice run", disable=None, leave=False, file=sys.stderr, delay=1,
        bar_format="{desc}: {percentage:.1f} %|{bar}| {elapsed}<{remaining}",
    ) as bar:  # fmt: skip

        def tell(share: float) -> None:
            nonlocal said
            bar.update(share - bar.n)
            if not said and time.monotonic() - start > SILENCE:
                said = True
                click.echo(f"{share:.1%} of the run is done", err=True)

        yield tell


@validate.command()
@_output
def limits(style: str, picture: Path | None) -> int:
    """Equal masses, m1 ≫ m2 and k → 1: widths, speed and amplitude, held to bounds."""
    result = run_limits(_progress)
    _show(result, style, picture)
    return 0 if result.ok else 1


@validate.command()
@click.option(
    "--velocity",
    callback=quantity,
    default="1.37",
    show_default=True,
    help="Of the striker, in m/s.",
)
@click.option(
    "--beads", type=int, default=38, show_default=True, help="In the chain, the striker included."
)
@click.option(
    "--sensors",
    callback=quantities,
    default="15,34",
    show_default=True,
    help="The two beads that are compared, counted from the striker, 1.",
)
@click.option("--gravity", is_flag=True, help="Let the chain stand upright, under its own weight.")
@_output
def paper(
    velocity: sp.Expr,
    beads: int,
    sensors: tuple[sp.Expr, ...],
    gravity: bool,
    style: str,
    picture: Path | None,
) -> None:
    """The steel:PTFE chain of the paper: speed, peak force and FWHM."""  # fmt: skip
    g = experiment.GRAVITY if gravity else 0.0
    result = experiment.paper(_number(velocity, "velocity"), beads, sensors, g, _run)
    _show(result, style, picture)


@validate.command("figures")
@_output
def paper_figures(style: str, picture: Path | None) -> None:
    """The paper's figures: force records, N:1 chains, force against speed, and the FWHM."""
    result: Figures = run_figures(_progress)
    _show(result, style, picture)


def _wanted(context: click.Context, option: click.Parameter, value: str | None) -> sp.Expr | None:
    return None if value is None else quantity(context, option, value)


EXPONENT = click.option(
    "--k", callback=quantity, default="3/2", show_default=True, help="Exponent of F = δ^k."
)


@validate.command()
@EXPONENT
@click.option(
    "--masses", callback=quantities, default="1", show_default=True,
    help="One mass, or the two of a dimer.",
)  # fmt: skip
@click.option("--speed", callback=_wanted, help="Scale the wave to this speed, at D = 1.")
@click.option(
    "--force", callback=_wanted, help="Scale the wave to this peak force, at A = 1; by default 1."
)
@_output
def exact(
    k: sp.Expr,
    masses: tuple[sp.Expr, ...],
    speed: sp.Expr | None,
    force: sp.Expr | None,
    style: str,
    picture: Path | None,
) -> None:
    """An exact traveling wave of the lattice: speed, widths, and the tail if it has one."""
    if speed is not None and force is not None:
        raise InputError("speed and force: a wave is scaled to one of the two")
    wave: ExactWave = exact_wave([_number(m, "mass") for m in masses], _number(k, "k"))
    if speed is not None:
        wave = wave.scaled(speed=_number(speed, "speed"))
    if force is not None:
        wave = wave.scaled(force=_number(force, "force"))
    _show(wave, style, picture)


@validate.command("resonances")
@EXPONENT
@click.option("--count", type=int, default=3, show_default=True, help="How many, from above.")
@_output
def special_mass_ratios(k: sp.Expr, count: int, style: str, picture: Path | None) -> None:
    """The mass ratios m2/m1 < 1 at which a dimer has a solitary wave."""
    found: Resonances = resonances(_number(k, "k"), count)
    _show(found, style, picture)


@validate.command("hard")
@click.option(
    "--case", "names", multiple=True, metavar="NAME",
    help=f"Only this case, may be given again: {', '.join(CASES)}.",
)  # fmt: skip
@_output
def hard_cases(names: tuple[str, ...], style: str, picture: Path | None) -> int:
    """Extreme k and ω, lost contacts, long runs, float64 against 50 digits: what holds there."""
    result: Hard = run_hard(names, _progress)
    _show(result, style, picture)
    return 0 if result.ok else 1


@validate.command()
@click.option(
    "--task", "names", multiple=True, metavar="NAME",
    help=f"Only this task, may be given again: {', '.join(NAMES)}.",
)  # fmt: skip
@_output
def accuracy(names: tuple[str, ...], style: str, picture: Path | None) -> None:
    """Speed against error: integrators on fixed tasks, and theories against true waves."""
    try:
        result: Accuracy = run_accuracy(names, _progress)
    except (PeerError, IntegrationError) as error:
        raise click.ClickException(str(error)) from None
    _show(result, style, picture)


def _number(value: sp.Expr, name: str) -> float:
    if not value.is_number:
        raise SceneError(f"{name} is {value}: a number is wanted")
    return float(value)


def _read(context: click.Context, argument: click.Parameter, path: str) -> Scene:
    return read(path)


def _store(context: click.Context, option: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("out", path, STORED)


@validate.command("run")
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
@_output
def run_scene(
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
        result = record(scene, method=method, rtol=rtol, progress=_run)
    except IntegrationError as error:
        raise click.ClickException(str(error)) from None
    if out is not None:
        store(result, out)
    _show(result, style, picture)


def _axis(context: click.Context, option: click.Parameter, text: str) -> tuple[sp.Rational, ...]:
    return axis(text, option.opts[0].lstrip("-"))


@validate.command()
@click.option(
    "--k", "ks", callback=_axis, default="5/4:3:8", show_default=True,
    help="Exponents of F = δ^k: values and ranges start:stop:count, separated by commas.",
)  # fmt: skip
@click.option(
    "--omega", "omegas", callback=_axis, default="1/20:1:20", show_default=True,
    help="Mass ratios m2/m1, likewise.",
)  # fmt: skip
@click.option(
    "--stretch", type=int, default=STRETCH, show_default=True,
    help="Cells from one place at which the pulse is measured to the next; more below k = 3/2.",
)  # fmt: skip
@click.option(
    "--file", metavar="FILE",
    help="Keep finished points (.jsonl); with the same file a sweep goes on where it was left.",
)  # fmt: skip
@click.option("--jobs", type=int, help="Processes; by default one for each processor.")
@click.option(
    "--cluster", "address", metavar="ADDRESS",
    help="Compute on a Dask cluster instead, whose scheduler is there, such as tcp://host:8786.",
)  # fmt: skip
@_output
def sweep(
    ks: tuple[sp.Rational, ...],
    omegas: tuple[sp.Rational, ...],
    stretch: int,
    file: str | None,
    jobs: int | None,
    address: str | None,
    style: str,
    picture: Path | None,
) -> None:
    """Maps over k and m2/m1: width, speed and decay of a struck chain's pulse."""
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has workers of its own")
    executor = processes(jobs) if address is None else cluster(address)
    try:
        result: Sweep = run_sweep(
            ks, omegas, stretch=stretch, executor=executor, file=file, progress=_progress
        )
    except SweepError as error:
        raise click.ClickException(str(error)) from None
    except KeyboardInterrupt:
        if file is not None and Path(file).exists():
            click.echo(f"finished points are in {file}: the same command goes on", err=True)
        raise
    _show(result, style, picture)


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    run(validate, "lwa-validate", arguments)
