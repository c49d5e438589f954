"""Studies: functions that return a `Report`, each with a command that prints the report."""

from __future__ import annotations

import inspect
import json
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import update_wrapper
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar

import click

from lwa.base.progress import bar, shown
from lwa.command.options import called, quantity
from lwa.command.terminal import HELP
from lwa.command.terminal import run as run_command
from validation.pictures import SUFFIXES
from validation.report.files import output_file
from validation.report.result import Report
from validation.scenes.checks import Failure, SceneError

P = ParamSpec("P")
T = TypeVar("T")


class Study(Generic[P]):
    """A function that returns a `Report`, with a ``command`` that prints the report."""

    def __init__(self, function: Callable[P, Report], options: Iterable[Any], epilog: str) -> None:
        self.function, self.name = function, function.__name__
        self.options, self.epilog = tuple(options), epilog
        update_wrapper(self, function)

    def __call__(self, *arguments: P.args, **options: P.kwargs) -> Report:
        return self.function(*arguments, **options)

    @property
    def command(self) -> click.Command:
        """The Click command, named like the function; its exit status is 1 if a finding fails."""
        wants = inspect.signature(self.function).parameters
        function: Callable[..., Report] = self.function

        def run(style: str, picture: Path | None, **values: Any) -> int:
            offered = {"progress": progress, "run_progress": run_progress, "picture": picture}
            values |= {name: value for name, value in offered.items() if name in wants}
            try:
                with warnings.catch_warnings():  # NumPy's: what overflows is refused or NaN
                    warnings.simplefilter("ignore", RuntimeWarning)
                    report = function(**values)
            except Failure as error:
                raise click.ClickException(str(error)) from None
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
        """Run the command as a program, for a file that defines one study and is executed."""
        run_command(self.command, f"{self.name}.py", arguments)


def study(*options: Any, epilog: str = "") -> Callable[[Callable[P, Report]], Study[P]]:
    """Return a decorator that gives a function returning a `Report` a command (see `Study`).

    The command has the function's name.

    options : options of the command, made by `option` or Click, one for each parameter.
    epilog : text below the options in the command's help.

    A function may have three further parameters, which the command sets: ``progress`` shows how
    many cases are done, ``run_progress`` how far a run of the lattice is
    (`validation.lattice.run.RunProgress`), and ``picture`` is the file of ``--plot``.
    """
    return lambda function: Study(function, options, epilog)


def option(*names: str, default: Any = None, says: str = "", **more: Any) -> Any:
    """Return a Click option with a default and help text ``says``; numbers keep their type."""
    more.setdefault("show_default", default is not None)
    if type(default) in (int, float) and "flag_value" not in more:
        kind, reader = ("INTEGER", whole) if isinstance(default, int) else ("NUMBER", number)
        more = {"callback": reader, "metavar": kind} | more
        default = str(default)
    return click.option(*names, default=default, help=says, **more)


def whole(context: click.Context, given: click.Parameter, value: str | None) -> int | None:
    """Read an option that is an integer."""
    found = quantity(context, given, value)
    if found is not None and not found.is_Integer:
        raise SceneError(f"{called(given)} is {found}: an integer is wanted")
    return None if found is None else int(found)


def number(context: click.Context, given: click.Parameter, value: str | None) -> float | None:
    """Read an option that is an integer, a decimal or a fraction."""
    found = quantity(context, given, value)
    if found is None:
        return None
    if not found.is_number:
        raise SceneError(f"{called(given)} is {found}: a number is wanted")
    return float(found)


EXPONENT = option("--k", callback=number, default="3/2", says="Exponent of F = δ^k.")


def progress(cases: Iterable[T]) -> Iterable[T]:
    """Show how many cases are done."""
    return shown(cases, "cases")


@contextmanager
def run_progress() -> Iterator[Callable[[float], None]]:
    """Show how far a lattice run is, by a bar."""
    form = "{desc}: {percentage:.1f} %|{bar}| {elapsed}<{remaining}"
    with bar("lattice run", total=1.0, delay=1, bar_format=form) as shares:
        yield lambda share: shares.update(share - shares.n)


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
