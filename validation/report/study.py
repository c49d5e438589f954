"""Studies: functions that return a `Report`, each with a command that prints the report.

A report has a title, tables, findings, panels and notes, as text, JSON, CSV, picture or page. Files
of results are checked before the work, and replaced only by complete files.
"""

from __future__ import annotations

import inspect
import io
import json
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial, update_wrapper
from pathlib import Path
from typing import Any, Generic, ParamSpec

import click

from lwa.base.exact import InputError, read_exact
from lwa.base.files import reason
from lwa.base.frozen import Estimate
from lwa.base.progress import bar, shown
from lwa.command.cli import HELP, called, help_end, run as run_command
from lwa.command.options import Read, Reader, Words, count, quantities
from validation.pictures import SUFFIXES, Panel, Pictured
from validation.report.table import (
    WIDTH,
    Column,
    Estimates,
    Finding,
    Table,
    findings_table,
    plain,
    wrap,
)
from validation.scenes.checks import finite

P = ParamSpec("P")

_DELAY = 1.0  # seconds of a run without a bar: most runs end before
_LONGEST = 120  # characters of a path in a message

# --- reports ---


@dataclass(frozen=True, eq=False, repr=False)
class Report(Pictured):
    """Result of a study.

    Parameters
    ----------
    title : str
        Description of the computation, in one line or a few.
    tables : sequence of Table
        Tables; text shows those with column labels. JSON has a table under its key, and tables
        without a key in the list ``tables``.
    findings : sequence of Finding
        Numbers with bounds. In a report with tables, text shows only the findings that fail.
    panels : sequence of Panel
        Panels of the picture.
    notes : sequence of str
        Explanations below the tables.
    data : mapping
        Entries of JSON by the names of columns: estimates become two numbers, and a dot stands for
        an entry of a mapping.

    Examples
    --------
    >>> from validation.report.table import Column
    >>> columns = (Column("n", "sites"), Column("c_value", "speed", format=".3f"))
    >>> Report("one chain", (Table(columns, [{"n": 8, "c_value": 1.25}]),))
    one chain
    <BLANKLINE>
    sites  speed
    8      1.250
    """

    title: str
    tables: Sequence[Table] = ()
    findings: Sequence[Finding] = ()
    panels: Sequence[Panel] = ()
    notes: Sequence[str] = ()
    data: Mapping[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        return self.text()

    @property
    def ok(self) -> bool:
        """True if every finding holds."""
        return not self._failed

    @property
    def _failed(self) -> list[Finding]:
        """Findings that do not hold."""
        return [finding for finding in self.findings if not finding.ok]

    @property
    def verdict(self) -> str:
        """Number of findings that hold; empty for a report without findings.

        >>> Report("", findings=(Finding("order", 2.4, 2.0, 3.0),)).verdict
        '1 check: all hold'
        """
        count = len(self.findings)
        if not count:
            return ""
        outcome = "all hold"
        if self._failed:
            outcome = f"{len(self._failed)} of {count} fail"
        return f"{count} check{'s' * (count > 1)}: {outcome}"

    def text(self, width: int = WIDTH) -> str:
        """The report as plain text: beside other printed tables only the findings that fail.

        Parameters
        ----------
        width : int
            Characters of a line, at most.
        """
        parts = [wrap(self.title, width)]
        parts += [table.text(width) for table in self.tables]
        # A report of findings alone shows them all.
        printed = self._failed if any(parts[1:]) else self.findings
        parts.append(findings_table(printed).text(width))
        parts += [wrap(note, width) for note in self.notes]
        parts.append(self.verdict)
        return "\n\n".join(filter(None, parts))

    def document(self) -> dict[str, Any]:
        """The report for JSON: ``data``, the tables, and the findings.

        With findings: ``ok``, ``findings``, and KEY_value of each finding that has a key.
        """
        columns = []
        for name, value in self.data.items():
            kind = Estimates if isinstance(value, Estimate) else Column
            columns.append(kind(name))
        (result,) = Table(columns, [self.data]).document()
        unnamed = []
        for table in self.tables:
            if table.key:
                result[table.key] = table.document()
            else:
                unnamed.append(table.document())
        if unnamed:
            result["tables"] = unnamed
        for finding in self.findings:
            if finding.key:
                result[f"{finding.key}_value"] = plain(finding.value)
        if self.findings:
            result["findings"] = findings_table(self.findings).document()
            result["ok"] = self.ok
        return result

    def csv(self) -> str:
        """Return the first table that has rows as CSV.

        Raises
        ------
        InputError
            For a report without tables.
        """
        if not self.tables:
            raise InputError("format is csv: this result has no table")
        filled = [table for table in self.tables if table.rows]
        first, *_ = filled or self.tables  # without any row the header alone
        return first.csv()

    def pictured(self) -> Sequence[Panel]:
        """The panels, curves and maps, of which a picture of the result is made."""
        return self.panels

    def save(self, file: Path) -> None:
        """Draw the picture into a file; an old file is replaced only by a complete picture."""
        # Drawn in memory first: Matplotlib prints a traceback for a file that cannot be closed.
        drawn = io.BytesIO()
        self.figure().savefig(drawn, dpi=150, format=file.suffix[1:])
        # 150 dots an inch: 900 for the width of a panel, enough for print in a column.
        with replacing(file) as new:
            new.write_bytes(drawn.getvalue())


# --- studies ---


@dataclass(eq=False)
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

    function: Callable[P, Report]
    options: Sequence[Any]
    help_end: str = ""

    def __post_init__(self) -> None:
        update_wrapper(self, self.function)

    def __call__(self, *arguments: P.args, **options: P.kwargs) -> Report:
        return self.function(*arguments, **options)

    @property
    def command(self) -> click.Command:
        """The Click command, named like the function; its exit status is 1 if a finding fails."""

        def run(style: str, plot: Path | None, **values: Any) -> int:
            """Print the report, draw it if asked to, and return the exit status."""
            report = self._report(values)
            # Before the picture: a form that the result lacks leaves no file behind.
            printed = printed_as(style, report)
            if plot is not None:
                report.save(plot)
            click.echo(printed)
            return 0 if report.ok else 1

        # Click shows the last decoration first.
        for decorate in (*_OUTPUT, *reversed(self.options)):
            run = decorate(run)
        # Further paragraphs of the docstring are for Python: parameters, names in JSON.
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
        # Called from Python, a study shows no progress unless asked.
        if "progress" in parameters:
            values["progress"] = progress
        if "run_progress" in parameters:
            values["run_progress"] = run_progress
        with warnings.catch_warnings():
            # NumPy warns of an overflow, which is then refused or NaN.
            warnings.simplefilter("ignore", RuntimeWarning)
            return function(**values)

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
    return lambda function: Study(function, options, help_end(examples, page))


def printed_as(style: str, report: Report) -> str:
    """Return a report as "text" for the terminal, "json" or "csv"."""
    if style == "json":
        # NaN and ∞ are no JSON: `plain` has made them null.
        return json.dumps(report.document(), indent=2, allow_nan=False)
    if style == "csv":
        return report.csv().rstrip("\n")
    # A pipe has no width of its own.
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else WIDTH
    return report.text(min(width, WIDTH))


# --- options and files ---


def option(
    name: str,
    says: str,
    *,
    to: str | None = None,
    default: Any = None,
    read: Reader | None = None,
    **settings: Any,
) -> Any:
    """Return a Click option.

    Parameters
    ----------
    name : str
        The option with its dashes.
    says : str
        Help text.
    to : str, optional
        Name of the parameter, where it differs from the option's.
    default : object
        Default value, shown in the help.
    read : callable, optional
        Reader of the text, a key of `READERS`; if none is given, `number` for a default that is a
        float, and `count` for an integer.
    **settings : object
        Further settings of `click.option`.
    """
    settings.setdefault("show_default", default is not None and default is not False)
    # The type itself counts: the False of a flag is an instance of int, but no count.
    read = read or {float: number, int: count}.get(type(default))
    if read:
        # The default becomes a text, which the reader takes and a refusal proposes.
        default = default and str(default)
        settings |= {"type": Read(read, default), "metavar": READERS[read]}
    names = filter(None, (name, to))
    return click.option(*names, default=default, help=says, **settings)


def output_file(name: str, path: str, suffixes: Sequence[str]) -> Path:
    """Return the path of an output file that can be written.

    Parameters
    ----------
    name : str
        Name of the option in messages.
    path : str
        The path.
    suffixes : sequence of str
        Endings that are allowed, such as ".json".

    Raises
    ------
    InputError
        For another ending, and where no file can be written.
    """
    file = Path(path)
    # A refusal proposes the current folder, which most likely takes files.
    proposed = file.name
    try:
        if file.suffix.lower() not in suffixes:
            proposed = str(file.parent / f"{file.stem or name}{suffixes[-1]}")
            fault = f"a file ending in {', '.join(suffixes)} is wanted"
        elif file.exists() and not file.is_file():
            fault = "a regular file is wanted"
        else:
            # Permissions alone do not tell: a disk may be read-only, or full.
            with tempfile.TemporaryFile(dir=file.resolve().parent):
                return file
    except (OSError, ValueError, RuntimeError) as error:  # a null byte, a loop of links
        fault = f"it cannot be written, {reason(error)}"
    # A name that cannot be written there, either, is left out.
    usable = proposed != path and proposed.isprintable()
    change = {name: proposed if usable else None}
    raise InputError(f"{name} is {path[:_LONGEST]}: {fault}", **change)


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces ``file`` at the end, and is removed after a failure.

    A symbolic link keeps its target, and a file its mode. Raises `lwa.InputError`.
    """
    target = file.resolve()
    try:
        # The temporary folder lies beside the target: a file is moved at once only within one disk.
        # In a folder of its own the new file has a short name, where the old one's is as long as a
        # disk allows.
        with tempfile.TemporaryDirectory(prefix=".", dir=target.parent) as folder:
            new = Path(folder, "new")
            yield new
            if target.exists():
                new.chmod(target.stat().st_mode)
            new.replace(target)
    except OSError as error:
        raise InputError(f"{file} is not written: {reason(error)}") from None


def output_option(name: str, suffixes: Sequence[str], says: str) -> Any:
    """Return an option of an output file, which is checked before the work (`output_file`)."""

    def read(
        context: click.Context, given: click.Parameter, path: str | None
    ) -> Path | None:
        return None if path is None else output_file(called(given), path, suffixes)

    return option(name, says, callback=read, metavar="FILE", type=click.Path())


def number(text: str, name: str) -> float:
    """Read an integer, a decimal or a fraction."""
    return finite(read_exact(text, name), name)


READERS = {
    number: "NUMBER",
    count: "INTEGER",
    read_exact: "NUMBER",
    quantities: "NUMBERS",
}
"""Readers of options, with the words for their texts in the help."""

EXPONENT = option(
    "--k", "Exponent k of the force F = A δ^k.", read=number, default="3/2"
)


progress = partial(shown, label="cases")
"""Display of how many cases are done."""


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
        "How to print the result.",
        to="style",
        type=Words(("text", "json", "csv")),
        default="text",
    ),
)
