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

from lwa.base.exact import shorten
from lwa.base.progress import bar, shown
from lwa.command.cli import HELP
from lwa.command.cli import run as run_command
from lwa.command.options import called, quantities, quantity
from validation.pictures import SUFFIXES
from validation.report.result import Report, output_file
from validation.scenes.checks import Failure, SceneError

P = ParamSpec("P")
T = TypeVar("T")


class Study(Generic[P]):
    """A function that returns a `Report`, with a ``command`` that prints the report."""

    def __init__(self, function: Callable[P, Report], options: Sequence[Any]) -> None:
        self.function, self.options = function, options
        update_wrapper(self, function)

    def __call__(self, *arguments: P.args, **options: P.kwargs) -> Report:
        return self.function(*arguments, **options)

    @property
    def command(self) -> click.Command:
        """The Click command, named like the function; its exit status is 1 if a finding fails."""
        function: Callable[..., Report] = self.function
        parameters = inspect.signature(function).parameters

        def run(style: str, plot: Path | None, **values: Any) -> int:
            displays = {"progress": progress, "run_progress": run_progress}
            values |= {
                name: show for name, show in displays.items() if name in parameters
            }
            try:
                with (
                    warnings.catch_warnings()
                ):  # NumPy's: what overflows is refused or NaN
                    warnings.simplefilter("ignore", RuntimeWarning)
                    report = function(**values)
            except Failure as error:
                raise click.ClickException(str(error)) from None
            if style == "json":
                printed = json.dumps(report.document(), indent=2, allow_nan=False)
            else:
                printed = report.csv().rstrip("\n") if style == "csv" else report.text()
            if plot is not None:
                report.save(plot)
            click.echo(printed)
            return 0 if report.ok else 1

        for option in (
            *_OUTPUT,
            *reversed(self.options),
        ):  # help shows the last decoration first
            run = option(run)
        summary, _, _ = (inspect.getdoc(function) or "").partition("\n\n")
        return click.command(function.__name__, help=summary, context_settings=HELP)(
            run
        )

    def main(self, arguments: Sequence[str] | None = None) -> None:
        """Run the command as a program, for a file that defines one study and is executed."""
        run_command(self.command, f"{self.function.__name__}.py", arguments)


def study(*options: Any) -> Callable[[Callable[P, Report]], Study[P]]:
    """Return a decorator that gives a function returning a `Report` a command (see `Study`).

    The command has the function's name.

    options : options of the command, made by `option` or Click, one for each parameter.

    A function may have two further parameters, which the command sets: ``progress`` shows how many
    cases are done, and ``run_progress`` how far a run of the lattice is
    (`validation.lattice.cost.RunProgress`).
    """
    return lambda function: Study(function, options)


def option(*names: str, default: Any = None, says: str = "", **more: Any) -> Any:
    """Return a Click option with a default and help text ``says``; `number` reads decimals."""
    more.setdefault("show_default", default is not None and default is not False)
    if isinstance(default, float):
        more, default = {"callback": number} | more, str(default)
    more.setdefault("metavar", _METAVARS.get(more.get("callback")))
    return click.option(*names, default=default, help=says, **more)


def output_option(name: str, suffixes: Sequence[str], says: str) -> Any:
    """Return an option of an output file, which is checked before the work (`output_file`)."""

    def read(
        context: click.Context, given: click.Parameter, path: str | None
    ) -> Path | None:
        return None if path is None else output_file(called(given), path, suffixes)

    return option(name, callback=read, metavar="FILE", type=click.Path(), says=says)


_UNIT = (
    "Unit of a column whose header has none, as in --unit time=ms, or its calibration, as in "
    "--unit 'CH1=12.5 N/V'; repeatable. If one unit is stated, all are wanted."
)
_COLUMN = (
    "Header that stands for a column in the file, as in --column time='CH1 t'; repeatable. The "
    "lines before the header are skipped."
)


def column_options(function: Any) -> Any:
    """Give a study that reads a measured file its options --column and --unit."""

    def read(
        context: click.Context, given: click.Parameter, pairs: Sequence[str]
    ) -> Any:
        renamed = {}
        for pair in pairs:
            name, equals, header = (part.strip() for part in pair.partition("="))
            if not (name and equals and header) or name in renamed:
                wanted = f"{given.metavar} is wanted, once a name"
                raise SceneError(f"{called(given)} is {shorten(pair)}: {wanted}")
            renamed[name] = header
        return renamed

    pairs = {"callback": read, "multiple": True}
    unit = option("--unit", "units", metavar="NAME=UNIT", says=_UNIT, **pairs)
    column = option("--column", "renamed", metavar="NAME=HEADER", says=_COLUMN, **pairs)
    return column(unit(function))


def number(
    context: click.Context, given: click.Parameter, value: str | None
) -> float | None:
    """Read an option that is an integer, a decimal or a fraction."""
    exact = quantity(context, given, value)
    if exact is not None and not exact.is_number:
        raise SceneError(f"{called(given)} is {exact}: a number is wanted")
    return None if exact is None else float(exact)


_METAVARS: dict[Any, str] = {
    number: "NUMBER",
    quantity: "NUMBER",
    quantities: "NUMBERS",
}
EXPONENT = option(
    "--k", callback=number, default="3/2", says="Exponent k of the force F = A δ^k."
)


def progress(cases: Iterable[T]) -> Iterable[T]:
    """Show how many cases are done."""
    return shown(cases, "cases")


@contextmanager
def run_progress() -> Iterator[Callable[[float], None]]:
    """Show how far a lattice run is, by a bar."""
    form = "{desc}: {percentage:.1f} %|{bar}| {elapsed}<{remaining}"
    with bar("lattice run", total=1.0, delay=1, bar_format=form) as shares:
        yield lambda share: shares.update(share - shares.n)


_FORMATS = click.Choice(("text", "json", "csv"))
_OUTPUT = (
    output_option(
        "--plot", SUFFIXES, f"Draw the result into a file ({', '.join(SUFFIXES)})."
    ),
    option(
        "--format",
        "style",
        type=_FORMATS,
        default="text",
        says="How to print the result.",
    ),
)
