"""A study as a command: its options, where its result goes, its progress and its exit status."""

from __future__ import annotations

import inspect
import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import update_wrapper
from pathlib import Path
from typing import Any, Generic, ParamSpec, Protocol, TypeVar

import click
from tqdm import tqdm

from lwa.base.progress import announce
from lwa.command.terminal import HELP, called, quantity
from lwa.command.terminal import run as run_command
from validation.lattice.effort import Effort
from validation.pictures.figure import SUFFIXES
from validation.report.files import output_file
from validation.report.result import Report
from validation.scenes.checks import Failure, SceneError

P = ParamSpec("P")
T = TypeVar("T")


class Result(Protocol):
    """A study's typed result."""

    def report(self) -> Report:
        """What it looks like."""
        ...


R = TypeVar("R", bound=Result | Report)


class Study(Generic[P, R]):
    """A function that computes a result, and the ``command`` that shows it."""

    def __init__(
        self, function: Callable[P, R], name: str, options: Iterable[Any], epilog: str
    ) -> None:
        self.function, self.name = function, name
        self.options, self.epilog = tuple(options), epilog
        update_wrapper(self, function)

    def __call__(self, *arguments: P.args, **options: P.kwargs) -> R:
        return self.function(*arguments, **options)

    @property
    def command(self) -> click.Command:
        """Of its options, ``--format`` and ``--plot``; it ends with 1 where a finding fails."""
        wants = inspect.signature(self.function).parameters
        function: Callable[..., R] = self.function

        def run(style: str, picture: Path | None, **values: Any) -> int:
            offered = {"progress": progress, "run_progress": run_progress, "picture": picture}
            values |= {name: value for name, value in offered.items() if name in wants}
            try:
                found = function(**values)
            except Failure as error:
                raise click.ClickException(str(error)) from None
            report = found if isinstance(found, Report) else found.report()
            if style == "json":
                written = json.dumps(report.document(), indent=2, allow_nan=False)
            else:
                written = report.csv().rstrip("\n") if style == "csv" else report.text()
            if picture is not None:
                report.save(picture)
            click.echo(written)
            return 0 if report.ok else 1

        for option in (*_OUTPUT, *reversed(self.options)):
            run = option(run)
        says = (inspect.getdoc(self.function) or "").partition("\n\n")[0]
        command = click.command(
            self.name, help=says, epilog=self.epilog or None, context_settings=HELP
        )
        return command(run)

    def main(self, arguments: Sequence[str] | None = None) -> None:
        """Run the study as a program of its own, for the file that defines it."""
        run_command(self.command, f"{self.name}.py", arguments)


def study(
    *options: Any, name: str = "", epilog: str = ""
) -> Callable[[Callable[P, R]], Study[P, R]]:
    """Make a study of a function that returns a `Report`, or what has one.

    options : of the command, as `option`, or Click's; the function's parameters have their names.
    name : of the command; by default the function's.
    epilog : what stands below the options in its help.

    What the function's parameters name it is given besides: ``progress`` to show cases on their
    way, ``run_progress`` one run (`validation.lattice.effort.RunProgress`), and ``picture``, the
    file that is asked for.
    """
    return lambda function: Study(function, name or function.__name__, options, epilog)


def option(*names: str, default: Any = None, says: str = "", **more: Any) -> Any:
    """An option with its default and its help; a number's type is that of the default."""
    more.setdefault("show_default", default is not None)
    if type(default) in (int, float) and "flag_value" not in more:
        kind, reader = ("INTEGER", whole) if isinstance(default, int) else ("NUMBER", number)
        more = {"callback": reader, "metavar": kind} | more
        default = str(default)
    return click.option(*names, default=default, help=says, **more)


def whole(context: click.Context, given: click.Parameter, value: str | None) -> int | None:
    """Callback of an option that is an integer."""
    found = quantity(context, given, value)
    if found is not None and not found.is_Integer:
        raise SceneError(f"{called(given)} is {found}: an integer is wanted")
    return None if found is None else int(found)


def number(context: click.Context, given: click.Parameter, value: str | None) -> float | None:
    """Callback of an option that is a number: an integer, a decimal or a fraction."""
    found = quantity(context, given, value)
    if found is None:
        return None
    if not found.is_number:
        raise SceneError(f"{called(given)} is {found}: a number is wanted")
    return float(found)


EXPONENT = option("--k", callback=number, default="3/2", says="Exponent of F = δ^k.")


def progress(cases: Iterable[T]) -> Iterable[T]:
    """Show the cases on their way, on a terminal."""
    # disable=None: only on a terminal
    bar: Iterable[T] = tqdm(cases, desc="cases", disable=None, leave=False, file=sys.stderr)
    return bar


SILENCE = 60.0
"""Seconds after which a run that was not expected to take long says how far it is."""


@contextmanager
def run_progress(effort: Effort) -> Iterator[Callable[[float], None]]:
    """What one run takes, and how far it is."""
    start, said = time.monotonic(), announce(str(effort), effort.seconds)
    with tqdm(
        total=1.0,
        desc="lattice run",
        disable=None,
        leave=False,
        file=sys.stderr,
        delay=1,
        bar_format="{desc}: {percentage:.1f} %|{bar}| {elapsed}<{remaining}",
    ) as bar:

        def tell(share: float) -> None:
            nonlocal said
            bar.update(share - bar.n)
            if not said and time.monotonic() - start > SILENCE:
                said = True
                click.echo(f"{share:.1%} of the run is done", err=True)

        yield tell


def _picture(context: click.Context, given: click.Parameter, path: str | None) -> Path | None:
    return None if path is None else output_file("plot", path, SUFFIXES)


_OUTPUT = (
    click.option(
        "--plot",
        "picture",
        callback=_picture,
        metavar="FILE",
        help=f"Draw the result into a file ({', '.join(SUFFIXES)}).",
    ),
    click.option(
        "--format",
        "style",
        type=click.Choice(("text", "json", "csv")),
        default="text",
        show_default=True,
        help="How to print the result.",
    ),
)
