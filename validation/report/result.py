"""What any study's result looks like: a title, tables, findings, panels and notes."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lwa.base.exact import InputError
from lwa.wave.plots import axes
from validation.report import text as texts
from validation.report.figure import draw, figure
from validation.report.files import replacing
from validation.report.panel import Panel
from validation.report.table import Finding, Statement, Table, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Report:
    """A result for people, programs, spreadsheets, notebooks and eyes.

    title : what was done, in one line or some.
    tables : of which people read those with labels, and programs those with a key.
    findings : numbers held to bounds, and statements. With tables, people read only what fails.
    panels : of the picture.
    notes : what it takes to read the rest.
    data : what goes to JSON as it is, besides the tables and findings.
    parts : reports of which this one is made.

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
    findings: tuple[Finding | Statement, ...] = ()
    panels: tuple[Panel, ...] = ()
    notes: tuple[str, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    parts: tuple[Report, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether every finding holds, those of the parts too."""
        return all(found.ok for found in self._all())

    @property
    def verdict(self) -> str:
        """How many findings hold; nothing where there are none.

        >>> Report("", findings=(Statement("refused", "k is 1", True),)).verdict
        '1 check: all hold'
        """
        count = len(found := self._all())
        failed = sum(not finding.ok for finding in found)
        checks = f"{count} check{'s' * (count != 1)}: "
        return checks + (f"{failed} of {count} fail" if failed else "all hold") if count else ""

    def text(self) -> str:
        """For people."""
        blocks = [block for report in self._whole() for block in report._blocks()]
        return "\n\n".join(filter(None, (*blocks, self.verdict)))

    def document(self) -> dict[str, Any]:
        """For JSON: ``data``, the tables by their keys and, where something was to hold, ``ok``,
        ``findings``, ``statements``, and KEY_value of each finding that has a key."""
        found: dict[str, Any] = dict(plain(self.data))
        found |= {table.key: table.document() for table in self.tables if table.key}
        if self.findings:
            numbers = [f for f in self.findings if isinstance(f, Finding)]
            found |= {f"{f.key}_value": plain(f.value) for f in numbers if f.key}
            found["findings"] = [f.document() for f in numbers]
            found["statements"] = [asdict(s) for s in self.findings if isinstance(s, Statement)]
        return found | ({"ok": self.ok} if self._all() else {})

    def csv(self) -> str:
        """The first table that programs read, of those that have rows if there are such.

        Raises `lwa.InputError` where there is none."""
        tables = [table for report in self._whole() for table in report.tables
                  if any(column.key for column in table.columns)]  # fmt: skip
        if not tables:
            raise InputError("format is csv: this result has no table")
        return next((table for table in tables if table.rows), tables[0]).csv()

    def figure(self) -> Figure:
        """The picture. Raises `lwa.InputError` where there is none."""
        return figure(self._panels())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first panel into Matplotlib's axes ``ax``, or into new ones; returns them.

        Raises `lwa.InputError` where there is no picture."""
        first = self._panels()[0]
        drawn: Axes = axes(ax)
        draw(drawn, first)
        return drawn

    def save(self, file: Path) -> None:
        """Draw the picture into a file, which is replaced only by a complete one."""
        drawn = io.BytesIO()  # of a file that cannot be closed Matplotlib prints a traceback
        self.figure().savefig(drawn, dpi=150, format=file.suffix[1:].lower())
        with replacing(file) as new:
            new.write_bytes(drawn.getvalue())

    def _repr_html_(self) -> str:
        """For a notebook: the tables and the picture."""
        picture = ""
        if any(report.panels for report in self._whole()):
            drawn = io.StringIO()
            self.figure().savefig(drawn, format="svg")
            picture = drawn.getvalue()[drawn.getvalue().index("<svg") :]
        verdict = f"<p>{self.verdict}</p>" if self._all() else ""
        return "".join((*(report._html() for report in self._whole()), picture, verdict))

    def _whole(self) -> Iterator[Report]:
        """This report and all that it is made of."""
        yield self
        for part in self.parts:
            yield from part._whole()

    def _all(self) -> list[Finding | Statement]:
        return [found for report in self._whole() for found in report.findings]

    def _panels(self) -> list[Panel]:
        if found := [panel for report in self._whole() for panel in report.panels]:
            return found
        raise InputError("plot is asked for: this result has no picture")

    def _listed(self) -> list[str]:
        shown = any(texts.blocks(table) for table in self.tables)
        return texts.listed(self.findings, all_of_them=not shown)

    def _blocks(self) -> list[str]:
        title, *notes = map(texts.filled, (self.title, *self.notes))
        return [title, *map(texts.text, self.tables), *self._listed(), *notes]

    def _html(self) -> str:
        title, *notes = (f"<p>{escape(line)}</p>" for line in (self.title, *self.notes))
        told = [f"<pre>{escape(block)}</pre>" for block in self._listed()]
        return "".join((title, *map(texts.html, self.tables), *told, *notes))
