"""Studies: functions that return a `Report`, each with a command that prints the report."""

from __future__ import annotations

import inspect
import json
import shutil
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import update_wrapper
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar

import click

from lwa.base.progress import bar, shown
from lwa.command.cli import HELP, called, help_end
from lwa.command.cli import run as run_command
from lwa.command.options import Words, quantities, quantity
from validation.pictures import SUFFIXES
from validation.report.result import Report, output_file
from validation.report.table import WIDTH
from validation.scenes.checks import Failure, SceneError

P = ParamSpec("P")
T = TypeVar("T")

_DELAY = 1.0  # seconds of a run without a bar: most runs end before


class Study(Generic[P]):
    """A function that returns a `Report`, with a ``command`` that prints the report.

    Parameters
    ----------
    function : callable
        The function.
    options : sequence of decorators
        Options of the command, see `study`.
    help_end : str
        Text at the end of the command's help.
    """

    def __init__(
        self, function: Callable[P, Report], options: Sequence[Any], help_end: str = ""
    ) -> None:
        self.function = function
        self.options = options
        self.help_end = help_end
        update_wrapper(self, function)

    def __call__(self, *arguments: P.args, **options: P.kwargs) -> Report:
        return self.function(*arguments, **options)

    @property
    def command(self) -> click.Command:
        """The Click command, named like the function; its exit status is 1 if a finding fails."""

        def run(style: str, plot: Path | None, **values: Any) -> int:
            report = self._report(values)
            printed = printed_as(style, report)
            if plot is not None:
                report.save(plot)
            click.echo(printed)
            return 0 if report.ok else 1

        # Click shows the last decoration first.
        for decorate in (*_OUTPUT, *reversed(self.options)):
            run = decorate(run)
        summary, _, _ = (inspect.getdoc(self.function) or "").partition("\n\n")
        make = click.command(
            self.function.__name__,
            help=summary,
            epilog=self.help_end,
            context_settings=HELP,
        )
        return make(run)

    def _report(self, values: dict[str, Any]) -> Report:
        """Call the function with the values of its options and the displays that it wants."""
        function: Callable[..., Report] = self.function
        parameters = inspect.signature(function).parameters
        if "progress" in parameters:
            values["progress"] = progress
        if "run_progress" in parameters:
            values["run_progress"] = run_progress
        try:
            with warnings.catch_warnings():
                # NumPy warns of an overflow, which is then refused or NaN.
                warnings.simplefilter("ignore", RuntimeWarning)
                return function(**values)
        except Failure as error:
            raise click.ClickException(str(error)) from None

    def main(self, arguments: Sequence[str] | None = None) -> None:
        """Run the command as a program, for a file that defines one study and is executed."""
        run_command(self.command, f"{self.function.__name__}.py", arguments)


def study(
    *options: Any, page: str = "", examples: Sequence[str] = ()
) -> Callable[[Callable[P, Report]], Study[P]]:
    """Return a decorator that gives a function returning a `Report` a command (see `Study`).

    The command has the function's name, and the first paragraph of its docstring as its help. A
    function may have two further parameters, which the command sets: ``progress`` shows how many
    cases are done, and ``run_progress`` how far a run of the lattice is
    (`validation.lattice.cost.RunProgress`).

    Parameters
    ----------
    *options : decorators
        Options and arguments of the command, made by `option` or Click, one for each parameter.
    page : str
        Page of the book on the study, the name of its file.
    examples : sequence of str
        Lines that run one after another in an empty folder, shown at the end of the help.
    """
    end = help_end(examples, page)
    return lambda function: Study(function, options, end)


def printed_as(style: str, report: Report) -> str:
    """Return a report as "text" for the terminal, "json" or "csv"."""
    if style == "json":
        return json.dumps(report.document(), indent=2, allow_nan=False)
    if style == "csv":
        return report.csv().rstrip("\n")
    # A pipe has no width of its own.
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else WIDTH
    return report.text(min(width, WIDTH))


def option(*names: str, default: Any = None, says: str = "", **settings: Any) -> Any:
    """Return a Click option.

    Parameters
    ----------
    *names : str
        Its flags, and the parameter's name where it differs from them.
    default : object
        Default value, shown in the help; an option whose default is a float reads a `number`.
    says : str
        Help text.
    **settings : object
        Further settings of `click.option`.
    """
    settings.setdefault("show_default", default is not None and default is not False)
    if isinstance(default, float):
        settings.setdefault("callback", number)
        default = str(default)  # the callback reads text
    settings.setdefault("metavar", _METAVARS.get(settings.get("callback")))
    return click.option(*names, default=default, help=says, **settings)


def output_option(name: str, suffixes: Sequence[str], says: str) -> Any:
    """Return an option of an output file, which is checked before the work (`output_file`)."""

    def read(
        context: click.Context, given: click.Parameter, path: str | None
    ) -> Path | None:
        return None if path is None else output_file(called(given), path, suffixes)

    return option(name, callback=read, metavar="FILE", type=click.Path(), says=says)


def number(
    context: click.Context, given: click.Parameter, value: str | None
) -> float | None:
    """Read an option that is an integer, a decimal or a fraction."""
    exact = quantity(context, given, value)
    if exact is None:
        return None
    if not exact.is_number:
        raise SceneError(f"{called(given)} is {exact}: a number is wanted")
    return float(exact)


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
    with bar("lattice run", total=1.0, delay=_DELAY, bar_format=form) as shares:
        yield lambda share: shares.update(share - shares.n)


_OUTPUT = (
    output_option(
        "--plot", SUFFIXES, f"Draw the result into a file ({', '.join(SUFFIXES)})."
    ),
    option(
        "--format",
        "style",
        type=Words(("text", "json", "csv")),
        default="text",
        says="How to print the result.",
    ),
)
