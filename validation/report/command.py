"""What the commands of the studies share: where a result goes, and how progress is shown."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
import sympy as sp
from tqdm import tqdm

from lwa.command.terminal import quantity
from lwa.duration import announce
from validation.lattice.effort import Effort
from validation.report.figure import SUFFIXES, plot_file, save
from validation.report.text import document, text
from validation.scenes.checks import SceneError

Command = Callable[..., Any]


def _picture(context: click.Context, option: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else plot_file(path)


def output(command: Command) -> Command:
    """The options that say where a result goes."""
    command = click.option(
        "--plot", "picture", callback=_picture, metavar="FILE",
        help=f"Draw the result into a file ({', '.join(SUFFIXES)}).",
    )(command)  # fmt: skip
    return click.option(
        "--format", "style", type=click.Choice(("text", "json")), default="text",
        show_default=True, help="How to print the result.",
    )(command)  # fmt: skip


def show(result: Any, style: str, picture: Path | None) -> None:
    if picture is not None:
        save(result, picture)
    click.echo(text(result) if style == "text" else json.dumps(document(result), indent=2))


def progress(cases: Collection[Any]) -> tqdm[Any]:
    # disable=None: only on a terminal
    return tqdm(cases, desc="lattice runs", disable=None, leave=False, file=sys.stderr)


SILENCE = 60.0
"""Seconds after which a run that was not expected to take long says how far it is."""


@contextmanager
def run_progress(effort: Effort) -> Iterator[Callable[[float], None]]:
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


def wanted(context: click.Context, option: click.Parameter, value: str | None) -> sp.Expr | None:
    return None if value is None else quantity(context, option, value)


EXPONENT = click.option(
    "--k", callback=quantity, default="3/2", show_default=True, help="Exponent of F = δ^k."
)


def number(value: sp.Expr, name: str) -> float:
    if not value.is_number:
        raise SceneError(f"{name} is {value}: a number is wanted")
    return float(value)
