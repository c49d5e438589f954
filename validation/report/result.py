"""Result of a study and its files: title, tables, findings, panels, notes, as text, JSON or CSV.

Output files are checked before the work, and replaced only by complete files.
"""

from __future__ import annotations

import io
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

from lwa.base.exact import InputError
from lwa.base.files import reason
from validation.pictures import Panel, Pictured, svg
from validation.report.table import WIDTH, Finding, Table, findings_table, plain, wrap

_LONGEST = 120  # characters of a path in a message


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
    try:
        if file.suffix.lower() not in suffixes:
            fault = f"a file ending in {', '.join(suffixes)} is wanted"
        elif file.exists() and not file.is_file():
            fault = "a regular file is wanted"
        else:
            with tempfile.TemporaryFile(dir=file.resolve().parent):
                return file
    except (OSError, ValueError, RuntimeError) as error:  # a null byte, a loop of links
        fault = f"it cannot be written, {reason(error)}"
    raise InputError(f"{name} is {path[:_LONGEST]}: {fault}")


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces ``file`` at the end, and is removed after a failure.

    A symbolic link keeps its target, and a file its mode. Raises `lwa.InputError`.
    """
    target = file.resolve()
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=target.parent) as folder:
            new = Path(folder, "new")
            yield new
            if target.exists():
                new.chmod(target.stat().st_mode)
            new.replace(target)
    except OSError as error:
        raise InputError(f"{file} is not written: {reason(error)}") from None


@dataclass(frozen=True, eq=False)
class Report(Pictured):
    """Result of a study.

    Parameters
    ----------
    title : str
        What was computed, in one or a few lines.
    tables : tuple of Table
        Tables; text shows those with column labels. JSON has a table under its key, and tables
        without a key in the list ``tables``.
    findings : tuple of Finding
        Numbers with bounds. In a report with tables, text shows only the findings that fail.
    panels : tuple of Panel
        Panels of the picture.
    notes : tuple of str
        Explanations below the tables.
    data : mapping
        Entries that go to JSON unchanged.

    >>> from validation.report.table import Column
    >>> row = Table((Column("n", "sites"), Column("c_value", "speed", format=".3f")), ((8, 1.25),))
    >>> print(Report("one chain", (row,)).text())
    one chain
    <BLANKLINE>
    sites  speed
    8      1.250
    """

    title: str
    tables: tuple[Table, ...] = ()
    findings: tuple[Finding, ...] = ()
    panels: tuple[Panel, ...] = ()
    notes: tuple[str, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """True if every finding holds."""
        return all(finding.ok for finding in self.findings)

    @property
    def verdict(self) -> str:
        """Number of findings that hold; empty for a report without findings.

        >>> Report("", findings=(Finding("order", 2.4, 2.0, 3.0),)).verdict
        '1 check: all hold'
        """
        count = len(self.findings)
        if not count:
            return ""
        failed = [finding for finding in self.findings if not finding.ok]
        outcome = f"{len(failed)} of {count} fail" if failed else "all hold"
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
        printed = [finding for finding in self.findings if not finding.ok]
        if not any(parts[1:]):
            printed = list(self.findings)
        parts.append(findings_table(printed).text(width))
        parts += [wrap(note, width) for note in self.notes]
        parts.append(self.verdict)
        return "\n\n".join(filter(None, parts))

    def _repr_html_(self) -> str:
        """The text and the picture, for a notebook."""
        return f"<pre>{escape(self.text())}</pre>{svg(self.panels)}"

    def document(self) -> dict[str, Any]:
        """The report for JSON: ``data``, the tables, and the findings.

        With findings: ``ok``, ``findings``, and KEY_value of each finding that has a key.
        """
        result: dict[str, Any] = dict(plain(self.data))
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
        for table in self.tables:
            if table.rows:
                return table.csv()
        return self.tables[0].csv()

    def pictured(self) -> tuple[Panel, ...]:
        """The panels, curves and maps, of which a picture of the result is made."""
        return self.panels

    def save(self, file: Path) -> None:
        """Draw the picture into a file; an old file is replaced only by a complete picture."""
        # In memory first: Matplotlib prints a traceback for a file that cannot be closed.
        drawn = io.BytesIO()
        self.figure().savefig(drawn, dpi=150, format=file.suffix[1:].lower())
        with replacing(file) as new:
            new.write_bytes(drawn.getvalue())
