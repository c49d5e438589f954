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
from validation.report.table import Finding, Table, findings_table, plain, wrap


def output_file(name: str, path: str, suffixes: Sequence[str]) -> Path:
    """Return a path, ``name`` in messages, if its suffix is allowed and a file can be written."""
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
    raise InputError(f"{name} is {path[:120]}: {fault}")


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces ``file`` at the end, and is removed after a failure.

    A symbolic link keeps its target, and a file its mode. Raises `lwa.InputError`.
    """
    target = file.resolve()
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=target.parent) as folder:
            yield (new := Path(folder, "new"))
            if target.exists():
                new.chmod(target.stat().st_mode)
            new.replace(target)
    except OSError as error:
        raise InputError(f"{file} is not written: {reason(error)}") from None


@dataclass(frozen=True, eq=False)
class Report(Pictured):
    """Result of a study.

    title : what was computed, in one or a few lines.
    tables : tables; text shows those with column labels, JSON those with a key.
    findings : numbers with bounds. In a report with tables, text shows only the findings that fail.
    panels : panels of the picture.
    notes : explanations below the tables.
    data : entries that go to JSON unchanged.

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
        count, failed = (
            len(self.findings),
            sum(not finding.ok for finding in self.findings),
        )
        checks = f"{count} check{'s' * (count != 1)}: "
        return (
            checks + (f"{failed} of {count} fail" if failed else "all hold")
            if count
            else ""
        )

    def text(self) -> str:
        """The report as plain text: beside other printed tables only the findings that fail."""
        tables = [table.text() for table in self.tables]
        printed = [
            finding for finding in self.findings if not (any(tables) and finding.ok)
        ]
        title, *notes = (wrap(text) for text in (self.title, *self.notes))
        texts = title, *tables, findings_table(printed).text(), *notes, self.verdict
        return "\n\n".join(filter(None, texts))

    def _repr_html_(self) -> str:
        """The text and the picture, for a notebook."""
        return f"<pre>{escape(self.text())}</pre>{svg(self.panels)}"

    def document(self) -> dict[str, Any]:
        """The report for JSON: ``data``, each table under its key, and the findings.

        With findings: ``ok``, ``findings``, and KEY_value of each finding that has a key.
        """
        result: dict[str, Any] = dict(plain(self.data))
        result |= {table.key: table.document() for table in self.tables if table.key}
        if self.findings:
            result |= {f"{f.key}_value": plain(f.value) for f in self.findings if f.key}
            result |= {
                "findings": findings_table(self.findings).document(),
                "ok": self.ok,
            }
        return result

    def csv(self) -> str:
        """Return the first table with keys as CSV; tables without rows come last.

        Raises `lwa.InputError` if no table has keys.
        """
        tables = [
            table
            for table in self.tables
            if any(column.key for column in table.columns)
        ]
        if not tables:
            raise InputError("format is csv: this result has no table")
        return next((table for table in tables if table.rows), tables[0]).csv()

    def pictured(self) -> tuple[Panel, ...]:
        """The panels, curves and maps, of which a picture of the result is made."""
        return self.panels

    def save(self, file: Path) -> None:
        """Draw the picture into a file; an old file is replaced only by a complete picture."""
        drawn = (
            io.BytesIO()
        )  # Matplotlib prints a traceback for a file that cannot be closed
        self.figure().savefig(drawn, dpi=150, format=file.suffix[1:].lower())
        with replacing(file) as new:
            new.write_bytes(drawn.getvalue())
