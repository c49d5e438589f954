"""Result of a study: title, tables, findings, panels and notes, as text, JSON, CSV or HTML."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

from lwa.base.exact import InputError
from validation.pictures.figure import Pictured, svg
from validation.pictures.panel import Panel
from validation.report import text as texts
from validation.report.files import replacing
from validation.report.table import Finding, Table, plain


@dataclass(frozen=True, eq=False)
class Report(Pictured):
    """Result of a study.

    title : what was computed, in one or a few lines.
    tables : tables; text shows those with column labels, JSON those with a key.
    findings : numbers with bounds. In a report with tables, text shows only the findings that fail.
    panels : panels of the picture.
    notes : explanations below the tables.
    data : entries that go to JSON unchanged.
    parts : reports that this report consists of.

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
    parts: tuple[Report, ...] = ()

    @property
    def ok(self) -> bool:
        """True if every finding holds, those of the parts included."""
        return all(found.ok for found in self._all_findings())

    @property
    def verdict(self) -> str:
        """Number of findings that hold; empty for a report without findings.

        >>> Report("", findings=(Finding("order", 2.4, 2.0, 3.0),)).verdict
        '1 check: all hold'
        """
        count = len(found := self._all_findings())
        failed = sum(not finding.ok for finding in found)
        checks = f"{count} check{'s' * (count != 1)}: "
        return checks + (f"{failed} of {count} fail" if failed else "all hold") if count else ""

    def text(self) -> str:
        """The report as plain text."""
        blocks = [block for report in self._tree() for block in report._blocks()]
        return "\n\n".join(filter(None, (*blocks, self.verdict)))

    def document(self) -> dict[str, Any]:
        """The report for JSON: ``data``, each table under its key, and the findings.

        With findings: ``ok``, ``findings``, ``statements`` (empty), and KEY_value of each finding
        that has a key.
        """
        found: dict[str, Any] = dict(plain(self.data))
        found |= {table.key: table.document() for table in self.tables if table.key}
        if self.findings:
            found |= {f"{f.key}_value": plain(f.value) for f in self.findings if f.key}
            found["findings"] = [f.document() for f in self.findings]
            found["statements"] = []  # a key of the format; all findings are numbers
        return found | ({"ok": self.ok} if self._all_findings() else {})

    def csv(self) -> str:
        """Return the first table with keys as CSV, if possible a table with rows.

        Raises `lwa.InputError` for a report without such a table.
        """
        tables = [
            table
            for report in self._tree()
            for table in report.tables
            if any(column.key for column in table.columns)
        ]
        if not tables:
            raise InputError("format is csv: this result has no table")
        return next((table for table in tables if table.rows), tables[0]).csv()

    def pictured(self) -> list[Panel]:
        """The panels of the report and its parts."""
        return [panel for report in self._tree() for panel in report.panels]

    def save(self, file: Path) -> None:
        """Draw the picture into a file; an old file is replaced only by a complete picture."""
        drawn = io.BytesIO()  # Matplotlib prints a traceback for a file that cannot be closed
        self.figure().savefig(drawn, dpi=150, format=file.suffix[1:].lower())
        with replacing(file) as new:
            new.write_bytes(drawn.getvalue())

    def _repr_html_(self) -> str:
        """The tables, the picture and the verdict, for a notebook."""
        verdict = f"<p>{self.verdict}</p>" if self._all_findings() else ""
        tables = (report._html() for report in self._tree())
        return "".join((*tables, svg(self.pictured()), verdict))

    def _tree(self) -> Iterator[Report]:
        """Iterate over this report and all its parts, depth first."""
        yield self
        for part in self.parts:
            yield from part._tree()

    def _all_findings(self) -> list[Finding]:
        return [found for report in self._tree() for found in report.findings]

    def _listed(self) -> str:
        shown = any(texts.blocks(table) for table in self.tables)
        return texts.listed(self.findings, failing=shown)

    def _blocks(self) -> list[str]:
        title, *notes = map(texts.filled, (self.title, *self.notes))
        return [title, *map(texts.text, self.tables), self._listed(), *notes]

    def _html(self) -> str:
        title, *notes = (f"<p>{escape(line)}</p>" for line in (self.title, *self.notes))
        listed = f"<pre>{escape(found)}</pre>" if (found := self._listed()) else ""
        return "".join((title, *map(texts.html, self.tables), listed, *notes))
